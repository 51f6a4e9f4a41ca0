//! `[reduced]`: by which laws a swimmer moves where no flow is solved for.

pub(crate) mod calibration;
pub(crate) mod law;
pub(crate) mod left_out;
pub(crate) mod mechanics;
pub(crate) mod parts;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use self::law::{Coefficient, LoadLaw};
use self::mechanics::{EllipsoidSpec, KeelSpec, ServoSpec, TendonSpec};
use self::parts::{BuoyancySpec, CalibratedSpec, ConnectionSpec, ThrusterSpec};
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// `[reduced]`: the reduced model of a swimmer, for runs with `--fidelity reduced`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ReducedSpec {
    /// Law of what the fluid does to a body.
    pub loads: LoadLaw,
    /// Coefficients of the law by name, for all bodies; those that are absent are as the page says.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub coefficients: BTreeMap<String, f64>,
    /// Coefficients of single bodies by their names: `reduced.body.eel-1.normal_linear`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub body: BTreeMap<String, BTreeMap<String, f64>>,
    /// Height of the body across the plane (m), of `loads = "ebt"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub depth: Option<f64>,
    /// What the fluid about an ellipsoid does by its inertia: `full` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub added_mass: Option<AddedMassSpec>,
    /// The lift of ellipsoids by their angle of attack: `full` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lift: Option<LiftSpec>,
    /// What bodies displace, by their names, where it is not what their shapes do.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub buoyancy: BTreeMap<String, BuoyancySpec>,
    /// Propellers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub thruster: Vec<ThrusterSpec>,
    /// Elastic lines between bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tendon: Vec<TendonSpec>,
    /// Motors that bring joints to a rate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub servo: Vec<ServoSpec>,
    /// Inertia of what turns with a joint alone, such as the rotor of its motor times the square of the gear, by the name of
    /// the body below the joint, a `hinge` (kg m2; kg m planar) or a `slider` (kg; kg/m).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[cfg_attr(test, schemars(with = "BTreeMap<String, NonNegative>"))]
    pub armature: BTreeMap<String, f64>,
    /// What keeps the first body level in space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keel: Option<KeelSpec>,
    /// Ellipsoids for the loads on bodies, in place of those of their shapes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ellipsoid: Vec<EllipsoidSpec>,
    /// The table of `loads = "connection"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connection: Option<ConnectionSpec>,
    /// A file of `alewife calibrate`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibrated: Option<CalibratedSpec>,
}

/// `added_mass`: one of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum AddedMassSpec {
    /// It resists accelerations, and its momentum turns with the body.
    Full,
    /// As `MuJoCo` has it: the momentum turns with the body, and resists no acceleration.
    Mujoco,
}

/// `lift`: one of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum LiftSpec {
    /// By its formula, at any size.
    Full,
    /// As `MuJoCo` 3 has it (3.3.7; 4.0 has it full): its denominators are 1e-15 at least in SI units, which takes it from
    /// parts of some centimetres.
    #[serde(rename = "mujoco-3")]
    Mujoco3,
}

impl ReducedSpec {
    /// A law with all its coefficients as they are where none is written.
    #[must_use]
    pub fn new(loads: LoadLaw) -> Self {
        Self {
            loads,
            coefficients: BTreeMap::new(),
            body: BTreeMap::new(),
            depth: None,
            added_mass: None,
            lift: None,
            buoyancy: BTreeMap::new(),
            thruster: Vec::new(),
            tendon: Vec::new(),
            servo: Vec::new(),
            armature: BTreeMap::new(),
            keel: None,
            ellipsoid: Vec::new(),
            connection: None,
            calibrated: None,
        }
    }

    /// The coefficients of a body, in the order of its law.
    #[must_use]
    pub fn coefficients_of(&self, body: &str) -> Vec<f64> {
        let own = self.body.get(body);
        let value = |one: &Coefficient| {
            let of_body = own.and_then(|own| own.get(one.name));
            *of_body.or_else(|| self.coefficients.get(one.name)).unwrap_or(&one.default)
        };
        self.loads.coefficients().iter().map(value).collect()
    }
}

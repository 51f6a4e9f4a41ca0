//! `[reduced]`: by which laws a swimmer moves where no flow is solved for.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

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
    /// What the fluid about an ellipsoid does by its inertia: `full` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub added_mass: Option<AddedMassSpec>,
}

/// `loads`: one of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum LoadLaw {
    /// Planar, with inertia: potential added mass, drag by strips across, friction along.
    Links,
    /// Without inertia: forces a length along and across a slender body.
    Resistive,
    /// In three dimensions, with inertia: an ellipsoid with five coefficients.
    Ellipsoid,
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

/// A coefficient of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    /// Its name.
    pub name: &'static str,
    /// Its value where none is written.
    pub default: f64,
}

/// Of slender links: fitted to two swims of an eel of three links by the full solver, at Reynolds numbers of 30 to 70
/// by the tail.
const LINKS: [Coefficient; 5] = [
    Coefficient { name: "added_mass", default: 0.55 },
    Coefficient { name: "normal_linear", default: 21.0 },
    Coefficient { name: "normal_quadratic", default: 4.9 },
    Coefficient { name: "tangential_linear", default: 17.0 },
    Coefficient { name: "tangential_quadratic", default: 0.53 },
];

/// The ratio is that of Purcell's swimmer.
const RESISTIVE: [Coefficient; 2] =
    [Coefficient { name: "along", default: 2.0 }, Coefficient { name: "across", default: 3.5 }];

/// Those of `MuJoCo`.
const ELLIPSOID: [Coefficient; 5] = [
    Coefficient { name: "blunt", default: 0.5 },
    Coefficient { name: "slender", default: 0.25 },
    Coefficient { name: "angular", default: 1.5 },
    Coefficient { name: "kutta", default: 1.0 },
    Coefficient { name: "magnus", default: 1.0 },
];

impl LoadLaw {
    /// Its name in a case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Links => "links",
            Self::Resistive => "resistive",
            Self::Ellipsoid => "ellipsoid",
        }
    }

    /// Its coefficients, in the order of [`ReducedSpec::coefficients_of`].
    #[must_use]
    pub fn coefficients(self) -> &'static [Coefficient] {
        match self {
            Self::Links => &LINKS,
            Self::Resistive => &RESISTIVE,
            Self::Ellipsoid => &ELLIPSOID,
        }
    }
}

impl ReducedSpec {
    /// A law with all its coefficients as they are where none is written.
    #[must_use]
    pub fn new(loads: LoadLaw) -> Self {
        Self { loads, coefficients: BTreeMap::new(), body: BTreeMap::new(), added_mass: None }
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

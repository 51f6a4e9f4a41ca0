//! `LoadLaw`: laws of what the fluid does to a body, with their coefficients by name.

use serde::{Deserialize, Serialize};

/// `loads`: one of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum LoadLaw {
    /// Planar, with inertia: potential added mass, drag by strips across, friction along.
    Links,
    /// Planar, with inertia: elongated-body theory, a chain whose tail leaves momentum behind, drag by strips.
    Ebt,
    /// Without inertia: forces a length along and across a slender body.
    Resistive,
    /// In three dimensions, with inertia: an ellipsoid with five coefficients.
    Ellipsoid,
    /// With inertia: a vehicle with added masses, linear and quadratic damping on its axes.
    Fossen,
    /// Without inertia: the velocity of the first body by the rates of up to three joints that are given.
    Connection,
}

/// A coefficient of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    /// Its name.
    pub name: &'static str,
    /// Its value where none is written.
    pub default: f64,
}

const fn coefficient(name: &'static str, default: f64) -> Coefficient {
    Coefficient { name, default }
}

/// Of slender links: fitted to two swims of an eel of three links by the full solver, at Reynolds numbers of 30 to 70
/// by the tail.
const LINKS: [Coefficient; 5] = [
    coefficient("added_mass", 0.55),
    coefficient("normal_linear", 21.0),
    coefficient("normal_quadratic", 4.9),
    coefficient("tangential_linear", 17.0),
    coefficient("tangential_quadratic", 0.53),
];

/// That of a cylinder about the tail, and the friction of `links`; none across, which is what the theory leaves out.
const EBT: [Coefficient; 5] = [
    coefficient("added_mass", 1.0),
    coefficient("normal_linear", 0.0),
    coefficient("normal_quadratic", 0.0),
    coefficient("tangential_linear", 17.0),
    coefficient("tangential_quadratic", 0.53),
];

/// The ratio is that of Purcell's swimmer.
const RESISTIVE: [Coefficient; 2] = [coefficient("along", 2.0), coefficient("across", 3.5)];

/// Those of `MuJoCo`.
const ELLIPSOID: [Coefficient; 5] = [
    coefficient("blunt", 0.5),
    coefficient("slender", 0.25),
    coefficient("angular", 1.5),
    coefficient("kutta", 1.0),
    coefficient("magnus", 1.0),
];

/// Along and about the axes of the body, by the names they have on ships.
const FOSSEN: [Coefficient; 18] = [
    coefficient("added_mass_surge", 0.0),
    coefficient("added_mass_sway", 0.0),
    coefficient("added_mass_heave", 0.0),
    coefficient("added_mass_roll", 0.0),
    coefficient("added_mass_pitch", 0.0),
    coefficient("added_mass_yaw", 0.0),
    coefficient("linear_surge", 0.0),
    coefficient("linear_sway", 0.0),
    coefficient("linear_heave", 0.0),
    coefficient("linear_roll", 0.0),
    coefficient("linear_pitch", 0.0),
    coefficient("linear_yaw", 0.0),
    coefficient("quadratic_surge", 0.0),
    coefficient("quadratic_sway", 0.0),
    coefficient("quadratic_heave", 0.0),
    coefficient("quadratic_roll", 0.0),
    coefficient("quadratic_pitch", 0.0),
    coefficient("quadratic_yaw", 0.0),
];

impl LoadLaw {
    /// Its name in a case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Links => "links",
            Self::Ebt => "ebt",
            Self::Resistive => "resistive",
            Self::Ellipsoid => "ellipsoid",
            Self::Fossen => "fossen",
            Self::Connection => "connection",
        }
    }

    /// Its coefficients, in the order of [`super::ReducedSpec::coefficients_of`].
    #[must_use]
    pub fn coefficients(self) -> &'static [Coefficient] {
        match self {
            Self::Links => &LINKS,
            Self::Ebt => &EBT,
            Self::Resistive => &RESISTIVE,
            Self::Ellipsoid => &ELLIPSOID,
            Self::Fossen => &FOSSEN,
            Self::Connection => &[],
        }
    }

    /// Whether it is for bodies without inertia.
    #[must_use]
    pub fn is_without_inertia(self) -> bool {
        matches!(self, Self::Resistive | Self::Connection)
    }
}

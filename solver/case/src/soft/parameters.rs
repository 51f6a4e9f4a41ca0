//! `ParameterKey`: a number of a soft case that gradients are known of, found by its key.

use super::solid::{MaterialSpec, SoftSolid};
use super::spec::{LoadCurve, SoftCase};
use super::stretch::Stretch;

/// A number that has a derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKey {
    /// Young's modulus of a material: 0 for that of the body, then those of its parts.
    Young(usize),
    /// Poisson's ratio of a material.
    Poisson(usize),
    /// The stiffness of a set of fibres.
    FibreStiffness(usize),
    /// The constant stretch of a set of fibres.
    Constant(usize),
    /// A number of the wave of a set of fibres: mean, amplitude, frequency, phase.
    Wave(usize, usize),
    /// A number of the pulses of a set of fibres: amplitude, rise, on.
    Trapezoid(usize, usize),
    /// The stretch of a set of fibres in a frame.
    Frame(usize, usize),
    /// A point of the curve of drag.
    Drag(usize),
    /// A point of the curve of thrust.
    Thrust(usize),
}

/// Why a key is none of a number that can be sought.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyError {
    /// What is wrong.
    pub message: String,
    /// What is accepted.
    pub help: String,
}

/// Numbers of a wave.
const WAVE: [&str; 4] = ["mean", "amplitude", "frequency", "phase"];
/// Numbers of pulses.
const TRAPEZOID: [&str; 3] = ["amplitude", "rise", "on"];

const ACCEPTED: &str = "accepted: solid.0.material.young and .poisson, solid.0.part.N.material.young and .poisson, \
                        solid.0.fibre.N.stiffness, solid.0.fibre.N.stretch.constant, .wave.mean, .wave.amplitude, \
                        .wave.frequency, .wave.phase, .trapezoid.amplitude, .trapezoid.rise, .trapezoid.on and \
                        .frames, loads.drag.bezier.N, loads.thrust.bezier.N, and \
                        the same of a table; N counts from 0";

impl ParameterKey {
    /// The numbers of a key: those of a list where it leads to one.
    ///
    /// # Errors
    /// [`KeyError`] where there is no such number in the case, or it has no derivative.
    pub fn find(case: &SoftCase, key: &str) -> Result<Vec<Self>, KeyError> {
        let unknown = || KeyError {
            message: format!("`{key}` is no number of this case that can be sought"),
            help: ACCEPTED.to_owned(),
        };
        let steps: Vec<&str> = key.split('.').collect();
        let number = |step: &str| step.parse::<usize>().ok();
        let all = |n: usize, of: &dyn Fn(usize) -> Self| (0..n).map(of).collect::<Vec<_>>();
        let material = |index: usize, key: &str| match key {
            "young" => Some(vec![Self::Young(index)]),
            "poisson" => Some(vec![Self::Poisson(index)]),
            _ => None,
        };
        let found = match steps.as_slice() {
            ["solid", "0", "material", key] => material(0, key),
            ["solid", "0", "part", n, "material", key] => {
                number(n).and_then(|n| material(n + 1, key))
            }
            ["solid", "0", "fibre", n, "stiffness"] => {
                number(n).map(|n| vec![Self::FibreStiffness(n)])
            }
            ["solid", "0", "fibre", n, "stretch", "constant"] => {
                number(n).map(|n| vec![Self::Constant(n)])
            }
            ["solid", "0", "fibre", n, "stretch", "wave", of] => {
                let of = WAVE.iter().position(|name| name == of);
                number(n).zip(of).map(|(n, of)| vec![Self::Wave(n, of)])
            }
            ["solid", "0", "fibre", n, "stretch", "trapezoid", of] => {
                let of = TRAPEZOID.iter().position(|name| name == of);
                number(n).zip(of).map(|(n, of)| vec![Self::Trapezoid(n, of)])
            }
            ["solid", "0", "fibre", n, "stretch", "frames"] => {
                number(n).map(|n| all(case.soft.frames, &|frame| Self::Frame(n, frame)))
            }
            ["solid", "0", "fibre", n, "stretch", "frames", frame] => {
                number(n).zip(number(frame)).map(|(n, frame)| vec![Self::Frame(n, frame)])
            }
            ["loads", "drag", kind, n] => curve(case, [true, *kind == "bezier"], number(n)),
            ["loads", "thrust", kind, n] => curve(case, [false, *kind == "bezier"], number(n)),
            _ => None,
        };
        let found = found.ok_or_else(unknown)?;
        if found.iter().all(|one| one.read(case).is_some()) { Ok(found) } else { Err(unknown()) }
    }

    /// Its value in a case.
    #[must_use]
    pub fn read(self, case: &SoftCase) -> Option<f64> {
        self.slot(&mut case.clone()).map(|slot| *slot)
    }

    /// Gives it another value in a case.
    pub fn write(self, case: &mut SoftCase, value: f64) {
        if let Some(slot) = self.slot(case) {
            *slot = value;
        }
    }

    fn slot(self, case: &mut SoftCase) -> Option<&mut f64> {
        let solid = case.solid.first_mut()?;
        match self {
            Self::Young(index) => material(solid, index).map(|material| &mut material.young),
            Self::Poisson(index) => material(solid, index).map(|material| &mut material.poisson),
            Self::FibreStiffness(n) => solid.fibre.get_mut(n).map(|fibre| &mut fibre.stiffness),
            Self::Constant(n) => match &mut solid.fibre.get_mut(n)?.stretch {
                Stretch::Constant(value) => Some(value),
                _ => None,
            },
            Self::Wave(n, of) => match &mut solid.fibre.get_mut(n)?.stretch {
                Stretch::Wave(wave) => Some(match of {
                    0 => &mut wave.mean,
                    1 => &mut wave.amplitude,
                    2 => &mut wave.frequency,
                    _ => &mut wave.phase,
                }),
                _ => None,
            },
            Self::Trapezoid(n, of) => match &mut solid.fibre.get_mut(n)?.stretch {
                Stretch::Trapezoid(pulse) => Some(match of {
                    0 => &mut pulse.amplitude,
                    1 => &mut pulse.rise,
                    _ => &mut pulse.on,
                }),
                _ => None,
            },
            Self::Frame(n, frame) => match &mut solid.fibre.get_mut(n)?.stretch {
                Stretch::Frames(values) => values.get_mut(frame),
                _ => None,
            },
            Self::Drag(n) => case.loads.as_mut()?.drag.points_mut().get_mut(n),
            Self::Thrust(n) => case.loads.as_mut()?.thrust.points_mut().get_mut(n),
        }
    }
}

/// The material of a number: that of the body, then those of its parts.
fn material(solid: &mut SoftSolid, index: usize) -> Option<&mut MaterialSpec> {
    match index.checked_sub(1) {
        None => Some(&mut solid.material),
        Some(part) => solid.part.get_mut(part).map(|part| &mut part.material),
    }
}

/// A point of a curve, where it is of the kind that is meant.
fn curve(
    case: &SoftCase,
    [is_drag, is_bezier]: [bool; 2],
    number: Option<usize>,
) -> Option<Vec<ParameterKey>> {
    let loads = case.loads.as_ref()?;
    let curve = if is_drag { &loads.drag } else { &loads.thrust };
    let fits = matches!(curve, LoadCurve::Bezier(_)) == is_bezier;
    let key = if is_drag { ParameterKey::Drag } else { ParameterKey::Thrust };
    number.filter(|_| fits).map(|n| vec![key(n)])
}

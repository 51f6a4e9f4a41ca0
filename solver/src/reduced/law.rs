//! `Law`: what the fluid does to a body by the law of a case, over any kind of number.

use alewife_reduced::tree::loads::{
    AddedMass, Ellipsoid, EllipsoidCoefficients, Lift, Load, Resistive, StripCoefficients, Strips,
    Vehicle,
};
use alewife_reduced::tree::{Number, real};
use nalgebra::Vector3;

use super::inertia::Solid;
use crate::case::{AddedMassSpec, Case, LiftSpec, LoadLaw, ReducedSpec};

/// The law of a case for one body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Law {
    loads: LoadLaw,
    added_mass: AddedMass,
    lift: Lift,
    semi_axes: Vector3<f64>,
    density: f64,
    viscosity: f64,
}

impl Law {
    pub fn new(case: &Case, spec: &ReducedSpec, solid: &Solid) -> Self {
        let added_mass = match spec.added_mass {
            Some(AddedMassSpec::Mujoco) => AddedMass::Mujoco,
            Some(AddedMassSpec::Full) | None => AddedMass::Full,
        };
        let lift = match spec.lift {
            Some(LiftSpec::Mujoco3) => Lift::Mujoco3,
            Some(LiftSpec::Full) | None => Lift::Full,
        };
        Self {
            loads: spec.loads,
            added_mass,
            lift,
            semi_axes: solid.semi_axes,
            density: case.fluid.density,
            viscosity: case.reference_viscosity(),
        }
    }

    /// The same law for an ellipsoid of other semi-axes (m).
    pub fn of(self, semi_axes: [f64; 3]) -> Self {
        Self { semi_axes: semi_axes.into(), ..self }
    }

    /// Where it is measured from the centre of mass, in the frame of the body: a vehicle's about the origin of that frame.
    pub fn place(&self, solid: &Solid) -> Vector3<f64> {
        if self.loads == LoadLaw::Fossen { -solid.center } else { solid.middle }
    }

    /// How far the body reaches from its middle (m).
    pub fn reach(&self) -> f64 {
        self.semi_axes.max()
    }

    /// Its load by coefficients in the order of the law; none where motions are those of a table.
    pub fn load<T: Number>(&self, coefficients: &[T]) -> Option<Load<T>> {
        let c = |k: usize| coefficients.get(k).copied().unwrap_or_else(|| real(0.0));
        let axes = self.semi_axes.map(real::<T>);
        let (density, viscosity) = (real(self.density), real(self.viscosity));
        let six = |from: usize| std::array::from_fn(|k| c(from + k));
        Some(match self.loads {
            LoadLaw::Links => Load::Strips(Strips {
                half_length: axes.x,
                half_width: axes.y,
                depth: real(1.0),
                density,
                viscosity,
                coefficients: StripCoefficients {
                    added_mass: c(0),
                    normal_linear: c(1),
                    normal_quadratic: c(2),
                    tangential_linear: c(3),
                    tangential_quadratic: c(4),
                },
            }),
            LoadLaw::Resistive => Load::Resistive(Resistive {
                length: axes.x * 2.0,
                half_width: axes.y,
                viscosity,
                along: c(0),
                across: c(1),
            }),
            LoadLaw::Ellipsoid => {
                let coefficients = EllipsoidCoefficients::from_array([0, 1, 2, 3, 4].map(c));
                let axes = [axes.x, axes.y, axes.z];
                let law = Ellipsoid::new(axes, density, viscosity, coefficients, self.added_mass);
                Load::Ellipsoid(Box::new(law.lifted(self.lift)))
            }
            LoadLaw::Fossen => {
                Load::Vehicle(Vehicle { added: six(0), linear: six(6), quadratic: six(12) })
            }
            LoadLaw::Connection => return None,
        })
    }
}

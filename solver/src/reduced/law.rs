//! `Law`: what the fluid does to a body by the law of a case, over any kind of number.

use alewife_reduced::tree::loads::{
    AddedMass, Ellipsoid, EllipsoidCoefficients, ElongatedLink, Lift, Load, Resistive,
    StripCoefficients, Strips, Vehicle, elongated_mass,
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
    /// Height across the plane (m).
    depth: f64,
    /// Where the head is from a tail, 1 along x or -1; none of bodies that are no tail.
    tail: Option<f64>,
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
            depth: spec.depth.unwrap_or(1.0),
            tail: None,
        }
    }

    /// The same law for a tail.
    pub fn of_tail(self, tail: Option<f64>) -> Self {
        Self { tail, ..self }
    }

    /// The same law for an ellipsoid of other semi-axes (m).
    pub fn of(self, semi_axes: [f64; 3]) -> Self {
        Self { semi_axes: semi_axes.into(), ..self }
    }

    /// Where it is measured from the centre of mass, in the frame of the body: a vehicle's about the origin of that frame.
    pub fn place(&self, solid: &Solid) -> Vector3<f64> {
        if self.loads == LoadLaw::Fossen { -solid.center } else { solid.middle }
    }

    /// Half lengths of what it is the law of, along its axes (m).
    pub fn semi_axes(&self) -> Vector3<f64> {
        self.semi_axes
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
            LoadLaw::Links => Load::Strips(self.strips(&[c(0), c(1), c(2), c(3), c(4)])),
            // A depth, as all loads of the plane
            LoadLaw::Ebt => Load::Elongated(ElongatedLink {
                drag: self.strips(&[real(0.0), c(1), c(2), c(3), c(4)]),
                mass: elongated_mass(density, real(self.depth), c(0)) / self.depth,
                tail: self.tail,
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

    /// Strips of the body, a depth.
    fn strips<T: Number>(&self, [added_mass, one, two, three, four]: &[T; 5]) -> Strips<T> {
        Strips {
            half_length: real(self.semi_axes.x),
            half_width: real(self.semi_axes.y),
            depth: real(1.0),
            density: real(self.density),
            viscosity: real(self.viscosity),
            coefficients: StripCoefficients {
                added_mass: *added_mass,
                normal_linear: *one,
                normal_quadratic: *two,
                tangential_linear: *three,
                tangential_quadratic: *four,
            },
        }
    }
}

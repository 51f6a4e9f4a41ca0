//! `PlanarRodBody`: a planar rod with its surface, its supports and its weight, as a body in a flow.

use nalgebra::{DMatrix, DVector, Vector2, Vector3};

use super::ends::{EndLoad, EndPose};
use super::loaded_end::LoadedEnd;
use super::planar_rod::PlanarRod;
use super::surface::{SectionPoint, SectionRows, SurfaceRows};
use crate::rod::center::center_weights;
use crate::rod::loads::LineForce;
use crate::rod::supports::Supports;
use crate::structure::{
    BaseMotion, Bend, Flexible, GivenLoad, Held, InnerPower, Load, SectionMotion, SectionWeight,
    Structure, Tangents, Weight,
};

/// A planar rod as a body in a flow. Its material points are named by their places where the rod is straight.
#[derive(Debug)]
pub struct PlanarRodBody {
    rod: PlanarRod,
    /// Place (m) and direction (rad) of the base of the straight rod.
    base: EndPose,
    initial: DVector<f64>,
    supports: Supports<EndPose>,
    weight: Option<LineForce>,
    ends: Vec<LoadedEnd>,
}

impl PlanarRodBody {
    /// A rod that is straight at the start, from a base (m, rad) on, with what holds it.
    #[must_use]
    pub fn new(rod: PlanarRod, base: EndPose, supports: Supports<EndPose>) -> Self {
        let rod = supports.clamp(rod);
        let initial = rod.straight(base.place, base.angle);
        Self { rod, base, initial, supports, weight: None, ends: Vec::new() }
    }

    /// With other coordinates at the start.
    #[must_use]
    pub fn starting(self, initial: DVector<f64>) -> Self {
        Self { initial, ..self }
    }

    /// With a force that does not change, such as weight less buoyancy.
    #[must_use]
    pub fn loaded(self, weight: LineForce) -> Self {
        Self { weight: Some(weight), ..self }
    }

    /// With loads at its ends.
    #[must_use]
    pub fn with_loaded_ends(self, ends: Vec<LoadedEnd>) -> Self {
        Self { ends, ..self }
    }

    /// The rod.
    #[must_use]
    pub fn rod(&self) -> &PlanarRod {
        &self.rod
    }

    /// The point that is at a place (m) where the rod is straight.
    #[must_use]
    pub fn section_point(&self, rest: &Vector3<f64>) -> SectionPoint {
        let from_base = rest.xy() - self.base.place;
        let (sin, cos) = self.base.angle.sin_cos();
        SectionPoint {
            along: from_base.dot(&Vector2::new(cos, sin)),
            offset: from_base.dot(&Vector2::new(-sin, cos)),
        }
    }

    fn at(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> SurfaceRows {
        self.rod.surface(coordinates, self.section_point(rest))
    }
}

impl Structure for PlanarRodBody {
    fn n_coordinates(&self) -> usize {
        self.rod.n_coordinates()
    }

    fn mass(&self) -> DMatrix<f64> {
        self.rod.mass()
    }

    fn forces(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> DVector<f64> {
        let mut forces = self.rod.forces(coordinates, velocities, time);
        if let Some(weight) = &self.weight {
            forces -= weight.load(coordinates, velocities, time);
        }
        for end in &self.ends {
            end.subtract(&self.rod, coordinates, time, &mut forces);
        }
        forces
    }

    fn tangents(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> Tangents {
        let mut tangents = self.rod.tangents(coordinates, velocities, time);
        for end in &self.ends {
            end.subtract_tangent(&self.rod, coordinates, time, &mut tangents.stiffness);
        }
        tangents
    }

    fn elastic_energy(&self, coordinates: &DVector<f64>, time: f64) -> f64 {
        self.rod.elastic_energy(coordinates, time)
    }

    fn inner_power(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> InnerPower {
        let power = |end: &LoadedEnd| end.power(&self.rod, coordinates, velocities, time);
        let ends = self.ends.iter().map(power).sum();
        InnerPower { ends, ..self.rod.inner_power(coordinates, velocities, time) }
    }
}

impl Flexible for PlanarRodBody {
    fn initial(&self) -> DVector<f64> {
        self.initial.clone()
    }

    fn held(&self, time: f64) -> Vec<Held> {
        self.supports.held(time, |end, support, pose| self.rod.held(end, support, pose))
    }

    fn place(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> Vector3<f64> {
        self.at(coordinates, rest).place.push(rest.z)
    }

    fn weights(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> Vec<Weight> {
        let rows = self.at(coordinates, rest);
        let weight = |i: usize| Weight {
            coordinate: (rows.first + i) % self.n_coordinates(),
            weight: rows.weights.column(i).push(0.0),
        };
        (0..rows.weights.ncols()).map(weight).collect()
    }

    fn section(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> Option<SectionMotion> {
        let along = self.section_point(rest).along;
        let SectionRows { place, first, weights } = self.rod.section(coordinates, along);
        let weight = |i: usize| SectionWeight {
            coordinate: (first + i) % self.n_coordinates(),
            linear: Vector3::new(weights[(0, i)], weights[(1, i)], 0.0),
            angular: Vector3::z() * weights[(2, i)],
        };
        let weights = (0..weights.ncols()).map(weight).collect();
        Some(SectionMotion { place: place.push(0.0), weights })
    }

    /// Directions count by the element they are at an end of.
    fn length_of(&self, coordinate: usize) -> f64 {
        let knots = self.rod.knots();
        let element = (coordinate / 4).min(knots.len() - 2);
        if coordinate % 4 < 2 { 1.0 } else { knots[element + 1] - knots[element] }
    }

    fn given_load(&self, coordinates: &DVector<f64>, time: f64) -> GivenLoad {
        let loads = self.ends.iter().map(|end| end.at(&self.rod, coordinates, time));
        loads.fold(GivenLoad::default(), |sum, EndLoad { force, moment }| GivenLoad {
            force: sum.force + force.push(0.0),
            moment: sum.moment + Vector3::z() * moment,
        })
    }

    fn center_weights(&self) -> Vec<Weight> {
        center_weights(&self.rod)
    }

    fn base(&self, coordinates: &DVector<f64>, velocities: &DVector<f64>) -> Option<BaseMotion> {
        Some(self.rod.base_motion(coordinates, velocities))
    }

    fn rigid_velocities(
        &self,
        coordinates: &DVector<f64>,
        motion: &BaseMotion,
    ) -> Option<DVector<f64>> {
        Some(self.rod.rigid_velocities(coordinates, motion))
    }

    fn bend(&self, coordinates: &DVector<f64>) -> Option<Bend> {
        let knots = self.rod.knots();
        let middles = knots.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        let curvatures = middles.map(|along| self.rod.curvature(coordinates, along));
        let larger = |most: f64, at: f64| if at.abs() > most.abs() { at } else { most };
        Some(Bend {
            tip: self.rod.place(coordinates, *knots.last()?).push(0.0),
            curvature: curvatures.fold(0.0, larger),
        })
    }
}

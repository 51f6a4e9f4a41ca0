//! `SpatialRodBody`: a rod in space with its surface, its supports and its weight, as a body in a flow.

use nalgebra::{DMatrix, DVector, Vector3};

use super::ends::{SpatialEndLoad, SpatialEndPose};
use super::loaded_end::SpatialLoadedEnd;
use super::spatial_rod::SpatialRod;
use super::surface::{SpatialSectionPoint, SpatialSurfaceRows};
use crate::rod::center::center_weights;
use crate::rod::loads::LineForce;
use crate::rod::supports::Supports;
use crate::structure::{
    BaseMotion, Bend, Flexible, GivenLoad, Held, InnerPower, Load, Structure, Tangents, Weight,
};

/// A rod in space as a body in a flow. Its material points are named by their places where the rod is straight.
#[derive(Debug)]
pub struct SpatialRodBody {
    rod: SpatialRod,
    /// Place (m) and frame of the base of the straight rod.
    base: SpatialEndPose,
    initial: DVector<f64>,
    supports: Supports<SpatialEndPose>,
    weight: Option<LineForce>,
    ends: Vec<SpatialLoadedEnd>,
}

impl SpatialRodBody {
    /// A rod that is straight at the start, from a base on, with what holds it.
    #[must_use]
    pub fn new(rod: SpatialRod, base: SpatialEndPose, supports: Supports<SpatialEndPose>) -> Self {
        let rod = supports.clamp(rod);
        let initial = rod.straight(base.place, base.rotation);
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
    pub fn with_loaded_ends(self, ends: Vec<SpatialLoadedEnd>) -> Self {
        Self { ends, ..self }
    }

    /// The rod.
    #[must_use]
    pub fn rod(&self) -> &SpatialRod {
        &self.rod
    }

    /// The point that is at a place (m) where the rod is straight.
    #[must_use]
    pub fn section_point(&self, rest: &Vector3<f64>) -> SpatialSectionPoint {
        let local = self.base.rotation.inverse() * (rest - self.base.place);
        SpatialSectionPoint { along: local.x, offset: [local.y, local.z] }
    }

    fn at(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> SpatialSurfaceRows {
        self.rod.surface(coordinates, self.section_point(rest))
    }
}

impl Structure for SpatialRodBody {
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
        let power = |end: &SpatialLoadedEnd| end.power(&self.rod, coordinates, velocities, time);
        let ends = self.ends.iter().map(power).sum();
        InnerPower { ends, ..self.rod.inner_power(coordinates, velocities, time) }
    }
}

impl Flexible for SpatialRodBody {
    fn initial(&self) -> DVector<f64> {
        self.initial.clone()
    }

    fn held(&self, time: f64) -> Vec<Held> {
        self.supports.held(time, |end, support, pose| self.rod.held(end, support, pose))
    }

    fn place(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> Vector3<f64> {
        self.rod.surface_place(coordinates, self.section_point(rest))
    }

    fn weights(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> Vec<Weight> {
        let rows = self.at(coordinates, rest);
        let weight = |i: usize| Weight {
            coordinate: rows.first + i,
            weight: rows.weights.column(i).into_owned(),
        };
        (0..rows.weights.ncols()).map(weight).collect()
    }

    /// Directions count by the element they are at an end of, vectors across by the thickness that is not known here: as those.
    fn length_of(&self, coordinate: usize) -> f64 {
        let knots = self.rod.knots();
        let element = (coordinate / 9).min(knots.len() - 2);
        if coordinate % 9 < 3 { 1.0 } else { knots[element + 1] - knots[element] }
    }

    fn given_load(&self, coordinates: &DVector<f64>, time: f64) -> GivenLoad {
        let loads = self.ends.iter().map(|end| end.at(&self.rod, coordinates, time));
        loads.fold(GivenLoad::default(), |sum, SpatialEndLoad { force, moment }| GivenLoad {
            force: sum.force + force,
            moment: sum.moment + moment,
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
        let curvatures = middles.map(|along| self.rod.turning(coordinates, along).xy().norm());
        Some(Bend {
            tip: self.rod.place(coordinates, *knots.last()?),
            curvature: curvatures.fold(0.0, f64::max),
        })
    }
}

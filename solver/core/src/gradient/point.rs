//! `CasePoint`: a case with some numbers changed, on the mesh of the case itself.

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use super::error::GradientError;
use super::moment::Moment;
use crate::algebra::AffineConstraints;
use crate::body::{MeshPoses, Pose};
use crate::case::{CaseFile, Model, Steady, TimeSettings};
use crate::coupling::{BodiesAt, BodyShapes, Configuration, Problem, RigidBodyEquations};
use crate::run::RunError;

/// How a flow without inertia is solved: its equations are linear, but for a viscosity that depends on the rate of shear.
const LINEAR: Steady = Steady { tolerance: 1e-11, max_iterations: 50 };

/// A case with its mesh, whose nodes have followed its bodies.
pub(super) struct CasePoint<const D: usize> {
    /// What follows from the case.
    pub model: Model,
    /// What is solved.
    pub problem: Problem<D>,
    /// The mesh.
    pub mesh: Mesh<D>,
    /// Poses of the bodies in the laboratory.
    pub poses: Vec<Pose>,
    /// The same in the mesh.
    pub in_mesh: MeshPoses,
    /// By how much the nodes have moved (m); nothing where none has.
    pub moved: Vec<Point<D>>,
    /// How it is solved.
    pub settings: Steady,
    shapes: BodyShapes,
    equations: RigidBodyEquations,
}

impl<const D: usize> CasePoint<D> {
    /// Of a problem on its mesh, whose nodes are where its bodies are at a moment.
    pub fn new(
        file: CaseFile,
        problem: Problem<D>,
        mesh: Mesh<D>,
        shifts: &[Vector3<f64>],
        moment: &Moment,
    ) -> Result<Self, GradientError> {
        let settings = match &file.case().time {
            TimeSettings::Steady(settings) => settings.clone(),
            TimeSettings::Unsteady(_) => LINEAR,
        };
        let poses = moment.poses(&problem);
        let in_mesh = MeshPoses::seen_from(&Vector3::zeros(), &poses, shifts);
        // Bodies that deform are refused, so that it is gaits and boundary values that are of this time
        let shapes = BodyShapes::at(&problem.bodies, moment.rates_at).map_err(RunError::from)?;
        let equations = RigidBodyEquations::steady(&problem, &poses, moment.rates_at);
        Ok(Self {
            model: file.model,
            problem,
            mesh,
            poses,
            in_mesh,
            moved: Vec::new(),
            settings,
            shapes,
            equations,
        })
    }

    /// Time of boundary values, gaits and loads (s).
    pub fn time(&self) -> f64 {
        self.shapes.time()
    }

    /// The bodies in the mesh.
    pub fn bodies(&self) -> BodiesAt<'_> {
        BodiesAt { poses: &self.in_mesh, shapes: &self.shapes }
    }

    /// Newton's and Euler's equations of the bodies.
    pub fn equations(&self) -> &RigidBodyEquations {
        &self.equations
    }

    /// All that defines the system.
    pub fn configuration<'a>(&'a self, constraints: &'a AffineConstraints) -> Configuration<'a, D> {
        Configuration {
            problem: &self.problem,
            mesh: &self.mesh,
            constraints,
            bodies: &self.equations,
            mean_flow: self.problem.mean_flow_at(self.time()),
        }
    }
}

//! `CasePoint`: a case with some numbers changed, on the mesh of the case itself.

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use super::error::GradientError;
use crate::algebra::AffineConstraints;
use crate::body::{MeshPoses, Pose};
use crate::case::{CaseFile, Model, Steady, TimeSettings};
use crate::coupling::{BodiesAt, BodyShapes, Configuration, Problem, RigidBodyEquations};
use crate::run::RunError;

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
    /// Of a problem on its mesh.
    pub fn new(
        file: CaseFile,
        problem: Problem<D>,
        mesh: Mesh<D>,
        shifts: &[Vector3<f64>],
    ) -> Result<Self, GradientError> {
        let TimeSettings::Steady(settings) = file.case().time.clone() else {
            return Err(GradientError::refused(
                &file,
                "time",
                "the flow of the case is not steady".to_owned(),
                "gradients are those of steady flows: write [time.steady]",
            ));
        };
        let poses: Vec<Pose> = problem.bodies.iter().map(|body| body.pose).collect();
        let in_mesh = MeshPoses::seen_from(&Vector3::zeros(), &poses, shifts);
        let shapes = BodyShapes::at(&problem.bodies, 0.0).map_err(RunError::from)?;
        let equations = RigidBodyEquations::steady(&problem, &poses, 0.0);
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
            mean_flow: self.problem.mean_flow_at(0.0),
        }
    }
}

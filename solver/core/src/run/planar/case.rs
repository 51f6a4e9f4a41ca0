//! What a planar or axisymmetric case says of meshes: domain, sizes, bodies, sheets.

use alewife_mesh::{
    CellId, Domain, Facet, Mesh, PlacedShape, Sizing, check_placement, estimate_cells, generate,
    generate_wrapped,
};
use nalgebra::Vector3;

use crate::body::Pose;
use crate::case::{Body, BoundaryCondition, Case, MeshFile, Model};
use crate::coupling::{Problem, ShapeError};
use crate::gait::WavingSheet;
use crate::motion::Limits;
use crate::motion::MotionSettings;
use crate::run::RunError;
use crate::run::build::{
    limits, motion_settings, rod_shape, shape_motion, sides_of_bodies, sizing,
};
use crate::run::start::check_cells;

/// What stays the same over all meshes of a run.
#[derive(Debug)]
pub(in crate::run) struct PlanarCase {
    /// The domain.
    pub domain: Domain,
    /// The wanted cell sizes.
    pub sizing: Sizing,
    /// When a mesh is replaced.
    pub limits: Limits,
    /// How the mesh moves.
    pub motion: MotionSettings,
    /// Whether each body deforms.
    pub deforms: Vec<bool>,
    /// Bodies that share a pivot.
    pub pivots: Vec<[usize; 2]>,
    /// The bodies at time zero.
    pub start_shapes: Vec<PlacedShape>,
    /// Their poses.
    pub start_poses: Vec<Pose>,
    /// Whether the mesh is one of a file, which is not made again.
    pub is_given: bool,
    /// Sides that wave, by name.
    sheets: Vec<(String, WavingSheet)>,
}

impl PlanarCase {
    /// That of a case and its problem.
    pub fn new(model: &Model, problem: &Problem<2>) -> Result<Self, RunError> {
        let case = &model.case;
        let sheets =
            case.boundary.keys().filter_map(|side| Some((side.clone(), waving_sheet(case, side)?)));
        Ok(Self {
            domain: case.mesh_domain(),
            sizing: sizing(case),
            limits: limits(case),
            is_given: case.given_mesh().is_some(),
            motion: motion_settings(model, problem),
            deforms: problem.bodies.iter().map(|body| body.shape.is_some()).collect(),
            pivots: problem.pairs_on_pivots(),
            start_shapes: placed_bodies(model)?,
            start_poses: problem.bodies.iter().map(|body| body.pose).collect(),
            sheets: sheets.collect(),
        })
    }

    /// The sheet that a side is, if it is one.
    pub fn sheet(&self, side: &str) -> Option<WavingSheet> {
        self.sheets.iter().find(|(name, _)| name == side).map(|(_, sheet)| *sheet)
    }
}

/// The mesh of a case at time zero, with its bodies as they are meshed.
pub(super) struct MeshedCase {
    /// The mesh.
    pub mesh: Mesh<2>,
    /// The bodies.
    pub shapes: Vec<PlacedShape>,
    /// Whole periods by which each has been moved (m).
    pub shifts: Vec<Vector3<f64>>,
}

impl MeshedCase {
    /// A mesh of a case from elsewhere, with bodies where they are.
    pub fn of(model: &Model, mesh: Mesh<2>) -> Result<Self, RunError> {
        let shapes = placed_bodies(model)?;
        let shifts = vec![Vector3::zeros(); shapes.len()];
        Ok(Self { mesh, shapes, shifts })
    }

    /// Generates the mesh of a case at time zero.
    pub fn generate(model: &Model) -> Result<Self, RunError> {
        let case = &model.case;
        if let Some(mesh) = case.given_mesh().and_then(MeshFile::planar) {
            return Self::of(model, mesh.with_bodies(&sides_of_bodies(model)));
        }
        let (domain, mut shapes, sizing) =
            (case.mesh_domain(), placed_bodies(model)?, sizing(case));
        check_cells::<2>(case.mesh.max_cells, |limit| {
            estimate_cells(&domain, &shapes, &sizing, limit)
        })?;
        let (mut mesh, shifts) = if check_placement(&domain, &shapes).is_ok() {
            (generate(&domain, &shapes, &sizing)?, vec![Vector3::zeros(); shapes.len()])
        } else {
            let shifts = move_into(&domain, &mut shapes);
            (generate_wrapped(&domain, &shapes, &sizing)?, shifts)
        };
        // The side of a sheet is straight at first, but will not stay so
        let is_waving =
            |facet: &&Facet| waving_sheet(case, &mesh.boundaries[facet.boundary].name).is_some();
        let waving: Vec<CellId> = mesh.facets.iter().filter(is_waving).map(|f| f.cell).collect();
        if !waving.is_empty() {
            let topology = mesh.topology_mut();
            waving.into_iter().for_each(|cell| topology.curved[cell] = true);
        }
        Ok(Self { mesh, shapes, shifts })
    }
}

/// Moves bodies by whole periods to where their centres are in the domain; gives how far (m).
pub(super) fn move_into(domain: &Domain, shapes: &mut [PlacedShape]) -> Vec<Vector3<f64>> {
    let into = |shape: &mut PlacedShape| {
        let shift = domain.shift_into(shape.center);
        shape.center += shift;
        Vector3::new(shift.x, shift.y, 0.0)
    };
    shapes.iter_mut().map(into).collect()
}

/// The sheet that a side of the domain is, if it is one.
fn waving_sheet(case: &Case, side: &str) -> Option<WavingSheet> {
    match case.boundary.get(side) {
        Some(&BoundaryCondition::WavingSheet { amplitude, wavelength, period, extensible }) => {
            Some(WavingSheet::new(amplitude, wavelength, period, extensible))
        }
        _ => None,
    }
}

/// The bodies of a case as they are meshed at time zero.
pub(super) fn placed_bodies(model: &Model) -> Result<Vec<PlacedShape>, RunError> {
    let placed = |body: &Body| {
        let mut placed = body.placed(model.case.mesh.scale);
        let rod = rod_shape(&model.case, body)?;
        if let Some(motion) =
            rod.map_or_else(|| shape_motion(body, model.case.geometry), |rod| Ok(Some(rod)))?
        {
            let start = motion.at(0.0);
            let start = start.map_err(|reason| ShapeError { body: body.name.clone(), reason })?;
            if let Some(shape) = start.shape() {
                placed.shape = shape;
            }
        }
        Ok(placed)
    };
    model.bodies.iter().map(placed).collect()
}

//! What a planar or axisymmetric case says of meshes: domain, sizes, bodies, sheets.

use alewife_mesh::{CellId, Domain, Facet, Mesh, PlacedShape, Sizing, estimate_cells};

use super::periodic_cell::{PeriodicCell, initial_cell};
use crate::body::Pose;
use crate::case::{Body, BoundaryCondition, Case, MeshFile, Model};
use crate::coupling::{Problem, ShapeError};
use crate::gait::WavingSheet;
use crate::motion::Limits;
use crate::motion::MotionSettings;
use crate::run::RunError;
use crate::run::build::{limits, motion_settings, shape_motion, sizing};
use crate::run::start::check_cells;

/// What stays the same over all meshes of a run.
#[derive(Debug)]
pub(in crate::run) struct PlanarCase {
    /// The domain as it was at first.
    pub home: Domain,
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
            home: case.mesh_domain(),
            sizing: sizing(case),
            limits: limits(case),
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

/// The mesh of a case at time zero, with its domain and bodies as they are meshed.
pub(super) struct MeshedCell {
    /// The mesh.
    pub mesh: Mesh<2>,
    /// Domain and bodies.
    pub cell: PeriodicCell,
}

impl MeshedCell {
    /// A mesh of a case from elsewhere, its domain not cut open.
    pub fn of(model: &Model, mesh: Mesh<2>) -> Result<Self, RunError> {
        let shapes = placed_bodies(model)?;
        Ok(Self { mesh, cell: PeriodicCell::whole(&model.case.mesh_domain(), shapes) })
    }

    /// Generates the mesh of a case at time zero.
    pub fn generate(model: &Model) -> Result<Self, RunError> {
        let case = &model.case;
        if let Some(mesh) = case.given_mesh().and_then(MeshFile::planar) {
            return Self::of(model, mesh.clone());
        }
        let (domain, bodies, sizing) = (case.mesh_domain(), placed_bodies(model)?, sizing(case));
        check_cells::<2>(|limit| estimate_cells(&domain, &bodies, &sizing, limit))?;
        let cell = initial_cell(&domain, bodies)?;
        let mut mesh = cell.mesh(&sizing)?;
        // The side of a sheet is straight at first, but will not stay so
        let is_waving =
            |facet: &&Facet| waving_sheet(case, &mesh.boundaries[facet.boundary].name).is_some();
        let waving: Vec<CellId> = mesh.facets.iter().filter(is_waving).map(|f| f.cell).collect();
        if !waving.is_empty() {
            let topology = mesh.topology_mut();
            waving.into_iter().for_each(|cell| topology.curved[cell] = true);
        }
        Ok(Self { mesh, cell })
    }
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
fn placed_bodies(model: &Model) -> Result<Vec<PlacedShape>, RunError> {
    let placed = |body: &Body| {
        let mut placed = body.placed(model.case.mesh.scale);
        if let Some(motion) = shape_motion(body, model.case.geometry)? {
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

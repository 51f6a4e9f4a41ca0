//! `Solid`: an elastic body of simplices with its materials, active fibres and what is held.

use std::sync::Arc;

use alewife_mesh::Point;
use nalgebra::Vector3;

use super::SolidError;
use super::cholesky::Cholesky;
use super::geometry::CellPoints;
use super::mass::Mass;
use super::mesh::{Frame, Order};
use super::mixed::pressures::Pressures;
use super::pattern::{Cells, Pattern};
use super::rigid::ties::Ties;
use super::spec::{RigidPart, SolidSpec, exists};
use crate::material::{Lame, Law, Material, MaterialError, Tensor};

/// Fibres in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct FibreIn {
    /// The set they belong to.
    pub set: usize,
    /// Their direction, a unit vector.
    pub direction: Vector3<f64>,
}

/// An elastic body in D dimensions, ready to be computed. A state of it is the places of its nodes (m), node
/// after node, D numbers each, and behind them the pressures (Pa) of cells that keep their volume.
#[derive(Debug, Clone)]
pub struct Solid<const D: usize> {
    pub(super) spec: SolidSpec<D>,
    pub(super) lame: Vec<Lame>,
    pub(super) points: CellPoints<D>,
    pub(super) mass: Mass<D>,
    pub(super) pressures: Pressures,
    pub(super) ties: Ties,
    /// Fibres of each cell.
    pub(super) fibres_in: Vec<Vec<FibreIn>>,
    pub(super) pattern: Arc<Pattern>,
    pub(super) cholesky: Arc<Cholesky>,
}

impl<const D: usize> Solid<D> {
    /// Checks and prepares a solid.
    ///
    /// # Errors
    /// [`SolidError`] for what does not fit together.
    pub fn new(mut spec: SolidSpec<D>) -> Result<Self, SolidError> {
        if (D == 3) != (spec.frame == Frame::Space) || !(2..=3).contains(&D) {
            return Err(SolidError::Frame(D));
        }
        let (n_cells, n_nodes) = (spec.mesh.n_cells(), spec.mesh.nodes.len());
        for material in &spec.materials {
            material.check()?;
        }
        let materials = spec.material_of.iter().copied().chain([0]);
        for material in materials {
            exists("material", material, spec.materials.len())?;
        }
        if !spec.material_of.is_empty() && spec.material_of.len() != n_cells {
            return Err(SolidError::Length {
                what: "materials of cells",
                found: spec.material_of.len(),
                expected: n_cells,
            });
        }
        for node in &spec.mesh.cells {
            exists("node", *node, n_nodes)?;
        }
        let points = CellPoints::new(&spec.mesh, spec.frame)?;
        let mut lame: Vec<Lame> = spec.materials.iter().map(Material::lame).collect();
        let ties = stiffen(&mut spec, &mut lame)?;
        let held = spec.held_components()?;
        let pressures = pressures(&spec, &held, &ties)?;
        let cells = Cells::<D> {
            nodes: &spec.mesh.cells,
            n_local: points.n_local,
            pressures: &pressures,
            ties: &ties,
        };
        let pattern = Pattern::new(&cells, &held);
        if pattern.n_places == 0 {
            return Err(SolidError::AllHeld);
        }
        let density = |cell: usize| spec.material_of_cell(cell).density;
        let mass = Mass::new(&spec.mesh, &points, density, &pattern);
        let cholesky = Cholesky::new(&pattern)?;
        Ok(Self {
            lame,
            fibres_in: fibres_in(&spec)?,
            points,
            mass,
            pressures,
            ties,
            pattern: Arc::new(pattern),
            cholesky: Arc::new(cholesky),
            spec,
        })
    }

    /// What it was made from.
    #[must_use]
    pub fn spec(&self) -> &SolidSpec<D> {
        &self.spec
    }

    /// The same solid with the mean volume for each cell and the mass of one cell for each node, in place of
    /// their own: **no discretisation of the body**, but what published moduli were found with (@du2021), whose
    /// code does so with cells of different sizes. For linear cells; derivatives by the shape are not those of it.
    #[must_use]
    pub fn with_equal_cells(mut self) -> Self {
        if self.spec.mesh.order == Order::Quadratic {
            return self;
        }
        let mean = self.volume() / self.spec.mesh.n_cells() as f64;
        let each = mean / self.points.n_points as f64;
        self.points.weights.fill(each);
        let density = self.spec.materials[0].density;
        self.mass.fill(density * mean);
        self
    }

    /// Gives a material other moduli, with the mesh and all that follows from it kept; its density stays.
    ///
    /// # Errors
    /// [`SolidError::Material`] and [`SolidError::Missing`].
    pub fn set_moduli(
        &mut self,
        number: usize,
        young: f64,
        poisson: f64,
    ) -> Result<(), SolidError> {
        exists("material", number, self.spec.materials.len())?;
        let own = self.spec.materials[number];
        let material = Material { young, poisson, ..own };
        material.check()?;
        if material.is_incompressible() != own.is_incompressible() {
            // It has other unknowns
            return Err(MaterialError::Poisson(poisson).into());
        }
        self.spec.materials[number] = material;
        self.lame[number] = material.lame();
        Ok(())
    }

    /// Gives a set of fibres another stiffness (Pa).
    ///
    /// # Errors
    /// [`SolidError::Missing`].
    pub fn set_fibre_stiffness(&mut self, set: usize, stiffness: f64) -> Result<(), SolidError> {
        exists("set of fibres", set, self.spec.fibres.len())?;
        self.spec.fibres[set].stiffness = stiffness;
        Ok(())
    }

    /// The state at rest: places of all nodes, and no pressures.
    #[must_use]
    pub fn at_rest(&self) -> Vec<f64> {
        self.with_pressures(|node| self.spec.mesh.nodes[node])
    }

    /// A list of all components with values at the nodes; pressures are 0.
    fn with_pressures(&self, value: impl Fn(usize) -> Point<D>) -> Vec<f64> {
        let n_nodes = self.spec.mesh.nodes.len();
        let mut all: Vec<f64> =
            (0..n_nodes).flat_map(|node| value(node).iter().copied().collect::<Vec<_>>()).collect();
        all.resize(self.n_components(), 0.0);
        all
    }

    /// Number of components: D for each node, and the pressures.
    #[must_use]
    pub fn n_components(&self) -> usize {
        self.n_places() + self.pressures.count()
    }

    /// Number of components that are places: D for each node.
    #[must_use]
    pub fn n_places(&self) -> usize {
        D * self.spec.mesh.nodes.len()
    }

    /// Nodes at which there are pressures, in the order of their components: vertices of cells that keep their
    /// volume, once for each material.
    #[must_use]
    pub fn pressure_nodes(&self) -> &[usize] {
        &self.pressures.nodes
    }

    /// The components that are held, ascending; those of rigid parts are not.
    #[must_use]
    pub fn held(&self) -> Vec<usize> {
        let mut is_free = vec![false; self.n_components()];
        for node in self.ties.parts.iter().flatten() {
            is_free[D * node..D * node + D.min(self.ties.n_each)].fill(true);
        }
        for component in &self.pattern.components {
            is_free[*component] = true;
        }
        (0..is_free.len()).filter(|component| !is_free[*component]).collect()
    }

    /// Number of components that are free.
    #[must_use]
    pub fn n_unknowns(&self) -> usize {
        self.pattern.n_unknowns()
    }

    /// Mass times the velocities or accelerations of all nodes.
    #[must_use]
    pub fn times_mass(&self, all: &[f64]) -> Vec<f64> {
        self.mass.times(all)
    }

    /// Forces (N) of an acceleration (m/s2) that is the same everywhere, as of gravity.
    #[must_use]
    pub fn weight(&self, acceleration: Point<D>) -> Vec<f64> {
        self.mass.times(&self.with_pressures(|_| acceleration))
    }

    /// Volume at rest (m3; per length in the plane).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.points.weights.iter().sum()
    }

    /// The material of a cell.
    pub(super) fn material_of(&self, cell: usize) -> usize {
        self.spec.material_of.get(cell).copied().unwrap_or(0)
    }

    /// Nodes of a cell.
    pub(super) fn nodes_of(&self, cell: usize) -> &[usize] {
        let n = self.points.n_local;
        &self.spec.mesh.cells[cell * n..(cell + 1) * n]
    }

    /// Values of all components at the nodes of a cell.
    pub(super) fn gather<'a>(
        &self,
        cell: usize,
        all: &[f64],
        local: &'a mut [Point<D>],
    ) -> &'a [Point<D>] {
        let nodes = self.nodes_of(cell);
        for (value, node) in local.iter_mut().zip(nodes) {
            *value = Point::<D>::from_column_slice(&all[node * D..node * D + D]);
        }
        &local[..nodes.len()]
    }

    /// Strains of a state by point, for instance of a level before.
    pub(super) fn deformations(&self, places: &[f64]) -> Vec<Tensor> {
        let mut all = Vec::with_capacity(self.points.weights.len());
        let mut local = [Point::<D>::zeros(); super::geometry::MAX_NODES];
        for cell in 0..self.spec.mesh.n_cells() {
            let local = self.gather(cell, places, &mut local);
            all.extend(
                (0..self.points.n_points).map(|k| self.points.at(cell, k).deformation(local)),
            );
        }
        all
    }
}

/// Makes parts rigid: each becomes a material without elasticity.
fn stiffen<const D: usize>(
    spec: &mut SolidSpec<D>,
    lame: &mut Vec<Lame>,
) -> Result<Ties, SolidError> {
    let parts: Vec<Vec<usize>> = spec.rigid.iter().map(|part| part.cells.clone()).collect();
    let ties = Ties::new(&parts, &spec.mesh, spec.frame)?;
    let tied = spec.held.iter().find_map(|component| ties.part_of(component / D));
    if let Some(part) = tied {
        return Err(SolidError::RigidHeld(part));
    }
    if !ties.is_empty() && spec.material_of.is_empty() {
        spec.material_of = vec![0; spec.mesh.n_cells()];
    }
    for RigidPart { cells, density } in &spec.rigid {
        // Moduli that do not count
        let material = Material {
            law: Law::NeoHookean,
            young: 1.0,
            poisson: 0.0,
            density: *density,
            viscosity: 0.0,
        };
        material.check()?;
        cells.iter().for_each(|cell| spec.material_of[*cell] = spec.materials.len());
        spec.materials.push(material);
        lame.push(Lame { shear: 0.0, volume: 0.0 });
    }
    Ok(ties)
}

/// The pressures of cells that keep their volume. A cell whose nodes are all held, or all of one rigid part, does so by
/// itself: nothing would determine its pressures.
fn pressures<const D: usize>(
    spec: &SolidSpec<D>,
    held: &[bool],
    ties: &Ties,
) -> Result<Pressures, SolidError> {
    let n_local = spec.mesh.n_local();
    let is_fixed = |nodes: &[usize]| {
        let part = ties.part_of(nodes[0]);
        let is_held = |node: &usize| held[D * node..D * node + D].iter().all(|held| *held);
        nodes.iter().all(is_held)
            || (part.is_some() && nodes.iter().all(|node| ties.part_of(*node) == part))
    };
    let cells = spec.mesh.cells.chunks_exact(n_local).enumerate().map(|(cell, nodes)| {
        let number = spec.material_of.get(cell).copied().unwrap_or(0);
        let is_kept = spec.materials[number].is_incompressible();
        ((is_kept && !is_fixed(nodes)).then_some(number), &nodes[..=D])
    });
    let pressures = Pressures::new(cells, D * spec.mesh.nodes.len());
    if pressures.count() > 0 && spec.mesh.order == Order::Linear {
        return Err(SolidError::LinearVolume);
    }
    Ok(pressures)
}

/// Fibres by cell.
fn fibres_in<const D: usize>(spec: &SolidSpec<D>) -> Result<Vec<Vec<FibreIn>>, SolidError> {
    let mut all = vec![Vec::new(); spec.mesh.n_cells()];
    for (set, fibres) in spec.fibres.iter().enumerate() {
        if fibres.cells.len() != fibres.directions.len() {
            return Err(SolidError::Length {
                what: "directions of fibres",
                found: fibres.directions.len(),
                expected: fibres.cells.len(),
            });
        }
        for (cell, direction) in fibres.cells.iter().zip(&fibres.directions) {
            exists("cell", *cell, all.len())?;
            let length = direction.norm();
            if !(length > 0.0 && length.is_finite()) {
                return Err(SolidError::Direction(*cell));
            }
            if !spec.rigid.iter().any(|part| part.cells.contains(cell)) {
                all[*cell].push(FibreIn { set, direction: direction / length });
            }
        }
    }
    Ok(all)
}

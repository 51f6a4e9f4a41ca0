//! `MeshMotion`: displacements of all nodes from those of the bodies, by an elliptic equation.
//!
//! Displacements are measured from a reference configuration, the mesh at its last remesh, on
//! which the matrix lives: it is factorised once, and a move costs a back-substitution. The same
//! boundary gives the same mesh whatever the way there, so a body that returns brings its mesh back.

use alewife_mesh::{Mesh, Point};

use super::hold::{HeldVertices, Hold, MotionError};
use super::stiffness::{MotionKind, Stiffness};
use crate::algebra::{AffineConstraints, Cholesky};

/// A factorised matrix for some of the components.
#[derive(Debug)]
struct System {
    /// Components it solves for: together (elastic), or one after the other by one matrix.
    axes: Vec<usize>,
    constraints: AffineConstraints,
    cholesky: Cholesky,
}

/// Moves a mesh after its boundary.
#[derive(Debug)]
pub struct MeshMotion {
    /// Places of all nodes in the reference configuration (m).
    reference: Vec<Point<2>>,
    held: HeldVertices,
    stiffness: Stiffness,
    systems: Vec<System>,
    /// Mid nodes with the ends of their edges.
    middles: Vec<[u32; 3]>,
    /// Mid nodes on curved boundaries that are carried, with these.
    carried: Vec<(u32, u16)>,
}

impl MeshMotion {
    /// Takes a mesh as the reference configuration and factorises the matrix of its motion.
    ///
    /// `holds` has one entry a boundary; [`super::holds`] gives the usual ones.
    ///
    /// # Errors
    /// When `holds` does not fit the mesh, or the matrix cannot be factorised.
    pub fn new(mesh: &Mesh<2>, kind: MotionKind, holds: &[Hold]) -> Result<Self, MotionError> {
        let held = HeldVertices::new(mesh, holds)?;
        let stiffness = Stiffness::new(mesh, kind, held.given.iter().map(|(vertex, _)| *vertex));
        let groups: Vec<Vec<usize>> = if stiffness.n_components == 2 || held.holds_both_alike() {
            vec![vec![0, 1]]
        } else {
            vec![vec![0], vec![1]]
        };
        let mut systems = Vec::new();
        for axes in groups {
            let constraints = held.constraints(&axes[..stiffness.n_components.min(axes.len())]);
            let (pattern, values) = stiffness.reduce::<2>(&constraints);
            let cholesky = Cholesky::factorise(&pattern, &values)?;
            systems.push(System { axes, constraints, cholesky });
        }
        let (middles, carried) = mid_nodes(mesh, holds);
        let reference = mesh.nodes.clone();
        Ok(Self { reference, held, stiffness, systems, middles, carried })
    }

    /// Displacements (m) of all nodes from the reference configuration.
    ///
    /// `given(boundary, place)` is the displacement of the point of a carried boundary that was at
    /// `place` in the reference configuration. Mid nodes of straight edges stay in the middle of
    /// their ends; those of curved edges are carried themselves, so that rigid bodies keep their
    /// exact shape.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn displacements(
        &self,
        given: &dyn Fn(usize, &Point<2>) -> Point<2>,
    ) -> Result<Vec<Point<2>>, MotionError> {
        let mut moved = self.held.displacements(&self.reference, given);
        let boundary = moved.clone();
        for system in &self.systems {
            self.solve(system, &boundary, &mut moved)?;
        }
        moved.resize(self.reference.len(), Point::<2>::zeros());
        for &[middle, from, to] in &self.middles {
            moved[middle as usize] = (moved[from as usize] + moved[to as usize]) * 0.5;
        }
        for &(node, side) in &self.carried {
            moved[node as usize] = given(usize::from(side), &self.reference[node as usize]);
        }
        Ok(moved)
    }

    /// Overwrites the places of the nodes of a mesh with the same cells (m).
    ///
    /// # Errors
    /// Those of [`Self::displacements`]; the mesh is then as it was.
    pub fn place(
        &self,
        mesh: &mut Mesh<2>,
        given: &dyn Fn(usize, &Point<2>) -> Point<2>,
    ) -> Result<(), MotionError> {
        let moved = self.displacements(given)?;
        for ((node, reference), moved) in mesh.nodes.iter_mut().zip(&self.reference).zip(&moved) {
            *node = reference + moved;
        }
        Ok(())
    }

    /// Places of the nodes in the reference configuration (m).
    #[must_use]
    pub fn reference(&self) -> &[Point<2>] {
        &self.reference
    }

    /// Entries of the factors, for estimates of memory.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.systems.iter().map(|system| system.cholesky.n_entries()).sum()
    }

    fn solve(
        &self,
        system: &System,
        boundary: &[Point<2>],
        moved: &mut [Point<2>],
    ) -> Result<(), MotionError> {
        let n = self.stiffness.n_components;
        // The right-hand sides of one factor: both components as one vector, or one each
        let sides: Vec<&[usize]> = system.axes.chunks(n).collect();
        let raw = |axes: &[usize]| -> Vec<f64> {
            boundary.iter().flat_map(|place| axes.iter().map(|&axis| place[axis])).collect()
        };
        let mut load = Vec::with_capacity(system.constraints.n_unknowns() * sides.len());
        for axes in &sides {
            load.extend(self.stiffness.load(&system.constraints, &raw(axes)));
        }
        system.cholesky.solve(&mut load)?;
        let n_unknowns = system.constraints.n_unknowns();
        for (nth, axes) in sides.iter().enumerate() {
            let free = &load[nth * n_unknowns..(nth + 1) * n_unknowns];
            let inside = system.constraints.expand(free);
            for (vertex, place) in moved.iter_mut().enumerate() {
                for (position, &axis) in axes.iter().enumerate() {
                    // Held values are not among the unknowns: one of the two terms is zero
                    place[axis] = boundary[vertex][axis] + inside[vertex * n + position];
                }
            }
        }
        Ok(())
    }
}

/// Mid nodes with the ends of their edges, and those carried by a curved boundary.
fn mid_nodes(mesh: &Mesh<2>, holds: &[Hold]) -> (Vec<[u32; 3]>, Vec<(u32, u16)>) {
    let mut carried = Vec::new();
    let mut is_done = vec![false; mesh.n_nodes()];
    for facet in &mesh.facets {
        let is_carried = holds[usize::from(facet.boundary)] == Hold::Given;
        if is_carried && mesh.curved[facet.cell as usize] {
            let middle = mesh.facet_nodes(facet)[2];
            carried.push((middle, facet.boundary));
            is_done[middle as usize] = true;
        }
    }
    let mut middles = Vec::new();
    for cell in 0..mesh.n_cells() {
        let nodes = mesh.cell(cell);
        for side in 0..3 {
            let middle = nodes[3 + side];
            if !std::mem::replace(&mut is_done[middle as usize], true) {
                middles.push([middle, nodes[side], nodes[(side + 1) % 3]]);
            }
        }
    }
    (middles, carried)
}

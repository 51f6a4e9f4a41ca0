//! `MeshMotion`: displacements of all nodes from those of the bodies, by an elliptic equation.
//!
//! Displacements are measured from a reference configuration, the mesh at its last remesh, on
//! which the matrix lives: it is factorised once, and a move costs a back-substitution. The same
//! boundary gives the same mesh whatever the way there, so a body that returns brings its mesh back.

use alewife_mesh::{BoundaryId, Mesh, NodeId, Point, Simplex};

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
    /// Nodes inside straight edges.
    inner: Vec<InnerNode>,
    /// Inner nodes on curved boundaries that are carried, with these.
    carried: Vec<(NodeId, BoundaryId)>,
}

/// A node inside a straight edge.
#[derive(Debug, Clone, Copy)]
struct InnerNode {
    node: NodeId,
    ends: [NodeId; 2],
    /// Its place on the edge: 0 at the first end, 1 at the second.
    parameter: f64,
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
            let cholesky = Cholesky::factorise(&stiffness.reduce::<2>(&constraints))?;
            systems.push(System { axes, constraints, cholesky });
        }
        let (inner, carried) = inner_nodes(mesh, holds);
        let reference = mesh.nodes.clone();
        Ok(Self { reference, held, stiffness, systems, inner, carried })
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
        for &InnerNode { node, ends: [from, to], parameter } in &self.inner {
            moved[node] = moved[from] * (1.0 - parameter) + moved[to] * parameter;
        }
        for &(node, side) in &self.carried {
            moved[node] = given(side.index(), &self.reference[node]);
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

/// Inner nodes with their edges, and those carried by a curved boundary.
fn inner_nodes(mesh: &Mesh<2>, holds: &[Hold]) -> (Vec<InnerNode>, Vec<(NodeId, BoundaryId)>) {
    let mut carried = Vec::new();
    let mut is_done = vec![false; mesh.n_nodes()];
    for facet in &mesh.facets {
        if holds[facet.boundary] == Hold::Given && mesh.curved[facet.cell] {
            for node in mesh.facet_inner_nodes(facet) {
                carried.push((node, facet.boundary));
                is_done[node] = true;
            }
        }
    }
    let mut inner = Vec::new();
    for edge in mesh.cell_ids().flat_map(|cell| mesh.cell_edges(cell)) {
        for (&node, &parameter) in edge.inner.iter().zip(Simplex::<2>::EDGE_PARAMETERS) {
            if !std::mem::replace(&mut is_done[node], true) {
                inner.push(InnerNode { node, ends: edge.ends, parameter });
            }
        }
    }
    (inner, carried)
}

//! `MeshMotion`: displacements of all nodes from those of the boundary, by an elliptic equation.
//!
//! Displacements are measured from a reference configuration, the mesh at its last remesh, on
//! which the matrix lives: its solver is set up once. The mesh
//! depends on where its boundary is and not on its path, so a body that returns brings it back.

use alewife_mesh::{BoundaryId, Mesh, NodeId, PeriodicPair, Point, Simplex};

use super::boundary_condition::{
    ConstrainedVertices, MeshBoundaryCondition, MotionError, PrescribedDisplacement,
};
use super::stiffness::{MotionKind, Stiffness};
use crate::algebra::{AffineConstraints, EllipticSolver, NodalComponent};

/// Unknowns in space up to which factors cost less than iterations.
const FACTORISED_IN_SPACE: usize = 3000;

/// What solves for some of the components.
#[derive(Debug)]
struct System {
    /// Components it solves for: together (elastic), or one after the other by one matrix.
    axes: Vec<usize>,
    constraints: AffineConstraints,
    solver: EllipticSolver,
}

/// Moves the nodes of a mesh with its boundary.
#[derive(Debug)]
pub struct MeshMotion<const D: usize> {
    /// Positions of all nodes in the reference configuration (m).
    reference: Vec<Point<D>>,
    vertices: ConstrainedVertices<D>,
    stiffness: Stiffness,
    systems: Vec<System>,
    /// Inner nodes of edges that are interpolated between the ends.
    interpolated: Vec<EdgeNode>,
    /// Inner nodes of curved facets with a prescribed displacement, and their boundary.
    prescribed: Vec<BoundaryNode>,
    /// Periodic copies of those.
    carried: Vec<PeriodicPair>,
}

/// A node with the boundary that prescribes its displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct BoundaryNode {
    node: NodeId,
    boundary: BoundaryId,
}

/// An inner node of an edge.
#[derive(Debug, Clone, Copy)]
struct EdgeNode {
    node: NodeId,
    ends: [NodeId; 2],
    /// Where it is on the edge: 0 at the first end, 1 at the second.
    parameter: f64,
}

impl<const D: usize> MeshMotion<D> {
    /// Takes a mesh as the reference configuration and sets the solver of its motion up.
    ///
    /// `conditions` has one entry for each boundary; [`super::mesh_boundary_conditions`] gives the
    /// usual ones.
    ///
    /// # Errors
    /// When `conditions` does not fit the mesh, or the matrix cannot be factorised.
    pub fn new(
        mesh: &Mesh<D>,
        kind: MotionKind,
        conditions: &[MeshBoundaryCondition],
    ) -> Result<Self, MotionError> {
        let vertices = ConstrainedVertices::new(mesh, conditions)?;
        let surface = vertices.prescribed.iter().map(|(vertex, _)| *vertex);
        let stiffness = Stiffness::new(mesh, kind, surface);
        let groups = if stiffness.n_components == D {
            vec![(0..D).collect()]
        } else {
            vertices.equal_components()
        };
        let mut systems = Vec::new();
        for axes in groups {
            let constraints = vertices.constraints(&axes[..stiffness.n_components.min(axes.len())]);
            let matrix = stiffness.reduce::<D>(&constraints);
            let solver = if D == 3 && matrix.n() > FACTORISED_IN_SPACE {
                let unknowns = nodal_components(&constraints, stiffness.n_components);
                EllipticSolver::iterative(matrix, &unknowns)
            } else {
                EllipticSolver::factorised(&matrix)?
            };
            systems.push(System { axes, constraints, solver });
        }
        let prescribed = curved_facet_nodes(mesh, conditions);
        let interpolated = edge_nodes(mesh, &prescribed);
        let is_prescribed =
            |node: NodeId| prescribed.binary_search_by_key(&node, |known| known.node).is_ok();
        let carried = mesh.periodic.iter().copied();
        let carried = carried
            .filter(|pair| is_prescribed(pair.original) && !is_prescribed(pair.copy))
            .collect();
        let reference = mesh.nodes.clone();
        Ok(Self { reference, vertices, stiffness, systems, interpolated, prescribed, carried })
    }

    /// Displacements (m) of all nodes from the reference configuration.
    ///
    /// Inner nodes of edges keep their part of the way between the ends; those of curved facets of
    /// boundaries with a prescribed displacement take it, so that rigid bodies keep their exact
    /// shape.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn displacements(
        &self,
        prescribed: &PrescribedDisplacement<'_, D>,
    ) -> Result<Vec<Point<D>>, MotionError> {
        let boundary = self.vertices.displacements(&self.reference, prescribed);
        let mut displacements = boundary.clone();
        for system in &self.systems {
            self.solve(system, &boundary, &mut displacements)?;
        }
        displacements.resize(self.reference.len(), Point::zeros());
        for &EdgeNode { node, ends: [from, to], parameter } in &self.interpolated {
            displacements[node] =
                displacements[from] * (1.0 - parameter) + displacements[to] * parameter;
        }
        for &BoundaryNode { node, boundary } in &self.prescribed {
            displacements[node] = prescribed(boundary, node, &self.reference[node]);
        }
        for PeriodicPair { copy, original } in &self.carried {
            displacements[*copy] = displacements[*original];
        }
        Ok(displacements)
    }

    /// Moves the nodes of a mesh with the cells of the reference configuration.
    ///
    /// # Errors
    /// Those of [`Self::displacements`]; the mesh is then as it was.
    pub fn move_nodes(
        &self,
        mesh: &mut Mesh<D>,
        prescribed: &PrescribedDisplacement<'_, D>,
    ) -> Result<(), MotionError> {
        let displacements = self.displacements(prescribed)?;
        let moved = self.reference.iter().zip(&displacements);
        for (node, (reference, displacement)) in mesh.nodes.iter_mut().zip(moved) {
            *node = reference + displacement;
        }
        Ok(())
    }

    /// Positions of the nodes in the reference configuration (m).
    #[must_use]
    pub fn reference(&self) -> &[Point<D>] {
        &self.reference
    }

    /// Entries of factors or matrices, for estimates of memory.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.systems.iter().map(|system| system.solver.n_entries()).sum()
    }

    fn solve(
        &self,
        system: &System,
        boundary: &[Point<D>],
        displacements: &mut [Point<D>],
    ) -> Result<(), MotionError> {
        let n = self.stiffness.n_components;
        // The right-hand sides of one factor: all components as one vector, or one each
        let sides: Vec<&[usize]> = system.axes.chunks(n).collect();
        let raw = |axes: &[usize]| -> Vec<f64> {
            boundary.iter().flat_map(|known| axes.iter().map(|&axis| known[axis])).collect()
        };
        let n_unknowns = system.constraints.n_unknowns();
        let mut load = Vec::with_capacity(n_unknowns * sides.len());
        for axes in &sides {
            load.extend(self.stiffness.load(&system.constraints, &raw(axes)));
        }
        system.solver.solve(&mut load)?;
        for (nth, axes) in sides.iter().enumerate() {
            let free = &load[nth * n_unknowns..(nth + 1) * n_unknowns];
            let inside = system.constraints.expand(free);
            for (vertex, displacement) in displacements.iter_mut().enumerate() {
                for (position, &axis) in axes.iter().enumerate() {
                    // Known values are not among the unknowns: one of the two terms is zero
                    displacement[axis] = boundary[vertex][axis] + inside[vertex * n + position];
                }
            }
        }
        Ok(())
    }
}

/// Inner nodes of curved facets with a prescribed displacement and the boundary that prescribes
/// it, sorted.
fn curved_facet_nodes<const D: usize>(
    mesh: &Mesh<D>,
    conditions: &[MeshBoundaryCondition],
) -> Vec<BoundaryNode> {
    let mut nodes: Vec<_> = mesh
        .facets
        .iter()
        .filter(|facet| {
            let condition = conditions[facet.boundary];
            condition == MeshBoundaryCondition::Prescribed && mesh.curved[facet.cell]
        })
        .flat_map(|facet| {
            let boundary = facet.boundary;
            mesh.facet_inner_nodes(facet).map(move |node| BoundaryNode { node, boundary })
        })
        .collect();
    nodes.sort_unstable();
    nodes.dedup_by_key(|at| at.node);
    nodes
}

/// Vertex and component of each unknown, with so many components a vertex.
fn nodal_components(constraints: &AffineConstraints, n: usize) -> Vec<NodalComponent> {
    let first = NodalComponent { node: 0, component: 0 };
    let mut places = vec![first; constraints.n_unknowns()];
    for raw in 0..constraints.n_raw() {
        if let Some(unknown) = constraints.unknown(raw) {
            let [node, component] = [raw / n, raw % n];
            places[unknown] = NodalComponent {
                node: u32::try_from(node).expect("indices of vertices take at most 32 bits"),
                component: u8::try_from(component).expect("a vertex has at most three components"),
            };
        }
    }
    places
}

/// Inner nodes of all edges but those whose displacement is prescribed.
fn edge_nodes<const D: usize>(mesh: &Mesh<D>, prescribed: &[BoundaryNode]) -> Vec<EdgeNode> {
    let mut is_known = vec![false; mesh.n_nodes()];
    for &BoundaryNode { node, .. } in prescribed {
        is_known[node] = true;
    }
    let mut nodes = Vec::new();
    for edge in mesh.cell_ids().flat_map(|cell| mesh.cell_edges(cell)) {
        for (&node, &parameter) in edge.inner.iter().zip(Simplex::<D>::EDGE_PARAMETERS) {
            if !std::mem::replace(&mut is_known[node], true) {
                nodes.push(EdgeNode { node, ends: edge.ends, parameter });
            }
        }
    }
    nodes
}

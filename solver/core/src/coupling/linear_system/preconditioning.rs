//! Data of mesh, fluid and constraints that the preconditioner of an iterative solver is made from.

use std::ops::Range;
use std::sync::Arc;

use alewife_mesh::{CellId, Mesh, NodeId, Simplex};

use super::wall_distance::wall_distances;
use crate::algebra::{
    AffineConstraints, CellFolds, CellMaps, ConstraintBuilder, Interpolation, Part, SaddlePoint,
    SparseMatrix, Term, Weights,
};
use crate::body::Modes;
use crate::flow::{LocalViscosity, for_each_cell};
use crate::space::{CellValues, DofLayout, Tables};

/// An index in 32 bits, as the linear algebra stores it.
fn index(index: usize) -> u32 {
    u32::try_from(index).expect("unknowns are fewer than four thousand million")
}

/// What walls at a distance d damp velocities by, over mu / d^2.
///
/// A gradient of pressure p drives a mean velocity of -g^2 / (12 mu) grad p through a film of width g, and d^2 / mu
/// has that mean. A third of it, because the mass matrix of the pressures adds its part to the inverse:
/// from a half to a fifth iterations are nearly the same, with all of it a sixth more.
const WALL_DRAG: f64 = 3.0;

/// The vertex whose pressure is held, because the equations leave a constant open.
fn held_pressure<const D: usize>(
    layout: &DofLayout<D>,
    constraints: &AffineConstraints,
) -> Option<NodeId> {
    layout.vertices().find(|&vertex| constraints.row(layout.pressure(vertex)).is_empty())
}

/// Velocities that stand for one body, and rates that do.
const MODES: [u8; 6] = [0, 1, 2, 3, 4, 5];

/// What each free unknown is, with these coordinates of each body.
pub(in super::super) fn saddle_point<const D: usize>(
    layout: &DofLayout<D>,
    constraints: &AffineConstraints,
    modes: Modes,
    coordinates: &[Range<usize>],
) -> SaddlePoint {
    let mut parts = vec![None; constraints.n_unknowns()];
    let mut set = |raw: usize, part: Part| {
        if let Some(unknown) = constraints.unknown(raw) {
            parts[unknown] = Some(part);
        }
    };
    let axes: [u8; 3] = [0, 1, 2];
    for node in layout.nodes() {
        for (axis, &component) in axes[..D].iter().enumerate() {
            let node_index = u32::from(node);
            set(layout.velocity(node, axis), Part::Velocity { node: node_index, component });
        }
    }
    for vertex in layout.vertices() {
        set(layout.pressure(vertex), Part::Pressure { node: u32::from(vertex) });
    }
    for body in 0..layout.n_bodies {
        for (position, mode) in modes.iter().enumerate() {
            let mode = u8::try_from(mode.index()).expect("a body has six modes");
            set(layout.rigid(body, position), Part::Rigid { body: index(body), mode });
        }
    }
    // Sixes of one body each: what no body couples is not coupled here either
    let mut body = layout.n_bodies;
    for own in coordinates {
        let own: Vec<usize> = own.clone().collect();
        for six in own.chunks(MODES.len()) {
            for (&coordinate, mode) in six.iter().zip(MODES) {
                set(layout.rate(coordinate), Part::Rate { body: index(body), mode });
            }
            body += 1;
        }
    }
    SaddlePoint {
        parts: parts.into_iter().flatten().collect(),
        has_held_pressure: held_pressure(layout, constraints).is_some(),
    }
}

/// What the numbers depend on, beside where the nodes are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Coefficients {
    /// Dynamic viscosity (Pa s), if it is the same everywhere.
    pub viscosity: f64,
    /// Density times the factor of the new velocity in its rate (kg/m^3/s), zero without inertia.
    pub inertia: f64,
    /// Whether the fluid is convected.
    pub has_convection: bool,
}

/// Spaces on a mesh, under constraints.
pub(in super::super) struct Discretised<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub layout: &'a DofLayout<D>,
    pub constraints: &'a AffineConstraints,
    pub tables: &'a Tables<D>,
    /// The viscosity where it is another one in each cell.
    pub local: Option<&'a LocalViscosity<'a, D>>,
}

impl<const D: usize> Discretised<'_, D> {
    /// The weights of a preconditioner.
    pub fn weights(&self, coefficients: Coefficients) -> Weights {
        let Coefficients { viscosity, inertia, has_convection } = coefficients;
        let (integrals, (interpolation, distances)) = rayon::join(
            || self.integrals(viscosity),
            || (self.interpolation(), self.wall_distances()),
        );
        let lumped_mass = self.restricted(&integrals.lumped_mass);
        let drag = |(node, distance): (usize, &f64)| {
            let viscous = match &integrals.viscous_mass {
                Some(viscous_mass) => WALL_DRAG * viscous_mass[node],
                None => integrals.lumped_mass[node] * WALL_DRAG * viscosity,
            };
            viscous / distance.powi(2)
        };
        let wall_drag: Vec<f64> = distances.iter().enumerate().map(drag).collect();
        let wall_drag = self.restricted(&wall_drag);
        let pressure_mass = integrals.pressure_mass;
        Weights { interpolation, pressure_mass, lumped_mass, wall_drag, inertia, has_convection }
    }

    /// Distance of each node to the nearest wall (m).
    fn wall_distances(&self) -> Vec<f64> {
        let Self { mesh, layout, constraints, .. } = self;
        let mut is_of_node = vec![false; constraints.n_unknowns()];
        let velocities = (0..layout.n_nodes * D).filter_map(|raw| constraints.unknown(raw));
        velocities.for_each(|unknown| is_of_node[unknown] = true);
        let is_held = |node: NodeId| {
            let mut terms = (0..D).flat_map(|axis| constraints.row(layout.velocity(node, axis)));
            terms.all(|term| !is_of_node[term.unknown as usize])
        };
        // Not a single node that is held because nothing else is
        let mut is_wall = vec![false; layout.n_nodes];
        for facet in &mesh.facets {
            if mesh.facet_nodes(facet).all(is_held) {
                mesh.facet_nodes(facet).for_each(|node| is_wall[node.index()] = true);
            }
        }
        wall_distances(mesh, |node| is_wall[node.index()])
    }

    /// Velocities on edges by those of the vertices at their ends, the others by themselves.
    fn interpolation(&self) -> Interpolation {
        let Self { mesh, layout, constraints, .. } = self;
        let itself = |unknown: usize| [Term { unknown: index(unknown), weight: 1.0 }];
        let mut interpolation = Interpolation::with_capacity(constraints.n_unknowns());
        let edges = edges_of_nodes(mesh);
        for node in layout.nodes() {
            for axis in 0..D {
                let Some(unknown) = constraints.unknown(layout.velocity(node, axis)) else {
                    continue;
                };
                match edges.get(node.index()).copied().flatten() {
                    None => interpolation.push(itself(unknown)),
                    Some(ends) => interpolation.push(ends.into_iter().flat_map(|end| {
                        let row = constraints.row(layout.velocity(end.vertex, axis));
                        row.iter()
                            .map(move |term| Term { weight: term.weight * end.weight, ..*term })
                    })),
                }
            }
        }
        // Pressures, which the transfer leaves out, and rigid velocities
        let others = layout.n_nodes * D..layout.n_raw();
        for unknown in others.filter_map(|raw| constraints.unknown(raw)) {
            interpolation.push(itself(unknown));
        }
        interpolation
    }

    /// The mass matrix of the pressures over twice the viscosity (Pa s), or over twice its mean in each cell, the held
    /// pressure last, and the lumped mass of the velocities at the nodes.
    ///
    /// Lumped masses are the diagonal of the mass matrix of a cell, scaled to its volume: row sums are
    /// not positive for quadratic elements (@hinton1976).
    fn integrals(&self, viscosity: f64) -> Integrals {
        let Self { mesh, layout, tables, local, .. } = self;
        let PressureCells { folds, constraints } = self.pressure_cells();
        let maps = CellMaps::new(&folds.unknowns(&constraints), |_, _| true);
        let mut values = vec![0.0; maps.pattern().n_entries()];
        let mut lumped_mass = vec![0.0; layout.n_nodes];
        let mut viscous_mass = local.map(|_| vec![0.0; layout.n_nodes]);
        let mut folded = vec![0.0; folds.largest_matrix()];
        let n_entries = (D + 1) * (D + 1);
        // Matrix, lumped masses, viscosity
        let size = n_entries + Simplex::<D>::N_NODES + 1;
        let compute = |cells: Range<usize>, integrals: &mut [f64]| {
            let mut workspace = CellValues::default();
            for (cell, of_cell) in cells.map(CellId::new).zip(integrals.chunks_exact_mut(size)) {
                of_cell.fill(0.0);
                let (own, of_cell) = of_cell.split_last_mut().expect("a cell has numbers");
                let (matrix, lumped) = of_cell.split_at_mut(n_entries);
                let mut volume = 0.0;
                *own = local.map_or(viscosity, |local| {
                    mean_viscosity(local, &mut workspace, tables, mesh, cell)
                });
                let factor = 1.0 / (2.0 * *own);
                workspace.for_each_point(tables, mesh, cell, |at| {
                    volume += at.dx;
                    for (square, phi) in lumped.iter_mut().zip(at.phi) {
                        *square += phi * phi * at.dx;
                    }
                    for (column, of_column) in at.psi.iter().zip(matrix.chunks_exact_mut(D + 1)) {
                        for (row, entry) in at.psi.iter().zip(of_column) {
                            *entry += factor * row * column * at.dx;
                        }
                    }
                });
                let scale = volume / lumped.iter().sum::<f64>();
                lumped.iter_mut().for_each(|mass| *mass *= scale);
            }
        };
        for_each_cell(mesh.n_cells(), size, compute, |cell, of_cell| {
            let (matrix, lumped) = of_cell.split_at(n_entries);
            for (&node, mass) in mesh.cell(CellId::new(cell)).iter().zip(lumped) {
                lumped_mass[node.index()] += mass;
                if let (Some(viscous_mass), [.., own]) = (&mut viscous_mass, lumped) {
                    viscous_mass[node.index()] += mass * own;
                }
            }
            if folds.is_folded(cell) {
                folds.fold(cell, &constraints, matrix, &mut folded);
                maps.scatter(cell, &folded, &mut values);
            } else {
                maps.scatter(cell, matrix, &mut values);
            }
        });
        let pressure_mass = SparseMatrix::new(Arc::clone(maps.pattern()), values);
        Integrals { pressure_mass, lumped_mass, viscous_mass }
    }

    /// The pressures of each cell, periodic copies folded to their originals.
    fn pressure_cells(&self) -> PressureCells {
        let Self { mesh, layout, constraints, .. } = self;
        let n = layout.n_vertices;
        let held = held_pressure(layout, constraints);
        // The held one after all others
        let place = |vertex: usize| match held.map(NodeId::index) {
            Some(held) if vertex == held => n - 1,
            Some(held) if vertex > held => vertex - 1,
            _ => vertex,
        };
        let mut builder = ConstraintBuilder::new(n);
        for pair in mesh.periodic.iter().filter(|pair| pair.copy.index() < n) {
            builder.equate(place(pair.copy.index()), place(pair.original.index()));
        }
        let vertices = mesh.cell_ids().flat_map(|cell| mesh.cell_vertices(cell));
        let raw = vertices.map(|vertex| index(place(vertex.index()))).collect();
        let constraints = builder.build();
        let folds = CellFolds::new(D + 1, raw, &constraints);
        PressureCells { folds, constraints }
    }

    /// Numbers of the nodes as numbers of the unknowns: what constrained velocities have goes to those they
    /// depend on.
    fn restricted(&self, of_nodes: &[f64]) -> Vec<f64> {
        let Self { layout, constraints, .. } = self;
        let mut values = vec![0.0; constraints.n_unknowns()];
        for node in layout.nodes() {
            for axis in 0..D {
                for term in constraints.row(layout.velocity(node, axis)) {
                    values[term.unknown as usize] +=
                        term.weight * term.weight * of_nodes[node.index()];
                }
            }
        }
        values
    }
}

/// Integrals of the bases over the mesh.
struct Integrals {
    pressure_mass: SparseMatrix,
    /// Of each node.
    lumped_mass: Vec<f64>,
    /// The same times the viscosities of the cells, where they have their own.
    viscous_mass: Option<Vec<f64>>,
}

/// The mean of a viscosity over a cell (Pa s).
fn mean_viscosity<const D: usize>(
    local: &LocalViscosity<'_, D>,
    workspace: &mut CellValues<D>,
    tables: &Tables<D>,
    mesh: &Mesh<D>,
    cell: CellId,
) -> f64 {
    let (mut sum, mut volume) = (0.0, 0.0);
    workspace.for_each_point(tables, mesh, cell, |at| {
        sum += local.value(tables.metric(), mesh.cell(cell), at) * at.dx;
        volume += at.dx;
    });
    sum / volume
}

/// Pressures of the cells, and which of them are equal.
struct PressureCells {
    folds: CellFolds,
    constraints: AffineConstraints,
}

/// A vertex at the end of an edge, and what its value counts at the node of the edge.
#[derive(Clone, Copy)]
struct EdgeEnd {
    vertex: NodeId,
    weight: f64,
}

/// The ends of the edge of each node, none of a vertex.
fn edges_of_nodes<const D: usize>(mesh: &Mesh<D>) -> Vec<Option<[EdgeEnd; 2]>> {
    let mut ends = vec![None; mesh.n_nodes()];
    for cell in mesh.cell_ids() {
        for edge in mesh.cell_edges(cell) {
            for (&node, parameter) in edge.inner.iter().zip(Simplex::<D>::EDGE_PARAMETERS) {
                let [vertex, other] = edge.ends;
                ends[node.index()] = Some([
                    EdgeEnd { vertex, weight: 1.0 - parameter },
                    EdgeEnd { vertex: other, weight: *parameter },
                ]);
            }
        }
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;
    use alewife_mesh::{Domain, Point, Sizing, generate};

    use crate::space::Metric;

    #[test]
    fn squares_of_distances_have_the_mean_mobility_of_a_film() {
        let (width, viscosity) = (0.2, 3.0);
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(0.3, width));
        let domain = Domain::Box { min, max, periodic_x: true, periodic_y: false };
        let mesh = &generate(&domain, &[], &Sizing::graded(0.01, 0.2, 0.01)).unwrap();
        let layout = &DofLayout::new(mesh, 0, 0);
        let mut builder = ConstraintBuilder::new(layout.n_raw());
        for node in mesh.facets.iter().flat_map(|facet| mesh.facet_nodes(facet)) {
            let is_on_wall = [0.0, width].iter().any(|y| (mesh.nodes[node][1] - y).abs() < 1e-12);
            (0..2)
                .filter(|_| is_on_wall)
                .for_each(|axis| builder.fix(layout.velocity(node, axis), 0.0));
        }
        let constraints = &builder.build();
        let tables = &Tables::new(Metric::Cartesian);
        let discretised = Discretised { mesh, layout, constraints, tables, local: None };
        let mass = discretised.integrals(0.5).lumped_mass;
        let distances = discretised.wall_distances();
        let sum: f64 = mass.iter().zip(&distances).map(|(mass, d)| mass * d * d / viscosity).sum();
        let mobility = sum / mass.iter().sum::<f64>();
        // Mean of y (g - y) / 2 mu
        let relative = mobility / (width * width / (12.0 * viscosity)) - 1.0;
        assert!(relative.abs() < 0.03, "{relative}");
    }
}

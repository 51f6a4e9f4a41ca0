//! `Drift`: the velocity fluid and bodies have together where nothing holds them.

use alewife_mesh::{Mesh, NodeId, Point};

use super::constrain::pinned_node;
use super::problem::Problem;
use super::system::Solution;
use crate::body::Twist;

/// Takes a common velocity out of fluid and bodies.
#[derive(Debug, Clone)]
pub(super) struct Drift {
    axes: [bool; 2],
    /// The node at which the system holds them.
    pinned: NodeId,
    /// Nodes of one side of each periodic pair, with the weights of their velocity in x and y of the
    /// mean velocity.
    weights: Vec<(NodeId, [Point<2>; 2])>,
}

impl Drift {
    /// What drifts in a problem on a mesh; `None` where all is held.
    pub fn new(problem: &Problem, mesh: &Mesh<2>) -> Option<Self> {
        let axes = problem.drifts();
        let pinned = axes.contains(&true).then(|| pinned_node(mesh))??;
        Some(Self { axes, pinned, weights: weights(mesh) })
    }

    /// The sum of loads along each axis that drifts must be zero: the first that is not, with its
    /// size (N).
    pub fn unbalanced(&self, external: &[[f64; 3]]) -> Option<(usize, f64)> {
        (0..2).filter(|&axis| self.axes[axis]).find_map(|axis| {
            let sum: f64 = external.iter().map(|load| load[axis]).sum();
            let size: f64 = external.iter().map(|load| load[axis].abs()).sum();
            (sum.abs() > 1e-9 * size).then_some((axis, sum))
        })
    }

    /// Moves with the node at which the system holds fluid and bodies.
    pub fn pin(&self, solution: &mut Solution) {
        let velocity = solution.velocity[self.pinned];
        self.subtract(velocity, solution);
    }

    /// Makes the mean velocity of fluid and bodies zero.
    pub fn center(&self, solution: &mut Solution) {
        let mean = self.weights.iter().fold(Point::<2>::zeros(), |sum, (node, weights)| {
            let velocity = &solution.velocity[*node];
            sum + Point::<2>::new(weights[0].dot(velocity), weights[1].dot(velocity))
        });
        self.subtract(mean, solution);
    }

    fn subtract(&self, velocity: Point<2>, solution: &mut Solution) {
        let off = [0, 1].map(|axis| if self.axes[axis] { velocity[axis] } else { 0.0 });
        for velocity in &mut solution.velocity {
            *velocity -= Point::<2>::from(off);
        }
        for twist in &mut solution.twists {
            let [x, y, turn] = twist.in_plane();
            *twist = Twist::planar([x - off[0], y - off[1], turn]);
        }
    }
}

/// The mean of a solenoidal velocity over fluid and bodies is the sum over periodic pairs of sides of
/// the way between them times the flux across, over the area: int u_i = int div(x_i u), in which
/// surfaces of bodies between fluid and body cancel.
fn weights(mesh: &Mesh<2>) -> Vec<(NodeId, [Point<2>; 2])> {
    let mut original = vec![None; mesh.n_nodes()];
    for pair in &mesh.periodic {
        original[pair.copy] = Some(pair.original);
    }
    let mut area = Point::<2>::zeros();
    let mut weights = Vec::new();
    for facet in &mesh.facets {
        let [a, b] = mesh.facet_vertices(facet);
        let Some(middle) = mesh.facet_inner_nodes(facet).next() else { continue };
        // Ends may be copies of the other pair, the middle is not
        let Some(of) = original[middle] else { continue };
        let way = mesh.nodes[middle] - mesh.nodes[of];
        let along = mesh.nodes[b] - mesh.nodes[a];
        let outward = Point::<2>::new(along.y, -along.x);
        for (node, part) in [(a, 1.0 / 6.0), (middle, 4.0 / 6.0), (b, 1.0 / 6.0)] {
            weights.push((node, [0, 1].map(|axis| outward * (part * way[axis]))));
        }
        area += way.component_mul(&outward);
    }
    for (_, weights) in &mut weights {
        for axis in 0..2 {
            weights[axis] /= if area[axis] == 0.0 { 1.0 } else { area[axis] };
        }
    }
    weights
}

//! Fields of one mesh evaluated at the nodes of another that covers the same region.

use alewife_mesh::{CellId, Locator, Mesh, NodeId, Point, shape_functions};
use rayon::prelude::*;

use crate::space::{CellValues, Tables};

/// Barycentric coordinates down to this are extrapolated; farther outside they are clamped to it.
const EXTRAPOLATION: f64 = -0.1;

/// Nodes a thread takes at a time.
const NODES_PER_TASK: usize = 1024;

/// How a node of the new mesh lies in the old one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Landing {
    /// In a cell, or outside by rounding.
    Inside,
    /// Outside, where the field of the nearest cell is extrapolated: two quadratic approximations
    /// of one curved boundary differ by their fourth-order error.
    Extrapolated,
    /// Farther outside than a tenth of the nearest cell: extrapolated up to there only.
    Clamped,
}

/// Where a node of the new mesh takes its values.
#[derive(Debug, Clone, Copy)]
struct Source {
    cell: CellId,
    at: [f64; 2],
    landing: Landing,
    /// Distance outside the old mesh (m).
    distance: f64,
}

/// What a node has before it is found.
const NOWHERE: Source =
    Source { cell: CellId::new(0), at: [0.0; 2], landing: Landing::Clamped, distance: 0.0 };

/// Takes fields from one mesh to another.
#[derive(Debug, Clone)]
pub struct Transfer<'a> {
    old: &'a Mesh<2>,
    new: &'a Mesh<2>,
    sources: Vec<Source>,
    /// Where the quadrature points of the new mesh take their values, cell by cell.
    points: Vec<Source>,
}

/// How the nodes of the new mesh lie in the old one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransferReport {
    /// Nodes with extrapolated values.
    pub extrapolated: usize,
    /// Nodes too far outside for that.
    pub clamped: usize,
    /// Largest distance of a node outside the old mesh (m).
    pub farthest: f64,
    /// Which node that is; none when all are inside.
    pub farthest_node: Option<NodeId>,
}

impl<'a> Transfer<'a> {
    /// Finds the nodes of a new mesh in an old one.
    ///
    /// `periods` are the vectors by which a periodic domain repeats (m), see
    /// [`alewife_mesh::Domain::images`]: a node outside is sought at its images too, since the
    /// sides of a periodic mesh need not be straight.
    ///
    /// Returns `None` when a node is not finite or the old mesh has no cells.
    #[must_use]
    pub fn new(old: &'a Mesh<2>, new: &'a Mesh<2>, periods: &[Point<2>]) -> Option<Self> {
        Some(Self { old, new, sources: find(old, &new.nodes, periods)?, points: Vec::new() })
    }

    /// Finds the quadrature points of the new mesh, too, for [`Self::missed`].
    ///
    /// Returns `None` as [`Self::new`] does.
    #[must_use]
    pub fn with_points(mut self, tables: &Tables<2>, periods: &[Point<2>]) -> Option<Self> {
        let mut points = Vec::new();
        let mut workspace = CellValues::default();
        for cell in self.new.cell_ids() {
            workspace.for_each_point(tables, self.new, cell, |at| points.push(at.position));
        }
        self.points = find(self.old, &points, periods)?;
        Some(self)
    }

    /// The new mesh.
    #[must_use]
    pub fn mesh(&self) -> &'a Mesh<2> {
        self.new
    }

    /// int phi (u - v) dx for each node, with u a field of the old mesh and v one of the new mesh: what
    /// interpolation loses. [`Self::with_points`] comes before.
    #[must_use]
    pub fn missed(&self, tables: &Tables<2>, old: &[Point<2>], new: &[Point<2>]) -> Vec<Point<2>> {
        let mesh = self.new;
        let mut missed = vec![Point::<2>::zeros(); new.len()];
        let mut workspace = CellValues::default();
        let mut sources = self.points.iter();
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell(cell);
            workspace.for_each_point(tables, mesh, cell, |at| {
                let Some(source) = sources.next() else { return };
                let mut off = self.at(source, |node| old[node]);
                for (&node, phi) in nodes.iter().zip(at.phi) {
                    off -= new[node] * *phi;
                }
                for (&node, phi) in nodes.iter().zip(at.phi) {
                    missed[node] += off * (phi * at.dx);
                }
            });
        }
        missed
    }

    /// A quadratic vector field (one vector a node of the old mesh) at the nodes of the new mesh.
    #[must_use]
    pub fn quadratic(&self, field: &[Point<2>]) -> Vec<Point<2>> {
        self.sources.iter().map(|source| self.at(source, |node| field[node])).collect()
    }

    /// A linear field (one value a vertex of the old mesh) at the vertices of the new mesh.
    #[must_use]
    pub fn linear(&self, field: &[f64]) -> Vec<f64> {
        self.sources[..self.new.n_vertices]
            .iter()
            .map(|source| {
                let [x, y] = source.at;
                let [a, b, c] = [0, 1, 2].map(|corner| field[self.old.cell(source.cell)[corner]]);
                (1.0 - x - y) * a + x * b + y * c
            })
            .collect()
    }

    /// How each node of the new mesh lies in the old one.
    pub fn landings(&self) -> impl Iterator<Item = Landing> + '_ {
        self.sources.iter().map(|source| source.landing)
    }

    /// How the nodes of the new mesh lie in the old one, in numbers.
    #[must_use]
    pub fn report(&self) -> TransferReport {
        let count = |wanted| self.landings().filter(|landing| *landing == wanted).count();
        let outside = self.sources.iter().enumerate().filter(|(_, s)| s.distance > 0.0);
        let farthest = outside.max_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        TransferReport {
            extrapolated: count(Landing::Extrapolated),
            clamped: count(Landing::Clamped),
            farthest: farthest.map_or(0.0, |(_, source)| source.distance),
            farthest_node: farthest.map(|(node, _)| NodeId::new(node)),
        }
    }

    fn at(&self, source: &Source, field: impl Fn(NodeId) -> Point<2>) -> Point<2> {
        let weights = shape_functions(source.at);
        let nodes = self.old.cell(source.cell);
        nodes
            .iter()
            .zip(weights.iter())
            .fold(Point::<2>::zeros(), |sum, (&node, &weight)| sum + field(node) * weight)
    }
}

/// Finds places (m) in a mesh; `None` when one is not finite or the mesh has no cells.
fn find(old: &Mesh<2>, places: &[Point<2>], periods: &[Point<2>]) -> Option<Vec<Source>> {
    let locator = Locator::new(old);
    let find = |place: &Point<2>| {
        if let Some(found) = locator.locate(*place) {
            return Some(settle(found.cell, found.reference, Landing::Inside, 0.0));
        }
        let images = std::iter::once(Point::<2>::zeros()).chain(periods.iter().copied());
        let found = images.filter_map(|shift| locator.nearest(place + shift));
        let nearest = found.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        Some(settle(nearest.cell, nearest.reference, Landing::Extrapolated, nearest.distance))
    };
    let order = near_ones_together(places);
    let found: Option<Vec<Source>> = order
        .par_chunks(NODES_PER_TASK)
        .flat_map_iter(|nodes| nodes.iter().map(|&node| find(&places[node as usize])))
        .collect();
    let mut sources = vec![NOWHERE; places.len()];
    for (node, source) in order.into_iter().zip(found?) {
        sources[node as usize] = source;
    }
    Some(sources)
}

/// Keeps reference coordinates within the cell, or near it where they are extrapolated.
fn settle(cell: CellId, at: [f64; 2], landing: Landing, distance: f64) -> Source {
    let barycentric = [1.0 - at[0] - at[1], at[0], at[1]];
    let lowest = barycentric.into_iter().fold(f64::INFINITY, f64::min);
    if lowest >= EXTRAPOLATION {
        return Source { cell, at, landing, distance };
    }
    let kept = barycentric.map(|l| l.max(EXTRAPOLATION));
    // Back to the sum of one, the parts above the bound giving way
    let spare: f64 = kept.iter().map(|l| l - EXTRAPOLATION).sum();
    let scale = (1.0 - 3.0 * EXTRAPOLATION) / spare;
    let [_, x, y] = kept.map(|l| EXTRAPOLATION + (l - EXTRAPOLATION) * scale);
    Source { cell, at: [x, y], landing: Landing::Clamped, distance }
}

/// The nodes along a Z-order curve: the search finds what it needs in the cache.
fn near_ones_together(nodes: &[Point<2>]) -> Vec<u32> {
    let bound = |best: f64, other: fn(&Point<2>, &Point<2>) -> Point<2>| {
        nodes.iter().fold(Point::<2>::repeat(best), |sum, node| other(&sum, node))
    };
    let low = bound(f64::INFINITY, |a, b| a.inf(b));
    let high = bound(f64::NEG_INFINITY, |a, b| a.sup(b));
    let scale = f64::from(u16::MAX) / (high - low).max();
    // Bits of x and y in turn
    let spread = |x: f64| {
        let mut bits = u64::from(x as u16);
        for (shift, mask) in
            [(8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)]
        {
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    let mut keys: Vec<(u64, u32)> = nodes
        .iter()
        .enumerate()
        .map(|(node, place)| {
            let at = (place - low) * scale;
            (spread(at.x) | spread(at.y) << 1, node as u32)
        })
        .collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, node)| node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_far_outside_are_clamped_near_the_cell() {
        let near = settle(CellId::new(0), [-0.05, 0.5], Landing::Extrapolated, 0.1);
        assert_eq!((near.at, near.landing), ([-0.05, 0.5], Landing::Extrapolated));
        for at in [[-3.0, 0.5], [5.0, 5.0], [-2.0, -2.0], [0.2, -0.2]] {
            let far = settle(CellId::new(0), at, Landing::Extrapolated, 0.1);
            assert_eq!(far.landing, Landing::Clamped);
            for l in [1.0 - far.at[0] - far.at[1], far.at[0], far.at[1]] {
                assert!((EXTRAPOLATION - 1e-14..=1.2 + 1e-14).contains(&l), "{at:?}: {l}");
            }
        }
    }
}

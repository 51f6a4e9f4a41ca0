//! Fields of one mesh evaluated at the nodes of another that covers the same region.

use alewife_mesh::{
    CellId, Image, Located, Locator, Mesh, Neighbours, NodeId, Point, shape_functions, whole,
};
use rayon::prelude::*;

use crate::space::{CellValues, Tables};

/// Barycentric coordinates down to this are extrapolated; farther outside they are clamped to it.
const EXTRAPOLATION: f64 = -0.1;

/// Cells of which a thread finds the quadrature points at a time.
const CELLS_PER_TASK: usize = 64;

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
struct Source<const D: usize> {
    /// Which of the periods lead there.
    image: usize,
    cell: CellId,
    at: [f64; D],
    landing: Landing,
    /// Distance outside the old mesh (m).
    distance: f64,
}

/// Takes fields from one mesh to another.
#[derive(Debug, Clone)]
pub struct Transfer<'a, const D: usize> {
    old: &'a Mesh<D>,
    new: &'a Mesh<D>,
    finder: Finder<D>,
    sources: Vec<Source<D>>,
    /// Where the quadrature points of the new mesh take their values, cell by cell.
    points: Vec<Source<D>>,
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

impl<'a, const D: usize> Transfer<'a, D> {
    /// Finds the nodes of a new mesh in an old one.
    ///
    /// `periods` are the vectors by which a periodic domain repeats (m), see
    /// [`alewife_mesh::Domain::images`]: a node outside is sought at its images too, since the
    /// sides of a periodic mesh need not be straight.
    ///
    /// Returns `None` when a node is not finite or the old mesh has no cells.
    #[must_use]
    pub fn new(old: &'a Mesh<D>, new: &'a Mesh<D>, periods: &[Point<D>]) -> Option<Self> {
        let finder = Finder::new(old, periods);
        let sources = finder.find(&new.nodes)?;
        Some(Self { old, new, finder, sources, points: Vec::new() })
    }

    /// Finds the quadrature points of the new mesh, too, for [`Self::missed`].
    ///
    /// Returns `None` as [`Self::new`] does.
    #[must_use]
    pub fn with_points(mut self, tables: &Tables<D>) -> Option<Self> {
        let (new, sources, finder) = (self.new, &self.sources, &self.finder);
        let cells: Vec<CellId> = new.cell_ids().collect();
        let of_cells = |cells: &[CellId]| {
            let mut workspace = CellValues::default();
            let mut points = Vec::new();
            for &cell in cells {
                // From a node of the cell, and from point to point
                let mut last = Some(sources[new.cell(cell)[0].index()]);
                workspace.for_each_point(tables, new, cell, |at| {
                    last = last.and_then(|last| finder.one(&at.position, Some(&last)));
                    points.push(last);
                });
            }
            points.into_iter().collect::<Option<Vec<_>>>()
        };
        let parts: Option<Vec<_>> = cells.par_chunks(CELLS_PER_TASK).map(of_cells).collect();
        self.points = parts?.concat();
        Some(self)
    }

    /// The new mesh.
    #[must_use]
    pub fn mesh(&self) -> &'a Mesh<D> {
        self.new
    }

    /// int phi (u - v) dx for each node, with u a field of the old mesh and v one of the new mesh: what
    /// interpolation loses. [`Self::with_points`] comes before.
    #[must_use]
    pub fn missed(&self, tables: &Tables<D>, old: &[Point<D>], new: &[Point<D>]) -> Vec<Point<D>> {
        let mesh = self.new;
        let mut missed = vec![Point::<D>::zeros(); new.len()];
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
    pub fn quadratic(&self, field: &[Point<D>]) -> Vec<Point<D>> {
        self.sources.iter().map(|source| self.at(source, |node| field[node])).collect()
    }

    /// A linear field (one value a vertex of the old mesh) at the vertices of the new mesh.
    #[must_use]
    pub fn linear(&self, field: &[f64]) -> Vec<f64> {
        self.sources[..self.new.n_vertices]
            .iter()
            .map(|source| {
                let corners = self.old.cell(source.cell);
                let others = source.at.iter().zip(&corners[1..]);
                let at_first = first_barycentric(&source.at) * field[corners[0]];
                others.fold(at_first, |sum, (l, &vertex)| sum + l * field[vertex])
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

    fn at(&self, source: &Source<D>, field: impl Fn(NodeId) -> Point<D>) -> Point<D> {
        let weights = shape_functions(source.at);
        let nodes = self.old.cell(source.cell);
        nodes
            .iter()
            .zip(weights.iter())
            .fold(Point::<D>::zeros(), |sum, (&node, &weight)| sum + field(node) * weight)
    }
}

/// Finds points in the old mesh, or their images.
#[derive(Debug, Clone)]
struct Finder<const D: usize> {
    locator: Locator<D>,
    neighbours: Neighbours<D>,
    /// No period, then all (m).
    images: Vec<Point<D>>,
}

impl<const D: usize> Finder<D> {
    fn new(old: &Mesh<D>, periods: &[Point<D>]) -> Self {
        let images = std::iter::once(&Point::zeros()).chain(periods).copied().collect();
        Self { locator: Locator::new(old), neighbours: Neighbours::new(old), images }
    }

    /// Finds a point (m), sooner near a place where another one was found; `None` when it is not finite or the
    /// mesh has no cells.
    fn one(&self, point: &Point<D>, near: Option<&Source<D>>) -> Option<Source<D>> {
        let Self { locator, neighbours, images } = self;
        let there = |near: &Source<D>| {
            let found = locator.walk(neighbours, near.cell, point + images[near.image])?;
            Some(settle(&Image { located: found, shift: near.image }, Landing::Inside))
        };
        if let Some(found) = near.and_then(there) {
            return Some(found);
        }
        if let Some(located) = locator.locate(*point) {
            return Some(settle(&Image { located, shift: 0 }, Landing::Inside));
        }
        Some(settle(&locator.nearest_image(*point, images)?, Landing::Extrapolated))
    }

    /// Finds points (m); `None` when one is not finite or the mesh has no cells.
    fn find(&self, points: &[Point<D>]) -> Option<Vec<Source<D>>> {
        let order = by_proximity(points);
        let found: Option<Vec<(usize, Source<D>)>> = order
            .par_chunks(NODES_PER_TASK)
            .flat_map_iter(|some| {
                let mut last: Option<Source<D>> = None;
                some.iter().map(move |&point| {
                    let found = self.one(&points[point], last.as_ref())?;
                    last = Some(found);
                    Some((point, found))
                })
            })
            .collect();
        let mut found = found?;
        found.par_sort_unstable_by_key(|(point, _)| *point);
        Some(found.into_iter().map(|(_, source)| source).collect())
    }
}

/// The barycentric coordinate of the first vertex.
fn first_barycentric<const D: usize>(at: &[f64; D]) -> f64 {
    at.iter().fold(1.0, |rest, l| rest - l)
}

/// Keeps reference coordinates within the cell, or near it where they are extrapolated.
fn settle<const D: usize>(found: &Image<D>, landing: Landing) -> Source<D> {
    let Image { located: Located { cell, reference: at, distance }, shift: image } = *found;
    let distance = if landing == Landing::Inside { 0.0 } else { distance };
    let first = first_barycentric(&at);
    let lowest = at.iter().fold(first, |lowest, l| lowest.min(*l));
    if lowest >= EXTRAPOLATION {
        return Source { image, cell, at, landing, distance };
    }
    // Back to the sum of one, the parts above the bound giving way
    let spare = |l: f64| l.max(EXTRAPOLATION) - EXTRAPOLATION;
    let total = at.iter().fold(spare(first), |sum, l| sum + spare(*l));
    let scale = (1.0 - (D + 1) as f64 * EXTRAPOLATION) / total;
    let at = at.map(|l| EXTRAPOLATION + spare(l) * scale);
    Source { image, cell, at, landing: Landing::Clamped, distance }
}

/// Points along a Z-order curve: the search finds what it needs in the cache.
fn by_proximity<const D: usize>(points: &[Point<D>]) -> Vec<usize> {
    let bound = |best: f64, other: fn(&Point<D>, &Point<D>) -> Point<D>| {
        points.iter().fold(Point::<D>::repeat(best), |sum, point| other(&sum, point))
    };
    let low = bound(f64::INFINITY, |a, b| a.inf(b));
    let high = bound(f64::NEG_INFINITY, |a, b| a.sup(b));
    let scale = f64::from(u16::MAX) / (high - low).max();
    let key = |point: &Point<D>| {
        let at = (point - low) * scale;
        // Bits of all coordinates in turn
        let bits = (0..u16::BITS as usize).flat_map(|bit| (0..D).map(move |axis| [bit, axis]));
        bits.fold(0_u64, |key, [bit, axis]| {
            let set = whole(at[axis]) as u64 >> bit & 1;
            key | set << (D * bit + axis)
        })
    };
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_cached_key(|&point| key(&points[point]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_far_outside_are_clamped_near_the_cell() {
        let settled = |reference| {
            let located = Located { cell: CellId::new(0), reference, distance: 0.1 };
            settle(&Image { located, shift: 0 }, Landing::Extrapolated)
        };
        let near = settled([-0.05, 0.5]);
        assert_eq!((near.at, near.landing), ([-0.05, 0.5], Landing::Extrapolated));
        for at in [[-3.0, 0.5], [5.0, 5.0], [-2.0, -2.0], [0.2, -0.2]] {
            let far = settled(at);
            assert_eq!(far.landing, Landing::Clamped);
            for l in [1.0 - far.at[0] - far.at[1], far.at[0], far.at[1]] {
                assert!((EXTRAPOLATION - 1e-14..=1.2 + 1e-14).contains(&l), "{at:?}: {l}");
            }
        }
    }
}

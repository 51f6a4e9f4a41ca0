//! `Facets`: a surface of triangles, straight or quadratic, and the distance to it.

use std::collections::BTreeMap;

use nalgebra::Matrix3;

use super::Foot;
use super::patch::{OnPatch, Patch};
use crate::{BoundaryId, Bounds, BoxTree, Facet, Mesh, NodeId, Point};

/// Distances that differ by less than this part are the same: those of two triangles to a point that is
/// nearest to their common edge.
const TIE: f64 = 1e-9;

/// Triangles, in a tree of the boxes around them.
#[derive(Debug, Clone)]
pub struct Facets {
    patches: Vec<Patch>,
    tree: BoxTree<3>,
    boxes: Vec<Bounds<3>>,
    is_curved: bool,
}

impl PartialEq for Facets {
    fn eq(&self, other: &Self) -> bool {
        self.patches == other.patches
    }
}

/// The nearest point of a surface, and the triangle it is on.
#[derive(Debug, Clone, Copy)]
pub(super) struct OnTriangle {
    pub foot: Foot,
    pub triangle: usize,
}

/// The nearest point of a surface that is continued beyond its rim.
#[derive(Debug, Clone, Copy)]
pub(super) struct Continued {
    pub foot: Foot,
    /// Distance to the surface as far as it reaches (m).
    pub distance: f64,
    pub triangle: usize,
}

/// The nearest point of all triangles.
#[derive(Debug, Clone, Copy)]
struct Nearest {
    patch: usize,
    on: OnPatch,
    distance: f64,
    /// Component of the way from there to the point along the normal into the fluid (m).
    height: f64,
}

impl Facets {
    /// Those of one boundary of a mesh.
    #[must_use]
    pub fn of(mesh: &Mesh<3>, side: BoundaryId) -> Self {
        let own: Vec<&Facet> = mesh.facets.iter().filter(|facet| facet.boundary == side).collect();
        let mut n_sharing: BTreeMap<[NodeId; 2], usize> = BTreeMap::new();
        for edge in own.iter().flat_map(|facet| edges(mesh, facet)) {
            *n_sharing.entry(edge).or_default() += 1;
        }
        let patch = |facet: &&Facet| {
            let n: Vec<Point<3>> = mesh.facet_nodes(facet).map(|node| mesh.nodes[node]).collect();
            let is_rim = edges(mesh, facet).map(|edge| n_sharing[&edge] == 1);
            Patch::new([n[0], n[1], n[2]], [n[3], n[4], n[5]], is_rim)
        };
        Self::new(own.iter().map(patch).collect())
    }

    /// These triangles.
    #[must_use]
    pub(in crate::spatial) fn new(patches: Vec<Patch>) -> Self {
        let boxes: Vec<Bounds<3>> = patches.iter().map(Patch::bounds).collect();
        let is_curved = patches.iter().any(Patch::is_curved);
        Self { tree: BoxTree::new(&boxes), patches, boxes, is_curved }
    }

    /// Whether edges on it may be bent.
    #[must_use]
    pub fn is_curved(&self) -> bool {
        self.is_curved
    }

    /// Nodes of its triangles (m), each at least once.
    pub fn points(&self) -> impl Iterator<Item = Point<3>> + '_ {
        self.patches.iter().flat_map(Patch::points)
    }

    /// The nearest point to another one within a distance (m).
    fn nearest(&self, point: Point<3>, within: f64) -> Option<Nearest> {
        let mut nearest: Option<Nearest> = None;
        self.tree.visit_near(point, within, |index, reach| {
            if self.boxes[index].squared_distance(&point) > *reach * *reach {
                return false;
            }
            let patch = &self.patches[index];
            let Some(on) = patch.nearest(&point, *reach) else { return false };
            let way = point - on.point;
            let distance = way.norm();
            if distance > *reach {
                return false;
            }
            let height = way.dot(&patch.inward(on.place));
            let is_better = nearest.is_none_or(|known| {
                let is_tie = (distance - known.distance).abs() <= TIE * known.distance;
                // Of those that meet in an edge the one it stands out from more shows the side
                if is_tie { height.abs() > known.height.abs() } else { distance < known.distance }
            });
            if is_better {
                nearest = Some(Nearest { patch: index, on, distance, height });
                *reach = reach.min(distance * (1.0 + TIE));
            }
            false
        });
        nearest
    }

    /// The nearest point to another one. The gap is negative behind the triangles, but where the
    /// surface ends: nothing is behind its rim.
    #[must_use]
    pub fn foot(&self, point: Point<3>) -> Foot {
        match self.nearest(point, f64::INFINITY) {
            Some(nearest) => self.foot_of(point, &nearest),
            None => Foot { point, normal: Point::<3>::zeros(), gap: f64::INFINITY },
        }
    }

    /// The same, and which triangle it is on.
    pub(super) fn on_triangle(&self, point: Point<3>) -> OnTriangle {
        match self.nearest(point, f64::INFINITY) {
            Some(at) => OnTriangle { foot: self.foot_of(point, &at), triangle: at.patch },
            None => OnTriangle { foot: self.foot(point), triangle: 0 },
        }
    }

    fn foot_of(&self, point: Point<3>, nearest: &Nearest) -> Foot {
        let Nearest { patch, on, distance, height } = *nearest;
        let patch = &self.patches[patch];
        let is_behind = height < 0.0 && !patch.is_on_rim(on.place);
        let gap = if is_behind { -distance } else { distance };
        let normal = if patch.is_inner(on.place) || distance == 0.0 {
            patch.inward(on.place)
        } else {
            (point - on.point) / gap
        };
        Foot { point: on.point, normal, gap }
    }

    /// The nearest point within a distance (m), the surface continued beyond its rim by its tangent planes there.
    pub(super) fn continued(&self, point: Point<3>, within: f64) -> Option<Continued> {
        let nearest = self.nearest(point, within)?;
        let Nearest { patch, on, distance, height } = nearest;
        let mut foot = self.foot_of(point, &nearest);
        if self.patches[patch].is_on_rim(on.place) {
            let normal = self.patches[patch].inward(on.place);
            foot = Foot { point: point - normal * height, normal, gap: height };
        }
        Some(Continued { foot, distance, triangle: patch })
    }

    /// The gap of [`Self::foot`] (m) where it is below a bound.
    #[must_use]
    pub fn gap_within(&self, point: Point<3>, bound: f64) -> Option<f64> {
        self.nearest(point, bound).map(|at| self.foot_of(point, &at).gap)
    }

    /// The derivative of the unit normal into the fluid at the point nearest to another one (1/m).
    #[must_use]
    pub fn curvature(&self, point: Point<3>) -> Matrix3<f64> {
        let nearest = self.nearest(point, f64::INFINITY);
        nearest.map_or_else(Matrix3::zeros, |at| self.patches[at.patch].curvature(at.on.place))
    }
}

/// The edges of a facet from each vertex to the next, by their ends in ascending order.
fn edges(mesh: &Mesh<3>, facet: &Facet) -> [[NodeId; 2]; 3] {
    let vertices = mesh.facet_vertices(facet);
    std::array::from_fn(|i| {
        let (a, b) = (vertices[i], vertices[(i + 1) % 3]);
        [a.min(b), a.max(b)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::cube_of_twelve;

    #[test]
    fn distances_are_those_to_a_cube() {
        let mesh = cube_of_twelve();
        let facets = Facets::of(&mesh, BoundaryId::new(0));
        for (point, nearest, gap) in [
            ([0.5, 0.4, 0.1], [0.5, 0.4, 0.0], 0.1),
            ([2.0, 0.5, 0.3], [1.0, 0.5, 0.3], -1.0),
            ([2.0, 2.0, 0.5], [1.0, 1.0, 0.5], -2.0_f64.sqrt()),
            ([-1.0, -1.0, -1.0], [0.0, 0.0, 0.0], -3.0_f64.sqrt()),
            ([0.0, 0.2, 0.7], [0.0, 0.2, 0.7], 0.0),
        ] {
            let foot = facets.foot(point.into());
            assert!((foot.gap - gap).abs() < 1e-14, "{foot:?}");
            assert!((foot.point - Point::from(nearest)).norm() < 1e-14, "{foot:?}");
            assert!((foot.normal.norm() - 1.0).abs() < 1e-14);
            assert_eq!(facets.gap_within(point.into(), 0.5).is_some(), gap.abs() < 0.5);
        }
    }
}

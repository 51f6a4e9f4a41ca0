//! `Hole`: a boundary of a plane mesh that runs around something which is not meshed.

use std::collections::BTreeMap;

use crate::quadrature::integrate;
use crate::{Boundary, BoundaryId, BoundaryKind, Mesh, Moments, NodeId, Point, SecondMoments};

/// What a closed boundary of a plane mesh surrounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    /// Nodes of its edges counter-clockwise, ends and middles in turn (m).
    pub outline: Vec<Point<2>>,
    /// Area, centroid and second moment of what is inside, along the curved edges themselves.
    pub moments: Moments,
}

impl Mesh<2> {
    /// What a boundary surrounds; `None` of one that is not closed, in several pieces, or around the mesh.
    #[must_use]
    pub fn hole(&self, boundary: BoundaryId) -> Option<Hole> {
        // The mesh is to the left of its edges, and what is not meshed to their right
        let mut before: BTreeMap<NodeId, [NodeId; 2]> = BTreeMap::new();
        for facet in self.facets.iter().filter(|facet| facet.boundary == boundary) {
            let nodes: Vec<NodeId> = self.facet_nodes(facet).collect();
            let [start, end, middle] = nodes.as_slice() else { return None };
            if before.insert(*end, [*middle, *start]).is_some() {
                return None;
            }
        }
        let first = *before.keys().next()?;
        let mut outline = Vec::with_capacity(2 * before.len());
        let mut at = first;
        loop {
            let [middle, next] = before.remove(&at)?;
            outline.extend([self.nodes[at], self.nodes[middle]]);
            at = next;
            if at == first {
                break;
            }
        }
        let moments = before.is_empty().then(|| moments(&outline))?;
        (moments.measure > 0.0).then_some(Hole { outline, moments })
    }
}

impl<const D: usize> Mesh<D> {
    /// The same mesh with boundaries as the surfaces of bodies, which are given in order by the name of the side and
    /// that of the body; they come behind all sides.
    #[must_use]
    pub fn with_bodies(&self, bodies: &[SideOfBody<'_>]) -> Self {
        let body_of = |boundary: &Boundary| bodies.iter().position(|b| b.side == boundary.name);
        let n = self.boundaries.len();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(|&old| body_of(&self.boundaries[old]).map_or(0, |body| body + 1));
        let mut numbers = vec![BoundaryId::new(0); n];
        for (new, &old) in order.iter().enumerate() {
            numbers[old] = BoundaryId::new(new);
        }
        let mut mesh = self.clone();
        let topology = mesh.topology_mut();
        let renamed = |&old: &usize| {
            let boundary = topology.boundaries[old].clone();
            match body_of(&boundary) {
                Some(body) => {
                    Boundary { name: bodies[body].body.to_owned(), kind: BoundaryKind::Body(body) }
                }
                None => boundary,
            }
        };
        topology.boundaries = order.iter().map(renamed).collect();
        for facet in &mut topology.facets {
            facet.boundary = numbers[facet.boundary.index()];
        }
        mesh
    }
}

/// A side of a mesh that is the surface of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SideOfBody<'a> {
    /// Name of the side.
    pub side: &'a str,
    /// Name of the body.
    pub body: &'a str,
}

/// By Green's theorem along quadratic edges, exact; about the first point, for the sake of rounding.
fn moments(outline: &[Point<2>]) -> Moments {
    let n = outline.len();
    let start = outline[0];
    let around = |f: &dyn Fn(Point<2>) -> f64| -> f64 {
        let edges = (0..n).step_by(2);
        let along = |i: usize| {
            let [a, m, b] = [0, 1, 2].map(|k| outline[(i + k) % n] - start);
            integrate(0.0, 1.0, |s| {
                let at = a * ((1.0 - s) * (1.0 - 2.0 * s))
                    + m * (4.0 * s * (1.0 - s))
                    + b * (s * (2.0 * s - 1.0));
                let rate = a * (4.0 * s - 3.0) + m * (4.0 - 8.0 * s) + b * (4.0 * s - 1.0);
                f(at) * at.perp(&rate)
            })
        };
        edges.map(along).sum()
    };
    let area = around(&|_| 0.5);
    let centroid = Point::<2>::new(around(&|x| x.x / 3.0), around(&|x| x.y / 3.0)) / area;
    let polar = around(&|x| x.norm_squared() / 4.0) - area * centroid.norm_squared();
    let second = SecondMoments::Planar { polar };
    Moments { measure: area, centroid: start + centroid, second }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, PlacedShape, Shape, Sizing, generate};

    fn with_disc(size: f64) -> Mesh<2> {
        let (min, max) = (Point::<2>::repeat(-2.0), Point::<2>::repeat(2.0));
        let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
        let disc = PlacedShape {
            name: "disc".to_owned(),
            shape: Shape::Disc { radius: 0.5 },
            center: Point::<2>::new(0.3, -0.4),
            angle: 0.0,
            size: None,
        };
        generate(&domain, &[disc], &Sizing::graded(0.5, 0.4, size)).expect("it fits")
    }

    /// Quadratic edges are off by the fourth power of their length.
    #[test]
    fn a_round_hole_has_the_moments_of_a_disc() {
        let error = |size: f64| {
            let mesh = with_disc(size);
            let hole = mesh.hole(BoundaryId::new(4)).expect("it is one");
            let area = std::f64::consts::PI / 4.0;
            let SecondMoments::Planar { polar } = hole.moments.second else { panic!("planar") };
            let off = (hole.moments.centroid - Point::<2>::new(0.3, -0.4)).norm();
            [(hole.moments.measure / area - 1.0).abs(), (polar / (area / 8.0) - 1.0).abs(), off]
        };
        let [coarse, fine] = [error(0.1), error(0.05)];
        assert!(coarse[0] < 1e-4 && fine[0] < coarse[0] / 12.0, "{coarse:?} {fine:?}");
        assert!(coarse[1] < 1e-4 && fine[1] < coarse[1] / 12.0, "{coarse:?} {fine:?}");
        assert!(coarse[2] < 1e-5 && fine[2] < 1e-6, "{coarse:?} {fine:?}");
        // Its sides are none
        for side in 0..4 {
            assert_eq!(with_disc(0.2).hole(BoundaryId::new(side)), None);
        }
    }

    #[test]
    fn a_side_becomes_the_last_boundary_as_that_of_a_body() {
        let mesh = with_disc(0.2);
        let bodies =
            [SideOfBody { side: "bottom", body: "a" }, SideOfBody { side: "left", body: "b" }];
        let other = mesh.with_bodies(&bodies);
        let names: Vec<&str> = other.boundaries.iter().map(|b| b.name.as_str()).collect();
        assert_eq!(names, ["right", "top", "disc", "a", "b"]);
        assert_eq!(other.boundaries[3].kind, BoundaryKind::Body(0));
        for (old, new) in mesh.facets.iter().zip(&other.facets) {
            let [old, new] =
                [(&mesh, old), (&other, new)].map(|(m, f)| &m.boundaries[f.boundary].name);
            let wanted = match old.as_str() {
                "bottom" => "a",
                "left" => "b",
                same => same,
            };
            assert_eq!(new, wanted);
        }
    }
}

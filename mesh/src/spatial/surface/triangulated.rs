//! `Triangulated`: the surface of a solid given by triangles, smooth through their vertices.
//!
//! Each triangle stands for a quadratic one with the same corners. The node in an edge is that of the cubic
//! with the tangents of the surface at its ends, across the normals there (as of PN triangles, @vlachos2001).
//! Neighbours share it, so the surface is closed.

use std::collections::BTreeMap;

use nalgebra::Matrix3;

use super::facets::OnTriangle;
use super::patch::{Element, Patch};
use super::{Facets, Foot};
use crate::spatial::triangles::{SurfaceFault, SurfaceMoments, TriangleMesh, edges_of};
use crate::{GaussRule, Point};

/// Points of the Gauss rule along each side of a triangle: moments of quadratic triangles are of degree 8.
const RULE: usize = 5;

/// Cosine of the angle by which the normal of a quadratic triangle may differ from that of the straight one.
const UNFOLDED: f64 = 0.3;

/// Radii on a triangle are taken to be no smaller than this part of its mean edge: it shows no more.
const RESOLVED: f64 = 0.5;

/// Steps of the search for the ball inside, and the change with which it ends.
const MOST_STEPS: usize = 20;
const CHANGE: f64 = 1e-3;

/// The surface of a solid in its own frame.
#[derive(Debug, Clone)]
pub struct Triangulated {
    facets: Facets,
    mesh: TriangleMesh,
    moments: SurfaceMoments,
    area: f64,
    reach: f64,
    bends: Vec<Bend>,
    inner_radius: f64,
}

impl PartialEq for Triangulated {
    fn eq(&self, other: &Self) -> bool {
        self.facets == other.facets
    }
}

/// The nearest point of a surface, and how it bends there.
#[derive(Debug, Clone, Copy)]
pub(super) struct BentFoot {
    pub foot: Foot,
    pub bend: Bend,
}

/// What quadratic triangles enclose, and their area (m2).
pub struct Enclosed {
    /// Volume, centroid, inertia.
    pub moments: SurfaceMoments,
    /// Area (m2).
    pub area: f64,
}

/// A ball that holds nothing of a surface.
#[derive(Debug, Clone, Copy)]
struct Ball {
    center: Point<3>,
    /// Distance of the centre to the surface (m).
    radius: f64,
}

/// How a triangle bends, and what is behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// Smallest radius of curvature (m).
    pub radius: f64,
    /// Radius of the largest ball inside that touches it (m).
    pub inside: f64,
    /// Mean length of its edges (m).
    pub edge: f64,
}

impl Triangulated {
    /// The surface of triangles that enclose a solid and turn by no more than an angle (degrees) at their
    /// edges. `origin` (m) is the origin of its frame, the centroid where there is none.
    ///
    /// # Errors
    /// Those of [`TriangleMesh::check`], and [`SurfaceFault::Crease`].
    pub fn new(
        mesh: &TriangleMesh,
        smooth: f64,
        origin: Option<Point<3>>,
    ) -> Result<Self, SurfaceFault> {
        mesh.check()?;
        check_creases(mesh, smooth)?;
        let origin = origin.unwrap_or_else(|| enclosed(&patches(mesh)).moments.centroid);
        let vertices = mesh.vertices.iter().map(|vertex| vertex - origin).collect();
        let mesh = TriangleMesh { vertices, triangles: mesh.triangles.clone() };
        let patches = patches(&mesh);
        Ok(Self::of_patches(mesh, patches))
    }

    /// Triangles with the quadratic ones they stand for, in the frame of the solid.
    pub(super) fn of_patches(mesh: TriangleMesh, patches: Vec<Patch>) -> Self {
        let Enclosed { moments, area } = enclosed(&patches);
        let far = patches.iter().flat_map(Patch::control_points).map(|point| point.norm());
        let reach = far.fold(0.0, f64::max);
        let facets = Facets::new(patches);
        let bends = bends(&mesh, &facets, reach);
        let inner_radius = bends.iter().map(|bend| bend.inside).fold(0.0, f64::max);
        Self { facets, mesh, moments, area, reach, bends, inner_radius }
    }

    /// What it encloses, at unit density.
    #[must_use]
    pub fn moments(&self) -> SurfaceMoments {
        self.moments
    }

    /// Its area (m2).
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Its triangles, straight, in its frame.
    #[must_use]
    pub fn triangles(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// No point of it is farther from the origin (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Radius of the largest ball inside that touches it in the middle of a triangle (m).
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        self.inner_radius
    }

    /// The nearest point to another one (m).
    pub(super) fn foot(&self, point: Point<3>) -> Foot {
        self.facets.foot(point)
    }

    /// The same, and how the surface bends there.
    pub(super) fn bent_foot(&self, point: Point<3>) -> BentFoot {
        let OnTriangle { foot, triangle } = self.facets.on_triangle(point);
        BentFoot { foot, bend: self.bends[triangle] }
    }

    /// Its vertices (m).
    pub(super) fn places(&self) -> &[Point<3>] {
        &self.mesh.vertices
    }
}

/// Refuses edges at which the surface turns by more than an angle (degrees).
fn check_creases(mesh: &TriangleMesh, smooth: f64) -> Result<(), SurfaceFault> {
    let (mut n, mut sharpest) = (0, (0.0, Point::<3>::zeros()));
    for ([a, b], beside) in edges_of(mesh) {
        let [one, other] = beside[..] else { continue };
        let angle = mesh.turn(one.triangle, other.triangle).to_degrees();
        if angle > smooth {
            n += 1;
            if angle > sharpest.0 {
                let [a, b] = [a, b].map(|vertex| mesh.vertices[vertex as usize]);
                sharpest = (angle, (a + b) * 0.5);
            }
        }
    }
    if n == 0 {
        return Ok(());
    }
    let (angle, at) = sharpest;
    Err(SurfaceFault::Crease { n, angle, limit: smooth, at: at.into() })
}

/// Unit normals at the vertices: of the triangles around each, by their angles there.
fn normals(mesh: &TriangleMesh) -> Vec<Point<3>> {
    let mut normals = vec![Point::<3>::zeros(); mesh.vertices.len()];
    for (triangle, vertices) in mesh.triangles.iter().enumerate() {
        let corners = mesh.corners(triangle);
        let normal = mesh.area_vector(triangle).normalize();
        for local in 0..3 {
            let [to, from] = [1, 2].map(|step| corners[(local + step) % 3] - corners[local]);
            let angle = to.cross(&from).norm().atan2(to.dot(&from));
            normals[vertices[local] as usize] += normal * angle;
        }
    }
    normals.into_iter().map(|normal| normal.try_normalize(0.0).unwrap_or(normal)).collect()
}

/// The quadratic triangles, turned so that their normals leave the fluid.
fn patches(mesh: &TriangleMesh) -> Vec<Patch> {
    let normals = normals(mesh);
    let mut nodes: BTreeMap<[u32; 2], Point<3>> = BTreeMap::new();
    let middle = |ends: [u32; 2]| {
        let [a, b] = ends.map(|end| mesh.vertices[end as usize]);
        (a + b) * 0.5
    };
    for [from, to] in edges_of(mesh).into_keys() {
        let [a, b] = [from, to].map(|end| mesh.vertices[end as usize]);
        let off = [from, to].map(|end| normals[end as usize]).map(|n| n * (b - a).dot(&n));
        nodes.insert([from, to], middle([from, to]) + (off[1] - off[0]) / 8.0);
    }
    loop {
        let patch = |vertices: &[u32; 3]| {
            let [a, c, b] = *vertices;
            let node = |from: u32, to: u32| nodes[&[from.min(to), from.max(to)]];
            let corners = [a, b, c].map(|vertex| mesh.vertices[vertex as usize]);
            Patch::new(corners, [node(a, b), node(b, c), node(c, a)], [false; 3])
        };
        let patches: Vec<Patch> = mesh.triangles.iter().map(patch).collect();
        let is_folded = |patch: &Patch| patch.is_curved() && patch.least_cosine() < UNFOLDED;
        let folded = patches.iter().zip(&mesh.triangles).filter(|(patch, _)| is_folded(patch));
        let folded: Vec<[u32; 3]> = folded.map(|(_, vertices)| *vertices).collect();
        if folded.is_empty() {
            return patches;
        }
        for [a, b, c] in folded {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let ends = [from.min(to), from.max(to)];
                nodes.insert(ends, middle(ends));
            }
        }
    }
}

/// What quadratic triangles enclose that have their fluid outside.
pub fn enclosed(patches: &[Patch]) -> Enclosed {
    let rule = GaussRule::new(RULE);
    let near = patches.first().and_then(|patch| patch.points().next()).unwrap_or_default();
    let (mut volume, mut first, mut second) = (0.0, Point::<3>::zeros(), Matrix3::zeros());
    let mut area = 0.0;
    for patch in patches {
        for (u, p) in rule.points.iter().zip(&rule.weights) {
            for (t, q) in rule.points.iter().zip(&rule.weights) {
                let Element { at, outward } = patch.element([*u, t * (1.0 - u)]);
                let weight = p * q * (1.0 - u);
                let x = at - near;
                let flux = x.dot(&outward) * weight;
                // div(x) = 3, div(x_i x) = 4 x_i, div(x_i x_j x) = 5 x_i x_j
                volume += flux / 3.0;
                first += x * (flux / 4.0);
                second += x * x.transpose() * (flux / 5.0);
                area += outward.norm() * weight;
            }
        }
    }
    Enclosed { moments: SurfaceMoments::of(volume, first, second).moved(near), area }
}

/// How each triangle bends, and the balls behind it.
fn bends(mesh: &TriangleMesh, facets: &Facets, reach: f64) -> Vec<Bend> {
    let normals = normals(mesh);
    let mut empty = Ball { center: Point::<3>::zeros(), radius: 0.0 };
    let bend = |(triangle, vertices): (usize, &[u32; 3])| {
        let corners = mesh.corners(triangle);
        let (mut curvature, mut edge) = (0.0_f64, 0.0);
        for local in 0..3 {
            let next = (local + 1) % 3;
            let length = (corners[next] - corners[local]).norm();
            let [m, n] = [local, next].map(|i| normals[vertices[i] as usize]);
            curvature = curvature.max((m - n).norm() / length);
            edge += length / 3.0;
        }
        let least = RESOLVED * edge;
        let middle: Point<3> = corners.iter().sum::<Point<3>>() / 3.0;
        let inside = ball_inside(facets, middle, 2.0 * reach, &mut empty);
        Bend { radius: (1.0 / curvature).max(least), inside: inside.max(least), edge }
    };
    mesh.triangles.iter().enumerate().map(bend).collect()
}

/// Radius of the largest ball inside that touches a surface at its point nearest to another one (m), by
/// balls that shrink from a radius until they hold nothing of the surface.
///
/// `empty` is a ball known to hold nothing, that of the triangle before. Around its centre distances differ
/// by no more than places do, which spares the search from the middle of a ball, whose triangles are all
/// as near: n searches of n triangles each for a sphere.
fn ball_inside(facets: &Facets, near: Point<3>, largest: f64, empty: &mut Ball) -> f64 {
    let touching = facets.foot(near);
    let mut radius = largest;
    for _ in 0..MOST_STEPS {
        let center = touching.point - touching.normal * radius;
        let enough = radius * (1.0 - CHANGE);
        if empty.radius - (center - empty.center).norm() >= enough {
            break;
        }
        let held = facets.foot(center);
        if held.gap.abs() >= enough {
            *empty = Ball { center, radius: held.gap.abs() };
            break;
        }
        let way = touching.point - held.point;
        let height = way.dot(&touching.normal);
        if height <= 0.0 {
            break;
        }
        radius = radius.min(way.norm_squared() / (2.0 * height));
    }
    radius
}

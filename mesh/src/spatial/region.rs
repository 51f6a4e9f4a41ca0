//! `Region`: the inside of a closed surface of triangles, with named sides and sharp edges between them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::geometry::Geometry;
use super::surface::{Facets, Patch, Sheet, SheetTriangle, SmoothSurface, enclosed};
use super::triangles::{Groups, SurfaceFault, TriangleMesh, edges_of};
use crate::{Boundary, BoundaryId, BoundaryKind, Point, Sizing};

/// Cosine of the angle by which the normal of a quadratic triangle may differ from that of the straight one.
const UNFOLDED: f64 = 0.3;

/// Vertices of a flat sheet are no farther from its plane than this part of the surface.
const FLAT: f64 = 1e-6;

/// Radii on a triangle are taken to be no smaller than this part of its shortest edge: it shows no more.
const RESOLVED: f64 = 0.5;

/// Most pairs of triangles that are looked at for the width of the region.
const MOST_PAIRS: usize = 40_000_000;

/// Most triangles of a sheet that is joined to another one.
const SPLINTER: usize = 3;

/// Edges that turn by more than this (degrees) are of a shape, not of coarse triangles: those of a prism on a
/// hexagon turn by 60.
const MOST_FADED: f64 = 55.0;

/// Cosine of the angle between normals of walls that face each other.
const FACING: f64 = -0.5;

/// The inside of a closed surface.
#[derive(Debug, Clone)]
pub struct Region {
    pub(super) mesh: TriangleMesh,
    names: Vec<String>,
    /// The side each triangle belongs to.
    sides: Vec<usize>,
    /// The sheet each triangle belongs to.
    pub(super) sheets: Vec<usize>,
    /// A point and the inward normal of each sheet that is flat.
    planes: Vec<Option<[Point<3>; 2]>>,
    nodes: BTreeMap<[u32; 2], Point<3>>,
}

impl Region {
    /// The inside of triangles, each of which belongs to one of the named sides. Edges at which the surface
    /// turns by more than an angle (degrees) stay sharp.
    ///
    /// # Errors
    /// Those of [`TriangleMesh::check`].
    pub fn new(
        mesh: TriangleMesh,
        names: Vec<String>,
        sides: Vec<usize>,
        smooth: f64,
    ) -> Result<Self, SurfaceFault> {
        mesh.check()?;
        let sheets = sheets(&mesh, smooth);
        let planes = planes(&mesh, &sheets);
        let mut region = Self { mesh, names, sides, sheets, planes, nodes: BTreeMap::new() };
        region.find_nodes();
        Ok(region)
    }

    /// Names of its sides.
    #[must_use]
    pub fn sides(&self) -> &[String] {
        &self.names
    }

    /// Number of its smooth parts.
    #[must_use]
    pub fn n_sheets(&self) -> usize {
        self.planes.len()
    }

    /// Its triangles, straight.
    #[must_use]
    pub fn triangles(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Its volume by quadratic triangles (m3).
    #[must_use]
    pub fn volume(&self) -> f64 {
        // Seen from inside
        -enclosed(&self.patches()).moments.volume
    }

    /// Unit normals into the region at the vertices of each sheet.
    fn normals(&self) -> BTreeMap<[usize; 2], Point<3>> {
        let mut normals: BTreeMap<[usize; 2], Point<3>> = BTreeMap::new();
        for (triangle, vertices) in self.mesh.triangles.iter().enumerate() {
            let corners = self.mesh.corners(triangle);
            let sheet = self.sheets[triangle];
            let normal = -self.mesh.area_vector(triangle).normalize();
            for local in 0..3 {
                let [to, from] = [1, 2].map(|step| corners[(local + step) % 3] - corners[local]);
                let angle = to.cross(&from).norm().atan2(to.dot(&from));
                *normals.entry([vertices[local] as usize, sheet]).or_default() += normal * angle;
            }
        }
        for ([_, sheet], normal) in &mut normals {
            let own = self.planes[*sheet].map(|[_, normal]| normal);
            *normal = own.or_else(|| normal.try_normalize(0.0)).unwrap_or(*normal);
        }
        normals
    }

    /// Nodes in the edges of quadratic triangles, which are those of both sheets at a sharp edge.
    fn find_nodes(&mut self) {
        let normals = self.normals();
        for ([from, to], beside) in edges_of(&self.mesh) {
            let [a, b] = [from, to].map(|end| self.mesh.vertices[end as usize]);
            let mut wanted: Vec<[Point<3>; 2]> = Vec::new();
            let mut sheets: Vec<usize> =
                beside.iter().map(|one| self.sheets[one.triangle]).collect();
            sheets.dedup();
            for sheet in sheets {
                let [m, n] = [from, to].map(|end| normals[&[end as usize, sheet]]);
                let way = b - a;
                // As of PN triangles (@vlachos2001)
                wanted.push([m + n, (n * way.dot(&n) - m * way.dot(&m)) / 8.0]);
            }
            self.nodes.insert([from, to], (a + b) * 0.5 + common_offset(&wanted));
        }
        // Where quadratic triangles are folded they stay straight
        loop {
            let is_folded = |patch: &Patch| patch.is_curved() && patch.least_cosine() < UNFOLDED;
            let all = self.patches();
            let folded = all.iter().zip(&self.mesh.triangles).filter(|(patch, _)| is_folded(patch));
            let folded: Vec<[u32; 3]> = folded.map(|(_, vertices)| *vertices).collect();
            if folded.is_empty() {
                return;
            }
            for [from, to] in folded.into_iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]) {
                let [a, b] = [from, to].map(|end| self.mesh.vertices[end as usize]);
                self.nodes.insert([from.min(to), from.max(to)], (a + b) * 0.5);
            }
        }
    }

    /// Its quadratic triangles, as those of one closed surface.
    fn patches(&self) -> Vec<Patch> {
        let patch = |vertices: &[u32; 3]| {
            let [a, b, c] = *vertices;
            let node = |from: u32, to: u32| self.nodes[&[from.min(to), from.max(to)]];
            let corners = vertices.map(|vertex| self.mesh.vertices[vertex as usize]);
            Patch::new(corners, [node(a, b), node(b, c), node(c, a)], [false; 3])
        };
        self.mesh.triangles.iter().map(patch).collect()
    }

    /// The surfaces that bound it, with the sizes that are wanted on them.
    pub(super) fn geometry(&self, sizing: &Sizing<3>) -> Geometry {
        let mut own = vec![Vec::new(); self.n_sheets()];
        for (triangle, sheet) in self.sheets.iter().enumerate() {
            own[*sheet].push(triangle);
        }
        let wanted = self.wanted(sizing);
        let rims = Rims::of(self);
        let sheet = |(sheet, own): (usize, &Vec<usize>)| {
            let patches = own.iter().map(|triangle| rims.patch(self, *triangle)).collect();
            let triangles = own.iter().map(|triangle| wanted[*triangle]).collect();
            let sheet = Sheet::new(patches, triangles, self.planes[sheet]);
            let mut surface = SmoothSurface::of_sheet(Arc::new(sheet));
            surface.size = sizing.size;
            surface.turn = sizing.turn;
            surface.find_bends(sizing.growth);
            surface
        };
        let sheets = own.iter().enumerate().map(sheet).collect();
        let side = |name: &String| Boundary { name: name.clone(), kind: BoundaryKind::Side };
        let boundaries = self.names.iter().map(side).collect();
        Geometry::inside(sheets, boundaries, Arc::new(Facets::new(self.patches())))
    }

    /// What is wanted on each triangle: the size of its side, that by its curvature, and layers across.
    fn wanted(&self, sizing: &Sizing<3>) -> Vec<SheetTriangle> {
        let of_side = |name: &String| {
            let own = sizing.sides.iter().filter(|(named, _)| named == name);
            own.map(|(_, size)| *size).fold(sizing.size, f64::min)
        };
        let sizes: Vec<f64> = self.names.iter().map(of_side).collect();
        let (normals, widths) = (self.normals(), self.widths());
        let wanted = |(triangle, vertices): (usize, &[u32; 3])| {
            let (corners, sheet) = (self.mesh.corners(triangle), self.sheets[triangle]);
            let (mut curvature, mut shortest) = (0.0_f64, f64::INFINITY);
            for local in 0..3 {
                let next = (local + 1) % 3;
                let length = (corners[next] - corners[local]).norm();
                let [m, n] = [local, next].map(|i| normals[&[vertices[i] as usize, sheet]]);
                curvature = curvature.max((m - n).norm() / length);
                shortest = shortest.min(length);
            }
            let radius = (1.0 / curvature).max(RESOLVED * shortest);
            let side = self.sides[triangle];
            let size = sizes[side].min(sizing.turn * radius);
            let size = size.min(widths[triangle] / sizing.gap_layers);
            SheetTriangle { side: BoundaryId::new(side), radius, size }
        };
        self.mesh.triangles.iter().enumerate().map(wanted).collect()
    }

    /// From the middles of triangles, of so many as can be looked at, straight across to the wall that faces
    /// them (m).
    fn widths(&self) -> Vec<f64> {
        let n = self.mesh.triangles.len();
        let every = (n * n / MOST_PAIRS).max(1);
        let mut widths = vec![f64::INFINITY; n];
        for triangle in (0..n).step_by(every) {
            let from = self.mesh.corners(triangle).iter().sum::<Point<3>>() / 3.0;
            let inward = -self.mesh.area_vector(triangle).normalize();
            for other in (0..n).filter(|other| *other != triangle) {
                let normal = -self.mesh.area_vector(other);
                if normal.dot(&inward) < FACING * normal.norm()
                    && let Some(way) = ray_to(from, inward, self.mesh.corners(other))
                {
                    widths[triangle] = widths[triangle].min(way);
                }
            }
        }
        widths
    }
}

/// The edges and vertices at which sheets end.
struct Rims {
    edges: BTreeSet<[u32; 2]>,
    vertices: BTreeSet<u32>,
    patches: Vec<Patch>,
}

impl Rims {
    fn of(region: &Region) -> Self {
        let is_rim = |triangles: &[usize]| {
            triangles.windows(2).any(|pair| region.sheets[pair[0]] != region.sheets[pair[1]])
        };
        let edges: BTreeSet<[u32; 2]> = edges_of(&region.mesh)
            .into_iter()
            .filter(|(_, beside)| {
                is_rim(&beside.iter().map(|one| one.triangle).collect::<Vec<_>>())
            })
            .map(|(ends, _)| ends)
            .collect();
        let vertices = edges.iter().flatten().copied().collect();
        Self { edges, vertices, patches: region.patches() }
    }

    /// A triangle that knows where its sheet ends.
    fn patch(&self, region: &Region, triangle: usize) -> Patch {
        let vertices = region.mesh.triangles[triangle];
        let edge = |i: usize| {
            let [a, b] = [vertices[i], vertices[(i + 1) % 3]];
            self.edges.contains(&[a.min(b), a.max(b)])
        };
        let corners = vertices.map(|vertex| self.vertices.contains(&vertex));
        self.patches[triangle].clone().with_rim([0, 1, 2].map(edge), corners)
    }
}

/// Numbers of the smooth parts that triangles belong to.
fn sheets(mesh: &TriangleMesh, smooth: f64) -> Vec<usize> {
    let n = mesh.triangles.len();
    let mut groups = Groups::new(n);
    for beside in edges_of(mesh).values() {
        if let [one, other] = beside[..]
            && mesh.turn(one.triangle, other.triangle).to_degrees() <= smooth
        {
            groups.join(one.triangle, other.triangle);
        }
    }
    join_splinters(mesh, smooth, &mut groups);
    let mut numbers = BTreeMap::new();
    let number = |triangle| {
        let next = numbers.len();
        *numbers.entry(groups.root(triangle)).or_insert(next)
    };
    (0..n).map(number).collect()
}

/// Joins sheets of a few triangles to a larger one that they turn against by little more than a smooth wall does:
/// coarse triangles at edges that fade out leave such. Where there are only small ones, as on a polyhedron, they
/// are its faces.
fn join_splinters(mesh: &TriangleMesh, smooth: f64, groups: &mut Groups) {
    let edges = edges_of(mesh);
    let most = (2.0 * smooth).min(MOST_FADED);
    loop {
        let mut sizes: BTreeMap<usize, usize> = BTreeMap::new();
        for triangle in 0..mesh.triangles.len() {
            *sizes.entry(groups.root(triangle)).or_default() += 1;
        }
        let mut least: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
        for beside in edges.values() {
            let [one, other] = beside[..] else { continue };
            let angle = mesh.turn(one.triangle, other.triangle).to_degrees();
            let pair = [one.triangle, other.triangle];
            for (own, across) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                let root = groups.root(own);
                let is_splinter =
                    sizes[&root] <= SPLINTER && sizes[&groups.root(across)] > SPLINTER;
                let known = least.get(&root).map_or(most, |known| known.0);
                if is_splinter && angle < known {
                    least.insert(root, (angle, across));
                }
            }
        }
        if least.is_empty() {
            return;
        }
        for (own, (_, across)) in least {
            groups.join(own, across);
        }
    }
}

/// A point and the inward normal of each sheet whose vertices are in one plane.
fn planes(mesh: &TriangleMesh, sheets: &[usize]) -> Vec<Option<[Point<3>; 2]>> {
    let n = sheets.iter().max().map_or(0, |last| last + 1);
    let mut sums = vec![(Point::<3>::zeros(), Point::<3>::zeros(), 0.0); n];
    for (triangle, sheet) in sheets.iter().enumerate() {
        let area = mesh.area_vector(triangle);
        let (normal, first, weight) = &mut sums[*sheet];
        *normal -= area;
        *first += mesh.corners(triangle).iter().sum::<Point<3>>() / 3.0 * area.norm();
        *weight += area.norm();
    }
    let plane = |(normal, first, weight): (Point<3>, Point<3>, f64)| {
        let normal = normal.try_normalize(0.0)?;
        Some([first / weight, normal])
    };
    let mut planes: Vec<_> = sums.into_iter().map(plane).collect();
    let tolerance = FLAT * mesh.extent();
    for (triangle, sheet) in sheets.iter().enumerate() {
        let is_off = |[on, normal]: [Point<3>; 2]| {
            let corners = mesh.corners(triangle);
            corners.iter().any(|corner| normal.dot(&(corner - on)).abs() > tolerance)
        };
        if planes[*sheet].is_some_and(is_off) {
            planes[*sheet] = None;
        }
    }
    planes
}

/// The shortest offset of the node of an edge that has the heights over both surfaces which these want: pairs
/// of their normals and the offsets wanted (m).
fn common_offset(wanted: &[[Point<3>; 2]]) -> Point<3> {
    match wanted {
        [] => Point::zeros(),
        [[_, offset]] => *offset,
        [[m, one], [n, other], ..] => {
            let [m, n] = [m, n].map(|normal| normal.try_normalize(0.0).unwrap_or_default());
            let heights = [m.dot(one), n.dot(other)];
            let cosine = m.dot(&n);
            let sine = 1.0 - cosine * cosine;
            // Two planes that hardly differ have no line in common
            if sine < 0.05 {
                return (one + other) * 0.5;
            }
            m * ((heights[0] - cosine * heights[1]) / sine)
                + n * ((heights[1] - cosine * heights[0]) / sine)
        }
    }
}

/// The way from a point along a unit vector to a triangle (m), if it is met.
fn ray_to(from: Point<3>, along: Point<3>, [a, b, c]: [Point<3>; 3]) -> Option<f64> {
    let (one, two) = (b - a, c - a);
    let across = along.cross(&two);
    let determinant = one.dot(&across);
    if determinant == 0.0 {
        return None;
    }
    let off = from - a;
    let u = off.dot(&across) / determinant;
    let over = off.cross(&one);
    let v = along.dot(&over) / determinant;
    let way = two.dot(&over) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && way > 0.0).then_some(way)
}

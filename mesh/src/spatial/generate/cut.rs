//! The cut of the mesh by one surface: vertices near it are moved onto it, edges through it split,
//! and cells beyond it dropped.

use super::bisection::DIP;
use super::improve::{Improver, Split};
use super::tetrahedra::Face;
use super::tetrahedra::boundary_edges::tag_of;
use super::tetrahedra::measure::{FACES, middle};
use super::tetrahedra::surface_set::SurfaceSet;
use crate::{MeshError, Point, interrupt};

/// Vertices are moved along an edge onto a surface that cuts it nearer than this part of its length.
const NEAR: f64 = 0.35;

/// Vertices farther from a surface than this part of an edge are not moved onto it.
const FAR: f64 = 0.6;

/// Cells around a vertex that is moved keep this quality, or half of what they had.
const KEPT_QUALITY: f64 = 0.08;

/// Gaps below this are none (m, over the size of the mesh).
pub(super) const ON_SURFACE: f64 = 1e-12;

/// Steps of the search for the place where a surface cuts an edge.
const MOST_STEPS: usize = 40;

/// A cut that is being made.
pub(super) struct Cut<'i, 'a> {
    pub(super) improver: &'i mut Improver<'a>,
    pub(super) index: u16,
    /// Gap of each vertex to the surface (m), zero where the vertex counts as on it; not a number where
    /// the surface does not matter.
    pub(super) gaps: Vec<f64>,
    /// Gaps below this are none (m).
    pub(super) tolerance: f64,
}

/// A vertex that may be moved, and the part of an edge it moves along.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    part: f64,
    vertex: u32,
}

impl Improver<'_> {
    /// Cuts the mesh by a surface.
    ///
    /// # Errors
    /// [`MeshError::PoorTetrahedra`] where the surface cuts nothing off.
    pub fn cut(&mut self, index: u16) -> Result<(), MeshError> {
        let surface = &self.geometry.surfaces[usize::from(index)];
        let [min, max] = self.geometry.corners;
        let tolerance = ON_SURFACE * (max - min).amax();
        let gaps = self.gaps_to(usize::from(index));
        let mut cut = Cut { improver: &mut *self, index, gaps, tolerance };
        cut.move_vertices();
        interrupt::check()?;
        cut.split_edges();
        interrupt::check()?;
        // Only a part of a body can be hidden, in another part
        if cut.drop_cells() == 0 && !self.geometry.has_creases() {
            let at = surface.origin().into();
            let reason = "a surface cuts no cells off, the number of those cut";
            return Err(MeshError::PoorTetrahedra { reason, value: 0.0, at });
        }
        Ok(())
    }

    /// Gaps of all vertices to a surface (m); a lower bound far from it.
    fn gaps_to(&self, index: usize) -> Vec<f64> {
        let surface = &self.geometry.surfaces[index];
        let gap = |point: &Point<3>| {
            let least = surface.least_gap(self.geometry.periods.beside(*point, surface.origin()));
            if least > surface.reach() { least } else { self.geometry.gap(index, *point) }
        };
        self.mesh.points.iter().map(gap).collect()
    }
}

impl Cut<'_, '_> {
    fn gap(&self, vertex: u32) -> f64 {
        self.gaps[vertex as usize]
    }

    /// Gap of a point to the surface (m).
    fn gap_at(&self, point: Point<3>) -> f64 {
        self.improver.geometry.gap(usize::from(self.index), point)
    }

    /// Edges that go through the surface, from the vertex beyond it to that in the fluid.
    fn cut_edges(&mut self) -> Vec<[u32; 2]> {
        let mut neighbours = Vec::new();
        let mut edges = Vec::new();
        for vertex in 0..self.improver.mesh.end_of_vertices() {
            if self.gap(vertex) < 0.0 {
                self.improver.mesh.neighbours(vertex, &mut neighbours);
                let inside = neighbours.iter().filter(|other| self.gap(**other) > 0.0);
                edges.extend(inside.map(|other| [vertex, *other]));
            }
        }
        edges
    }

    /// Part of the way from one end of an edge to the other at which the surface is met: by the
    /// secant, each third time by halving.
    fn crossing(&self, [from, to]: [u32; 2]) -> f64 {
        let [a, b] = self.improver.mesh.corners([from, to]);
        let (mut low, mut high) = (0.0, 1.0);
        let [mut gap_low, mut gap_high] = [self.gap(from), self.gap(to)];
        let mut part = 0.5;
        for step in 0..MOST_STEPS {
            part = if step % 3 == 2 {
                0.5 * (low + high)
            } else {
                low + (high - low) * gap_low / (gap_low - gap_high)
            };
            let gap = self.gap_at(a + (b - a) * part);
            if gap.abs() < self.tolerance {
                break;
            }
            if (gap > 0.0) == (gap_low > 0.0) {
                (low, gap_low) = (part, gap);
            } else {
                (high, gap_high) = (part, gap);
            }
        }
        part
    }

    /// Part of an edge along which its first end would move onto the surface; `None` where that is
    /// too far.
    fn part_to_move(&self, edge: [u32; 2]) -> Option<f64> {
        if self.gap(edge[0]).abs() >= FAR * self.improver.mesh.length(edge[0], edge[1]) {
            return None;
        }
        Some(self.crossing(edge)).filter(|part| *part < NEAR)
    }

    /// Vertices near the surface, the nearest first.
    fn candidates(&mut self) -> Vec<Candidate> {
        let mut parts = vec![f64::INFINITY; self.gaps.len()];
        for [a, b] in self.cut_edges() {
            for edge in [[a, b], [b, a]] {
                if let Some(part) = self.part_to_move(edge) {
                    let least = &mut parts[edge[0] as usize];
                    *least = least.min(part);
                }
            }
        }
        let mut candidates = Vec::new();
        for vertex in self.improver.mesh.vertices() {
            if self.gap(vertex).abs() < self.tolerance {
                candidates.push(Candidate { part: 0.0, vertex });
            } else if parts[vertex as usize].is_finite() {
                candidates.push(Candidate { part: parts[vertex as usize], vertex });
            }
        }
        candidates.sort_by(|a, b| a.part.total_cmp(&b.part).then(a.vertex.cmp(&b.vertex)));
        candidates
    }

    /// Moves the vertices near the surface onto it, where their cells stay good.
    pub(super) fn move_vertices(&mut self) {
        let mut neighbours = Vec::new();
        for Candidate { vertex, .. } in self.candidates() {
            if interrupt::is_requested() {
                return;
            }
            self.improver.mesh.neighbours(vertex, &mut neighbours);
            let gap = self.gap(vertex);
            // Its neighbours may have been moved since
            let is_near = gap.abs() < self.tolerance
                || neighbours.iter().any(|&other| {
                    gap * self.gap(other) < 0.0 && self.part_to_move([vertex, other]).is_some()
                });
            let Some(surfaces) = self.improver.mesh.surfaces(vertex).with(self.index) else {
                continue;
            };
            if !is_near || self.improver.is_fixed(surfaces) {
                continue;
            }
            let point = self.improver.project(surfaces, self.improver.mesh.point(vertex));
            let is_on = self.gap_at(point).abs() <= 1e3 * self.tolerance;
            if !is_on || self.improver.crosses_earlier(vertex, point, self.index) {
                continue;
            }
            if gap < 0.0 && self.would_bridge(point, &neighbours) {
                continue;
            }
            let here = self.improver.mesh.point(vertex);
            let before = self.improver.least_quality_at(vertex, here, 0.0);
            let after = self.improver.least_quality_at(vertex, point, 0.0);
            if after > KEPT_QUALITY.min(0.5 * before) {
                let size = self.improver.sizes.at(point);
                self.improver.mesh.move_vertex(vertex, point, size);
                self.improver.mesh.surfaces[vertex as usize] = surfaces;
                self.gaps[vertex as usize] = 0.0;
            }
        }
    }

    /// Whether a vertex beyond the surface, once it is at a point on it (m), would have an edge through
    /// a thin body to one of its neighbours, the fluid of the other side.
    fn would_bridge(&self, point: Point<3>, neighbours: &[u32]) -> bool {
        neighbours.iter().filter(|other| self.gap(**other) > 0.0).any(|&other| {
            let [there] = self.improver.mesh.corners_beside([other], point);
            self.gap_at(middle(point, there)) < -DIP * (point - there).norm()
        })
    }

    /// Splits all edges that go through the surface where they do.
    pub(super) fn split_edges(&mut self) {
        let mut shell = Vec::new();
        for ends in self.cut_edges() {
            if interrupt::is_requested() {
                return;
            }
            self.improver.mesh.shell(ends[0], ends[1], &mut shell);
            let part = self.crossing(ends).clamp(1e-3, 1.0 - 1e-3);
            let [a, b] = self.improver.mesh.corners(ends);
            let straight = a + (b - a) * part;
            let edge = self.improver.surfaces_along(ends);
            let surfaces = edge.with(self.index).unwrap_or(edge);
            // On a ridge the point is that of all surfaces, or of the edge where that is too far
            let on_ridge = (!edge.is_empty()).then(|| self.improver.project(surfaces, straight));
            let vertex = on_ridge
                .and_then(|point| self.try_split(ends, point, surfaces, &shell))
                .or_else(|| self.try_split(ends, straight, surfaces, &shell));
            if vertex.is_some() {
                self.gaps.push(0.0);
            } else {
                let [a, b] = ends.map(|end| self.gap(end).abs());
                self.gaps[ends[usize::from(b < a)] as usize] = 0.0;
            }
        }
    }

    fn try_split(
        &mut self,
        ends: [u32; 2],
        point: Point<3>,
        surfaces: SurfaceSet,
        shell: &[u32],
    ) -> Option<u32> {
        let split = Split { ends, point, surfaces, least_quality: 0.0 };
        self.improver.split(&split, shell)
    }

    /// Drops the cells beyond the surface and tags the faces they leave; gives their number.
    fn drop_cells(&mut self) -> usize {
        let (geometry, index) = (self.improver.geometry, usize::from(self.index));
        let mesh = &mut self.improver.mesh;
        let mut is_beyond = vec![false; mesh.cells().last().map_or(0, |last| last as usize + 1)];
        let mut beyond = Vec::new();
        for cell in mesh.cells() {
            let gaps = mesh.cell(cell).map(|vertex| self.gaps[vertex as usize]);
            let most = gaps.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let least = gaps.into_iter().fold(f64::INFINITY, f64::min);
            // A cell with all its vertices on the surface goes by its middle
            let is_dropped = most <= 0.0
                && (least < 0.0 || {
                    let middle: Point<3> =
                        mesh.corners(mesh.cell(cell)).iter().sum::<Point<3>>() * 0.25;
                    geometry.gap(index, middle) <= 0.0
                });
            if is_dropped {
                is_beyond[cell as usize] = true;
                beyond.push(cell);
            }
        }
        let mut left: Vec<Face> = Vec::new();
        for &cell in &beyond {
            for face in FACES {
                let vertices = face.map(|local| mesh.cell(cell)[local]);
                let across = mesh.across(vertices, cell);
                left.extend(across.filter(|face| !is_beyond[face.cell as usize]));
            }
        }
        for cell in &beyond {
            mesh.delete_cell(*cell);
        }
        for face in left {
            mesh.set_tag(face, tag_of(self.index));
        }
        beyond.len()
    }
}

impl Improver<'_> {
    /// Makes the surfaces of each vertex those of the boundary faces around it, and moves vertices
    /// that were left off their surfaces onto them where their cells stay good.
    pub fn settle_boundary(&mut self) {
        let mut surfaces = vec![SurfaceSet::EMPTY; self.mesh.points.len()];
        for cell in self.mesh.cells() {
            let tags = self.mesh.tags(cell);
            for (face, tag) in FACES.into_iter().zip(tags).filter(|(_, tag)| *tag > 0) {
                for local in face {
                    let set = &mut surfaces[self.mesh.cell(cell)[local] as usize];
                    *set = set.with(tag - 1).unwrap_or(*set);
                }
            }
        }
        self.mesh.surfaces = surfaces;
        self.mesh.forget_qualities();
        self.pull_vertices();
    }

    /// Moves vertices off their surfaces onto them where their cells stay good.
    pub fn pull_vertices(&mut self) {
        for vertex in 0..self.mesh.end_of_vertices() {
            if interrupt::is_requested() {
                return;
            }
            let surfaces = self.mesh.surfaces(vertex);
            let is_settled = surfaces.is_empty() || self.is_fixed(surfaces);
            if is_settled || self.mesh.around(vertex).is_empty() {
                continue;
            }
            let here = self.mesh.point(vertex);
            let off = |surface: &u16| self.geometry.gap(usize::from(*surface), here).abs();
            let size = self.mesh.sizes[vertex as usize];
            if surfaces.as_slice().iter().map(off).fold(0.0, f64::max) < 1e-12 * size {
                continue;
            }
            let point = self.project(surfaces, here);
            let before = self.least_quality_at(vertex, here, 0.0);
            if self.least_quality_at(vertex, point, 0.0) > (0.5 * before).min(0.02) {
                self.mesh.move_vertex(vertex, point, self.sizes.at(point));
            }
        }
    }
}

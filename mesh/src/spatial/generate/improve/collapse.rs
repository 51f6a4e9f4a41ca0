//! The collapse of an edge: one of its ends is merged into the other.

use super::improver::{Improver, Pending};
use crate::Point;
use crate::spatial::generate::tetrahedra::Face;
use crate::spatial::generate::tetrahedra::boundary_edges::INNER;
use crate::spatial::generate::tetrahedra::measure::FACES;

/// Quality that every cell keeps.
const LEAST_QUALITY: f64 = 0.03;

/// Quality above which cells need not be kept as good as they were.
const GOOD: f64 = 0.35;

/// Cosine of the angle by which a boundary face may turn.
const LEAST_COSINE: f64 = 0.3;

/// What a collapse must achieve.
#[derive(Debug, Clone, Copy)]
pub enum CollapseGoal {
    /// The worst quality may fall to this part of what it was.
    Coarsen(f64),
    /// The worst quality has to rise.
    Improve,
}

/// A collapse that is being tried.
struct Collapse<'i, 'a> {
    improver: &'i mut Improver<'a>,
    /// The vertex that goes.
    gone: u32,
    /// The vertex it is merged into.
    kept: u32,
    goal: CollapseGoal,
    /// Cells around the edge.
    shell: Vec<u32>,
    /// Cells around the vertex that goes.
    ball: Vec<u32>,
    /// Their worst quality.
    before: f64,
}

impl Improver<'_> {
    /// Merges a vertex into another at the end of an edge, where cells stay good, the boundary stays
    /// on its surfaces, and no edge becomes longer than `longest` wanted lengths.
    pub fn collapse(&mut self, [gone, kept]: [u32; 2], goal: CollapseGoal, longest: f64) -> bool {
        let mut shell = Vec::new();
        self.mesh.shell(gone, kept, &mut shell);
        let edge = self.mesh.edge_surfaces(gone, kept);
        // A vertex moves along its surfaces only
        let is_fixed = self.is_fixed(self.mesh.surfaces(gone));
        if shell.is_empty() || is_fixed || !self.mesh.surfaces(gone).is_subset_of(edge) {
            return false;
        }
        let ball = self.mesh.around(gone).to_vec();
        let before = self.least_quality(&ball);
        let mut trial = Collapse { improver: self, gone, kept, goal, shell, ball, before };
        if !trial.keeps_quality() || !trial.keeps_lengths(longest) || !trial.keeps_topology() {
            return false;
        }
        let is_inside = edge.is_empty();
        if !is_inside && (!trial.keeps_surface() || !trial.keeps_neighbours()) {
            return false;
        }
        if edge.len() == 1 && trial.n_faces_at_edge() != 2 {
            return false;
        }
        trial.make()
    }
}

impl Collapse<'_, '_> {
    /// Vertices of a cell with the vertex that goes replaced.
    fn merged(&self, vertices: [u32; 4]) -> [u32; 4] {
        vertices.map(|vertex| if vertex == self.gone { self.kept } else { vertex })
    }

    fn is_good_enough(&self, quality: f64) -> bool {
        quality >= LEAST_QUALITY
            && match self.goal {
                CollapseGoal::Coarsen(part) => quality >= part * self.before.min(GOOD),
                CollapseGoal::Improve => quality > self.before + 1e-6,
            }
    }

    fn keeps_quality(&self) -> bool {
        let pending = Pending::Merge { vertex: self.gone, other: self.kept };
        let mesh = &self.improver.mesh;
        self.ball.iter().filter(|cell| !self.shell.contains(cell)).all(|&cell| {
            let vertices = mesh.cell(cell);
            let corners = mesh.corners(self.merged(vertices));
            // By the old names, under which the boundary edges are known
            self.is_good_enough(self.improver.quality_of(vertices, &corners, &pending))
        })
    }

    fn keeps_lengths(&self, longest: f64) -> bool {
        let mesh = &self.improver.mesh;
        self.ball.iter().flat_map(|cell| mesh.cell(*cell)).all(|vertex| {
            vertex == self.gone
                || vertex == self.kept
                || mesh.relative_length(self.kept, vertex) <= longest
        })
    }

    /// Whether the vertices next to both ends are those of the ring around the edge: else the collapse
    /// would glue cells together (@dey1999).
    fn keeps_topology(&mut self) -> bool {
        let mesh = &mut self.improver.mesh;
        let (mut of_gone, mut of_kept) = (Vec::new(), Vec::new());
        mesh.neighbours(self.gone, &mut of_gone);
        mesh.neighbours(self.kept, &mut of_kept);
        let n_common = mesh.n_common(&of_gone, &of_kept);
        let mut ring: Vec<u32> = self.shell.iter().flat_map(|cell| mesh.cell(*cell)).collect();
        ring.sort_unstable();
        ring.dedup();
        n_common + 2 == ring.len()
    }

    fn keeps_surface(&self) -> bool {
        let mesh = &self.improver.mesh;
        let gone_at = mesh.point(self.gone);
        let [kept_at] = mesh.corners_beside([self.kept], gone_at);
        for &cell in &self.ball {
            for (opposite, tag) in mesh.tags(cell).into_iter().enumerate() {
                let vertices = mesh.face_vertices(Face { cell, opposite });
                let is_moved = tag != INNER && vertices.contains(&self.gone);
                if !is_moved || vertices.contains(&self.kept) {
                    continue;
                }
                let before = mesh.corners_beside(vertices, gone_at);
                let after =
                    std::array::from_fn(
                        |i| {
                            if vertices[i] == self.gone { kept_at } else { before[i] }
                        },
                    );
                if !self.improver.follows_surface(&after, tag)
                    || !self.improver.is_fine_enough(&after, tag)
                    || cosine_between(&before, &after) < LEAST_COSINE
                {
                    return false;
                }
            }
        }
        true
    }

    /// Whether cells at the vertex that stays stay good, whose edges become edges of the boundary.
    fn keeps_neighbours(&mut self) -> bool {
        if !self.improver.is_curved() {
            return true;
        }
        let pending = Pending::Merge { vertex: self.kept, other: self.gone };
        for cell in self.improver.mesh.around(self.kept).to_vec() {
            let mesh = &self.improver.mesh;
            let vertices = mesh.cell(cell);
            let is_affected = !vertices.contains(&self.gone)
                && vertices.iter().any(|&vertex| {
                    vertex != self.kept
                        && !mesh.edge_surfaces(self.gone, vertex).is_empty()
                        && mesh.edge_surfaces(self.kept, vertex).is_empty()
                });
            if !is_affected {
                continue;
            }
            let quality = self.improver.quality_of(vertices, &mesh.corners(vertices), &pending);
            let is_worse = quality < self.improver.quality(cell) - 1e-9;
            if quality < LEAST_QUALITY || (is_worse && !self.is_good_enough(quality)) {
                return false;
            }
        }
        true
    }

    /// Number of boundary faces at the edge.
    fn n_faces_at_edge(&self) -> usize {
        let mesh = &self.improver.mesh;
        let faces = self.shell.iter().flat_map(|&cell| {
            let tags = mesh.tags(cell).into_iter().enumerate();
            tags.filter(|(_, tag)| *tag != INNER).map(move |(opposite, _)| Face { cell, opposite })
        });
        let at_edge = |face: &Face| {
            let vertices = mesh.face_vertices(*face);
            vertices.contains(&self.gone) && vertices.contains(&self.kept)
        };
        faces.filter(at_edge).count()
    }

    /// Makes the collapse, unless two boundary faces would become one.
    fn make(&mut self) -> bool {
        let (gone, kept) = (self.gone, self.kept);
        // Boundary faces of the cells that vanish, which become those of their neighbours
        let mut faces = Vec::new();
        for &cell in &self.shell {
            let mesh = &self.improver.mesh;
            let (vertices, tags) = (mesh.cell(cell), mesh.tags(cell));
            let tag_opposite = |vertex: u32| {
                let at = vertices.iter().position(|other| *other == vertex);
                at.map_or(INNER, |local| tags[local])
            };
            let [one, other] = [tag_opposite(gone), tag_opposite(kept)];
            if one != INNER && other != INNER {
                return false;
            }
            if one != INNER || other != INNER {
                let opposite = vertices.iter().position(|vertex| *vertex == gone).unwrap_or(0);
                faces.push((FACES[opposite].map(|local| vertices[local]), one.max(other)));
            }
        }
        let mesh = &mut self.improver.mesh;
        for &cell in &self.shell {
            mesh.delete_cell(cell);
        }
        for &cell in &self.ball {
            if self.shell.contains(&cell) {
                continue;
            }
            let (vertices, tags) = (mesh.cell(cell), mesh.tags(cell));
            mesh.delete_cell(cell);
            mesh.add_cell(vertices.map(|vertex| if vertex == gone { kept } else { vertex }), tags);
        }
        for (vertices, tag) in faces {
            if let Some(face) = mesh.across(vertices, u32::MAX) {
                mesh.set_tag(face, tag);
            }
        }
        mesh.forget_around(kept);
        true
    }
}

/// Cosine of the angle between two triangles.
fn cosine_between(one: &[Point<3>; 3], other: &[Point<3>; 3]) -> f64 {
    let [u, v] = [one, other].map(|[a, b, c]| (b - a).cross(&(c - a)));
    u.dot(&v) / (u.norm() * v.norm()).max(f64::MIN_POSITIVE)
}

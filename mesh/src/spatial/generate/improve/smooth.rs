//! Moves of single vertices: to the middle of what is around them, and up the slope of the worst
//! qualities.

use super::improver::{Improver, LEAST_CLEARANCE, Pending};
use crate::Point;
use crate::spatial::generate::tetrahedra::Face;
use crate::spatial::generate::tetrahedra::boundary_edges::INNER;
use crate::spatial::generate::tetrahedra::measure::{middle, six_volumes};
use crate::spatial::generate::tetrahedra::surface_set::SurfaceSet;

/// Steps up the slope in one go.
const ASCENTS: usize = 2;

/// Step of finite differences, over the local length.
const DIFFERENCE: f64 = 1e-4;

/// Quality below which cells weigh no more in the slope.
const SOFT_FLOOR: f64 = 0.01;

/// A sum of points with weights.
struct Mean {
    sum: Point<3>,
    weight: f64,
}

impl Mean {
    fn add(&mut self, point: Point<3>, weight: f64) {
        self.sum += point * weight;
        self.weight += weight;
    }
}

impl Improver<'_> {
    /// Moves a vertex to where the worst quality around it is higher, along its surfaces where it is on
    /// some; with `climb` also where the way to the middle leads to no better place.
    pub fn smooth(&mut self, vertex: u32, climb: bool) -> bool {
        let surfaces = self.mesh.surfaces(vertex);
        let is_fixed = surfaces.len() >= 3 || self.is_fixed(surfaces);
        if self.mesh.around(vertex).is_empty() || is_fixed {
            return false;
        }
        let around = self.mesh.around(vertex).to_vec();
        let mut quality = self.least_quality(&around);
        let mut is_moved = false;
        if let Some(center) = self.center_around(vertex, surfaces) {
            let from = self.mesh.point(vertex);
            for part in [1.0, 0.5, 0.25] {
                let to = self.project(surfaces, from + (center - from) * part);
                if self.try_move(vertex, to, &mut quality, 0.0) {
                    is_moved = true;
                    break;
                }
            }
        }
        if climb {
            for _ in 0..ASCENTS {
                if !self.climb(vertex, &mut quality) {
                    break;
                }
                is_moved = true;
            }
        }
        if is_moved {
            let point = self.mesh.point(vertex);
            self.mesh.sizes[vertex as usize] = self.sizes.at(point);
        }
        is_moved
    }

    /// Moves a vertex where that raises the worst quality around it by some gain.
    fn try_move(&mut self, vertex: u32, to: Point<3>, quality: &mut f64, gain: f64) -> bool {
        let moved = self.least_quality_at(vertex, to, *quality + gain);
        if moved <= *quality + gain || !self.may_be_at(vertex, to) {
            return false;
        }
        self.mesh.move_vertex(vertex, to, self.mesh.sizes[vertex as usize]);
        *quality = moved;
        true
    }

    /// Whether a vertex at a point (m) is in the fluid, or the faces around it follow their surface.
    fn may_be_at(&self, vertex: u32, point: Point<3>) -> bool {
        if self.mesh.surfaces(vertex).is_empty() {
            let is_boundary = |cell: &u32| self.mesh.tags(*cell).iter().any(|tag| *tag != INNER);
            return !self.is_curved()
                || !self.mesh.around(vertex).iter().any(is_boundary)
                || self.is_in_fluid(point, LEAST_CLEARANCE * self.mesh.sizes[vertex as usize]);
        }
        self.boundary_faces(vertex).all(|(face, tag)| {
            let corners = self.corners_with(self.mesh.face_vertices(face), vertex, point);
            self.follows_surface(&corners, tag)
                && (!self.is_curved() || self.is_fine_enough(&corners, tag))
        })
    }

    /// Boundary faces at a vertex with their tags.
    fn boundary_faces(&self, vertex: u32) -> impl Iterator<Item = (Face, u16)> + '_ {
        self.mesh.around(vertex).iter().flat_map(move |&cell| {
            let vertices = self.mesh.cell(cell);
            let tags = self.mesh.tags(cell).into_iter().enumerate();
            tags.filter(move |(opposite, tag)| *tag != INNER && vertices[*opposite] != vertex)
                .map(move |(opposite, tag)| (Face { cell, opposite }, tag))
        })
    }

    /// The mean of the middles of cells, faces or edges around a vertex, as it is inside the fluid, on
    /// a surface or on a ridge, each by its measure in units of the size wanted.
    fn center_around(&self, vertex: u32, surfaces: SurfaceSet) -> Option<Point<3>> {
        let mut mean = Mean { sum: Point::zeros(), weight: 0.0 };
        let size = |vertex: u32| self.mesh.sizes[vertex as usize];
        let here = self.mesh.point(vertex);
        match surfaces.len() {
            0 => {
                for &cell in self.mesh.around(vertex) {
                    let vertices = self.mesh.cell(cell);
                    let corners = self.mesh.corners_beside(vertices, here);
                    let size = vertices.map(size).iter().sum::<f64>() * 0.25;
                    let center = corners.iter().sum::<Point<3>>() * 0.25;
                    mean.add(center, six_volumes(&corners).max(0.0) / (size * size * size));
                }
            }
            1 => {
                for (face, _) in self.boundary_faces(vertex) {
                    let vertices = self.mesh.face_vertices(face);
                    let [a, b, c] = self.mesh.corners_beside(vertices, here);
                    let size = vertices.map(size).iter().sum::<f64>() / 3.0;
                    mean.add((a + b + c) / 3.0, (b - a).cross(&(c - a)).norm() / (size * size));
                }
            }
            _ => {
                for (face, _) in self.boundary_faces(vertex) {
                    for other in self.mesh.face_vertices(face) {
                        let along = surfaces.is_subset_of(self.mesh.edge_surfaces(vertex, other));
                        if other != vertex && along {
                            let [there] = self.mesh.corners_beside([other], here);
                            let size = 0.5 * (size(vertex) + size(other));
                            mean.add(middle(here, there), (there - here).norm() / size);
                        }
                    }
                }
            }
        }
        (mean.weight > 0.0).then(|| mean.sum / mean.weight)
    }

    /// One step up the slope of a smooth function of the qualities in which the worst dominate.
    fn climb(&mut self, vertex: u32, quality: &mut f64) -> bool {
        let surfaces = self.mesh.surfaces(vertex);
        let from = self.mesh.point(vertex);
        let length = 0.5 * self.mesh.sizes[vertex as usize].min(self.shortest_edge(vertex));
        let difference = DIFFERENCE * length;
        let here = self.soft_quality(vertex, from);
        let slope = Point::<3>::from_fn(|axis, _| {
            let mut there = from;
            there[axis] += difference;
            (self.soft_quality(vertex, there) - here) / difference
        });
        let steepness = slope.norm();
        if steepness.is_nan() || steepness < 1e-12 {
            return false;
        }
        let mut step = 0.25 * length;
        for _ in 0..6 {
            let to = self.project(surfaces, from + slope * (step / steepness));
            if self.try_move(vertex, to, quality, 1e-7) {
                return true;
            }
            step *= 0.4;
        }
        false
    }

    fn shortest_edge(&self, vertex: u32) -> f64 {
        let others = self.mesh.around(vertex).iter().flat_map(|cell| self.mesh.cell(*cell));
        let lengths =
            others.filter(|other| *other != vertex).map(|other| self.mesh.length(vertex, other));
        lengths.fold(f64::INFINITY, f64::min)
    }

    /// Minus the sum of the fourth powers of the inverse qualities around a vertex at a point (m).
    fn soft_quality(&self, vertex: u32, point: Point<3>) -> f64 {
        let mut sum = 0.0;
        for &cell in self.mesh.around(vertex) {
            let vertices = self.mesh.cell(cell);
            let corners = self.corners_with(vertices, vertex, point);
            let quality = self.quality_of(vertices, &corners, &Pending::Nothing);
            sum -= quality.max(SOFT_FLOOR).powi(-4);
        }
        sum
    }
}

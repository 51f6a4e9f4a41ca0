//! Point location: the cell that holds a point, and its reference coordinates there.
//!
//! A tree of cell boxes finds the candidates; the map of a straight cell is inverted exactly, that
//! of a curved one by Newton's method.

mod cell_faces;
mod cell_point;
mod neighbours;
mod walk;

pub use neighbours::Neighbours;

use crate::box_tree::{Bounds, BoxTree};
use crate::mesh::determinant;
use crate::number::index_u32;
use crate::{CellId, Mesh, Point, Simplex};
use cell_faces::{Face, push_faces};
use cell_point::{CellPoint, invert_quadratic, nearest_in_quadratic, nearest_in_simplex, solve};

/// A point this far outside (in sizes of the mesh) still counts as on its boundary.
const TOLERANCE: f64 = 1e-9;

/// Marks a cell without curved sides.
const STRAIGHT: u32 = u32::MAX;

/// Newton's method has found a point when it misses by this part of the cell's size at most.
const FOUND: f64 = 1e-10;

/// Part of the mean size of cells within which points on an exact curve are from the quadratic one.
const SHORT: f64 = 0.05;

/// Barycentric coordinates of a point inside may be negative by this, so that no point falls
/// between two cells.
const ROUNDING: f64 = 1e-12;

/// Where a point is in a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located<const D: usize> {
    /// The cell.
    pub cell: CellId,
    /// Reference coordinates in it; a little outside the simplex when the point is outside.
    pub reference: [f64; D],
    /// Distance from the point to the cell (m), zero inside.
    pub distance: f64,
}

/// Where an image of a point is in a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Image<const D: usize> {
    /// Where it is.
    pub located: Located<D>,
    /// Which of the shifts led to it.
    pub shift: usize,
}

/// Finds cells; keeps its own copy of the geometry, so the mesh may move on.
#[derive(Debug, Clone)]
pub struct Locator<const D: usize> {
    tree: BoxTree<D>,
    /// Boxes around the cells.
    boxes: Vec<Bounds<D>>,
    /// Positions of the vertices of all cells, D + 1 for each (m).
    vertices: Vec<Point<D>>,
    /// Faces of the straight cells, opposite to each vertex, D + 1 for each cell.
    faces: Vec<Face>,
    /// Where the nodes of each curved cell start in `quadratic`; [`STRAIGHT`] for the others.
    curved: Vec<u32>,
    /// Positions of the nodes of the curved cells (m).
    quadratic: Vec<Point<D>>,
    tolerance: f64,
    /// Distance within which points outside are sought first (m).
    short: f64,
}

impl<const D: usize> Locator<D> {
    /// Prepares the search in a mesh.
    #[must_use]
    pub fn new(mesh: &Mesh<D>) -> Self {
        let mut boxes = Vec::with_capacity(mesh.n_cells());
        let mut vertices = Vec::with_capacity((D + 1) * mesh.n_cells());
        let mut curved = vec![STRAIGHT; mesh.n_cells()];
        let mut quadratic = Vec::new();
        let mut faces = Vec::with_capacity((D + 1) * mesh.n_cells());
        let mut size = 0.0;
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell_nodes(cell);
            let mut bounds = Bounds::around(&nodes[..=D]);
            vertices.extend_from_slice(&nodes[..=D]);
            if mesh.curved[cell] {
                // A quadratic curve lies within the hull of its control points
                for (edge, &[i, j]) in Simplex::<D>::EDGES.iter().enumerate() {
                    for middle in &nodes[Simplex::<D>::edge_nodes(edge)] {
                        bounds.include(&(middle * 2.0 - (nodes[i] + nodes[j]) * 0.5));
                    }
                }
                curved[cell] = index_u32(quadratic.len());
                quadratic.extend_from_slice(&nodes);
            }
            push_faces(&nodes, mesh.curved[cell], &mut faces);
            size += (bounds.max - bounds.min).max();
            boxes.push(bounds);
        }
        let tree = BoxTree::new(&boxes);
        let tolerance = TOLERANCE * tree.extent();
        let short = SHORT * size / boxes.len().max(1) as f64;
        Self { tree, boxes, vertices, faces, curved, quadratic, tolerance, short }
    }

    /// The cell that holds a point (m), and the reference coordinates there; `None` outside.
    ///
    /// A point outside by rounding (1e-9 of the size of the mesh) is found in the nearest cell.
    #[must_use]
    pub fn locate(&self, point: Point<D>) -> Option<Located<D>> {
        self.search(point, self.tolerance)
    }

    /// The cell nearest to a point (m), however far outside; `None` only for a point that is not
    /// finite or a mesh without cells.
    ///
    /// Points on an exact curve may be outside the quadratic geometry by its fourth-order error:
    /// this finds where fields are to be extrapolated from.
    #[must_use]
    pub fn nearest(&self, point: Point<D>) -> Option<Located<D>> {
        self.search(point, f64::INFINITY)
    }

    /// The cell nearest to one of the images of a point: `point + shift` (m) for each shift. Of
    /// images that are equally near, the first one counts.
    ///
    /// `None` as from [`Self::nearest`], or without a shift.
    #[must_use]
    pub fn nearest_image(&self, point: Point<D>, shifts: &[Point<D>]) -> Option<Image<D>> {
        // Most points have an image inside, which a short search finds
        let at = |(shift, by): (usize, &Point<D>)| {
            self.locate(point + by).map(|located| Image { located, shift })
        };
        let mut inside = shifts.iter().enumerate().filter_map(at);
        if let Some(found) = inside.find(|found| found.located.distance == 0.0) {
            return Some(found);
        }
        // A long search begun at the wrong image goes through many cells
        self.nearest_of(point, shifts, self.short)
            .or_else(|| self.nearest_of(point, shifts, f64::INFINITY))
    }

    /// The nearest of the images within reach (m).
    fn nearest_of(&self, point: Point<D>, shifts: &[Point<D>], mut reach: f64) -> Option<Image<D>> {
        let mut best: Option<Image<D>> = None;
        for (shift, by) in shifts.iter().enumerate() {
            let Some(located) = self.search(point + by, reach) else { continue };
            if best.is_none_or(|best| located.distance < best.located.distance) {
                reach = located.distance + self.tolerance;
                best = Some(Image { located, shift });
            }
        }
        best
    }

    fn search(&self, point: Point<D>, reach: f64) -> Option<Located<D>> {
        let mut best: Option<Located<D>> = None;
        self.tree.visit_near(point, reach, |cell, reach| {
            // Inside is what is so by rounding, too
            let bound = reach.max(self.tolerance);
            if self.boxes[cell].squared_distance(&point) > bound * bound {
                return false;
            }
            let Some(found) = self.locate_in(CellId::new(cell), point, bound) else { return false };
            if found.distance <= *reach && best.is_none_or(|b| found.distance < b.distance) {
                best = Some(found);
                *reach = found.distance;
            }
            found.distance == 0.0
        });
        best
    }

    /// Vertices of a cell (m), D + 1 of them.
    fn vertices_of(&self, cell: CellId) -> &[Point<D>] {
        &self.vertices[(D + 1) * cell.index()..(D + 1) * (cell.index() + 1)]
    }

    /// Nodes of a curved cell (m); `None` of a straight one.
    fn quadratic_nodes(&self, cell: CellId) -> Option<&[Point<D>]> {
        let start = self.curved[cell];
        (start != STRAIGHT)
            .then(|| &self.quadratic[start as usize..start as usize + Simplex::<D>::N_NODES])
    }

    /// By how much Newton's method may miss a point in a cell (m).
    fn found_within(&self, cell: CellId) -> f64 {
        let vertices = self.vertices_of(cell);
        FOUND * vertices[1..].iter().map(|vertex| (vertex - vertices[0]).norm()).sum::<f64>()
    }

    /// Where a point is with respect to one cell, unless that is farther than a bound (m).
    fn locate_in(&self, cell: CellId, point: Point<D>, bound: f64) -> Option<Located<D>> {
        let vertices = self.vertices_of(cell);
        let columns: [Point<D>; D] = std::array::from_fn(|k| vertices[k + 1] - vertices[0]);
        let straight = straight_coordinates(vertices, point);
        if self.is_beyond(cell, straight, bound) {
            return None;
        }
        let nodes = self.quadratic_nodes(cell);
        let found = match nodes {
            Some(nodes) => invert_quadratic(nodes, point, straight, self.found_within(cell)),
            None => Some(straight),
        };
        let reference = found.unwrap_or(straight);
        let is_inside = reference.iter().all(|x| *x >= -ROUNDING)
            && reference.iter().sum::<f64>() <= 1.0 + ROUNDING;
        if found.is_some() && is_inside {
            return Some(Located { cell, reference, distance: 0.0 });
        }
        let nearest = match nodes {
            Some(nodes) => nearest_in_quadratic(nodes, point, reference, &columns),
            None => {
                let inside = nearest_in_simplex(reference, &columns);
                let along = columns.iter().zip(inside);
                let position = along.fold(vertices[0], |sum, (column, x)| sum + column * x);
                CellPoint { reference: inside, position }
            }
        };
        let reference = if found.is_some() { reference } else { nearest.reference };
        Some(Located { cell, reference, distance: (point - nearest.position).norm() })
    }

    /// Whether a point is beyond a face of a cell by more than a bound (m), by its coordinates in the straight
    /// cell.
    fn is_beyond(&self, cell: CellId, straight: [f64; D], bound: f64) -> bool {
        let faces = &self.faces[(D + 1) * cell.index()..(D + 1) * (cell.index() + 1)];
        barycentric(straight).zip(faces).any(|(l, face)| (-l - face.beyond) * face.height > bound)
    }
}

/// Barycentric coordinates of a point with these reference coordinates, D + 1 of them.
fn barycentric<const D: usize>(reference: [f64; D]) -> impl Iterator<Item = f64> {
    let first = 1.0 - reference.iter().sum::<f64>();
    std::iter::once(first).chain(reference)
}

/// Reference coordinates of a point (m) in the straight cell with some vertices, D + 1 of them (m).
fn straight_coordinates<const D: usize>(vertices: &[Point<D>], point: Point<D>) -> [f64; D] {
    let columns: [Point<D>; D] = std::array::from_fn(|k| vertices[k + 1] - vertices[0]);
    solve(&columns, point - vertices[0], determinant(&columns))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::map_quadratic;
    use crate::test_meshes::{bulged_cube, cube_of_five, cube_of_twelve};
    use crate::{Domain, PlacedShape, Shape, Sizing, generate};

    pub(super) fn channel() -> Mesh<2> {
        let domain = Domain::Box {
            min: Point::<2>::zeros(),
            max: Point::<2>::new(2.2, 0.41),
            periodic_x: false,
            periodic_y: false,
        };
        let disc = PlacedShape {
            name: "disc".into(),
            shape: Shape::Disc { radius: 0.05 },
            center: Point::<2>::new(0.2, 0.2),
            angle: 0.0,
            size: None,
        };
        generate(&domain, &[disc], &Sizing::graded(0.02, 0.2, 0.08)).unwrap()
    }

    #[test]
    fn the_image_of_a_reference_point_is_found_there() {
        let mesh = channel();
        let locator = Locator::new(&mesh);
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell_nodes(cell);
            for at in [[0.3, 0.3], [0.05, 0.9], [0.5, 0.02], [0.02, 0.02]] {
                let found = locator.locate(map_quadratic(&nodes, at).position).unwrap();
                assert_eq!(found.cell, cell);
                let [x, y] = found.reference;
                assert!((x - at[0]).hypot(y - at[1]) < 1e-12);
            }
        }
    }

    #[test]
    fn every_node_is_found_and_points_outside_are_not() {
        let mesh = channel();
        let locator = Locator::new(&mesh);
        for node in &mesh.nodes {
            let found = locator.locate(*node).expect("nodes are in the mesh");
            let map = map_quadratic(&mesh.cell_nodes(found.cell), found.reference);
            assert!((map.position - node).norm() < 1e-13);
        }
        for (x, y) in [(0.2, 0.2), (0.2, 0.2 + 0.0499), (-1e-6, 0.2), (1.0, 0.42), (f64::NAN, 0.0)]
        {
            assert!(locator.locate(Point::<2>::new(x, y)).is_none(), "({x}, {y})");
        }
        assert!(locator.locate(Point::<2>::new(-1e-10, 0.2)).is_some());
    }

    #[test]
    fn the_nearest_image_is_that_of_the_plain_loop() {
        let mesh = channel();
        let locator = Locator::new(&mesh);
        let shifts: Vec<_> = (-2..=2)
            .flat_map(|i| (-2..=2).map(move |j| (f64::from(i), f64::from(j))))
            .map(|(i, j)| Point::<2>::new(2.2 * i, 0.41 * j))
            .collect();
        for (i, j) in (0..60).flat_map(|i| (0..60).map(move |j| (i, j))) {
            let point = Point::<2>::new(-3.0 + 0.1 * f64::from(i), -0.6 + 0.02 * f64::from(j));
            let all = shifts.iter().filter_map(|shift| locator.nearest(point + shift));
            let plain = all.min_by(|a, b| a.distance.total_cmp(&b.distance));
            let found = locator.nearest_image(point, &shifts);
            assert_eq!(found.map(|image| image.located), plain);
            assert!(found.is_none_or(|image| {
                locator.nearest(point + shifts[image.shift]) == Some(image.located)
            }));
        }
        let nowhere = Point::<2>::new(f64::NAN, 0.0);
        assert_eq!(locator.nearest_image(nowhere, &shifts), None);
        assert_eq!(locator.nearest_image(Point::<2>::zeros(), &[]), None);
    }

    #[test]
    fn points_just_inside_the_body_are_nearest_to_its_surface() {
        let mesh = channel();
        let locator = Locator::new(&mesh);
        for i in 0..100 {
            let (sin, cos) = (0.0628 * f64::from(i)).sin_cos();
            let point = Point::<2>::new(0.2 + 0.045 * cos, 0.2 + 0.045 * sin);
            let found = locator.nearest(point).unwrap();
            assert!((found.distance - 0.005).abs() < 1e-4, "{}", found.distance);
        }
    }

    /// Reference points well inside, close to a vertex, and close to a face.
    const INSIDE: [[f64; 3]; 3] = [[0.25, 0.2, 0.3], [0.02, 0.95, 0.01], [0.3, 0.3, 0.002]];

    #[test]
    fn points_of_a_tetrahedral_mesh_are_found_in_their_cells() {
        for mesh in [cube_of_five(), cube_of_twelve(), bulged_cube(0.2)] {
            let locator = Locator::new(&mesh);
            for cell in mesh.cell_ids() {
                for at in INSIDE {
                    let point = map_quadratic(&mesh.cell_nodes(cell), at).position;
                    let found = locator.locate(point).expect("the point is in the mesh");
                    assert_eq!((found.cell, found.distance), (cell, 0.0));
                    let off = Point::from(found.reference) - Point::from(at);
                    assert!(off.norm() < 1e-12, "{:?}", found.reference);
                }
            }
            assert!(mesh.nodes.iter().all(|node| locator.locate(*node).is_some()));
        }
    }

    #[test]
    fn points_outside_tetrahedra_are_refused_and_have_a_nearest_cell() {
        let straight = Locator::new(&cube_of_five());
        let above = Point::<3>::new(0.5, 0.4, 1.3);
        assert_eq!(straight.locate(above), None);
        let found = straight.nearest(above).expect("a mesh has a nearest cell");
        assert!((found.distance - 0.3).abs() < 1e-15);
        let at_corner = straight.nearest(Point::<3>::new(-2.0, -1.0, -2.0)).expect("likewise");
        assert!((at_corner.distance - 3.0).abs() < 1e-14);

        // The middle of a side is on a curved edge, which leaves it by a fifth of 1/2
        let mesh = bulged_cube(0.2);
        let curved = Locator::new(&mesh);
        let middle = Point::<3>::new(0.5, 0.5, 1.1);
        assert_eq!(curved.locate(middle).map(|found| found.distance), Some(0.0));
        let beyond = middle + Point::<3>::new(0.0, 0.0, 0.25);
        assert_eq!(curved.locate(beyond), None);
        let found = curved.nearest(beyond).expect("a mesh has a nearest cell");
        let closest = distance_to_places(&mesh, beyond);
        assert!(found.distance <= closest + 1e-12, "{} {closest}", found.distance);
        assert!(found.distance > closest - 1e-3, "{} {closest}", found.distance);
    }

    /// Distance from a point to the nearest of many places in all cells (m).
    fn distance_to_places(mesh: &Mesh<3>, point: Point<3>) -> f64 {
        let n = 40;
        let mut least = f64::INFINITY;
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell_nodes(cell);
            for (i, j, k) in (0..=n).flat_map(|i| {
                (0..=n - i).flat_map(move |j| (0..=n - i - j).map(move |k| (i, j, k)))
            }) {
                let at = [i, j, k].map(|m| f64::from(m) / f64::from(n));
                least = least.min((map_quadratic(&nodes, at).position - point).norm());
            }
        }
        least
    }
}

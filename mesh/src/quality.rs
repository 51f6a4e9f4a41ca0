//! `Quality`: how good a mesh is, in numbers and as a table, worst cells first.

use std::fmt;

use rayon::prelude::*;

use crate::mesh::{determinant, jacobian_coefficients};
use crate::{CellId, Mesh, Point, Simplex};

/// Worst cells listed.
const LISTED: usize = 5;
/// Cells a thread measures at a time, at least.
const CELLS_PER_TASK: usize = 512;

/// Numbers that describe a mesh.
///
/// Angles and mean ratios are those of the straight simplices; the angles of a tetrahedron are
/// those between its faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality<const D: usize = 2> {
    /// Cells.
    pub n_cells: usize,
    /// Vertices.
    pub n_vertices: usize,
    /// P2 nodes.
    pub n_nodes: usize,
    /// Unknowns of the Taylor-Hood element: D velocities per node, one pressure per vertex.
    pub n_dofs: usize,
    /// Smallest angle (degrees).
    pub min_angle: f64,
    /// Where it is: centre of its cell (m).
    pub min_angle_at: Point<D>,
    /// Mean over the cells of their smallest angle (degrees).
    pub mean_angle: f64,
    /// Smallest mean ratio, see [`Mesh::cell_quality`].
    pub min_ratio: f64,
    /// Mean of the mean ratios.
    pub mean_ratio: f64,
    /// Shortest edge (m).
    pub shortest_edge: f64,
    /// Longest edge (m).
    pub longest_edge: f64,
    /// Cells with a curved side.
    pub n_curved: usize,
    /// Smallest Bezier coefficient of det J of a curved cell over det J of the straight one; 1
    /// without curved cells.
    pub min_curved_jacobian: f64,
    /// The cells with the smallest mean ratio, worst first.
    pub worst: Vec<WorstCell<D>>,
}

/// One of the worst cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstCell<const D: usize = 2> {
    /// Index of the cell.
    pub cell: CellId,
    /// Its mean ratio.
    pub ratio: f64,
    /// Its smallest angle (degrees).
    pub angle: f64,
    /// Its centre (m).
    pub center: Point<D>,
}

/// Quality of one cell, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellQuality<const D: usize> {
    /// Index of the cell.
    pub cell: CellId,
    /// See [`Mesh::cell_quality`].
    pub quality: f64,
    /// Centre of the cell (m).
    pub center: Point<D>,
}

impl<const D: usize> CellQuality<D> {
    /// Whether the cell is neither inverted nor folded.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.quality > 0.0
    }
}

/// Measures of a straight simplex.
#[derive(Debug, Clone, Copy)]
struct StraightMeasures<const D: usize> {
    /// det J (m^D).
    det: f64,
    /// Sum of its squared edges (m²).
    squares: f64,
}

impl<const D: usize> StraightMeasures<D> {
    fn of(vertices: &[Point<D>]) -> Self {
        let det = determinant(&std::array::from_fn::<_, D, _>(|k| vertices[k + 1] - vertices[0]));
        let edges = Simplex::<D>::EDGES.iter();
        let squares = edges.map(|&[i, j]| (vertices[j] - vertices[i]).norm_squared()).sum();
        Self { det, squares }
    }

    /// Mean ratio: 1 when regular, 0 when flat, negative when inverted.
    fn mean_ratio(&self) -> f64 {
        if D == 2 {
            2.0 * 3.0_f64.sqrt() * self.det / self.squares
        } else {
            12.0 * self.det.signum() * (0.5 * self.det.abs()).powf(2.0 / 3.0) / self.squares
        }
    }
}

/// Smallest angle of a straight simplex (rad): at the vertices of a triangle, negative when it is
/// inverted; between the faces of a tetrahedron.
pub(crate) fn smallest_angle<const D: usize>(vertices: &[Point<D>]) -> f64 {
    let angle = |&[i, j]: &[usize; 2]| {
        let along = vertices[j] - vertices[i];
        let mut others = (0..=D).filter(|k| *k != i && *k != j).map(|k| vertices[k] - vertices[i]);
        let mut next = || others.next().unwrap_or(along);
        if D == 2 {
            let back = next();
            return (along[0] * back[1] - along[1] * back[0]).atan2(along.dot(&back));
        }
        let [p, q] = [next(), next()]
            .map(|side| side - along * (side.dot(&along) / along.norm_squared()))
            .map(|upright| upright.normalize());
        2.0 * (p - q).norm().atan2((p + q).norm())
    };
    Simplex::<D>::EDGES.iter().map(angle).fold(f64::INFINITY, f64::min)
}

impl<const D: usize> Mesh<D> {
    /// Quality of a cell: 1 when regular, 0 or less when inverted or folded, never NaN.
    ///
    /// The mean ratio of the straight simplex, 4 √3 area / (sum of squared edges) of a triangle and
    /// 12 (3 volume)^(2/3) / (sum of squared edges) of a tetrahedron; for a curved cell times the
    /// smallest Bezier coefficient of det J over that of the straight cell, where that is below one.
    ///
    /// # Source
    /// @liu1994 for the mean ratio, @johnen2013 for curved cells.
    #[must_use]
    pub fn cell_quality(&self, cell: CellId) -> f64 {
        let nodes = self.cell_nodes(cell);
        let straight = StraightMeasures::of(&nodes[..=D]);
        let (det, ratio) = (straight.det, straight.mean_ratio());
        let quality = if self.curved[cell] && det > 0.0 {
            // Unlike f64::min, the comparison keeps what is not a number
            let lowest = jacobian_coefficients(&nodes)
                .into_iter()
                .fold(det, |low, c| if c >= low { low } else { c });
            ratio * lowest / det
        } else {
            ratio
        };
        if quality.is_nan() { f64::NEG_INFINITY } else { quality }
    }

    /// The quality of each cell.
    #[must_use]
    pub fn cell_qualities(&self) -> Vec<f64> {
        let cells = (0..self.n_cells()).into_par_iter().with_min_len(CELLS_PER_TASK);
        cells.map(|cell| self.cell_quality(CellId::new(cell))).collect()
    }

    /// The cell with the lowest quality; `None` for a mesh without cells.
    #[must_use]
    pub fn worst_cell(&self) -> Option<CellQuality<D>> {
        let all = self.cell_ids().zip(self.cell_qualities());
        let (cell, quality) = all.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(CellQuality { cell, quality, center: self.cell_center(cell) })
    }
}

impl<const D: usize> Quality<D> {
    /// Measures a mesh.
    #[must_use]
    pub fn of(mesh: &Mesh<D>) -> Self {
        let n = mesh.n_cells();
        let mut all: Vec<WorstCell<D>> = Vec::with_capacity(n);
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        let mut min_curved_jacobian = 1.0_f64;
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell_nodes(cell);
            for &[i, j] in Simplex::<D>::EDGES {
                let length = (nodes[j] - nodes[i]).norm();
                shortest = shortest.min(length);
                longest = longest.max(length);
            }
            let straight = StraightMeasures::of(&nodes[..=D]);
            if mesh.curved[cell] {
                let lowest =
                    jacobian_coefficients(&nodes).into_iter().fold(f64::INFINITY, f64::min);
                min_curved_jacobian = min_curved_jacobian.min(lowest / straight.det);
            }
            all.push(WorstCell {
                cell,
                ratio: straight.mean_ratio(),
                angle: smallest_angle(&nodes[..=D]).to_degrees(),
                center: mesh.cell_center(cell),
            });
        }
        let mean = |f: fn(&WorstCell<D>) -> f64| all.iter().map(f).sum::<f64>() / n.max(1) as f64;
        let (mean_angle, mean_ratio) = (mean(|c| c.angle), mean(|c| c.ratio));
        let sharpest = all.iter().copied().min_by(|a, b| a.angle.total_cmp(&b.angle));
        all.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
        all.truncate(LISTED);
        Self {
            n_cells: n,
            n_vertices: mesh.n_vertices,
            n_nodes: mesh.n_nodes(),
            n_dofs: D * mesh.n_nodes() + mesh.n_vertices,
            min_angle: sharpest.map_or(0.0, |c| c.angle),
            min_angle_at: sharpest.map_or(Point::zeros(), |c| c.center),
            mean_angle,
            min_ratio: all.first().map_or(0.0, |c| c.ratio),
            mean_ratio,
            shortest_edge: shortest,
            longest_edge: longest,
            n_curved: mesh.curved.iter().filter(|c| **c).count(),
            min_curved_jacobian,
            worst: all,
        }
    }
}

/// Coordinates in brackets.
fn coordinates<const D: usize>(point: &Point<D>) -> String {
    let parts: Vec<String> = point.iter().map(|x| format!("{x:.4e}")).collect();
    format!("({})", parts.join(", "))
}

impl<const D: usize> fmt::Display for Quality<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "cells            {:>12}  ({} curved)", self.n_cells, self.n_curved)?;
        writeln!(f, "vertices         {:>12}", self.n_vertices)?;
        writeln!(f, "P2 nodes         {:>12}", self.n_nodes)?;
        writeln!(f, "Taylor-Hood dofs {:>12}", self.n_dofs)?;
        writeln!(
            f,
            "edge lengths     {:>12.4e}  to {:.4e}",
            self.shortest_edge, self.longest_edge
        )?;
        writeln!(
            f,
            "smallest angle   {:>12.2}  degrees at {}; mean {:.2}",
            self.min_angle,
            coordinates(&self.min_angle_at),
            self.mean_angle
        )?;
        writeln!(
            f,
            "mean ratio       {:>12.4}  smallest; mean {:.4}",
            self.min_ratio, self.mean_ratio
        )?;
        writeln!(f, "curved det J     {:>12.4}  smallest over straight", self.min_curved_jacobian)?;
        writeln!(f, "worst cell   ratio   angle   centre")?;
        for worst in &self.worst {
            writeln!(
                f,
                "{:>10}  {:.4}  {:>6.2}   {}",
                worst.cell,
                worst.ratio,
                worst.angle,
                coordinates(&worst.center)
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::{bulged_cube, cube_of_five};

    #[test]
    fn a_regular_tetrahedron_is_perfect_and_a_flat_one_is_not() {
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0]];
        let mut vertices = corners.map(Point::<3>::from);
        let ratio = |vertices: &[Point<3>]| StraightMeasures::of(vertices).mean_ratio();
        assert!((ratio(&vertices) - 1.0).abs() < 1e-15, "{}", ratio(&vertices));
        let angle = smallest_angle(&vertices);
        assert!((angle - (1.0_f64 / 3.0).acos()).abs() < 1e-15, "{angle}");
        vertices.swap(0, 1);
        assert!((ratio(&vertices) + 1.0).abs() < 1e-15);
        vertices[3] = (vertices[0] + vertices[1] + vertices[2]) / 3.0;
        assert!(ratio(&vertices).abs() < 1e-6 && smallest_angle(&vertices).abs() < 1e-7);
    }

    #[test]
    fn the_angles_of_a_triangle_are_those_of_its_corners() {
        let at = |x: f64, y: f64| Point::<2>::new(x, y);
        let half = smallest_angle(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 0.5_f64.tan())]);
        assert!((half - 0.5).abs() < 1e-15);
        let regular = StraightMeasures::of(&[at(0.0, 0.0), at(2.0, 0.0), at(1.0, 3f64.sqrt())]);
        assert!((regular.mean_ratio() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_quality_of_a_cube_of_five_tetrahedra_is_known() {
        let quality = Quality::of(&cube_of_five());
        assert_eq!((quality.n_cells, quality.n_vertices, quality.n_nodes), (5, 8, 26));
        assert_eq!((quality.n_dofs, quality.n_curved), (3 * 26 + 8, 0));
        // One is regular, the four at the corners of the cube have three right angles
        let at_corner = 12.0 * 0.5_f64.powf(2.0 / 3.0) / 9.0;
        assert!((quality.min_ratio - at_corner).abs() < 1e-15);
        assert!((quality.mean_ratio - (1.0 + 4.0 * at_corner) / 5.0).abs() < 1e-15);
        let angle = (1.0 / 3.0_f64.sqrt()).acos().to_degrees();
        assert!((quality.min_angle - angle).abs() < 1e-13, "{}", quality.min_angle);
        assert_eq!((quality.shortest_edge, quality.longest_edge), (1.0, 2.0_f64.sqrt()));
        assert_eq!(quality.min_curved_jacobian, 1.0);
    }

    #[test]
    fn curved_tetrahedra_are_worse_than_straight_ones_and_folded_ones_are_not_valid() {
        let worst = |by: f64| bulged_cube(by).worst_cell().expect("a cube has cells");
        let straight = worst(0.0);
        assert!((straight.quality - Quality::of(&bulged_cube(0.0)).min_ratio).abs() < 1e-14);
        assert!(worst(-0.05).quality < straight.quality && worst(-0.05).is_valid());
        assert!(!worst(-1.2).is_valid());
        let quality = Quality::of(&bulged_cube(-0.05));
        assert_eq!(quality.n_curved, 12);
        assert!((0.1..1.0).contains(&quality.min_curved_jacobian));
    }
}

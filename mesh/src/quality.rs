//! `Quality`: how good a mesh is, in numbers and as a table, worst cells first.

use std::fmt;

use crate::outline::cross;
use crate::{CellId, Mesh, Point, jacobian_coefficients};

/// Worst cells listed.
const LISTED: usize = 5;

/// Numbers that describe a planar mesh.
///
/// Angles and mean ratios are those of the straight triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    /// Cells.
    pub n_cells: usize,
    /// Vertices.
    pub n_vertices: usize,
    /// P2 nodes.
    pub n_nodes: usize,
    /// Unknowns of the Taylor-Hood element: two velocities per node, one pressure per vertex.
    pub n_dofs: usize,
    /// Smallest angle (degrees).
    pub min_angle: f64,
    /// Where it is: centre of its cell (m).
    pub min_angle_at: Point<2>,
    /// Mean over the cells of their smallest angle (degrees).
    pub mean_angle: f64,
    /// Smallest mean ratio: 4 √3 area / (sum of squared edges), 1 when equilateral.
    pub min_ratio: f64,
    /// Mean of the mean ratios.
    pub mean_ratio: f64,
    /// Shortest edge (m).
    pub shortest_edge: f64,
    /// Longest edge (m).
    pub longest_edge: f64,
    /// Cells with a curved side.
    pub n_curved: usize,
    /// Smallest Bezier coefficient of det J of a curved cell over twice its straight area; 1
    /// without curved cells.
    pub min_curved_jacobian: f64,
    /// The cells with the smallest mean ratio, worst first.
    pub worst: Vec<WorstCell>,
}

/// One of the worst cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstCell {
    /// Index of the cell.
    pub cell: CellId,
    /// Its mean ratio.
    pub ratio: f64,
    /// Its smallest angle (degrees).
    pub angle: f64,
    /// Its centre (m).
    pub center: Point<2>,
}

/// Quality of one cell, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellQuality {
    /// Index of the cell.
    pub cell: CellId,
    /// See [`Mesh::cell_quality`].
    pub quality: f64,
    /// Centre of the cell (m).
    pub center: Point<2>,
}

impl CellQuality {
    /// Whether the cell is neither inverted nor folded.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.quality > 0.0
    }
}

impl Mesh<2> {
    /// Quality of a cell: 1 when equilateral, 0 or less when inverted or folded, never NaN.
    ///
    /// The mean ratio 4 √3 area / (sum of squared edges) of the straight triangle; for a curved
    /// cell times the smallest Bezier coefficient of det J over twice the straight area, where
    /// that is below one.
    ///
    /// # Source
    /// @liu1994 for the mean ratio, @johnen2013 for curved cells.
    #[must_use]
    pub fn cell_quality(&self, cell: CellId) -> f64 {
        let nodes = self.cell_nodes(cell);
        let [a, b, c] = [nodes[0], nodes[1], nodes[2]];
        let twice_area = cross(b - a, c - a);
        let squares = (b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared();
        let ratio = 2.0 * 3.0_f64.sqrt() * twice_area / squares;
        let quality = if self.curved[cell] && twice_area > 0.0 {
            // Unlike f64::min, the comparison keeps what is not a number
            let lowest = jacobian_coefficients(&nodes)
                .into_iter()
                .fold(twice_area, |low, c| if c >= low { low } else { c });
            ratio * lowest / twice_area
        } else {
            ratio
        };
        if quality.is_nan() { f64::NEG_INFINITY } else { quality }
    }

    /// The cell with the lowest quality; `None` for a mesh without cells.
    #[must_use]
    pub fn worst_cell(&self) -> Option<CellQuality> {
        let all = self.cell_ids().map(|cell| (cell, self.cell_quality(cell)));
        let (cell, quality) = all.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let [a, b, c, ..] = self.cell_nodes(cell);
        Some(CellQuality { cell, quality, center: (a + b + c) / 3.0 })
    }
}

impl Quality {
    /// Measures a mesh.
    #[must_use]
    pub fn of(mesh: &Mesh<2>) -> Self {
        let n = mesh.n_cells();
        let mut all: Vec<WorstCell> = Vec::with_capacity(n);
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        let mut min_curved_jacobian = 1.0_f64;
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell_nodes(cell);
            let [a, b, c] = [nodes[0], nodes[1], nodes[2]];
            let sides = [b - a, c - b, a - c];
            for side in &sides {
                shortest = shortest.min(side.norm());
                longest = longest.max(side.norm());
            }
            let twice_area = cross(b - a, c - a);
            let squares: f64 = sides.iter().map(Point::<2>::norm_squared).sum();
            let ratio = 2.0 * 3.0_f64.sqrt() * twice_area / squares;
            let angle = (0..3)
                .map(|i| {
                    let (out, back) = (sides[i], -sides[(i + 2) % 3]);
                    cross(out, back).atan2(out.dot(&back)).to_degrees()
                })
                .fold(f64::INFINITY, f64::min);
            if mesh.curved[cell] {
                let lowest =
                    jacobian_coefficients(&nodes).into_iter().fold(f64::INFINITY, f64::min);
                min_curved_jacobian = min_curved_jacobian.min(lowest / twice_area);
            }
            all.push(WorstCell { cell, ratio, angle, center: (a + b + c) / 3.0 });
        }
        let mean = |f: fn(&WorstCell) -> f64| all.iter().map(f).sum::<f64>() / n.max(1) as f64;
        let (mean_angle, mean_ratio) = (mean(|c| c.angle), mean(|c| c.ratio));
        let sharpest = all.iter().copied().min_by(|a, b| a.angle.total_cmp(&b.angle));
        all.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
        all.truncate(LISTED);
        Self {
            n_cells: n,
            n_vertices: mesh.n_vertices,
            n_nodes: mesh.n_nodes(),
            n_dofs: 2 * mesh.n_nodes() + mesh.n_vertices,
            min_angle: sharpest.map_or(0.0, |c| c.angle),
            min_angle_at: sharpest.map_or(Point::<2>::zeros(), |c| c.center),
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

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "cells            {:>12}  ({} curved)", self.n_cells, self.n_curved)?;
        writeln!(f, "vertices         {:>12}", self.n_vertices)?;
        writeln!(f, "P2 nodes         {:>12}", self.n_nodes)?;
        writeln!(f, "Taylor-Hood dofs {:>12}", self.n_dofs)?;
        writeln!(
            f,
            "edges (m)        {:>12.4e}  to {:.4e}",
            self.shortest_edge, self.longest_edge
        )?;
        writeln!(
            f,
            "smallest angle   {:>12.2}  degrees at ({:.4e}, {:.4e}); mean {:.2}",
            self.min_angle, self.min_angle_at.x, self.min_angle_at.y, self.mean_angle
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
                "{:>10}  {:.4}  {:>6.2}   ({:.4e}, {:.4e})",
                worst.cell, worst.ratio, worst.angle, worst.center.x, worst.center.y
            )?;
        }
        Ok(())
    }
}

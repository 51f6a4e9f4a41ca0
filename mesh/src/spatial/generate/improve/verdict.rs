//! `Verdict`: whether a mesh is good enough to be given away.

use super::improver::Improver;
use crate::quality::smallest_angle;
use crate::spatial::generate::tetrahedra::measure::{
    EDGES, least_coefficient, least_sine, six_volumes,
};
use crate::{MeshError, Point};

/// Smallest dihedral angle of a good mesh (degrees), where no two surfaces of a body meet.
const GOOD_ANGLE: f64 = 25.0;

/// Smallest dihedral angle that is given away (degrees).
const LEAST_ANGLE: f64 = 12.0;

/// Least Bezier coefficient of det J over the mean in a curved cell.
pub const LEAST_COEFFICIENT: f64 = 0.1;

/// Part of the quality of a given mesh that one made of it has at least.
const AS_GIVEN: f64 = 0.9;

/// Distance of a boundary vertex from its surfaces over the size wanted there.
const OFF_SURFACE: f64 = 1e-9;

/// The worst of something, and where.
#[derive(Debug, Clone, Copy)]
struct Worst {
    value: f64,
    at: Point<3>,
}

impl Worst {
    /// Takes a value that is less; what is not a number counts as least.
    fn take_less(&mut self, value: f64, at: Point<3>) {
        if value < self.value || value.is_nan() {
            *self = Self { value, at };
        }
    }
}

/// What is worst in a mesh.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// Smallest dihedral angle (degrees), not positive in an inverted cell.
    angle: Worst,
    /// Least Bezier coefficient of det J over the mean.
    coefficient: Worst,
    /// Minus the largest distance of a boundary vertex from its surfaces over the size there.
    off_surface: Worst,
    /// Minus the number of cells whose nodes are all on the boundary.
    closed: Worst,
    /// Angle of a good mesh of this geometry (degrees).
    good_angle: f64,
    /// Smallest angle that is given away (degrees): no better than that of a given mesh.
    least_angle: f64,
    /// The same of the coefficients.
    least_coefficient: f64,
}

impl Verdict {
    /// Judges a mesh.
    pub fn of(improver: &Improver<'_>) -> Self {
        let none = |value| Worst { value, at: Point::zeros() };
        let good_angle = if improver.geometry.has_creases() { LEAST_ANGLE } else { GOOD_ANGLE };
        let mut verdict = Self {
            angle: none(180.0),
            coefficient: none(1.0),
            off_surface: none(0.0),
            closed: none(0.0),
            good_angle,
            least_angle: LEAST_ANGLE,
            least_coefficient: LEAST_COEFFICIENT,
        };
        if let Some(imported) = &improver.geometry.imported {
            verdict.least_angle = LEAST_ANGLE.min(AS_GIVEN * imported.smallest_angle());
            verdict.least_coefficient =
                LEAST_COEFFICIENT.min(AS_GIVEN * imported.least_coefficient());
        }
        for cell in improver.mesh.cells() {
            verdict.take_cell(improver, improver.mesh.cell(cell));
        }
        for vertex in improver.mesh.vertices() {
            let here = improver.mesh.point(vertex);
            for surface in improver.mesh.surfaces(vertex).as_slice() {
                let surface = usize::from(*surface);
                if improver.geometry.surfaces[surface].is_given() {
                    continue;
                }
                let gap = improver.geometry.gap(surface, here).abs();
                verdict.off_surface.take_less(-gap / improver.mesh.sizes[vertex as usize], here);
            }
        }
        verdict
    }

    fn take_cell(&mut self, improver: &Improver<'_>, vertices: [u32; 4]) {
        let corners = improver.mesh.corners(vertices);
        let center = corners.iter().sum::<Point<3>>() * 0.25;
        // The sine is cheap, and angles near 90 degrees need no look
        if six_volumes(&corners) <= 0.0 {
            self.angle.take_less(-1.0, center);
        } else if least_sine(&corners) < 0.9 {
            self.angle.take_less(smallest_angle(&corners).to_degrees(), center);
        }
        let mut offsets = [Point::<3>::zeros(); 6];
        let (mut n_edges, mut is_curved) = (0, false);
        for (edge, [i, j]) in EDGES.into_iter().enumerate() {
            let surfaces = improver.mesh.edge_surfaces(vertices[i], vertices[j]);
            n_edges += usize::from(!surfaces.is_empty());
            if improver.asked.bent_edges && improver.has_curved(surfaces) {
                offsets[edge] = improver.offset_of_node(vertices[i], vertices[j]);
                is_curved = true;
            }
        }
        if n_edges == 6 && improver.asked.free_nodes {
            self.closed = Worst { value: self.closed.value - 1.0, at: center };
        }
        if is_curved {
            self.coefficient.take_less(least_coefficient(&corners, &offsets), center);
        }
    }

    /// Whether nothing is left to be wished.
    pub fn is_good(&self) -> bool {
        self.angle.value >= self.good_angle && self.is_acceptable()
    }

    /// Whether it may be given away.
    pub fn is_acceptable(&self) -> bool {
        self.angle.value >= self.least_angle
            && self.coefficient.value >= self.least_coefficient
            && self.off_surface.value >= -OFF_SURFACE
            && self.closed.value >= 0.0
    }

    /// Whether a mesh is better than another one.
    pub fn is_better_than(&self, other: &Self) -> bool {
        let rank =
            |one: &Self| (one.is_acceptable(), one.angle.value.min(60.0 * one.coefficient.value));
        let (is_acceptable, value) = rank(self);
        let (other_is, other_value) = rank(other);
        is_acceptable & !other_is || (is_acceptable == other_is && value > other_value)
    }

    /// Why the mesh cannot be given away.
    ///
    /// # Errors
    /// [`MeshError::PoorTetrahedra`].
    pub fn check(&self) -> Result<(), MeshError> {
        let refuse = |reason, value: f64, worst: &Worst| {
            Err(MeshError::PoorTetrahedra { reason, value, at: worst.at.into() })
        };
        if self.is_acceptable() {
            return Ok(());
        }
        if self.off_surface.value < -OFF_SURFACE {
            let reason = "a vertex is off its surface, in sizes";
            return refuse(reason, -self.off_surface.value, &self.off_surface);
        }
        if self.closed.value < 0.0 {
            let reason = "cells have all their nodes on the boundary, their number";
            return refuse(reason, -self.closed.value, &self.closed);
        }
        if self.coefficient.value < self.least_coefficient {
            let reason = "a curved cell is nearly folded, its least det J over the mean";
            return refuse(reason, self.coefficient.value, &self.coefficient);
        }
        refuse(
            "a cell is flat, its smallest dihedral angle in degrees",
            self.angle.value,
            &self.angle,
        )
    }
}

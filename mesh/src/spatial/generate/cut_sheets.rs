//! The cut of the mesh by the sheets of a region, and of what is outside of all.
//!
//! Each sheet is cut through the mesh a little beyond its rim, which makes edges of the mesh where two of them meet;
//! then what is outside of the region is dropped.

use super::cut::{Cut, ON_SURFACE};
use super::improve::Improver;
use super::tetrahedra::Face;
use super::tetrahedra::boundary_edges::tag_of;
use super::tetrahedra::measure::FACES;
use super::tetrahedra::surface_set::SurfaceSet;
use crate::{MeshError, Point, interrupt};

/// An edge between two vertices of a sheet is along it where its middle is nearer to it than this part of its
/// length: it turns by 45 degrees.
const ALONG: f64 = 0.1;

/// Sheets are cut through the mesh as far as this many of the longest edges around a vertex from them.
const BEYOND_RIM: f64 = 1.01;

/// Vertices on a sheet are on the whole surface where they are nearer to it than this (m, over the sizes).
const ON_WHOLE: f64 = 1e-4;

impl Improver<'_> {
    /// Cuts the mesh by all sheets of a region and drops what is outside.
    ///
    /// # Errors
    /// [`MeshError::PoorTetrahedra`] where nothing is left, [`MeshError::Stopped`].
    pub fn cut_by_sheets(&mut self) -> Result<(), MeshError> {
        let [min, max] = self.geometry.corners;
        let tolerance = ON_SURFACE * (max - min).amax();
        for index in 0..self.geometry.surfaces.len() {
            let gaps = self.gaps_to_sheet(index);
            let index = u16::try_from(index).unwrap_or(u16::MAX);
            let mut cut = Cut { improver: &mut *self, index, gaps, tolerance };
            cut.move_vertices();
            interrupt::check()?;
            cut.split_edges();
            interrupt::check()?;
        }
        self.drop_outside();
        if self.mesh.n_cells() == 0 {
            let at = ((min + max) * 0.5).into();
            let reason = "the region is thinner than cells, the number of those inside";
            return Err(MeshError::PoorTetrahedra { reason, value: 0.0, at });
        }
        Ok(())
    }

    /// Gaps of the vertices near a sheet (m), not a number elsewhere.
    fn gaps_to_sheet(&mut self, index: usize) -> Vec<f64> {
        let Some(sheet) = self.geometry.surfaces[index].sheet() else { return Vec::new() };
        let end = self.mesh.end_of_vertices();
        let mut neighbours = Vec::new();
        let mut gap = |vertex: u32| {
            self.mesh.neighbours(vertex, &mut neighbours);
            let lengths = neighbours.iter().map(|other| self.mesh.length(vertex, *other));
            let longest = lengths.fold(0.0, f64::max);
            sheet.gap_within(self.mesh.point(vertex), BEYOND_RIM * longest).unwrap_or(f64::NAN)
        };
        (0..end).map(&mut gap).collect()
    }

    /// The surfaces that an edge runs along: of boundary faces at it, or sheets, which have no faces yet.
    pub(super) fn surfaces_along(&self, [a, b]: [u32; 2]) -> SurfaceSet {
        if self.geometry.enclosure.is_none() {
            return self.mesh.edge_surfaces(a, b);
        }
        let (one, other) = (self.mesh.surfaces(a), self.mesh.surfaces(b));
        let (middle, length) = (self.mesh.middle([a, b]), self.mesh.length(a, b));
        let is_along = |sheet: &&u16| {
            other.contains(**sheet)
                && self.geometry.gap(usize::from(**sheet), middle).abs() < ALONG * length
        };
        let common = one.as_slice().iter().filter(is_along);
        common.fold(SurfaceSet::EMPTY, |all, sheet| all.with(*sheet).unwrap_or(all))
    }

    /// Whether a vertex would come to the other side of a sheet that has been cut before this one if it were at a
    /// point (m): its edges would go through that again.
    pub(super) fn crosses_earlier(&self, vertex: u32, to: Point<3>, index: u16) -> bool {
        if self.geometry.enclosure.is_none() {
            return false;
        }
        let (here, own) = (self.mesh.point(vertex), self.mesh.surfaces(vertex));
        let mut earlier = (0..index).filter(|sheet| !own.contains(*sheet));
        earlier.any(|sheet| {
            let [before, after] = [here, to].map(|at| self.geometry.gap(usize::from(sheet), at));
            before * after < 0.0
        })
    }

    /// Drops the cells outside and tags the faces they leave.
    fn drop_outside(&mut self) {
        let gap = |vertex: u32| {
            let gap = self.geometry.clearance(self.mesh.point(vertex), 0.0);
            let is_on = !self.mesh.surfaces(vertex).is_empty()
                && gap.abs() < ON_WHOLE * self.mesh.sizes[vertex as usize];
            if is_on { 0.0 } else { gap }
        };
        let gaps: Vec<f64> = (0..self.mesh.end_of_vertices()).map(gap).collect();
        let all: Vec<u32> = self.mesh.cells().collect();
        let mut is_outside = vec![false; all.last().map_or(0, |last| *last as usize + 1)];
        for &cell in &all {
            let own = self.mesh.cell(cell).map(|vertex| gaps[vertex as usize]);
            let most = own.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let least = own.into_iter().fold(f64::INFINITY, f64::min);
            is_outside[cell as usize] = if least < 0.0 && most <= 0.0 {
                true
            } else if most > 0.0 && least >= 0.0 {
                false
            } else {
                let corners = self.mesh.corners(self.mesh.cell(cell));
                self.geometry.clearance(corners.iter().sum::<Point<3>>() * 0.25, 0.0) <= 0.0
            };
        }
        let mut left: Vec<Face> = Vec::new();
        for &cell in all.iter().filter(|cell| is_outside[**cell as usize]) {
            for face in FACES {
                let vertices = face.map(|local| self.mesh.cell(cell)[local]);
                let across = self.mesh.across(vertices, cell);
                left.extend(across.filter(|face| !is_outside[face.cell as usize]));
            }
        }
        for &cell in all.iter().filter(|cell| is_outside[**cell as usize]) {
            self.mesh.delete_cell(cell);
        }
        for face in left {
            let sheet = self.sheet_of(self.mesh.face_vertices(face));
            self.mesh.set_tag(face, tag_of(sheet));
        }
    }

    /// The sheet that a face is on: of those all its vertices are on, or of all, the one that is nearest and
    /// runs along it.
    fn sheet_of(&self, vertices: [u32; 3]) -> u16 {
        let corners = self.mesh.corners(vertices);
        let [a, b, c] = corners;
        let middle = (a + b + c) / 3.0;
        let normal = (b - a).cross(&(c - a)).normalize();
        let size = (a - b).norm().max((b - c).norm()).max((c - a).norm());
        let distance = |sheet: u16, at: Point<3>| {
            let sheet = self.geometry.surfaces[usize::from(sheet)].sheet();
            sheet.map_or(f64::INFINITY, |sheet| sheet.near(at).distance)
        };
        let all: Vec<u16> = (0..u16::MAX).take(self.geometry.surfaces.len()).collect();
        let has_all =
            |sheet: &u16| corners.iter().all(|at| distance(*sheet, *at) < ON_WHOLE * size);
        let mut of: Vec<u16> = all.iter().copied().filter(has_all).collect();
        if of.is_empty() {
            of = all;
        }
        let misfit = |sheet: &u16| {
            let along = self.geometry.surfaces[usize::from(*sheet)].foot(middle).normal;
            distance(*sheet, middle) / size + 1.0 - normal.dot(&along).abs()
        };
        let best = of.into_iter().min_by(|one, other| misfit(one).total_cmp(&misfit(other)));
        best.unwrap_or_default()
    }
}

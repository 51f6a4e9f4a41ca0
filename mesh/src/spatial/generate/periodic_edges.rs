//! Edges and vertices on periodic sides, taken together with their images.

use super::improver::Improver;
use super::surface_set::SurfaceSet;

/// Difference of two edges that are images, over their length.
const ROUNDING: f64 = 1e-6;

impl Improver<'_> {
    /// Whether what is on these surfaces stays as it is, being on a periodic or a given side.
    pub fn is_fixed(&self, surfaces: SurfaceSet) -> bool {
        let sides = &self.geometry.surfaces;
        surfaces.as_slice().iter().any(|surface| sides[usize::from(*surface)].is_fixed())
    }

    /// An edge, and its images where it is on a periodic side.
    pub fn images(&self, ends: [u32; 2]) -> Vec<[u32; 2]> {
        let [a, b] = ends;
        let mut images = vec![ends];
        if self.is_fixed(self.mesh.edge_surfaces(a, b)) {
            let along = self.mesh.point(b) - self.mesh.point(a);
            let is_image = |[c, d]: [u32; 2]| {
                let other = self.mesh.point(d) - self.mesh.point(c);
                (other - along).norm() < ROUNDING * along.norm()
                    && self.is_fixed(self.mesh.edge_surfaces(c, d))
            };
            for c in self.twins.of(a).skip(1) {
                images.extend(self.twins.of(b).map(|d| [c, d]).filter(|edge| is_image(*edge)));
            }
        }
        images
    }

    /// Cells around an edge and its images.
    pub fn shell_of_images(&self, ends: [u32; 2], cells: &mut Vec<u32>) {
        self.mesh.shell(ends[0], ends[1], cells);
        let mut of_image = Vec::new();
        for [a, b] in self.images(ends).into_iter().skip(1) {
            self.mesh.shell(a, b, &mut of_image);
            cells.append(&mut of_image);
        }
    }

    /// The image of a vertex with the smallest coordinates along the axes of periodic sides that some
    /// surfaces include as those with the largest; itself where there is none.
    pub fn original(&self, vertex: u32, surfaces: SurfaceSet) -> u32 {
        let mut place = self.mesh.point(vertex);
        for side in surfaces.as_slice().iter().map(|surface| usize::from(*surface)) {
            if self.geometry.surfaces[side].is_periodic && !side.is_multiple_of(2) {
                place[side / 2] -= self.geometry.periods[side / 2];
            }
        }
        let distance = |v: &u32| (self.mesh.point(*v) - place).norm();
        let nearest = self.twins.of(vertex).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.unwrap_or(vertex)
    }
}

//! Smooth parts of a surface that are hardly larger than cells: coarse triangles make them where edges are round.

use super::region::Region;
use super::triangles::edges_of;

/// A part is small with an area of so many squares of the edge length: about twenty faces of cells.
const SMALL: f64 = 9.0;

/// Edges that turn by more (degrees) are of a shape, whatever its size.
const SHARP: f64 = 80.0;

/// Largest part of a surface that small parts are together: with more, they are its faces.
const FEW: f64 = 0.1;

impl Region {
    /// The angle to smooth edges by (degrees) that joins each smooth part of a few cells of an edge length (m)
    /// to another one, where such end at edges that are not sharp; `None` where there are none, or where they are
    /// more than a tenth of the surface, which then is no round one.
    #[must_use]
    pub fn angle_without_small_sheets(&self, size: f64) -> Option<f64> {
        let mut areas = vec![0.0; self.n_sheets()];
        for (triangle, sheet) in self.sheets.iter().enumerate() {
            areas[*sheet] += 0.5 * self.mesh.area_vector(triangle).norm();
        }
        let mut least = vec![f64::INFINITY; self.n_sheets()];
        for beside in edges_of(&self.mesh).values() {
            let [one, other] = beside[..] else { continue };
            let turn = self.mesh.turn(one.triangle, other.triangle).to_degrees();
            let [a, b] = [one, other].map(|side| self.sheets[side.triangle]);
            for sheet in [a, b].into_iter().filter(|_| a != b) {
                least[sheet] = least[sheet].min(turn);
            }
        }
        let is_small = |area: &f64| *area < SMALL * size * size;
        let of_small: f64 = areas.iter().filter(|area| is_small(area)).sum();
        if of_small > FEW * areas.iter().sum::<f64>() {
            return None;
        }
        let small = areas.iter().zip(least).filter(|(area, _)| is_small(area));
        let turns = small.map(|(_, turn)| turn).filter(|turn| *turn < SHARP);
        turns.reduce(f64::max).map(f64::ceil)
    }
}

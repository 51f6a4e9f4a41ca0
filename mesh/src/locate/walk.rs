//! The way from a guessed cell to the one that holds a point, across the face beyond which the point is.

use super::cell_point::invert_quadratic;
use super::neighbours::Neighbours;
use super::{Located, Locator, barycentric, straight_coordinates};
use crate::{CellId, Point};

/// Coordinates in the straight cell may be negative by this where a point is in the curved one.
const CURVED: f64 = 0.3;

/// Most cells on a way to a point.
const LONGEST_WAY: usize = 64;

/// Barycentric coordinates of a point that is in no other cell are larger than this.
const WITHIN: f64 = 1e-6;

impl<const D: usize> Locator<D> {
    /// What [`Self::locate`] finds, by a way through cells from one that is guessed; `None` where that leads to
    /// the boundary, too far, or to a point that is in no cell alone.
    #[must_use]
    pub fn walk(
        &self,
        neighbours: &Neighbours<D>,
        guess: CellId,
        point: Point<D>,
    ) -> Option<Located<D>> {
        let mut cell = guess;
        for _ in 0..LONGEST_WAY {
            let straight = straight_coordinates(self.vertices_of(cell), point);
            let all = barycentric(straight).enumerate();
            let (opposite, least) = all.min_by(|a, b| a.1.total_cmp(&b.1))?;
            // On a side, another cell may be the first that is found
            let found = match self.quadratic_nodes(cell) {
                None => (least > WITHIN).then_some(straight),
                Some(nodes) if least > -CURVED => {
                    let found = invert_quadratic(nodes, point, straight, self.found_within(cell));
                    found.filter(|reference| barycentric(*reference).all(|l| l > WITHIN))
                }
                Some(_) => None,
            };
            if found.is_some() || least > 0.0 {
                return found.map(|reference| Located { cell, reference, distance: 0.0 });
            }
            cell = neighbours.across(cell, opposite)?;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use crate::locate::tests::channel;
    use crate::mesh::map_quadratic;
    use crate::test_meshes::bulged_cube;

    /// To places inside, on sides and at corners, and outside, from their cell and from one far away.
    fn goes_to<const D: usize>(mesh: &Mesh<D>, places: &[[f64; D]]) {
        let (locator, neighbours) = (Locator::new(mesh), Neighbours::new(mesh));
        let mut n_found = 0;
        for cell in mesh.cell_ids() {
            let far = CellId::new(mesh.n_cells() - 1 - cell.index());
            for at in places {
                let point = map_quadratic(&mesh.cell_nodes(cell), *at).position;
                for from in [cell, far] {
                    if let Some(found) = locator.walk(&neighbours, from, point) {
                        assert_eq!(Some(found), locator.locate(point), "{from} {at:?}");
                        n_found += 1;
                    }
                }
            }
        }
        assert!(n_found >= 2 * mesh.n_cells(), "{n_found}");
    }

    #[test]
    fn a_way_leads_to_what_is_found_without() {
        let all = [[0.3, 0.3], [0.5, 0.5], [0.0, 0.4], [0.0, 0.0], [-0.1, 0.2], [40.0, 3.0]];
        goes_to(&channel(), &all);
        let all = [[0.25, 0.2, 0.3], [0.3, 0.3, 0.002], [0.4, 0.3, 0.3], [0.0, 0.2, 0.2], [9.0; 3]];
        goes_to(&bulged_cube(0.2), &all);
    }
}

//! How many tetrahedra a size field asks for, before any of them is made.

use super::domain::Domain;
use super::region::Region;
use super::shape::Body;
use super::size_field::SizeField;
use crate::count::{Cube, sum_over};
use crate::{MeshError, Point, Sizing};

/// Cells over volume / size^3 where the size varies, fitted to meshes of the generator.
const CELLS: f64 = 10.2;

/// The same in the lattice as it is, at the largest size.
const COARSEST: f64 = 6.2;

/// Halvings of the domain after which a cube is taken as it is.
const DEEPEST: u32 = 40;

/// Most that the size changes from the middle of a cube to its sides.
const CHANGE: f64 = 0.25;

/// About how many cells [`generate`](super::generate) would make; infinite where there would be more
/// than `limit`.
///
/// The integral of a constant over h^3 over the fluid, by cubes in which h hardly changes.
///
/// # Errors
/// What [`check_placement`](super::check_placement) and [`Sizing::check`] refuse.
pub fn estimate_cells(
    domain: &Domain,
    bodies: &[Body],
    sizing: &Sizing<3>,
    limit: f64,
) -> Result<f64, MeshError> {
    let sizes = SizeField::new(domain, bodies, sizing)?;
    Ok(Count { sizes: &sizes, growth: sizing.growth, limit }.total(domain))
}

/// The same of [`generate_inside`](super::generate_inside).
///
/// # Errors
/// What [`Sizing::check`] refuses.
pub fn estimate_cells_inside(
    region: &Region,
    sizing: &Sizing<3>,
    limit: f64,
) -> Result<f64, MeshError> {
    sizing.check(&region.sides().iter().map(String::as_str).collect::<Vec<_>>())?;
    // Far too many are seen without a count: a cell is smaller than the cube over its edge
    let least = region.volume() / sizing.size.powi(3);
    if least > limit {
        return Ok(least);
    }
    let sizes = SizeField::of(region.geometry(sizing), sizing);
    let corners = sizes.geometry().corners;
    Ok(Count { sizes: &sizes, growth: sizing.growth, limit }.within(corners))
}

/// The integral over the fluid.
struct Count<'a> {
    sizes: &'a SizeField,
    growth: f64,
    limit: f64,
}

impl Count<'_> {
    fn total(&self, domain: &Domain) -> f64 {
        let imported = self.sizes.geometry().imported.as_ref();
        if let Some(imported) = imported.filter(|_| self.sizes.geometry().groups.len() == 1) {
            return imported.mesh().n_cells() as f64;
        }
        self.within(domain.corners())
    }

    /// The same within a box.
    fn within(&self, [min, max]: [Point<3>; 2]) -> f64 {
        let half = 0.5 * (max - min).max();
        let whole = Cube { center: (min + max) * 0.5, half, depth: 0 };
        sum_over([whole], self.limit, |cube| self.cells_of(cube))
    }

    /// Cells in a cube; `None` where it has to be halved.
    fn cells_of(&self, cube: &Cube<3>) -> Option<f64> {
        let Cube { center, half, depth } = *cube;
        let reach = 3.0_f64.sqrt() * half;
        let geometry = self.sizes.geometry();
        let mut inside = geometry.clearance(center, reach);
        if geometry.imported.as_ref().is_some_and(|imported| !imported.contains(center)) {
            inside = -inside.abs();
        }
        if inside < -reach {
            return Some(0.0);
        }
        let h = self.sizes.at(center);
        let is_cut = inside < reach && half > h;
        if depth < DEEPEST && (half * self.growth > CHANGE * h || is_cut) {
            return None;
        }
        let part = (0.5 + 0.5 * inside / half).clamp(0.0, 1.0);
        let is_coarsest = h > 0.97 * self.sizes.largest();
        let density = if is_coarsest { COARSEST } else { CELLS };
        Some(density * part * (2.0 * half / h).powi(3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Centreline, Part, Shape, generate};
    use nalgebra::{Isometry3, UnitQuaternion};

    fn check(name: &str, domain: &Domain, bodies: &[Body], sizing: &Sizing<3>) {
        let estimate = estimate_cells(domain, bodies, sizing, 1e9).unwrap();
        let cells = generate(domain, bodies, sizing).unwrap().n_cells() as f64;
        let ratio = cells / estimate;
        println!("{name}: {cells} cells, {ratio:.3} of the estimate");
        assert!((1.0 / 1.3..1.3).contains(&ratio), "{name}: {ratio}");
    }

    fn at(x: f64, y: f64, z: f64) -> Isometry3<f64> {
        Isometry3::translation(x, y, z)
    }

    #[test]
    fn cells_are_estimated_around_bodies_of_all_kinds() {
        let sphere = Shape::Sphere { radius: 0.2 };
        let tube = Domain::Cylinder { x: [-3.0, 3.0], radius: 1.0 };
        let graded = Sizing::graded(0.06, 0.25, 0.35);
        check("tube", &tube, &[Body::new("a", sphere.clone(), at(0.0, 0.0, 0.0))], &graded);
        let coarse = Sizing::graded(0.1, 0.5, 0.35);
        check("coarse", &tube, &[Body::new("a", sphere.clone(), at(0.0, 0.5, 0.0))], &coarse);
        let ball = Domain::Ball { center: Point::<3>::zeros(), radius: 2.0 };
        let large = Body::new("a", Shape::Sphere { radius: 1.0 }, at(0.0, 0.0, 0.0));
        let shell = Sizing { gap_layers: 4.0, ..Sizing::graded(0.25, 0.25, 0.5) };
        check("shell", &ball, &[large], &shell);
        let walls = Domain::walls(Point::<3>::repeat(-1.5), Point::<3>::repeat(1.5));
        check("box", &walls, &[], &Sizing::graded(0.2, 0.3, 0.2));
        let pair = [
            Body::new("a", Shape::Sphere { radius: 0.4 }, at(-0.42, 0.0, 0.0)),
            Body::new("b", Shape::Sphere { radius: 0.4 }, at(0.42, 0.0, 0.0)),
        ];
        check("pair", &walls, &pair, &Sizing::graded(0.15, 0.3, 0.4));
        let turn = nalgebra::convert(UnitQuaternion::from_euler_angles(0.4, 0.7, -0.3));
        let thin = Shape::Ellipsoid { semi_axes: [0.6, 0.3, 0.1] };
        check("ellipsoid", &walls, &[Body::new("a", thin, turn)], &Sizing::graded(0.15, 0.3, 0.5));
        let mut swimmer = Body::new("a", Shape::Sphere { radius: 0.25 }, at(-0.7, 0.0, 0.0));
        let centreline = Centreline::Helix { radius: 0.12, pitch: 0.5, turns: 2.0 };
        let tail = Shape::Tube { centreline, radius: 0.05 };
        swimmer.parts.push(Part { shape: tail, pose: at(0.2, 0.0, 0.0) });
        check("tail", &walls, &[swimmer], &Sizing::graded(0.1, 0.4, 0.5));
    }

    #[test]
    fn counting_ends_at_the_limit() {
        let walls = Domain::walls(Point::<3>::repeat(-1.5), Point::<3>::repeat(1.5));
        let sizing = Sizing::graded(1e-7, 0.3, 0.2);
        let body = Body::new("a", Shape::Sphere { radius: 0.4 }, at(0.0, 0.0, 0.0));
        assert_eq!(estimate_cells(&walls, &[body], &sizing, 1e6), Ok(f64::INFINITY));
    }
}

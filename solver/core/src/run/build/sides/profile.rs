//! The velocity on a side by numbers at places of it.

use alewife_mesh::{BoundaryId, Bounds, Mesh, Point, Scattered, Shares};
use nalgebra::{DMatrix, SymmetricEigen};

use crate::case::{ColumnAxis, ProfileSpec};
use crate::coupling::VelocityProfile;
use crate::run::RunError;

/// Places are on a line, or in a plane, when none is further from it than this part of their extent.
const FLAT: f64 = 1e-3;

/// A velocity by its values at places, linear between these.
struct Table {
    places: Places,
    /// Velocity at each place (m/s).
    velocities: Vec<[f64; 3]>,
}

/// Places by the coordinates that tell them apart.
enum Places {
    /// On a line.
    Line {
        /// Axis of the coordinate.
        axis: usize,
        /// Numbers of the places in the order of their coordinate (m).
        order: Vec<(f64, usize)>,
    },
    /// In a plane.
    Plane {
        /// Axes of both coordinates.
        axes: [usize; 2],
        triangles: Scattered,
    },
}

/// The velocity that is given at places of a side of a mesh.
///
/// # Errors
/// When places are on no line or in no plane, or do not cover the side.
pub fn profile<const D: usize>(
    spec: &ProfileSpec,
    mesh: &Mesh<D>,
    side: &str,
) -> Result<VelocityProfile<D>, RunError> {
    let refused =
        |what: String| RunError::Unsupported(format!("the profile on side `{side}` {what}"));
    let table = Table::new::<D>(spec).map_err(refused)?;
    let boundary = mesh.boundary_named(side);
    let spacing = table.places.spacing();
    let extent = table.places.extent(mesh, boundary);
    if extent < 0.5 * spacing {
        return Err(refused(format!(
            "has places about {spacing:.3e} from each other, and the side is {extent:.3e} long there: take another \
             coordinate, or write lengths in the unit of the case"
        )));
    }
    for facet in mesh.facets.iter().filter(|facet| Some(facet.boundary) == boundary) {
        for node in mesh.facet_vertices(facet) {
            let at = mesh.nodes[node];
            let outside = table.places.shares(at.as_slice()).outside;
            if outside > spacing {
                return Err(refused(format!(
                    "ends {outside:.3e} before the node at {:?}, and its places are about {spacing:.3e} from each \
                     other: give values up to the rim of the side",
                    at.as_slice()
                )));
            }
        }
    }
    Ok(Box::new(move |place, _| {
        let Shares { points, shares, .. } = table.places.shares(place.as_slice());
        Point::<D>::from_fn(|axis, _| {
            let parts = points.iter().zip(shares);
            parts.map(|(point, share)| share * table.velocities[*point][axis]).sum()
        })
    }))
}

impl Table {
    fn new<const D: usize>(spec: &ProfileSpec) -> Result<Self, String> {
        let mut coordinates = spec.coordinates();
        if coordinates.len() == D {
            // All of them: places of a flat side need one less
            coordinates.remove(across(spec, &coordinates)?);
        }
        let of = |row: &[f64], one: &ColumnAxis| row[one.column];
        // Those that one coordinate less has made the same
        if let Some([before, row]) = spec.rows_at_one_place(&coordinates) {
            return Err(format!("has its rows {before} and {row} at one place"));
        }
        let places = match coordinates[..] {
            [along] => {
                let mut order: Vec<(f64, usize)> =
                    spec.rows.iter().zip(0..).map(|(row, n)| (of(row, &along), n)).collect();
                order.sort_by(|a, b| a.0.total_cmp(&b.0));
                Places::Line { axis: along.axis, order }
            }
            [one, other] => {
                let points =
                    spec.rows.iter().map(|row| Point::<2>::new(of(row, &one), of(row, &other)));
                let triangles = Scattered::new(points.collect());
                let triangles =
                    triangles.ok_or("has all its places on one line of a side in space: give it by one coordinate, if it depends on that alone")?;
                Places::Plane { axes: [one.axis, other.axis], triangles }
            }
            _ => return Err("is given by no coordinate".to_owned()),
        };
        let velocity = |row: &Vec<f64>| {
            let mut velocity = [0.0; 3];
            for one in spec.velocities() {
                velocity[one.axis] = of(row, &one);
            }
            velocity
        };
        Ok(Self { places, velocities: spec.rows.iter().map(velocity).collect() })
    }
}

/// Which of the coordinates of places on a line, or in a plane, is closest to across it.
fn across(spec: &ProfileSpec, coordinates: &[ColumnAxis]) -> Result<usize, String> {
    let (n, d) = (spec.rows.len(), coordinates.len());
    let place = DMatrix::from_fn(n, d, |row, k| spec.rows[row][coordinates[k].column]);
    let mean = place.row_mean();
    let off = DMatrix::from_fn(n, d, |row, k| place[(row, k)] - mean[k]);
    let extent = off.amax();
    let moments = SymmetricEigen::new(off.transpose() * &off);
    let normal = moments.eigenvectors.column(moments.eigenvalues.imin()).into_owned();
    let height = (&off * &normal).amax();
    if height > FLAT * extent {
        let what = if d == 2 { "line" } else { "plane" };
        return Err(format!(
            "has places up to {height:.3e} off a {what}: give it by one coordinate less, or on a straight side"
        ));
    }
    Ok(normal.iamax())
}

impl Places {
    /// About how far neighbours are from each other (m).
    fn spacing(&self) -> f64 {
        match self {
            Self::Line { order, .. } => {
                order.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max)
            }
            Self::Plane { triangles, .. } => triangles.spacing(),
        }
    }

    /// Length (m) of a side in the coordinates that tell places apart.
    fn extent<const D: usize>(&self, mesh: &Mesh<D>, side: Option<BoundaryId>) -> f64 {
        let axes = match self {
            Self::Line { axis, .. } => [*axis; 2],
            Self::Plane { axes, .. } => *axes,
        };
        let own = mesh.facets.iter().filter(|facet| Some(facet.boundary) == side);
        let nodes = own.flat_map(|facet| mesh.facet_vertices(facet));
        let bounds = Bounds::around(nodes.map(|node| &mesh.nodes[node]));
        axes.map(|axis| bounds.max[axis] - bounds.min[axis]).into_iter().fold(0.0, f64::max)
    }

    /// What a place has of those around it.
    fn shares(&self, at: &[f64]) -> Shares {
        match self {
            Self::Plane { axes: [one, other], triangles } => {
                triangles.shares(Point::<2>::new(at[*one], at[*other]))
            }
            Self::Line { axis, order } => {
                let at = at[*axis];
                let after = order.partition_point(|(place, _)| *place <= at);
                let after = after.clamp(1, order.len() - 1);
                let (from, to) = (order[after - 1], order[after]);
                let part = ((at - from.0) / (to.0 - from.0)).clamp(0.0, 1.0);
                let outside = (from.0 - at).max(at - to.0).max(0.0);
                let points = [from.1, to.1, to.1];
                Shares { points, shares: [1.0 - part, part, 0.0], outside }
            }
        }
    }
}

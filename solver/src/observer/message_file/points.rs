//! Particles and scalars as viewers draw them: a cloud of points, packed into bytes.

use alewife_mesh::{Mesh, Point};
use data_encoding::BASE64;
use serde::Serialize;

use super::foxglove::WORLD;
use super::primitives::{Placement, Timestamp};
use crate::body::in_space;
use crate::tracer::Cloud;

/// Bytes of a point: four numbers of single precision.
const STRIDE: u32 = 16;
/// A number of single precision, in the words of viewers.
const FLOAT32: u8 = 7;

#[derive(Serialize)]
struct Field {
    name: &'static str,
    offset: u32,
    #[serde(rename = "type")]
    kind: u8,
}

#[derive(Serialize)]
struct PointCloud {
    timestamp: Timestamp,
    frame_id: &'static str,
    pose: Placement,
    point_stride: u32,
    fields: [Field; 4],
    data: String,
}

/// The particles of a cloud that are in the fluid, where they are in the mesh, with the time of their release.
pub fn point_cloud<const D: usize>(cloud: &Cloud<D>, time: f64) -> impl Serialize + use<D> {
    let in_fluid = cloud.particles.iter().filter(|particle| particle.is_in_fluid());
    let points = in_fluid.map(|one| (one.position + one.shift, one.released));
    packed(points, "released", time)
}

/// A scalar at the nodes of a mesh.
pub fn scalar_cloud<const D: usize>(
    mesh: &Mesh<D>,
    values: &[f64],
    time: f64,
) -> impl Serialize + use<D> {
    packed(mesh.nodes.iter().copied().zip(values.iter().copied()), "value", time)
}

/// Points (m), each with a number of a name.
fn packed<const D: usize>(
    points: impl Iterator<Item = (Point<D>, f64)>,
    name: &'static str,
    time: f64,
) -> PointCloud {
    #[expect(clippy::cast_possible_truncation, reason = "single precision is what viewers draw")]
    let bytes: Vec<u8> = points
        .flat_map(|(place, number)| {
            let place = in_space(&place);
            [place.x, place.y, place.z, number].map(|number| number as f32)
        })
        .flat_map(f32::to_le_bytes)
        .collect();
    let field = |name, offset| Field { name, offset, kind: FLOAT32 };
    PointCloud {
        timestamp: Timestamp::of(time),
        frame_id: WORLD,
        pose: Placement::none(),
        point_stride: STRIDE,
        fields: [field("x", 0), field("y", 4), field("z", 8), field(name, 12)],
        data: BASE64.encode(&bytes),
    }
}

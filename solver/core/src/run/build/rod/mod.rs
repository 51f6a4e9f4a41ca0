//! The elastic rod of a body of a case: in the plane and in space, and what it is fixed to.

mod attach;
mod laws;
mod planar;
mod spatial;

use std::sync::Arc;

use crate::case::{Body, Case, Geometry};
use crate::gait::ShapeMotion;
use crate::run::RunError;

pub(super) use self::attach::attach;

/// The shape of a body that is a rod, which starts from its shape without loads; `None` of one that is none.
///
/// # Errors
/// Where its numbers make no rod.
pub fn rod_shape(case: &Case, body: &Body) -> Result<Option<Arc<dyn ShapeMotion>>, RunError> {
    let Some(spec) = &body.rod else { return Ok(None) };
    let shape: Arc<dyn ShapeMotion> = match case.geometry {
        Geometry::Spatial => Arc::new(spatial::shape(case, body, spec)?),
        Geometry::Planar | Geometry::Axisymmetric => Arc::new(planar::shape(case, body, spec)?),
    };
    Ok(Some(shape))
}

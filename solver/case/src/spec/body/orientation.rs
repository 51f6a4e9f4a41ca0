//! `orientation`: how a body is turned in space.

#[cfg(test)]
use crate::spec::number::Direction;
use serde::{Deserialize, Serialize};

/// `orientation`: how the body frame is turned from that of the laboratory, one of these.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Orientation {
    /// Turned about an axis.
    Turned {
        /// Direction of the axis, of any length.
        #[cfg_attr(test, schemars(with = "Direction"))]
        axis: [f64; 3],
        /// Angle, right-handed about the axis (rad).
        #[serde(deserialize_with = "crate::text::angle::deserialize")]
        #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
        angle: f64,
    },
    /// Unit quaternion [w, x, y, z], from the body frame to the laboratory.
    Quaternion([f64; 4]),
    /// The body's x axis points along this direction, of any length, by the shortest turn.
    Along(#[cfg_attr(test, schemars(with = "Direction"))] [f64; 3]),
}

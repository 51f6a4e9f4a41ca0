//! `[[joint]]`: how a body hangs on another.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::stroke::Stroke;

/// `[[joint]]`: the child hangs on the parent; bodies and joints make trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Name of the body it hangs on.
    pub parent: String,
    /// Name of the body that hangs.
    pub child: String,
    /// Where the joint is on the parent, in its frame (m); its origin if absent.
    #[serde(default)]
    pub on_parent: [f64; 2],
    /// Where the joint is on the child, in its frame (m); its origin if absent.
    #[serde(default)]
    pub on_child: [f64; 2],
    /// What it lets the child do.
    pub kind: JointKind,
    /// Whether it was made for a `[[swimmer]]`.
    #[serde(skip)]
    pub is_made: bool,
}

/// What a joint lets its child do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum JointKind {
    /// An arm of given length from the joint of the parent to that of the child; it turns with the
    /// parent, and the child turns with both.
    Arm {
        /// Length (m).
        length: Stroke,
        /// Direction in the parent's frame, from x, counter-clockwise (rad).
        #[serde(default)]
        direction: f64,
    },
    /// A pivot bent by a given angle.
    Bent {
        /// Angle of the child less that of the parent (rad).
        angle: Stroke,
    },
    /// A free pivot: torque on the child -stiffness (angle - rest) - damping rate + torque, with the
    /// angle of the child less that of the parent; the opposite on the parent.
    Hinge(Hinge),
}

impl JointKind {
    /// What is given in time of where the child is; nothing of a free pivot.
    #[must_use]
    pub fn stroke(&self) -> Option<&Stroke> {
        match self {
            Self::Arm { length, .. } => Some(length),
            Self::Bent { angle } => Some(angle),
            Self::Hinge(_) => None,
        }
    }
}

/// `hinge`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Torque per angle (N m/rad; N/rad planar).
    #[serde(default)]
    pub stiffness: f64,
    /// Torque per angular velocity (N m s/rad; N s/rad planar).
    #[serde(default)]
    pub damping: f64,
    /// Angle at rest (rad).
    #[serde(default)]
    pub rest: f64,
    /// Torque of a motor on the child (N m; N planar).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Stroke>,
}

//! `skin` of a chain: its links as one body with a contiguous outline, which bends at the pivots.

use alewife_mesh::{MeshError, Profile, TubeForm};
use serde::{Deserialize, Serialize};

use super::body::{GaitSpec, ShapeSpec};
use super::link::{Extent, Link};
use super::parts::{Part, middle};
use super::stroke::Stroke;
use super::swimmer::Pivot;

/// Material points along the length over which a skin bends.
const POINTS_OF_BEND: f64 = 16.0;

/// Largest rate of the step by which a skin bends, over the mean one.
pub(crate) const STEEPEST: f64 = 1.875;

/// `skin`: one smooth tube about the midline of all links.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Skin {
    /// Length of midline over which it bends at each pivot (m); half the shortest distance between
    /// neighbouring pivots, or of an end from its pivot, if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rounding: Option<f64>,
}

/// The outline of a chain with a skin, straight along the body's x.
#[derive(Debug, Clone, PartialEq)]
pub struct TubeShape {
    /// [distance from the head, half width] in the middle of each link (m).
    pub sections: Vec<[f64; 2]>,
    /// Length (m).
    pub length: f64,
    /// Longest distance between material points (m).
    pub spacing: f64,
}

/// How a chain with a skin bends.
#[derive(Debug, Clone, PartialEq)]
pub struct JointsGait {
    /// From the head on.
    pub joints: Vec<BentJoint>,
    /// Length of midline over which each of them bends (m).
    pub rounding: f64,
}

/// A pivot inside a skin.
#[derive(Debug, Clone, PartialEq)]
pub struct BentJoint {
    /// Distance from the head (m).
    pub along: f64,
    /// Angle of the link farther from the root less that of the nearer one (rad).
    pub angle: Stroke,
    /// Whether it is behind the root.
    pub is_behind_root: bool,
}

impl TubeShape {
    /// Half width along the midline; `None` for lengths that make no body.
    #[must_use]
    pub fn profile(&self) -> Option<Profile> {
        Profile::tube(&TubeForm {
            sections: self.sections.clone(),
            length: self.length,
            spacing: self.spacing,
        })
    }
}

impl JointsGait {
    /// The time after which it begins again (s), if it does.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        self.joints.iter().find_map(|joint| joint.angle.period())
    }
}

/// Pivots along a chain that is laid straight.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// What it is in the middle of each link.
    pub sections: Vec<[f64; 2]>,
    /// Distance of each pivot from the head (m).
    pub pivots: Vec<f64>,
    /// Length (m).
    pub length: f64,
}

impl Layout {
    /// Of links with a gap (m) between their ends.
    ///
    /// # Errors
    /// When a link has no outline: its number, and why.
    pub fn new(links: &[Link], gap: f64) -> Result<Self, (usize, MeshError)> {
        let mut layout = Self { sections: Vec::new(), pivots: Vec::new(), length: 0.0 };
        for (nth, link) in links.iter().enumerate() {
            let Extent { back, front, half_width } = link.extent().map_err(|error| (nth, error))?;
            if nth > 0 {
                layout.pivots.push(layout.length + 0.5 * gap);
                layout.length += gap;
            }
            layout.sections.push([layout.length + 0.5 * (front - back), half_width]);
            layout.length += front - back;
        }
        Ok(layout)
    }

    /// Shortest distance between neighbouring pivots, or of an end from its pivot (m).
    pub fn shortest(&self) -> f64 {
        let ends = [0.0, self.length];
        let mut places: Vec<f64> = self.pivots.iter().copied().chain(ends).collect();
        places.sort_by(f64::total_cmp);
        places.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min)
    }

    /// Length of midline over which a skin bends (m).
    pub fn rounding(&self, skin: Skin) -> f64 {
        skin.rounding.unwrap_or(0.5 * self.shortest())
    }

    /// The one body that all links are.
    pub fn part(&self, skin: Skin, joints: &[Pivot]) -> Part {
        let rounding = self.rounding(skin);
        let root = middle(self.sections.len());
        let bent = |(nth, (along, pivot)): (usize, (&f64, &Pivot))| {
            let Pivot::Bent { angle } = pivot else { return None };
            Some(BentJoint { along: *along, angle: angle.clone(), is_behind_root: nth >= root })
        };
        let joints = self.pivots.iter().zip(joints).enumerate().filter_map(bent).collect();
        let spacing = rounding / POINTS_OF_BEND;
        let (sections, length) = (self.sections.clone(), self.length);
        Part {
            shape: ShapeSpec::Tube(TubeShape { sections, length, spacing }),
            gait: Some(GaitSpec::Joints(JointsGait { joints, rounding })),
            density: None,
            attachment: None,
        }
    }
}

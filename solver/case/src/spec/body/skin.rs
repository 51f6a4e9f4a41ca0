//! `skin` of a chain: its links as one body with a contiguous outline, which bends at the pivots.

use alewife_mesh::MeshError;

use super::gait::{BentJoint, JointsGait, TubeShape};
use super::link::{Link, LinkExtent};
use super::swimmer::{Pivot, Skin};

/// Material points along the length over which a skin bends.
const POINTS_OF_BEND: f64 = 16.0;

/// Largest rate of the step by which a skin bends, over the mean one.
pub(crate) const STEEPEST: f64 = 1.875;

/// A link of a chain without an outline.
pub struct NoOutline {
    /// Its number.
    pub link: usize,
    /// Why.
    pub error: MeshError,
}

/// Pivots along a chain that is laid straight.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// [distance from the head, half width] in the middle of each link (m).
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
    /// When a link has no outline.
    pub fn new(links: &[Link], gap: f64) -> Result<Self, NoOutline> {
        let mut layout = Self { sections: Vec::new(), pivots: Vec::new(), length: 0.0 };
        for (nth, link) in links.iter().enumerate() {
            let LinkExtent { back, front, half_width } =
                link.extent().map_err(|error| NoOutline { link: nth, error })?;
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

    /// The outline of the one body that all links are, straight.
    pub fn shape(&self, skin: Skin) -> TubeShape {
        let spacing = self.rounding(skin) / POINTS_OF_BEND;
        TubeShape { sections: self.sections.clone(), length: self.length, spacing }
    }

    /// How it bends, all links attached to the link of number `root`.
    pub fn gait(&self, skin: Skin, joints: &[Pivot], root: usize) -> JointsGait {
        let bent = |(nth, (along, pivot)): (usize, (&f64, &Pivot))| {
            let Pivot::Bent { angle } = pivot else { return None };
            Some(BentJoint { along: *along, angle: angle.clone(), is_behind_root: nth >= root })
        };
        let joints = self.pivots.iter().zip(joints).enumerate().filter_map(bent).collect();
        JointsGait { joints, rounding: self.rounding(skin) }
    }
}

//! `[[tracer]]`: particles without size or weight that the flow carries along.

use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::spec::number::{CountPerDimension, NonNegative, PerDimension, Positive};

/// `[[tracer]]`: particles carried by the flow; one of `box`, `line`, `points` and `file` says where they begin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TracerSpec {
    /// Name, used in outputs and references.
    pub name: String,
    /// Particles that fill a box.
    #[serde(default, rename = "box", skip_serializing_if = "Option::is_none")]
    pub grid: Option<SeedGrid>,
    /// Particles on a straight line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<SeedLine>,
    /// Particles at points (m).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "Vec<PerDimension>"))]
    pub points: Vec<Vec<f64>>,
    /// A file with a point in each line (m), relative to the case file; it becomes `points` when the case is read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// When they are released (s).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub start: f64,
    /// Time after which they are released again, and again (s), as dye is for a streak line; once if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub every: Option<f64>,
    /// A box in which particles are counted, and their time is taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<TracerRegion>,
}

/// `tracer.box`: one particle in the middle of each of equal parts of a box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SeedGrid {
    /// Corner with the least coordinates (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub min: Vec<f64>,
    /// Corner with the largest coordinates (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub max: Vec<f64>,
    /// Parts along each coordinate.
    #[cfg_attr(test, schemars(with = "CountPerDimension"))]
    pub count: Vec<usize>,
}

/// `line` of tracers or of a probe: places of equal distance, one at each end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SeedLine {
    /// One end (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub from: Vec<f64>,
    /// The other end (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub to: Vec<f64>,
    /// Places, two or more.
    #[cfg_attr(test, schemars(range(min = 2)))]
    pub count: usize,
}

/// `tracer.region`: a box, in the laboratory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TracerRegion {
    /// Corner with the least coordinates (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub min: Vec<f64>,
    /// Corner with the largest coordinates (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub max: Vec<f64>,
}

impl TracerSpec {
    /// Particles of one release; `None` of more than can be counted.
    #[must_use]
    pub fn n_seeds(&self) -> Option<usize> {
        let of_box = |grid: &SeedGrid| {
            grid.count.iter().try_fold(1usize, |product, count| product.checked_mul(*count))
        };
        let in_box = self.grid.as_ref().map_or(Some(0), of_box)?;
        let on_line = self.line.as_ref().map_or(0, |line| line.count);
        in_box.checked_add(on_line)?.checked_add(self.points.len())
    }

    /// Releases up to a time (s).
    #[must_use]
    pub fn n_releases(&self, end: f64) -> f64 {
        self.every.map_or(1.0, |every| 1.0 + ((end - self.start) / every).floor().max(0.0))
    }

    /// Where particles begin (m), one number per dimension.
    #[must_use]
    pub fn seeds(&self) -> Vec<Vec<f64>> {
        let mut seeds = Vec::new();
        if let Some(SeedGrid { min, max, count }) = &self.grid {
            let total: usize = count.iter().product();
            for nth in 0..total {
                let mut rest = nth;
                let along = |((low, high), count): ((&f64, &f64), &usize)| {
                    let part = rest % count;
                    rest /= count;
                    low + (high - low) * (part as f64 + 0.5) / *count as f64
                };
                seeds.push(min.iter().zip(max).zip(count).map(along).collect());
            }
        }
        if let Some(SeedLine { from, to, count }) = &self.line {
            for nth in 0..*count {
                let part = nth as f64 / (count.max(&2) - 1) as f64;
                let along = |(from, to): (&f64, &f64)| from + (to - from) * part;
                seeds.push(from.iter().zip(to).map(along).collect());
            }
        }
        seeds.extend(self.points.iter().cloned());
        seeds
    }
}

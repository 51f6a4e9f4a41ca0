//! `Case`: what one case file declares.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::{
    Body, BoundaryCondition, CalibrationSpec, ContactSpec, DataSpec, DomainSpec, EnvironmentSpec,
    FieldSpec, FlowModel, FlowOptimisation, Fluid, Geometry, InitialFlow, Joint, LoadLaw,
    MagneticSpec, MeanFlowSpec, MeshSettings, Numbers, Output, Probe, ReducedSpec, Reference,
    ScalarSpec, Scales, Statistics, SwimmerSpec, TimeSettings, TracerSpec, Units, Variant,
};

/// A problem to solve: what one case file declares, after `extends`, variants and `--set`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// One line saying what is solved.
    pub title: String,
    /// A paragraph for `alewife show`: physics, source, what to expect.
    #[serde(default)]
    pub description: String,
    /// Planar, or axisymmetric (x along the axis, y the distance from it).
    pub geometry: Geometry,
    /// The consistent units of all numbers: a text, as `SI`, or labels: `{ length = "um", time = "s" }`.
    #[serde(default)]
    pub units: Units,
    /// Files that do not come with the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub data: Option<DataSpec>,
    /// Numbers with names, for use in expressions.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub define: BTreeMap<String, f64>,
    /// Name of the body the frame of reference travels with; the laboratory frame if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<String>,
    /// The fluid and its equations.
    pub fluid: Fluid,
    /// The region, with named sides; a case with `[reduced]` that is run by its reduced model alone needs none.
    #[cfg_attr(test, schemars(with = "Option<DomainSpec>"))]
    pub domain: DomainSpec,
    /// What holds on each side of the domain, by the side's name.
    #[serde(default)]
    pub boundary: BTreeMap<String, BoundaryCondition>,
    /// What drives the fluid along periodic directions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow: Option<MeanFlowSpec>,
    /// The flow an unsteady run starts from, where it is not at rest or the Stokes flow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<InitialFlow>,
    /// What acts on bodies from afar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<FieldSpec>,
    /// The bodies in the fluid, but for those of swimmers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub body: Vec<Body>,
    /// How bodies are attached to each other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joint: Vec<Joint>,
    /// Swimmers made of bodies and joints by their kind.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub swimmer: Vec<SwimmerSpec>,
    /// Forces that keep bodies apart from each other and from walls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactSpec>,
    /// The reduced model, for runs with `--fidelity reduced`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reduced: Option<ReducedSpec>,
    /// The case as a task for a controller that learns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<EnvironmentSpec>,
    /// Which numbers `alewife optimise` finds, and for what.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimisation: Option<FlowOptimisation>,
    /// Coefficients of the reduced model that are to be found, for `alewife calibrate`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<CalibrationSpec>,
    /// Cell sizes; as the region.
    #[cfg_attr(test, schemars(with = "Option<MeshSettings>"))]
    pub mesh: MeshSettings,
    /// Steady solution or time steps.
    pub time: TimeSettings,
    /// What is written, and how often.
    #[serde(default)]
    pub output: Output,
    /// Points at which the flow is measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probe: Vec<Probe>,
    /// Particles that the flow carries along.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tracer: Vec<TracerSpec>,
    /// Concentrations or temperatures that the flow carries and that diffuse.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scalar: Vec<ScalarSpec>,
    /// Length and velocity that make coefficients and numbers dimensionless.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<Scales>,
    /// Dimensionless numbers the author expects; they must agree with the derived ones.
    #[serde(default)]
    pub numbers: Numbers,
    /// The stretch of time over which statistics are taken.
    #[serde(default)]
    pub statistics: Statistics,
    /// What the case is compared with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reference: Vec<Reference>,
    /// Whether `alewife validate --quick` runs the case (its variants say so themselves).
    #[serde(default)]
    pub quick: bool,
    /// Members of a family: the same case with some keys set, and its own references.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variant: Vec<Variant>,
    /// Tables that only the full solver needs, and that were left out.
    #[serde(skip)]
    pub left_out: Vec<&'static str>,
}

impl Case {
    /// The magnetic field, if there is one.
    #[must_use]
    pub fn magnetic_field(&self) -> Option<&MagneticSpec> {
        self.field.as_ref()?.magnetic.as_ref()
    }

    /// The first sentence of the description: what the set-up is.
    #[must_use]
    pub fn gist(&self) -> String {
        first_sentence(&self.description)
    }

    /// The reduced model that is asked for, or the one that fits the fluid and the dimension.
    #[must_use]
    pub fn reduced_model(&self) -> ReducedSpec {
        let loads = match (self.fluid.model, self.geometry) {
            (FlowModel::Stokes, _) => LoadLaw::Resistive,
            (_, Geometry::Spatial) => LoadLaw::Ellipsoid,
            _ => LoadLaw::Links,
        };
        self.reduced.clone().unwrap_or_else(|| ReducedSpec::new(loads))
    }

    /// The viscosity (Pa s) that numbers of the case are made of: that at rest, or of powers of the rate of shear that at
    /// the rate of `[scales]`, velocity over length, or at 1/s where there are none.
    #[must_use]
    pub fn reference_viscosity(&self) -> f64 {
        let rate = self.scales.map_or(1.0, |scales| scales.velocity / scales.length);
        self.fluid.viscosity.reference(rate.abs())
    }
}

fn first_sentence(paragraph: &str) -> String {
    let words: Vec<&str> = paragraph.split_whitespace().collect();
    let ends = |word: &&str| word.ends_with(['.', ':']) && word.len() > 2;
    let n_words = words.iter().position(ends).map_or(words.len(), |last| last + 1);
    words[..n_words].join(" ").trim_end_matches(':').trim_end_matches('.').to_owned() + "."
}

#[cfg(test)]
mod tests {
    use super::first_sentence;

    #[test]
    fn a_sentence_ends_at_its_first_full_stop() {
        let said = first_sentence("A disc\nfalls 0.5 radii. It\nturns.");
        assert_eq!(said, "A disc falls 0.5 radii.");
        assert_eq!(first_sentence("Two kinds: one"), "Two kinds.");
        assert_eq!(first_sentence("No stop"), "No stop.");
    }
}

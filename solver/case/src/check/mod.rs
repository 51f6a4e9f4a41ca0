//! What a case means: all its diagnostics at once, each with its location and a remedy.
//!
//! Reading has made sure of keys and types. Here every number is compared with what it stands for,
//! and every name against what it names. Nothing is meshed or solved.

mod bodies;
mod boundary;
mod contact;
mod fluid;
mod gait;
mod joints;
mod mesh;
mod placement;
mod references;
mod spring;
mod strokes;
mod swimmers;
mod time;

use super::diagnostic::{Diagnostic, Severity};
use super::read::CaseFile;
use super::{Case, DomainSpec, Geometry, Model};

/// Numbers a place or a velocity has; axisymmetric cases are computed in their half plane.
const DIMENSIONS: usize = 2;

/// All diagnostics of a case: errors, which stop a run, and warnings.
#[must_use]
pub fn check(file: &CaseFile) -> Vec<Diagnostic> {
    let mut findings = Findings { file, diagnostics: Vec::new() };
    for path in file.not_finite() {
        findings.error(
            &path,
            format!("`{path}` is not a finite number"),
            "write a number such as 0.5 or 1e-3",
        );
    }
    general(&mut findings);
    fluid::check(&mut findings);
    boundary::check(&mut findings);
    bodies::check(&mut findings);
    joints::check(&mut findings);
    swimmers::check(&mut findings);
    contact::check(&mut findings);
    mesh::check(&mut findings);
    time::check(&mut findings);
    references::check(&mut findings);
    if findings.has_no_error() {
        placement::check(&mut findings);
    }
    if findings.has_no_error() {
        strokes::check(&mut findings);
    }
    findings.diagnostics
}

/// Geometry, domain and frame of reference.
fn general(findings: &mut Findings<'_>) {
    let case = findings.case();
    if case.title.trim().is_empty() {
        findings.warning(
            "title",
            "the title is empty".to_owned(),
            "say what is solved in one line",
        );
    }
    let (is_axisymmetric, wanted, domains) = match case.geometry {
        Geometry::Planar => (false, "planar", "box, channel, disc"),
        Geometry::Axisymmetric => (true, "axisymmetric", "half-disc, cylinder"),
    };
    if case.domain.is_axisymmetric() != is_axisymmetric {
        findings.error(
            "domain",
            format!("this domain does not fit `geometry = \"{wanted}\"`"),
            &format!("{wanted} domains: {domains}"),
        );
    }
    match &case.domain {
        DomainSpec::Box { min, max } => {
            if (0..2).any(|axis| max[axis] <= min[axis]) {
                findings.error(
                    "domain.box.max",
                    format!("the box from {min:?} to {max:?} is empty"),
                    "both numbers of `max` must be larger than those of `min`",
                );
            }
        }
        DomainSpec::Channel { length, height } => {
            findings.positive("domain.channel.length", *length);
            findings.positive("domain.channel.height", *height);
        }
        DomainSpec::Disc { radius, .. } => findings.positive("domain.disc.radius", *radius),
        DomainSpec::HalfDisc { radius, .. } => {
            findings.positive("domain.half-disc.radius", *radius);
        }
        DomainSpec::Cylinder { x, radius } => {
            findings.positive("domain.cylinder.radius", *radius);
            if x[1] <= x[0] {
                findings.error(
                    "domain.cylinder.x",
                    format!("the cylinder from {} to {} is empty", x[0], x[1]),
                    "write x = [start, end] with start < end",
                );
            }
        }
    }
    let model = findings.model();
    if let (Some(name), None) = (&case.frame, model.frame_body()) {
        let bodies = model.bodies.iter().map(|body| body.name.as_str());
        let swimmers = model.swimmers.iter().map(|swimmer| swimmer.name.as_str());
        let names: Vec<&str> = bodies.chain(swimmers).collect();
        findings.error(
            "frame",
            format!("`frame` is \"{name}\", but no body or swimmer has that name"),
            &super::type_error::suggestion(name, &names),
        );
    }
}

/// The diagnostics found so far.
struct Findings<'a> {
    file: &'a CaseFile,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Findings<'a> {
    fn case(&self) -> &'a Case {
        &self.file.model.case
    }

    fn model(&self) -> &'a Model {
        &self.file.model
    }

    fn has_no_error(&self) -> bool {
        self.diagnostics.iter().all(|one| one.severity == Severity::Warning)
    }

    fn add(&mut self, severity: Severity, key: &str, message: String, help: &str) {
        let key = &self.written(key);
        let location = self.file.location(key);
        let (key, help) = (key.to_owned(), help.to_owned());
        self.diagnostics.push(Diagnostic { severity, key, message, help, location });
    }

    /// The key of what stands in the file: for one of a body made for a swimmer that of the swimmer.
    fn written(&self, key: &str) -> String {
        let number = |list: &str| {
            let rest = key.strip_prefix(list)?;
            rest.split('.').next()?.parse::<usize>().ok()
        };
        let of_body = number("body.").and_then(|body| self.model().swimmer_of_body(body));
        let of_joint = number("joint.").and_then(|joint| self.model().swimmer_of_joint(joint));
        of_body
            .or(of_joint)
            .map_or_else(|| key.to_owned(), |swimmer| format!("swimmer.{swimmer}.kind"))
    }

    fn error(&mut self, key: &str, message: String, help: &str) {
        self.add(Severity::Error, key, message, help);
    }

    fn warning(&mut self, key: &str, message: String, help: &str) {
        self.add(Severity::Warning, key, message, help);
    }

    /// A number that must be larger than zero.
    fn positive(&mut self, key: &str, value: f64) {
        if value <= 0.0 {
            let help = "write a number larger than 0";
            self.error(key, format!("`{key}` is {value}, but must be positive"), help);
        }
    }

    /// A number that must not be negative.
    fn not_negative(&mut self, key: &str, value: f64) {
        if value < 0.0 {
            let help = "write 0 or a larger number";
            self.error(key, format!("`{key}` is {value}, but must not be negative"), help);
        }
    }

    /// A vector with one number per dimension; `true` if it is one.
    fn vector(&mut self, key: &str, values: &[f64]) -> bool {
        let is_vector = values.len() == DIMENSIONS;
        if !is_vector {
            let plural = if values.len() == 1 { "" } else { "s" };
            let n = values.len();
            self.error(
                key,
                format!("`{key}` has {n} number{plural}, but this case has {DIMENSIONS} dimensions"),
                "write [x, y]; in axisymmetric cases x is along the axis and y the distance from it",
            );
        }
        is_vector
    }
}

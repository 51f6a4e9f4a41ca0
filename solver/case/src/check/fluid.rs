//! Problems of `[fluid]` and `[scales]`, and numbers that disagree.

use super::Findings;
use crate::numbers::{density_ratio, reynolds, significant};
use crate::{FlowModel, Geometry};

/// Largest relative difference between a declared number and the derived one.
const AGREEMENT: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let fluid = &case.fluid;
    findings.positive("fluid.viscosity", fluid.viscosity);
    findings.not_negative("fluid.density", fluid.density);
    if fluid.model != FlowModel::Stokes && fluid.density == 0.0 {
        let model = if fluid.model == FlowModel::UnsteadyStokes {
            "unsteady-stokes"
        } else {
            "navier-stokes"
        };
        findings.error(
            "fluid.density",
            format!("the model `{model}` has inertia, but the fluid has no density"),
            "add `density = ...` to [fluid], or set `model = \"stokes\"`",
        );
    }
    if !fluid.gravity.is_empty()
        && findings.vector("fluid.gravity", &fluid.gravity)
        && case.geometry == Geometry::Axisymmetric
        && fluid.gravity[1] != 0.0
    {
        findings.error(
            "fluid.gravity",
            format!("gravity {:?} is not along the axis", fluid.gravity),
            "in an axisymmetric case write gravity = [g, 0.0]",
        );
    }
    if let Some(scales) = &case.scales {
        findings.positive("scales.length", scales.length);
        findings.positive("scales.velocity", scales.velocity);
        if let Some(area) = scales.area {
            findings.positive("scales.area", area);
        }
    }
    declared_numbers(findings);
}

/// `[numbers]` against what follows from the rest of the case.
fn declared_numbers(findings: &mut Findings<'_>) {
    let case = findings.case();
    let formula = "density * scales.velocity * scales.length / viscosity";
    let ratio = "density of the first body / density of the fluid";
    let numbers = [
        ("numbers.reynolds", "Reynolds number", case.numbers.reynolds, reynolds(case), formula),
        (
            "numbers.density_ratio",
            "density ratio",
            case.numbers.density_ratio,
            density_ratio(findings.model()),
            ratio,
        ),
    ];
    for (key, name, declared, derived, formula) in numbers {
        match (declared, derived) {
            (Some(declared), Some(derived)) => {
                // Written so that a difference that is not a number disagrees, too.
                let agrees = (declared - derived).abs() <= AGREEMENT * derived.abs();
                if !agrees {
                    findings.error(
                        key,
                        format!(
                            "the {name} is declared as {declared}, but the case gives {} \
                             = {formula}",
                            significant(derived)
                        ),
                        "correct the declared number, or the values it follows from",
                    );
                }
            }
            (Some(declared), None) => findings.error(
                key,
                format!("the {name} is declared as {declared}, but cannot be derived"),
                &format!("it is {formula}: give all of them"),
            ),
            (None, _) => {}
        }
    }
}

//! Problems of flows that are given on a side, each by itself: developed ones, and numbers at places.

use crate::rules::{Findings, OneOf};
use crate::{BoundaryCondition, FlowModel, ProfileColumn, ProfileSpec};

/// What a profile is made of.
const WANTED: &str = "write a header of coordinates and velocities, such as y,velocity.x, and a row of numbers for each place";

/// What is given of a flow, by itself.
pub fn check_given(findings: &mut Findings<'_>, key: &str, condition: &BoundaryCondition) {
    check_developed(findings, key, condition);
    if let BoundaryCondition::Profile(profile) = condition {
        check_profile(findings, &format!("{key}.profile"), profile);
    }
}

/// A developed flow has its flux or its largest velocity.
fn check_developed(findings: &mut Findings<'_>, key: &str, condition: &BoundaryCondition) {
    let BoundaryCondition::Developed { flux, peak, .. } = condition else { return };
    let of = OneOf {
        what: "a developed flow",
        names: ["flux", "peak"],
        given: [flux.is_some(), peak.is_some()],
        help: "{ developed = { flux = ... } } (m3/s; m2/s planar), or { developed = { peak = ... } } (m/s)",
    };
    findings.one_of(&format!("{key}.developed"), &of);
}

/// Its columns and rows.
fn check_profile(findings: &mut Findings<'_>, key: &str, profile: &ProfileSpec) {
    let n = findings.case().geometry.dimensions();
    let columns = &profile.columns;
    if profile.rows.is_empty() || columns.is_empty() {
        let message = "the profile has no rows of numbers".to_owned();
        findings.error(key, message, "name a CSV file: { profile = \"inflow.csv\" }");
        return;
    }
    for (nth, column) in columns.iter().enumerate() {
        let name = column.name();
        let axis = column.coordinate().or(column.velocity()).unwrap_or(0);
        if axis >= n {
            let message = format!("the profile has a column `{name}`, and the case no z");
            let help = "leave it out: there are x and y, velocity.x and velocity.y";
            findings.error(key, message, help);
        }
        if columns[..nth].contains(column) {
            findings.error(key, format!("the profile has two columns `{name}`"), WANTED);
        }
    }
    let missing = [
        (profile.coordinates().is_empty(), "coordinate", &ProfileColumn::ALL[..n]),
        (profile.velocities().is_empty(), "velocity", &ProfileColumn::ALL[3..3 + n]),
    ];
    for (is_missing, what, all) in missing {
        if is_missing {
            let names: Vec<&str> = all.iter().map(|one| one.name()).collect();
            let message = format!("the profile has no {what}");
            findings.error(key, message, &format!("give a column `{}`", names.join("`, `")));
        }
    }
    check_rows(findings, key, profile);
}

fn check_rows(findings: &mut Findings<'_>, key: &str, profile: &ProfileSpec) {
    let coordinates = profile.coordinates();
    let least = if coordinates.len() > 1 { 3 } else { 2 };
    if profile.rows.len() < least {
        let message = format!("the profile has {} rows", profile.rows.len());
        findings.error(key, message, &format!("it takes {least} places or more: {WANTED}"));
    }
    for (nth, row) in profile.rows.iter().enumerate() {
        let (number, n) = (nth + 1, profile.columns.len());
        if row.len() != n {
            let message = format!("row {number} of the profile has {} numbers", row.len());
            findings.error(key, message, &format!("write {n}, one for each column"));
            return;
        }
        if let Some(wrong) = row.iter().find(|value| !value.is_finite()) {
            let message = format!("row {number} of the profile has {wrong}");
            findings.error(key, message, "leave the row out where nothing is known");
            return;
        }
    }
    if let Some([before, number]) = profile.rows_at_one_place(&coordinates) {
        let message = format!("rows {before} and {number} of the profile are at one place");
        findings.error(key, message, "leave one of them out");
    }
}
/// Whether what a side takes of fluid that enters is there at all.
pub(super) fn check_backflow(
    findings: &mut Findings<'_>,
    key: &str,
    condition: &BoundaryCondition,
) {
    let (name, backflow) = match condition {
        BoundaryCondition::Pressure { backflow, .. } => ("pressure", *backflow),
        BoundaryCondition::Traction { backflow, .. } => ("traction", *backflow),
        _ => return,
    };
    if backflow > 0.0 && findings.case().fluid.model != FlowModel::NavierStokes {
        findings.error(
            &format!("{key}.{name}.backflow"),
            format!(
                "{backflow} of the momentum of fluid that enters, but nothing convects momentum"
            ),
            "leave `backflow` out, or set fluid.model = \"navier-stokes\"",
        );
    }
}

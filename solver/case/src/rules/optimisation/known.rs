//! Problems of quantities that a search asks for: whether there are such, and their gradients.

use crate::quantity::{differentiable_columns, known_quantities};
use crate::rules::Findings;
use crate::rules::references::check_quantity;
use crate::{TimeSettings, significant};

/// Part of a period that is rounding.
const ROUNDING: f64 = 1e-9;

/// Whether the gradient of a quantity is known.
pub fn check_known(findings: &mut Findings<'_>, key: &str, quantity: &str) {
    let known = known_quantities(findings.model());
    let columns = differentiable_columns(findings.model());
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    if names.contains(&quantity) {
        return check_cycle(findings, key, quantity);
    }
    if !known.iter().any(|name| name == quantity) {
        check_quantity(findings, key, quantity, &known);
        return;
    }
    findings.error(
        key,
        format!("the gradient of `{quantity}` is not known"),
        &format!(
            "gradients are those of loads, powers and velocities of bodies and swimmers: {}",
            names.join(", ")
        ),
    );
}

/// An average over a cycle has no value before the first one has ended.
fn check_cycle(findings: &mut Findings<'_>, key: &str, quantity: &str) {
    let TimeSettings::Unsteady(time) = &findings.case().time else { return };
    let swimmers = &findings.model().swimmers;
    let of = |name: &str| quantity.strip_prefix(name)?.strip_prefix(".cycle.").map(|_| ());
    let Some(swimmer) = swimmers.iter().find(|swimmer| of(&swimmer.name).is_some()) else { return };
    let Some(period) = swimmer.period.filter(|period| *period > time.end * (1.0 + ROUNDING)) else {
        return;
    };
    let (period, end) = (significant(period), significant(time.end));
    findings.error(
        key,
        format!("`{quantity}` has no value: a cycle takes {period}, and the run ends at {end}"),
        &format!("write time.unsteady.end = {period} or more"),
    );
}

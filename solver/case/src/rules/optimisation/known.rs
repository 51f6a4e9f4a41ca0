//! Problems of quantities that a search asks for: whether there are such, and their gradients.

use crate::quantity::{differentiable_columns, known_quantities};
use crate::rules::Findings;
use crate::rules::references::check_quantity;

/// Whether the gradient of a quantity is known.
pub fn check_known(findings: &mut Findings<'_>, key: &str, quantity: &str) {
    let known = known_quantities(findings.model());
    let columns = differentiable_columns(findings.model());
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    if names.contains(&quantity) {
        return;
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

//! Problems of the parts of a magnetic field: vectors that are zero, and fields that no magnet makes.

use super::strokes::check_strokes;
use crate::model::numbers::significant;
use crate::model::speed::norm;
use crate::rules::Findings;
use crate::{DipoleField, Geometry, LinearField, MagneticSpec, RotatingField};

/// Sum of derivatives over the largest of them that is taken for rounding.
const ROUNDING: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>, field: &MagneticSpec) {
    if *field == MagneticSpec::default() {
        findings.error(
            "field.magnetic",
            "the magnetic field has no part".to_owned(),
            "give it `rotating`, `components`, `linear` or `dipoles`; it is the sum of what is given",
        );
    }
    check_strokes(findings, field);
    if let Some(rotating) = &field.rotating {
        check_rotating(findings, rotating);
    }
    if !field.components.is_empty() {
        check_components(findings, field);
    }
    if let Some(linear) = &field.linear {
        check_linear(findings, linear);
    }
    for (nth, dipole) in field.dipoles.iter().enumerate() {
        check_dipole(findings, &format!("field.magnetic.dipoles.{nth}"), dipole);
    }
}

fn check_rotating(findings: &mut Findings<'_>, rotating: &RotatingField) {
    if findings.case().geometry == Geometry::Spatial && rotating.axis.is_none() {
        findings.error(
            "field.magnetic.rotating",
            "the field rotates in space, about no axis".to_owned(),
            "add axis = [x, y, z]: the field turns counter-clockwise about it",
        );
    }
}

fn check_components(findings: &mut Findings<'_>, field: &MagneticSpec) {
    let (components, geometry) = (&field.components, findings.case().geometry);
    let (n, key) = (geometry.dimensions(), "field.magnetic.components");
    let is_zero = |axis: usize| components[axis].range() == [0.0; 2];
    if components.len() != n {
        let plural = if components.len() == 1 { "" } else { "s" };
        let is_out = geometry == Geometry::Planar && components.len() == 3;
        findings.error(
            key,
            format!(
                "`{key}` has {} stroke{plural}, but this case has {n} dimensions",
                components.len()
            ),
            if n == 3 {
                "write one along x, y and z, such as { constant = 0.0 }"
            } else if is_out {
                "write one along x and y: a field out of the plane turns nothing in it"
            } else {
                "write one along x and y, such as { constant = 0.0 }"
            },
        );
    } else if (0..n).all(is_zero) && findings.is_right(key) {
        findings.error(
            key,
            "the components of the field are zero at all times".to_owned(),
            "give one of them a value other than 0, or leave them out",
        );
    } else if geometry == Geometry::Axisymmetric && !is_zero(1) {
        findings.error(
            &format!("{key}.1"),
            "a field across the axis breaks the symmetry".to_owned(),
            "write { constant = 0.0 }, or take geometry = \"spatial\"",
        );
    }
}

fn check_linear(findings: &mut Findings<'_>, linear: &LinearField) {
    let (rows, geometry) = (&linear.gradient, findings.case().geometry);
    let (n, key) = (geometry.dimensions(), "field.magnetic.linear.gradient");
    if rows.len() != n || rows.iter().any(|row| row.len() != n) {
        findings.error(
            key,
            format!("`{key}` is no matrix of {n} rows with {n} numbers each"),
            if n == 3 {
                "write [[g, 0.0, 0.0], [0.0, -0.5 g, 0.0], [0.0, 0.0, -0.5 g]] or another symmetric matrix"
            } else {
                "write [[g, 0.0], [0.0, -g]] or another symmetric matrix"
            },
        );
        return;
    }
    let largest = rows.iter().flatten().fold(0.0f64, |most, entry| most.max(entry.abs()));
    if largest == 0.0 {
        findings.error(
            key,
            "all derivatives of the field are zero".to_owned(),
            "give one another value, or leave `linear` out",
        );
        return;
    }
    for row in 0..n {
        for column in 0..row {
            let [one, other] = [rows[row][column], rows[column][row]];
            if (one - other).abs() > ROUNDING * largest {
                findings.error(
                    &format!("{key}.{row}.{column}"),
                    format!(
                        "`{key}` is not symmetric: {one} and {other}; such a field has a rotation"
                    ),
                    "write the same number on both sides of the diagonal",
                );
            }
        }
    }
    let mut trace: f64 = (0..n).map(|axis| rows[axis][axis]).sum();
    if geometry == Geometry::Axisymmetric {
        trace += rows[1][1];
        if rows[0][1] != 0.0 {
            findings.error(
                &format!("{key}.0.1"),
                "the field has a part across the axis, which breaks the symmetry".to_owned(),
                "write [[g, 0.0], [0.0, -0.5 g]]",
            );
        }
    }
    if trace.abs() > ROUNDING * largest {
        let last = rows[n - 1][n - 1];
        let wanted = match geometry {
            Geometry::Axisymmetric => last - 0.5 * trace,
            _ => last - trace,
        };
        findings.error(
            &format!("{key}.{}.{}", n - 1, n - 1),
            format!(
                "the divergence of the field is {}, and that of all magnetic fields zero",
                significant(trace)
            ),
            &format!("write {} there", significant(wanted)),
        );
    }
}

fn check_dipole(findings: &mut Findings<'_>, key: &str, dipole: &DipoleField) {
    let DipoleField { position, strength, .. } = dipole;
    if !strength.is_empty() && strength.iter().all(|part| *part == 0.0) {
        findings.error(
            &format!("{key}.strength"),
            "the strength of the dipole is zero".to_owned(),
            "write a vector such as [1.0, 0.0], or leave the dipole out",
        );
    }
    if findings.case().geometry == Geometry::Axisymmetric {
        for (name, vector) in [("position", position), ("strength", strength)] {
            if vector.get(1).is_some_and(|across| *across != 0.0) {
                findings.error(
                    &format!("{key}.{name}.1"),
                    "a dipole off the axis, or across it, breaks the symmetry".to_owned(),
                    "write 0.0, or take geometry = \"spatial\"",
                );
            }
        }
    }
    for body in findings.model().bodies.iter().filter(|body| !body.magnetic_moment.is_empty()) {
        let ways = position.iter().zip(&body.center).map(|(at, center)| at - center);
        let distance = norm(&ways.collect::<Vec<_>>());
        if distance < body.shape.reach() {
            findings.error(
                &format!("{key}.position"),
                format!(
                    "the dipole is {} from the centre of \"{}\", within it",
                    significant(distance),
                    body.name
                ),
                "put it outside of the bodies: its field grows without bound",
            );
        }
    }
}

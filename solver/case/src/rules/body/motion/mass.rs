//! Problems of `body.mass`, `body.inertia` and `body.center_of_mass`.

use nalgebra::Matrix3;

use crate::rules::Findings;
use crate::{Body, FlowModel, Geometry, InertiaSpec};

/// What is rounding in a tensor, over its largest entry.
const ROUNDING: f64 = 1e-9;

pub fn check(findings: &mut Findings<'_>, index: usize, body: &Body) {
    let (key, name) = (format!("body.{index}"), &body.name);
    if body.mass.is_some() && body.density.is_some() {
        findings.error(
            &format!("{key}.mass"),
            format!("\"{name}\" has a mass and a density"),
            "leave one of them out: the mass is the density times what the shape encloses",
        );
    }
    let given = [
        ("mass", body.mass.is_some()),
        ("inertia", body.inertia.is_some()),
        ("center_of_mass", !body.center_of_mass.is_empty()),
    ];
    for (what, _) in given.iter().filter(|(_, is_given)| *is_given && body.deforms()) {
        findings.error(
            &format!("{key}.{what}"),
            format!("\"{name}\" deforms: its mass is spread evenly over its shape"),
            "give its density, and leave this out",
        );
    }
    check_center(findings, &key, body);
    if let Some(inertia) = &body.inertia {
        check_inertia(findings, &format!("{key}.inertia"), body, inertia);
    }
}

/// A centre of mass that is far outside is hardly meant: of another unit, or in the laboratory.
fn check_center(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let off = crate::model::speed::norm(&body.center_of_mass);
    let reach = body.shape.reach();
    if off > 2.0 * reach && reach > 0.0 {
        findings.warning(
            &format!("{key}.center_of_mass"),
            format!(
                "the centre of mass of \"{}\" is {off:.3} from its origin, and its shape reaches {reach:.3}",
                body.name
            ),
            "it is given in the frame of the body, [0, 0] its origin, not in the laboratory",
        );
    }
}

fn check_inertia(findings: &mut Findings<'_>, key: &str, body: &Body, inertia: &InertiaSpec) {
    let case = findings.case();
    let is_planar = matches!(inertia, InertiaSpec::AboutZ(_));
    match (case.geometry, is_planar) {
        (Geometry::Planar, false) => {
            findings.error(
                key,
                format!(
                    "the inertia of \"{}\" has three parts, and it turns about z only",
                    body.name
                ),
                "write one number, or take geometry = \"spatial\"",
            );
            return;
        }
        (Geometry::Spatial, true) => {
            findings.error(
                key,
                format!(
                    "the inertia of \"{}\" is one number, and it turns about all axes",
                    body.name
                ),
                "write [xx, yy, zz] about the axes of the body, or the tensor by its three rows",
            );
            return;
        }
        _ => {}
    }
    if case.fluid.model == FlowModel::Stokes {
        findings.warning(
            key,
            format!(
                "`inertia` has no effect on \"{}\": in `stokes` nothing has inertia",
                body.name
            ),
            "leave it out, or take fluid.model = \"navier-stokes\" or \"unsteady-stokes\"",
        );
    }
    if let (Geometry::Spatial, Some(wrong)) = (case.geometry, impossible(&inertia.tensor())) {
        findings.error(
            key,
            format!("no body has this inertia: {wrong}"),
            "of a body of unit density, [xx, yy, zz] are the integrals of y2 + z2, x2 + z2 and x2 + y2",
        );
    }
}

/// Why no masses have a tensor of inertia.
fn impossible(tensor: &Matrix3<f64>) -> Option<String> {
    let small = ROUNDING * tensor.amax();
    if (tensor - tensor.transpose()).amax() > small {
        return Some("its tensor is not symmetric".to_owned());
    }
    let moments = tensor.symmetric_eigenvalues();
    if moments.min() < -small {
        return Some(format!("about one axis it is {:.3e}", moments.min()));
    }
    let (most, sum) = (moments.max(), moments.sum());
    (most > sum - most + small).then(|| {
        format!(
            "the largest moment {most:.3e} is more than the two others together, {:.3e}",
            sum - most
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::{Case, Severity, check};

    /// Keys and messages of the problems of a case with these lines for its body.
    fn wrong(geometry: &str, lines: &str, settings: &[&str]) -> Vec<(String, Severity)> {
        let (shape, domain, center) = match geometry {
            "planar" => ("disc.radius = 1.0", "disc", "[0.0, 0.0]"),
            "axisymmetric" => ("sphere.radius = 1.0", "half-disc", "[0.0, 0.0]"),
            _ => ("sphere.radius = 1.0", "sphere", "[0.0, 0.0, 0.0]"),
        };
        let text = format!(
            "title = 't'
geometry = '{geometry}'
fluid = {{ model = 'navier-stokes', viscosity = 1.0, density = 1.0 }}
domain.{domain}.radius = 4.0
boundary.wall = 'no-slip'
mesh = {{ size = 0.5, surface = 0.1 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = 'b'
shape.{shape}
center = {center}
motion = 'free'
force = [1.0, 0.0{}]
{lines}
",
            if geometry == "spatial" { ", 0.0" } else { "" }
        );
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let file = Case::parse("t.toml", &text, &settings).unwrap();
        check(&file).into_iter().map(|found| (found.key, found.severity)).collect()
    }

    #[test]
    fn bodies_have_mass_centre_and_inertia_of_their_own() {
        for (geometry, lines) in [
            ("planar", "mass = 3.0\ninertia = 2.0\ncenter_of_mass = [0.2, -0.1]"),
            ("planar", "mass = 0\ninertia = 0"),
            ("axisymmetric", "mass = 3.0\ncenter_of_mass = [-0.2, 0.0]"),
            ("spatial", "inertia = [1.0, 2, 2.5]\ncenter_of_mass = [0.0, 0.0, -0.1]"),
            ("spatial", "inertia = [[1.0, 0.1, 0], [0.1, 1.0, 0], [0, 0, 1.5]]"),
        ] {
            assert_eq!(wrong(geometry, lines, &[]), [], "{lines}");
        }
    }

    #[test]
    fn what_no_body_has_is_refused() {
        for (geometry, lines, key) in [
            ("planar", "mass = 1.0\ndensity = 1.0", "body.0.mass"),
            ("planar", "mass = -1.0", "body.0.mass"),
            ("planar", "inertia = -1.0", "body.0.inertia"),
            ("planar", "inertia = [1.0, 1.0, 1.0]", "body.0.inertia"),
            ("planar", "center_of_mass = [1.0]", "body.0.center_of_mass"),
            ("axisymmetric", "inertia = 1.0", "body.0.inertia"),
            ("axisymmetric", "center_of_mass = [0.0, 0.1]", "body.0.center_of_mass.1"),
            ("spatial", "inertia = 1.0", "body.0.inertia"),
            ("spatial", "inertia = [1.0, 1.0, 2.5]", "body.0.inertia"),
            ("spatial", "inertia = [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]", "body.0.inertia"),
            ("spatial", "inertia = [[1, 2, 0], [2, 1, 0], [0, 0, 1]]", "body.0.inertia"),
            (
                "axisymmetric",
                "mass = 1.0\ngait.pulsating = { amplitude = 0.1, period = 1.0 }",
                "body.0.mass",
            ),
        ] {
            let found = wrong(geometry, lines, &[]);
            let errors: Vec<&str> = found
                .iter()
                .filter(|(_, severity)| *severity == Severity::Error)
                .map(|(key, _)| key.as_str())
                .collect();
            assert!(errors.contains(&key), "{lines}: {found:?}");
        }
        let far = wrong("planar", "center_of_mass = [3.0, 0.0]", &[]);
        assert_eq!(far, [("body.0.center_of_mass".to_owned(), Severity::Warning)]);
    }
}

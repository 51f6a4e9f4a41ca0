//! Fields and moments that are right, and what is said of those that are not.

use crate::{Case, Diagnostic, Severity, check};

/// Problems of a free disc, a sphere in space, with a moment and a field, with some settings.
fn problems(geometry: &str, settings: &[&str]) -> Vec<Diagnostic> {
    let is_spatial = geometry == "spatial";
    let (domain, shape, center) = match geometry {
        "spatial" => ("sphere = { radius = 3.0 }", "sphere", "[0.0, 0.0, 0.0]"),
        "axisymmetric" => ("half-disc = { radius = 3.0 }", "sphere", "[0.0, 0.0]"),
        _ => ("disc = { radius = 3.0 }", "disc", "[0.0, 0.0]"),
    };
    let moment = if is_spatial { "[0.0, 1.0, 0.0]" } else { "[1.0, 0.0]" };
    let field = match geometry {
        "spatial" => "rotating = { strength = 2.0, frequency = 0.5, axis = [1.0, 0.0, 0.0] }",
        "axisymmetric" => "linear = { gradient = [[1.0, 0.0], [0.0, -0.5]] }",
        _ => "rotating = { strength = 2.0, frequency = 0.5 }",
    };
    let text = format!(
        "title = 't'
geometry = '{geometry}'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain = {{ {domain} }}
boundary = {{ wall = 'no-slip' }}
mesh = {{ size = 0.25 }}
time.unsteady = {{ step = 0.02, end = 1.0 }}
field.magnetic = {{ {field} }}
[[body]]
name = 'b'
shape = {{ {shape} = {{ radius = 1.0 }} }}
center = {center}
motion = 'free'
magnetic_moment = {moment}
"
    );
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    check(&Case::parse("t.toml", &text, &settings).unwrap())
}

/// The only problem is of this kind, at this key, and says so.
#[track_caller]
fn only(geometry: &str, settings: &[&str], severity: Severity, [key, message]: [&str; 2]) {
    let found = problems(geometry, settings);
    assert_eq!(found.len(), 1, "{settings:?}: {found:?}");
    let one = &found[0];
    assert_eq!((one.severity, one.key.as_str()), (severity, key), "{settings:?}: {found:?}");
    assert!(one.message.contains(message) && !one.help.is_empty(), "{settings:?}: {found:?}");
}

#[test]
fn fields_of_all_kinds_are_right() {
    for geometry in ["planar", "axisymmetric", "spatial"] {
        assert_eq!(problems(geometry, &[]), [], "{geometry}");
    }
    for field in [
        "{ components = [{ constant = 1.0 }, { sine = { amplitude = 1.0, period = 1.0 } }] }",
        "{ linear = { gradient = [[1.0, 0.5], [0.5, -1.0]], center = [0.2, 0.0] } }",
        "{ dipoles = [{ position = [5.0, 0.0], strength = [1.0, 0.0], factor = { constant = 2.0 } }] }",
        "{ rotating = { strength = 1.0, frequency = 1.0, clockwise = true, phase = 0.25, ramp = 1.0 } }",
    ] {
        assert_eq!(problems("planar", &[&format!("field.magnetic={field}")]), [], "{field}");
    }
    let steady = [
        "time={ steady = {} }",
        "field.magnetic={ components = [{ constant = 1.0 }, { constant = 0.0 }] }",
    ];
    assert_eq!(problems("planar", &steady), []);
}

#[test]
fn moments_that_are_none_are_refused() {
    let moment = "body.0.magnetic_moment";
    for (geometry, value, message) in [
        ("planar", "[0.0, 0.0]", "is zero"),
        ("planar", "[1.0, 0.0, 0.5]", "points out of the plane"),
        ("planar", "[1.0, 0.0, 0.0]", "has 3 numbers, but this case has 2"),
        ("planar", "[1.0]", "has 1 number,"),
        ("axisymmetric", "[1.0, 0.5]", "breaks the symmetry"),
        ("spatial", "[0.0, 0.0, 0.0]", "is zero"),
        ("spatial", "[1.0, 0.0]", "has 2 numbers"),
        ("planar", "[nan, 0.0]", "is not a finite number"),
    ] {
        let found = problems(geometry, &[&format!("{moment}={value}")]);
        let errors: Vec<_> = found.iter().filter(|one| one.severity == Severity::Error).collect();
        assert_eq!(errors.len(), 1, "{value}: {found:?}");
        assert!(errors[0].key.starts_with(moment), "{value}: {found:?}");
        assert!(errors[0].message.contains(message), "{value}: {found:?}");
    }
}

#[test]
fn fields_that_no_magnet_makes_are_refused() {
    let field = "field.magnetic";
    let error = Severity::Error;
    for (geometry, setting, key, message) in [
        ("planar", "field={}", "field", "has no field in it"),
        ("planar", "field.magnetic={}", field, "has no part"),
        (
            "planar",
            "field.magnetic.rotating.strength=0.0",
            "field.magnetic.rotating.strength",
            "must be positive",
        ),
        (
            "planar",
            "field.magnetic.rotating.frequency=-2.0",
            "field.magnetic.rotating.frequency",
            "is -2, but must be positive",
        ),
        (
            "planar",
            "field.magnetic.rotating.frequency=inf",
            "field.magnetic.rotating.frequency",
            "finite",
        ),
        (
            "planar",
            "field.magnetic.rotating.axis=[0.0, 0.0, 1.0]",
            "field.magnetic.rotating.axis",
            "no meaning",
        ),
        (
            "spatial",
            "field.magnetic.rotating.clockwise=true",
            "field.magnetic.rotating.clockwise",
            "no meaning",
        ),
        (
            "spatial",
            "field.magnetic.rotating.axis=[0.0, 0.0, 0.0]",
            "field.magnetic.rotating.axis",
            "points nowhere",
        ),
        (
            "spatial",
            "field.magnetic={ rotating = { strength = 1.0, frequency = 1.0 } }",
            "field.magnetic.rotating",
            "about no axis",
        ),
        (
            "axisymmetric",
            "field.magnetic={ rotating = { strength = 1.0, frequency = 1.0 } }",
            "field.magnetic.rotating",
            "no meaning",
        ),
        (
            "planar",
            "field.magnetic={ components = [{ constant = 1.0 }] }",
            "field.magnetic.components",
            "has 1 stroke,",
        ),
        (
            "planar",
            "field.magnetic={ components = [{ constant = 0.0 }, { constant = 0.0 }] }",
            "field.magnetic.components",
            "zero at all times",
        ),
        (
            "planar",
            "field.magnetic={ components = [{ table = [] }, { constant = 1.0 }] }",
            "field.magnetic.components.0.table",
            "must rise",
        ),
        (
            "axisymmetric",
            "field.magnetic={ components = [{ constant = 1.0 }, { constant = 1.0 }] }",
            "field.magnetic.components.1",
            "breaks the symmetry",
        ),
        (
            "planar",
            "field.magnetic={ linear = { gradient = [[1.0, 0.0], [0.0, 0.5]] } }",
            "field.magnetic.linear.gradient.1.1",
            "divergence",
        ),
        (
            "planar",
            "field.magnetic={ linear = { gradient = [[1.0, 0.2], [0.0, -1.0]] } }",
            "field.magnetic.linear.gradient.1.0",
            "not symmetric",
        ),
        (
            "planar",
            "field.magnetic={ linear = { gradient = [[0.0, 0.0], [0.0, 0.0]] } }",
            "field.magnetic.linear.gradient",
            "are zero",
        ),
        (
            "planar",
            "field.magnetic={ linear = { gradient = [[1.0, 0.0]] } }",
            "field.magnetic.linear.gradient",
            "no matrix",
        ),
        (
            "axisymmetric",
            "field.magnetic={ linear = { gradient = [[1.0, 0.0], [0.0, -1.0]] } }",
            "field.magnetic.linear.gradient.1.1",
            "divergence",
        ),
        (
            "planar",
            "field.magnetic={ dipoles = [{ position = [0.5, 0.0], strength = [1.0, 0.0] }] }",
            "field.magnetic.dipoles.0.position",
            "within it",
        ),
        (
            "planar",
            "field.magnetic={ dipoles = [{ position = [5.0, 0.0], strength = [0.0, 0.0] }] }",
            "field.magnetic.dipoles.0.strength",
            "is zero",
        ),
        (
            "axisymmetric",
            "field.magnetic={ dipoles = [{ position = [5.0, 1.0], strength = [1.0, 0.0] }] }",
            "field.magnetic.dipoles.0.position.1",
            "breaks the symmetry",
        ),
        ("planar", "time={ steady = {} }", "field.magnetic.rotating", "has no time"),
    ] {
        only(geometry, &[setting], error, [key, message]);
    }
}

#[test]
fn what_does_nothing_is_warned_of() {
    let warning = Severity::Warning;
    let moment = "body.0.magnetic_moment";
    only("planar", &["body.0.magnetic_moment=[]"], warning, ["field.magnetic", "no body has"]);
    only("planar", &["body.0.motion='held'"], warning, [moment, "is not free"]);
    only("planar", &["body.0.locked=['rotation']"], warning, [moment, "is locked"]);
    let components = "field.magnetic={ components = [{ constant = 1.0 }, { constant = 0.0 }] }";
    only("axisymmetric", &[components], warning, [moment, "cannot turn"]);
    only(
        "planar",
        &["time.unsteady.step=0.25"],
        warning,
        ["field.magnetic.rotating", "0.125 of a period"],
    );
    let text = "title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.disc.radius = 3.0
boundary = { wall = 'no-slip' }
mesh = { size = 0.5 }
time.unsteady = { step = 0.02, end = 1.0 }
[[body]]
name = 'b'
shape = { disc = { radius = 1.0 } }
center = [0.0, 0.0]
motion = 'free'
magnetic_moment = [1.0, 0.0]
";
    let found = check(&Case::parse("t.toml", text, &[]).unwrap());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].key == moment && found[0].message.contains("no field"), "{found:?}");
    let location = found[0].location.as_ref().map(|location| location.line);
    assert_eq!(location, Some(13), "{found:?}");
}

#[test]
fn the_explicit_scheme_follows_magnets_that_turn_slowly() {
    let scheme = "time.unsteady.scheme=rk3";
    assert_eq!(problems("planar", &[scheme]), []);
    let stiff = "field.magnetic.rotating.strength=1e3";
    only("planar", &[scheme, stiff], Severity::Error, ["time.unsteady.scheme", "rad in a step"]);
    assert_eq!(problems("planar", &[scheme, stiff, "time.unsteady.adaptive={}"]), []);
    assert_eq!(problems("planar", &[stiff]), []);
}

#[test]
fn parts_of_swimmers_have_moments() {
    let chain = |link: &str, own: &str, skin: &str| {
        let text = format!(
            "title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.disc.radius = 3.0
boundary = {{ wall = 'no-slip' }}
mesh = {{ size = 0.5 }}
time.unsteady = {{ step = 0.02, end = 1.0 }}
field.magnetic = {{ rotating = {{ strength = 1.0, frequency = 0.5 }} }}
[[swimmer]]
name = 's'
{own}
[swimmer.kind.chain]
links = [{{ shape = {{ ellipse = {{ semi_axes = [0.3, 0.1] }} }}{link} }}, [0.3, 0.1], [0.3, 0.1]]
gap = 0.2
joints = [{{ bent = {{ angle = {{ constant = 0.0 }} }} }}, {{ bent = {{ angle = {{ constant = 0.1 }} }} }}]
{skin}
"
        );
        let file = Case::parse("t.toml", &text, &[]).unwrap();
        let moments: Vec<Vec<f64>> =
            file.model.bodies.iter().map(|body| body.magnetic_moment.clone()).collect();
        let found = check(&file);
        let errors = found.into_iter().filter(|one| one.severity == Severity::Error);
        (moments, errors.map(|one| one.key).collect::<Vec<_>>())
    };
    let of_link = ", magnetic_moment = [1.0, 0.0]";
    let (moments, errors) = chain(of_link, "", "");
    assert_eq!((moments, errors), (vec![vec![1.0, 0.0], vec![], vec![]], vec![]));
    let (moments, errors) = chain("", "magnetic_moment = [0.0, 2.0]", "");
    assert_eq!((moments, errors), (vec![vec![], vec![0.0, 2.0], vec![]], vec![]));
    let link = "swimmer.0.kind.chain.links.0.magnetic_moment";
    let (_, errors) = chain(", magnetic_moment = [0.0, 0.0]", "", "");
    assert_eq!(errors, [link]);
    let (moments, errors) = chain(of_link, "", "skin = {}");
    assert_eq!((moments, errors), (vec![Vec::<f64>::new()], vec![link.to_owned()]));
    let (moments, errors) = chain("", "magnetic_moment = [0.0, 2.0]", "skin = {}");
    assert_eq!((moments, errors), (vec![vec![0.0, 2.0]], vec![]));
}

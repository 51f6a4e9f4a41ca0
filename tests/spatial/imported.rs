//! Flow in meshes made by Gmsh: Poiseuille flow in the plane and in a tube, and a sphere in a box.

use alewife_core::case::{Case, CaseFile, check};
use alewife_core::run::{RunSummary, simulate};
use tests::figure;

/// A case, its mesh a file of the tests of the mesher where a name is given.
fn case(text: &str, mesh: Option<&str>) -> CaseFile {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../mesh/tests/msh/data");
    let settings = mesh.map(|name| format!("domain.mesh.file={folder}/{name}.msh"));
    let settings: Vec<String> = settings.into_iter().collect();
    let file = Case::parse("t.toml", text, &settings).unwrap_or_else(|error| panic!("{error}"));
    assert!(check(&file).iter().all(|found| found.severity != alewife_core::case::Severity::Error));
    file
}

fn last(run: &RunSummary, name: &str) -> f64 {
    let column = run.series.column(name).expect("the quantity is measured");
    *column.last().expect("there is a row")
}

const POISEUILLE: &str = r#"
title = "t"
fluid = { model = "stokes", viscosity = 1.0 }
boundary = { inlet = { parabolic = { peak = 1.0 } }, outlet = "do-nothing", wall = "no-slip" }
mesh = { size = 0.5 }
time = { steady = {} }
"#;

/// A velocity of second order is found exactly: the pressure falls by 8 mu U / H^2.
#[test]
fn poiseuille_flow_in_a_plane_mesh_is_exact() {
    for mesh in ["square-1-text", "square-2-binary"] {
        let text = format!(
            "{POISEUILLE}geometry = 'planar'\n[[probe]]\nname = 'a'\npoint = [0.5, 0.3]\n\
             minus = [1.5, 0.6]\n"
        );
        let file = case(&text, Some(mesh));
        let run = simulate::<2>(&file.model, &mut []).expect("it is solved");
        assert!((last(&run, "a.pressure") - 8.0).abs() < 1e-9, "{}", last(&run, "a.pressure"));
        assert!(last(&run, "flow.mass_defect").abs() < 1e-12);
    }
}

/// Bent walls follow the tube nearly: the pressure falls by 4 mu U / R^2; straight walls make it
/// narrower.
#[test]
fn poiseuille_flow_in_a_tube_is_nearly_exact_with_bent_walls() {
    let text = format!(
        "{POISEUILLE}geometry = 'spatial'\n[[probe]]\nname = 'a'\npoint = [0.5, 0.1, 0.2]\n\
         minus = [1.5, -0.2, 0.1]\n"
    );
    let error = |mesh: &str| {
        let run = simulate::<3>(&case(&text, Some(mesh)).model, &mut []).expect("it is solved");
        assert!(last(&run, "flow.mass_defect").abs() < 1e-10);
        last(&run, "a.pressure") / 4.0 - 1.0
    };
    let [bent, straight] = ["pipe-2-binary", "pipe-1-binary"].map(error);
    figure!(bent, "bent walls");
    figure!(straight, "straight walls");
    assert!(bent.abs() < 0.03 && straight > 3.0 * bent.abs(), "{bent} {straight}");
}

/// A sphere carried through a tube until it leaves, against the same in a tube of the mesher.
#[test]
fn a_sphere_leaves_a_given_tube_as_it_leaves_a_tube() {
    let carried = r#"
title = "t"
geometry = "spatial"
fluid = { model = "stokes", viscosity = 1.0 }
mesh = { size = 0.5, surface = 0.15, growth = 0.6, gap_layers = 1 }
time.unsteady = { step = 0.1, end = 3.0, until = { one-leaves = 0.25 } }
[[body]]
name = "sphere"
shape.sphere.radius = 0.25
center = [0.6, 0.5, 0.1]
motion = "free"
"#;
    let inlet = "{ parabolic = { peak = 1.0 } }, wall = 'no-slip'";
    let given = format!("boundary = {{ inlet = {inlet}, outlet = 'do-nothing' }}\n{carried}");
    let given = simulate::<3>(&case(&given, Some("pipe-2-binary")).model, &mut []);
    let built = format!(
        "boundary = {{ left = {inlet}, right = 'do-nothing' }}\n\
         domain.cylinder = {{ x = [0.0, 2.0], radius = 1.0 }}\n{carried}"
    );
    let built = simulate::<3>(&case(&built, None).model, &mut []);
    let runs = [given, built].map(|run| run.expect("the case runs"));
    for (run, domain) in runs.iter().zip(["given", "built"]) {
        // It has come by 0.25 and its radius near to the end of the tube, and not a step before
        let x = run.series.column("sphere.x").expect("it is measured");
        assert!(x[x.len() - 1] > 1.5 && x[x.len() - 2] < 1.5, "{x:?}");
        assert_eq!(run.steps + 1, x.len());
        assert!(last(run, "flow.remeshes") >= 1.0 && last(run, "flow.minimum_gap") > 0.1);
        // Of pi / 2 that enters: the mesh is moved to where the flow leads after that is solved, within 1e-3 of an edge
        // (factors and iterations alike; 1e-17 where the sphere is held)
        let defect = last(run, "flow.mass_defect");
        figure!(defect, "{domain}: mass defect");
        assert!(defect.abs() < 2e-6, "{defect}");
    }
    // Both meshes are coarse; the one that is given has bent edges of a third of the radius
    let [given, built] = runs;
    assert_eq!(given.steps, built.steps);
    for (name, tolerance) in [("sphere.x", 5e-3), ("sphere.y", 5e-3), ("sphere.velocity.x", 2e-2)] {
        let [one, other] = [&given, &built].map(|run| last(run, name));
        figure!(one - other, "{name}: carried");
        assert!((one - other).abs() < tolerance, "{name}: {one} {other}");
    }
}

/// A sphere in a box that is given, against the same in a box of the mesher.
#[test]
fn a_sphere_in_a_given_box_has_the_resistance_of_one_in_a_box() {
    let sphere = r#"
title = "t"
geometry = "spatial"
fluid = { model = "stokes", viscosity = 1.0 }
mesh = { size = 0.5, surface = 0.08, growth = 0.4, gap_layers = 2 }
time = { steady = {} }
[[body]]
name = "sphere"
shape.sphere.radius = 0.3
center = [0.1, -0.1, 0.05]
motion = { imposed = { velocity = [1.0, 0.5, 0.0] } }
"#;
    let given = format!("{sphere}[boundary]\nwall = 'no-slip'\n");
    let given = simulate::<3>(&case(&given, Some("box-1-text")).model, &mut []).expect("is solved");
    let sides = ["left", "right", "bottom", "top", "back", "front"];
    let sides: String = sides.iter().map(|side| format!("{side} = 'no-slip'\n")).collect();
    let built = format!(
        "{sphere}[domain.box]\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\n[boundary]\n{sides}"
    );
    let built = simulate::<3>(&case(&built, None).model, &mut []).expect("is solved");
    for name in ["sphere.force.x", "sphere.force.y"] {
        let [one, other] = [&given, &built].map(|run| last(run, name));
        figure!(one / other - 1.0, "{name}: resistance");
        assert!((one / other - 1.0).abs() < 2e-3, "{name}: {one} {other}");
    }
}

//! Bodies that a given mesh in space leaves out: loads of the side around them, and a fall as in our own mesh.

use alewife_core::case::Model;
use alewife_core::run::{RunSummary, simulate};
use tests::cases::{case, last};
use tests::figure;
use tests::given::in_mesh_of;

fn run(model: &Model) -> RunSummary {
    simulate::<3>(model, &mut []).expect("it is solved")
}

/// A case of a sphere in a box that is driven through, or falls.
fn text(size: f64, rest: &str) -> String {
    format!(
        r#"
        title = "sphere in a box"
        geometry = "spatial"
        mesh = {{ size = {}, surface = {size} }}
        {rest}
        "#,
        3.0 * size
    )
}

const BOX: &str = "domain.box = { min = [-1.0, -1.0, -1.0], max = [1.5, 1.0, 1.0] }\n";

#[test]
fn a_hole_in_space_as_a_body_has_the_force_of_its_side() {
    let rest = r#"
        fluid = { model = "stokes", viscosity = 0.7 }
        time.steady = { tolerance = 1e-12 }
        [boundary]
        left.velocity.value = [1.0, 0.0, 0.2]
        right = "do-nothing"
        bottom = "symmetry"
        top = "no-slip"
        back = "symmetry"
        front = "no-slip"
        "#;
    let sphere = "[[body]]\nname = \"sphere\"\nshape.sphere.radius = 0.4\ncenter = [0.1, 0.0, 0.1]\nmotion = \"held\"\n";
    let own = case(&text(0.3, &format!("{BOX}{rest}{sphere}")));
    let side =
        in_mesh_of::<3>("solid-side", &own, &text(0.3, &format!("{rest}sphere = \"no-slip\"\n")));
    let body = "[[body]]\nname = \"ball\"\nshape.side = \"sphere\"\nmotion = \"held\"\n";
    let body = in_mesh_of::<3>("solid-body", &own, &text(0.3, &format!("{rest}{body}")));
    let center = &body.bodies[0].center;
    assert!((center[0] - 0.1).abs() < 1e-3 && center[1].abs() < 1e-3, "{center:?}");
    let [side, body] = [run(&side), run(&body)];
    for axis in ["x", "z"] {
        let side = last(&side, &format!("sphere.force.{axis}"));
        let body = last(&body, &format!("ball.force.{axis}"));
        figure!(side / body - 1.0, "force.{axis}");
        assert!((side / body - 1.0).abs() < 1e-8, "{axis}: {side} {body}");
    }
}

/// On the same cells as its own mesh a sphere falls as it does there.
#[test]
fn a_free_hole_in_space_falls_as_the_sphere_of_our_own_mesh() {
    let rest = r#"
        fluid = { model = "navier-stokes", viscosity = 0.3, density = 1.0, gravity = [0.3, -1.0, 0.0] }
        time.unsteady = { step = 0.1, end = 0.2 }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }
        "#;
    let body = "[[body]]\nname = \"b\"\ndensity = 2.0\nmotion = \"free\"\n";
    let difference = |size: f64| {
        let sphere = "shape.sphere.radius = 0.4\ncenter = [0.1, 0.0, 0.1]\n";
        let own = case(&text(size, &format!("{rest}{BOX}{body}{sphere}")));
        let given = format!("{rest}{body}shape.side = \"b\"\n");
        let given = in_mesh_of::<3>(&format!("solid-falls-{size}"), &own, &text(size, &given));
        let [own, given] = [run(&own), run(&given)];
        let apart = ["velocity.x", "velocity.y", "y"].map(|quantity| {
            let [own, given] = [&own, &given].map(|run| last(run, &format!("b.{quantity}")));
            (own - given).abs() / own.abs()
        });
        apart.into_iter().fold(0.0, f64::max)
    };
    let coarse = difference(0.4);
    figure!(coarse, "coarse");
    assert!(coarse < 1e-2, "{coarse:.3e}");
}

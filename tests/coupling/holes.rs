//! Bodies that a given mesh leaves out: loads of the side around them, and motions as in our own mesh.

use alewife_core::case::Case;
use alewife_core::run::simulate;
use tests::cases::{case, column, last, run};
use tests::figure;
use tests::given::in_mesh_of;

/// The flow of DFG 2D-1 in a mesh of a file, the cylinder one of its sides or a body.
#[test]
fn a_hole_as_a_body_has_the_force_of_its_side() {
    let settings = ["mesh.scale=2.0", "reference=[]"].map(str::to_owned);
    let own = Case::read("dfg-2d-1", &settings).expect("it is shipped").model;
    let text = r#"
        title = "given"
        geometry = "planar"
        fluid = { model = "navier-stokes", viscosity = 1e-3, density = 1.0 }
        mesh.size = 0.1
        time.steady.tolerance = 1e-12
        [boundary]
        left.parabolic.peak = 0.3
        right = "do-nothing"
        bottom = "no-slip"
        top = "no-slip"
        "#;
    let side = in_mesh_of::<2>("side", &own, &format!("{text}cylinder = \"no-slip\"\n"));
    let body = "[[body]]\nname = \"post\"\nshape.side = \"cylinder\"\nmotion = \"held\"\n";
    let body = in_mesh_of::<2>("body", &own, &format!("{text}{body}"));
    assert!((body.bodies[0].center[0] - 0.2).abs() < 1e-9);
    let [side, body] = [run(&side), run(&body)];
    for axis in ["x", "y"] {
        let side = last(&side, &format!("cylinder.force.{axis}"));
        let body = last(&body, &format!("post.force.{axis}"));
        assert!((side / body - 1.0).abs() < 1e-10, "{axis}: {side} {body}");
    }
    let coefficient = last(&body, "post.force.x") * 2.0 / (0.04 * 0.1);
    figure!(coefficient, "drag");
    assert!((coefficient / 5.579_535_232_84 - 1.0).abs() < 1e-4, "{coefficient}");
}

/// A disc or an ellipse that falls, in our own mesh or as the hole of one from a file.
fn falling(shape: &str, size: f64) -> [String; 2] {
    let [domain, sides] = [
        "domain.box = { min = [-2.0, -3.0], max = [2.0, 2.0] }",
        r#"boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }"#,
    ];
    let rest = format!(
        r#"
        title = "falling"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", viscosity = 0.1, density = 1.0, gravity = [0.3, -1.0] }}
        {sides}
        mesh = {{ size = {}, surface = {size} }}
        time.unsteady = {{ step = 0.05, end = 0.5 }}
        "#,
        4.0 * size
    );
    let body = "[[body]]\nname = \"b\"\nmotion = \"free\"\ndensity = 2.0\n";
    let own = format!("{rest}{domain}\n{body}shape.{shape}\ncenter = [0.2, 0.1]\nangle = 0.3\n");
    [own, format!("{rest}{body}shape.side = \"b\"\n")]
}

/// On the same cells it moves as with its exact shape, but for the mass that the quadratic edges leave out.
#[test]
fn a_free_hole_falls_as_the_body_of_our_own_mesh() {
    let difference = |size: f64| {
        let [own, given] = falling("ellipse.semi_axes = [0.5, 0.3]", size);
        let own = case(&own);
        let given = in_mesh_of::<2>(&format!("falls-{size}"), &own, &given);
        let [own, given] = [run(&own), run(&given)];
        let quantities = ["x", "y", "velocity.y", "angular_velocity"];
        let apart = quantities.map(|quantity| {
            let [own, given] = [&own, &given].map(|run| {
                let all = column(run, &format!("b.{quantity}"));
                (all[all.len() - 1], all.iter().map(|x| x.abs()).fold(0.0, f64::max))
            });
            (own.0 - given.0).abs() / own.1
        });
        apart.into_iter().fold(0.0, f64::max)
    };
    let [coarse, fine] = [difference(0.15), difference(0.075)];
    figure!(coarse, "coarse");
    figure!(fine, "fine");
    assert!(coarse < 1e-3 && fine < coarse / 4.0, "{coarse:.3e} {fine:.3e}");
}

/// A mesh from a file is moved, not made again: where it is worn the run stops, and says so.
#[test]
fn a_run_that_wears_a_given_mesh_stops_with_the_way_out() {
    let [own, given] = falling("disc.radius = 0.4", 0.15);
    let imposed = r#"motion = { imposed = { velocity = [0.4, -4.6], angular_velocity = 8.0 } }"#;
    let given = given.replace("motion = \"free\"", imposed).replace("density = 2.0\n", "");
    let given = in_mesh_of::<2>("worn", &case(&own), &given);
    let error = simulate::<2>(&given, &mut []).expect_err("the mesh is worn").to_string();
    assert!(error.contains("not made again") && error.contains("mesh.moving.quality"), "{error}");
    // As far as its cells go it is imposed on the fluid
    let near = falling("disc.radius = 0.4", 0.15)[1].replace("density = 2.0\n", "");
    let near =
        near.replace("motion = \"free\"", &imposed.replace("-4.6", "-0.3").replace("8.0", "0.5"));
    let near = run(&in_mesh_of::<2>("near", &case(&own), &near));
    let y = column(&near, "b.y");
    assert!((y[y.len() - 1] - (0.1 - 0.15)).abs() < 1e-6, "{y:?}");
}

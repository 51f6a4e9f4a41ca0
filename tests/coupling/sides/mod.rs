//! Loads and fluxes of sides against exact flows, against bodies, and by conservation.

mod backflow;

use alewife_core::case::Case;
use alewife_core::run::{RunSummary, simulate};
use tests::cases::{case, last, run};
use tests::given::in_mesh_of;

/// Sum of a quantity over owners.
fn sum(outcome: &RunSummary, owners: &[&str], quantity: &str) -> f64 {
    owners.iter().map(|owner| last(outcome, &format!("{owner}.{quantity}"))).sum()
}

fn largest(outcome: &RunSummary, owners: &[&str], quantity: &str) -> f64 {
    owners
        .iter()
        .map(|owner| last(outcome, &format!("{owner}.{quantity}")).abs())
        .fold(0.0, f64::max)
}

const BOX: [&str; 4] = ["left", "right", "bottom", "top"];

/// The velocity 4 y (1 - y) is in the space of the elements: what the pressure pushes is what the walls hold.
#[test]
fn walls_hold_what_the_pressure_of_a_channel_pushes() {
    let (length, viscosity) = (3.0, 0.7);
    for outflow in ["do-nothing", "traction-free"] {
        let outcome = run(&case(&format!(
            r#"
            title = "channel"
            geometry = "planar"
            fluid = {{ model = "navier-stokes", viscosity = {viscosity}, density = 1.3 }}
            domain.channel = {{ length = {length}, height = 1.0 }}
            boundary = {{ left.parabolic.peak = 1.0, right = "{outflow}", bottom = "no-slip", top = "no-slip" }}
            mesh = {{ size = 0.3 }}
            time.steady = {{ tolerance = 1e-12 }}
            "#
        )));
        assert!((last(&outcome, "left.flux") - 2.0 / 3.0).abs() < 1e-12);
        let net = sum(&outcome, &BOX, "flux");
        assert!((net + last(&outcome, "flow.mass_defect")).abs() < 1e-13, "{net}");
        if outflow == "traction-free" {
            continue;
        }
        assert!((last(&outcome, "right.flux") + 2.0 / 3.0).abs() < 1e-10);
        for wall in ["top", "bottom"] {
            let shear = last(&outcome, &format!("{wall}.force.x"));
            assert!((shear - 4.0 * viscosity * length).abs() < 1e-8, "{wall}: {shear}");
            let traction = last(&outcome, &format!("{wall}.mean_traction.x"));
            assert!((traction - 4.0 * viscosity).abs() < 1e-8, "{wall}: {traction}");
            let pressure = last(&outcome, &format!("{wall}.mean_pressure"));
            assert!((pressure - 4.0 * viscosity * length).abs() < 1e-8, "{wall}: {pressure}");
        }
        let drop = 8.0 * viscosity * length;
        assert!((last(&outcome, "left.force.x") + drop).abs() < 1e-8);
        assert!((last(&outcome, "left.mean_pressure") - drop).abs() < 1e-8);
        assert!(last(&outcome, "right.force.x").abs() < 1e-8);
        // By the lines of action of these forces
        let torque = [sum(&outcome, &BOX, "torque"), largest(&outcome, &BOX, "torque")];
        assert!(torque[0].abs() < 1e-8 && torque[1] > 10.0, "{torque:?}");
    }
}

/// Poiseuille flow in the half plane of a tube: force 4 pi mu U L on the wall, flux pi R^2 U / 2.
#[test]
fn the_wall_of_a_tube_holds_its_pressure() {
    let outcome = run(&case(
        r#"
        title = "tube"
        geometry = "axisymmetric"
        fluid = { model = "stokes", viscosity = 0.5 }
        domain.cylinder = { x = [0.0, 2.0], radius = 1.0 }
        boundary = { left.parabolic.peak = 3.0, right = "do-nothing", wall = "no-slip" }
        mesh = { size = 0.3 }
        time.steady = {}
        "#,
    ));
    let pi = std::f64::consts::PI;
    assert!((last(&outcome, "wall.force.x") / (4.0 * pi * 0.5 * 3.0 * 2.0) - 1.0).abs() < 1e-9);
    assert!((last(&outcome, "left.flux") / (0.5 * pi * 3.0) - 1.0).abs() < 1e-9);
    let sides = ["left", "right", "wall"];
    let [force, all] = [sum, largest].map(|of| of(&outcome, &sides, "force.x"));
    assert!(force.abs() < 1e-10 * all, "{force} of {all}");
    assert!(sum(&outcome, &sides, "flux").abs() < 1e-10);
}

/// Without inertia nothing is left of all forces and torques, whatever the mesh.
#[test]
fn loads_of_sides_and_bodies_balance_in_the_plane() {
    for sides in [
        r#"left.velocity.value = [1.0, 0.3], right = "do-nothing", bottom = "symmetry", top = "no-slip""#,
        r#"left = "traction-free", right = "no-slip", bottom.shear.rate = 1.0, top = "do-nothing""#,
        r#"left = "symmetry", right = "do-nothing", bottom = "symmetry", top.velocity.value = [0.2, -1.0]"#,
    ] {
        for motion in
            [r#""free""#, "{ imposed = { velocity = [0.3, 0.5], angular_velocity = 2.0 } }"]
        {
            let outcome = run(&case(&format!(
                r#"
                title = "disc in a box"
                geometry = "planar"
                fluid = {{ model = "stokes", viscosity = 0.7 }}
                domain.box = {{ min = [-1.0, -1.2], max = [2.0, 1.0] }}
                boundary = {{ {sides} }}
                mesh = {{ size = 0.4, surface = 0.1 }}
                output.sides = true
                time.steady = {{}}
                [[body]]
                name = "disc"
                shape.disc.radius = 0.3
                center = [0.1, 0.2]
                motion = {motion}
                "#
            )));
            let owners = ["left", "right", "bottom", "top", "disc"];
            for quantity in ["force.x", "force.y"] {
                let [net, all] = [sum, largest].map(|of| of(&outcome, &owners, quantity));
                assert!(net.abs() < 1e-10 * all, "{sides}: {net} of {all}");
            }
            let arm = 0.1 * last(&outcome, "disc.force.y") - 0.2 * last(&outcome, "disc.force.x");
            let net = sum(&outcome, &owners, "torque") + arm;
            let all = largest(&outcome, &owners, "torque");
            assert!(net.abs() < 1e-9 * all, "{sides}: torque {net} of {all}");
            let flux = sum(&outcome, &BOX, "flux");
            assert!(flux.abs() < 1e-9, "{sides}: {flux}");
        }
    }
}

/// The same in space, where edges and corners are shared, too.
#[test]
fn loads_of_sides_and_bodies_balance_in_space() {
    let outcome = simulate::<3>(
        &case(
            r#"
            title = "sphere in a box"
            geometry = "spatial"
            fluid = { model = "stokes", viscosity = 0.7 }
            domain.box = { min = [-1.0, -1.0, -1.0], max = [1.5, 1.0, 1.0] }
            mesh = { size = 0.8, surface = 0.4 }
            output.sides = true
            time.steady = {}
            [boundary]
            left.velocity.value = [1.0, 0.0, 0.2]
            right = "do-nothing"
            bottom = "symmetry"
            top = "no-slip"
            back = "symmetry"
            front = "traction-free"
            [[body]]
            name = "sphere"
            shape.sphere.radius = 0.4
            center = [0.1, 0.0, 0.1]
            motion = "held"
            "#,
        ),
        &mut [],
    )
    .expect("it is solved");
    let sides = ["left", "right", "bottom", "top", "back", "front"];
    let owners = [&sides[..], &["sphere"]].concat();
    for axis in ["x", "y", "z"] {
        let [net, all] = [sum, largest].map(|of| of(&outcome, &owners, &format!("force.{axis}")));
        assert!(net.abs() < 1e-7 * all, "{axis}: {net} of {all}");
    }
    let flux = sum(&outcome, &sides, "flux") + last(&outcome, "flow.mass_defect");
    assert!(flux.abs() < 1e-12, "{flux}");
}

/// Only what is asked for is reported of cases with bodies; periodic sides have no loads.
#[test]
fn sides_are_reported_where_they_are_asked_for() {
    let text = |more: &str| {
        format!(
            r#"
            title = "disc"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.box = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}
            boundary = {{ left.periodic = "right", bottom = "no-slip", top = "no-slip" }}
            mesh = {{ size = 0.5 }}
            time.steady = {{}}
            {more}
            "#
        )
    };
    let names = |more: &str| alewife_core::case::known_quantities(&case(&text(more)));
    let has = |names: &[String], name: &str| names.iter().any(|one| one == name);
    let plain = names("");
    assert!(has(&plain, "top.force.x") && !has(&plain, "left.flux") && !has(&plain, "right.flux"));
    let disc = "[[body]]\nname = \"disc\"\nshape.disc.radius = 0.2\ncenter = [0.0, 0.0]\nmotion = \"free\"\n";
    assert!(!has(&names(disc), "top.force.x"));
    assert!(has(&names(&format!("output.sides = true\n{disc}")), "top.force.x"));
    let reference = "[[reference]]\nquantity = \"top.flux\"\nvalue = 0.0\nabsolute = 1e-9\nkind = \"property\"\nsource = \"no flow through a wall\"\n";
    let named = names(&format!("{disc}{reference}"));
    assert!(has(&named, "top.force.x") && !has(&named, "bottom.force.x"));
}

/// A hole of a given mesh has the drag of a body (DFG 2D-1): on the same mesh to rounding.
#[test]
fn a_hole_of_a_given_mesh_has_the_drag_of_a_body() {
    let settings = ["mesh.scale=2.0", "time.steady.tolerance=1e-11", "reference=[]"];
    let settings = settings.map(str::to_owned);
    let body = Case::read("dfg-2d-1", &settings).expect("it is shipped").model;
    let text = r#"
        title = "given"
        geometry = "planar"
        fluid = { model = "navier-stokes", viscosity = 1e-3, density = 1.0 }
        mesh.size = 0.1
        time.steady.tolerance = 1e-11
        [boundary]
        left.parabolic.peak = 0.3
        right = "do-nothing"
        bottom = "no-slip"
        top = "no-slip"
        cylinder = "no-slip"
        "#;
    let hole = run(&in_mesh_of::<2>("hole", &body, text));
    let body = run(&body);
    for quantity in ["force.x", "force.y"] {
        let name = format!("cylinder.{quantity}");
        let (hole, body) = (last(&hole, &name), last(&body, &name));
        assert!((hole / body - 1.0).abs() < 1e-8, "{name}: {hole} {body}");
    }
    let coefficient = last(&hole, "cylinder.force.x") * 2.0 / (0.04 * 0.1);
    assert!((coefficient / 5.579_535_232_84 - 1.0).abs() < 1e-4, "{coefficient}");
}

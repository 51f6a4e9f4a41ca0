//! Wrong fluids, sides of the domain, shapes and probes.

use super::{assert_accepted, assert_refused, check, edited, refused, without_variant};

#[test]
fn a_negative_viscosity_is_refused() {
    refused(
        "viscosity = 0.001",
        "viscosity = -0.001",
        &["`fluid.viscosity` is -0.001, but must be positive", "wrong.toml:6:13", "larger than 0"],
    );
    refused("viscosity = 0.001", "viscosity = nan", &["not a finite number", "wrong.toml:6:13"]);
}

#[test]
fn inertia_needs_a_density() {
    refused("density = 1.0\n", "", &["the fluid has no density", "wrong.toml:4:", "add `density"]);
}

#[test]
fn an_unknown_side_is_refused_and_a_side_without_condition_too() {
    refused(
        "top = \"no-slip\"",
        "topp = \"no-slip\"",
        &[
            "this domain has no side `topp`",
            "wrong.toml:17:8",
            "did you mean `top`? accepted: left",
            "nothing is said about the side `top`",
        ],
    );
    refused(
        "surface = 0.02",
        "surface = 0.02\nsides = { wall = 0.1 }",
        &["no side `wall`", "wrong.toml:28:18", "accepted: left, right, bottom, top"],
    );
}

#[test]
fn inflow_without_outflow_is_refused_with_its_flux() {
    // 2/3 of 0.3 times 0.41.
    refused(
        "right = \"do-nothing\"",
        "right = \"no-slip\"",
        &["net inflow 0.082000 m2/s", "wrong.toml:13:", "do-nothing"],
    );
    let balanced = edited("right = \"do-nothing\"", "right = { parabolic = { peak = 0.3 } }");
    assert_accepted(&check(without_variant(&balanced), &[]));
}

#[test]
fn conditions_that_cannot_hold_on_a_side_are_refused() {
    refused("top = \"no-slip\"", "top = \"axis\"", &["wrong.toml:17:7", "symmetry"]);
    refused(
        "top = \"no-slip\"",
        "top = { periodic = \"left\" }",
        &["`top` cannot be periodic with `left`", "top = { periodic = \"bottom\" }"],
    );
    refused(
        "top = \"no-slip\"",
        "top = { periodic = \"bottom\" }",
        &["`bottom` has another condition", "wrong.toml:16:10"],
    );
    refused(
        "top = \"no-slip\"",
        "top = { parabolic = { peak = 1.0 } }",
        &["enters through `left` or `right`", "wrong.toml:17:"],
    );
}

#[test]
fn a_periodic_partner_may_be_left_out() {
    let sides = "left = { parabolic = { peak = 0.3 } }\nright = \"do-nothing\"";
    let text = edited(sides, "left = { periodic = \"right\" }");
    assert_accepted(&check(without_variant(&text), &[]));
}

#[test]
fn a_vector_of_the_wrong_length_is_refused() {
    refused(
        "center = [0.2, 0.2]",
        "center = [0.2, 0.2, 0.0]",
        &[
            "`body.0.center` has 3 numbers, but this case has 2 dimensions",
            "wrong.toml:22:10",
            "write [x, y]",
        ],
    );
    refused(
        "minus = [0.25, 0.2]",
        "minus = [0.25]",
        &["`probe.0.minus` has 1 number,", "wrong.toml:41:9"],
    );
}

#[test]
fn probes_are_in_the_fluid_or_on_its_boundary() {
    let outside = ["outside the domain", "wrong.toml:40:9"];
    refused("point = [0.15, 0.2]", "point = [0.15, 0.6]", &outside);
    refused("point = [0.15, 0.2]", "point = [0.17, 0.2]", &["inside the body \"disc\""]);
}

#[test]
fn shapes_fit_the_geometry() {
    refused(
        "{ disc = { radius = 0.05 } }",
        "{ sphere = { radius = 0.05 } }",
        &["a sphere cannot stand", "wrong.toml:21:9", "disc, ellipse, spline"],
    );
    refused("geometry = \"planar\"", "geometry = \"axisymmetric\"", &["half-disc, cylinder"]);
}

#[test]
fn a_sheet_waves_on_the_bottom_of_a_periodic_box_and_alone() {
    let sheet = |wavelength: &str, more: &str| {
        let text = format!(
            r#"
            title = "a sheet"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.box = {{ min = [0.0, 0.0], max = [2.0, 3.0] }}
            mesh = {{ size = 0.2 }}
            [boundary]
            left.periodic = "right"
            top = "symmetry"
            [boundary.bottom.waving-sheet]
            amplitude = 0.05
            wavelength = {wavelength}
            period = 1.0
            {more}
            "#
        );
        check(&text, &[])
    };
    let time = "[time.unsteady]\nstep = 0.1\nend = 1.0";
    assert_accepted(&sheet("1.0", time));
    assert_refused(&sheet("1.5", time), &["1.333333 wavelengths fit", "divides the length"]);
    assert_refused(&sheet("0.5", time), &["cannot follow a sheet of amplitude 0.05"]);
    assert_refused(&sheet("1.0", "[time.steady]"), &["the solution is steady"]);
    refused(
        "bottom = \"no-slip\"",
        "bottom.waving-sheet = { amplitude = 0.01, wavelength = 1.0, period = 1.0 }",
        &["the bottom of a box that is periodic along x"],
    );
}

#[test]
fn sizes_that_ask_for_too_many_cells_are_refused_before_the_mesh_is_made() {
    let asks = "cells, more than 5e6";
    refused(
        "surface = 0.02",
        "surface = 1e-9",
        &["`mesh.surface` is 1e-9", asks, "wrong.toml:27:11", "write 7"],
    );
    refused(
        "size = 0.1",
        "size = 1e-6",
        &["`mesh.size` is 1e-6", asks, "wrong.toml:26:8", "write 6.5e-4"],
    );
    refused(
        "length = 2.2",
        "length = 4e6",
        &["`mesh.size` is 1e-1", asks, "make the domain smaller"],
    );
    let refined = "[[mesh.box]]\nmin = [0.0, 0.0]\nmax = [1.0, 0.4]\nsize = 1e-6\n\n[time.steady]";
    refused("[time.steady]", refined, &["`mesh.box.0.size` is 1e-6", asks, "wrong.toml:32:8"]);
    refused("surface = 0.02", "sides.top = 1e-12", &["`mesh.sides.top` is 1e-12", asks]);
    refused(
        "surface = 0.02",
        "surface = 0.02\nscale = 1e-6",
        &["with `mesh.scale` = 1e-6, `mesh.size` = 1e-1 asks", asks],
    );
    refused(
        "surface = 0.02",
        "gap_layers = 1e6",
        &["gaps would get 1000000 layers", "4 are usual"],
    );
    // What only all sizes together ask for is found before the mesh is made, too
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(
        directory.path().join("wrong.toml"),
        edited("surface = 0.02", "gap_layers = 150"),
    )
    .unwrap();
    let said = super::alewife(directory.path(), &["check", "wrong.toml"]);
    assert_refused(&said, &["the cell sizes ask for", "times as large would fit"]);
}

/// A cell of a periodic array, with a disc.
fn cell(flow: &str, sides: &str, motion: &str) -> String {
    format!(
        r#"
        title = "a cell of an array"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        {flow}
        domain.box = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}
        mesh.size = 0.2
        time.steady = {{}}
        boundary = {{ left.periodic = "right", right.periodic = "left", {sides} }}
        [[body]]
        name = "disc"
        shape.disc.radius = 0.3
        center = [0.0, 0.0]
        motion = "{motion}"
        "#
    )
}

#[test]
fn a_periodic_box_without_walls_needs_a_mean_flow_where_a_body_is_held() {
    let [periodic, walls] = [
        "bottom.periodic = \"top\", top.periodic = \"bottom\"",
        "bottom = \"no-slip\", top = \"no-slip\"",
    ];
    let mean = "flow.mean_velocity = [1.0, 0.0]";
    for (flow, sides, motion, told) in [
        ("", periodic, "held", "nothing determines the mean flow along x"),
        ("flow = {}", walls, "held", "`flow` drives nothing"),
        ("flow.pressure_gradient = [1.0, 0.0]", periodic, "free", "nothing resists the flow"),
        ("flow.mean_velocity = [1.0, 2.0]", walls, "held", "2 along y, where the domain is not"),
        ("flow.mean_velocity = [1.0]", walls, "held", "has 1 number"),
        (
            "flow = { mean_velocity = [1.0, 0.0], pressure_gradient = [1.0, 0.0] }",
            walls,
            "held",
            "one follows from the other",
        ),
    ] {
        assert_refused(&check(&cell(flow, sides, motion), &[]), &[told]);
    }
    for (flow, sides, motion) in [
        ("", periodic, "free"),
        ("", walls, "held"),
        (mean, periodic, "held"),
        (mean, periodic, "free"),
        (mean, walls, "free"),
        ("flow.pressure_gradient = [-1.0, 0.0]", walls, "free"),
    ] {
        assert_accepted(&check(&cell(flow, sides, motion), &[]));
    }
}

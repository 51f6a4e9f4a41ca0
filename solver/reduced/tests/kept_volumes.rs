//! Soft cases whose bodies keep their volume: motions, gradients by key, files, and what is refused.

use std::fs;

use alewife_case::soft::search::{ObjectiveSpec, Parameter};
use alewife_case::soft::{SoftFile, check};
use alewife_mesh::Point;
use alewife_reduced::search::Sought as _;
use alewife_reduced::tier::{Kind, Model, Seeker, Sought, write_fields};
use tempfile::TempDir;

use crate::given;

/// A bar of two materials that keep their volume, and one that does not.
const BAR: &str = r#"
title = "a bar that keeps its volume"
geometry = "planar"

[[solid]]
name = "bar"
grid = { from = [0.0, -0.01], to = [0.12, 0.01], cells = [12, 2] }
material = { young = 4e4, poisson = 0.5, density = 1000.0, viscosity = 5.0 }

[[solid.part]]
region = { from = [0.04, -inf], to = [0.08, inf] }
material = { law = "corotated", young = 8e4, poisson = 0.5, density = 1000.0 }

[[solid.part]]
region = { from = [0.08, -inf], to = [inf, inf] }
material = { young = 4e4, poisson = 0.3, density = 1000.0 }

[[solid.fibre]]
name = "above"
region = { from = [-inf, 0.0], to = [inf, inf] }
direction = [1.0, 0.0]
stiffness = 5e4
stretch.wave = { mean = 0.95, amplitude = 0.04, frequency = 3.0 }

[[solid.hold]]
region = { from = [0.0, -inf], to = [0.0, inf] }

[soft]
frame = 0.02
frames = 6
scheme = "bdf2"
tolerance = 1e-12

[loads]
density = 1000.0
drag.bezier = [0.05, 0.05, 1.85, 2.05]
thrust.bezier = [-0.8, -0.5, 0.1, 2.5]

[[marker]]
name = "tip"
at = [0.12, 0.0]

[optimisation.objective.travel]
direction = [0.0, 1.0]
cost_of_work = 0.01

[[optimisation.parameter]]
name = "amplitude"
keys = ["solid.0.fibre.0.stretch.wave.amplitude"]
bounds = [0.001, 0.05]
scale = 0.01

[robot.set]
"solid.0.material.young" = 6e4
"#;

fn read(text: &str) -> SoftFile {
    given::read(text).expect("it is a soft case")
}

#[test]
fn a_bar_of_several_materials_keeps_the_volumes_it_should() {
    let model = Model::<2>::new(&read(BAR)).expect("it is a body");
    let motion = model.body.simulate(&model.plan).expect("it moves");
    let solid = &model.body.solid;
    let spec = solid.spec();
    let end = motion.levels.last().expect("it has levels");
    let ratios = solid.volume_ratios(&end.places);
    let centre = |cell: usize| {
        spec.mesh.cells[6 * cell..6 * cell + 3].iter().map(|n| spec.mesh.nodes[*n][0]).sum::<f64>()
            / 3.0
    };
    for (from, to, is_kept) in [(0.0, 0.04, true), (0.04, 0.08, true), (0.08, 0.12, false)] {
        let own: Vec<f64> = (0..ratios.len())
            .filter(|cell| from < centre(*cell) && centre(*cell) < to)
            .map(|cell| ratios[cell] - 1.0)
            .collect();
        let mean = own.iter().sum::<f64>() / own.len() as f64;
        println!("{from} to {to}: {mean:+.1e}, {own:.1?}");
        assert_eq!(mean.abs() < 1e-11, is_kept, "{mean}");
    }
    // The pressure jumps between materials: vertices there have two
    let nodes = solid.pressure_nodes();
    let beside = nodes.iter().filter(|node| (spec.mesh.nodes[**node][0] - 0.04).abs() < 1e-9);
    assert_eq!(beside.count(), 6);
    let out = TempDir::new().expect("there is room");
    write_fields(out.path(), &model, &motion).expect("it is written");
    let bytes = fs::read(out.path().join("fields/frame-0006.vtu")).expect("it is there");
    assert!(String::from_utf8_lossy(&bytes).contains("\"pressure\""));
}

/// Where all nodes of a cell are held, nothing determines pressures in it, and they move nothing.
#[test]
fn cells_that_are_held_as_a_whole_are_as_if_they_were_not_there() {
    let hold = "region = { from = [-inf, -inf], to = [0.02, inf] }";
    let held = BAR.replace("region = { from = [0.0, -inf], to = [0.0, inf] }", hold);
    let cut = held.replace(
        "from = [0.0, -0.01], to = [0.12, 0.01], cells = [12, 2]",
        "from = [0.02, -0.01], to = [0.12, 0.01], cells = [10, 2]",
    );
    assert!(held != BAR && cut != held);
    let tip = |text: &str| {
        let model = Model::<2>::new(&read(text)).expect("it is a body");
        let motion = model.body.simulate(&model.plan).expect("it moves");
        let nodes = &model.body.solid.spec().mesh.nodes;
        let is_tip = |node: &Point<2>| (node - Point::<2>::new(0.12, 0.0)).norm() < 1e-9;
        let tip = nodes.iter().position(is_tip).expect("there is one");
        let places = &motion.levels.last().expect("it has levels").places;
        Point::<2>::new(places[2 * tip], places[2 * tip + 1])
    };
    let [held, cut] = [&held, &cut].map(|text| tip(text));
    assert!((cut - Point::<2>::new(0.12, 0.0)).norm() > 1e-4, "{cut}");
    assert!((held - cut).norm() < 1e-9, "{held} {cut}");
}

#[test]
fn derivatives_by_keys_are_those_of_differences() {
    let keys = [
        ("solid.0.material.young", 1e4),
        ("solid.0.part.0.material.young", 1e4),
        ("solid.0.part.1.material.poisson", 0.1),
        ("solid.0.fibre.0.stiffness", 1e5),
        ("solid.0.fibre.0.stretch.wave.amplitude", 0.1),
        ("loads.drag.bezier.2", 1.0),
    ];
    let file = read(BAR);
    let parameters = keys.map(|(key, scale)| Parameter {
        name: key.to_owned(),
        keys: vec![key.to_owned()],
        start: None,
        bounds: [-1e9, 1e9],
        scale: Some(scale),
    });
    let sought = Sought::new(&file.case, &parameters);
    let start: Vec<f64> = sought.bounded.iter().map(|one| one.start).collect();
    let model = Model::<2>::new(&file).expect("it is a body");
    let objective =
        ObjectiveSpec::Travel { direction: vec![0.2, 1.0], cost_of_work: 0.1, after: None };
    let mut seeker = Seeker { model, sought, kind: Kind::Optimisation(objective) };
    let found = seeker.evaluate(&start).expect("it moves").slopes;
    let largest = (0..keys.len()).map(|k| (found[k] * keys[k].1).abs()).fold(0.0, f64::max);
    for k in 0..keys.len() {
        let mut at = |by: f64| {
            let mut values = start.clone();
            values[k] += by;
            seeker.evaluate(&values).expect("it moves").objective
        };
        let h = 1e-4 * keys[k].1;
        let expected = (at(h) - at(-h)) / (2.0 * h);
        let apart = (found[k] - expected).abs() * keys[k].1 / largest;
        println!("{}: {apart:.1e}", keys[k].0);
        assert!(apart < 1e-5, "{}: {} {expected}", keys[k].0, found[k]);
    }
}

#[test]
fn what_cannot_keep_its_volume_is_refused_with_key_line_and_remedy() {
    assert!(check(&read(BAR)).is_empty(), "{:?}", check(&read(BAR)));
    let amplitude = "keys = [\"solid.0.fibre.0.stretch.wave.amplitude\"]\nbounds = [0.001, 0.05]";
    for (from, to, key, says) in [
        ("poisson = 0.5,", "poisson = 0.51,", "solid.0.material.poisson", "0.5 at most"),
        (
            "cells = [12, 2] }",
            "cells = [12, 2] }\norder = \"linear\"",
            "solid.0.material.poisson",
            "write order = \"quadratic\"",
        ),
        (
            amplitude,
            "keys = [\"solid.0.material.poisson\"]\nstart = 0.4\nbounds = [0.3, 0.45]",
            "optimisation.parameter.0.bounds",
            "write a smaller ratio",
        ),
        (
            "\"solid.0.material.young\" = 6e4",
            "\"solid.0.material.poisson\" = 0.4",
            "robot.set.solid.0.material.poisson",
            "for both or for none",
        ),
        (
            "\"solid.0.material.young\" = 6e4",
            "\"solid.0.part.1.material.poisson\" = 0.5",
            "robot.set.solid.0.part.1.material.poisson",
            "for both or for none",
        ),
    ] {
        assert!(BAR.contains(from), "{from}");
        let found = check(&read(&BAR.replacen(from, to, 1)));
        let first = found.first().unwrap_or_else(|| panic!("{to} is wrong"));
        assert_eq!(first.key, key, "{first}");
        let said = first.to_string();
        assert!(said.contains(says) && said.contains("case.toml:"), "{said}");
    }
}

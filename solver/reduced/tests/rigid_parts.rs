//! Soft cases with rigid parts: their form, their momentum in vacuum, and what is refused.

use alewife_reduced::tier::{Model, TierError};

use crate::given;

/// A free bar with a rigid head and a rigid tail, in vacuum.
const BAR: &str = r#"
title = "a bar with a rigid head and tail"
geometry = "planar"

[[solid]]
name = "bar"
grid = { from = [0.0, -0.01], to = [0.12, 0.01], cells = [12, 2] }
material = { young = 4e4, poisson = 0.3, density = 1000.0 }

[[solid.rigid]]
region = { from = [0.08, -inf], to = [inf, inf] }
density = 3000.0

[[solid.rigid]]
region = { from = [-inf, -inf], to = [0.02, inf] }
density = 500.0

[[solid.fibre]]
name = "above"
region = { from = [-inf, 0.0], to = [inf, inf] }
direction = [1.0, 0.0]
stiffness = 5e4
stretch.wave = { mean = 0.9, amplitude = 0.05, frequency = 3.0 }

[soft]
frame = 0.01
frames = 20
scheme = "bdf2"
tolerance = 1e-12
"#;

fn model(text: &str) -> Result<Model<2>, String> {
    let file = given::read(text).map_err(|error| error.to_string())?;
    Model::new(&file).map_err(|error| match error {
        TierError::Case(all) => {
            all.first().map_or_else(String::new, |one| format!("{} | {one}", one.key))
        }
        other => other.to_string(),
    })
}

#[test]
fn rigid_parts_keep_their_form_and_the_whole_its_momentum() {
    let model = model(BAR).expect("it is a body");
    let solid = &model.body.solid;
    let motion = model.body.simulate(&model.plan).expect("it moves");
    let (rest, end) = (solid.at_rest(), motion.levels.last().expect("it has levels"));
    let nodes = &solid.spec().mesh.nodes;
    let mass: f64 = solid.times_mass(&vec![1.0; rest.len()]).iter().step_by(2).sum();
    assert!((mass - 0.02 * (0.02 * 500.0 + 0.06 * 1e3 + 0.04 * 3e3)).abs() < 1e-12, "{mass}");
    for (from, to) in [(0.0, 0.02), (0.08, 0.12)] {
        let own: Vec<usize> = (0..nodes.len())
            .filter(|node| from - 1e-9 < nodes[*node][0] && nodes[*node][0] < to + 1e-9)
            .collect();
        let distance = |all: &[f64], a: usize, b: usize| {
            (all[2 * a] - all[2 * b]).hypot(all[2 * a + 1] - all[2 * b + 1])
        };
        for pair in own.windows(2) {
            let change =
                distance(&end.places, pair[0], pair[1]) - distance(&rest, pair[0], pair[1]);
            assert!(change.abs() < 1e-13, "{change}");
        }
        let turned = end.places[2 * own[0] + 1] - end.places[2 * own[own.len() - 1] + 1];
        assert!(turned.abs() > 1e-4, "{turned}");
    }
    let momentum = solid.times_mass(&end.velocities);
    let largest = momentum.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let along: f64 = momentum.iter().step_by(2).sum();
    let across: f64 = momentum.iter().skip(1).step_by(2).sum();
    println!("{along:.1e} {across:.1e} of {largest:.1e}");
    assert!(along.abs() + across.abs() < 1e-8 * largest, "{along} {across}");
}

#[test]
fn wrong_parts_are_refused_with_key_line_and_remedy() {
    for (from, to, key, says) in [
        ("density = 3000.0", "density = 0.0", "solid.0.rigid.0.density", "write a number above 0"),
        (
            "from = [0.08, -inf]",
            "from = [0.02, -inf]",
            "solid.0.rigid.1.region",
            "leave cells between them",
        ),
        ("from = [0.08, -inf]", "from = [1.0, -inf]", "solid.0.rigid.0.region", "widen the region"),
        ("from = [0.08, -inf]", "from = [0.08]", "solid.0.rigid.0.region.from", "write 2"),
        (
            "[soft]",
            "[[solid.hold]]\nregion = { from = [-inf, -inf], to = [0.0, inf] }\n[soft]",
            "solid.0.rigid.1.region",
            "hold cells beside it",
        ),
    ] {
        assert!(BAR.contains(from), "{from}");
        let said = model(&BAR.replacen(from, to, 1)).err().unwrap_or_default();
        assert!(said.contains(key) && said.contains(says), "{key}, {says}: {said}");
        assert!(said.contains("case.toml:"), "{said}");
    }
}

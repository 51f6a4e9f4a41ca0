//! A robot of links under a skin, whose joints follow angles that were recorded, from file to result.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use super::done;

/// Three links under a skin in a tank, with the angles of their two joints.
fn eel(angles: [&str; 2]) -> String {
    let [front, back] = angles;
    format!(
        r#"
        title = "three links under a skin"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.1 }}
        domain.box = {{ min = [-3.0, -2.0], max = [3.0, 2.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 1.0, surface = 0.2, growth = 0.4, gap_layers = 1 }}
        time.unsteady = {{ step = 0.05, end = 1.0 }}
        [[swimmer]]
        name = "eel"
        [swimmer.kind.chain]
        links = [[0.4, 0.1], [0.4, 0.1], [0.4, 0.1]]
        gap = 0.1
        skin.rounding = 0.4
        joints = [{{ bent.angle.{front} }}, {{ bent.angle.{back} }}]
        "#
    )
}

/// The place and heading at the end, by the series of a run.
fn way(directory: &Path, case: &str, out: &str) -> [f64; 3] {
    done(directory, &["run", case, "--out", out, "--threads", "1", "--quiet"]);
    let series = std::fs::read_to_string(directory.join(out).join("series.csv")).unwrap();
    let names: Vec<&str> = series.lines().next().unwrap().split(',').collect();
    let values: Vec<&str> = series.lines().last().unwrap().split(',').collect();
    ["eel.x", "eel.y", "eel.angle"].map(|name| {
        let column = names.iter().position(|known| *known == name).unwrap();
        values[column].parse().unwrap()
    })
}

/// Translation of the recoil as `check` tells it.
fn translation(directory: &Path, case: &str) -> f64 {
    let said = done(directory, &["check", "--no-mesh", case]);
    let (_, rest) = said.split_once("eel: translation up to ").unwrap();
    rest.split(' ').next().unwrap().parse().unwrap()
}

/// Angles of the recoil in the messages of a run.
fn recoil_angles(directory: &Path, out: &str) -> Vec<f64> {
    let bytes = std::fs::read(directory.join(out).join("run.mcap")).unwrap();
    let messages = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
    messages
        .filter(|message| message.channel.topic == "/body/eel")
        .map(|message| serde_json::from_slice::<Value>(&message.data).unwrap())
        .map(|body| body["recoil"]["angle"].as_f64().unwrap())
        .collect()
}

/// Angles that are sampled from sines, fifty times a period, make the way of the sines; and the run keeps
/// them, so that its own case file needs no other.
#[test]
fn a_skin_swims_by_the_angles_of_a_file() {
    let directory = tempfile::tempdir().unwrap();
    let write = |file: &str, text: &str| std::fs::write(directory.path().join(file), text).unwrap();
    let sine = |phase: f64| format!("sine = {{ amplitude = 0.4, period = 1.0, phase = {phase} }}");
    write("sine.toml", &eel([&sine(0.0), &sine(0.25)]));
    let column = |name: &str| {
        format!("file = {{ path = \"angles.csv\", time = \"t\", column = \"{name}\" }}")
    };
    write("recorded.toml", &eel([&column("front"), &column("back")]));
    let mut angles = "t,front,back\n".to_owned();
    for sample in -5..=55 {
        let time = f64::from(sample) / 50.0;
        let [front, back] = [0.0, 0.25].map(|phase| 0.4 * (TAU * (time + phase)).sin());
        writeln!(angles, "{time},{front},{back}").unwrap();
    }
    write("angles.csv", &angles);

    let exact = way(directory.path(), "sine.toml", "sine");
    let recorded = way(directory.path(), "recorded.toml", "recorded");
    assert!(exact[0] > 0.02, "it swims: {exact:?}");
    let off = |one: [f64; 3], other: [f64; 3]| {
        one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    println!("{exact:?}, {recorded:?}: {:e} apart", off(exact, recorded));
    assert!(off(exact, recorded) < 1e-5 * exact[0], "{exact:?} {recorded:?}");
    // What is subtracted from the gait is told, of a recording over all of it
    let [one, other] =
        ["sine.toml", "recorded.toml"].map(|case| translation(directory.path(), case));
    assert!((one - other).abs() < 0.05 * one, "{one} {other}");
    let [one, other] = ["sine", "recorded"].map(|out| recoil_angles(directory.path(), out));
    assert_eq!(one.len(), 21);
    assert!(one.iter().any(|angle| angle.abs() > 0.05), "{one:?}");
    assert!(one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-5), "{one:?} {other:?}");
    std::fs::remove_file(directory.path().join("angles.csv")).unwrap();
    let again = way(directory.path(), "recorded/case.toml", "again");
    assert_eq!(again, recorded);
}

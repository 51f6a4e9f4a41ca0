//! What a run warns of: steps too long for its convection or its strokes.

use super::alewife;

#[test]
fn steps_too_long_for_extrapolated_convection_are_told() {
    let directory = tempfile::tempdir().unwrap();
    let run = |convection: &str| {
        let mut command = vec!["run", "dfg-2d-2", "--overwrite", "--threads", "1"];
        for setting in [
            "mesh.scale=4",
            "time.unsteady.step=0.1",
            "time.unsteady.end=0.3",
            "reference=[]",
            "statistics={}",
            convection,
        ] {
            command.extend(["--set", setting]);
        }
        let output = alewife(directory.path(), &command);
        assert_eq!(output.status.code(), Some(0));
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(said.contains("CFL number up to"), "{said}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let warned = run("time.unsteady.convection=\"extrapolated\"");
    assert!(warned.contains("extrapolated convection was shown to hold up to 5"), "{warned}");
    let told = warned.split("with steps of ").nth(1).and_then(|rest| rest.split(' ').next());
    let step: f64 = told.and_then(|step| step.parse().ok()).expect("a step that helps");
    assert!((1e-3..0.1).contains(&step), "{warned}");
    assert!(!run("time.unsteady.convection=\"newton\"").contains("CFL"));
}

/// Whoever does not look at the terminal is told, too.
#[test]
fn warnings_of_case_and_run_are_in_the_status_and_the_last_lines() {
    let directory = tempfile::tempdir().unwrap();
    let mut command = vec!["run", "dfg-2d-2", "--out", "r", "--threads", "1", "--quiet"];
    for setting in [
        "mesh.scale=4",
        "time.unsteady.step=0.1",
        "time.unsteady.end=0.3",
        "reference=[]",
        "statistics={ window = [0.2, 0.6] }",
    ] {
        command.extend(["--set", setting]);
    }
    let output = alewife(directory.path(), &command);
    assert_eq!(output.status.code(), Some(0));
    let [said, told] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    let status = std::fs::read_to_string(directory.path().join("r/status.json")).unwrap();
    let status: serde_json::Value = serde_json::from_str(&status).unwrap();
    let warnings = status["warnings"].as_array().unwrap();
    let found = |words: &str| {
        let is_it = |one: &&serde_json::Value| one["message"].as_str().unwrap().contains(words);
        warnings.iter().find(is_it).unwrap_or_else(|| panic!("no {words}: {status:#}"))
    };
    let (of_case, of_run) = (found("the run ends at 0.3"), found("CFL number"));
    assert!(of_case["time"].is_null() && of_case["count"] == 1, "{of_case}");
    assert!(of_run["time"].as_f64().unwrap() > 0.0 && of_run["count"] == 1, "{of_run}");
    assert!(!told.contains("CFL number"), "{told}");
    assert!(said.contains(&format!("\n{} warnings, in status.json", warnings.len())), "{said}");
    assert!(said.contains("CFL number") && said.contains("the run ends at 0.3"), "{said}");
    let shown = alewife(directory.path(), &["status", "r"]).stdout;
    let shown = String::from_utf8_lossy(&shown);
    assert_eq!(shown.matches("  warning: ").count(), warnings.len(), "{shown}");
}

#[test]
fn check_warns_of_steps_in_which_fluid_crosses_several_cells() {
    let directory = tempfile::tempdir().unwrap();
    let told = |settings: &[&str]| {
        let mut command = vec!["check", "dfg-2d-2", "--no-step", "--set", "mesh.scale=4"];
        settings.iter().for_each(|setting| command.extend(["--set", setting]));
        let output = alewife(directory.path(), &command);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let long = "time.unsteady.step=0.1";
    let warned = told(&[long, "time.unsteady.convection=\"extrapolated\""]);
    assert!(
        warned.contains("the CFL number is up to") && warned.contains("hold up to 5"),
        "{warned}"
    );
    let warned = told(&[long, "time.unsteady.convection=\"newton\""]);
    assert!(warned.contains("what changes within a step is not resolved"), "{warned}");
    for fine in ["time.unsteady.step=0.005", "fluid.model=\"unsteady-stokes\""] {
        assert!(!told(&[long, fine]).contains("CFL number"), "{fine}");
    }
    assert!(!told(&[long, "time.unsteady.adaptive={}"]).contains("CFL number"));
}

/// Three links above a wall, their joints bent in quadrature, at steps of a size.
const THREE_LINKS: &str = r#"
title = "three links above a wall"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.box = { min = [-4.0, 0.0], max = [4.0, 4.0] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 1.5, surface = 0.2, growth = 0.5, gap_layers = 1 }
time.unsteady = { step = 0.05, end = 1.0 }
[[swimmer]]
name = "links"
center = [0.0, 1.0]
[swimmer.kind.chain]
links = [[0.5, 0.12], [0.5, 0.12], [0.5, 0.12]]
gap = 0.3
joints = [
    { bent = { angle = { sine = { amplitude = 0.7, period = 1.0 } } } },
    { bent = { angle = { sine = { amplitude = 0.7, period = 1.0, phase = 0.25 } } } },
]
"#;

#[test]
fn a_run_warns_of_the_error_of_a_stroke() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("links.toml"), THREE_LINKS).unwrap();
    let swim = |scheme: &str, steps: usize| -> ([f64; 2], Option<f64>) {
        let scheme = format!("time.unsteady.scheme={scheme}");
        let step = format!("time.unsteady.step={}", 1.0 / steps as f64);
        let replace = ["run", "links.toml", "--overwrite", "--threads", "1"];
        let output = alewife(
            directory.path(),
            &[&replace[..], &["--set", &scheme, "--set", &step]].concat(),
        );
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{told}");
        let series = std::fs::read_to_string(directory.path().join("runs/links/series.csv"));
        let series = series.unwrap();
        let row = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let (names, values) =
            (row(series.lines().next().unwrap()), row(series.lines().last().unwrap()));
        let value = |name: &str| -> f64 {
            let column = names.iter().position(|known| known == name).unwrap();
            values[column].parse().unwrap()
        };
        let percent = told.split("uncertain by about ").nth(1);
        let percent = percent.map(|rest| rest.split(' ').next().unwrap().parse().unwrap());
        (["links.cycle.x", "links.cycle.y"].map(value), percent)
    };
    let (exact, none) = swim("rk3", 40);
    assert_eq!(none, None);
    for (scheme, steps) in [("bdf2", 5), ("bdf2", 10), ("bdf2", 20)] {
        let ([x, y], percent) = swim(scheme, steps);
        let error = (x - exact[0]).hypot(y - exact[1]) / x.hypot(y);
        let percent = percent.expect("an error is warned of");
        println!("{scheme}, {steps} steps: {:.2} % off, {percent} % estimated", 100.0 * error);
        assert!(percent > 50.0 * error && percent < 200.0 * error, "{steps}: {error}, {percent} %");
    }
    assert_eq!(swim("rk3", 10).1, None);
}

/// Three spheres whose arms shorten and lengthen together, with times of rest between.
const RECIPROCAL: &str = r#"
title = "a stroke to and fro"
geometry = "axisymmetric"
fluid = { model = "stokes", viscosity = 1.0 }
domain.cylinder = { x = [-20.0, 20.0], radius = 10.0 }
boundary = { left = "no-slip", right = "no-slip", wall = "no-slip" }
mesh = { size = 2.5, surface = 0.3, growth = 0.3 }
time.unsteady = { step = 0.1, end = 4.0 }
[[swimmer]]
name = "swimmer"
[swimmer.kind.linked-spheres]
radii = [1.0, 1.0, 1.0]
[[swimmer.kind.linked-spheres.arms]]
legs = { period = 4.0, knots = [[0.0, 7.0], [1.0, 4.0], [2.0, 4.0], [3.0, 7.0]] }
[[swimmer.kind.linked-spheres.arms]]
legs = { period = 4.0, knots = [[0.0, 7.0], [1.0, 4.0], [2.0, 4.0], [3.0, 7.0]] }
"#;

/// Where all rest, velocities are rounding: nothing may be measured by them.
#[test]
fn swimmers_that_rest_and_go_nowhere_need_no_warning() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("arms.toml"), RECIPROCAL).unwrap();
    for (scheme, steps) in [
        ("rk3", "time.unsteady.step=0.1"),
        ("bdf2", "time.unsteady.step=0.1"),
        ("rk3", "time.unsteady.adaptive={ tolerance = 1e-4 }"),
    ] {
        let scheme = format!("time.unsteady.scheme=\"{scheme}\"");
        let command = ["run", "arms.toml", "-v", "--overwrite", "--threads", "1"];
        let output = alewife(
            directory.path(),
            &[&command[..], &["--set", &scheme, "--set", steps]].concat(),
        );
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{told}");
        assert!(!told.contains("WARN"), "{told}");
        let is_adaptive = steps.contains("adaptive");
        assert_eq!(told.contains("`swimmer` goes nowhere in a cycle"), !is_adaptive, "{told}");
    }
}

#[test]
fn contact_too_weak_for_its_bodies_is_told_and_another_strength_proposed() {
    let directory = tempfile::tempdir().unwrap();
    let text = r#"
        title = "a disc pressed on to the floor"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0, density = 1.0, gravity = [0.0, -1.0] }
        domain.box = { min = [-2.0, 0.0], max = [2.0, 3.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.5, surface = 0.1, gap_layers = 1 }
        time.unsteady = { step = 0.002, end = 0.02 }
        contact.barrier = { range = 0.05, stiffness = STIFFNESS }
        [[body]]
        name = "disc"
        shape.disc.radius = 0.5
        center = [0.0, HEIGHT]
        density = 2.0
        motion = "free"
    "#;
    let with = |stiffness: &str, height: &str, command: &[&str]| {
        let text = text.replace("STIFFNESS", stiffness).replace("HEIGHT", height);
        std::fs::write(directory.path().join("disc.toml"), text).unwrap();
        let output = alewife(directory.path(), command);
        let [out, error] =
            [output.stdout, output.stderr].map(|told| String::from_utf8(told).unwrap());
        assert_eq!(output.status.code(), Some(0), "{error}");
        (out, error)
    };
    let run = ["run", "disc.toml", "--overwrite", "--threads", "1"];
    let (_, told) = with("1e-4", "0.5004", &run);
    assert!(told.contains("the smallest gap, at `disc`, is"), "{told}");
    let (said, _) = with("1e-4", "0.5004", &["check", "disc.toml"]);
    let line = said.lines().find(|line| line.contains("stiffness for half the range")).unwrap();
    let proposed: f64 =
        line.split_whitespace().find_map(|word| word.parse().ok()).expect("a number");
    // Its weight less buoyancy is pi / 4; the barrier holds that at half its range
    let weight = proposed * 0.05 * (0.5 + 2f64.ln());
    assert!((0.7..3.0).contains(&weight), "{weight}: {line}");
    let (_, told) = with(&proposed.to_string(), "0.52", &run);
    assert!(!told.contains("the smallest gap"), "{told}");
}

#[test]
fn check_tells_cfl_and_cell_reynolds_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let output = alewife(directory.path(), &["check", "dfg-2d-2", "--set", "mesh.scale=4"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("CFL number") && said.contains("cell Reynolds"), "{said}");
}

#[test]
fn a_run_that_is_cut_short_leaves_references_uncomputed() {
    let directory = tempfile::tempdir().unwrap();
    let case = THREE_LINKS.to_owned()
        + "[statistics]\nwindow = [0.5, 1.0]\n\
           [[reference]]\nquantity = \"links.x\"\nstatistic = \"at\"\nat = 1.0\nvalue = 0.0\n\
           absolute = 1.0\nkind = \"property\"\nsource = \"it stays near its place\"\n\
           [[reference]]\nquantity = \"links.y\"\nstatistic = \"mean\"\nvalue = 1.0\n\
           absolute = 1.0\nkind = \"property\"\nsource = \"it stays near its place\"\n\
           [[reference]]\nquantity = \"links.y\"\nvalue = 1.0\n\
           absolute = 1.0\nkind = \"property\"\nsource = \"it stays near its place\"\n";
    std::fs::write(directory.path().join("links.toml"), case).unwrap();
    let run = |more: &[&str]| {
        let short = ["--set", "time.unsteady.end=0.1", "--set", "time.unsteady.step=0.05"];
        let command = ["run", "links.toml", "--overwrite", "--threads", "1", "--quiet"];
        let output = alewife(directory.path(), &[&command[..], &short[..], more].concat());
        let [said, warned] =
            [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        assert_eq!(output.status.code(), Some(0), "{said}{warned}");
        (said, warned, directory.path().join("runs/links/comparison.json").exists())
    };
    let (said, warned, is_compared) = run(&[]);
    assert!(warned.contains("the time 1 is after the end of the run at 0.1"), "{warned}");
    assert!(warned.contains("the window goes from 0.5 to 1, and the run ends at 0.1"), "{warned}");
    assert_eq!(said.matches("NOT COMPUTED").count(), 2, "{said}");
    assert_eq!(said.matches("within").count(), 1, "{said}");
    assert!(said.contains("the run has no value at time 1") && is_compared, "{said}");
    let (said, _, is_compared) = run(&["--no-references"]);
    assert!(!said.contains("COMPUTED") && said.contains("links.x") && !is_compared, "{said}");
}

/// Two discs pressed together, without contact.
const PRESSED: &str = r#"
title = "two discs pressed together"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 1.5, surface = 0.3, growth = 0.5, gap_layers = 1 }
time.unsteady = { step = 0.02, end = 6.0 }
[[body]]
name = "one"
shape = { disc = { radius = 0.5 } }
center = [-0.8, 0.0]
motion = "free"
force = [10.0, 0.0]
[[body]]
name = "other"
shape = { disc = { radius = 0.5 } }
center = [0.8, 0.0]
motion = "free"
force = [-10.0, 0.0]
"#;

#[test]
fn contact_is_proposed_where_bodies_stay_near_each_other_without_it() {
    let directory = tempfile::tempdir().unwrap();
    let told = |text: &str, more: &[&str]| {
        std::fs::write(directory.path().join("discs.toml"), text).unwrap();
        let command = ["run", "discs.toml", "--overwrite", "--threads", "1"];
        let output = alewife(directory.path(), &[&command[..], more].concat());
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{error}");
        let count = error.matches("if they may meet, [contact]").count();
        assert!(count == 0 || error.contains("`one` and `other` are"), "{error}");
        count
    };
    assert_eq!(told(PRESSED, &[]), 1);
    // Not while they are on their way, and not with contact
    assert_eq!(told(PRESSED, &["--set", "time.unsteady.end=0.2"]), 0);
    let contact = "contact.barrier = { range = 0.1, stiffness = 200.0 }\n[[body]]";
    assert_eq!(told(&PRESSED.replacen("[[body]]", contact, 1), &[]), 0);
}

/// A squirmer in a fluid a billion times thinner than its cells resolve.
const THIN: &str = r#"
title = "a fluid too thin"
geometry = "planar"
fluid = { model = "navier-stokes", viscosity = 1e-6, density = 1000.0 }
domain.box = { min = [-2.0, -2.0], max = [2.0, 2.0] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 0.4, surface = 0.125 }
time.unsteady = { step = 0.05, end = 40.0 }
[[body]]
name = "one"
shape.disc.radius = 0.5
center = [0.0, 0.0]
motion = "free"
gait.squirmer = { modes = [2.0, 6.0], heading = "30 deg" }
"#;

#[test]
fn a_flow_that_no_mesh_resolves_is_warned_of_and_ends_with_what_is_wrong() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("thin.toml"), THIN).unwrap();
    let checked = alewife(directory.path(), &["check", "--no-mesh", "thin.toml"]);
    let warned = String::from_utf8_lossy(&checked.stderr);
    assert!(warned.contains("the cell Reynolds number of the finest cells is 1.0e9"), "{warned}");
    let output = alewife(directory.path(), &["run", "thin.toml", "--threads", "1", "--quiet"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(10), "{told}");
    let last = told.lines().last().unwrap_or_default();
    assert!(last.contains("the flow has blown up") || last.contains("far too many"), "{told}");
    assert!(!last.contains("[contact]"), "{told}");
}

//! Points of sweeps: how many, in which order, with which values; and what is refused.

use serde_json::{Value, json};

use super::latin_hypercube::sample;
use super::range::Range;
use crate::{CaseError, Sweep, check};

const CASE: &str = "extends = 'squirmer-alone'\ntitle = 't'\n";
/// A key of that case, B2.
const MODE: &str = "body.0.gait.squirmer.modes.1";

/// The sweep of a text behind that of the case.
fn sweep(text: &str, settings: &[&str]) -> Result<Sweep, CaseError> {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("case.toml");
    std::fs::write(&file, format!("{CASE}{text}")).unwrap();
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    Sweep::read(file.to_str().unwrap(), &settings)
}

fn points(text: &str, settings: &[&str]) -> Vec<Vec<Value>> {
    let sweep = sweep(text, settings).unwrap();
    (0..sweep.n_points()).map(|index| sweep.point(index).values()).collect()
}

#[track_caller]
fn refusal(text: &str, settings: &[&str]) -> String {
    sweep(text, settings).unwrap_err().to_string()
}

#[test]
fn a_grid_has_all_combinations_and_the_last_key_changes_first() {
    let text = format!("[sweep.grid]\n'fluid.viscosity' = [1.0, 2.0]\n'{MODE}' = [0, 3, 6]\n");
    let all = points(&text, &[]);
    let expected = [[1.0, 0.0], [1.0, 3.0], [1.0, 6.0], [2.0, 0.0], [2.0, 3.0], [2.0, 6.0]];
    let found: Vec<Vec<f64>> =
        all.iter().map(|row| row.iter().map(|value| value.as_f64().unwrap()).collect()).collect();
    assert_eq!(found, expected);
}

#[test]
fn keys_are_in_the_order_in_which_they_are_written() {
    let text =
        format!("[sweep.grid]\nmesh.scale = [1, 2]\n'{MODE}' = [0]\nfluid.viscosity = [1, 2]");
    assert_eq!(sweep(&text, &[]).unwrap().keys(), ["mesh.scale", MODE, "fluid.viscosity"]);
}

#[test]
fn zipped_keys_go_side_by_side_and_with_all_of_the_grid() {
    let text = format!(
        "[sweep.grid]\n'{MODE}' = [0, 3]\n[[sweep.zip]]\n'mesh.size' = [0.6, 0.3, 0.2]\nmesh.surface = \
         {{ from = 0.06, to = 0.02, n = 3 }}\n"
    );
    let all = points(&text, &[]);
    assert_eq!(all.len(), 6);
    assert_eq!(all[1], [json!(0), json!(0.3), json!(0.04)]);
    assert_eq!(all[5], [json!(3), json!(0.2), json!(0.02)]);
}

#[test]
fn a_list_gives_points_one_by_one() {
    let text = format!(
        "sweep.list = [{{ '{MODE}' = 1, 'fluid.viscosity' = 2.0 }}, {{ fluid.viscosity = 4.0, '{MODE}' = 3 }}]"
    );
    assert_eq!(points(&text, &[]), [[json!(1), json!(2.0)], [json!(3), json!(4.0)]]);
}

#[test]
fn ranges_have_both_ends_and_short_numbers() {
    let values = |setting: &str| {
        let text = format!("fluid.viscosity={setting}");
        points("", &[&text]).into_iter().map(|row| row[0].clone()).collect::<Vec<_>>()
    };
    assert_eq!(values("0.1:0.5:5"), [0.1, 0.2, 0.3, 0.4, 0.5].map(|value| json!(value)));
    assert_eq!(values("1:5:5"), [1, 2, 3, 4, 5].map(|value| json!(value)));
    assert_eq!(values("1:2:3"), [1.0, 1.5, 2.0].map(|value| json!(value)));
    assert_eq!(values("1:1e4:5:log"), [1.0, 10.0, 100.0, 1000.0, 1e4].map(|value| json!(value)));
    assert_eq!(values("3,1,2.5"), [json!(3), json!(1), json!(2.5)]);
}

#[test]
fn the_command_line_sweeps_any_value() {
    let all =
        points("", &["fluid.model=stokes,unsteady-stokes", "body.0.center=[0.0,0.0],[1.0,0.0]"]);
    assert_eq!(all[1], [json!("stokes"), json!([1.0, 0.0])]);
    assert_eq!(all.len(), 4);
    // One text with commas and blanks sets a key once
    let all = points("", &["title=one, two", "fluid.viscosity=1,2"]);
    assert_eq!(all.len(), 2);
}

#[test]
fn the_command_line_goes_over_the_grid_of_the_file() {
    let text = format!("[sweep.grid]\n'{MODE}' = [0, 3]\nfluid.viscosity = [1.0, 2.0]\n");
    let set = format!("{MODE}=-1:1:3");
    assert_eq!(points(&text, &[&set]).len(), 6);
    let fixed = points(&text, &["fluid.viscosity=7.0"]);
    assert_eq!(fixed, [[json!(0), json!(7.0)], [json!(3), json!(7.0)]]);
    let reported = refusal(&text, &["body.0.gait.squirmer.modes=[1.0, 2.0]"]);
    assert!(
        reported.contains("is set once, and `body.0.gait.squirmer.modes.1` is swept"),
        "{reported}"
    );
}

#[test]
fn every_part_of_every_range_has_one_point() {
    let ranges = [
        Range::new(-2.0, 3.0, false).unwrap(),
        Range::new(1.0, 1e6, true).unwrap(),
        Range::new(5.0, 4.0, false).unwrap(),
    ];
    for n in [1, 2, 7, 100] {
        let rows = sample(&ranges, n, 4);
        let part = |value: f64, column: usize| match column {
            0 => (value + 2.0) / 5.0,
            1 => value.log10() / 6.0,
            _ => 5.0 - value,
        };
        for column in 0..3 {
            let mut counts = vec![0; n];
            for row in &rows {
                let part = part(row[column], column);
                assert!((0.0..1.0).contains(&part), "{part}");
                counts[alewife_mesh::whole(part * n as f64)] += 1;
            }
            assert_eq!(counts, vec![1; n], "column {column} of {n} points");
        }
    }
    // Another seed, other points; no order along one range is that along another
    assert_eq!(sample(&ranges, 50, 4), sample(&ranges, 50, 4));
    let [one, other] = [4, 5].map(|seed| sample(&ranges, 50, seed));
    assert_ne!(one, other);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let column = |nth: usize| one.iter().map(|row| row[nth]).collect::<Vec<_>>();
    let [x, y] = [column(0), column(2)];
    let [mean_x, mean_y] = [mean(&x), mean(&y)];
    let product = |(x, y): (&f64, &f64)| (x - mean_x) * (y - mean_y);
    let products: Vec<f64> = x.iter().zip(&y).map(product).collect();
    // Of independent columns the correlation is some 1/sqrt(50); it is 1 where orders are the same
    assert!(mean(&products).abs() < 0.5 * (5.0 / 12.0), "{}", mean(&products));
}

#[test]
fn a_latin_hypercube_is_that_of_its_seed() {
    let text = format!(
        "[sweep.latin-hypercube]\npoints = 9\nseed = 2\n'{MODE}' = {{ from = -1, to = 1 }}\nfluid.viscosity = \
         {{ from = 0.1, to = 10.0, scale = 'log' }}\n"
    );
    let all = points(&text, &[]);
    assert_eq!((all.len(), &all), (9, &points(&text, &[])));
    assert_ne!(all, points(&text, &["sweep.latin-hypercube.seed=3"]));
}

#[test]
fn the_case_of_a_point_is_the_case_with_its_values() {
    let text = format!("[sweep.grid]\n'{MODE}' = [0.5, 3.0]\nfluid.viscosity = [1.0, 2.0]\n");
    let sweep = sweep(&text, &[]).unwrap();
    let file = sweep.case(1).unwrap();
    assert!(check(&file).is_empty() && sweep.check(&file).is_empty());
    let settings = ["title='t'", &format!("{MODE}=0.5"), "fluid.viscosity=2.0", "reference=[]"];
    let settings = settings.map(str::to_owned);
    let mut single = crate::Case::read("squirmer-alone", &settings).unwrap().model.case;
    single.variant.clear();
    single.quick = false;
    assert_eq!(file.case(), &single);
    assert_eq!(sweep.point(1).label(), format!("{MODE} = 0.5, fluid.viscosity = 2.0"));
}

#[test]
fn a_sweep_is_no_part_of_a_case_and_not_inherited() {
    let shipped = crate::Case::read("squirmer-alone", &[]).unwrap();
    assert!(shipped.has_sweep && !shipped.case().to_toml().unwrap().contains("sweep"));
    let reported = refusal("", &[]);
    assert!(
        reported.contains("no key of the case is swept") && reported.contains("add a [sweep]"),
        "{reported}"
    );
}

#[test]
fn what_is_wrong_in_a_sweep_is_told_with_its_place_and_what_is_accepted() {
    let grid = |line: &str| format!("[sweep.grid]\n{line}\n");
    for (text, message, help) in [
        ("[sweep]\ngird = {}\n".into(), "unknown key `gird` in `sweep`", "did you mean `grid`?"),
        (grid("mesh.scale = 3"), "`mesh.scale` has no values to sweep", "write a list such as"),
        (grid("mesh.scale = []"), "has 0 values", "1 to 100000"),
        (grid("mesh.scale = { from = 1, to = 2 }"), "has no `n`", "add n"),
        (
            grid("mesh.scale = { from = 1, t = 2, n = 3 }"),
            "a range has no `t`",
            "did you mean `to`",
        ),
        (grid("mesh.scale = { from = 1, to = 2, n = 1 }"), "not a number of values", "from 2 to"),
        (
            grid("mesh.scale = { from = '1', to = 2, n = 3 }"),
            "`from` is not a number",
            "a range is",
        ),
        (grid("mesh.scale = { from = 1, to = 2, n = 3, scale = 'ln' }"), "no scale", "\"log\""),
        (
            grid("mesh.scale = { from = 0, to = 2, n = 3, scale = 'log' }"),
            "positive",
            "larger than 0",
        ),
        (grid("sweep.grid = [1]"), "`sweep.grid` cannot be swept", "keys of the case"),
        (grid("mesh = [1]\n'mesh.scale' = [1]"), "is swept twice", "zip"),
        (
            "[[sweep.zip]]\nmesh.scale = [1, 2]\nmesh.size = [1]\n".into(),
            "has 1 values",
            "equally many",
        ),
        ("sweep.list = [{ mesh.scale = 1 }, { mesh.size = 1 }]".into(), "other keys", "mesh.scale"),
        ("sweep.list = []".into(), "has no points", "for each point"),
        ("[sweep.latin-hypercube]\nseed = 1\n".into(), "how many points", "add points"),
        (
            "[sweep.latin-hypercube]\npoints = 3\nsead = 1\n".into(),
            "`sead` is no range",
            "in ranges",
        ),
        ("[sweep.latin-hypercube]\npoints = 3\nseed = -1\n".into(), "no seed", "not negative"),
        ("[sweep.latin-hypercube]\npoints = 3\n".into(), "has no ranges", "add a range"),
        (
            "[sweep]\nquantities = ['men a.x']\n".into(),
            "\"men\" is no statistic",
            "did you mean `mean`",
        ),
        ("sweep = 3".into(), "`sweep` is not a table", "with their values"),
    ] {
        let reported = refusal(&text, &[]);
        assert!(reported.contains(message) && reported.contains(help), "{text}: {reported}");
        assert!(reported.contains("case.toml:"), "{reported}");
        // No command takes such a file
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("case.toml");
        std::fs::write(&file, format!("{CASE}{text}")).unwrap();
        assert!(crate::Case::read(file.to_str().unwrap(), &[]).is_err(), "{text}");
    }
    for (setting, message) in [
        ("mesh.scale=1:2", "does not say how many values"),
        ("mesh.scale=1:2:x", "`x` is no number of values"),
        ("mesh.scale=1:2:3:ln", "`ln` is no scale"),
        ("mesh.scale=0:2:3:log", "numbers above 0"),
        ("=1:2:3", "no key is named"),
    ] {
        let reported = refusal("", &[setting]);
        assert!(
            reported.contains(message) && reported.contains("--set:1:"),
            "{setting}: {reported}"
        );
    }
    let reported = refusal("", &["mesh.scale=1:2:1000", "fluid.viscosity=1:2:1000"]);
    assert!(reported.contains("more than 100000 points"), "{reported}");
}

#[test]
fn a_point_that_is_wrong_says_where_its_value_is_written() {
    let sweep = sweep("[sweep.grid]\nfluid.viscsity = [1.0, 2.0]\n", &[]).unwrap();
    let reported = sweep.case(1).unwrap_err().to_string();
    assert!(
        reported.contains("case.toml:4:") && reported.contains("did you mean `viscosity`"),
        "{reported}"
    );
    let sweep = super::Sweep::read("squirmer-alone", &["fluid.viscosity=1,-2".to_owned()]).unwrap();
    let found = check(&sweep.case(1).unwrap_or_else(|error| panic!("{error}")));
    assert!(found[0].location.is_some(), "{found:?}");
}

#[test]
fn quantities_to_collect_are_those_of_a_run() {
    let sweep = sweep("[sweep]\nquantities = ['mean squirmer.powr']\ngrid.mesh.scale = [1]\n", &[])
        .unwrap();
    let found = sweep.check(&sweep.case(0).unwrap());
    assert!(found[0].help.contains("did you mean `squirmer.power`"), "{found:?}");
    assert_eq!(found[0].location.as_ref().unwrap().line, 4);
}

#[test]
fn of_settings_of_one_key_the_last_one_holds() {
    let n = |settings: &[&str]| points("", &[&["mesh.scale=1:2:2"], settings].concat()).len();
    assert_eq!(n(&["fluid.viscosity=1:2:3", "fluid.viscosity=1:2:4"]), 8);
    assert_eq!(n(&["fluid.viscosity=1:2:3", "fluid.viscosity=5"]), 2);
    assert_eq!(n(&["fluid.viscosity=5", "fluid.viscosity=1:2:3"]), 6);
}

#[test]
fn the_viscosity_follows_a_reynolds_number_that_is_swept() {
    let text = "fluid.model = 'navier-stokes'\nfluid.density = 2.0\nnumbers.reynolds = 20\n\
                scales = { length = 2.0, velocity = 3.0 }\n";
    let text = format!("{CASE}{text}");
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("case.toml");
    std::fs::write(&file, text).unwrap();
    let settings = ["numbers.reynolds=10,20,50".to_owned()];
    let sweep = Sweep::read(file.to_str().unwrap(), &settings).unwrap();
    let viscosities: Vec<f64> = (0..3)
        .map(|index| {
            let file = sweep.case(index).unwrap();
            let mistakes = sweep.check(&file);
            assert!(mistakes.iter().all(|one| one.key != "numbers.reynolds"), "{mistakes:?}");
            file.case().reference_viscosity()
        })
        .collect();
    for (computed, reynolds) in viscosities.iter().zip([10.0, 20.0, 50.0]) {
        assert!((computed * reynolds / 12.0 - 1.0).abs() < 1e-14, "{viscosities:?}");
    }
    // Set once, it is a claim, and what gives it is said
    let set = ["numbers.reynolds=50".to_owned()];
    let found = crate::check(&crate::Case::read(file.to_str().unwrap(), &set).unwrap());
    let one = found.iter().find(|one| one.key == "numbers.reynolds").unwrap();
    assert!(one.help.contains("fluid.viscosity = 0.24"), "{}", one.help);
}

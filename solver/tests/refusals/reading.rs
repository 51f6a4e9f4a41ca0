//! Files that cannot be read: keys, types, settings, `extends`, variants.

use super::{RIGHT, alewife, assert_accepted, assert_refused, check, edited, refused};

#[test]
fn a_right_case_is_accepted_with_its_variants() {
    let said = check(RIGHT, &[]);
    assert_accepted(&said);
    assert_eq!(said.stderr, "");
    assert!(said.stdout.contains("Reynolds number"), "{}", said.stdout);
    assert!(said.stdout.contains("nothing was run"), "{}", said.stdout);
}

#[test]
fn a_misspelt_key_is_named_with_the_nearest_one_and_all_others() {
    refused(
        "viscosity = 0.001",
        "viscocity = 0.001",
        &[
            "unknown key `viscocity` in `fluid`",
            "--> wrong.toml:6:1",
            "6 | viscocity = 0.001",
            "  | ^^^^^^^^^",
            "did you mean `viscosity`? accepted: model, viscosity, density, gravity",
        ],
    );
}

#[test]
fn all_misspelt_keys_are_named_at_once() {
    let text = edited("size = 0.1", "sise = 0.1").replace("length = 2.2", "lenght = 2.2");
    let said = check(&text, &[]);
    assert_refused(&said, &["wrong.toml:10:1", "`length`", "wrong.toml:26:1", "`size`"]);
    assert!(!said.stderr.contains("missing key"), "{}", said.stderr);
}

#[test]
fn a_misspelt_key_inside_an_alternative_is_pointed_at() {
    refused(
        "{ disc = { radius = 0.05 } }",
        "{ disc = { radios = 0.05 } }",
        &["unknown key `radios` in `body.0.shape.disc`", "wrong.toml:21:20", "`radius`?"],
    );
}

#[test]
fn a_quoted_number_is_a_wrong_type() {
    refused(
        "viscosity = 0.001",
        "viscosity = \"0.001 Pa s\"",
        &[
            "`fluid.viscosity` is the string \"0.001 Pa s\" where a number is wanted",
            "wrong.toml:6:13",
            "without quotes",
        ],
    );
}

#[test]
fn an_unknown_alternative_is_refused_with_the_known_ones() {
    refused(
        "model = \"navier-stokes\"",
        "model = \"navier-stoks\"",
        &["wrong.toml:5:9", "`navier-stokes`?", "accepted: stokes, unsteady-stokes"],
    );
    refused(
        "motion = \"held\"",
        "motion = \"imposed\"",
        &["wrong.toml:23:10", "{ imposed = ... }"],
    );
    refused("[time.steady]", "[time]", &["wrong.toml:29:", "exactly one", "{ unsteady = "]);
}

#[test]
fn a_missing_radius_is_named_with_its_table() {
    refused(
        "{ disc = { radius = 0.05 } }",
        "{ disc = { } }",
        &["missing key `radius` in `body.0.shape.disc`", "wrong.toml:21:18", "radius = ..."],
    );
}

#[test]
fn text_that_is_not_toml_is_pointed_at() {
    let wanted = ["this is not TOML", "wrong.toml:26:", "numbers have a decimal point: 0.1"];
    refused("size = 0.1", "size = 0,1", &wanted);
}

#[test]
fn an_unknown_variant_is_refused_with_the_known_ones() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("wrong.toml"), RIGHT).unwrap();
    let said = alewife(directory.path(), &["check", "--no-mesh", "wrong.toml/slaw"]);
    assert_refused(&said, &["there is no variant `slaw`", "wrong.toml:50:", "`slow`?"]);
    assert_accepted(&alewife(directory.path(), &["check", "--no-mesh", "wrong.toml/slow"]));
}

#[test]
fn a_variant_that_is_wrong_is_found_from_its_case() {
    refused(
        "\"numbers.reynolds\" = 2.0",
        "\"numbers.reynolds\" = 3.0",
        &["in variant wrong.toml/slow", "declared as 3", "wrong.toml:52:"],
    );
}

#[test]
fn a_wrong_setting_is_refused() {
    let refused = |setting: &str, wanted: &[&str]| {
        assert_refused(&check(RIGHT, &["--set", setting]), wanted);
    };
    refused(
        "fluid.viscocity=2",
        &["unknown key `viscocity`", "--> --set:1:1", "did you mean `viscosity`?"],
    );
    refused("body.1.center=[1, 1]", &["there is no `body.1`", "`body` has 1 of them"]);
    refused("fluid.viscosity", &["sets nothing", "--set KEY=VALUE"]);
    refused("fluid.viscosity=-1", &["must be positive", "--> --set:1:17"]);
}

#[test]
fn settings_reach_into_arrays_and_take_words_without_quotes() {
    let said = check(RIGHT, &["--set", "body.0.center.0=0.3", "--set", "fluid.model=stokes"]);
    assert_accepted(&said);
    assert!(said.stdout.contains("at [0.3, 0.2]"), "{}", said.stdout);
    assert!(said.stdout.contains("Stokes, viscosity"), "{}", said.stdout);
}

#[test]
fn a_file_extends_another_one_for_one_level() {
    let directory = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text).unwrap();
    let check = |name: &str| alewife(directory.path(), &["check", "--no-mesh", name]);
    let child = "extends = \"base.toml\"\n[fluid]\nviscosity = 0.002\n[numbers]\nreynolds = 10\n";
    write("base.toml", RIGHT);
    write("child.toml", child);
    write("grandchild.toml", "extends = \"child.toml\"\n");
    write("orphan.toml", "extends = \"bass.toml\"\n");

    let said = check("child.toml");
    assert_accepted(&said);
    assert!(said.stdout.contains("viscosity 0.002, density 1"), "{}", said.stdout);
    assert!(said.stdout.contains("none: the result is not compared"), "{}", said.stdout);
    assert_refused(&check("grandchild.toml"), &["child.toml:1:1", "one level of `extends`"]);
    assert_refused(&check("orphan.toml"), &["orphan.toml:1:11", "there is no file bass.toml"]);

    write("base.toml", &edited("density = 1.0", "densty = 1.0"));
    assert_refused(&check("child.toml"), &["base.toml:7:1", "`density`?"]);
}

#[test]
fn what_is_not_there_is_exit_code_66() {
    let directory = tempfile::tempdir().unwrap();
    let said = alewife(directory.path(), &["check", "absent.toml"]);
    assert_eq!(said.code, 66, "{}", said.stderr);
    let said = alewife(directory.path(), &["show", "squirmer-alon"]);
    assert_eq!(said.code, 66);
    assert!(said.stderr.contains("did you mean one of `squirmer-alone`"), "{}", said.stderr);
}

#[test]
fn usage_is_exit_code_2() {
    let directory = tempfile::tempdir().unwrap();
    assert_eq!(alewife(directory.path(), &["fly"]).code, 2);
    assert_eq!(alewife(directory.path(), &["run"]).code, 2);
}

#[test]
fn variants_have_names_that_can_be_asked_for() {
    let slow = "name = \"slow\"";
    for (name, why) in [
        ("\"\"", "it is empty"),
        ("\"a/b\"", "it has a slash"),
        ("'a\\b'", "it has a slash"),
        ("\"a\\nb\"", "a control character"),
        ("\"..\"", "stands for a directory"),
        (&format!("\"{}\"", "n".repeat(65)), "65 characters, more than 64"),
    ] {
        let wanted = ["cannot be the name of a variant", why, "wrong.toml:51:8"];
        refused(slow, &format!("name = {name}"), &wanted);
    }
    let twice = "name = \"slow\"\n\n[[variant]]\nname = \"slow\"";
    refused(slow, twice, &["\"slow\" is taken by a variant above", "wrong.toml:54:8"]);
}

/// Checks a file of these bytes.
fn check_bytes(name: &str, bytes: &[u8]) -> super::Said {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join(name), bytes).unwrap();
    alewife(directory.path(), &["check", "--no-mesh", name])
}

#[test]
fn what_is_no_file_of_text_is_refused_at_once() {
    let mut latin = RIGHT.as_bytes().to_vec();
    let at = RIGHT.find("disc in").unwrap();
    latin[at] = 0xe9;
    let said = check_bytes("wrong.toml", &latin);
    assert_refused(
        &said,
        &["wrong.toml is not text in UTF-8: byte 12 (in line 1) is 0xE9", "save"],
    );
    assert!(said.stderr.contains("iconv -f latin1 -t utf-8"), "{}", said.stderr);
    let words = RIGHT.encode_utf16().flat_map(u16::to_le_bytes);
    let said =
        check_bytes("wrong.toml", &[0xff, 0xfe].into_iter().chain(words).collect::<Vec<_>>());
    assert_refused(&said, &["byte 1 (in line 1) is 0xFF", "iconv -f utf-16 -t utf-8"]);
    let long = vec![b'#'; 16_000_001];
    assert_refused(
        &check_bytes("long.toml", &long),
        &["long.toml has 16.0 MB, more than the 16 MB"],
    );
    assert_refused(
        &check_bytes("..toml", RIGHT.as_bytes()),
        &["the name \".\"", "rename the file"],
    );
    let directory = tempfile::tempdir().unwrap();
    std::fs::create_dir(directory.path().join("d.toml")).unwrap();
    let said = alewife(directory.path(), &["check", "d.toml"]);
    assert_refused(&said, &["d.toml is a directory, not a file"]);
    #[cfg(unix)]
    {
        let said = alewife(directory.path(), &["check", "/dev/zero"]);
        assert_refused(&said, &["/dev/zero is a pipe or a device, not a file"]);
        let made =
            std::process::Command::new("mkfifo").arg(directory.path().join("p.toml")).status();
        assert!(made.unwrap().success());
        let said = alewife(directory.path(), &["check", "p.toml"]);
        assert_refused(&said, &["p.toml is a pipe or a device, not a file"]);
    }
}

#[test]
fn an_unknown_case_leads_to_a_few_and_to_the_list() {
    let directory = tempfile::tempdir().unwrap();
    let said = alewife(directory.path(), &["check", "squirmer-alon"]);
    assert_eq!(said.code, 66);
    assert!(said.stderr.contains("`squirmer-alone`"), "{}", said.stderr);
    assert!(said.stderr.contains("`alewife list`"), "{}", said.stderr);
    assert!(said.stderr.len() < 250, "{}", said.stderr);
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_an_error() {
    for arguments in [["list", "--long"], ["check", "squirmer-alone"], ["show", "squirmer-alone"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let said = std::process::Command::new(env!("CARGO_BIN_EXE_alewife"))
            .args(arguments)
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(said.status.code(), Some(74), "{arguments:?}");
        assert!(String::from_utf8_lossy(&said.stderr).contains("cannot write standard output"));
    }
}

#[test]
fn control_characters_of_a_file_stay_off_the_terminal() {
    let said = check(&edited("A disc in", "A \\u001b[31mdisc\\n in"), &[]);
    assert_accepted(&said);
    assert!(said.stdout.contains("A \\u{1b}[31mdisc in a channel"), "{}", said.stdout);
    let said = check(&edited("name = \"disc\"", "name = \"\\u001bdisc\""), &[]);
    assert_refused(&said, &["\"\\u{1b}disc\" cannot be a name"]);
    // What is wrong may be shown, too
    let directory = tempfile::tempdir().unwrap();
    let text = edited("name = \"disc\"", "name = \"\\u001bdisc\"")
        .replace("quantity = \"", "quantity = \"\\u001b");
    std::fs::write(directory.path().join("wrong.toml"), text).unwrap();
    let shown = alewife(directory.path(), &["show", "wrong.toml"]).stdout;
    for name in ["\\u{1b}disc: disc of radius", "\\u{1b}disc.drag_coefficient ="] {
        assert!(shown.contains(name), "{name} is not in:\n{shown}");
    }
    assert!(!shown.contains('\u{1b}'), "{shown:?}");
}

#[test]
fn many_diagnostics_are_cut_short_and_errors_come_first() {
    let boxes: String = (0..50)
        .map(|_| "[[mesh.box]]\nmin = [9.0, 9.0]\nmax = [10.0, 10.0]\nsize = 0.1\n")
        .collect();
    let text = edited("[time.steady]", &format!("{boxes}[time.steady]"));
    let said = check(&text, &[]);
    assert_accepted(&said);
    assert_eq!(said.stderr.matches("warning:").count(), 20);
    assert!(said.stderr.contains("... and 30 more warnings"), "{}", said.stderr);
    let said = check(&text, &["--set", "fluid.viscosity=-1"]);
    assert_refused(&said, &["must be positive"]);
    assert!(said.stderr.starts_with("error:"), "{}", said.stderr);
}

#[test]
fn a_key_given_twice_is_to_be_given_once() {
    refused(
        "density = 1.0",
        "density = 1.0\ndensity = 2.0",
        &["duplicate key", "keep one of the two"],
    );
}

/// Coefficients of a calibration that are wrong are told where they stand, whoever names their file.
#[test]
fn what_is_wrong_in_a_calibrated_file_is_told_at_its_line() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("found.toml");
    let text = "reduced.loads = 'links'\n[calibrated]\nbodies = []\n[reduced.coefficients]\nadded_mass = -1.0\n";
    std::fs::write(&path, text).unwrap();
    let settings = [
        "reduced.loads='links'".to_owned(),
        format!("reduced.calibrated.file='{}'", path.display()),
    ];
    let file = alewife::case::Case::read("robot-eel", &settings).unwrap();
    let found = alewife::case::check(&file);
    let found = found.iter().find(|one| one.key == "reduced.coefficients.added_mass").unwrap();
    let at = found.location.clone().unwrap();
    assert_eq!((at.file, at.line), (path.display().to_string(), 5), "{}", found.message);
}

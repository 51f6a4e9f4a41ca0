//! A case whose joints move as a file says stands for itself once it is read.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

use std::fs;
use std::path::Path;

use alewife_case::{Case, CaseError, JointKind, data_elsewhere};

const CASE: &str = r#"
title = "a robot"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.disc.radius = 5.0
boundary.wall = "no-slip"
mesh = { size = 0.5 }
time.unsteady = { step = 0.1, end = 1.0 }
[[swimmer]]
name = "robot"
[swimmer.kind.chain]
links = [[0.4, 0.1], [0.4, 0.1]]
gap = 0.2
joints = [{ bent.angle.file = { path = "../log.csv", time = "t", column = "q" } }]
"#;

fn read(path: &Path, settings: &[&str]) -> Case {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    Case::read(path.to_str().unwrap(), &settings).unwrap().model.case
}

#[test]
fn the_values_of_a_file_become_part_of_the_case() {
    let directory = tempfile::tempdir().unwrap();
    let [cases, others] = ["cases", "others/deeper"].map(|name| directory.path().join(name));
    fs::create_dir_all(&cases).unwrap();
    fs::create_dir_all(&others).unwrap();
    let log = directory.path().join("log.csv");
    fs::write(&log, "t,q,r\n0,0.0,0.0\n0.4,0.3,0.1\n0.7,0.1,0.2\n1,-0.2,0.3\n").unwrap();
    let path = cases.join("robot.toml");
    fs::write(&path, CASE).unwrap();
    let case = read(&path, &[]);

    // A file is found from the text that names it, also where another one extends that
    let child = others.join("child.toml");
    let parent = path.to_str().unwrap();
    fs::write(&child, format!("extends = '{parent}'\ntitle = \"another\"\n")).unwrap();
    assert_eq!(read(&child, &[]).swimmer, case.swimmer);

    // Another column, and another value, are another problem
    let keys = case.problem_keys().unwrap();
    let key = "swimmer.0.kind.chain.joints.0.bent.angle";
    let other = read(&path, &[&format!("{key}.file.column=r")]).problem_keys().unwrap();
    let differ: Vec<&String> = keys.keys().filter(|key| keys[*key] != other[*key]).collect();
    assert_eq!(differ, [&format!("{key}.cubic")]);

    // Nothing of the file is needed when the case is read back
    let text = case.to_toml().unwrap();
    fs::remove_file(&log).unwrap();
    let back = Case::parse("case.toml", &text, &[]).unwrap().model;
    assert_eq!(back.case, case);
    let JointKind::Bent { angle, .. } = &back.joints[0].kind else { panic!("{:?}", back.joints) };
    for (time, value) in [(0.0, 0.0), (0.4, 0.3), (0.7, 0.1), (1.0, -0.2)] {
        assert!((angle.at(time)[0] - value).abs() < 1e-14);
    }
    // Rates are continuous, and so are their slopes
    for knot in [0.4, 0.7] {
        let rate = |time: f64| angle.at(time)[1];
        let slopes = [rate(knot) - rate(knot - 1e-6), rate(knot + 1e-6) - rate(knot)];
        assert!(slopes.iter().all(|slope| slope.abs() < 1e-4), "{slopes:?}");
        assert!((slopes[0] - slopes[1]).abs() < 1e-9, "{slopes:?}");
    }
}

#[test]
fn a_field_follows_a_file() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("field.toml");
    fs::write(directory.path().join("log.csv"), "t,b\n0,0.0\n0.5,2.0\n1,1.0\n").unwrap();
    let text = r#"
title = "a magnet"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.disc.radius = 5.0
boundary.wall = "no-slip"
mesh = { size = 0.5 }
time.unsteady = { step = 0.02, end = 1.0 }
field.magnetic.components = [{ file = { path = "log.csv", time = "t", column = "b" } }, { constant = 1.0 }]
[[body]]
name = "disc"
shape.disc.radius = 1.0
center = [0.0, 0.0]
motion = "free"
magnetic_moment = [1.0, 0.0]
"#;
    fs::write(&path, text).unwrap();
    let case = read(&path, &[]);
    let field = case.magnetic_field().unwrap();
    assert_eq!(field.components[0].at(0.5)[0], 2.0);
    assert!(case.problem_keys().unwrap().contains_key("field.magnetic.components.0.cubic"));
}

/// A value of a column `q` is sign * scale * q + offset, in the unit of the column.
#[test]
fn angles_of_a_file_have_unit_sign_scale_and_offset() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("robot.toml");
    fs::write(directory.path().join("log.csv"), "t,q\n0,0\n0.5,20\n1,10\n").unwrap();
    let with = |more: &str| {
        let text = CASE.replace("../log.csv", "log.csv");
        fs::write(&path, text.replace("column = \"q\"", &format!("column = \"q\", {more}")))
            .unwrap();
        Case::read(path.to_str().unwrap(), &[])
    };
    let angle = |more: &str, time: f64| {
        let model = with(more).unwrap().model;
        let JointKind::Bent { angle, .. } = &model.joints[0].kind else { panic!("{more}") };
        angle.at(time)[0]
    };
    for (more, time, exact) in [
        ("scale = 0.01", 0.5, 0.2),
        ("unit = \"deg\"", 1.0, 10_f64.to_radians()),
        ("unit = \"deg\", sign = -1, scale = 0.5, offset = 3", 0.5, -7_f64.to_radians()),
        ("unit = \"turn\", scale = 0.01", 1.0, 0.1 * std::f64::consts::TAU),
    ] {
        let error = angle(more, time) - exact;
        assert!(error.abs() < 1e-15, "{more}: {error:e}");
    }
    for (more, said) in [
        ("sign = 2", ["`sign` is 2", "scale"]),
        ("unit = \"grad\"", ["grad", "deg"]),
        ("factor = 2", ["factor", "scale"]),
    ] {
        let message = with(more).unwrap_err().to_string();
        assert!(said.iter().all(|part| message.contains(part)), "{more}: {message}");
    }
}

/// The stroke of the first joint of the case with a file, and with other keys in `file`.
fn with_file(rows: &str, more: &str) -> Result<alewife_case::CaseFile, String> {
    with_case(CASE, rows, more)
}

fn with_case(case: &str, rows: &str, more: &str) -> Result<alewife_case::CaseFile, String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("robot.toml");
    fs::write(directory.path().join("log.csv"), rows).unwrap();
    let text = case.replace("../log.csv", "log.csv");
    fs::write(&path, text.replace("column = \"q\"", &format!("column = \"q\"{more}"))).unwrap();
    Case::read(path.to_str().unwrap(), &[]).map_err(|error| error.to_string())
}

fn first_angle(file: &alewife_case::CaseFile, time: f64) -> [f64; 2] {
    let JointKind::Bent { angle, .. } = &file.model.joints[0].kind else { panic!("is bent") };
    angle.at(time)
}

/// All that is said of a case, one below the other.
fn said(file: &alewife_case::CaseFile) -> String {
    let found = alewife_case::check(file);
    found.iter().map(|one| format!("{}: {} {}\n", one.key, one.message, one.help)).collect()
}

#[test]
fn a_file_of_one_period_comes_again() {
    use std::f64::consts::TAU;
    let rows = |n: u32, unit: f64| {
        let row = |i: u32| {
            let time = 0.25 * f64::from(i) / f64::from(n);
            format!("{},{}\n", (time + 3.0) / unit, 0.3 * (TAU * time / 0.25).sin())
        };
        "t,q\n".to_owned() + &(0..=n).map(row).collect::<String>()
    };
    // From another time, in milliseconds, with and without the row that closes it
    let closed = with_file(&rows(40, 1e-3), ", time_scale = 1e-3, time_offset = -3, period = 0.25");
    let closed = closed.unwrap();
    let open = rows(40, 1e-3);
    let open = open.trim_end().rsplit_once('\n').unwrap().0;
    let open = with_file(open, ", time_scale = 1e-3, time_offset = -3, period = 0.25").unwrap();
    for time in [0.0, 0.01, 0.13, 0.24, 0.25, 0.61, 1.0, 37.4] {
        let exact = 0.3 * (TAU * time / 0.25).sin();
        for file in [&closed, &open] {
            assert!((first_angle(file, time)[0] - exact).abs() < 1e-5, "{time}");
        }
    }
    // Neither value nor rate jumps where it begins again
    let [before, after] = [0.25 - 1e-9, 0.25 + 1e-9].map(|time| first_angle(&closed, time));
    assert!((before[0] - after[0]).abs() < 1e-7 && (before[1] - after[1]).abs() < 1e-5);
    assert!(said(&closed).lines().all(|line| !line.contains("its times")), "{}", said(&closed));
    // It stands for itself when it is read back
    let back = Case::parse("case.toml", &closed.case().to_toml().unwrap(), &[]).unwrap();
    assert_eq!(back.case(), closed.case());
    let JointKind::Bent { angle, .. } = &back.model.joints[0].kind else { panic!("is bent") };
    assert_eq!(angle.period(), Some(0.25));
}

#[test]
fn what_is_no_period_is_refused_where_it_stands() {
    let rows = "t,q\n0,0\n0.1,0.2\n0.2,-0.1\n0.3,0.9\n";
    for (more, parts) in [
        (", period = 0.2", ["`period` is 0.2", "from 0 to 0.3"]),
        (", period = 0.3, scale = -1", ["`period` of 0.3", "-0.9"]),
        (", period = 0", ["period` is 0", "positive"]),
        (", time_scale = -1", ["time_scale` is -1", "positive"]),
        (", period = 'long'", ["period", "long"]),
        (", time_unit = 'ms'", ["time_unit", "time_scale"]),
    ] {
        // The last value is as far from the first one as no two rows are
        let rows = if more.contains("0.3") { rows.replace("-0.1", "0.4") } else { rows.to_owned() };
        let error = with_file(&rows, more).unwrap_err();
        assert!(error.contains("robot.toml:14"), "{error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{more}: {error}");
    }
}

#[test]
fn a_clock_in_another_unit_is_asked_about() {
    // 2 s at 100 Hz, of which a run of 1 s takes the half
    let rows = |unit: f64, name: &str| {
        let row = |i: u32| format!("{},{}\n", f64::from(i) * 0.01 / unit, f64::from(i % 7) * 0.01);
        format!("{name},q\n") + &(0..=200).map(row).collect::<String>()
    };
    let asks =
        |rows: &str, more: &str| said(&with_file(rows, more).unwrap()).contains("time_scale");
    assert!(!asks(&rows(1.0, "t"), ""));
    assert!(asks(&rows(1e-3, "t"), "") && asks(&rows(1e-6, "t"), ""));
    let message = said(&with_file(&rows(1e-6, "t"), "").unwrap());
    assert!(message.contains("time_scale = 1e-6") && message.contains("201 rows"), "{message}");
    assert!(!asks(&rows(1e-3, "t"), ", time_scale = 1e-3"), "it is said");
    assert!(!asks(&rows(1e-3, "t"), ", time_scale = 1"), "it is meant so");
    // Long, and as fine as the steps
    let long: String = (0..=20_000).map(|i| format!("{},0\n", f64::from(i) * 0.1)).collect();
    assert!(!asks(&("t,q\n".to_owned() + &long), ""));
    // By its name, whatever its length
    let named = CASE.replace("time = \"t\"", "time = \"t_ms\"");
    let by_name = |case: &str| said(&with_case(case, &rows(1e-3, "t_ms"), "").unwrap());
    assert!(by_name(&named).contains("`t_ms`") && by_name(&named).contains("0.001"));
    let in_ms = named.replace("title =", "units = { time = \"ms\" }\ntitle =");
    let in_ms = in_ms.replace("step = 0.1, end = 1.0", "step = 100, end = 1000");
    assert!(!by_name(&in_ms).contains("time_scale"), "{}", by_name(&in_ms));
    // One that does not cover the run is refused with the ways
    let short = said(&with_file("t,q\n0,0\n0.5,0.1\n", "").unwrap());
    assert!(short.contains("`period`") && short.contains("time_scale"), "{short}");
    let late = said(&with_file("t,q\n1700,0\n1702,0.1\n", "").unwrap());
    assert!(late.contains("time_offset = -1700"), "{late}");
}

#[test]
fn angles_in_degrees_are_asked_about_by_how_they_swing() {
    let asks = |case: &str, rows: &str, more: &str| {
        said(&with_case(case, rows, more).unwrap()).contains(" deg")
    };
    // 5 degrees to either side are no turn, and no joint is bent so far by so many radians
    let wave = |amplitude: f64| {
        let row = |i: u32| {
            let time = f64::from(i) * 0.02;
            format!("{time},{}\n", amplitude * (12.0 * time).sin())
        };
        "t,q\n".to_owned() + &(0..=50).map(row).collect::<String>()
    };
    assert!(asks(CASE, &wave(5.0), "") && !asks(CASE, &wave(3.0), ""));
    assert!(
        !asks(CASE, &wave(5.0), ", unit = \"rad\"") && !asks(CASE, &wave(5.0), ", unit = \"deg\"")
    );
    let named = CASE.replace("column = \"q\"", "column = \"q\", column = \"q_deg\"");
    let named = named.replace("column = \"q\", ", "");
    let file = |more: &str| {
        let case = named.replace("\"q_deg\"", &format!("\"q_deg\"{more}"));
        with_case(&case, &wave(1.0).replace("t,q", "t,q_deg"), "").unwrap()
    };
    assert!(said(&file("")).contains("by its name in degrees"), "{}", said(&file("")));
    assert!(!said(&file(", unit = \"rad\"")).contains("degrees"));
}

/// Of one that is not there it is told where it is from; what is written of the case names none.
#[test]
fn files_that_do_not_come_with_a_case_are_looked_for_first() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("cases/robot.toml");
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    let data = "[data]\nfiles = [\"../log.csv\"]\nsource = \"a server\"\n";
    fs::write(&path, format!("{CASE}{data}")).unwrap();
    let error = Case::read(path.to_str().unwrap(), &[]).unwrap_err();
    assert!(matches!(error, CaseError::Elsewhere(_)), "{error}");
    let said = error.to_string();
    assert!(said.contains("`../log.csv` does not come with the case"), "{said}");
    assert!(said.contains("robot.toml:16") && said.contains("it is from a server"), "{said}");
    assert_eq!(data_elsewhere(path.to_str().unwrap()).map(|it| it.to_string()), Some(said));

    let two = data.replace("log.csv\"", "log.csv\", \"far.csv\"");
    fs::write(&path, format!("{CASE}{two}")).unwrap();
    let said = Case::read(path.to_str().unwrap(), &[]).unwrap_err().to_string();
    assert!(said.contains("; nor are `far.csv`"), "{said}");
    fs::write(&path, format!("{CASE}{data}")).unwrap();
    fs::create_dir(directory.path().join("log.csv")).unwrap();
    let said = Case::read(path.to_str().unwrap(), &[]).unwrap_err().to_string();
    assert!(said.contains("is a folder there and no file"), "{said}");
    fs::remove_dir(directory.path().join("log.csv")).unwrap();

    fs::write(directory.path().join("log.csv"), "t,q\n0,0.0\n0.5,0.2\n1,0.1\n").unwrap();
    assert!(data_elsewhere(path.to_str().unwrap()).is_none());
    let text = read(&path, &[]).to_toml().unwrap();
    assert!(text.contains("files = []") && text.contains("a server"), "{text}");
}

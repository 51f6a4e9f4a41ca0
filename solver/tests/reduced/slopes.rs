//! Derivatives of reduced motions by numbers of their cases, and optima of gaits.

use alewife::case::{Case, CaseFile, WrittenNumber, check, check_starts};
use alewife::gradient::NumberedCase;
use alewife::optimise::FlowSearch;
use alewife::reduced::{MotionByNumbers, SlopeError, simulate};

use super::last;

/// Part of a derivative, of the quantity over the number where that is more, by which differences may be off.
const CLOSE: f64 = 1e-6;

/// A number of a case: keys that are it, and those that are 1 over it.
struct Number<'a> {
    keys: &'a [&'a str],
    inverse: &'a [&'a str],
    factors: &'a [f64],
    start: f64,
}

/// Keys that are the number.
fn plain<'a>(keys: &'a [&'a str], start: f64) -> Number<'a> {
    Number { keys, inverse: &[], factors: &[], start }
}

impl Number<'_> {
    fn written(&self, value: f64) -> Vec<WrittenNumber> {
        let keys = self.keys.iter().map(|key| (key, value));
        let inverse = self.inverse.iter().zip(self.factors).map(|(key, by)| (key, by / value));
        let written = |(key, value): (&&str, f64)| WrittenNumber { path: (*key).to_owned(), value };
        keys.chain(inverse).map(written).collect()
    }
}

fn at(file: &CaseFile, numbers: &[Number<'_>], values: &[f64]) -> CaseFile {
    let all = numbers.iter().zip(values);
    let all: Vec<WrittenNumber> = all.flat_map(|(one, value)| one.written(*value)).collect();
    file.with_numbers(&all).unwrap()
}

/// Compares derivatives with differences of fourth order of whole motions over real numbers. Drag by |v| v has jumps in its
/// second derivative, so that steps are small: those of 1e-4 were off by up to 3.4e-6.
fn compare(file: &CaseFile, numbers: &[Number<'_>], of: &[&str]) {
    let of: Vec<String> = of.iter().map(|name| (*name).to_owned()).collect();
    let values: Vec<f64> = numbers.iter().map(|one| one.start).collect();
    let sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    let case = |values: &[f64]| Ok(at(file, numbers, values));
    let numbered = NumberedCase { case: &case, of: &of, sizes: &sizes };
    let found = MotionByNumbers.at(&numbered, &values).unwrap();
    let ends = |values: &[f64]| {
        let series = simulate(&at(file, numbers, values).model).unwrap();
        of.iter().map(|name| last(&series, name)).collect::<Vec<f64>>()
    };
    let plain = ends(&values);
    for nth in 0..numbers.len() {
        let step = 1e-5 * sizes[nth];
        let beside = [-2.0, -1.0, 1.0, 2.0].map(|places| {
            let mut values = values.clone();
            values[nth] += places * step;
            ends(&values)
        });
        for (k, one) in found.iter().enumerate() {
            let [a, b, c, d] = [0, 1, 2, 3].map(|at| beside[at][k]);
            let slope = (a - 8.0 * b + 8.0 * c - d) / (12.0 * step);
            let size = slope.abs().max(plain[k].abs() / sizes[nth]);
            let off = (one.by[nth] - slope).abs() / size;
            assert!(
                off < CLOSE,
                "{} by number {nth}: {:e}, {slope:e}, off {off:e}",
                one.of,
                one.by[nth]
            );
            assert!((one.value - plain[k]).abs() <= 1e-12 * plain[k].abs(), "{}", one.of);
        }
    }
}

const SINES: [&str; 2] = [
    "swimmer.0.kind.chain.joints.0.bent.angle.sine",
    "swimmer.0.kind.chain.joints.1.bent.angle.sine",
];

#[test]
fn derivatives_of_an_eel_by_gait_coefficients_and_frequency_are_those_of_differences() {
    let file = Case::read("eel-calibration", &[]).unwrap();
    let keys: Vec<String> = SINES
        .iter()
        .flat_map(|sine| ["period", "ramp"].map(|what| format!("{sine}.{what}")))
        .collect();
    let mut inverse: Vec<&str> =
        vec!["swimmer.0.period", "time.unsteady.step", "time.unsteady.end"];
    inverse.extend(keys.iter().map(String::as_str));
    let [phase, amplitude] = ["phase", "amplitude"].map(|what| format!("{}.{what}", SINES[1]));
    let coefficients = ["added_mass", "normal_quadratic", "tangential_quadratic"]
        .map(|name| format!("reduced.coefficients.{name}"));
    compare(
        &file,
        &[
            // Of two seconds, with steps of a two-hundredth and two cycles
            Number {
                keys: &[],
                inverse: &inverse,
                factors: &[1.0, 0.005, 2.0, 1.0, 0.5, 1.0, 0.5],
                start: 0.5,
            },
            plain(&[&phase], 0.25),
            plain(&[&amplitude], 0.5),
            plain(&[&coefficients[0]], 1.0),
            plain(&[&coefficients[1]], 2.0),
            plain(&[&coefficients[2]], 0.2),
        ],
        &[
            "eel.x",
            "eel-1.y",
            "eel-3.angle",
            "eel.cycle.speed",
            "eel.cycle.power",
            "eel.cycle.cost_of_transport",
            "eel.cycle.angle",
        ],
    );
}

#[test]
fn derivatives_in_space_and_without_inertia_are_those_of_differences() {
    let fish = Case::read("tendon-fish", &["time.unsteady.end=0.2".to_owned()]).unwrap();
    let stiffness: Vec<String> =
        (1..6).map(|nth| format!("joint.{nth}.kind.hinge.stiffness")).collect();
    let stiffness: Vec<&str> = stiffness.iter().map(String::as_str).collect();
    compare(
        &fish,
        &[
            plain(&["reduced.coefficients.slender"], 7.79),
            plain(&["reduced.coefficients.kutta"], 3.84),
            plain(&["reduced.servo.0.rate"], 4.7),
            plain(&stiffness, 0.65),
        ],
        &["head.x", "head.y", "tail4.x"],
    );
    let settings =
        ["reduced.loads=resistive", "reduced.coefficients={ along = 1.0, across = 1.8 }"];
    let purcell = Case::read("purcell-three-link", &settings.map(str::to_owned)).unwrap();
    let name = purcell.model.bodies[0].name.clone();
    let of = format!("{name}.x");
    compare(&purcell, &[plain(&["reduced.coefficients.across"], 1.8)], &[&of]);
}

#[test]
fn a_number_that_changes_bodies_has_no_derivative_and_that_is_said() {
    let file = Case::read("eel-calibration", &[]).unwrap();
    let of = ["eel.x".to_owned()];
    for (key, start, what) in [
        ("swimmer.0.kind.chain.gap", 0.01, "masses, shapes or places"),
        ("time.unsteady.step", 0.01, "how many steps"),
        ("time.unsteady.end", 4.0, "how many steps"),
    ] {
        let keys = [key];
        let number = [plain(&keys, start)];
        let case = |values: &[f64]| Ok(at(&file, &number, values));
        let numbered = NumberedCase { case: &case, of: &of, sizes: &[start] };
        let error = MotionByNumbers.at(&numbered, &[start]).unwrap_err();
        assert!(matches!(error, SlopeError::Number { nth: 0, .. }), "{key}: {error}");
        assert!(error.to_string().contains(what), "{key}: {error}");
    }
}

#[test]
fn the_gait_of_an_eel_that_is_found_is_that_of_a_sweep_and_goes_on_with_the_same_bits() {
    let file = Case::read("eel-gait", &[]).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let search = || FlowSearch::new(&file).unwrap().seek(directory.path(), &mut |_| ()).unwrap();
    let found = search();
    let [frequency, lag] = [found.found.best.values[0], found.found.best.values[1]];
    // Around the optimum the objective is smaller, each time by a motion over real numbers
    let value = |values: [f64; 2]| {
        let written = alewife::case::numbers_at(&file.sought(), &file.case().define, &values);
        let series = simulate(&file.with_numbers(&written.unwrap()).unwrap().model).unwrap();
        last(&series, "eel.cycle.speed")
            / (last(&series, "eel.cycle.power") + file.case().define["idle"])
    };
    let best = value([frequency, lag]);
    assert!((best / found.objective - 1.0).abs() < 1e-12, "{best} {}", found.objective);
    for (by, other) in
        [(1.05, 1.0), (0.95, 1.0), (1.0, 1.05), (1.0, 0.95), (1.05, 1.05), (0.95, 0.95)]
    {
        let beside = value([frequency * by, lag * other]);
        assert!(beside < best, "{by} {other}: {beside} {best}");
    }
    // What the last evaluations were is computed again, to the same bits
    let journal = directory.path().join("round-1.journal");
    let whole = std::fs::read_to_string(&journal).unwrap();
    let kept: Vec<&str> = whole.lines().take(4).collect();
    std::fs::write(&journal, kept.join("\n") + "\n0.1 0.2").unwrap();
    assert_eq!(search().found.best, found.found.best);
    assert_eq!(std::fs::read_to_string(&journal).unwrap(), whole);
}

#[test]
fn what_a_search_of_a_gait_cannot_do_is_told_with_its_key() {
    let read = |setting: &str| {
        let settings = [setting.to_owned(), "optimisation.reference=[]".to_owned()];
        Case::read("eel-gait", &settings).unwrap()
    };
    let parameter = |key: &str, bounds: &str| {
        format!(
            "optimisation.parameter.1={{ name = 'other', keys = ['{key}'], bounds = {bounds} }}"
        )
    };
    // What only the models of the case show
    let file = read(&parameter("swimmer.0.kind.chain.gap", "[0.1, 0.2]"));
    assert!(check(&file).is_empty(), "{:?}", check(&file));
    let place = tempfile::tempdir().unwrap();
    let error = FlowSearch::new(&file).unwrap().seek(place.path(), &mut |_| ()).unwrap_err();
    let told = error.to_string();
    for words in ["\"other\"", "masses, shapes or places", "numbers of gaits"] {
        assert!(told.contains(words), "{told}");
    }
    let quantity = |name: &str| format!("optimisation.objective.expression.quantities.u='{name}'");
    for (setting, key, words) in [
        (parameter("fluid.viscosity", "[0.05, 0.2]"), "keys.0", "by the reduced model change"),
        (parameter("swimmer.0.periot", "[0.5, 2.0]"), "keys.0", "did you mean `swimmer.0.period`"),
        (quantity("eel.cycle.lighthill_efficiency"), "quantities.u", "there is no quantity"),
        (quantity("eel.cycle.spead"), "quantities.u", "eel.cycle.speed"),
        ("time.unsteady.adaptive={}".to_owned(), "time.unsteady", "one length"),
    ] {
        let found = check(&read(&setting));
        let one = found.iter().find(|one| one.key.ends_with(key));
        let one = one.unwrap_or_else(|| panic!("{setting}: {found:?}")).to_string();
        assert!(one.contains(words), "{setting}: {one}");
    }
    let outside = check_starts(&read(&parameter("reduced.coefficients.added_mass", "[1.0, 2.0]")));
    assert!(outside[0].to_string().contains("not between its bounds"), "{outside:?}");
}

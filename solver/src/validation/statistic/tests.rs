//! Statistics of series whose values are known.

use std::f64::consts::TAU;

use super::*;

const CASE: &str = r#"
    title = "t"
    geometry = "planar"
    fluid = { model = "stokes", viscosity = 1.0 }
    domain = { disc = { radius = 1.0 } }
    mesh = { size = 1.0 }
    time = { steady = {} }
    scales = { length = 0.1, velocity = 2.0 }
    statistics = { phase_of = "b.lift" }
"#;

fn series(dt: f64, n: usize, columns: &[(&str, &dyn Fn(f64) -> f64)]) -> Series {
    let times: Vec<f64> = (0..=n).map(|i| i as f64 * dt).collect();
    Series {
        names: columns.iter().map(|(name, _)| (*name).to_owned()).collect(),
        rows: times
            .iter()
            .map(|time| columns.iter().map(|(_, value)| value(*time)).collect())
            .collect(),
        times,
    }
}

fn value(
    series: &Series,
    quantity: &str,
    kind: StatisticKind,
    window: Option<[f64; 2]>,
) -> Result<f64, StatisticError> {
    let mut case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
    case.statistics.window = window;
    measured_value(series, &case, &taken(quantity, kind))
}

fn taken(quantity: &str, kind: StatisticKind) -> Statistic {
    Statistic { quantity: quantity.to_owned(), kind, at: Some(0.33), ..Statistic::default() }
}

/// As `series`, with steps that grow threefold from the first to the last.
fn uneven(end: f64, n: usize, columns: &[(&str, &dyn Fn(f64) -> f64)]) -> Series {
    let mut run = series(1.0 / n as f64, n, columns);
    for (time, row) in run.times.iter_mut().zip(&mut run.rows) {
        *time = end * 0.5 * *time * (1.0 + *time);
        *row = columns.iter().map(|(_, value)| value(*time)).collect();
    }
    run
}

/// When `quantity`, less `minus`, is at a level.
fn crossing(
    run: &Series,
    [quantity, minus]: [&str; 2],
    level: f64,
    window: Option<[f64; 2]>,
) -> Result<f64, StatisticError> {
    let mut case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
    case.statistics.window = window;
    let minus = (!minus.is_empty()).then(|| minus.to_owned());
    let plain = taken(quantity, StatisticKind::Crossing);
    measured_value(run, &case, &Statistic { level: Some(level), minus, ..plain })
}

#[test]
fn a_parabola_is_met_exactly_between_steps() {
    let arch = series(0.1, 10, &[("q", &|t| 3.0 - (t - 0.47) * (t - 0.47))]);
    let of = |statistic| value(&arch, "q", statistic, None).unwrap();
    assert!((of(StatisticKind::Max) - 3.0).abs() < 1e-13);
    assert!((of(StatisticKind::At) - (3.0 - 0.14 * 0.14)).abs() < 1e-13);
    assert!((of(StatisticKind::Final) - (3.0 - 0.53 * 0.53)).abs() < 1e-13);
    let bowl = series(0.1, 10, &[("q", &|t| (t - 0.47) * (t - 0.47) - 3.0)]);
    assert!((value(&bowl, "q", StatisticKind::Min, None).unwrap() + 3.0).abs() < 1e-13);
}

#[test]
fn an_extremum_at_the_edge_of_the_window_is_taken_as_it_is() {
    let line = series(0.1, 10, &[("q", &|t| t)]);
    assert_eq!(value(&line, "q", StatisticKind::Max, Some([0.2, 0.5])), Ok(0.5));
    assert_eq!(value(&line, "q", StatisticKind::Min, Some([0.2, 0.5])), Ok(0.2));
}

#[test]
fn a_periodic_series_is_averaged_over_whole_periods() {
    // 3.3 periods, so that the plain average would be off by several per cent.
    let wave = series(0.01, 330, &[("q", &|t| 2.0 + (TAU * t + 0.4).sin())]);
    let mean = value(&wave, "q", StatisticKind::Mean, None).unwrap();
    assert!((mean - 2.0).abs() < 1e-5, "{mean}");
    let swing = series(0.01, 330, &[("q", &|t| (TAU * t + 0.4).sin())]);
    let rms = value(&swing, "q", StatisticKind::Rms, None).unwrap();
    assert!((rms - 0.5_f64.sqrt()).abs() < 1e-3, "{rms}");
}

#[test]
fn a_series_that_does_not_repeat_is_averaged_over_the_window() {
    let line = series(0.1, 10, &[("q", &|t| 4.0 * t)]);
    let mean = value(&line, "q", StatisticKind::Mean, Some([0.5, 1.0])).unwrap();
    assert!((mean - 3.0).abs() < 1e-13);
}

#[test]
fn the_strouhal_number_is_frequency_times_length_over_velocity() {
    let wave = series(0.013, 400, &[("q", &|t| 1.0 + (TAU * 2.5 * t).sin())]);
    let strouhal = value(&wave, "q", StatisticKind::Strouhal, None).unwrap();
    assert!((strouhal - 2.5 * 0.1 / 2.0).abs() < 1e-5, "{strouhal}");
    let line = series(0.1, 10, &[("q", &|t| t)]);
    let error = value(&line, "q", StatisticKind::Strouhal, None).unwrap_err();
    assert!(matches!(error, StatisticError::NoPeriod { .. }), "{error}");
}

#[test]
fn half_a_period_after_the_maximum_is_where_the_lift_is_lowest() {
    // Lift peaks at 0.1 + k; the pressure is a line there plus a wave of the same period.
    let lift = |t: f64| (TAU * (t - 0.1)).cos();
    let pressure = |t: f64| 5.0 + (TAU * (t - 0.1)).cos();
    let run = series(0.01, 400, &[("b.lift", &lift), ("p", &pressure)]);
    let found = value(&run, "p", StatisticKind::HalfPeriodAfterMax, None).unwrap();
    assert!((found - 4.0).abs() < 1e-4, "{found}");
}

#[test]
fn a_level_is_met_at_its_time_from_either_side() {
    let fall = |t: f64| 2.0 - t * t;
    let run =
        uneven(3.0, 17, &[("q", &fall), ("up", &|t| t * t - 2.0), ("half", &|t| 0.5 * t * t)]);
    for [quantity, minus] in [["q", ""], ["up", ""], ["up", "half"]] {
        let (level, wanted) = match minus {
            "" if quantity == "q" => (-0.5, 2.5_f64.sqrt()),
            "" => (0.5, 2.5_f64.sqrt()),
            // 1/2 t^2 - 2
            _ => (-1.0, 2.0_f64.sqrt()),
        };
        let time = crossing(&run, [quantity, minus], level, None).unwrap();
        assert!((time - wanted).abs() < 1e-12, "{quantity} {minus}: {time}");
    }
    // In a step at the beginning or the end of the run, and at a row of it.
    for wanted in [0.01, 2.95, run.times[6]] {
        let time = crossing(&run, ["q", ""], fall(wanted), None).unwrap();
        assert!((time - wanted).abs() < 1e-12, "{time} {wanted}");
    }
    assert_eq!(crossing(&run, ["q", ""], 2.0, None), Ok(0.0));
}

#[test]
fn only_what_happens_in_the_window_counts() {
    let wave = |t: f64| (TAU * t).sin();
    let run = uneven(3.0, 400, &[("q", &wave)]);
    let at = |level, window| crossing(&run, ["q", ""], level, Some(window));
    assert!((at(0.5, [0.3, 3.0]).unwrap() - 5.0 / 12.0).abs() < 1e-5);
    assert!((at(0.5, [0.5, 3.0]).unwrap() - 13.0 / 12.0).abs() < 1e-5);
    // The window may begin within the step that reaches the level.
    let line = series(0.4, 5, &[("q", &|t| t)]);
    let begun = crossing(&line, ["q", ""], 1.0, Some([0.9, 2.0])).unwrap();
    assert!((begun - 1.0).abs() < 1e-12, "{begun}");
    let error = at(1.5, [0.5, 1.5]).unwrap_err();
    let StatisticError::NotReached { level, lowest, highest, .. } = &error else {
        panic!("{error}")
    };
    assert_eq!(*level, 1.5);
    assert!(*lowest < -0.99 && *highest > 0.99, "{error}");
    assert!(at(0.5, [0.5, 0.9]).is_err());
}

#[test]
fn a_quantity_is_taken_when_another_reaches_a_level() {
    let run = uneven(2.0, 23, &[("y", &|t| 3.0 - t * t), ("x", &|t| 4.0 * t)]);
    let case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
    let plain = Statistic { level: Some(1.0), ..taken("x", StatisticKind::When) };
    assert!(measured_value(&run, &case, &plain).is_err());
    let when = Statistic { of: Some("y".to_owned()), ..plain };
    let x = measured_value(&run, &case, &when).unwrap();
    assert!((x - 4.0 * 2.0_f64.sqrt()).abs() < 1e-11, "{x}");
    // Less another quantity: 4 t - (3 - t^2), where t^2 = 2.
    let apart = Statistic { minus: Some("y".to_owned()), ..when.clone() };
    let x = measured_value(&run, &case, &apart).unwrap();
    assert!((x - 4.0 * 2.0_f64.sqrt() + 1.0).abs() < 1e-11, "{x}");
    let never = Statistic { level: Some(5.0), ..when };
    let error = measured_value(&run, &case, &never).unwrap_err();
    assert!(error.to_string().contains("`y` does not reach 5"), "{error}");
}

#[test]
fn the_range_is_from_trough_to_peak_in_the_window() {
    let run = uneven(2.0, 300, &[("q", &|t| 1.0 + 0.3 * (TAU * t + 0.2).sin())]);
    let range = value(&run, "q", StatisticKind::Range, None).unwrap();
    assert!((range - 0.6).abs() < 1e-6, "{range}");
    let line = series(0.1, 10, &[("q", &|t| -t)]);
    let range = value(&line, "q", StatisticKind::Range, Some([0.2, 0.5])).unwrap();
    assert!((range - 0.3).abs() < 1e-13, "{range}");
}

#[test]
fn a_difference_is_taken_before_its_statistic() {
    let run = series(
        0.01,
        100,
        &[("a", &|t| 5.0 * t), ("b", &|t| 5.0 * t - 1.0 + (t - 0.4) * (t - 0.4))],
    );
    let case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
    let minus = Some("b".to_owned());
    let largest = Statistic { minus, ..taken("a", StatisticKind::Max) };
    assert!((measured_value(&run, &case, &largest).unwrap() - 1.0).abs() < 1e-12);
    let unknown = Statistic { minus: Some("c".to_owned()), ..largest };
    let error = measured_value(&run, &case, &unknown).unwrap_err();
    assert_eq!(error, StatisticError::UnknownQuantity("c".to_owned()));
}

#[test]
fn morisons_coefficients_are_those_of_the_bodys_own_motion() {
    // D = 0.1 and rho = 2: F = -0.1 c_D |v| v - pi/200 c_I dv/dt
    let (v, a) = (|t: f64| (TAU * t).sin(), |t: f64| TAU * (TAU * t).cos());
    let force = |t: f64| -0.1 * 1.7 * v(t).abs() * v(t) - std::f64::consts::PI / 200.0 * 1.2 * a(t);
    let run = uneven(
        3.0,
        500,
        &[
            ("b.force.y", &force),
            ("b.velocity.y", &v),
            ("b.acceleration.y", &a),
            ("b.force.x", &force),
            ("b.velocity.x", &|_| 0.0),
            ("b.acceleration.x", &|_| 0.0),
        ],
    );
    let mut case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
    case.fluid.density = 2.0;
    case.statistics.window = Some([1.0, 3.0]);
    let of = |quantity, kind| measured_value(&run, &case, &taken(quantity, kind));
    let drag = of("b.force.y", StatisticKind::MorisonDrag).unwrap();
    let inertia = of("b.force.y", StatisticKind::MorisonInertia).unwrap();
    assert!((drag - 1.7).abs() < 1e-11 && (inertia - 1.2).abs() < 1e-11, "{drag} {inertia}");
    let error = of("b.force.x", StatisticKind::MorisonDrag).unwrap_err();
    assert!(matches!(error, StatisticError::NoOscillation { .. }), "{error}");
    assert!(of("b.velocity.y", StatisticKind::MorisonDrag).is_err());
}

#[test]
fn what_was_not_computed_is_an_error() {
    let line = series(0.1, 2, &[("q", &|t| t)]);
    assert!(value(&line, "r", StatisticKind::Final, None).is_err());
    assert!(value(&line, "q", StatisticKind::At, None).is_err());
    assert!(value(&line, "q", StatisticKind::Max, Some([5.0, 6.0])).is_err());
    // Of a window that the run has reached in part another value would come out
    let long = series(0.1, 20, &[("q", &|t| t)]);
    assert!(value(&long, "q", StatisticKind::Mean, Some([0.5, 1.5])).is_ok());
    assert!(value(&long, "q", StatisticKind::Mean, Some([1.5, 2.5])).is_err());
    assert!(value(&long, "q", StatisticKind::Final, Some([1.5, 2.5])).is_ok());
}

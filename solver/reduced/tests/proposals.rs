//! Searches by proposals: each method finds a minimum within bounds, and goes on with the same bits.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use alewife_interrupt::{Request, hearing, is_requested};
use alewife_reduced::search::{
    Bounded, Effort, Ended, External, HALVINGS, Journal, Method, Opened, Proposals, SearchError,
    propose,
};

fn bounded() -> Vec<Bounded> {
    let one = |name: &str, start: f64, lower: f64, upper: f64| Bounded {
        name: name.to_owned(),
        start,
        lower,
        upper,
        scale: None,
    };
    vec![one("a", 0.0, -2.0, 2.0), one("b", 60.0, 0.0, 100.0), one("c", 0.0, 0.0, 1.0)]
}

/// Least at a = 1, b = 30 and c at its lower bound, in a bent valley; it fails where a is below -1.5.
fn valley(values: &[f64]) -> f64 {
    let (a, b, c) = (values[0], values[1] / 30.0, values[2]);
    if a < -1.5 {
        return f64::NAN;
    }
    0.01 + (1.0 - a).powi(2) + 5.0 * (b - a * a).powi(2) + c
}

/// What a search has come to.
#[derive(Debug, PartialEq)]
struct Come {
    best: Vec<f64>,
    objective: f64,
    n_proposals: usize,
    n_accepted: usize,
    n_at_once: usize,
    n_made: usize,
    ended: Ended,
}

fn sought(method: Method<'_>, most: usize, journal: Option<&Path>) -> Result<Come, SearchError> {
    counting(method, most, journal, &mut || ())
}

/// The same, with something that is called at each evaluation.
fn counting(
    method: Method<'_>,
    most: usize,
    journal: Option<&Path>,
    count: &mut dyn FnMut(),
) -> Result<Come, SearchError> {
    let bounded = bounded();
    let mut n_made = 0;
    let mut evaluate = |values: &[f64]| {
        let is_within =
            bounded.iter().zip(values).all(|(one, v)| (one.lower..=one.upper).contains(v));
        assert!(is_within, "{values:?}");
        n_made += 1;
        count();
        // A motion that is asked to end has no value; not each look is a question
        if (0..100).any(|_| is_requested()) { f64::INFINITY } else { valley(values) }
    };
    let opened = journal.map(|path| Journal::open(path, "valley")).transpose()?;
    let (journal, known) =
        opened.map_or((None, Vec::new()), |Opened { journal, known }| (Some(journal), known));
    let effort = Effort { evaluations: most, halvings: HALVINGS };
    let mut proposals = Proposals::new(&bounded, effort, &mut evaluate, journal, known)?;
    let ended = propose(&mut proposals, method)?;
    let accepted = || proposals.all().iter().filter_map(|one| one.accepted);
    let mut come = Come {
        best: proposals.best().to_vec(),
        objective: proposals.objective(),
        n_proposals: proposals.all().len(),
        n_accepted: accepted().count(),
        n_at_once: accepted().filter(|part| *part >= 1.0).count(),
        n_made: 0,
        ended,
    };
    assert!(proposals.n_evaluations() <= most);
    come.n_made = n_made;
    Ok(come)
}

fn methods<'a>() -> [(&'static str, Method<'a>, f64); 3] {
    [
        ("random", Method::Random { seed: 3 }, 0.15),
        ("nelder-mead", Method::NelderMead, 1e-3),
        ("cma-es", Method::CmaEs { seed: 3 }, 5e-3),
    ]
}

#[test]
fn each_method_finds_the_minimum_and_says_what_was_accepted() {
    for (name, method, within) in methods() {
        let come = sought(method, 1500, None).unwrap();
        let [a, b, c] = [come.best[0], come.best[1], come.best[2]];
        let off = (a - 1.0).abs().max((b / 30.0 - 1.0).abs()).max(c);
        assert!(off < within, "{name}: {come:?}");
        assert!(come.objective < valley(&[0.0, 60.0, 0.0]), "{name}: {come:?}");
        assert!(come.n_at_once > 0 && come.n_accepted > come.n_at_once, "{name}: {come:?}");
        assert!(come.n_accepted < come.n_proposals && come.n_made <= 1500, "{name}: {come:?}");
    }
}

#[test]
fn a_search_that_was_stopped_goes_on_with_the_same_bits() {
    let place = tempfile::tempdir().unwrap();
    for ((name, method, _), (_, again, _)) in methods().into_iter().zip(methods()) {
        let whole = sought(method, 200, None).unwrap();
        let path = place.path().join(name);
        let (_, first, _) = methods().into_iter().find(|one| one.0 == name).unwrap();
        assert_eq!(sought(first, 77, Some(&path)).unwrap().n_made, 77);
        let rest = sought(again, 200, Some(&path)).unwrap();
        assert_eq!(rest.n_made, whole.n_made - 77, "{name}");
        assert_eq!(Come { n_made: whole.n_made, ..rest }, whole, "{name}");
    }
    // The journal of another method
    let error = sought(Method::Random { seed: 4 }, 200, Some(&place.path().join("random")));
    assert!(matches!(error, Err(SearchError::OtherSearch(_))), "{error:?}");
}

#[test]
fn a_program_proposes_and_what_it_may_not_answer_is_refused() {
    let program = |text: &str| External {
        command: ["sh", "-c", text].map(str::to_owned).to_vec(),
        directory: ".".into(),
    };
    let asked = |text: &str, journal: Option<&Path>| {
        let program = program(text);
        let mut ask = |proposals: &Proposals<'_>| program.ask(proposals);
        sought(Method::External(&mut ask), 12, journal).unwrap()
    };
    // It is told names, bounds, the best point and what is left, and its point is clipped to the bounds
    let knows = "grep -q '\"b\":\\[0.0,100.0\\]' && echo '{ \"values\": { \"a\": 1, \"b\": 30.0, \"c\": -5 } }'";
    let come = asked(knows, None);
    assert_eq!((come.best, come.ended), (vec![1.0, 30.0, 0.0], Ended::Evaluations));
    for (text, words) in [
        ("echo no", "no JSON"),
        ("echo '{}'", "no object `values`"),
        ("echo '{ \"values\": { \"a\": 1, \"b\": 3 } }'", "\"c\" is missing"),
        ("echo '{ \"values\": { \"a\": 1, \"b\": 3, \"d\": 0 } }'", "nothing is called \"d\""),
        ("echo '{ \"values\": { \"a\": 1, \"b\": null, \"c\": 0 } }'", "\"b\" is null"),
        ("echo '{ \"values\": { \"a\": 1, \"b\": 1e999, \"c\": 0 } }'", "no JSON"),
        ("exit 3", "ended with exit status: 3"),
    ] {
        let come = asked(text, None);
        let Ended::Failed(what) = come.ended else { panic!("{text}: {:?}", come.ended) };
        assert!(what.contains(words), "{text}: {what}");
        assert!(words.contains("ended") || what.contains("accepted is one JSON object"), "{what}");
    }
    let none = External { command: vec!["/nowhere/program".to_owned()], directory: ".".into() };
    let mut ask = |proposals: &Proposals<'_>| none.ask(proposals);
    let come = sought(Method::External(&mut ask), 12, None).unwrap();
    assert!(matches!(come.ended, Ended::Failed(what) if what.contains("/nowhere/program")));
    // What stands in the journal is not asked for again
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("journal");
    let before = asked(knows, Some(&path));
    let after = asked("exit 3", Some(&path));
    assert_eq!((after.n_made, after.best), (0, before.best));
}

#[test]
fn what_a_program_has_started_ends_with_it() {
    let place = tempfile::tempdir().unwrap();
    let program = External {
        command: ["sh", "-c", "sleep 60 & echo $! > id; wait"].map(str::to_owned).to_vec(),
        directory: place.path().to_owned(),
    };
    let id = place.path().join("id");
    let seen = id.clone();
    let request: Request =
        Arc::new(move || std::fs::read(&seen).is_ok_and(|id| id.ends_with(b"\n")));
    let mut ask = |proposals: &Proposals<'_>| program.ask(proposals);
    let heard = hearing(request, || sought(Method::External(&mut ask), 12, None));
    assert!(heard.was_ended);
    let started = std::fs::read_to_string(id).unwrap();
    let stat = Path::new("/proc").join(started.trim()).join("stat");
    // Gone, or a zombie that nobody has waited for
    let has_ended = || std::fs::read_to_string(&stat).map_or(true, |stat| stat.contains(") Z "));
    let looks = (0..500).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(10));
        has_ended()
    });
    assert!(looks, "the process {} of the program goes on", started.trim());
}

#[test]
fn a_start_that_fails_or_is_outside_is_refused() {
    let mut one = bounded();
    one[0].start = -1.7;
    let mut evaluate = valley;
    let effort = Effort { evaluations: 10, halvings: HALVINGS };
    let error = Proposals::new(&one, effort, &mut evaluate, None, Vec::new()).err();
    assert!(matches!(error, Some(SearchError::Start(_))), "{error:?}");
    one[0].start = 3.0;
    let error = Proposals::new(&one, effort, &mut evaluate, None, Vec::new()).err();
    assert!(matches!(error, Some(SearchError::Bounds { .. })), "{error:?}");
}

/// Without the line search only proposals themselves are tried, and a better one is all that is accepted.
#[test]
fn the_line_search_can_be_left_out() {
    let bounded = bounded();
    let mut evaluate = valley;
    let effort = Effort { evaluations: 300, halvings: 0 };
    let mut proposals = Proposals::new(&bounded, effort, &mut evaluate, None, Vec::new()).unwrap();
    propose(&mut proposals, Method::Random { seed: 3 }).unwrap();
    assert_eq!(proposals.all().len(), 299);
    let accepted: Vec<f64> = proposals.all().iter().filter_map(|one| one.accepted).collect();
    assert!(!accepted.is_empty() && accepted.iter().all(|part| *part >= 1.0), "{accepted:?}");
    let with = sought(Method::Random { seed: 3 }, 300, None).unwrap();
    assert!(with.n_accepted as f64 / with.n_proposals as f64 > accepted.len() as f64 / 299.0);
}

/// What was being evaluated when a search was asked to end is no part of it: that motion came to nothing.
#[test]
fn a_search_that_is_asked_to_end_goes_on_with_the_same_bits() {
    for (name, ..) in methods() {
        let method = || methods().into_iter().find(|one| one.0 == name).map(|one| one.1);
        let method = || method().expect("it is one of them");
        let place = tempfile::tempdir().expect("there is room");
        let path = place.path().join("search.journal");
        let whole = sought(method(), 40, None).expect("it is made");
        for lasting in [1, 3, 17] {
            let n = Arc::new(AtomicUsize::new(0));
            let asked = Arc::clone(&n);
            let request: Request = Arc::new(move || asked.load(Ordering::Relaxed) >= lasting);
            let counted = Arc::clone(&n);
            let mut count = || {
                counted.fetch_add(1, Ordering::Relaxed);
            };
            let made = hearing(request, || counting(method(), 40, Some(&path), &mut count));
            assert!(matches!(made.result, Err(SearchError::Stopped(_))), "{name}");
            let text = std::fs::read_to_string(&path).expect("it has a journal");
            assert!(!text.contains("inf"), "{name}: {text}");
        }
        let rest = sought(method(), 40, Some(&path)).expect("it goes on");
        assert_eq!((rest.best, rest.n_proposals), (whole.best, whole.n_proposals), "{name}");
    }
}

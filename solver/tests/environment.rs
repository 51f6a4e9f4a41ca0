//! Environments: the same bits in any number of threads, resets, ends, refusals, the full solver, and learning.
#![expect(clippy::unwrap_used, reason = "a test that cannot open its case has failed")]

use std::f64::consts::TAU;

use alewife::case::{Asked, Case, CaseFile, Severity, SplitMix64, check};
use alewife::environment::{
    Autoreset, Batch, Environment, EnvironmentError, Full, Head, Reason, Swim,
};
use alewife::reduced::simulate;

fn read(settings: &[&str]) -> CaseFile {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    let file = Case::read("eel-to-target", &settings).unwrap();
    let errors = check(&file).into_iter().filter(|one| one.severity == Severity::Error);
    assert_eq!(errors.map(|one| one.to_string()).collect::<Vec<_>>(), Vec::<String>::new());
    file
}

/// Actions without a pattern.
fn actions(random: &mut SplitMix64, n: usize) -> Vec<f64> {
    (0..n).map(|_| 2.0 * random.uniform() - 1.0).collect()
}

const RANDOM: &str =
    "environment.randomise=[{ key = 'fluid.viscosity', law.log-uniform = [0.08, 0.15] }]";

#[test]
fn bits_are_the_same_in_any_number_of_threads_and_alone() {
    let file = read(&["time.unsteady.end=0.7", RANDOM, "environment.samples=3"]);
    let played = |threads: usize, n: usize| {
        let mut batch = Batch::open(&file, n, threads).unwrap();
        batch.reset(None, None).unwrap();
        let mut random = SplitMix64(3);
        let mut seen: Vec<u64> = Vec::new();
        for _ in 0..20 {
            // The first environments are asked for the same however many there are
            let all = actions(&mut random, 5 * 9);
            batch.step(&all[..5 * n], Autoreset::NextStep).unwrap();
            let rewards = batch.heads()[..3].iter().map(|head| head.reward);
            let observations = batch.observations()[..3 * 22].iter().copied();
            seen.extend(observations.chain(rewards).map(f64::to_bits));
        }
        seen
    };
    let alone = played(1, 3);
    assert_eq!(alone, played(2, 9));
    // And those of one environment by itself
    let mut swim = Swim::open(&file).unwrap();
    let mut random = SplitMix64(3);
    swim.reset(Some(swim.task().seed())).unwrap();
    for nth in 0..20 {
        let all = actions(&mut random, 5 * 9);
        let is_over = nth > 0 && nth % 8 == 7;
        let observed = if is_over {
            swim.reset(None).unwrap().observation
        } else {
            let outcome = swim.step(&all[..5]).unwrap();
            assert_eq!(outcome.truncated, nth % 8 == 6);
            outcome.observation
        };
        let bits: Vec<u64> = observed.iter().map(|value| value.to_bits()).collect();
        assert_eq!(bits, alone[nth * 69..nth * 69 + 22], "{nth}");
    }
}

/// What is observed is what a run with the same commands has in its series.
#[test]
fn an_episode_is_the_run_that_repeats_it() {
    let file = read(&["time.unsteady.end=1.0", "environment.interval=0.05"]);
    let mut swim = Swim::open(&file).unwrap();
    swim.reset(Some(1)).unwrap();
    let mut random = SplitMix64(8);
    let mut seen = Vec::new();
    for nth in 0..20 {
        let action = actions(&mut random, 5);
        for (one, value) in swim.task().actions().iter().zip(&action) {
            let (time, command) = (0.05 * f64::from(nth), one.command.clone());
            file.model.commands.ask(&Asked { time, command, target: one.target(*value) }).unwrap();
        }
        seen.push(swim.step(&action).unwrap().observation);
    }
    let series = simulate(&file.model).unwrap();
    for (name, place, scale) in [
        ("eel-4.joint.angle", 2, 1.0),
        ("eel-6.joint.rate", 9, 5.0),
        ("eel-1.angular_velocity", 12, 1.0),
    ] {
        let column = series.column(name).unwrap();
        for (nth, observation) in seen.iter().enumerate() {
            let difference = (observation[place] * scale - column[5 * (nth + 1)]).abs();
            assert!(difference < 1e-9, "{name} {nth}: {difference}");
        }
    }
}

#[test]
fn episodes_follow_each_other_in_three_ways() {
    let file = read(&["time.unsteady.end=0.5"]);
    let mut random = SplitMix64(5);
    let asked: Vec<Vec<f64>> = (0..12).map(|_| actions(&mut random, 10)).collect();
    let open = || {
        let mut batch = Batch::open(&file, 2, 1).unwrap();
        batch.reset(Some(&[7, 8]), None).unwrap();
        batch
    };
    let (mut same, mut next, mut own) = (open(), open(), open());
    for nth in 0..5 {
        same.step(&asked[nth], Autoreset::SameStep).unwrap();
        next.step(&asked[nth], Autoreset::NextStep).unwrap();
        own.step(&asked[nth], Autoreset::Disabled).unwrap();
    }
    let ends = |head: &Head| head.reason == Reason::End;
    assert!([&same, &next, &own].iter().all(|batch| batch.heads().iter().all(ends)));
    assert!(same.heads().iter().all(|head| head.was_reset));
    assert_eq!(same.finals(), own.observations());
    assert_eq!(next.observations(), own.observations());
    let refused = own.step(&asked[5], Autoreset::Disabled).unwrap_err();
    assert!(matches!(refused, EnvironmentError::Over { environment: 0 }), "{refused}");
    // The step of a reset takes no action and pays nothing
    next.step(&asked[5], Autoreset::NextStep).unwrap();
    own.reset(None, Some(&[true, true])).unwrap();
    assert!(next.heads().iter().all(|head| head.was_reset && head.reward == 0.0));
    assert_eq!(next.observations(), same.observations());
    assert_eq!(next.observations(), own.observations());
    // One of them alone
    let before = own.observations().to_vec();
    own.reset(Some(&[9, 9]), Some(&[false, true])).unwrap();
    assert_eq!(own.observations()[..22], before[..22]);
    assert!(own.observations()[22..] != before[22..]);
    let targets = own.drawn().targets;
    assert!(targets.chunks(2).all(|to| (3.5..6.0).contains(&to[0]) && to[1].abs() < 2.0));
}

#[test]
fn a_motion_that_fails_breaks_off_its_episode_and_tells_why() {
    let torque = "{ hinge.torque.command = { limits = [-1e80, 1e80], filter = 0.01 } }";
    let blows_up = format!("swimmer.0.kind.chain.joints.4={torque}");
    let mut swim = Swim::open(&read(&[&blows_up])).unwrap();
    let first = swim.reset(Some(0)).unwrap().observation;
    let mut last = swim.step(&[1.0; 5]).unwrap();
    for _ in 0..40 {
        if last.truncated {
            break;
        }
        last = swim.step(&[1.0; 5]).unwrap();
    }
    assert!(last.truncated && !last.terminated && last.reward == 0.0);
    assert!(matches!(last.info.reason, Reason::Failure | Reason::NotFinite), "{:?}", last.info);
    assert!(!last.info.message.is_empty() && first.len() == last.observation.len());
    assert!(last.observation.iter().all(|value| value.is_finite()));
    // Neither is an expression that is no number any more
    let odd = "environment.reward=[{ of = 'log(0.05 - time)' }]";
    let mut swim = Swim::open(&read(&[odd])).unwrap();
    swim.reset(Some(0)).unwrap();
    let outcome = swim.step(&[0.0; 5]).unwrap();
    assert!(outcome.truncated && outcome.reward == 0.0);
    assert_eq!(outcome.info.reason, Reason::NotFinite);
    let odd = "environment.observations=['eel.x', 'sqrt(-1 - time)']";
    let error = Swim::open(&read(&[odd])).unwrap().reset(Some(0)).unwrap_err().to_string();
    assert!(error.contains("environment.observations.1") && error.contains("NaN"), "{error}");
}

#[test]
fn what_cannot_be_is_refused() {
    let mut swim = Swim::open(&read(&[])).unwrap();
    let refused = |error: EnvironmentError, words: &str| {
        let told = error.to_string();
        assert!(told.contains(words), "{told}");
    };
    refused(swim.step(&[0.0; 5]).unwrap_err(), "reset it");
    swim.reset(None).unwrap();
    refused(swim.step(&[0.0, f64::NAN, 0.0, 0.0, 0.0]).unwrap_err(), "`eel.joint.2` is NaN");
    refused(swim.step(&[0.0; 4]).unwrap_err(), "4 numbers");
    swim.step(&[0.0; 5]).unwrap();
    let mut batch = Batch::open(&read(&[]), 3, 1).unwrap();
    batch.reset(None, None).unwrap();
    let mut asked = [0.0; 15];
    asked[13] = f64::INFINITY;
    refused(batch.step(&asked, Autoreset::NextStep).unwrap_err(), "environment 2: the action");
    refused(Batch::open(&read(&[]), 0, 1).unwrap_err(), "0 environments");
    let open = |settings: &[&str]| Swim::open(&read(settings)).unwrap_err();
    refused(open(&["environment.observations=['flow.dissipation']"]), "the full solver alone");
    let key = "environment.randomise=[{ key = 'fluid.density', law.uniform = [-1.0, -0.5] }]";
    refused(open(&[key]), "with fluid.density = -0.");
    let contact = "contact.barrier={ range = 0.05, stiffness = 1.0 }".to_owned();
    let touching = Case::read("eel-to-target", &[contact]).unwrap();
    refused(Swim::open(&touching).unwrap_err(), "contact");
    let robot = Case::read("robot-eel", &[]).unwrap();
    refused(Swim::open(&robot).unwrap_err(), "no [environment]");
}

#[test]
fn samples_differ_by_their_law_and_seed() {
    let mut reached = Vec::new();
    for seed in ["environment.seed=1", "environment.seed=1", "environment.seed=2"] {
        let mut batch = Batch::open(&read(&[RANDOM, seed]), 40, 1).unwrap();
        batch.reset(Some(&(0..40).collect::<Vec<u64>>()), None).unwrap();
        for nth in 0..5 {
            let asked: Vec<f64> =
                (0..200).map(|k| if (k + nth) % 2 == 0 { 1.0 } else { -0.5 }).collect();
            batch.step(&asked, Autoreset::NextStep).unwrap();
        }
        let samples = batch.drawn().samples;
        let mut own: Vec<usize> = samples.clone();
        own.sort_unstable();
        own.dedup();
        assert!(own.len() > 8 && own.iter().all(|sample| *sample < 16));
        reached.push(batch.observations()[10]);
    }
    assert!(reached[0].to_bits() == reached[1].to_bits() && reached[0] != reached[2]);
}

const SMALL: &str = r#"
title = "three links on command"
geometry = "planar"
fluid = { model = "navier-stokes", density = 1.0, viscosity = 0.2 }
domain.box = { min = [-2.5, -1.5], max = [2.5, 1.5] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 0.6, surface = 0.21 }
time.unsteady = { step = 0.05, end = 0.2 }

[[swimmer]]
name = "eel"

[swimmer.kind.chain]
links = [[0.4, 0.12], [0.4, 0.12], [0.4, 0.1]]
gap = 0.2
joints = [
    { bent.angle.command = { limits = ["-40 deg", "40 deg"], filter = 0.05 } },
    { bent.angle.command = { limits = [-0.6, 0.6], filter = 0.06 } },
]

[environment]
interval = 0.1
observations = ["eel.x", "eel-1.joint.angle", "eel.power"]
actions = ["eel.joint.1", { command = "eel.joint.2", range = [-0.2, 0.2] }]
reward = [{ of = "eel.velocity.x", weight = 10.0 }, { of = "-abs([action.eel.joint.1])" }]
"#;

/// The same task by both solvers: what is commanded is the same, what the fluid does is not quite.
#[test]
fn the_full_solver_takes_the_same_actions() {
    let file = Case::parse("small.toml", SMALL, &[]).unwrap();
    let mut both: Vec<Box<dyn Environment>> =
        vec![Box::new(Full::<2>::open(&file).unwrap()), Box::new(Swim::open(&file).unwrap())];
    let mut seen: Vec<Vec<Vec<u64>>> = Vec::new();
    for environment in &mut both {
        for _ in 0..2 {
            let mut own = vec![environment.reset(Some(4)).unwrap().observation];
            for action in [[0.7, -3.0], [-0.2, 0.4]] {
                let outcome = environment.step(&action).unwrap();
                assert!(outcome.reward.is_finite() && outcome.info.terms[1] == -action[0].abs());
                own.push(outcome.observation);
                assert_eq!(outcome.truncated, own.len() == 3);
            }
            let bits = |row: Vec<f64>| row.into_iter().map(f64::to_bits).collect();
            seen.push(own.into_iter().map(bits).collect());
        }
    }
    assert!(seen[0] == seen[1] && seen[2] == seen[3]);
    let at = |run: usize, decision: usize, place: usize| f64::from_bits(seen[run][decision][place]);
    for decision in 0..3 {
        assert!((at(0, decision, 1) - at(2, decision, 1)).abs() < 1e-9);
    }
    let (full, reduced) = (at(0, 2, 2), at(2, 2, 2));
    assert!(full.is_finite() && full != reduced, "{full} {reduced}");
}

/// A wave of the servos with a linear answer to where the target is.
struct Policy([f64; 5]);

impl Policy {
    const AMPLITUDES: [f64; 5] = [0.29, 0.43, 0.5, 0.57, 0.64];
    const PHASES: [f64; 5] = [0.0, 0.83, 0.17, 0.0, 0.83];

    fn act(&self, time: f64, observation: &[f64]) -> [f64; 5] {
        let bearing = observation[15] / observation[13];
        std::array::from_fn(|joint| {
            let phase = TAU * (time + 0.1 + Self::PHASES[joint]);
            Self::AMPLITUDES[joint] * phase.sin() + self.0[joint] * bearing
        })
    }

    /// Mean return, and the part of episodes that reach their targets.
    fn try_on(&self, batch: &mut Batch, seeds: &[u64]) -> [f64; 2] {
        batch.reset(Some(seeds), None).unwrap();
        let n = seeds.len();
        let (mut sum, mut hits, mut over) = (0.0, 0, vec![false; n]);
        for decision in 0..batch.task().n_decisions() {
            let time = batch.task().time(decision);
            let rows = batch.observations().chunks(22);
            let asked: Vec<f64> = rows.flat_map(|row| self.act(time, row)).collect();
            batch.step(&asked, Autoreset::NextStep).unwrap();
            for (head, over) in batch.heads().iter().zip(&mut over).filter(|(_, over)| !**over) {
                sum += head.reward;
                *over = head.reason != Reason::Goes;
                hits += usize::from(head.reason.terminates());
            }
        }
        [sum / n as f64, hits as f64 / n as f64]
    }
}

/// Five gains by random search, on targets other than those it is tried on.
#[test]
fn a_linear_feedback_learns_to_reach_targets_it_has_not_seen() {
    let file = read(&[]);
    let mut batch = Batch::open(&file, 8, 2).unwrap();
    let training: Vec<u64> = (0..8).collect();
    let unseen: Vec<u64> = (1000..1032).collect();
    let mut tried = Batch::open(&file, 32, 2).unwrap();
    let mut random = SplitMix64(1);
    let mut best = Policy([0.0; 5]);
    let before = best.try_on(&mut tried, &unseen);
    let mut value = best.try_on(&mut batch, &training)[0];
    let mut direction = [0.0; 5];
    for nth in 0..24 {
        // A step that helped is tried once more, any other is drawn anew
        if direction == [0.0; 5] || nth % 6 == 0 {
            direction = std::array::from_fn(|_| 1.2 * (random.uniform() - 0.5));
        }
        let other = Policy(std::array::from_fn(|k| best.0[k] + direction[k]));
        let found = other.try_on(&mut batch, &training)[0];
        if found > value {
            (best, value) = (other, found);
        } else {
            direction = [0.0; 5];
        }
    }
    let after = best.try_on(&mut tried, &unseen);
    assert!(
        before[1] <= 0.5 && after[1] >= 0.8 && after[0] > before[0] + 100.0,
        "{before:?} {after:?}"
    );
}

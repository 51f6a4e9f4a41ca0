//! Bodies that hang on each other, with inertia and without.

use std::f64::consts::PI;

use alewife_core::run::RunSummary;
use tests::cases::{case, column, last, run};
use tests::figure;

/// Semi-axes of a link, and from its centre to the pivot.
const LINK: [f64; 2] = [0.4, 0.12];
const GAP: f64 = 0.3;
const LEVER: f64 = LINK[0] + 0.5 * GAP;

/// Two links in the thinnest of fluids, driven by a motor in their pivot.
fn pendulum(step: f64) -> RunSummary {
    run(&case(&format!(
        r#"
        title = "two links and a motor"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1e-9, viscosity = 1e-9 }}
        domain.disc.radius = 3.0
        boundary.wall = "no-slip"
        mesh = {{ size = 1.5, surface = 0.3, growth = 0.8, gap_layers = 1, moving.layers = 1 }}
        time.unsteady = {{ step = {step}, end = 1.0 }}
        [[swimmer]]
        name = "swimmer"
        center = [{LEVER}, 0.1]
        density = 1.0
        [swimmer.kind.chain]
        links = [[{a}, {b}], [{a}, {b}]]
        gap = {GAP}
        joints = [{{ hinge = {{ stiffness = 0.05, rest = 0.3, damping = 0.002, torque = {{ sine = {{ amplitude = 0.03, period = 0.8 }} }} }} }}]
        "#,
        a = LINK[0],
        b = LINK[1]
    )))
}

/// The same as ordinary differential equations of the two angles, after Lagrange: the centre of mass
/// rests, and T = I/2 (p'^2 + q'^2) + m/4 lever^2 (p'^2 + q'^2 + 2 p' q' cos(p - q)).
fn exact(end: f64) -> [f64; 4] {
    let mass = PI * LINK[0] * LINK[1];
    let own = mass * (LINK[0].powi(2) + LINK[1].powi(2)) / 4.0;
    let coupled = 0.5 * mass * LEVER * LEVER;
    let rates = |time: f64, [p, q, u, v]: [f64; 4]| {
        let motor = 0.03 * (2.0 * PI * time / 0.8).sin();
        let torque = motor - 0.05 * (q - p - 0.3) - 0.002 * (v - u);
        let (sin, cos) = (p - q).sin_cos();
        let (diagonal, off) = (own + coupled, coupled * cos);
        let first = -torque - coupled * sin * v * v;
        let second = torque + coupled * sin * u * u;
        let determinant = diagonal * diagonal - off * off;
        let du = (first * diagonal - off * second) / determinant;
        [u, v, du, (second * diagonal - off * first) / determinant]
    };
    let n = 2000;
    let step = end / f64::from(n);
    // The hinge is at rest at its rest angle.
    let mut state = [0.0, 0.3, 0.0, 0.0];
    for nth in 0..n {
        let time = f64::from(nth) * step;
        let after = |rate: [f64; 4], part: f64| -> [f64; 4] {
            std::array::from_fn(|i| state[i] + part * step * rate[i])
        };
        let one = rates(time, state);
        let two = rates(time + 0.5 * step, after(one, 0.5));
        let three = rates(time + 0.5 * step, after(two, 0.5));
        let four = rates(time + step, after(three, 1.0));
        for i in 0..4 {
            state[i] += step / 6.0 * (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i]);
        }
    }
    state
}

/// Without a fluid worth mentioning: the motion is that of a free double pendulum to second order, an
/// inner torque gives no momentum, and what the motor works is what the links have.
#[test]
fn a_chain_in_next_to_nothing_is_a_double_pendulum() {
    let exact = exact(1.0);
    let names = ["1.angle", "2.angle", "1.angular_velocity", "2.angular_velocity"];
    let (mut errors, mut left) = (Vec::new(), Vec::new());
    for step in [0.04, 0.02, 0.01] {
        let outcome = pendulum(step);
        let found = names.map(|name| last(&outcome, &format!("swimmer-{name}")));
        let pairs = found.iter().zip(exact);
        errors.push(pairs.map(|(one, other)| (one - other).abs()).fold(0.0f64, f64::max));
        let mass = PI * LINK[0] * LINK[1];
        let own = mass * (LINK[0].powi(2) + LINK[1].powi(2)) / 4.0;
        let (mut momentum, mut spin, mut energy) = ([0.0; 2], 0.0, 0.0);
        for body in ["swimmer-1", "swimmer-2"] {
            let at = |what: &str| last(&outcome, &format!("{body}.{what}"));
            let velocity = [at("velocity.x"), at("velocity.y")];
            momentum[0] += mass * velocity[0];
            momentum[1] += mass * velocity[1];
            let turn = own * at("angular_velocity");
            let [x, y] =
                [at("x") - last(&outcome, "swimmer.x"), at("y") - last(&outcome, "swimmer.y")];
            spin += turn + mass * (x * velocity[1] - y * velocity[0]);
            energy += 0.5 * mass * (velocity[0].powi(2) + velocity[1].powi(2));
            energy += 0.5 * turn * at("angular_velocity");
        }
        // Work of the hinge on both, by the trapezoidal rule.
        let times = &outcome.series.times;
        let [first, second] = ["1", "2"].map(|n| column(&outcome, &format!("swimmer-{n}.angle")));
        let [u, v] = ["1", "2"].map(|n| column(&outcome, &format!("swimmer-{n}.angular_velocity")));
        let power = |n: usize| {
            let rate = v[n] - u[n];
            let motor = 0.03 * (2.0 * PI * times[n] / 0.8).sin();
            (motor - 0.05 * (second[n] - first[n] - 0.3) - 0.002 * rate) * rate
        };
        let work: f64 = (1..times.len())
            .map(|n| 0.5 * (times[n] - times[n - 1]) * (power(n) + power(n - 1)))
            .sum();
        println!(
            "step {step}: off by {:e}, momentum {momentum:?}, angular momentum {spin:.1e}, \
             energy {energy} of work {work}",
            errors[errors.len() - 1]
        );
        let size = mass * LEVER * exact[2].abs();
        assert!(momentum.iter().all(|part| part.abs() < 1e-7 * size), "{momentum:?}");
        assert!(spin.abs() < 4.0 * step * step * size * LEVER, "{spin}");
        left.push((energy - work).abs() / work);
    }
    figure!(left[2], "energy left");
    figure!(errors[2], "error");
    assert!(left[2] < 0.03 && left[2] < 0.4 * left[1] && left[1] < 0.4 * left[0], "{left:?}");
    assert!(errors[2] < 2e-3, "{errors:?}");
    assert!(errors[1] / errors[2] > 3.2 && errors[0] / errors[1] > 2.8, "{errors:?}");
}

/// A bent chain is pulled through the fluid; its pivot is stiff, or held at an angle.
fn towed(joint: &str) -> [f64; 3] {
    let outcome = run(&case(&format!(
        r#"
        title = "a bent chain is towed"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.2 }}
        domain.disc.radius = 3.0
        boundary.wall = "no-slip"
        mesh = {{ size = 1.0, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1 }}
        time.unsteady = {{ step = 0.02, end = 0.2 }}
        [[swimmer]]
        name = "swimmer"
        density = 2.0
        motion.imposed = {{ velocity = [0.5, 0.3], angular_velocity = 0.4, factor.smooth-ramp.duration = 0.1 }}
        [swimmer.kind.chain]
        links = [[0.5, 0.15], [0.3, 0.1]]
        gap = 0.3
        joints = [{{ {joint} }}]
        "#
    )));
    ["force.x", "force.y", "torque"].map(|part| last(&outcome, &format!("swimmer.{part}")))
}

#[test]
fn a_stiff_hinge_makes_one_body_of_two() {
    let stiff = towed("hinge = { stiffness = 1e7, damping = 1e7, rest = 0.7 }");
    let bent = towed("bent = { angle = { constant = 0.7 } }");
    println!("{stiff:?} {bent:?}");
    for (one, other) in stiff.iter().zip(bent) {
        assert!((one - other).abs() < 1e-6 * bent[0].abs(), "{stiff:?} {bent:?}");
    }
}

/// Two discs of different weights that are held together, by a text for each and one for their joint.
fn sinking(first: &str, second: &str, joint: &str, time: &str, model: &str) -> RunSummary {
    run(&case(&format!(
        r#"
        title = "two discs held together"
        geometry = "planar"
        fluid = {{ model = "{model}", density = 1.0, viscosity = 0.5, gravity = [0.0, -1.0] }}
        domain.box = {{ min = [-2.0, -2.0], max = [2.0, 2.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.8, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1 }}
        time.{time}
        [[body]]
        name = "one"
        shape.disc.radius = 0.3
        center = [-0.4, 0.2]
        density = 3.0
        {first}
        [[body]]
        name = "other"
        shape.disc.radius = 0.2
        center = [0.5, 0.2]
        density = 2.0
        {second}
        {joint}
        "#
    )))
}

const FREE: &str = "motion = \"free\"";
const HANGS: &str = "[[joint]]\nparent = \"one\"\nchild = \"other\"\n";

/// Whatever joint holds them: an arm, or a pivot that does not bend, on either end.
#[test]
fn discs_held_together_sink_the_same_way_whatever_holds_them() {
    let joints = [
        format!("{HANGS}kind.arm.length.constant = 0.9"),
        format!("{HANGS}on_parent = [0.9, 0.0]\nkind.bent.angle.constant = 0.0"),
        format!("{HANGS}on_child = [-0.9, 0.0]\nkind.bent.angle.constant = 0.0"),
        "[[joint]]\nparent = \"other\"\nchild = \"one\"\n\
         kind.arm = { length.constant = 0.9, direction = 3.141592653589793 }"
            .to_owned(),
    ];
    for model in ["stokes", "navier-stokes"] {
        let ends = joints.each_ref().map(|joint| {
            let outcome =
                sinking(FREE, FREE, joint, "unsteady = { step = 0.05, end = 0.3 }", model);
            ["one.x", "one.y", "one.angle", "other.x", "other.y", "other.angle"]
                .map(|name| last(&outcome, name))
        });
        println!("{model}: {:?}", ends[0]);
        for end in &ends[1..] {
            for (one, other) in ends[0].iter().zip(end) {
                // Places are integrated for the body that others hang on: the error of a step.
                assert!((one - other).abs() < 2e-5, "{model}: {ends:?}");
            }
        }
    }
}

/// The motion the pair finds is the one in which the loads of both, moved so, balance their weights.
#[test]
fn the_motion_of_a_linked_pair_balances_its_weight() {
    let joint = format!("{HANGS}kind.arm.length.constant = 0.9");
    let together = sinking(FREE, FREE, &joint, "steady = {}", "stokes");
    let at = |outcome: &RunSummary, name: &str| last(outcome, name);
    let velocity = |name: &str| {
        let parts = ["velocity.x", "velocity.y", "angular_velocity"];
        parts.map(|part| at(&together, &format!("{name}.{part}")))
    };
    let moved = |name: &str| {
        let [u, v, spin] = velocity(name);
        format!("motion.imposed = {{ velocity = [{u:e}, {v:e}], angular_velocity = {spin:e} }}")
    };
    let (one, other) = (velocity("one"), velocity("other"));
    assert!((one[0] - other[0]).abs() < 1e-12 && (other[1] - one[1] - 0.9 * one[2]).abs() < 1e-12);
    let apart = sinking(&moved("one"), &moved("other"), "", "steady = {}", "stokes");
    let weights = [2.0 * PI * 0.09, 1.0 * PI * 0.04];
    let lift = |name: &str| at(&apart, &format!("{name}.force.y"));
    let total = lift("one") + lift("other");
    assert!((total / (weights[0] + weights[1]) - 1.0).abs() < 1e-9, "{total}");
    let sideways = at(&apart, "one.force.x") + at(&apart, "other.force.x");
    let torque =
        at(&apart, "one.torque") + at(&apart, "other.torque") + 0.9 * (lift("other") - weights[1]);
    figure!(sideways, "force off balance");
    figure!(torque, "torque off balance");
    assert!(sideways.abs() < 1e-9 && torque.abs() < 1e-9, "{sideways:e} {torque:e}");
}

/// The rate of momentum of all bodies is the force of the fluid, in every step to rounding; that of
/// their angular momentum the torque, to the order of the scheme.
#[test]
fn the_momentum_of_a_swimmer_changes_by_the_force_of_the_fluid() {
    let at = |step: f64| {
        let outcome = run(&case(&format!(
            r#"
            title = "three discs with inertia"
            geometry = "planar"
            fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.05 }}
            domain.disc.radius = 3.0
            boundary.wall = "no-slip"
            mesh = {{ size = 1.0, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1 }}
            time.unsteady = {{ step = {step}, end = 0.48 }}
            [[swimmer]]
            name = "swimmer"
            center = [0.3, 0.2]
            angle = 0.3
            density = 1.7
            [swimmer.kind.star]
            radius = 0.3
            radii = [0.2, 0.25, 0.2]
            arms = [
                {{ sine = {{ mean = 1.0, amplitude = 0.3, period = 1.0, ramp = 0.4 }} }},
                {{ sine = {{ mean = 0.9, amplitude = 0.2, period = 1.0, phase = 0.238732, ramp = 0.4 }} }},
                {{ sine = {{ mean = 1.1, amplitude = 0.3, period = 1.0, phase = 0.477465, ramp = 0.4 }} }},
            ]
            "#
        )));
        let radii = [0.3, 0.2, 0.25, 0.2];
        let (mut worst, mut size) = (0.0f64, 0.0f64);
        let times = &outcome.series.times;
        let columns =
            |body: usize, what: &str| column(&outcome, &format!("swimmer-{}.{what}", body + 1));
        for axis in ["x", "y"] {
            let force = column(&outcome, &format!("swimmer.force.{axis}"));
            let mut rates = vec![0.0; times.len()];
            for (body, radius) in radii.iter().enumerate() {
                let all = columns(body, &format!("acceleration.{axis}"));
                let pairs = rates.iter_mut().zip(all);
                pairs.for_each(|(sum, rate)| *sum += 1.7 * PI * radius * radius * rate);
            }
            for n in 1..times.len() {
                worst = worst.max((rates[n] - force[n]).abs());
                size = size.max(force[n].abs());
            }
        }
        assert!(worst < 1e-9 * size, "{worst:e} of {size}");
        // About the centre of mass.
        let torque = column(&outcome, "swimmer.torque");
        let mut spin = vec![0.0; times.len()];
        let center = ["x", "y"].map(|axis| column(&outcome, &format!("swimmer.{axis}")));
        for (body, radius) in radii.iter().enumerate() {
            let mass = 1.7 * PI * radius * radius;
            let [x, y] = ["x", "y"].map(|axis| columns(body, axis));
            let [u, v] = ["velocity.x", "velocity.y"].map(|what| columns(body, what));
            let turn = columns(body, "angular_velocity");
            for n in 0..times.len() {
                let lever = [x[n] - center[0][n], y[n] - center[1][n]];
                spin[n] += mass * (lever[0] * v[n] - lever[1] * u[n]);
                spin[n] += 0.5 * mass * radius * radius * turn[n];
            }
        }
        let (mut off, mut most) = (0.0f64, 0.0f64);
        for n in 3..times.len() {
            let rate = (3.0 * spin[n] - 4.0 * spin[n - 1] + spin[n - 2]) / (2.0 * step);
            off = off.max((rate - torque[n]).abs());
            most = most.max(torque[n].abs());
        }
        figure!(worst / size, "step {step}: force");
        figure!(off / most, "step {step}: torque");
        off / most
    };
    let (coarse, fine) = (at(0.04), at(0.02));
    assert!(fine < 0.35 * coarse && fine < 0.06, "{coarse:e} {fine:e}");
}

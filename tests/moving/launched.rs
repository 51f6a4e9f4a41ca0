//! Free bodies that start with a velocity: the flow of the impulse, and how it decays.

use std::f64::consts::PI;

use alewife_core::case::Model;
use alewife_core::run::{Dimension, RunSummary, SavedState, Solve, simulate};
use nalgebra::Complex;
use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

const A: f64 = 0.5;
const B: f64 = 2.0;

/// A body of radius `A` in the middle of a round container of radius `B`.
fn container(geometry: &str, mesh: &str, time: &str, body: &str) -> Model {
    let (shape, domain, center) = match geometry {
        "planar" => ("disc", format!("disc = {{ radius = {B} }}"), "[0.0, 0.0]"),
        "axisymmetric" => ("sphere", format!("half-disc = {{ radius = {B} }}"), "[0.0, 0.0]"),
        _ => ("sphere", format!("sphere = {{ radius = {B} }}"), "[0.0, 0.0, 0.0]"),
    };
    case(&format!(
        r#"
        title = "a body set in motion at once"
        geometry = "{geometry}"
        fluid = {{ model = "unsteady-stokes", density = 1.0, viscosity = 0.1 }}
        domain.{domain}
        boundary.wall = "no-slip"
        mesh = {{ {mesh} }}
        time.unsteady = {{ {time} }}
        [[body]]
        name = "body"
        shape.{shape}.radius = {A}
        center = {center}
        motion = "free"
        {body}
        "#
    ))
}

/// Energy of the potential flow between two circles or spheres about one point, the inner one at unit speed
/// (Lamb, sections 69 and 93).
fn exact_energy(geometry: &str) -> f64 {
    if geometry == "planar" {
        0.5 * PI * A * A * (B * B + A * A) / (B * B - A * A)
    } else {
        let (a, b) = (A.powi(3), B.powi(3));
        0.5 * (2.0 / 3.0) * PI * a * (b + 2.0 * a) / (b - a)
    }
}

/// Surface cells hold the fluid by the body, where that of a potential flow slips: a layer that is half as thick has
/// half the energy.
#[test]
fn the_flow_at_the_start_is_that_of_an_impulse() {
    let time = "step = 0.01, end = 0.01";
    for geometry in ["planar", "axisymmetric"] {
        let exact = exact_energy(geometry);
        let error = |surface: f64| {
            let mesh = format!("size = 0.2, surface = {surface}, growth = 0.2");
            let outcome = run(&container(geometry, &mesh, time, "velocity = [1.0, 0.0]"));
            assert_eq!(column(&outcome, "body.velocity.x")[0], 1.0);
            column(&outcome, "flow.kinetic_energy")[0] / exact - 1.0
        };
        let [coarse, fine] = [0.02, 0.01].map(error);
        figure!(coarse, "{geometry}: coarse");
        figure!(2.0 * fine - coarse, "{geometry}: extrapolated");
        assert!(coarse > 0.0 && coarse < 0.1, "{geometry}: {coarse:e}");
        assert!((2.0 * fine - coarse).abs() < 5e-3, "{geometry}: {coarse:e} {fine:e}");
    }
}

#[test]
fn the_flow_at_the_start_is_that_of_an_impulse_in_space() {
    let mesh = "size = 0.8, surface = 0.15, growth = 0.5";
    let body = "velocity = [0.48, 0.6, 0.64]\nangular_velocity = [0.1, 0.2, 0.3]";
    let model = container("spatial", mesh, "step = 0.01, end = 0.01", body);
    let outcome = simulate::<3>(&model, &mut []).expect("the case runs");
    let first = |quantity: &str| column(&outcome, &format!("body.{quantity}"))[0];
    assert_eq!(["velocity.x", "velocity.y", "velocity.z"].map(first), [0.48, 0.6, 0.64]);
    let spins = ["angular_velocity.x", "angular_velocity.y", "angular_velocity.z"];
    assert_eq!(spins.map(first), [0.1, 0.2, 0.3]);
    let error = column(&outcome, "flow.kinetic_energy")[0] / exact_energy("spatial") - 1.0;
    figure!(error, "energy in space");
    assert!(error > 0.0 && error < 0.35, "{error:e}");
    // The next row is of a flow that has hardly changed
    assert!((last(&outcome, "body.velocity.x") / 0.48 - 1.0).abs() < 0.2);
}

/// The inverse of a Laplace transform at a time (s), by Talbot's contour (Abate and Valko 2004).
fn inverse(transform: impl Fn(Complex<f64>) -> Complex<f64>, time: f64) -> f64 {
    let n = 24;
    let r = 2.0 * f64::from(n) / (5.0 * time);
    let first = 0.5 * (r * time).exp() * transform(Complex::new(r, 0.0)).re;
    let rest = (1..n).map(|k| {
        let theta = f64::from(k) * PI / f64::from(n);
        let cot = theta.cos() / theta.sin();
        let s = Complex::new(r * theta * cot, r * theta);
        let sigma = theta + (theta * cot - 1.0) * cot;
        ((s * time).exp() * transform(s) * Complex::new(1.0, sigma)).re
    });
    r / f64::from(n) * (first + rest.sum::<f64>())
}

/// A sphere in fluid without walls: (m + m_f / 2) dU/dt = -6 pi mu a (U + history of Basset and Boussinesq), with
/// that of the impulse at the start, so that (M s + 6 pi mu a (1 + a sqrt(s / nu))) U = M U_0.
#[test]
fn a_sphere_set_in_motion_at_once_slows_down_by_added_mass_and_history() {
    let (mu, density, end): (f64, f64, f64) = (0.1, 2.0, 0.5);
    let volume = 4.0 / 3.0 * PI * A.powi(3);
    let mass = volume * (density + 0.5);
    let drag = 6.0 * PI * mu * A;
    let exact = inverse(
        |s| Complex::from(mass) / (s * mass + (s.sqrt() * (A / mu.sqrt()) + 1.0) * drag),
        end,
    );
    let at = |time: &str, surface: f64| {
        let text = format!(
            r#"
            title = "a sphere set in motion at once"
            geometry = "axisymmetric"
            frame = "body"
            fluid = {{ model = "unsteady-stokes", density = 1.0, viscosity = {mu} }}
            domain.half-disc.radius = 10.0
            boundary.wall = "no-slip"
            mesh = {{ size = 2.0, surface = {surface}, growth = 0.3 }}
            time.unsteady = {{ {time}, end = {end} }}
            [[body]]
            name = "body"
            shape.sphere.radius = {A}
            center = [0.0, 0.0]
            density = {density}
            velocity = [1.0, 0.0]
            motion = "free"
            "#
        );
        run(&case(&text))
    };
    for (time, name) in
        [("step = 0.0025", "fixed"), ("adaptive.tolerance = 1e-3, step = 0.001", "adaptive")]
    {
        // The cells on the surface start with the body
        let [coarse, fine] = [0.02, 0.01].map(|surface| {
            let outcome = at(time, surface);
            let history = column(&outcome, "body.velocity.x");
            assert!(history.windows(2).all(|pair| pair[1] < pair[0]), "{name}");
            last(&outcome, "body.velocity.x") / exact - 1.0
        });
        figure!(fine, "speed, {name} steps");
        figure!(2.0 * fine - coarse, "speed, {name} steps, extrapolated");
        assert!(coarse > fine && fine > 0.0 && fine < 8e-3, "{name}: {coarse:e} {fine:e}");
        assert!((2.0 * fine - coarse).abs() < 2e-3, "{name}: {coarse:e} {fine:e} of {exact}");
    }
}

/// Angular velocity of a disc in a container after a time (s), by finite volumes in the radius r:
/// rho du/dt = (1 / r^2) d/dr (mu r^3 d(u / r)/dr), I d omega/dt = 2 pi mu a^3 d(u / r)/dr.
fn spin_by_radius(inertia: f64, mu: f64, end: f64) -> f64 {
    let (n, steps) = (800_usize, 4000_u32);
    let width = (B - A) / n as f64;
    let dt = end / f64::from(steps);
    // Unknowns: omega of the disc, then of rings; moment of inertia of each over 2 pi
    let face = |k: usize| A + width * k as f64;
    let ring = |k: usize| 0.25 * (face(k + 1).powi(4) - face(k).powi(4));
    let mut moments = vec![inertia / (2.0 * PI)];
    moments.extend((0..n).map(ring));
    // Torque over 2 pi through the face before each ring, by the difference across it; and the wall
    let way = |k: usize| if k == 0 || k == n { 0.5 * width } else { width };
    let links: Vec<f64> = (0..=n).map(|k| mu * face(k).powi(3) / way(k)).collect();
    let mut omega = vec![0.0; n + 1];
    omega[0] = 1.0;
    for _ in 0..steps {
        // Implicit Euler, by elimination from the wall inwards
        let mut diagonal = vec![0.0; n + 1];
        let mut right = vec![0.0; n + 1];
        for k in (0..=n).rev() {
            let inner = if k == 0 { 0.0 } else { links[k - 1] };
            diagonal[k] = moments[k] / dt + inner + links[k];
            right[k] = moments[k] / dt * omega[k];
            if k < n {
                diagonal[k] -= links[k] * links[k] / diagonal[k + 1];
                right[k] += links[k] * right[k + 1] / diagonal[k + 1];
            }
        }
        omega[0] = right[0] / diagonal[0];
        for k in 1..=n {
            omega[k] = (right[k] + links[k - 1] * omega[k - 1]) / diagonal[k];
        }
    }
    omega[0]
}

/// With the inertia of its shape, and with one of its own.
#[test]
fn a_disc_that_is_spun_slows_down_as_a_calculation_by_its_radius_says() {
    let end = 0.2;
    for (body, inertia) in [("density = 2.0", PI * A.powi(4)), ("mass = 1.0\ninertia = 0.6", 0.6)] {
        let exact = spin_by_radius(inertia, 0.1, end);
        let [coarse, fine] = [0.04, 0.02].map(|surface| {
            let mesh = format!("size = 0.15, surface = {surface}, growth = 0.2");
            let time = format!("step = 0.004, end = {end}");
            let body = format!("{body}\nangular_velocity = 1.0");
            let outcome = run(&container("planar", &mesh, &time, &body));
            last(&outcome, "body.angular_velocity") / exact - 1.0
        });
        figure!(fine, "angular velocity, {body}");
        figure!(2.0 * fine - coarse, "angular velocity, {body}, extrapolated");
        assert!(coarse > fine && fine > 0.0 && fine < 0.015, "{body}: {coarse:e} {fine:e}");
        assert!((2.0 * fine - coarse).abs() < 3e-3, "{body}: {coarse:e} {fine:e} of {exact}");
    }
}

/// What hangs on a body starts with it, and turns by itself where its hinge lets it.
#[test]
fn what_hangs_on_a_body_starts_with_it() {
    let body = r#"
        velocity = [0.3, -0.2]
        angular_velocity = 0.5
        [[body]]
        name = "arm"
        shape.ellipse.semi_axes = [0.3, 0.1]
        center = [1.1, 0.0]
        motion = "free"
        angular_velocity = -1.5
        [[joint]]
        parent = "body"
        child = "arm"
        on_parent = [0.7, 0.0]
        on_child = [-0.4, 0.0]
        kind.hinge = {}
        "#;
    let mesh = "size = 0.5, surface = 0.1";
    let outcome = run(&container("planar", mesh, "step = 0.01, end = 0.01", body));
    let first = |quantity: &str| column(&outcome, quantity)[0];
    let arm = ["velocity.x", "velocity.y", "angular_velocity"];
    let [x, y, spin] = arm.map(|part| first(&format!("arm.{part}")));
    assert!((x - 0.3).abs() < 1e-15 && (spin + 1.5).abs() < 1e-15, "{x} {spin}");
    assert!((y - (-0.2 + 0.7 * 0.5 + 0.4 * -1.5)).abs() < 1e-15, "{y}");
    assert!((first("arm.joint.rate") + 2.0).abs() < 1e-15);
}

fn bits(outcome: &RunSummary) -> Vec<u64> {
    outcome.series.rows.iter().flatten().map(|value| value.to_bits()).collect()
}

fn resumes_with_the_same_bits<const D: usize>(model: &Model)
where
    Dimension<D>: Solve<D>,
{
    let whole = simulate::<D>(model, &mut []).expect("the case runs");
    let saved: SavedState<D> = stopped(model, 2);
    assert_eq!(bits(&resumed(model, &saved).expect("it continues")), bits(&whole));
}

#[test]
fn a_launched_body_ends_with_the_same_bits_when_it_resumes() {
    let mesh = "size = 0.6, surface = 0.15";
    let body = "velocity = [2.0, 0.0]";
    for time in ["step = 0.02, end = 0.1", "step = 0.01, end = 0.1, adaptive.tolerance = 1e-2"] {
        resumes_with_the_same_bits::<2>(&container("planar", mesh, time, body));
        resumes_with_the_same_bits::<2>(&container("axisymmetric", mesh, time, body));
    }
}

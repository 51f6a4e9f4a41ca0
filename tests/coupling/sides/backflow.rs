//! Sides that take the momentum of fluid that enters, against Bernoulli's equation.

use tests::cases::{case, last, run};

/// A tube of length L between frictionless walls, at rest, with the total pressure p at one end: fluid as one piece has
/// rho L dU/dt = p - rho U^2 / 2, so that U = W tanh(W t / 2 L) with W^2 = 2 p / rho.
struct Tube {
    name: &'static str,
    geometry: &'static str,
    domain: &'static str,
    walls: &'static str,
    area: f64,
}

const LENGTH: f64 = 1.5;
const DENSITY: f64 = 1.3;
const PRESSURE: f64 = 2.6;
const END: f64 = 1.0;

const TUBES: [Tube; 3] = [
    Tube {
        name: "plane",
        geometry: "planar",
        domain: "box = { min = [0.0, 0.0], max = [1.5, 1.0] }",
        walls: "top = 'symmetry', bottom = 'symmetry'",
        area: 1.0,
    },
    Tube {
        name: "axis",
        geometry: "axisymmetric",
        domain: "cylinder = { x = [0.0, 1.5], radius = 1.0 }",
        walls: "wall = 'symmetry'",
        area: std::f64::consts::PI,
    },
    Tube {
        name: "space",
        geometry: "spatial",
        domain: "box = { min = [0.0, 0.0, 0.0], max = [1.5, 1.0, 1.0] }",
        walls: "top = 'symmetry', bottom = 'symmetry', front = 'symmetry', back = 'symmetry'",
        area: 1.0,
    },
];

/// Relative errors of the flux, of the force on the end fluid enters by, and of the balance of momentum.
fn errors(tube: &Tube, ends: &str, convection: &str, step: f64) -> [f64; 3] {
    let Tube { name, geometry, domain, walls, area } = tube;
    let outcome = run(&case(&format!(
        r#"
        title = "tube of total pressure, {name}"
        geometry = "{geometry}"
        fluid = {{ model = "navier-stokes", viscosity = 0.1, density = {DENSITY} }}
        domain.{domain}
        boundary = {{ {ends}, {walls} }}
        mesh = {{ size = 0.7 }}
        time.unsteady = {{ step = {step}, end = {END}, convection = "{convection}" }}
        "#
    )));
    let largest = (2.0 * PRESSURE / DENSITY).sqrt();
    let speed = largest * (0.5 * largest * END / LENGTH).tanh();
    let dynamic = 0.5 * DENSITY * speed * speed;
    let flux = last(&outcome, "left.flux").abs() / (area * speed) - 1.0;
    // The static pressure pushes on what is outside
    let inlet = if last(&outcome, "left.flux") > 0.0 { "left" } else { "right" };
    let force = last(&outcome, &format!("{inlet}.force.x")).abs();
    let pushed = force / (area * (PRESSURE - dynamic)) - 1.0;
    let both = last(&outcome, "left.force.x") + last(&outcome, "right.force.x");
    let gained = (PRESSURE - dynamic) * area;
    [flux, pushed, both.abs() / gained - 1.0]
}

const LEFT: &str = "left.pressure = { value = 2.6, backflow = 0.5 }, right = 'do-nothing'";

#[test]
fn a_side_that_takes_half_the_momentum_has_the_total_pressure() {
    for tube in &TUBES {
        for convection in ["newton", "extrapolated"] {
            let [coarse, fine] = [0.1, 0.05].map(|step| errors(tube, LEFT, convection, step));
            for (coarse, fine) in coarse.iter().zip(&fine) {
                let name = tube.name;
                assert!(fine.abs() < 2e-3, "{name}, {convection}: {fine}");
                assert!(fine.abs() < 0.35 * coarse.abs(), "{name}, {convection}: {coarse}, {fine}");
            }
        }
    }
}

/// Without a viscous part a traction does the same, and so does what enters from the right.
#[test]
fn a_traction_does_what_a_pressure_does() {
    let ends = [
        "left = 'do-nothing', right.pressure = { value = 2.6, backflow = 0.5 }",
        "left.traction = { value = [2.6, 0.0], backflow = 0.5 }, right = 'traction-free'",
    ];
    for ends in ends {
        for error in errors(&TUBES[0], ends, "newton", 0.05) {
            assert!(error.abs() < 2e-3, "{ends}: {error}");
        }
    }
}

//! Flow between walls and in a tube: a one-dimensional equation, in the plane, about an axis and in space.

use alewife_core::run::simulate;
use tests::cases::{PERIODIC_CHANNEL, case, last, run};
use tests::figure;

use super::{CARREAU, LAWS};

/// Of a channel of half height 1 and of a tube of radius 1 under a gradient of 3: largest and mean velocity, by
/// quadrature over the rate of shear.
const CHANNEL: [f64; 2] = [4.477_135_161, 3.334_759_141];
const TUBE: [f64; 2] = [1.161_588_940, 0.657_548_607];

fn parallel_flow(rest: &str, viscosity: &str) -> String {
    format!(
        r#"
        title = "parallel flow"
        fluid = {{ model = "stokes", viscosity = {viscosity} }}
        flow.pressure_gradient = [-3.0, 0.0]
        time.steady = {{}}
        probe = [{{ name = "middle", point = [0.125, 0.0] }}]
        {rest}
        "#
    )
}

fn channel(size: f64, viscosity: &str) -> String {
    let rest = format!(
        r#"
        geometry = "planar"
        domain.box = {{ min = [0.0, -1.0], max = [0.25, 1.0] }}
        {PERIODIC_CHANNEL}
        mesh = {{ size = {size} }}
        "#
    );
    parallel_flow(&rest, viscosity)
}

fn tube(size: f64, viscosity: &str) -> String {
    let rest = format!(
        r#"
        geometry = "axisymmetric"
        domain.cylinder = {{ x = [0.0, 0.25], radius = 1.0 }}
        boundary = {{ left.periodic = "right", right.periodic = "left", wall = "no-slip" }}
        mesh = {{ size = {size} }}
        "#
    );
    parallel_flow(&rest, viscosity)
}

/// Errors of the largest and of the mean velocity, relative.
fn errors(text: &str, expected: [f64; 2]) -> [f64; 2] {
    let outcome = run(&case(text));

    let values = ["middle.velocity.x", "flow.mean_velocity.x"].map(|name| last(&outcome, name));
    [0, 1].map(|i| (values[i] / expected[i] - 1.0).abs())
}

#[test]
fn a_carreau_flow_between_walls_and_in_a_tube_converges_with_order_three_or_more() {
    let sizes = [0.1, 0.05];
    for (name, expected, text) in [
        ("channel", CHANNEL, channel as fn(f64, &str) -> String),
        ("tube", TUBE, tube as fn(f64, &str) -> String),
    ] {
        let [coarse, fine] = sizes.map(|size| errors(&text(size, CARREAU), expected));
        for i in 0..2 {
            let order = (coarse[i] / fine[i]).log2();
            println!("{name}: {coarse:?} {fine:?} order {order}");
            assert!(order > 2.7, "{name} {i}: {coarse:?} {fine:?}");
        }
        figure!(fine[1], "mean velocity of a Carreau flow, {name}");
    }
}

/// What the wall carries is the gradient, whatever the law.
#[test]
fn newtons_method_finds_the_flow_of_every_law() {
    for law in LAWS {
        let outcome = run(&case(&channel(0.2, law)));
        let [fastest, mean] =
            ["middle.velocity.x", "flow.mean_velocity.x"].map(|name| last(&outcome, name));
        assert!(fastest > mean && mean > 0.0, "{law}: {fastest} {mean}");
    }
}

/// Far below the yield stress only the regularisation lets it creep; u = (G / K)^(1/n) n / (n + 1) of a power law.
#[test]
fn a_power_law_has_its_profile_and_a_yield_stress_stops_the_flow() {
    let power = "{ power-law = { consistency = 2.0, index = 0.5, regularised = 1e-4 } }";
    let fastest = last(&run(&case(&channel(0.05, power))), "middle.velocity.x");
    let exact = 1.5f64.powi(2) / 3.0;
    assert!((fastest / exact - 1.0).abs() < 2e-3, "{fastest} {exact}");
    let stiff = "{ herschel-bulkley = { yield_stress = 6.0, consistency = 1.0, index = 0.6, \
                 regularised = 1e-3 } }";
    let creeping = last(&run(&case(&channel(0.2, stiff))), "middle.velocity.x");
    assert!(creeping > 0.0 && creeping < 1e-3, "{creeping}");
}

#[test]
fn in_space_the_channel_is_the_same() {
    let text = format!(
        r#"
        title = "a channel in space"
        geometry = "spatial"
        fluid = {{ model = "stokes", viscosity = {CARREAU} }}
        flow.pressure_gradient = [-3.0, 0.0, 0.0]
        domain.box = {{ min = [0.0, -1.0, 0.0], max = [0.5, 1.0, 0.5] }}
        boundary = {{ left.periodic = "right", right.periodic = "left", bottom = "no-slip", top = "no-slip", front = "symmetry", back = "symmetry" }}
        mesh = {{ size = 0.12 }}
        time.steady = {{}}
        probe = [{{ name = "middle", point = [0.25, 0.0, 0.25] }}]
        "#
    );
    let outcome = simulate::<3>(&case(&text), &mut []).expect("the case runs");
    let fastest = last(&outcome, "middle.velocity.x");
    let mean = last(&outcome, "flow.mean_velocity.x");
    println!("{fastest} {mean}");
    assert!((fastest / CHANNEL[0] - 1.0).abs() < 3e-3, "{fastest}");
    assert!((mean / CHANNEL[1] - 1.0).abs() < 3e-3, "{mean}");
}

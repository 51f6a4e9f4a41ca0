//! Many swimmers: where copies are put, and what keeps them apart.

use alewife_core::case::Model;
use tests::cases::{case, last, run};
use tests::figure;

/// Swimmers of three discs in a box, so many and so placed.
fn crowd(copies: &str) -> Model {
    case(&format!(
        r#"
        title = "a crowd"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-6.0, -4.0], max = [6.0, 4.0] }}
        boundary = {{ left.periodic = "right", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 1.0, surface = 0.2 }}
        time.unsteady = {{ step = 0.1, end = 1.0 }}
        [[body]]
        name = "post"
        shape.disc.radius = 0.5
        center = [0.0, 0.0]
        motion = "held"
        [[swimmer]]
        name = "swimmer"
        center = [-4.0, -2.0]
        [swimmer.kind.linked-spheres]
        radii = [0.2, 0.2, 0.2]
        arms = [{{ constant = 0.6 }}, {{ constant = 0.5 }}]
        [swimmer.copies.{copies}]
        "#
    ))
}

fn places(model: &Model) -> Vec<[f64; 3]> {
    model.bodies.iter().map(|body| [body.center[0], body.center[1], body.angle]).collect()
}

#[test]
fn copies_in_a_lattice_stand_in_rows_and_columns() {
    let case = crowd("lattice]\ncounts = [3, 2]\nspacing = [4.0, 4.0]\n#");
    let names: Vec<&str> = case.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names.len(), 19);
    assert_eq!(&names[1..5], ["swimmer-1-1", "swimmer-1-2", "swimmer-1-3", "swimmer-2-1"]);
    let middle = |nth: usize| case.bodies[2 + 3 * nth].center.clone();
    assert_eq!(middle(0), [-4.0, -2.0]);
    assert_eq!(middle(2), [4.0, -2.0]);
    assert_eq!(middle(3), [-4.0, 2.0]);
}

#[test]
fn copies_at_random_are_where_their_seed_puts_them_and_keep_their_gap() {
    let at = |seed: u32| {
        crowd(&format!("random]\ncount = 6\nseed = {seed}\ngap = 0.3\nturned = true\n#"))
    };
    let case = at(7);
    assert_eq!(places(&case), places(&at(7)));
    assert_ne!(places(&case), places(&at(8)));
    let discs: Vec<(usize, [f64; 2], f64)> = case
        .bodies
        .iter()
        .enumerate()
        .map(|(nth, body)| {
            let swimmer = if nth == 0 { 0 } else { 1 + (nth - 1) / 3 };
            (swimmer, [body.center[0], body.center[1]], if nth == 0 { 0.5 } else { 0.2 })
        })
        .collect();
    for (nth, (swimmer, one, radius)) in discs.iter().enumerate() {
        assert!(one[1].abs() + radius <= 4.0 - 0.3 || *swimmer == 0, "{one:?}");
        for (other_swimmer, other, other_radius) in &discs[nth + 1..] {
            if swimmer == other_swimmer {
                continue;
            }
            for period in [-12.0, 0.0, 12.0] {
                let far = (one[0] - other[0] + period).hypot(one[1] - other[1]);
                assert!(far - radius - other_radius >= 0.3, "{one:?} {other:?}");
            }
        }
    }
    // The same on every machine.
    let first = &case.bodies[2].center;
    assert!((first[0] - 4.809_128_167).abs() < 1e-9 && (first[1] - 0.663_442_344).abs() < 1e-9);
}

/// Two heavy swimmers sink upon a disc and the bottom, their strokes going on.
#[test]
fn swimmers_driven_together_do_not_overlap() {
    let text = r#"
        title = "two swimmers and a disc"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 0.3, density = 1.0, gravity = [0.0, -10.0] }
        domain.box = { min = [-2.0, -1.0], max = [2.0, 1.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.5, surface = 0.15, gap_layers = 2 }
        contact.barrier = { range = 0.1, stiffness = 80.0 }
        time.unsteady = { step = 0.05, end = 2.0 }
        [[body]]
        name = "disc"
        shape.disc.radius = 0.2
        center = [-0.1, -0.6]
        density = 2.0
        motion = "free"
        [[swimmer]]
        name = "swimmer"
        center = [-0.9, 0.0]
        angle = 0.3
        density = 3.0
        [swimmer.kind.linked-spheres]
        radii = [0.2, 0.2, 0.2]
        arms = [
            { sine = { mean = 0.6, amplitude = 0.1, period = 1.0 } },
            { sine = { mean = 0.6, amplitude = 0.1, period = 1.0, phase = 0.238732 } },
        ]
        [swimmer.copies.lattice]
        counts = [2, 1]
        spacing = [1.8, 0.0]
        "#;
    let outcome = run(&case(text));
    let mut carried = 0.0f64;
    let gaps = outcome.series.column("flow.minimum_gap").expect("the mesh moves");
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    // Contact and fluid carry the weight of each swimmer, all parts of its tree together.
    for swimmer in ["swimmer-1", "swimmer-2"] {
        let discs = [1, 2, 3].map(|nth| format!("{swimmer}-{nth}"));
        let of = |what: &str| -> f64 {
            discs.iter().map(|disc| last(&outcome, &format!("{disc}.{what}"))).sum()
        };
        let weight = 3.0 * 2.0 * 10.0 * std::f64::consts::PI * 0.04;
        let (fluid, contact) = (of("force.y"), of("contact_force.y"));
        println!("{swimmer}: fluid {fluid}, contact {contact}, weight {weight}");
        carried = carried.max(contact / weight);
        assert!((fluid + contact - weight).abs() < 1e-8 * weight);
    }
    figure!(least, "least gap");
    figure!(carried, "part of a weight that contact carries");
    assert!(carried > 0.1, "nobody stands on anything: {carried}");
    assert!(least > 0.0 && least < 0.1, "{least}");
}

/// Parts of a swimmer may reach beyond a periodic side: there it swims as anywhere else.
#[test]
fn a_chain_may_start_across_a_periodic_side() {
    let at = |x: f64| {
        run(&case(&format!(
            r#"
            title = "a chain in a periodic channel"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.box = {{ min = [-2.0, -2.0], max = [2.0, 2.0] }}
            boundary = {{ left.periodic = "right", bottom = "no-slip", top = "no-slip" }}
            mesh = {{ size = 0.5, surface = 0.06 }}
            time.unsteady = {{ step = 0.05, end = 0.3 }}
            [[swimmer]]
            name = "chain"
            center = [{x}, 0.0]
            [swimmer.kind.chain]
            links = [[0.3, 0.1], [0.3, 0.1], [0.3, 0.1]]
            gap = 0.1
            joints = [
                {{ bent.angle.sine = {{ amplitude = 0.4, period = 1.0 }} }},
                {{ bent.angle = 0.3 }},
            ]
            "#
        )))
    };
    let ends = [0.0, 1.8].map(|x| {
        let outcome = at(x);
        ["velocity.x", "velocity.y", "angular_velocity", "power"]
            .map(|name| last(&outcome, &format!("chain.{name}")))
    });
    println!("{ends:?}");
    for (one, other) in ends[0].iter().zip(ends[1]) {
        assert!((one - other).abs() < 1e-5 * ends[0][3], "{ends:?}");
    }
}

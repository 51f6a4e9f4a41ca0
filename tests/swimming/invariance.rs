//! Gaits seen in a mirror, from a turned and shifted frame, and from one that travels: on the mesh
//! that is moved in the same way the same motion comes out, so that no direction of the plane and no
//! frame is built into anything.

use alewife_core::run::build_mesh;
use alewife_mesh::Point;
use tests::cases::case;
use tests::{Moved, Swim};

/// Equal to this part.
const SAME: f64 = 1e-8;

/// A stroke of an arm.
fn arm(mean: f64, phase: f64) -> String {
    format!("{{ sine = {{ mean = {mean}, amplitude = 0.3, period = 1.0, phase = {phase} }} }}")
}

/// A gait as it is in a frame.
struct Swimmer {
    name: &'static str,
    /// Its `kind`, and the name of the body that others hang on.
    kind: fn(&Moved) -> String,
    root: &'static str,
    /// Edges on it (m).
    size: f64,
}

const SWIMMERS: [Swimmer; 8] = [
    Swimmer {
        name: "three discs",
        kind: |_| {
            format!(
                "linked-spheres = {{ radii = [0.3, 0.2, 0.25], arms = [{}, {}] }}",
                arm(1.0, 0.048),
                arm(0.9, 0.27)
            )
        },
        root: "swimmer-2",
        size: 0.2,
    },
    Swimmer {
        name: "star",
        kind: |moved| {
            let directions = [0.2, 2.1, -1.7].map(|direction| moved.sign() * direction);
            format!(
                "star = {{ radius = 0.3, radii = [0.2, 0.2, 0.2], arms = [{}, {}, {}], \
                 directions = {directions:?} }}",
                arm(1.0, 0.048),
                arm(0.9, 0.27),
                arm(1.1, 0.46)
            )
        },
        root: "swimmer-1",
        size: 0.2,
    },
    Swimmer {
        name: "chain",
        kind: |moved| {
            let bent = |mean: f64, phase: f64| {
                let (mean, amplitude) = (moved.sign() * mean, moved.sign() * 0.6);
                format!(
                    "{{ bent = {{ angle = {{ sine = {{ mean = {mean}, amplitude = {amplitude}, \
                     period = 1.0, phase = {phase} }} }} }} }}"
                )
            };
            format!(
                "chain = {{ links = [[0.4, 0.08], [0.3, 0.08], [0.4, 0.1]], gap = 0.3, \
                 joints = [{}, {}] }}",
                bent(0.2, 0.06),
                bent(-0.1, 0.3)
            )
        },
        root: "swimmer-2",
        size: 0.2,
    },
    Swimmer {
        name: "flagellate",
        kind: |moved| {
            let phase = if moved.mirrored { 0.6 } else { 0.1 };
            format!(
                "body = {{ shape = {{ flagellate = {{ head = [0.3, 0.2], tail_length = 1.2, \
                 thickness = 0.12 }} }}, gait = {{ flagellum = {{ period = 1.0, wavelength = 1.0, \
                 amplitude = 0.15, ramp = 0.1, phase = {phase} }} }} }}"
            )
        },
        root: "swimmer",
        size: 0.15,
    },
    Swimmer {
        name: "carangiform",
        kind: |moved| fish("carangiform", moved),
        root: "swimmer",
        size: 0.15,
    },
    Swimmer {
        name: "anguilliform",
        kind: |moved| fish("anguilliform", moved),
        root: "swimmer",
        size: 0.15,
    },
    Swimmer {
        name: "squirmer",
        kind: |moved| {
            let (heading, turn) = (moved.sign() * 0.4, moved.sign() * 0.8);
            format!(
                "body = {{ shape = {{ disc = {{ radius = 0.5 }} }}, gait = {{ squirmer = {{ \
                 modes = [1.0, -0.7, 0.3], heading = {heading}, \
                 turn = {{ table = [[0.0, 0.0], [1.0, {turn}]] }} }} }} }}"
            )
        },
        root: "swimmer",
        size: 0.25,
    },
    Swimmer {
        name: "pulsating pair",
        kind: |_| {
            let pulse = |amplitude: f64| {
                format!(
                    "{{ pulsating = {{ amplitude = {amplitude}, period = 1.0, phase = 0.1 }} }}"
                )
            };
            format!(
                "linked-spheres = {{ radii = [0.3, 0.3], arms = [{}], gaits = [{}, {}] }}",
                arm(1.0, 0.048),
                pulse(0.4),
                pulse(-0.4)
            )
        },
        root: "swimmer-1",
        size: 0.2,
    },
];

/// A thick fish, already bent at the start.
fn fish(gait: &str, moved: &Moved) -> String {
    let phase = if moved.mirrored { 0.7 } else { 0.2 };
    format!(
        "body = {{ shape = {{ fish = {{ length = 1.6, head_width = 0.08, head_end = 0.08, \
         tail_width = 0.04, tip_radius = 0.01, corner_radius = 0.05 }} }}, gait = {{ {gait} = {{ \
         period = 1.0, ramp = 0.0, phase = {phase} }} }} }}"
    )
}

const CENTER: [f64; 2] = [0.3, -0.4];
const ANGLE: f64 = 0.35;

/// A swimmer in a circular container, moved as a whole; with a `stream` (m/s) the wall goes with that
/// velocity, and the mesh with the swimmer.
fn swim(swimmer: &Swimmer, model: &str, moved: &Moved, stream: Option<Point<2>>) -> Swim {
    let at = |moved: &Moved| {
        let [center, wall] = [CENTER, [0.0; 2]].map(|place| moved.place(Point::<2>::from(place)));
        let frame = stream.map_or(String::new(), |_| format!("frame = \"{}\"", swimmer.root));
        let [u, v] = stream.map_or([0.0; 2], Into::into);
        let text = format!(
            r#"
            title = "{name}"
            geometry = "planar"
            {frame}
            fluid = {{ model = "{model}", density = 1.0, viscosity = 0.1 }}
            domain.disc = {{ center = [{}, {}], radius = 4.0 }}
            boundary.wall.velocity.value = [{u}, {v}]
            mesh = {{ size = 1.5, surface = {size}, growth = 0.5, gap_layers = 1, moving.layers = 1 }}
            time.unsteady = {{ step = 0.02, end = 1.0 }}
            [[swimmer]]
            name = "swimmer"
            center = [{}, {}]
            angle = {}
            density = 1.3
            [swimmer.kind]
            {kind}
            "#,
            wall.x,
            wall.y,
            center.x,
            center.y,
            moved.angle(ANGLE),
            name = swimmer.name,
            size = swimmer.size,
            kind = (swimmer.kind)(moved),
        );
        case(&text)
    };
    let mesh = build_mesh(&at(&Moved::default())).expect("it is meshed");
    let mut swim = Swim::new(&at(moved), moved.mesh(&mesh));
    if let Some(stream) = stream {
        swim.stream(stream);
    }
    swim
}

/// Places and velocities of bodies as seen from a frame, seen from the first one.
fn seen_back(swim: &Swim, moved: &Moved, stream: Point<2>) -> Vec<[f64; 6]> {
    let back = |vector: Point<2>| {
        let vector = nalgebra::Rotation2::new(-moved.turn) * vector;
        Point::<2>::new(vector.x, moved.sign() * vector.y)
    };
    let way = stream * swim.state().time + Point::<2>::from(moved.shift);
    let pairs = swim.state().poses.iter().zip(&swim.state().now.twists);
    pairs
        .map(|(pose, twist)| {
            let at = back(pose.center.xy() - way);
            let angle = moved.sign() * (pose.angle() - moved.turn);
            let velocity = back(twist.linear.xy() - stream);
            [at.x, at.y, angle, velocity.x, velocity.y, moved.sign() * twist.angular.z]
        })
        .collect()
}

#[track_caller]
fn assert_same(
    name: &str,
    moved: &Moved,
    one: (&[[f64; 6]], f64),
    other: (&[[f64; 6]], f64),
) -> f64 {
    let speed = one.0.iter().flat_map(|body| &body[3..]).fold(0.0f64, |most, v| most.max(v.abs()));
    let mut worst = (one.1 - other.1).abs() / one.1.abs();
    for (one, other) in one.0.iter().zip(other.0) {
        for part in 0..6 {
            let scale = if part < 3 { 1.0 } else { speed };
            let mut off = (one[part] - other[part]).abs();
            if part == 2 {
                off = (off + 1.0).rem_euclid(std::f64::consts::TAU) - 1.0;
            }
            worst = worst.max(off.abs() / scale);
        }
    }
    assert!(worst < SAME, "{name}, {moved:?}: {worst:e}\n{one:?}\n{other:?}");
    worst
}

const TURNED: Moved = Moved { mirrored: false, turn: 0.9, shift: [1.3, -0.7] };
const MIRRORED: Moved = Moved { mirrored: true, turn: -0.4, shift: [0.2, 0.9] };

/// The flow at time zero, and an explicit step.
#[test]
fn gaits_without_inertia_are_the_same_turned_shifted_and_mirrored() {
    for swimmer in &SWIMMERS {
        let at = |moved: &Moved| {
            let mut swim = swim(swimmer, "stokes", moved, None);
            swim.begin();
            let start = (seen_back(&swim, moved, Point::<2>::zeros()), swim.power());
            swim.step(0.05);
            (
                start,
                (seen_back(&swim, moved, Point::<2>::zeros()), swim.power()),
                swim.state().mesh.n_cells(),
            )
        };
        let (start, end, cells) = at(&Moved::default());
        let mut worst = Vec::new();
        for moved in [TURNED, MIRRORED] {
            let other = at(&moved);
            for (one, other) in [(&start, &other.0), (&end, &other.1)] {
                worst.push(assert_same(swimmer.name, &moved, (&one.0, one.1), (&other.0, other.1)));
            }
        }
        println!("{}, {cells} cells: {worst:?}", swimmer.name);
    }
}

/// Two steps of the Navier-Stokes equations. The frame that travels sees walls, fluid and swimmer
/// go by: velocities differ by its own, and forces and their work on the shape not at all.
#[test]
fn gaits_with_inertia_are_the_same_turned_mirrored_and_in_a_frame_that_travels() {
    for swimmer in &SWIMMERS {
        let at = |moved: &Moved, stream: Point<2>| {
            let mut swim = swim(swimmer, "navier-stokes", moved, Some(stream));
            for _ in 0..2 {
                swim.step(0.02);
            }
            // Work that is done on the fluid as a whole belongs to the frame.
            let force: Point<2> = swim.loads.bodies.iter().map(|load| load.load.force.xy()).sum();
            (seen_back(&swim, moved, stream), swim.power() + force.dot(&stream))
        };
        let start = at(&Moved::default(), Point::<2>::zeros());
        let mut worst = Vec::new();
        let still = Point::<2>::zeros();
        for (moved, stream) in
            [(TURNED, still), (MIRRORED, still), (Moved::default(), Point::<2>::new(0.7, -0.4))]
        {
            let other = at(&moved, stream);
            worst.push(assert_same(swimmer.name, &moved, (&start.0, start.1), (&other.0, other.1)));
        }
        println!("{}: {worst:?}", swimmer.name);
    }
}

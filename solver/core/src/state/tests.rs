//! Every field of a state survives a file.

use alewife_mesh::{
    Boundary, BoundaryId, BoundaryKind, CellId, Facet, Mesh, NodeId, PeriodicPair, Point, Topology,
};
use nalgebra::Vector3;

use super::{
    EnergyBalance, EnergyRecord, EnergySupply, ErrorOfChange, Evolving, LoadHistory,
    MomentumBalance, MomentumRecord, PropulsionHistory, SquaredError, State, StepErrors,
};
use crate::body::{Pose, Twist, Wrench};
use crate::contact::{ContactLoads, MinimumGap, Partner};
use crate::coupling::Solution;
use crate::scalar::ScalarField;
use crate::time::Bdf;
use crate::tracer::{Cloud, Fate, Particle};

/// A triangle with all that a mesh may have.
fn mesh(origin: Point<2>, nodes: &[Point<2>]) -> Mesh<2> {
    let topology = Topology {
        n_vertices: 3,
        cells: (0..6u32).map(NodeId::from).collect(),
        curved: vec![true],
        facets: vec![Facet { cell: CellId::from(0), side: 1, boundary: BoundaryId::from(0) }],
        boundaries: vec![Boundary { name: "wall".to_owned(), kind: BoundaryKind::Side }],
        periodic: vec![PeriodicPair { copy: NodeId::from(2), original: NodeId::from(1) }],
    };
    Mesh::new(nodes.iter().map(|node| node + origin).collect(), topology)
}

/// Numbers that are all different.
fn numbers(seed: f64) -> impl Iterator<Item = f64> {
    (0..).map(move |nth| (f64::from(nth) + seed).sin())
}

fn points(seed: f64) -> Vec<Point<2>> {
    let mut all = numbers(seed);
    (0..6).map(|_| Point::<2>::from_fn(|_, _| all.next().unwrap())).collect()
}

fn vectors(seed: f64, n: usize) -> Vec<Vector3<f64>> {
    let mut all = numbers(seed);
    (0..n).map(|_| Vector3::from_fn(|_, _| all.next().unwrap())).collect()
}

fn twists(seed: f64) -> Vec<Twist> {
    vec![Twist { linear: vectors(seed, 1)[0], angular: vectors(seed + 0.5, 1)[0] }]
}

fn solution(seed: f64) -> Solution<2> {
    Solution {
        velocity: points(seed),
        pressure: numbers(seed + 1.0).take(3).collect(),
        twists: twists(seed + 2.0),
        rates: Vec::new(),
        pressure_gradient: Point::<2>::new(seed, -seed),
    }
}

fn energy() -> EnergyBalance {
    let mut balance = EnergyBalance::default();
    for (nth, time) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        let power = nth as f64 + 0.25;
        let dissipation_scale = 7.0;
        let (dissipation, kinetic_energy) = (power + 0.1, power + 0.3);
        balance.add(
            true,
            EnergyRecord { time, power, dissipation, kinetic_energy, dissipation_scale },
        );
    }
    balance
}

fn momentum() -> MomentumBalance {
    let mut balance = MomentumBalance::default();
    for nth in 0..30 {
        let seed = f64::from(nth);
        balance.add_forces(&vectors(-seed, 2), &Bdf::first_order(1.0));
        balance.add(MomentumRecord {
            time: seed,
            momenta: vectors(seed, 2),
            exchange: 3.0,
            scale: 4.0,
        });
    }
    balance
}

fn propulsion() -> PropulsionHistory {
    let mut history = PropulsionHistory::default();
    history.start(&crate::coupling::PropulsionPower::of([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    let record = history.record(0.5, vectors(8.0, 1)[0], Pose::planar(0.1, 0.2, 0.3).orientation);
    history.cycles.push(record, 1.0);
    history
}

fn cloud() -> Cloud<2> {
    let [start, position, velocity, shift] = [0, 1, 2, 3].map(|nth| points(9.0)[nth]);
    let particle = Particle {
        seed: 5,
        released: 0.25,
        start,
        position,
        velocity,
        shift,
        cell: 2,
        residence: 0.75,
        is_inside: true,
        fate: Fate::Left,
    };
    Cloud { particles: vec![particle], releases: 3 }
}

/// A field that is added to [`Evolving`] has to be added here, with a value that is not its default.
fn state() -> State<2> {
    let origin = Vector3::new(0.25, -0.5, 0.0);
    let nodes = points(0.0);
    State(Evolving {
        step: 17,
        time: 1.25,
        last_step: 0.125,
        remeshes: 3,
        mesh: mesh(Point::<2>::new(origin.x, origin.y), &nodes),
        origin,
        nodes,
        nodes_before: points(1.0),
        now: solution(2.0),
        previous: solution(3.0),
        poses: vec![Pose::planar(1.0, 2.0, 0.3)],
        previous_poses: vec![Pose::planar(0.9, 1.9, 0.2)],
        shapes: crate::state::ShapeState::at_rest(numbers(0.3).take(4).collect()),
        image_shifts: vectors(4.0, 1),
        rates: points(5.0),
        accelerations: twists(6.0),
        twist_rates: twists(6.5),
        top_speed: 9.5,
        supply: EnergySupply {
            initial: Some(0.5),
            initial_speed: 0.75,
            work: 1.5,
            given_speed: 2.5,
            loads: vec![LoadHistory { largest: 3.5, free_fall: 4.5 }],
            largest_gradient: 5.5,
            gradient_speed: 6.5,
        },
        step_errors: StepErrors {
            flow: SquaredError { error: 0.25, size: 8.5 },
            ways: vec![ErrorOfChange { error: 0.125, change: 7.5 }],
        },
        contact: ContactLoads {
            energy: 0.5,
            energy_made: -0.01,
            wrenches: vec![Wrench { force: vectors(7.0, 1)[0], torque: vectors(7.5, 1)[0] }],
            on_coordinates: Vec::new(),
            contacts: Vec::new(),
            minimum_gap: Some(MinimumGap { body: 0, partner: Partner::Wall(2), gap: 0.01 }),
        },
        propulsion: vec![propulsion()],
        energy: energy(),
        momentum: momentum(),
        tracers: vec![cloud()],
        scalars: vec![scalar()],
    })
}

fn scalar() -> ScalarField {
    ScalarField {
        now: vec![0.25; 6],
        previous: vec![0.125; 6],
        fluxes: vec![-0.5],
        source: 0.75,
        initial: 1.5,
        added: -0.25,
        added_before: -0.125,
    }
}

#[test]
fn every_field_survives_a_file() {
    let state = state();
    let text = serde_json::to_string(&state).unwrap();
    let mut read: State<2> = serde_json::from_str(&text).unwrap();
    assert_eq!(read, state.without_derived(), "nodes follow from those seen from the frame");
    read.complete_mesh(&state.mesh.boundaries);
    assert_eq!(read, state);
}

//! Rigid parts of solids: exact motions of rigid bodies, and the limit of stiff materials.

use alewife_mesh::Point;
use alewife_solid::material::Law;
use alewife_solid::solid::{
    Frame, Minimiser, Motion, Order, Potential, RigidPart, Scheme, Solid, SolidError, SolidMesh,
    SolidSpec, StepInput,
};
use nalgebra::{Matrix3, Vector3};

use crate::meshes::{all_of, cube, material, square};

/// A solid whose cells with their middle in a region are rigid, of some density.
fn with_rigid<const D: usize>(
    mesh: SolidMesh<D>,
    frame: Frame,
    [poisson, density]: [f64; 2],
    held: Vec<usize>,
    is_rigid: impl Fn(&Point<D>) -> bool,
) -> SolidSpec<D> {
    let n = mesh.n_local();
    let middle = |cell: &usize| -> Point<D> {
        let vertices = &mesh.cells[cell * n..=cell * n + D];
        vertices.iter().map(|node| mesh.nodes[*node]).sum::<Point<D>>() / (D + 1) as f64
    };
    let cells = (0..mesh.n_cells()).filter(|cell| is_rigid(&middle(cell))).collect();
    SolidSpec {
        frame,
        materials: vec![material(Law::NeoHookean, 1e4, poisson)],
        material_of: Vec::new(),
        fibres: Vec::new(),
        rigid: vec![RigidPart { cells, density }],
        held,
        mesh,
    }
}

fn advance<const D: usize>(
    body: &Solid<D>,
    start: Motion,
    scheme: Scheme,
    step: f64,
    n: usize,
) -> Motion {
    let loads = vec![0.0; body.n_components()];
    let given = StepInput { scheme, step, targets: &[], loads: &loads, held: None };
    let mut minimiser = Minimiser::with_tolerance(1e-13);
    (0..n).fold(start, |motion, _| body.advance(&mut minimiser, &motion, &given).expect("it moves"))
}

/// How a free body with this tensor of inertia is turned after a time: Euler's equations.
fn turned(inertia: Matrix3<f64>, spin: Vector3<f64>, time: f64) -> Matrix3<f64> {
    let n = 4000;
    let h = time / f64::from(n);
    let inverse = inertia.try_inverse().expect("it is a body");
    let rate = |(turn, spin): (Matrix3<f64>, Vector3<f64>)| {
        (turn * spin.cross_matrix(), inverse * (inertia * spin).cross(&spin))
    };
    let mut y = (Matrix3::identity(), spin);
    for _ in 0..n {
        let add = |k: (Matrix3<f64>, Vector3<f64>), by: f64| (y.0 + k.0 * by, y.1 + k.1 * by);
        let k1 = rate(y);
        let k2 = rate(add(k1, 0.5 * h));
        let k3 = rate(add(k2, 0.5 * h));
        let k4 = rate(add(k3, h));
        y = (
            y.0 + (k1.0 + (k2.0 + k3.0) * 2.0 + k4.0) * (h / 6.0),
            y.1 + (k1.1 + (k2.1 + k3.1) * 2.0 + k4.1) * (h / 6.0),
        );
    }
    y.0
}

#[test]
fn a_rigid_box_tumbles_as_euler_s_equations_have_it() {
    let edges = Vector3::new(0.3, 0.2, 0.1);
    for order in [Order::Quadratic, Order::Linear] {
        let n = if order == Order::Linear { [2, 2, 2] } else { [1, 1, 1] };
        let mesh = cube(n, order, |x| (x - Vector3::repeat(0.5)).component_mul(&edges));
        let spec = with_rigid(mesh, Frame::Space, [0.3, 500.0], Vec::new(), |_| true);
        let body = Solid::new(spec).expect("it is a solid");
        let rest = body.at_rest();
        // By the masses of its nodes, which of linear cells are lumped
        let along = |i: usize| -> Vec<f64> {
            let nodes = (0..rest.len() / 3).flat_map(|node| [rest[3 * node + i], 0.0, 0.0]);
            nodes.collect()
        };
        let second = Matrix3::from_fn(|i, j| {
            body.times_mass(&along(i)).iter().zip(&along(j)).map(|(m, x)| m * x).sum::<f64>()
        });
        let inertia = Matrix3::identity() * second.trace() - second;
        if order == Order::Quadratic {
            let mass = 500.0 * edges.product();
            let exact = Matrix3::from_diagonal(&edges.map(|e| e * e * mass / 12.0));
            assert!((second - exact).norm() < 1e-12, "{second}");
        }
        let (spin, drift) = (Vector3::new(0.3, 0.5, 4.0), Vector3::new(0.1, -0.2, 0.3));
        let mut start = Motion::at_rest(&body);
        for node in 0..rest.len() / 3 {
            let x = Vector3::from_column_slice(&rest[3 * node..3 * node + 3]);
            let velocity = drift + spin.cross(&x);
            start.velocities[3 * node..3 * node + 3].copy_from_slice(velocity.as_slice());
        }
        let time = 1.0;
        let turn = turned(inertia, spin, time);
        let error = |scheme: Scheme, n: usize| {
            let end = advance(&body, start.clone(), scheme, time / n as f64, n);
            let apart = (0..rest.len() / 3).map(|node| {
                let x = Vector3::from_column_slice(&rest[3 * node..3 * node + 3]);
                let found = Vector3::from_column_slice(&end.places[3 * node..3 * node + 3]);
                (found - turn * x - drift * time).norm()
            });
            apart.fold(0.0, f64::max)
        };
        for (scheme, expected) in [(Scheme::ImplicitEuler, 1.0), (Scheme::Bdf2, 2.0)] {
            let (coarse, fine) = (error(scheme, 100), error(scheme, 200));
            let found = (coarse / fine).log2();
            println!("{order:?} {scheme:?}: {fine:.1e}, order {found:.2}");
            assert!((found - expected).abs() < 0.2, "{order:?} {scheme:?} {found}");
        }
        // It keeps its form to rounding
        let end = advance(&body, start.clone(), Scheme::Bdf2, time / 100.0, 100);
        let distance = |all: &[f64], a: usize, b: usize| {
            (0..3).map(|i| (all[3 * a + i] - all[3 * b + i]).powi(2)).sum::<f64>().sqrt()
        };
        let last = rest.len() / 3 - 1;
        assert!((distance(&end.places, 0, last) - distance(&rest, 0, last)).abs() < 1e-12);
    }
}

/// Places of the end of a cantilever that carries a block at its end, under its weight, and three frequencies.
fn loaded<const D: usize>(body: &Solid<D>, tip: usize) -> Vec<f64> {
    let pull = Point::from_fn(|i, _| if i == 1 { -0.05 } else { 0.0 });
    let load = body.weight(pull);
    let potential = Potential::at_rest(body, &[], &load);
    let found = Minimiser::default().minimise(&potential, &body.at_rest()).expect("it bends");
    let mut all = found.places[D * tip..D * (tip + 1)].to_vec();
    all.extend(body.frequencies(&found.places, &[], &load, 3).expect("it has modes"));
    all
}

/// That a rigid block is the limit of stiff ones.
fn check_limit<const D: usize>(name: &str, mesh: &SolidMesh<D>, frame: Frame, poisson: f64) {
    let held = all_of::<D>(&mesh.nodes_where(|x| x[0] < 1e-9));
    let spec = with_rigid(mesh.clone(), frame, [poisson, 3e3], held, |x| x[0] > 0.7);
    let tip = mesh.nodes_where(|x| x[0] > 1.0 - 1e-9)[0];
    let rigid = loaded(&Solid::new(spec.clone()).expect("it is a solid"), tip);
    let apart = |young: f64| {
        let mut stiff = spec.clone();
        let block = material(Law::NeoHookean, young, 0.3);
        stiff.material_of = vec![0; mesh.n_cells()];
        stiff.rigid[0].cells.iter().for_each(|cell| stiff.material_of[*cell] = 1);
        stiff.materials.push(alewife_solid::material::Material { density: 3e3, ..block });
        stiff.rigid.clear();
        let found = loaded(&Solid::new(stiff).expect("it is a solid"), tip);
        let pairs = found.iter().zip(&rigid);
        pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
    };
    let (soft, hard) = (apart(1e7), apart(1e8));
    println!("{name}: {rigid:.4?}, apart by {soft:.1e} and {hard:.1e}");
    assert!(hard < 1e-3 && (soft / hard - 10.0).abs() < 1.0, "{name} {soft} {hard}");
}

#[test]
fn a_rigid_block_is_the_limit_of_stiff_ones() {
    for poisson in [0.3, 0.5] {
        let mesh = square([20, 4], Order::Quadratic, |s, t| Point::from([s, 0.2 * (t - 0.5)]));
        check_limit(&format!("plane, nu = {poisson}"), &mesh, Frame::Plane, poisson);
    }
    let place = |x: Point<3>| Point::from([x[0], 0.2 * (x[1] - 0.5), 0.2 * x[2]]);
    check_limit("space", &cube([10, 2, 2], Order::Linear, place), Frame::Space, 0.3);
}

#[test]
fn a_rigid_disc_on_a_rod_moves_along_the_axis() {
    // Where nothing moves across the rod stretches as a spring: u'' of a mass at its end
    let mesh = square([10, 2], Order::Quadratic, |s, t| Point::from([s, 0.1 * t]));
    let mut held = all_of::<2>(&mesh.nodes_where(|x| x[0] < 1e-9));
    held.extend(mesh.nodes_where(|x| x[0] < 0.9 - 1e-9).iter().map(|node| 2 * node + 1));
    let spec = with_rigid(mesh, Frame::Axis, [0.3, 1e7], held, |x| x[0] > 0.9);
    let body = Solid::new(spec).expect("it is a solid");
    let lame = material(Law::NeoHookean, 1e4, 0.3).lame();
    let area = std::f64::consts::PI * 0.01;
    let (stiffness, mass) = ((lame.volume + 2.0 * lame.shear) * area / 0.9, 1e7 * 0.1 * area);
    let found = {
        let none = vec![0.0; body.n_components()];
        body.frequencies(&body.at_rest(), &[], &none, 1).expect("it has modes")[0]
    };
    // The rod has a ten-thousandth of the mass
    let error = found / (stiffness / mass).sqrt() - 1.0;
    println!("{error:+.1e}");
    assert!(error.abs() < 1e-3, "{error}");
}

#[test]
fn parts_that_touch_or_are_held_are_refused() {
    let mesh = || square([4, 1], Order::Quadratic, |s, t| Point::from([s, 0.2 * t]));
    let spec = |held| with_rigid(mesh(), Frame::Plane, [0.3, 1e3], held, |x: &Point<2>| x[0] > 0.5);
    let said = |spec| Solid::<2>::new(spec).map(|_| ());
    let end = mesh().nodes_where(|x| x[0] == 1.0);
    assert_eq!(said(spec(all_of::<2>(&end))), Err(SolidError::RigidHeld(0)));
    let mut two = spec(Vec::new());
    two.rigid.push(RigidPart { cells: vec![3], density: 1e3 });
    assert_eq!(said(two), Err(SolidError::RigidTouch([0, 1])));
    let mut none = spec(Vec::new());
    none.rigid[0].cells.clear();
    assert_eq!(said(none), Err(SolidError::RigidEmpty(0)));
    let mut light = spec(Vec::new());
    light.rigid[0].density = 0.0;
    assert!(said(light).is_err());
    let body = Solid::new(spec(Vec::new())).expect("it is a solid");
    let loads = vec![0.0; body.n_components()];
    let given = StepInput {
        scheme: Scheme::Conservative,
        step: 0.01,
        targets: &[],
        loads: &loads,
        held: None,
    };
    let refused = body.advance(&mut Minimiser::default(), &Motion::at_rest(&body), &given);
    assert_eq!(refused.map(|_| ()), Err(SolidError::Rigid("a conservative step")));
}

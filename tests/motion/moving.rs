//! What a moved mesh keeps: bits at rest, rigid motions, curves, symmetry, pairs, the axis.

use alewife_core::body::Pose;
use alewife_core::motion::{
    MeshBoundaryCondition, MeshMotion, MotionError, MotionKind, RigidMove, Stiffening,
    mesh_boundary_conditions,
};
use alewife_core::space::simplex_rule;
use alewife_mesh::{
    Boundary, BoundaryId, BoundaryKind, CellId, Domain, Facet, Mesh, NodeId, Point, Simplex,
    Sizing, Topology, check_mesh, generate,
};
use tests::Study;

use super::{disc, disc_in_square, square, tube};

fn kinds() -> Vec<MotionKind> {
    let stiffenings = [
        Stiffening::None,
        Stiffening::MasudHughes,
        Stiffening::Jacobian { exponent: 1.0 },
        Stiffening::Distance { exponent: 0.5 },
    ];
    let both = |stiffening| {
        [MotionKind::Harmonic(stiffening), MotionKind::Elastic { poisson: 0.3, stiffening }]
    };
    stiffenings.into_iter().flat_map(both).collect()
}

fn from_origin(x: f64, y: f64, angle: f64) -> RigidMove {
    RigidMove::between(&Pose::planar(0.0, 0.0, 0.0), &Pose::planar(x, y, angle))
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

#[test]
fn a_mesh_at_rest_keeps_every_bit() {
    let (domain, sphere) = tube(0.3);
    let axisymmetric = generate(&domain, &[sphere], &Sizing::graded(0.1, 0.2, 0.4)).unwrap();
    for mesh in [disc_in_square(0.1, 0.4), axisymmetric] {
        for kind in kinds() {
            let motion =
                MeshMotion::new(&mesh, kind, &mesh_boundary_conditions(&mesh, true)).unwrap();
            let pose = Pose::planar(0.3, 0.1, 0.7);
            let still = RigidMove::between(&pose, &pose);
            let mut moved = mesh.clone();
            motion.move_nodes(&mut moved, &|_, _, x| still.displacement(x)).unwrap();
            let bits = |mesh: &Mesh<2>| -> Vec<u64> {
                mesh.nodes.iter().flat_map(|x| [x.x.to_bits(), x.y.to_bits()]).collect()
            };
            assert!(bits(&moved) == bits(&mesh), "{kind:?}");
        }
    }
}

/// All kinds carry a mesh along as a whole; with k = 1 they also turn it, and elastic ones turn it
/// by small angles whatever k, since a small turn strains nothing.
#[test]
fn a_rigid_motion_of_the_whole_boundary_is_one_of_the_whole_mesh() {
    let mesh = disc_in_square(0.1, 0.4);
    let all_prescribed = vec![MeshBoundaryCondition::Prescribed; mesh.boundaries.len()];
    let (shift, turn) = (from_origin(0.7, -0.4, 0.0), from_origin(0.2, 0.1, 2.0));
    let skew = |x: &Point<2>| Point::<2>::new(-0.3 * x.y, 0.3 * x.x);
    for kind in kinds() {
        let motion = MeshMotion::new(&mesh, kind, &all_prescribed).unwrap();
        let error = |given: &dyn Fn(&Point<2>) -> Point<2>| {
            let moved = motion.displacements(&|_, _, x| given(x)).unwrap();
            largest(mesh.nodes.iter().zip(&moved).map(|(x, d)| (d - given(x)).norm()))
        };
        assert!(error(&|x| shift.displacement(x)) < 1e-13, "{kind:?}");
        match kind {
            MotionKind::Harmonic(Stiffening::None)
            | MotionKind::Elastic { stiffening: Stiffening::None, .. } => {
                assert!(error(&|x| turn.displacement(x)) < 1e-13, "{kind:?}");
            }
            MotionKind::Elastic { .. } => assert!(error(&skew) < 1e-13, "{kind:?}"),
            MotionKind::Harmonic(_) => {}
        }
    }
}

#[test]
fn a_disc_moved_by_half_its_radius_keeps_its_mesh_and_its_curve() {
    let mesh = disc_in_square(0.1, 0.4);
    for kind in kinds() {
        let motion = MeshMotion::new(&mesh, kind, &mesh_boundary_conditions(&mesh, false)).unwrap();
        let rigid = from_origin(0.25, 0.0, 0.4);
        let mut moved = mesh.clone();
        motion.move_nodes(&mut moved, &|_, _, x| rigid.displacement(x)).unwrap();
        check_mesh(&moved).unwrap();
        assert!(moved.worst_cell().unwrap().quality > 0.1, "{kind:?}: {:?}", moved.worst_cell());
        let center = Point::<2>::new(0.25, 0.0);
        for facet in mesh.facets.iter().filter(|facet| facet.boundary.index() == 4) {
            let nodes: Vec<_> =
                mesh.facet_nodes(facet).map(|node| moved.nodes[node] - center).collect();
            assert!(nodes.iter().all(|x| (x.norm() - 0.5).abs() < 1e-14));
            assert!(((nodes[2] - nodes[0]).norm() - (nodes[1] - nodes[2]).norm()).abs() < 1e-14);
        }
        for facet in mesh.facets.iter().filter(|facet| facet.boundary.index() < 4) {
            for node in mesh.facet_nodes(facet) {
                assert_eq!(moved.nodes[node], mesh.nodes[node]);
            }
        }
    }
}

/// A square frame of squares cut in four, a square body in its middle: symmetric about x = 0 and
/// y = 0.
fn frame() -> Mesh<2> {
    let n = 8;
    let place =
        |i: i32, j: i32| Point::<2>::new(0.5 * f64::from(i), 0.5 * f64::from(j)).add_scalar(-2.0);
    let is_body = |i: i32, j: i32| (3..5).contains(&i) && (3..5).contains(&j);
    let mut vertices: Vec<Point<2>> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let index = |x: Point<2>, vertices: &mut Vec<Point<2>>| {
        let known = vertices.iter().position(|y| *y == x);
        known.unwrap_or_else(|| {
            vertices.push(x);
            vertices.len() - 1
        }) as u32
    };
    let mut facets = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|&(i, j)| !is_body(i, j))
    {
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        let across = [(i, j - 1), (i + 1, j), (i, j + 1), (i - 1, j)];
        let places = corners.map(|(i, j)| place(i, j));
        let center = index(places.iter().sum::<Point<2>>() / 4.0, &mut vertices);
        for (side, (k, l)) in across.into_iter().enumerate() {
            let [a, b] = [side, (side + 1) % 4].map(|k| index(places[k], &mut vertices));
            let cell = CellId::new(triangles.len());
            if is_body(k, l) {
                facets.push(Facet { cell, side: 0, boundary: BoundaryId::new(1) });
            } else if !(0..n).contains(&k) || !(0..n).contains(&l) {
                facets.push(Facet { cell, side: 0, boundary: BoundaryId::new(0) });
            }
            triangles.push([a, b, center]);
        }
    }
    let n_vertices = vertices.len();
    let mut nodes = vertices;
    let mut cells = Vec::new();
    for corners in &triangles {
        let middles = [0, 1, 2].map(|edge| {
            let [a, b] = Simplex::<2>::EDGES[edge].map(|v| nodes[corners[v] as usize]);
            index((a + b) * 0.5, &mut nodes)
        });
        cells.extend(corners.iter().chain(&middles).copied().map(NodeId::from));
    }
    let boundary = |name: &str, kind| Boundary { name: name.into(), kind };
    let topology = Topology {
        curved: vec![false; triangles.len()],
        boundaries: vec![
            boundary("wall", BoundaryKind::Side),
            boundary("b", BoundaryKind::Body(0)),
        ],
        periodic: Vec::new(),
        n_vertices,
        cells,
        facets,
    };
    let mesh = Mesh::new(nodes, topology);
    check_mesh(&mesh).unwrap();
    mesh
}

#[test]
fn a_mirror_symmetric_motion_moves_a_symmetric_mesh_symmetrically() {
    let mesh = frame();
    let mirrored: Vec<usize> = mesh
        .nodes
        .iter()
        .map(|x| mesh.nodes.iter().position(|y| y.x == x.x && y.y == -x.y).unwrap())
        .collect();
    for kind in kinds() {
        let motion = MeshMotion::new(&mesh, kind, &mesh_boundary_conditions(&mesh, false)).unwrap();
        let moved = motion.displacements(&|_, _, _| Point::<2>::new(0.3, 0.0)).unwrap();
        let error = largest(mirrored.iter().enumerate().map(|(node, &other)| {
            let (d, m) = (moved[node], moved[other]);
            (d.x - m.x).abs().max((d.y + m.y).abs())
        }));
        assert!(error < 1e-15, "{kind:?}: {error:.1e}");
    }
}

/// d = (x^2 - y^2, -2 x y) is harmonic, and free of divergence, so it solves both equations.
#[test]
fn smooth_displacements_are_extended_with_second_order() {
    let exact = |x: &Point<2>| Point::<2>::new(x.x * x.x - x.y * x.y, -2.0 * x.x * x.y);
    let rule = simplex_rule::<2>(5);
    for kind in [
        MotionKind::Harmonic(Stiffening::None),
        MotionKind::Elastic { poisson: 0.3, stiffening: Stiffening::None },
    ] {
        let study = Study::run(&[0.4, 0.2, 0.1], |h| {
            let mesh = generate(&square(false, false), &[], &Sizing::graded(h, 0.2, h)).unwrap();
            let motion =
                MeshMotion::new(&mesh, kind, &[MeshBoundaryCondition::Prescribed; 4]).unwrap();
            let moved = motion.displacements(&|_, _, x| exact(x)).unwrap();
            let mut error = 0.0;
            for nodes in mesh.cells() {
                let [a, b, c] = [0, 1, 2].map(|i| mesh.nodes[nodes[i]]);
                let [p, q, r] = [0, 1, 2].map(|i| moved[nodes[i]]);
                let det = (b - a).perp(&(c - a));
                for (at, weight) in rule.points.iter().zip(&rule.weights) {
                    let place = a + (b - a) * at[0] + (c - a) * at[1];
                    let value = p + (q - p) * at[0] + (r - p) * at[1];
                    error += weight * det * (value - exact(&place)).norm_squared();
                }
            }
            error.sqrt()
        });
        study.assert_order(&format!("extension of a displacement, {kind:?}"), 2.0, 0.15);
    }
}

#[test]
fn points_of_the_axis_slide_on_it_and_its_corners_stay() {
    let (domain, sphere) = tube(0.0);
    let mesh = generate(&domain, &[sphere], &Sizing::graded(0.1, 0.2, 0.3)).unwrap();
    for kind in kinds() {
        let motion = MeshMotion::new(&mesh, kind, &mesh_boundary_conditions(&mesh, false)).unwrap();
        let moved = motion.displacements(&|_, _, _| Point::<2>::new(0.25, 0.0)).unwrap();
        let mut farthest = 0.0_f64;
        for facet in mesh.facets.iter().filter(|facet| facet.boundary.index() == 3) {
            for node in mesh.facet_nodes(facet) {
                let (x, d) = (mesh.nodes[node].x, moved[node]);
                assert_eq!(d.y, 0.0);
                assert!(d.x >= 0.0 && d.x <= 0.25 + 1e-15);
                if x.abs() == 2.0 {
                    assert_eq!(d.x, 0.0);
                } else if x.abs() > 0.5 {
                    farthest = farthest.max(d.x);
                }
            }
        }
        assert!(farthest > 0.15, "{kind:?}: {farthest}");
        let mut mesh = mesh.clone();
        motion.move_nodes(&mut mesh, &|_, _, _| Point::<2>::new(0.25, 0.0)).unwrap();
        check_mesh(&mesh).unwrap();
    }
}

#[test]
fn walls_let_their_points_slide_when_asked_to() {
    let mesh = disc_in_square(0.1, 0.4);
    let motion =
        MeshMotion::new(&mesh, MotionKind::default(), &mesh_boundary_conditions(&mesh, true))
            .unwrap();
    let moved = motion.displacements(&|_, _, _| Point::<2>::new(0.5, 0.2)).unwrap();
    let mut slid = [0.0_f64; 4];
    for facet in mesh.facets.iter().filter(|facet| facet.boundary.index() < 4) {
        let side = facet.boundary.index();
        for node in mesh.facet_nodes(facet) {
            let d = moved[node];
            assert_eq!(d[side / 2], 0.0);
            slid[side] = slid[side].max(d[1 - side / 2].abs());
            if mesh.nodes[node].abs() == Point::<2>::new(2.0, 2.0) {
                assert_eq!(d, Point::<2>::zeros());
            }
        }
    }
    assert!(slid.iter().all(|slid| *slid > 0.01), "{slid:?}");
}

#[test]
fn periodic_pairs_move_equally_and_lone_meshes_stay() {
    for (x, y) in [(true, false), (true, true)] {
        let bodies = [disc("a", -1.0, 0.1), disc("b", 1.2, -0.3)];
        let sizing = Sizing::graded(0.15, 0.2, 0.4);
        let mesh = generate(&square(x, y), &bodies, &sizing).unwrap();
        for kind in kinds() {
            let motion =
                MeshMotion::new(&mesh, kind, &mesh_boundary_conditions(&mesh, false)).unwrap();
            let given = |boundary: BoundaryId, _: NodeId, _: &Point<2>| {
                Point::<2>::new(0.2, if boundary == BoundaryId::new(4) { 0.1 } else { -0.1 })
            };
            let mut moved = mesh.clone();
            motion.move_nodes(&mut moved, &given).unwrap();
            check_mesh(&moved).unwrap();
            let displacements = motion.displacements(&given).unwrap();
            let mut farthest = 0.0_f64;
            for pair in &mesh.periodic {
                let (d, e) = (displacements[pair.copy], displacements[pair.original]);
                assert!((d - e).norm() < 1e-16, "{kind:?}");
                farthest = farthest.max(d.norm());
            }
            assert!(farthest > 0.1, "{kind:?}: {farthest}");
        }
        let empty = generate(&square(x, y), &[], &sizing).unwrap();
        let motion = MeshMotion::new(
            &empty,
            MotionKind::default(),
            &mesh_boundary_conditions(&empty, false),
        )
        .unwrap();
        let moved = motion.displacements(&|_, _, _| Point::<2>::zeros()).unwrap();
        assert!(moved.iter().all(|d| *d == Point::<2>::zeros()));
    }
}

#[test]
fn holds_that_do_not_fit_are_refused() {
    let domain = Domain::Disc { center: Point::<2>::zeros(), radius: 2.0 };
    let mesh = generate(&domain, &[], &Sizing::graded(0.3, 0.2, 0.5)).unwrap();
    let sliding = [MeshBoundaryCondition::Sliding { normal_axis: 0 }];
    let refused = MeshMotion::new(&mesh, MotionKind::default(), &sliding).unwrap_err();
    assert_eq!(refused, MotionError::NotAxisAligned { boundary: "wall".into() });
    let refused = MeshMotion::new(&mesh, MotionKind::default(), &[]).unwrap_err();
    assert_eq!(refused, MotionError::ConditionCount { expected: 1, found: 0 });
}

/// An inverted cell is reported, not a panic.
#[test]
fn a_mesh_moved_too_far_says_where_it_broke() {
    let mesh = disc_in_square(0.1, 0.4);
    let motion =
        MeshMotion::new(&mesh, MotionKind::default(), &mesh_boundary_conditions(&mesh, false))
            .unwrap();
    for (far, quality) in [(1.6, 0.0), (f64::NAN, f64::NEG_INFINITY)] {
        let mut moved = mesh.clone();
        motion.move_nodes(&mut moved, &|_, _, _| Point::<2>::new(far, 0.0)).unwrap();
        let worst = moved.worst_cell().unwrap();
        assert!(!worst.is_valid() && worst.quality <= quality, "{worst:?}");
    }
}

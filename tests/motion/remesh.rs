//! When a mesh is given up, and that a new one ends the reason.

use alewife_core::body::Pose;
use alewife_core::motion::{
    Fresh, Limits, MeshMotion, MotionKind, Reason, RigidMove, mesh_boundary_conditions,
    needs_remesh,
};
use alewife_mesh::{GapQuery, Mesh, Sizing, generate};

use super::{disc, square};

/// A disc in the square, its mesh moved to a pose; the reason to remesh, if any.
fn reason_after(sizing: &Sizing, start: [f64; 2], to: Pose) -> (Mesh<2>, Option<Reason<2>>) {
    let (domain, body) = (square(false, false), disc("disc", start[0], start[1]));
    let mesh = generate(&domain, std::slice::from_ref(&body), sizing).unwrap();
    let mut surroundings = GapQuery::new(&domain, std::slice::from_ref(&body)).unwrap();
    let fresh = Fresh::new(&mesh, &surroundings, Limits::default());
    assert_eq!(needs_remesh(&mesh, &fresh, &surroundings), None, "a new mesh is good");
    let motion =
        MeshMotion::new(&mesh, MotionKind::default(), &mesh_boundary_conditions(&mesh, false))
            .unwrap();
    let rigid = RigidMove::between(&Pose::planar(start[0], start[1], 0.0), &to);
    let mut moved = mesh;
    motion.move_nodes(&mut moved, &|_, _, x| rigid.displacement(x)).unwrap();
    let carried = rigid.carry(&body);
    surroundings.place_body(0, carried.center, carried.angle);
    let reason = needs_remesh(&moved, &fresh, &surroundings);
    (moved, reason)
}

#[test]
fn small_motions_need_no_mesh() {
    let sizing = Sizing::graded(0.1, 0.2, 0.4);
    let (_, reason) = reason_after(&sizing, [0.0, 0.0], Pose::planar(0.2, 0.1, 0.3));
    assert_eq!(reason, None);
}

#[test]
fn a_poor_cell_is_named_with_its_place_and_quality() {
    let sizing = Sizing::graded(0.1, 0.2, 0.4);
    let (moved, reason) = reason_after(&sizing, [0.0, 0.0], Pose::planar(0.0, 0.0, 1.5));
    let Some(Reason::Quality { cell, at, quality, when_new }) = &reason else {
        panic!("{reason:?}")
    };
    assert!(*quality < 0.4 * when_new && *when_new > 0.5);
    assert_eq!(moved.cell_quality(*cell), *quality);
    let [a, b, c] = [0, 1, 2].map(|i| moved.nodes[moved.cell(*cell)[i]]);
    assert_eq!((a + b + c) / 3.0, *at);
}

#[test]
fn a_gap_with_too_few_layers_is_named_with_its_surfaces() {
    // Cells of 0.15 at a gap of 0.45, then of 0.2: one layer and a third
    let sizing = Sizing::graded(0.15, 0.2, 0.4);
    let (_, reason) = reason_after(&sizing, [1.05, 0.0], Pose::planar(1.3, 0.0, 0.0));
    let Some(Reason::Gap { between, at, gap, layers }) = &reason else { panic!("{reason:?}") };
    assert!(between.contains(&"disc".to_string()) && between.contains(&"right".to_string()));
    assert!((gap - 0.2).abs() < 0.01 && *layers < 2.0, "{reason:?}");
    assert!(at.x > 1.7 && at.y.abs() < 0.2, "{at}");
    let text = reason.as_ref().map(ToString::to_string).unwrap();
    assert!(text.contains("layers") && text.contains("disc") && text.contains("right"), "{text}");
    // The new mesh has its layers, and no reason to be made again
    let _ = reason_after(&sizing, [1.3, 0.0], Pose::planar(1.3, 0.0, 0.0));
}

#[test]
fn overlapping_bodies_have_a_negative_gap() {
    let sizing = Sizing::graded(0.15, 0.2, 0.4);
    let (domain, bodies) = (square(false, false), [disc("a", -0.6, 0.0), disc("b", 0.6, 0.0)]);
    let mesh = generate(&domain, &bodies, &sizing).unwrap();
    let mut surroundings = GapQuery::new(&domain, &bodies).unwrap();
    let fresh = Fresh::new(&mesh, &surroundings, Limits::default());
    surroundings.place_body(0, alewife_mesh::Point::<2>::new(0.0, 0.0), 0.0);
    let reason = needs_remesh(&mesh, &fresh, &surroundings);
    assert!(matches!(reason, Some(Reason::Gap { gap, .. }) if gap < 0.0), "{reason:?}");
}

/// Narrow gaps meshed with few layers on purpose do not ask for a mesh again and again.
#[test]
fn few_layers_on_purpose_are_no_reason() {
    for layers in [1.0, 1.5, 2.0, 3.0] {
        let sizing = Sizing { gap_layers: layers, ..Sizing::graded(0.1, 0.2, 0.4) };
        for gap in [0.1, 0.01] {
            let x = 1.5 - gap;
            let (_, reason) = reason_after(&sizing, [x, 0.0], Pose::planar(x, 0.0, 0.0));
            assert_eq!(reason, None);
            let (_, reason) =
                reason_after(&sizing, [x, 0.0], Pose::planar(x + 0.6 * gap, 0.0, 0.0));
            assert!(matches!(reason, Some(Reason::Gap { .. })), "{layers} {gap}: {reason:?}");
        }
    }
}

//! How far a disc may go before its mesh is degenerate, for each kind of motion.

use alewife_core::body::Pose;
use alewife_core::motion::{
    MeshMotion, MotionKind, RigidMove, Stiffening, mesh_boundary_conditions,
};
use alewife_mesh::{Mesh, Sizing, generate};

use super::{disc, square};

/// Quality at which a mesh counts as degenerate.
const FLOOR: f64 = 0.3;

/// Largest parameter, in hundredths, up to which all cells keep the quality.
fn reach(mesh: &Mesh<2>, motion: &MeshMotion<2>, to: impl Fn(f64) -> Pose) -> f64 {
    let start = Pose::planar(0.0, 0.0, 0.0);
    let mut moved = mesh.clone();
    let mut far = 0.0;
    for step in 1..=314 {
        let parameter = 0.01 * f64::from(step);
        let rigid = RigidMove::between(&start, &to(parameter));
        motion.move_nodes(&mut moved, &|_, _, x| rigid.displacement(x)).expect("is solved");
        if moved.worst_cell().expect("has cells").quality < FLOOR {
            break;
        }
        far = parameter;
    }
    far
}

/// A disc in the square, off the middle by next to nothing: as good a mesh as any other place gets.
fn mesh(surface: f64, size: f64) -> Mesh<2> {
    let sizing = Sizing::graded(surface, 0.2, size);
    generate(&square(false, false), &[disc("disc", 1e-9, 2e-9)], &sizing).expect("is meshed")
}

/// Ways (m) along x and along the diagonal, and angle (degrees), of a disc of diameter 1 in the
/// middle of a box of side 4.
fn reaches(mesh: &Mesh<2>, kind: MotionKind, slides: bool) -> [f64; 3] {
    let motion = MeshMotion::new(mesh, kind, &mesh_boundary_conditions(mesh, slides))
        .expect("is factorised");
    let half = 0.5_f64.sqrt();
    [
        reach(mesh, &motion, |s| Pose::planar(s, 0.0, 0.0)),
        reach(mesh, &motion, |s| Pose::planar(half * s, half * s, 0.0)),
        reach(mesh, &motion, |s| Pose::planar(0.0, 0.0, s)).to_degrees(),
    ]
}

/// The table of docs/method.md, and that the kind taken by default is the one to take.
#[test]
fn the_default_motion_carries_a_disc_farthest_on_any_mesh() {
    let stiffenings = [
        ("none", Stiffening::None),
        ("Masud-Hughes", Stiffening::MasudHughes),
        ("V^-1/2", Stiffening::Jacobian { exponent: 0.5 }),
        ("V^-1", Stiffening::Jacobian { exponent: 1.0 }),
        ("d^-1/2", Stiffening::Distance { exponent: 0.5 }),
        ("d^-1", Stiffening::Distance { exponent: 1.0 }),
    ];
    let meshes = [(0.1, 0.4), (0.05, 0.2), (0.02, 0.4)].map(|(h, size)| mesh(h, size));
    for (name, stiffening) in stiffenings {
        for kind in
            [MotionKind::Harmonic(stiffening), MotionKind::Elastic { poisson: 0.0, stiffening }]
        {
            let is_default = kind == MotionKind::default();
            let is_harmonic = matches!(kind, MotionKind::Harmonic(_));
            print!("| {} | {name} |", if is_harmonic { "harmonic" } else { "elastic" });
            for mesh in &meshes {
                let [along, diagonal, turned] = reaches(mesh, kind, false);
                print!(" {along:.2} / {diagonal:.2} / {turned:.0} |");
                let is_far = along > 0.93 && diagonal > 1.15 && turned > 65.0;
                assert_eq!(is_far, is_default, "{kind:?}: {along} {diagonal} {turned}");
            }
            println!();
        }
    }
    println!("sliding walls: {:?}", meshes.map(|m| reaches(&m, MotionKind::default(), true)));
}

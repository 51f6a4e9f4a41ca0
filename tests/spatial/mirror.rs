//! Swimmers seen in a mirror: on the image of each mesh they move as images, through new meshes too.

use alewife_core::body::{MeshPoses, Orientation, Pose};
use alewife_core::case::Model;
use alewife_core::contact::Gaps;
use alewife_core::coupling::BodyShapes;
use alewife_core::motion::{Meshed, MostCells, MovingMesh, PosesByShift, RemeshError, Scene};
use alewife_core::run::{Attempt, Simulation, build_mesh, motion_settings, simulation_on};
use alewife_mesh::{Mesh, Point};
use nalgebra::{Quaternion, UnitQuaternion};
use tests::cases::case;
use tests::figure;
use tests::mirror_image;

/// The coordinate that changes its sign.
const AXIS: usize = 2;

/// Two squirmers that pass each other at skew headings, `sign` = -1 in the mirror.
fn pair(sign: f64) -> Model {
    case(&format!(
        r#"
        title = "two squirmers pass each other"
        geometry = "spatial"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.sphere.radius = 6.0
        boundary.wall = "no-slip"
        mesh = {{ size = 3.0, surface = 0.6, growth = 0.6, gap_layers = 1 }}
        time.unsteady = {{ step = 0.2, end = 2.0 }}
        [[body]]
        name = "a"
        shape.sphere.radius = 1.0
        center = [-1.6, 0.9, {za}]
        motion = "free"
        orientation.along = [1.0, 0.0, {ea}]
        gait.squirmer.modes = [1.5, 1.5]
        [[body]]
        name = "b"
        shape.sphere.radius = 1.0
        center = [1.4, -1.2, {zb}]
        motion = "free"
        orientation.along = [-1.0, -0.1, {eb}]
        gait.squirmer.modes = [1.5, -1.5]
        "#,
        za = sign * 0.7,
        ea = sign * 0.1,
        zb = sign * -0.9,
        eb = sign * 0.1,
    ))
}

/// A pose in the mirror: a rotation is one about the image of its axis, the other way.
fn image(pose: &Pose) -> Pose {
    let Quaternion { coords } = *pose.rotation().quaternion();
    let mut axis = -coords.xyz();
    let mut center = pose.center;
    axis[AXIS] = -axis[AXIS];
    center[AXIS] = -center[AXIS];
    let turn = UnitQuaternion::new_normalize(Quaternion::from_parts(coords.w, axis));
    Pose { center, orientation: Orientation::Spatial(turn) }
}

fn images(poses: &[Pose]) -> MeshPoses {
    MeshPoses::of(poses.iter().map(image))
}

/// A scene that is meshed by what the mirror shows of it.
#[derive(Debug)]
struct Mirrored {
    /// The scene as it is, for the gaps in it.
    own: Box<dyn Scene<3>>,
    /// Its image.
    image: Box<dyn Scene<3>>,
}

impl Scene<3> for Mirrored {
    fn gaps(&self) -> &dyn Gaps {
        self.own.gaps()
    }

    fn lowest_quality(&self) -> f64 {
        self.image.lowest_quality()
    }

    fn remesh_reason(
        &mut self,
        mesh: &Mesh<3>,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Option<String> {
        self.image.remesh_reason(&mirror_image(mesh, AXIS), &images(poses), shapes)
    }

    fn remesh(
        &self,
        poses: &MeshPoses,
        shapes: &BodyShapes,
        shifted: PosesByShift<'_>,
        most: MostCells,
    ) -> Result<Meshed<3>, RemeshError> {
        let shown = images(poses);
        let Meshed { mesh, scene: image, .. } =
            self.image.remesh(&shown, shapes, &|_| shown.clone(), most)?;
        let own = self.own.remesh(poses, shapes, shifted, most)?;
        let scene = Box::new(Self { own: own.scene, image });
        Ok(Meshed { mesh: mirror_image(&mesh, AXIS), scene, ..own })
    }

    fn images(&self, _: [&Mesh<3>; 2]) -> Vec<Point<3>> {
        vec![Point::<3>::zeros()]
    }
}

/// The scene of a case at time zero, with its mesh.
fn scene(model: &Model) -> Meshed<3> {
    let mesh = build_mesh::<3>(model).expect("the case is meshed");
    let Simulation { moving_mesh, state, .. } =
        simulation_on(model, mesh).expect("the case is a problem");
    let moving = moving_mesh.expect("its bodies move");
    let poses = state.in_mesh(&state.poses);
    let shapes = BodyShapes::rigid(poses.len());
    let most = MostCells(f64::INFINITY);
    moving.scene().remesh(&poses, &shapes, &|_| poses.clone(), most).expect("it is meshed again")
}

fn in_mirror(model: &Model, shown: Meshed<3>) -> Simulation<3> {
    let mesh = mirror_image(&shown.mesh, AXIS);
    let mut simulation = simulation_on(model, mesh.clone()).expect("the image is a problem");
    let settings = motion_settings(model, &simulation.problem);
    let scene = Box::new(Mirrored { own: scene(model).scene, image: shown.scene });
    let poses = simulation.state.in_mesh(&simulation.state.poses);
    let moving = MovingMesh::new(&mesh, scene, settings, poses, 0.0);
    simulation.moving_mesh = Some(moving.expect("the mesh can move"));
    simulation
}

#[test]
fn squirmers_that_pass_each_other_are_seen_in_the_mirror_as_they_are() {
    let (model, mirrored) = (pair(1.0), pair(-1.0));
    let shown = scene(&model);
    let mut one = simulation_on(&model, shown.mesh.clone()).expect("the case is a problem");
    let mut other = in_mirror(&mirrored, shown);
    let mut worst = 0.0f64;
    for _ in 0..12 {
        for simulation in [&mut one, &mut other] {
            let attempt = simulation.try_step(0.2, f64::INFINITY).expect("the step can be made");
            assert!(matches!(attempt, Attempt::Made(_)));
        }
        for (pose, seen) in one.state.poses.iter().zip(images(&other.state.poses).iter()) {
            worst = worst.max(pose.displacement_from(seen).norm());
        }
    }
    let [a, b] = [0, 1].map(|body: usize| one.state.poses[body]);
    figure!(worst, "in the mirror");
    assert!(worst < 1e-6, "{worst:e}");
    assert!(one.state.remeshes >= 2 && one.state.remeshes == other.state.remeshes);
    // They have passed each other, and turned by much more than that
    assert!(a.center.x > b.center.x + 0.5, "{a:?} {b:?}");
    let turned = a.orientation.angle_from(&one.problem.bodies[0].pose.orientation);
    assert!(turned > 1e-3, "{turned}");
}

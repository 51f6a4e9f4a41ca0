//! `Bipyramid`: a scene of few tetrahedra beside one body, meshed once with two and then with three.

use alewife_core::body::{MeshPoses, Modes, Pose, on_mesh};
use alewife_core::contact::{ContactPair, Gaps, MinimumGap, Partner};
use alewife_core::coupling::BodyShapes;
use alewife_core::motion::{Meshed, MostCells, PosesByShift, RemeshError, Scene};
use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;
use tests::three_tetrahedra;

/// A double pyramid on a body that does not turn.
#[derive(Debug, Clone)]
pub struct Bipyramid {
    n_cells: usize,
    lowest_quality: f64,
    /// Where the body was when the region was first meshed.
    start: Pose,
}

impl Bipyramid {
    /// The scene of a mesh.
    pub fn of(mesh: &Mesh<3>, start: Pose) -> Self {
        let lowest_quality = mesh.worst_cell().map_or(1.0, |worst| worst.quality);
        Self { n_cells: mesh.n_cells(), lowest_quality, start }
    }
}

impl Scene<3> for Bipyramid {
    fn gaps(&self) -> &dyn Gaps {
        &OneBody
    }

    fn lowest_quality(&self) -> f64 {
        self.lowest_quality
    }

    fn remesh_reason(&mut self, _: &Mesh<3>, _: &MeshPoses, _: &BodyShapes) -> Option<String> {
        (self.n_cells == 2).then(|| "three cells are better".to_owned())
    }

    fn remesh(
        &self,
        poses: &MeshPoses,
        _: &BodyShapes,
        _: PosesByShift<'_>,
        _: MostCells,
    ) -> Result<Meshed<3>, RemeshError> {
        let mut mesh = three_tetrahedra();
        let moved: Point<3> = on_mesh(&(poses[0].center - self.start.center));
        for node in &mut mesh.nodes {
            *node += moved;
        }
        let scene = Box::new(Self::of(&mesh, self.start));
        Ok(Meshed { mesh, scene, poses: poses.clone(), shifts: vec![Vector3::zeros()] })
    }

    fn images(&self, _: [&Mesh<3>; 2]) -> Vec<Point<3>> {
        Vec::new()
    }
}

/// One body that meets nothing.
#[derive(Debug)]
struct OneBody;

impl Gaps for OneBody {
    fn n_bodies(&self) -> usize {
        1
    }

    fn modes(&self) -> Modes {
        Modes::SPATIAL
    }

    fn body_name(&self, _: usize) -> &'static str {
        "body"
    }

    fn partner_name(&self, _: Partner) -> &'static str {
        "nothing"
    }

    fn reach(&self, _: usize) -> f64 {
        1.0
    }

    fn is_round(&self, _: usize) -> bool {
        false
    }

    fn pairs(&self, _: &[Pose], _: f64) -> Vec<ContactPair> {
        Vec::new()
    }

    fn minimum_gap(&self, _: &[Pose]) -> Option<MinimumGap> {
        None
    }

    fn minimum_gap_among(&self, _: &[Pose], _: &[usize]) -> Option<f64> {
        None
    }

    fn max_part_of(&self, _: &[Pose], _: &[f64]) -> f64 {
        1.0
    }
}

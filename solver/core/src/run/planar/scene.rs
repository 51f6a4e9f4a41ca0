//! `PlanarScene`: domain and outlines of the bodies of a planar or axisymmetric mesh.

use std::collections::BTreeMap;
use std::sync::Arc;

use alewife_mesh::{
    BoundaryId, BoundaryKind, GapQuery, Mesh, NodeId, Outline, PlacedShape, Point, Shape,
    estimate_cells, generate_wrapped,
};
use nalgebra::{SMatrix, Vector3};

use super::case::{PlanarCase, move_into};
use crate::body::{MeshPoses, Pose, on_mesh};
use crate::contact::{COORDINATES_OF_SECTION, Gaps, PlanarGaps, Section, Sections};
use crate::coupling::BodyShapes;
use crate::gait::{DeformedOutline, WavingSheet};
use crate::motion::{Fresh, RigidMove, needs_remesh};
use crate::motion::{Meshed, MostCells, PosesByShift, RemeshError, RestPlace, Scene};
use crate::structure::{SectionMotion, SectionWeight};

/// Domain and bodies as they were meshed.
#[derive(Debug)]
pub(in crate::run) struct PlanarScene {
    case: Arc<PlanarCase>,
    /// Bodies in the mesh.
    shapes: Vec<PlacedShape>,
    /// Parameters on the outlines of bodies that deform, by node.
    materials: BTreeMap<NodeId, OnOutline>,
    /// Sheet of each boundary.
    sheets: Vec<Option<WavingSheet>>,
    fresh: Fresh,
    surroundings: GapQuery,
    gaps: PlanarGaps,
}

/// The sections of a body whose outline follows coordinates.
#[derive(Debug)]
struct CarriedSections {
    outline: Outline,
    deformed: DeformedOutline,
}

impl Sections for CarriedSections {
    fn at(&self, point: &Vector3<f64>) -> Option<Section> {
        let parameter = self.outline.parameter_of(point.xy());
        let SectionMotion { place, weights } = self.deformed.section(parameter)?;
        let first = weights.iter().map(|at| at.coordinate).min()?;
        let mut section = Section { center: place, first, weights: SMatrix::zeros() };
        for SectionWeight { coordinate, linear, angular } in weights {
            let column = coordinate - first;
            if column >= COORDINATES_OF_SECTION {
                return None;
            }
            section.weights.fixed_view_mut::<3, 1>(0, column).copy_from(&linear);
            section.weights.fixed_view_mut::<3, 1>(3, column).copy_from(&angular);
        }
        Some(section)
    }
}

/// A point of the outline of a body that deforms.
#[derive(Debug, Clone, Copy)]
struct OnOutline {
    body: usize,
    parameter: f64,
}

/// A body of this shape with a pose.
fn placed(body: &PlacedShape, shape: Shape, pose: &Pose) -> PlacedShape {
    PlacedShape { shape, center: on_mesh(&pose.center), angle: pose.angle(), ..body.clone() }
}

impl PlanarScene {
    /// Takes a mesh with bodies at poses.
    pub fn new(
        case: Arc<PlanarCase>,
        mesh: &Mesh<2>,
        shapes: Vec<PlacedShape>,
        poses: &MeshPoses,
    ) -> Result<Self, RemeshError> {
        let sheets = mesh.boundaries.iter().map(|boundary| case.sheet(&boundary.name)).collect();
        let domain = &case.domain;
        let surroundings = GapQuery::new(domain, &shapes)?;
        let fresh = Fresh::new(mesh, &surroundings, case.limits);
        let walls: Vec<usize> =
            (0..domain.sides().len()).filter(|&side| domain.wall(side).is_some()).collect();
        let gaps =
            PlanarGaps::new(domain, &walls, &shapes)?.with_joined(case.pivots.iter().copied());
        let materials = materials(&case, mesh, &shapes, poses)?;
        Ok(Self { case, shapes, materials, sheets, fresh, surroundings, gaps })
    }

    /// That of a mesh with the bodies of the case carried to poses.
    pub fn restored(
        case: Arc<PlanarCase>,
        mesh: &Mesh<2>,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Result<Self, RemeshError> {
        let carried = shapes_at(&case, poses, shapes);
        Self::new(case, mesh, carried, poses)
    }
}

/// The bodies of a case with these shapes at poses.
///
/// Always carried from where they started, so that a scene that is restored has the same bits as one that has gone
/// from mesh to mesh.
fn shapes_at(case: &PlanarCase, poses: &MeshPoses, shapes: &BodyShapes) -> Vec<PlacedShape> {
    let bodies = case.start_shapes.iter().zip(&case.start_poses).zip(poses.iter()).enumerate();
    bodies
        .map(|(body, ((shape, start), pose))| {
            match shapes.deformed(body).and_then(DeformedOutline::shape) {
                Some(deformed) => placed(shape, deformed, pose),
                None => {
                    // The mesh of a body that looks the same from all sides does not turn
                    let is_turned = case.motion.turns[body];
                    let orientation = if is_turned { pose.orientation } else { start.orientation };
                    RigidMove::between(start, &Pose { orientation, ..*pose }).carry(shape)
                }
            }
        })
        .collect()
}

/// Parameters on the outlines of bodies that deform, of the nodes on them.
fn materials(
    case: &PlanarCase,
    mesh: &Mesh<2>,
    shapes: &[PlacedShape],
    poses: &MeshPoses,
) -> Result<BTreeMap<NodeId, OnOutline>, RemeshError> {
    let outline = |body: usize| {
        let outline =
            || Outline::new(&placed(&shapes[body], shapes[body].shape.clone(), &poses[body]));
        case.deforms[body].then(outline).transpose()
    };
    let outlines: Vec<Option<Outline>> =
        (0..shapes.len()).map(outline).collect::<Result<_, _>>()?;
    let mut materials = BTreeMap::new();
    for facet in &mesh.facets {
        let BoundaryKind::Body(body) = mesh.boundaries[facet.boundary].kind else { continue };
        let Some(outline) = &outlines[body] else { continue };
        for node in mesh.facet_nodes(facet) {
            let at = || OnOutline { body, parameter: outline.parameter_of(mesh.nodes[node]) };
            materials.entry(node).or_insert_with(at);
        }
    }
    Ok(materials)
}

impl Scene<2> for PlanarScene {
    fn gaps(&self) -> &dyn Gaps {
        &self.gaps
    }

    fn deformed_gaps(&self, shapes: &BodyShapes) -> Option<Box<dyn Gaps>> {
        let mut gaps: Option<PlanarGaps> = None;
        for body in 0..self.shapes.len() {
            let (Some(outline), Some(deformed)) = (shapes.outline(body), shapes.deformed(body))
            else {
                continue;
            };
            let gaps = gaps.get_or_insert_with(|| self.gaps.clone());
            let outline = outline.clone();
            if deformed.follows_coordinates() {
                let sections =
                    CarriedSections { outline: outline.clone(), deformed: deformed.clone() };
                gaps.bend_outline(body, outline, Arc::new(sections));
            } else {
                gaps.deform_outline(body, outline);
            }
        }
        gaps.map(|gaps| -> Box<dyn Gaps> { Box::new(gaps) })
    }

    fn material_position(
        &self,
        node: NodeId,
        body: usize,
        shapes: &BodyShapes,
    ) -> Option<Vector3<f64>> {
        let at = shapes.deformed(body)?.position(self.materials.get(&node)?.parameter);
        Some(Vector3::new(at.x, at.y, 0.0))
    }

    fn rest_places(&self, shapes: &BodyShapes) -> Vec<RestPlace> {
        let place = |(node, at): (&NodeId, &OnOutline)| {
            let place = shapes.deformed(at.body)?.rest_place(at.parameter)?;
            Some(RestPlace { node: *node, body: at.body, place })
        };
        self.materials.iter().filter_map(place).collect()
    }

    /// Up and down: where the nodes are along the curve makes no difference.
    fn side_displacement(
        &self,
        boundary: BoundaryId,
        reference: &Point<2>,
        time: f64,
    ) -> Option<Point<2>> {
        let sheet = self.sheets[boundary].as_ref()?;
        Some(Point::<2>::new(0.0, sheet.height(reference[0], time)))
    }

    fn has_moving_wall(&self) -> bool {
        self.sheets.iter().any(Option::is_some)
    }

    fn lowest_quality(&self) -> f64 {
        self.fresh.lowest()
    }

    fn remesh_reason(
        &mut self,
        mesh: &Mesh<2>,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Option<String> {
        let placed = shapes_at(&self.case, poses, shapes);
        for (body, PlacedShape { center, angle, .. }) in placed.into_iter().enumerate() {
            match shapes.outline(body) {
                None => self.surroundings.place_body(body, center, angle),
                Some(outline) => {
                    self.surroundings.set_body(body, outline.placed_at(center, angle));
                }
            }
        }
        needs_remesh(mesh, &self.fresh, &self.surroundings).map(|reason| reason.to_string())
    }

    fn remesh(
        &self,
        poses: &MeshPoses,
        shapes: &BodyShapes,
        shifted: PosesByShift<'_>,
        most: MostCells,
    ) -> Result<Meshed<2>, RemeshError> {
        if self.case.is_given {
            return Err(RemeshError::Given);
        }
        let case = Arc::clone(&self.case);
        let mut shapes = shapes_at(&case, poses, shapes);
        let shifts = move_into(&case.domain, &mut shapes);
        most.check_before(|limit| estimate_cells(&case.domain, &shapes, &case.sizing, limit))?;
        let mesh = generate_wrapped(&case.domain, &shapes, &case.sizing)?;
        most.check(&mesh)?;
        let poses = shifted(&shifts);
        let scene = Self::new(case, &mesh, shapes, &poses)?;
        Ok(Meshed { mesh, scene: Box::new(scene), poses, shifts })
    }

    fn images(&self, [old, new]: [&Mesh<2>; 2]) -> Vec<Point<2>> {
        self.case.domain.images_around(old.nodes.iter().chain(&new.nodes).copied())
    }
}

//! Bodies that are near each other or a wall at the start, in a case without `[contact]`.

use alewife_mesh::{Domain, Outline, Wall, closest, closest_to_wall};

use super::Findings;
use crate::model::balls::{Ball, BallGrid};
use crate::{Body, BoundaryCondition, Lock, Model, Motion, TimeSettings};

/// Gap over the thickness of the thinner body below which a step or two may close it.
const NEAR: f64 = 0.05;

pub fn check(findings: &mut Findings<'_>) {
    let model = findings.model();
    let is_unsteady = matches!(model.case.time, TimeSettings::Unsteady(_));
    if !is_unsteady || model.case.contact.is_some() || !model.mesh_moves() {
        return;
    }
    let Some(nearest) = Surroundings::new(model).nearest() else { return };
    let Near { body, other, gap, thickness } = nearest;
    let of = |body: usize| format!("\"{}\"", model.bodies[body].name);
    let other = match other {
        Other::Body(other) => of(other),
        Other::Side(side) => format!("the side `{side}`"),
    };
    findings.warning(
        &format!("body.{body}.center"),
        format!(
            "{} is within {:.1e} of {other} at the start, and nothing keeps them apart",
            of(body),
            gap.max(0.0)
        ),
        &format!(
            "if they may meet, add {}: without [contact] steps and cells shrink with the gap",
            barrier(model, body, thickness)
        ),
    );
}

/// A contact that acts over a cell at a body, whose half width is a `thickness` (m) at least.
fn barrier(model: &Model, body: usize, thickness: f64) -> String {
    let range = model.bodies[body].size.or(model.case.mesh.surface).unwrap_or(0.1 * thickness);
    format!("contact.barrier = {{ range = {:.1e}, stiffness = ... }}", range.min(0.5 * thickness))
}

/// What is near a body.
#[derive(Debug, Clone, Copy)]
enum Other {
    Body(usize),
    Side(&'static str),
}

/// A body and what is near it.
#[derive(Debug, Clone, Copy)]
struct Near {
    body: usize,
    other: Other,
    /// The gap (m).
    gap: f64,
    /// Half the width of the thinner one (m).
    thickness: f64,
}

/// The bodies of a case with what they may meet.
struct Surroundings<'a> {
    model: &'a Model,
    domain: Domain,
    outlines: Vec<Option<Outline>>,
}

impl<'a> Surroundings<'a> {
    fn new(model: &'a Model) -> Self {
        let scale = model.case.mesh.scale;
        let outlines =
            model.bodies.iter().map(|body| Outline::new(&body.placed(scale)).ok()).collect();
        Self { model, domain: model.case.mesh_domain(), outlines }
    }

    /// What is nearest, relative to its thickness, if it is near.
    fn nearest(&self) -> Option<Near> {
        self.all_near().into_iter().min_by(|one, other| {
            (one.gap / one.thickness).total_cmp(&(other.gap / other.thickness))
        })
    }

    fn all_near(&self) -> Vec<Near> {
        let mut found = Vec::new();
        let [min, max] = self.model.case.extent().in_plane();
        let mut placed = BallGrid::<2>::new(min.into(), max.into(), self.outlines.len());
        let roots: Vec<usize> =
            (0..self.outlines.len()).map(|body| root(self.model, body)).collect();
        let yields = |body: usize| yields(&self.model.bodies[roots[body]]);
        for (body, outline) in self.outlines.iter().enumerate() {
            let Some(outline) = outline else { continue };
            let own = self.model.bodies[body].shape.half_width();
            let circle = Ball { center: outline.center(), radius: outline.reach() * (1.0 + NEAR) };
            let mut others: Vec<usize> = placed.near(&circle).collect();
            others.sort_unstable();
            others.dedup();
            for other in others {
                let Some(facing) = &self.outlines[other] else { continue };
                if roots[body] == roots[other] || !(yields(body) || yields(other)) {
                    continue;
                }
                let thickness = own.min(self.model.bodies[other].shape.half_width());
                let gap = closest(outline, facing).gap;
                if gap < NEAR * thickness {
                    found.push(Near { body, other: Other::Body(other), gap, thickness });
                }
            }
            for (side, wall) in self.walls().filter(|_| yields(body)) {
                let gap = closest_to_wall(outline, &wall).gap;
                if gap < NEAR * own {
                    found.push(Near { body, other: Other::Side(side), gap, thickness: own });
                }
            }
            placed.insert(body, &circle);
        }
        found
    }

    /// Sides that bodies cannot pass.
    fn walls(&self) -> impl Iterator<Item = (&'static str, Wall)> {
        let sides = self.domain.sides().iter().enumerate();
        sides.filter_map(|(index, side)| {
            let condition = self.model.case.boundary.get(*side);
            let is_open = condition.is_some_and(BoundaryCondition::is_open);
            self.domain.wall(index).filter(|_| !is_open).map(|wall| (*side, wall))
        })
    }
}

/// What a body hangs on in the end.
fn root(model: &Model, body: usize) -> usize {
    let mut root = body;
    while let Some(above) =
        model.joint_above(root).and_then(|joint| model.body_index(&model.joints[joint].parent))
    {
        root = above;
    }
    root
}

/// Whether a body that hangs on nothing can give way.
fn yields(Body { motion, locked, .. }: &Body) -> bool {
    *motion == Motion::Free && !(locked.contains(&Lock::X) && locked.contains(&Lock::Y))
}

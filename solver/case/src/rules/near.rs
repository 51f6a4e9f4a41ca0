//! Bodies that come near each other or a wall in a case without `[contact]`.

use alewife_mesh::{Domain, Outline, Wall, closest, closest_to_wall};

use super::Findings;
use super::strokes::{Tree, cycle_of};
use super::swing::swing;
use crate::balls::{Ball, BallGrid};
use crate::numbers::significant;
use crate::{Body, BoundaryCondition, Lock, Model, Motion, TimeSettings};

/// Gap over the thickness of the thinner body below which a step or two may close it.
const NEAR: f64 = 0.05;

/// Times of a cycle at which bodies are looked at.
const TIMES: u32 = 24;

/// Bodies above which strokes are not followed: their number of gaps is what `[contact]` is for.
const FOLLOWED: usize = 100;

pub fn check(findings: &mut Findings<'_>) {
    let model = findings.model();
    let is_unsteady = matches!(model.case.time, TimeSettings::Unsteady(_));
    if !is_unsteady || model.case.contact.is_some() || !model.mesh_moves() {
        return;
    }
    let Some(nearest) = Surroundings::new(model).nearest() else {
        check_ahead(findings);
        return;
    };
    let Near { body, other, gap, thickness } = nearest;
    let of = |body: usize| format!("\"{}\"", model.bodies[body].name);
    let other = match other {
        Other::Body(other) => of(other),
        Other::Side(side) => format!("the side `{side}`"),
    };
    findings.warning(
        &format!("body.{body}.center"),
        format!(
            "by its place, stroke or gait {} comes within {:.1e} of {other}, and nothing keeps them \
             apart",
            of(body),
            gap.max(0.0)
        ),
        &format!(
            "if they may meet, add {}: without [contact] steps and cells shrink with the gap",
            barrier(model, body, thickness)
        ),
    );
}

/// Warns of a body that swims or is drawn to a side or another body and gets there before the end, in any
/// geometry.
pub fn check_ahead(findings: &mut Findings<'_>) {
    let model = findings.model();
    let TimeSettings::Unsteady(time) = &model.case.time else { return };
    if model.case.contact.is_some() || !model.mesh_moves() {
        return;
    }
    let Some(met) = model.first_meeting().filter(|met| met.time < time.end) else { return };
    let other = if met.is_at_side { "a side of the domain" } else { "another body" };
    let thickness = model.bodies[met.body].shape.half_width();
    findings.warning(
        &format!("body.{}.{}", met.body, if met.swims { "gait" } else { "center" }),
        format!(
            "\"{}\" heads for {other}: straight on, at its speed in free fluid, it is there {} t = {}, \
             before the end at {}, and nothing keeps them apart",
            model.bodies[met.body].name,
            if met.swims { "at" } else { "at the latest about" },
            significant(met.time),
            time.end
        ),
        &format!(
            "add {}, or end before: without [contact] steps and cells shrink with the gap",
            barrier(model, met.body, thickness)
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

/// A body and what it comes near.
#[derive(Debug, Clone, Copy)]
struct Near {
    body: usize,
    other: Other,
    /// Least gap (m).
    gap: f64,
    /// Half the width of the thinner one (m).
    thickness: f64,
}

/// The bodies of a case with what they may meet.
struct Surroundings<'a> {
    model: &'a Model,
    domain: Domain,
    outlines: Vec<Option<Outline>>,
    /// The first of the bodies that hang together, of each body.
    roots: Vec<usize>,
    /// How far a gait or a stroke takes the surface of each body (m).
    swings: Vec<f64>,
    trees: Vec<Tree<'a>>,
}

impl<'a> Surroundings<'a> {
    fn new(model: &'a Model) -> Self {
        let scale = model.case.mesh.scale;
        let outlines =
            model.bodies.iter().map(|body| Outline::new(&body.placed(scale)).ok()).collect();
        let mut swings: Vec<f64> = model.bodies.iter().map(swing).collect();
        let mut roots: Vec<usize> = (0..model.bodies.len()).collect();
        let children = model.children();
        let mut trees = Vec::new();
        for root in (0..model.bodies.len()).filter(|body| model.joint_above(*body).is_none()) {
            if children[root].is_empty() {
                continue;
            }
            let tree = Tree::new(model, &children, root);
            for way in tree.ways(TIMES) {
                roots[way.body] = root;
                swings[way.body] += way.length;
            }
            trees.push(tree);
        }
        let domain = model.case.mesh_domain();
        Self { model, domain, outlines, roots, swings, trees }
    }

    /// What comes nearest, relative to its thickness, if it comes near.
    fn nearest(&self) -> Option<Near> {
        let candidates = self.candidates();
        let followed = self.model.bodies.len() <= FOLLOWED;
        let near = candidates.into_iter().filter_map(|mut near| {
            if followed {
                near.gap = near.gap.min(self.least_gap(&near));
            }
            (near.gap < NEAR * near.thickness).then_some(near)
        });
        near.min_by(|one, other| {
            (one.gap / one.thickness).total_cmp(&(other.gap / other.thickness))
        })
    }

    /// Pairs that may come near each other, with their gaps at the start less what gaits take.
    fn candidates(&self) -> Vec<Near> {
        let mut found = Vec::new();
        let [min, max] = self.model.case.extent().in_plane();
        let mut grid = BallGrid::<2>::new(min.into(), max.into(), self.outlines.len());
        for (body, outline) in self.outlines.iter().enumerate() {
            let Some(outline) = outline else { continue };
            let spec = &self.model.bodies[body];
            let own = spec.shape.half_width();
            let room = outline.reach() * (1.0 + NEAR) + self.swings[body];
            let circle = Ball { center: outline.center(), radius: room };
            let mut near: Vec<usize> = grid.near(&circle).collect();
            near.sort_unstable();
            near.dedup();
            for other in near {
                let Some(facing) = &self.outlines[other] else { continue };
                let facing_spec = &self.model.bodies[other];
                let thickness = own.min(facing_spec.shape.half_width());
                let (body_yields, other_yields) =
                    (yields(self.model, body), yields(self.model, other));
                if self.roots[body] == self.roots[other] || !(body_yields || other_yields) {
                    continue;
                }
                let gap = closest(outline, facing).gap;
                let swings = self.swings[body] + self.swings[other];
                if gap - swings < NEAR * thickness {
                    let gap = gap - swing(spec) - swing(facing_spec);
                    found.push(Near { body, other: Other::Body(other), gap, thickness });
                }
            }
            if yields(self.model, body) {
                for (side, wall) in self.walls() {
                    let gap = closest_to_wall(outline, &wall).gap;
                    if gap - self.swings[body] < NEAR * own {
                        let (gap, other) = (gap - swing(spec), Other::Side(side));
                        found.push(Near { body, other, gap, thickness: own });
                    }
                }
            }
            grid.insert(body, &circle);
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

    /// Least gap over the cycles of the strokes, the roots where they start (m).
    fn least_gap(&self, near: &Near) -> f64 {
        let mut least = f64::INFINITY;
        let tree = |body: usize| self.trees.iter().find(|tree| tree.root() == self.roots[body]);
        let of_body = tree(near.body);
        let of_other = match near.other {
            Other::Body(other) => tree(other),
            Other::Side(_) => None,
        };
        let end = of_body.iter().chain(&of_other).map(|tree| cycle_of(tree)).fold(0.0, f64::max);
        if end == 0.0 {
            return least;
        }
        for nth in 1..=TIMES {
            let time = end * f64::from(nth) / f64::from(TIMES);
            let at = |tree: Option<&Tree<'_>>, body: usize| match tree {
                Some(tree) => tree.outline_at(body, time),
                None => self.outlines[body].clone(),
            };
            let Some(outline) = at(of_body, near.body) else { continue };
            let gap = match near.other {
                Other::Body(other) => at(of_other, other)
                    .map_or(f64::INFINITY, |facing| closest(&outline, &facing).gap),
                Other::Side(side) => {
                    let wall = self.walls().find(|(name, _)| *name == side);
                    wall.map_or(f64::INFINITY, |(_, wall)| closest_to_wall(&outline, &wall).gap)
                }
            };
            least = least.min(gap);
        }
        least
    }
}

/// Whether a body, or what it hangs on, can give way.
fn yields(model: &Model, body: usize) -> bool {
    let mut root = body;
    while let Some(above) =
        model.joint_above(root).and_then(|joint| model.body_index(&model.joints[joint].parent))
    {
        root = above;
    }
    let Body { motion, locked, .. } = &model.bodies[root];
    *motion == Motion::Free && !(locked.contains(&Lock::X) && locked.contains(&Lock::Y))
}

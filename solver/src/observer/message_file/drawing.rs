//! What viewers are shown besides rigid bodies: bodies that deform, walls, arms, forces.

use std::collections::{BTreeMap, HashMap, HashSet};

use alewife_mesh::{BoundaryKind, Facet, Mesh, NodeId, Point};
use nalgebra::Vector3;
use serde_json::Value;

use super::foxglove::WORLD;
use super::primitives::{Arrow, Colour, Line, Primitives, SceneUpdate, Triangles, Xyz};
use crate::body::{Pose, in_space};
use crate::case::{Geometry, Model};
use crate::observer::run_directory::joint_ends;
use crate::run::BodyReport;

/// Part of the longest extent of the walls by which they have to move to be drawn again.
const NOTICEABLE: f64 = 0.01;
/// Part of the largest force below which a force is not drawn.
const LEAST_FORCE: f64 = 1e-3;

/// The surface of a body as the mesh has it, in the body's frame: its outline, in space its faces.
pub fn surface<const D: usize>(
    mesh: &Mesh<D>,
    body: usize,
    pose: &Pose,
    geometry: Geometry,
    ink: Colour,
) -> Primitives {
    let is_own =
        |facet: &&Facet| mesh.boundaries[facet.boundary.index()].kind == BoundaryKind::Body(body);
    let facets: Vec<&Facet> = mesh.facets.iter().filter(is_own).collect();
    let shift = image_shift(mesh, &facets, pose);
    let place =
        |node: NodeId| pose.to_body(&(in_space(&(mesh.nodes[node.index()] - shift)) - pose.center));
    if D == 3 {
        return Primitives {
            triangles: faces(mesh, &facets, &place, ink).into_iter().collect(),
            ..Primitives::default()
        };
    }
    let mut points: Vec<Vector3<f64>> = outline(mesh, &facets).into_iter().map(&place).collect();
    if geometry == Geometry::Axisymmetric {
        // The other half; the axis of revolution goes through the body's frame along its x
        let mirrored = points.iter().rev().map(|p| Vector3::new(p.x, -p.y, p.z));
        let mirrored: Vec<_> = mirrored.collect();
        points.extend(mirrored);
    }
    Primitives { lines: vec![Line::closed(&points, ink)], ..Primitives::default() }
}

/// Whole periods by which a periodic mesh has a body away from its pose.
fn image_shift<const D: usize>(mesh: &Mesh<D>, facets: &[&Facet], pose: &Pose) -> Point<D> {
    let mut shift = Point::<D>::zeros();
    if mesh.periodic.is_empty() || facets.is_empty() {
        return shift;
    }
    let mut mean = Point::<D>::zeros();
    for facet in facets {
        mean += mesh.nodes[mesh.facet_vertices(facet)[0].index()] / facets.len() as f64;
    }
    let away = mean - Point::<D>::from_fn(|axis, _| pose.center[axis]);
    for pair in &mesh.periodic {
        let period = mesh.nodes[pair.copy.index()] - mesh.nodes[pair.original.index()];
        let n = ((away - shift).dot(&period) / period.norm_squared()).round();
        if n != 0.0 {
            shift += period * n;
        }
    }
    shift
}

/// Nodes of facets in the plane, one after the other along the outline.
fn outline<const D: usize>(mesh: &Mesh<D>, facets: &[&Facet]) -> Vec<NodeId> {
    let ends = |facet: &Facet| {
        let nodes = mesh.facet_vertices(facet);
        [nodes[0], nodes[D - 1]]
    };
    let begins: HashMap<NodeId, &Facet> = facets.iter().map(|f| (ends(f)[0], *f)).collect();
    let reached: HashSet<NodeId> = facets.iter().map(|f| ends(f)[1]).collect();
    // An outline that ends at the axis begins there, too
    let first = facets.iter().find(|f| !reached.contains(&ends(f)[0])).or(facets.first());
    let mut nodes = Vec::with_capacity(2 * facets.len());
    let mut next = first.copied();
    while let Some(facet) = next.filter(|_| nodes.len() < 2 * facets.len()) {
        let [from, to] = ends(facet);
        nodes.push(from);
        nodes.extend(mesh.facet_inner_nodes(facet));
        next = begins.get(&to).copied();
        if next.is_none() {
            nodes.push(to);
        }
    }
    nodes
}

/// Flat triangles between the vertices of faces in space.
fn faces<const D: usize>(
    mesh: &Mesh<D>,
    facets: &[&Facet],
    place: &dyn Fn(NodeId) -> Vector3<f64>,
    ink: Colour,
) -> Option<Triangles> {
    let mut numbers: BTreeMap<NodeId, usize> = BTreeMap::new();
    let (mut points, mut indices) = (Vec::new(), Vec::with_capacity(3 * facets.len()));
    for facet in facets {
        for node in mesh.facet_vertices(facet) {
            let number = *numbers.entry(node).or_insert_with(|| {
                points.push(Xyz::of(&place(node)));
                points.len() - 1
            });
            indices.push(number);
        }
    }
    (!indices.is_empty()).then(|| Triangles::new(points, indices, ink))
}

/// Lowest and highest corner of the sides of the domain.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WallBox {
    low: [f64; 3],
    high: [f64; 3],
}

impl WallBox {
    /// That of a mesh; nothing without sides that are drawn.
    pub fn of<const D: usize>(mesh: &Mesh<D>) -> Option<Self> {
        let mut found: Option<Self> = None;
        let mut is_drawn = false;
        let periodic = periodic_nodes(mesh);
        for facet in sides(mesh) {
            is_drawn |= !is_periodic(mesh, facet, &periodic);
            // Nodes on curved edges, too: they are where the side is, however coarse its facets
            for node in mesh.facet_nodes(facet) {
                let at: [f64; 3] = in_space(&mesh.nodes[node.index()]).into();
                let all = found.get_or_insert(Self { low: at, high: at });
                for axis in 0..3 {
                    all.low[axis] = all.low[axis].min(at[axis]);
                    all.high[axis] = all.high[axis].max(at[axis]);
                }
            }
        }
        found.filter(|_| is_drawn)
    }

    /// Whether it is noticeably elsewhere.
    pub fn differs(&self, other: &Self) -> bool {
        let extent = (0..3).map(|axis| self.high[axis] - self.low[axis]).fold(0.0, f64::max);
        let most = (0..3).map(|axis| {
            let [low, high] =
                [self.low[axis] - other.low[axis], self.high[axis] - other.high[axis]];
            low.abs().max(high.abs())
        });
        most.fold(0.0, f64::max) > NOTICEABLE * extent
    }

    /// That of a scene of walls that was written before.
    pub fn of_scene(scene: &Value) -> Option<Self> {
        let note = scene["entities"].get(0)?["metadata"].get(0)?["value"].as_str()?;
        serde_json::from_str(note).ok()
    }
}

fn sides<const D: usize>(mesh: &Mesh<D>) -> impl Iterator<Item = &Facet> {
    let is_side =
        |facet: &&Facet| mesh.boundaries[facet.boundary.index()].kind == BoundaryKind::Side;
    mesh.facets.iter().filter(is_side)
}

fn periodic_nodes<const D: usize>(mesh: &Mesh<D>) -> HashSet<NodeId> {
    mesh.periodic.iter().flat_map(|pair| [pair.copy, pair.original]).collect()
}

fn is_periodic<const D: usize>(mesh: &Mesh<D>, facet: &Facet, periodic: &HashSet<NodeId>) -> bool {
    mesh.facet_vertices(facet).iter().all(|node| periodic.contains(node))
}

/// The sides of the domain but for periodic ones, in the world.
pub fn walls<const D: usize>(
    mesh: &Mesh<D>,
    geometry: Geometry,
    place: &WallBox,
    time: f64,
) -> SceneUpdate {
    let periodic = periodic_nodes(mesh);
    let mut by_name: BTreeMap<&str, Vec<&Facet>> = BTreeMap::new();
    for facet in sides(mesh) {
        if !is_periodic(mesh, facet, &periodic) {
            let name = mesh.boundaries[facet.boundary.index()].name.as_str();
            by_name.entry(name).or_default().push(facet);
        }
    }
    let note = serde_json::to_string(place).unwrap_or_default();
    let at = |node: NodeId| in_space(&mesh.nodes[node.index()]);
    let entities = by_name.into_iter().map(|(name, facets)| {
        let mut drawn = Primitives::default();
        if D == 3 {
            drawn.triangles.extend(faces(mesh, &facets, &at, Colour::new([0.5, 0.55, 0.6, 0.15])));
        } else {
            let mut points = Vec::with_capacity(4 * facets.len());
            for facet in facets {
                let ends = mesh.facet_vertices(facet).map(at);
                points.extend(ends);
                if geometry == Geometry::Axisymmetric {
                    points.extend(ends.map(|p| Vector3::new(p.x, -p.y, p.z)));
                }
            }
            drawn.lines.push(Line::between_pairs(&points, Colour::new([0.5, 0.55, 0.6, 1.0])));
        }
        drawn.entity(WORLD, name, time, ["box", &note])
    });
    SceneUpdate::of(entities.collect())
}

/// Two bodies and the points of theirs between which an arm is.
#[derive(Debug)]
pub struct Arm {
    bodies: [usize; 2],
    ends: [Vector3<f64>; 2],
}

impl Arm {
    /// All arms between points that are given in the frames of bodies.
    pub fn all(model: &Model) -> Vec<Self> {
        let arms = model.joints.iter().filter(|joint| joint.kind.is_arm());
        arms.filter_map(|joint| {
            let bodies = [model.body_index(&joint.parent)?, model.body_index(&joint.child)?];
            Some(Self { bodies, ends: joint_ends(model, joint) })
        })
        .collect()
    }
}

/// All arms in the world, as lines.
pub fn arms(arms: &[Arm], bodies: &[BodyReport], time: f64) -> SceneUpdate {
    let points: Vec<Vector3<f64>> = arms
        .iter()
        .flat_map(|arm| {
            std::array::from_fn::<_, 2, _>(|i| {
                let pose = &bodies[arm.bodies[i]].pose;
                pose.center + pose.to_world(&arm.ends[i])
            })
        })
        .collect();
    let lines = vec![Line::between_pairs(&points, Colour::new([0.55, 0.57, 0.6, 1.0]))];
    let drawn = Primitives { lines, ..Primitives::default() };
    SceneUpdate::of(vec![drawn.entity(WORLD, "arms", time, ["arms", &arms.len().to_string()])])
}

/// Forces of the fluid and of contact on bodies as arrows, the longest as long as `longest` (m).
pub fn forces(bodies: &[BodyReport], longest: f64, time: f64) -> SceneUpdate {
    let inks = [Colour::new([0.1, 0.45, 0.85, 1.0]), Colour::new([0.85, 0.25, 0.1, 1.0])];
    let both = |body: &BodyReport| [body.load.force, body.contact.force];
    let most = bodies.iter().flat_map(both).map(|force| force.norm()).fold(0.0, f64::max);
    let mut drawn = Primitives::default();
    for body in bodies {
        for (force, ink) in both(body).into_iter().zip(inks) {
            if force.norm().is_finite() && most > 0.0 && force.norm() > LEAST_FORCE * most {
                let length = longest * force.norm() / most;
                drawn.arrows.push(Arrow::new(&body.pose.center, &force, length, ink));
            }
        }
    }
    let per_length = (most / longest).to_string();
    SceneUpdate::of(vec![drawn.entity(WORLD, "forces", time, ["force per length", &per_length])])
}

//! From `[[swimmer]]` to bodies, joints and groups of bodies.

use std::f64::consts::{PI, TAU};

use alewife_mesh::Point;
use nalgebra::Rotation2;

use super::body::{Body, GaitSpec, ShapeSpec};
use super::joint::{Joint, JointKind};
use super::stroke::Stroke;
use super::swimmer::{Copies, SwimmerKind, SwimmerSpec};
use super::{Case, Geometry, Motion};

/// Trials of a random place for each copy.
const TRIALS: usize = 20_000;

/// Bodies that are told of as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Name in `series.csv`.
    pub name: String,
    /// Its bodies; the first one is that the others hang on.
    pub bodies: Vec<usize>,
    /// Time of one cycle (s).
    pub period: Option<f64>,
    /// Force per velocity that drags it when towed (N s/m).
    pub resistance: Option<f64>,
}

/// What is wrong with a swimmer: key, message, help.
pub type Refusal = (String, String, String);

/// A body of a swimmer before it is placed: the joint to its parent, both by position in the list.
struct Part {
    shape: ShapeSpec,
    gait: Option<GaitSpec>,
    hangs: Option<(usize, [f64; 2], [f64; 2], JointKind)>,
}

/// Appends the bodies and joints of all swimmers to those of a case, and groups them.
///
/// # Errors
/// When numbers of radii and arms do not fit, a body is not there, or there is no room.
pub fn expand(case: &mut Case) -> Result<(), Refusal> {
    let swimmers = case.swimmer.clone();
    let mut random = None;
    for (index, swimmer) in swimmers.iter().enumerate() {
        let key = format!("swimmer.{index}");
        let own_period = swimmer.period.or_else(|| period(&swimmer.kind));
        if let SwimmerKind::Bodies(names) = &swimmer.kind {
            let bodies = names.iter().map(|name| {
                case.body.iter().position(|body| body.name == *name).ok_or_else(|| {
                    let known: Vec<&str> =
                        case.body.iter().map(|body| body.name.as_str()).collect();
                    (
                        format!("{key}.kind.bodies"),
                        format!("there is no body \"{name}\" before it"),
                        format!("bodies: {}", known.join(", ")),
                    )
                })
            });
            let bodies = bodies.collect::<Result<Vec<usize>, Refusal>>()?;
            let period = own_period.or_else(|| bodies_period(case, &bodies));
            let (name, resistance) = (swimmer.name.clone(), swimmer.resistance);
            case.group.push(Group { name, bodies, period, resistance });
            continue;
        }
        let parts = parts(&key, &swimmer.kind, case.geometry)?;
        for (name, center, angle) in places(case, &key, swimmer, &parts, &mut random)? {
            let first = case.body.len();
            for (nth, place) in put(&parts, center, angle).into_iter().enumerate() {
                let part = &parts[nth];
                let own =
                    if parts.len() == 1 { name.clone() } else { format!("{name}-{}", nth + 1) };
                if let Some((parent, on_parent, on_child, kind)) = &part.hangs {
                    case.joint.push(Joint {
                        parent: format!("{name}-{}", parent + 1),
                        child: own.clone(),
                        on_parent: *on_parent,
                        on_child: *on_child,
                        kind: kind.clone(),
                        is_made: true,
                    });
                }
                case.body.push(Body {
                    name: own,
                    shape: part.shape.clone(),
                    center: vec![place[0], place[1]],
                    angle: place[2],
                    density: swimmer.density,
                    motion: if part.hangs.is_none() {
                        swimmer.motion.clone()
                    } else {
                        Motion::Free
                    },
                    locked: Vec::new(),
                    gait: part.gait.clone(),
                    force: Vec::new(),
                    torque: 0.0,
                    load_factor: None,
                    spring: None,
                    size: swimmer.size,
                    swimmer: Some(index),
                });
            }
            let mut bodies: Vec<usize> = (first..case.body.len()).collect();
            bodies.sort_by_key(|body| parts[body - first].hangs.is_some());
            let (period, resistance) = (own_period, swimmer.resistance);
            case.group.push(Group { name, bodies, period, resistance });
        }
    }
    for (index, body) in case.body.iter().enumerate() {
        let is_grouped = case.group.iter().any(|group| group.bodies.contains(&index));
        if body.gait.is_some() && !is_grouped {
            let period = body.gait.as_ref().and_then(GaitSpec::period);
            let (name, bodies) = (body.name.clone(), vec![index]);
            case.group.push(Group { name, bodies, period, resistance: None });
        }
    }
    Ok(())
}

/// Bodies and joints of a kind.
fn parts(key: &str, kind: &SwimmerKind, geometry: Geometry) -> Result<Vec<Part>, Refusal> {
    let fits = |what: &str, found: usize, wanted: usize| {
        if found == wanted {
            return Ok(());
        }
        let message = format!("{found} {what} are given, and {wanted} are wanted");
        Err((format!("{key}.kind"), message, "give one for each".to_owned()))
    };
    let round = |radius: f64| match geometry {
        Geometry::Planar => ShapeSpec::Disc { radius },
        Geometry::Axisymmetric => ShapeSpec::Sphere { radius },
    };
    Ok(match kind {
        SwimmerKind::Body { shape, gait } => {
            vec![Part { shape: shape.clone(), gait: gait.clone(), hangs: None }]
        }
        SwimmerKind::LinkedSpheres { radii, arms, gaits } => {
            fits("arms", arms.len(), radii.len().saturating_sub(1))?;
            if !gaits.is_empty() {
                fits("gaits", gaits.len(), radii.len())?;
            }
            let middle = radii.len().saturating_sub(1) / 2;
            let hang = |nth: usize| {
                let (parent, arm, direction) = match nth {
                    _ if nth == middle => return None,
                    _ if nth > middle => (nth - 1, nth - 1, 0.0),
                    _ => (nth + 1, nth, PI),
                };
                let kind = JointKind::Arm { length: arms[arm].clone(), direction };
                Some((parent, [0.0; 2], [0.0; 2], kind))
            };
            let part = |(nth, radius): (usize, &f64)| Part {
                shape: round(*radius),
                gait: gaits.get(nth).cloned(),
                hangs: hang(nth),
            };
            radii.iter().enumerate().map(part).collect()
        }
        SwimmerKind::Star { radius, radii, arms, directions } => {
            fits("arms", arms.len(), radii.len())?;
            if !directions.is_empty() {
                fits("directions", directions.len(), radii.len())?;
            }
            let mut parts = vec![Part { shape: round(*radius), gait: None, hangs: None }];
            for (nth, (radius, arm)) in radii.iter().zip(arms).enumerate() {
                let even = TAU * nth as f64 / radii.len() as f64;
                let direction = directions.get(nth).copied().unwrap_or(even);
                let kind = JointKind::Arm { length: arm.clone(), direction };
                let hangs = Some((0, [0.0; 2], [0.0; 2], kind));
                parts.push(Part { shape: round(*radius), gait: None, hangs });
            }
            parts
        }
        SwimmerKind::Chain { links, gap, joints } => {
            fits("joints", joints.len(), links.len().saturating_sub(1))?;
            let middle = links.len().saturating_sub(1) / 2;
            let tip = |nth: usize| links[nth][0] + 0.5 * gap;
            let hang = |nth: usize| {
                let (parent, pivot, side) = match nth {
                    _ if nth == middle => return None,
                    // Behind the middle: towards -x
                    _ if nth > middle => (nth - 1, nth - 1, -1.0),
                    _ => (nth + 1, nth, 1.0),
                };
                let kind = JointKind::from(joints[pivot].clone());
                Some((parent, [side * tip(parent), 0.0], [-side * tip(nth), 0.0], kind))
            };
            let part = |(nth, semi_axes): (usize, &[f64; 2])| Part {
                shape: ShapeSpec::Ellipse { semi_axes: *semi_axes },
                gait: None,
                hangs: hang(nth),
            };
            links.iter().enumerate().map(part).collect()
        }
        SwimmerKind::Bodies(_) => Vec::new(),
    })
}

/// Centres and angles of parts at time zero, in their order.
fn put(parts: &[Part], center: Point<2>, angle: f64) -> Vec<[f64; 3]> {
    let mut places: Vec<Option<[f64; 3]>> = vec![None; parts.len()];
    // A chain of n parts is placed after n rounds at the latest.
    for _ in 0..parts.len() {
        for (nth, part) in parts.iter().enumerate() {
            places[nth] = match &part.hangs {
                None => Some([center.x, center.y, angle]),
                Some((parent, on_parent, on_child, kind)) => {
                    places[*parent].map(|at| hang(at, *on_parent, *on_child, kind, 0.0))
                }
            };
        }
    }
    places.into_iter().flatten().collect()
}

/// Place at a time (s) of a child whose parent is at a place.
pub fn hang(
    parent: [f64; 3],
    on_parent: [f64; 2],
    on_child: [f64; 2],
    kind: &JointKind,
    time: f64,
) -> [f64; 3] {
    let (arm, bend) = match kind {
        JointKind::Arm { length, direction } => {
            (Rotation2::new(*direction) * Point::<2>::new(length.at(time)[0], 0.0), 0.0)
        }
        JointKind::Bent { angle } => (Point::<2>::zeros(), angle.at(time)[0]),
        JointKind::Hinge(hinge) => (Point::<2>::zeros(), hinge.rest),
    };
    let angle = parent[2] + bend;
    let joint = Rotation2::new(parent[2]) * (Point::<2>::from(on_parent) + arm);
    let back = Rotation2::new(angle) * Point::<2>::from(on_child);
    // An arm on the axis stays on it to the last bit.
    let across =
        if parent[2] == 0.0 && joint.y.abs() < 1e-15 * joint.x.abs() { 0.0 } else { joint.y };
    [parent[0] + joint.x - back.x, parent[1] + across - back.y, angle]
}

fn period(kind: &SwimmerKind) -> Option<f64> {
    match kind {
        SwimmerKind::Body { gait, .. } => gait.as_ref().and_then(GaitSpec::period),
        SwimmerKind::LinkedSpheres { arms, gaits, .. } => {
            arms.iter().find_map(Stroke::period).or_else(|| gaits.iter().find_map(GaitSpec::period))
        }
        SwimmerKind::Star { arms, .. } => arms.iter().find_map(Stroke::period),
        SwimmerKind::Chain { joints, .. } => {
            joints.iter().find_map(|pivot| kind_period(&JointKind::from(pivot.clone())))
        }
        SwimmerKind::Bodies(_) => None,
    }
}

fn kind_period(kind: &JointKind) -> Option<f64> {
    match kind {
        JointKind::Hinge(hinge) => hinge.torque.as_ref(),
        given => given.stroke(),
    }
    .and_then(Stroke::period)
}

fn bodies_period(case: &Case, bodies: &[usize]) -> Option<f64> {
    let gait = |body: &usize| case.body[*body].gait.as_ref().and_then(GaitSpec::period);
    let is_ours = |joint: &&Joint| bodies.iter().any(|body| case.body[*body].name == joint.child);
    let joints = case.joint.iter().filter(is_ours);
    bodies.iter().find_map(gait).or_else(|| joints.map(|joint| &joint.kind).find_map(kind_period))
}

/// Names, centres and angles of all copies.
fn places(
    case: &Case,
    key: &str,
    swimmer: &SwimmerSpec,
    parts: &[Part],
    random: &mut Option<SplitMix>,
) -> Result<Vec<(String, Point<2>, f64)>, Refusal> {
    let start = Point::<2>::from(swimmer.center);
    let named = |nth: usize| format!("{}-{}", swimmer.name, nth + 1);
    match &swimmer.copies {
        None => Ok(vec![(swimmer.name.clone(), start, swimmer.angle)]),
        Some(Copies::Lattice { counts: [columns, rows], spacing }) => {
            let all = (0..rows * columns).map(|nth| {
                let (column, row) = ((nth % columns) as f64, (nth / columns) as f64);
                let way = Point::<2>::new(column * spacing[0], row * spacing[1]);
                (named(nth), start + way, swimmer.angle)
            });
            Ok(all.collect())
        }
        Some(Copies::Random { count, seed, gap, within, turned }) => {
            let stream = random.insert(SplitMix(*seed));
            let reach = put(parts, Point::<2>::zeros(), 0.0)
                .iter()
                .zip(parts)
                .fold(0.0f64, |most, (place, part)| {
                    most.max(place[0].hypot(place[1]) + part.shape.reach())
                });
            let domain = case.mesh_domain();
            let images = domain.images();
            let clearance = |place: Point<2>| {
                let walls = (0..domain.sides().len()).filter(|side| !domain.is_periodic(*side));
                walls.map(|side| domain.side_gap(side, place)).fold(f64::INFINITY, f64::min)
            };
            let [min, max] = within.unwrap_or_else(|| case.domain.extent());
            let mut taken: Vec<(Point<2>, f64)> = case
                .body
                .iter()
                .filter(|body| body.center.len() == 2)
                .map(|body| (Point::<2>::new(body.center[0], body.center[1]), body.shape.reach()))
                .collect();
            let mut places = Vec::new();
            for nth in 0..*count {
                let found = (0..TRIALS).find_map(|_| {
                    let along = |axis: usize, part: f64| min[axis] + part * (max[axis] - min[axis]);
                    let (x, y) = (stream.next(), stream.next());
                    let place = Point::<2>::new(along(0, x), along(1, y));
                    let on_axis = case.geometry == Geometry::Axisymmetric;
                    let place = if on_axis { Point::<2>::new(place.x, 0.0) } else { place };
                    let is_apart = taken.iter().all(|(other, radius)| {
                        let least = reach + radius + gap;
                        images.iter().all(|away| (place - other - away).norm() >= least)
                    });
                    (is_apart && clearance(place) >= reach + gap).then_some(place)
                });
                let Some(place) = found else {
                    let message = format!(
                        "no room was found for copy {} of \"{}\", which takes a circle of radius \
                         {reach:.4} and a gap of {gap}",
                        nth + 1,
                        swimmer.name
                    );
                    let help = "ask for fewer copies, a smaller gap, or a larger domain";
                    return Err((format!("{key}.copies.random.count"), message, help.to_owned()));
                };
                taken.push((place, reach));
                let angle = if *turned { TAU * stream.next() } else { swimmer.angle };
                places.push((named(nth), place, angle));
            }
            Ok(places)
        }
    }
}

/// Random numbers that are the same for ever, from a counter (@steele2014).
struct SplitMix(u64);

impl SplitMix {
    /// The next one in [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

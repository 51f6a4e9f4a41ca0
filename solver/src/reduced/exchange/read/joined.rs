//! Bodies as a file has them: those without a joint become part of what they hang on.

use alewife_reduced::tree::Pose;
use nalgebra::{Matrix3, Vector3};

use super::mass::Mass;
use super::source::{Read, Remark};
use super::words::Names;
use crate::reduced::exchange::robot::{
    Robot, RobotBody, RobotEllipsoid, RobotJoint, RobotSite, RobotTendon,
};

/// Most bodies of a file, which may hang each on the one before.
pub(super) const MOST_BODIES: usize = 1000;

/// A robot that was read, with what of the file is not in it.
pub(super) struct Found {
    pub robot: Robot,
    pub notes: Vec<Remark>,
}

/// A body of a file.
#[derive(Debug, Clone)]
pub(super) struct Raw {
    /// Its element, of which nothing is said yet.
    pub element: Remark,
    pub name: String,
    /// The body it hangs on, which comes before it.
    pub parent: Option<usize>,
    /// Its frame in that of its parent, or of the world, where the coordinates of joints are zero.
    pub pose: Pose<f64>,
    pub mass: Mass,
    pub is_free: bool,
    pub joints: Vec<RobotJoint>,
    pub ellipsoids: Vec<RobotEllipsoid>,
    /// Half lengths of its largest shape along its axes (m).
    pub extent: Option<Vector3<f64>>,
    /// That shape as an ellipsoid in a fluid.
    pub largest: Option<RobotEllipsoid>,
    /// Part of its weight that lifts it.
    pub lift: f64,
}

impl Raw {
    fn moves(&self) -> bool {
        self.is_free || !self.joints.is_empty()
    }
}

/// Where a body of the file is among those that move.
#[derive(Debug, Clone, Copy)]
pub(super) struct Whereabouts {
    /// The body it is part of; the world if absent.
    pub body: Option<usize>,
    /// Its frame in that.
    pub pose: Pose<f64>,
}

/// Bodies that move, and where those of the file are in them.
pub(super) struct Joined {
    pub bodies: Vec<RobotBody>,
    pub places: Vec<Whereabouts>,
    pub notes: Vec<Remark>,
}

/// Something said of an element.
pub(super) fn said(element: &Remark, what: impl Into<String>) -> Remark {
    Remark { what: what.into(), ..element.clone() }
}

/// Bodies that move or hold what does.
///
/// # Errors
/// When there is none, when several hang on nothing, or one has no mass.
pub(super) fn joined(raws: &[Raw]) -> Read<Joined> {
    let mut names = Names::default();
    let mut joined = Joined { bodies: Vec::new(), places: Vec::new(), notes: Vec::new() };
    for (number, raw) in raws.iter().enumerate() {
        let above = match raw.parent {
            Some(parent) => joined.places[parent],
            None => Whereabouts { body: None, pose: Pose::identity() },
        };
        let pose = above.pose.then(&raw.pose);
        let holds = raw.parent.is_none() && raw.mass.mass > 0.0 && holds_something(raws, number);
        if !raw.moves() && !holds {
            joined.places.push(Whereabouts { body: above.body, pose });
            joined.absorb(raw, &joined.places[number].clone());
            continue;
        }
        if let (Some(_), true) = (above.body, raw.is_free) {
            let what = "a body moves freely in the world alone";
            return Err(Remark {
                help: Some("no freejoint within another body".to_owned()),
                ..said(&raw.element, what)
            });
        }
        let name = names.of(&raw.name);
        if name != raw.name {
            joined.notes.push(said(&raw.element, format!("it is called \"{name}\" in the case")));
        }
        joined.places.push(Whereabouts { body: Some(joined.bodies.len()), pose: Pose::identity() });
        let mut body = RobotBody {
            name,
            parent: above.body,
            pose,
            mass: 0.0,
            center: Vector3::zeros(),
            inertia: Matrix3::zeros(),
            is_free: raw.is_free,
            velocity: [Vector3::zeros(); 2],
            joints: raw.joints.clone(),
            ellipsoids: Vec::new(),
            extent: None,
            middle: Vector3::zeros(),
            largest: None,
            displaced: 0.0,
            lifted_at: Vector3::zeros(),
        };
        add(&mut body, raw, &Pose::identity());
        joined.bodies.push(body);
    }
    check(raws, &joined)?;
    Ok(joined)
}

/// Whether a body that hangs on nothing has some below that moves, with none between that does.
fn holds_something(raws: &[Raw], number: usize) -> bool {
    raws.iter().any(|raw| {
        let mut above = raw.parent;
        while let Some(one) = above.filter(|one| *one != number && !raws[*one].moves()) {
            above = raws[one].parent;
        }
        raw.moves() && above == Some(number)
    })
}

/// Masses, ellipsoids and shape of one body as part of another, in whose frame it has a pose.
fn add(body: &mut RobotBody, raw: &Raw, pose: &Pose<f64>) {
    let own = raw.mass.seen_from(pose);
    let whole = Mass { mass: body.mass, center: body.center, inertia: body.inertia }.with(&own);
    (body.mass, body.center, body.inertia) = (whole.mass, whole.center, whole.inertia);
    let lifted = raw.lift * own.mass;
    if lifted > 0.0 {
        let sum = body.displaced + lifted;
        body.lifted_at = (body.lifted_at * body.displaced + own.center * lifted) / sum;
        body.displaced = sum;
    }
    let seen = |one: RobotEllipsoid| RobotEllipsoid { pose: pose.then(&one.pose), ..one };
    body.ellipsoids.extend(raw.ellipsoids.iter().copied().map(seen));
    let size = |extent: &Vector3<f64>| extent.product();
    let turned = |extent: Vector3<f64>| (pose.rotation.abs() * extent).map(|part| part.max(1e-9));
    let larger =
        raw.extent.filter(|own| body.extent.as_ref().is_none_or(|was| size(own) > size(was)));
    if let Some(extent) = larger {
        body.extent = Some(turned(extent));
        body.largest = raw.largest.map(seen);
    }
}

impl Joined {
    /// Has a body without a joint be part of what it hangs on.
    fn absorb(&mut self, raw: &Raw, place: &Whereabouts) {
        let what = match place.body {
            Some(body) => {
                let body = &mut self.bodies[body];
                add(body, raw, &place.pose);
                format!("it has no joint: it is part of \"{}\"", body.name)
            }
            None if raw.mass.mass == 0.0 && raw.ellipsoids.is_empty() => return,
            None => "it does not move and holds nothing: it is left out".to_owned(),
        };
        self.notes.push(said(&raw.element, what));
    }
}

/// One tree of bodies with masses.
fn check(raws: &[Raw], joined: &Joined) -> Read<()> {
    let element = |body: usize| {
        let nth = joined.places.iter().position(|place| place.body == Some(body));
        nth.map_or_else(
            || Remark { line: 1, element: None, what: String::new(), help: None },
            |nth| raws[nth].element.clone(),
        )
    };
    let refused = |body: usize, what: &str, help: &str| {
        Err(Remark { help: Some(help.to_owned()), ..said(&element(body), what) })
    };
    if joined.bodies.is_empty() {
        return refused(0, "the file has no body that moves", "one with a joint or a freejoint");
    }
    for (number, body) in joined.bodies.iter().enumerate() {
        let moments = body.inertia.symmetric_eigenvalues();
        // Those of a thin rod may be less than zero by rounding
        let has_moments = moments.max() > 0.0 && moments.min() > -1e-12 * moments.max();
        if body.mass.is_nan() || body.mass <= 0.0 || !has_moments {
            return refused(
                number,
                "it moves, and has no mass or no moments",
                "an <inertial> with a mass above 0 and its moments",
            );
        }
    }
    let is_uneven = |body: &RobotBody| {
        body.ellipsoids.windows(2).any(|pair| pair[0].coefficients != pair[1].coefficients)
    };
    if let Some(body) = joined.bodies.iter().position(is_uneven) {
        let what = "its ellipsoids differ in `fluidcoef`, and a body of a case has one set of coefficients";
        return refused(
            body,
            what,
            "the same numbers for all geoms of a body, or bodies of their own",
        );
    }
    let mut roots = (0..joined.bodies.len()).filter(|one| joined.bodies[*one].parent.is_none());
    if let (Some(first), Some(second)) = (roots.next(), roots.next()) {
        let what = format!(
            "the reduced model has one tree of bodies, and \"{}\" does not hang on \"{}\"",
            joined.bodies[second].name, joined.bodies[first].name
        );
        return refused(second, &what, "a file of each, or bodies that hang together");
    }
    Ok(())
}

/// The frames of all bodies in the world when the coordinates of all joints are zero.
fn poses_at_zero(bodies: &[RobotBody]) -> Vec<Pose<f64>> {
    let mut poses: Vec<Pose<f64>> = Vec::new();
    for body in bodies {
        let above = body.parent.map_or_else(Pose::identity, |parent| poses[parent]);
        poses.push(above.then(&body.pose));
    }
    poses
}

/// Length of a tendon when the coordinates of all joints are zero (m).
pub(super) fn length_at_zero(bodies: &[RobotBody], tendon: &RobotTendon) -> f64 {
    let poses = poses_at_zero(bodies);
    let at = |site: &RobotSite| poses[site.body].then(&Pose::at(site.position)).position;
    tendon.sites.windows(2).map(|pair| (at(&pair[1]) - at(&pair[0])).norm()).sum()
}

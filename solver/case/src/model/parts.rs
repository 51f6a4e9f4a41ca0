//! Kinds of swimmers: the bodies each is made of, and how they are attached to each other.

use std::cmp::Ordering;
use std::f64::consts::{PI, TAU};

use alewife_mesh::MeshError;

use super::part_pose::PartPose;
use crate::Geometry;
use crate::spec::body::joint::{Joint, JointKind};
use crate::spec::body::link::{Link, LinkExtent};
use crate::spec::body::skin::{Layout, NoOutline};
use crate::spec::body::stroke::Stroke;
use crate::spec::body::swimmer::{Pivot, SwimmerKind, SwimmerSpec};
use crate::spec::body::{GaitSpec, ShapeSpec};
use crate::text::diagnostic::CaseError;

/// One body of a swimmer before it is placed.
pub struct Part {
    pub shape: ShapeSpec,
    pub gait: Option<GaitSpec>,
    /// Its own density (kg/m3); that of the swimmer if absent.
    pub density: Option<f64>,
    /// Its own magnetic moment (A m2; A m planar); that of the swimmer if it has none and is the root.
    pub magnetic_moment: Vec<f64>,
    /// How it is attached to another part; the part all others are attached to is not.
    pub attachment: Option<Attachment>,
}

impl Part {
    /// Its magnetic moment in a swimmer (A m2; A m planar).
    pub fn moment_in(&self, swimmer: &SwimmerSpec) -> Vec<f64> {
        let is_given = !self.magnetic_moment.is_empty() || self.attachment.is_some();
        if is_given { &self.magnetic_moment } else { &swimmer.magnetic_moment }.clone()
    }
}

/// How a part is attached to another one.
pub struct Attachment {
    /// The part it is attached to, by its position in the list.
    pub parent: usize,
    pub on_parent: [f64; 2],
    pub on_child: [f64; 2],
    pub kind: JointKind,
    /// Its number among the arms or joints of the swimmer as they are written, from 0.
    pub number: usize,
}

impl Attachment {
    /// An arm from origin to origin.
    fn arm(parent: usize, number: usize, length: &Stroke, to: Direction) -> Self {
        let Direction { angle, along } = to;
        let direction = angle.unwrap_or(0.0);
        let kind = JointKind::Arm { length: length.clone(), direction, along };
        Self { parent, on_parent: [0.0; 2], on_child: [0.0; 2], kind, number }
    }

    /// The same between bodies with names.
    pub fn joint(&self, parent: String, child: String) -> Joint {
        let Self { on_parent, on_child, kind, .. } = self;
        let [on_parent, on_child] = [on_parent, on_child].map(|end| end.to_vec());
        Joint { parent, child, on_parent, on_child, kind: kind.clone() }
    }
}

/// The parts of a swimmer.
///
/// # Errors
/// When the numbers of radii, arms, gaits or joints do not fit together.
pub fn parts(key: &str, kind: &SwimmerKind, geometry: Geometry) -> Result<Vec<Part>, CaseError> {
    let fits = |what: &str, found: usize, wanted: usize, of: &str| {
        if found == wanted {
            return Ok(());
        }
        let verb = |count: usize| if count == 1 { "is" } else { "are" };
        let found_what = if found == 1 { what.trim_end_matches('s') } else { what };
        let message = format!(
            "{found} {found_what} {} given, and {wanted} {} wanted",
            verb(found),
            verb(wanted)
        );
        Err(CaseError::at(&format!("{key}.kind"), message, &format!("give one for each {of}")))
    };
    match kind {
        SwimmerKind::Body { shape, gait } => Ok(vec![Part {
            shape: shape.clone(),
            gait: gait.clone(),
            density: None,
            magnetic_moment: Vec::new(),
            attachment: None,
        }]),
        SwimmerKind::LinkedSpheres { radii, arms, gaits } => {
            let between = "pair of neighbours in `radii`";
            fits("arms", arms.len(), radii.len().saturating_sub(1), between)?;
            if !gaits.is_empty() {
                fits("gaits", gaits.len(), radii.len(), "of `radii`")?;
            }
            Ok(linked_spheres(radii, arms, gaits, geometry))
        }
        SwimmerKind::Star { radius, radii, arms, directions, along } => {
            fits("arms", arms.len(), radii.len(), "of `radii`")?;
            if !directions.is_empty() {
                fits("directions", directions.len(), radii.len(), "of `radii`")?;
            }
            if !along.is_empty() {
                fits("directions along", along.len(), radii.len(), "of `radii`")?;
            }
            let arm = |nth: usize| Direction {
                angle: directions.get(nth).copied(),
                along: along.get(nth).copied(),
            };
            Ok(star(*radius, radii, arms, &arm, geometry))
        }
        SwimmerKind::Chain { links, gap, joints, skin } => {
            let between = "pair of neighbours in `links`";
            fits("joints", joints.len(), links.len().saturating_sub(1), between)?;
            let Some(skin) = skin else { return chain(key, links, *gap, joints, geometry) };
            let layout = Layout::new(links, *gap)
                .map_err(|NoOutline { link, error }| no_outline(key, link, &error))?;
            Ok(vec![Part {
                shape: ShapeSpec::Tube(layout.shape(*skin)),
                gait: Some(GaitSpec::Joints(layout.gait(*skin, joints, middle(links.len())))),
                density: None,
                magnetic_moment: Vec::new(),
                attachment: None,
            }])
        }
        SwimmerKind::Bodies(_) => Ok(Vec::new()),
    }
}

/// A disc in the plane, else a sphere.
fn round_shape(radius: f64, geometry: Geometry) -> ShapeSpec {
    match geometry {
        Geometry::Planar => ShapeSpec::Disc { radius },
        Geometry::Axisymmetric | Geometry::Spatial => ShapeSpec::Sphere { radius },
    }
}

/// Spheres or discs in a line along x, on arms from neighbour to neighbour.
fn linked_spheres(
    radii: &[f64],
    arms: &[Stroke],
    gaits: &[GaitSpec],
    geometry: Geometry,
) -> Vec<Part> {
    let attachment = |nth: usize| {
        let Neighbour { parent, between, is_after } = neighbour(nth, radii.len())?;
        let to = Direction { angle: Some(if is_after { 0.0 } else { PI }), along: None };
        Some(Attachment::arm(parent, between, &arms[between], to))
    };
    let part = |(nth, radius): (usize, &f64)| Part {
        shape: round_shape(*radius, geometry),
        gait: gaits.get(nth).cloned(),
        density: None,
        magnetic_moment: Vec::new(),
        attachment: attachment(nth),
    };
    radii.iter().enumerate().map(part).collect()
}

/// Where an arm of a star points to: by an angle in the plane (rad) or along a vector, if that is given.
struct Direction {
    angle: Option<f64>,
    along: Option<[f64; 3]>,
}

/// Discs or spheres on arms from one in the middle.
fn star(
    radius: f64,
    radii: &[f64],
    arms: &[Stroke],
    direction: &dyn Fn(usize) -> Direction,
    geometry: Geometry,
) -> Vec<Part> {
    let disc = |radius: f64, attachment: Option<Attachment>| Part {
        shape: round_shape(radius, geometry),
        gait: None,
        density: None,
        magnetic_moment: Vec::new(),
        attachment,
    };
    let mut parts = vec![disc(radius, None)];
    for (nth, (radius, arm)) in radii.iter().zip(arms).enumerate() {
        let even = TAU * nth as f64 / radii.len() as f64;
        let Direction { angle, along } = direction(nth);
        // A vector takes the place of the angle
        let angle = angle.or(along.is_none().then_some(even));
        let attachment = Attachment::arm(0, nth, arm, Direction { angle, along });
        parts.push(disc(*radius, Some(attachment)));
    }
    parts
}

/// Links along x with pivots between them, the first one towards +x: each pivot is on the x axes of
/// both links, half the gap beyond their ends.
///
/// # Errors
/// When a link has no outline.
fn chain(
    key: &str,
    links: &[Link],
    gap: f64,
    joints: &[Pivot],
    geometry: Geometry,
) -> Result<Vec<Part>, CaseError> {
    let ends =
        |(nth, link): (usize, &Link)| link.extent().map_err(|error| no_outline(key, nth, &error));
    let ends =
        links.iter().enumerate().map(ends).collect::<Result<Vec<LinkExtent>, CaseError>>()?;
    let behind = |nth: usize| [ends[nth].back - 0.5 * gap, 0.0];
    let before = |nth: usize| [ends[nth].front + 0.5 * gap, 0.0];
    let attachment = |nth: usize| {
        let Neighbour { parent, between, is_after } = neighbour(nth, links.len())?;
        let (on_parent, on_child) =
            if is_after { (behind(parent), before(nth)) } else { (before(parent), behind(nth)) };
        let kind = JointKind::from(joints[between].clone());
        Some(Attachment { parent, on_parent, on_child, kind, number: between })
    };
    let part = |(nth, link): (usize, &Link)| Part {
        shape: match (link.shape(), geometry) {
            (ShapeSpec::Ellipse { semi_axes }, Geometry::Spatial) => {
                ShapeSpec::Spheroid { semi_axes }
            }
            (shape, _) => shape,
        },
        gait: None,
        density: link.density(),
        magnetic_moment: link.magnetic_moment().to_vec(),
        attachment: attachment(nth),
    };
    Ok(links.iter().enumerate().map(part).collect())
}

/// The error of a link without an outline.
fn no_outline(key: &str, nth: usize, error: &MeshError) -> CaseError {
    CaseError::at(
        &format!("{key}.kind.chain.links.{nth}.shape"),
        format!("link {} of the chain has no outline: {error}", nth + 1),
        "give lengths larger than 0, and points that run counter-clockwise and do not cross",
    )
}

/// Which neighbour in a row a part is attached to.
struct Neighbour {
    parent: usize,
    /// Number of the joint between the two.
    between: usize,
    /// Whether the part comes after its parent.
    is_after: bool,
}

/// The part in a row of `n` that all others are attached to.
fn middle(n: usize) -> usize {
    n.saturating_sub(1) / 2
}

/// The neighbour towards the middle of a row of `n` parts; none of the middle one.
fn neighbour(nth: usize, n: usize) -> Option<Neighbour> {
    let middle = middle(n);
    match nth.cmp(&middle) {
        Ordering::Equal => None,
        Ordering::Greater => Some(Neighbour { parent: nth - 1, between: nth - 1, is_after: true }),
        Ordering::Less => Some(Neighbour { parent: nth + 1, between: nth, is_after: false }),
    }
}

/// Poses of parts at time zero, in their order, where the one all others are attached to has the
/// pose `root`.
pub fn poses(parts: &[Part], root: PartPose) -> Vec<PartPose> {
    let mut poses: Vec<Option<PartPose>> = vec![None; parts.len()];
    for start in 0..parts.len() {
        // From the part up to the first one whose pose is known, and down again
        let mut path = Vec::new();
        let mut above = Some(start);
        while let Some(nth) = above.filter(|&nth| poses[nth].is_none()) {
            path.push(nth);
            above = parts[nth].attachment.as_ref().map(|attachment| attachment.parent);
        }
        for nth in path.into_iter().rev() {
            let pose = parts[nth].attachment.as_ref().and_then(|attachment| {
                let Attachment { parent, on_parent, on_child, kind, .. } = attachment;
                Some(poses[*parent]?.child([*on_parent, *on_child], kind))
            });
            poses[nth] = Some(pose.unwrap_or(root));
        }
    }
    poses.into_iter().flatten().collect()
}

impl SwimmerKind {
    /// Period of its gait or of the first of its strokes that has one (s).
    pub(crate) fn period(&self) -> Option<f64> {
        match self {
            Self::Body { gait, .. } => gait.as_ref().and_then(GaitSpec::period),
            Self::LinkedSpheres { arms, gaits, .. } => arms
                .iter()
                .find_map(Stroke::period)
                .or_else(|| gaits.iter().find_map(GaitSpec::period)),
            Self::Star { arms, .. } => arms.iter().find_map(Stroke::period),
            Self::Chain { joints, .. } => {
                joints.iter().find_map(|pivot| JointKind::from(pivot.clone()).period())
            }
            Self::Bodies(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use alewife_mesh::Point;

    use super::*;
    use crate::spec::body::joint::PlanarPose;
    use crate::spec::body::link::ShapedLink;

    fn planar(poses: &[PartPose]) -> Vec<PlanarPose> {
        let in_plane = |pose: &PartPose| match pose {
            PartPose::Planar(pose) => *pose,
            PartPose::Spatial(_) => panic!("{pose:?}"),
        };
        poses.iter().map(in_plane).collect()
    }

    #[test]
    fn a_chain_hangs_together_at_its_pivots() {
        let bent = |angle: f64| Pivot::Bent { angle: Stroke::Constant(angle) };
        let kind = SwimmerKind::Chain {
            links: [[0.4, 0.1], [0.5, 0.1], [0.3, 0.1], [0.2, 0.1]].map(Link::Ellipse).to_vec(),
            gap: 0.2,
            joints: vec![bent(0.3), bent(-0.2), bent(0.5)],
            skin: None,
        };
        let parts = parts("swimmer.0", &kind, Geometry::Planar).unwrap();
        let root = PlanarPose { center: Point::<2>::new(1.0, 2.0), angle: 0.1 };
        let poses = planar(&poses(&parts, PartPose::Planar(root)));
        assert_eq!(poses[1], root);
        let end = |nth: usize, x: f64| {
            let PlanarPose { center, angle } = poses[nth];
            center + Point::<2>::new(angle.cos(), angle.sin()) * x
        };
        // Pivots half a gap off the tips, the first link in front.
        for (nth, [front, back]) in [[0.4, 0.5], [0.5, 0.3], [0.3, 0.2]].into_iter().enumerate() {
            let off = end(nth, -(front + 0.1)) - end(nth + 1, back + 0.1);
            assert!(off.norm() < 1e-14, "pivot {nth}: {off}");
        }
        assert!((poses[3].angle - (0.1 - 0.2 + 0.5)).abs() < 1e-14);
    }

    #[test]
    fn pivots_are_beyond_the_ends_of_links_of_any_shape() {
        let points = vec![[0.5, 0.0], [0.0, 0.2], [-0.2, 0.0], [0.0, -0.2]];
        let kite = ShapedLink {
            shape: ShapeSpec::Spline { points },
            density: Some(3.0),
            magnetic_moment: vec![0.5, 0.0],
        };
        let kind = SwimmerKind::Chain {
            links: vec![Link::Shaped(kite.clone()), Link::Ellipse([0.4, 0.1]), Link::Shaped(kite)],
            gap: 0.2,
            joints: [0.0; 2].map(|angle| Pivot::Bent { angle: Stroke::Constant(angle) }).to_vec(),
            skin: None,
        };
        let parts = parts("swimmer.0", &kind, Geometry::Planar).unwrap();
        let poses = planar(&poses(&parts, PartPose::Planar(PlanarPose::default())));
        // The first link ends 0.2 before the middle one, its back nearer to its origin than its front
        let back = poses[0].center.x - 0.6;
        assert!((0.2..0.25).contains(&back), "{back}");
        assert!((poses[2].center.x + 1.1).abs() < 1e-9, "{}", poses[2].center.x);
        let densities: Vec<Option<f64>> = parts.iter().map(|part| part.density).collect();
        assert_eq!(densities, [Some(3.0), None, Some(3.0)]);
        let moments: Vec<&[f64]> = parts.iter().map(|part| &*part.magnetic_moment).collect();
        assert_eq!(moments, [&[0.5, 0.0][..], &[], &[0.5, 0.0]]);
    }
}

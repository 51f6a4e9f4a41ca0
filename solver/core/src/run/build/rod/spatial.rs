//! The elastic rod of a body of a case in space.
//!
//! Straight, it goes from its head on towards -x: t, d1 and d2 are -x, -y and z of the body, and so are what turns about them.

use std::sync::Arc;

use alewife_mesh::Profile;
use alewife_mesh::spatial::{SectionHeight, SectionPoint};
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::laws::{
    ENDS, axes, density, end, is_clamped, longest_step, refused, steady_rest, stiff_enough,
    with_wave,
};
use crate::case::{
    self, Activation, AlongBody, Body, Case, EndFrame, EndLoadSpec, EndMoment, Hold, RodSpec,
    Stroke,
};
use crate::gait::FlexibleSurface;
use crate::rod::{
    Along, End, Field, Flexure, RodProperties, Section, SpatialEndLoad, SpatialEndPose,
    SpatialLoadedEnd, SpatialProperties, SpatialRod, SpatialRodBody, Support, Supports,
};
use crate::run::RunError;

/// Young's modulus over the shear modulus of a material that keeps its volume.
const INCOMPRESSIBLE: f64 = 3.0;

/// The axis of the body that each of d1, d2 and t is along, and which way.
const AXES: [Axis; 3] =
    [Axis { of: 1, sign: -1.0 }, Axis { of: 2, sign: 1.0 }, Axis { of: 0, sign: -1.0 }];

/// An axis of a body, or its opposite.
#[derive(Clone, Copy)]
struct Axis {
    of: usize,
    sign: f64,
}

impl Axis {
    /// A rate of turning about it without loads.
    fn rest(self, spec: &RodSpec) -> Along {
        let steady = steady_rest(spec, self.of);
        if self.sign > 0.0 { steady } else { Along::function(move |along| -steady.at(along)) }
    }
}

/// The shape of a body in space that is a rod.
pub fn shape(case: &Case, body: &Body, spec: &RodSpec) -> Result<FlexibleSurface, RunError> {
    let refuse = |why: &str| refused(body, why);
    let profile = body.shape.profile().ok_or_else(|| refuse("a rod has to be slender"))?;
    let height =
        body.shape.section_height().ok_or_else(|| refuse("its sections have no height"))?;
    let sections = profile.sections(height).ok_or_else(|| refuse("its lengths make no body"))?;
    let material = Material { case, body, spec, sizes: Sizes::new(&profile, height) };
    let rod = SpatialRod::new(material.properties()).map_err(|error| refuse(&error.to_string()))?;
    let rod = rod.with_relaxation(longest_step(case).unwrap_or_default());
    let rod = if is_clamped(body) { rod.clamped(End::Base) } else { rod };
    let nose = sections.point(SectionPoint { along: 0.0, around: 0.0 }).x;
    let base = SpatialEndPose {
        place: Vector3::new(nose, 0.0, 0.0),
        rotation: Rotation3::from_matrix_unchecked(back()),
        ..SpatialEndPose::default()
    };
    let supports = supports(body, base);
    let start = match body.attached.as_ref().map(|attached| &attached.hold) {
        Some(Hold::Angle(angle)) => turned(base, angle, 0.0),
        Some(Hold::Clamped | Hold::Hinged) | None => base,
    };
    let start = rod.curved(start.place, start.rotation, &AXES.map(|axis| axis.rest(spec)));
    let flexible = SpatialRodBody::new(rod, base, supports)
        .starting(start)
        .with_loaded_ends(loaded_ends(body));
    FlexibleSurface::new(sections, Arc::new(flexible)).ok_or_else(|| refuse("it has no surface"))
}

/// The frame of the straight rod, t, d1 and d2, by the axes of its body; seen from it, those of the body are the same.
fn back() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 1.0))
}

/// What holds the head.
fn supports(body: &Body, base: SpatialEndPose) -> Supports<SpatialEndPose> {
    let Some(attached) = body.attached.as_ref().filter(|attached| attached.to.is_none()) else {
        return Supports::FREE;
    };
    match attached.hold.clone() {
        Hold::Clamped => Supports::one(End::Base, Support::Clamped, move |_| base),
        Hold::Hinged => Supports::one(End::Base, Support::Hinged, move |_| base),
        Hold::Angle(stroke) => {
            Supports::one(End::Base, Support::Clamped, move |time| turned(base, &stroke, time))
        }
    }
}

/// A base that is turned about the z axis of the body by the angle at a time (s).
fn turned(base: SpatialEndPose, angle: &Stroke, time: f64) -> SpatialEndPose {
    let [angle, rate] = angle.at(time);
    let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), angle) * base.rotation;
    SpatialEndPose { rotation, angular_velocity: Vector3::z() * rate, ..base }
}

/// Loads at the ends, seen from the frame of the straight body as its coordinates are, or along t, d1 and d2.
fn loaded_ends(body: &Body) -> Vec<SpatialLoadedEnd> {
    let from_laboratory = body.pose_in_space().rotation.inverse().to_rotation_matrix();
    let loaded = |at: case::LoadedEnd<&EndLoadSpec>| {
        let EndLoadSpec { force, moment, frame } = at.load.clone();
        let turn = match frame {
            EndFrame::Laboratory => from_laboratory,
            EndFrame::End => Rotation3::from_matrix_unchecked(back()),
        };
        let vector = move |of: &[Stroke], time| {
            let along = |axis: usize| of.get(axis).map_or(0.0, |stroke| stroke.at(time)[0]);
            turn * Vector3::from_fn(|axis, _| along(axis))
        };
        let load = move |time| SpatialEndLoad {
            force: vector(&force, time),
            moment: vector(moment.as_ref().map_or(&[], EndMoment::components), time),
        };
        SpatialLoadedEnd { end: end(at.end), axes: axes(frame), load: Box::new(load) }
    };
    body.end_loads().map(loaded).collect()
}

/// Half width and half height of the sections.
#[derive(Clone)]
struct Sizes {
    profile: Profile,
    height: SectionHeight,
    /// Half width below which a body is as stiff as there (m).
    least: f64,
}

impl Sizes {
    fn new(profile: &Profile, height: SectionHeight) -> Self {
        let stations = profile.stations();
        let widest = stations.iter().map(|at| at.half_width).fold(0.0, f64::max);
        Self { profile: profile.clone(), height, least: ENDS * widest }
    }

    /// The section at a distance from the head (m).
    fn at(&self, along: f64) -> Section {
        let half_width = self.profile.find(along).half_width;
        let half_height = self.height.at(along, half_width, self.profile.length());
        Section::Ellipse { half_width, half_height }
    }

    /// That by which it is stiff.
    fn stiff_at(&self, along: f64) -> Section {
        let half_width = self.profile.find(along).half_width.max(self.least);
        let length = self.profile.length();
        let half_height = match self.height {
            SectionHeight::Round => half_width,
            SectionHeight::Ellipse { half_height } => {
                self.height.at(along, half_width, length).max(ENDS * half_height)
            }
        };
        Section::Ellipse { half_width, half_height }
    }
}

/// What a rod is made of.
struct Material<'a> {
    case: &'a Case,
    body: &'a Body,
    spec: &'a RodSpec,
    sizes: Sizes,
}

/// What a section resists, over what its bending about d2 does.
#[derive(Clone, Copy)]
enum Resists {
    AboutFirst,
    AboutSecond,
    Twist,
}

impl Resists {
    /// The stiffness of a section over Young's modulus (m4).
    fn moment(self, section: Section) -> f64 {
        match self {
            Self::AboutFirst => section.second_moment_across(),
            Self::AboutSecond => section.second_moment(),
            Self::Twist => section.torsion() / INCOMPRESSIBLE,
        }
    }
}

impl Material<'_> {
    fn properties(&self) -> SpatialProperties {
        let Self { case, body, spec, sizes } = self;
        let (length, elements) = (sizes.profile.length(), spec.elements);
        let density = density(case, body);
        let (mass, turning) = (sizes.clone(), sizes.clone());
        let stiffness = self.stiffness(Resists::AboutSecond);
        let stiffest = (0..=elements)
            .map(|i| stiffness.at(length * i as f64 / elements as f64))
            .fold(0.0, f64::max);
        let active = body.activation.as_ref();
        let of_axis =
            |nth: usize, stiffness: Along, strokes: [fn(&Activation) -> &Option<Stroke>; 2]| {
                let Axis { sign, .. } = AXES[nth];
                let [curvature, moment] = strokes;
                Flexure {
                    stiffness,
                    rest: with_wave(AXES[nth].rest(spec), active, curvature, sign),
                    moment: with_wave(Along::Constant(0.0), active, moment, sign),
                }
            };
        SpatialProperties {
            rod: RodProperties {
                length,
                elements,
                stretching: spec.stretching.unwrap_or_else(|| {
                    RodProperties::stiff(stiffest, length).min(length * stiff_enough(case, length))
                }),
                damping: spec.damping,
                mass: Along::function(move |along| density * mass.at(along).area()),
                section_inertia: Along::function(move |along| {
                    density * turning.at(along).turning()
                }),
            },
            bending: [
                of_axis(
                    0,
                    self.stiffness(Resists::AboutFirst),
                    [|active| &active.curvature_y, |active| &active.moment_y],
                ),
                of_axis(1, stiffness, [|active| &active.curvature, |active| &active.moment]),
            ],
            twisting: Flexure {
                rest: Field::Steady(AXES[2].rest(spec)),
                ..Flexure::passive(self.twisting())
            },
        }
    }

    fn twisting(&self) -> Along {
        match &self.spec.twisting {
            Some(given) => along(given),
            None => self.stiffness(Resists::Twist),
        }
    }

    /// By Young's modulus, or as the sections have it beside the bending about d2 that is given.
    fn stiffness(&self, of: Resists) -> Along {
        let sizes = self.sizes.clone();
        match (&self.spec.bending, self.spec.young) {
            (Some(given), _) => match of {
                Resists::AboutSecond => along(given),
                Resists::AboutFirst | Resists::Twist => {
                    let bending = along(given);
                    Along::function(move |at| {
                        let section = sizes.stiff_at(at);
                        bending.at(at) * of.moment(section) / section.second_moment()
                    })
                }
            },
            (None, young) => {
                let young = young.unwrap_or_default();
                Along::function(move |at| young * of.moment(sizes.stiff_at(at)))
            }
        }
    }
}

/// A number of the case along a body.
fn along(given: &AlongBody) -> Along {
    match given {
        AlongBody::Table(rows) => Along::Table(rows.clone()),
        AlongBody::Constant(value) => Along::Constant(*value),
    }
}

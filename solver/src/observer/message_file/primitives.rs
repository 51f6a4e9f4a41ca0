//! Primitives of a scene in the words of viewers: lines, triangles, arrows, ellipsoids and cylinders.

use nalgebra::{UnitQuaternion, Vector3};
use serde::Serialize;

/// A list with nothing in it: what viewers ask for and nothing is said of.
type Nothing = [u8; 0];

/// A closed line, in the words of viewers.
const LINE_LOOP: u8 = 1;
/// Pairs of points, in the words of viewers.
const LINE_LIST: u8 = 2;

/// What is said of one topic at one time.
#[derive(Debug, Serialize)]
pub struct SceneUpdate {
    deletions: Nothing,
    entities: Vec<Entity>,
}

impl SceneUpdate {
    /// A scene of these things.
    pub fn of(entities: Vec<Entity>) -> Self {
        Self { deletions: [], entities }
    }
}

/// A thing of a scene.
#[derive(Debug, Serialize)]
pub struct Entity {
    timestamp: Timestamp,
    frame_id: String,
    id: String,
    lifetime: Timestamp,
    frame_locked: bool,
    metadata: [Note; 1],
    arrows: Vec<Arrow>,
    cubes: Nothing,
    spheres: Vec<Solid>,
    cylinders: Vec<Solid>,
    lines: Vec<Line>,
    triangles: Vec<Triangles>,
    texts: Nothing,
    models: Nothing,
}

#[derive(Debug, Serialize)]
struct Note {
    key: String,
    value: String,
}

/// Primitives of one thing in a scene.
#[derive(Debug, Default)]
pub struct Primitives {
    /// Lines.
    pub lines: Vec<Line>,
    /// Triangles.
    pub triangles: Vec<Triangles>,
    /// Arrows.
    pub arrows: Vec<Arrow>,
    /// Ellipsoids.
    pub spheres: Vec<Solid>,
    /// Cylinders.
    pub cylinders: Vec<Solid>,
}

impl Primitives {
    /// A thing of a scene that stays with a frame, with a note on it.
    pub fn entity(self, frame: &str, id: &str, time: f64, note: [&str; 2]) -> Entity {
        let [key, value] = note.map(str::to_owned);
        Entity {
            timestamp: Timestamp::of(time),
            frame_id: frame.to_owned(),
            id: id.to_owned(),
            lifetime: Timestamp::of(0.0),
            frame_locked: true,
            metadata: [Note { key, value }],
            arrows: self.arrows,
            cubes: [],
            spheres: self.spheres,
            cylinders: self.cylinders,
            lines: self.lines,
            triangles: self.triangles,
            texts: [],
            models: [],
        }
    }
}

/// A line through points.
#[derive(Debug, Serialize)]
pub struct Line {
    #[serde(rename = "type")]
    kind: u8,
    pose: Placement,
    thickness: f64,
    scale_invariant: bool,
    points: Vec<Xyz>,
    color: Colour,
    colors: Nothing,
    indices: Nothing,
}

impl Line {
    /// A line through points and back to the first one.
    pub fn closed(points: &[Vector3<f64>], colour: Colour) -> Self {
        Self::new(LINE_LOOP, points, colour)
    }

    /// Lines between each two points.
    pub fn between_pairs(points: &[Vector3<f64>], colour: Colour) -> Self {
        Self::new(LINE_LIST, points, colour)
    }

    /// The same, moved by a vector (m).
    pub fn shifted(mut self, shift: &Vector3<f64>) -> Self {
        self.points.iter_mut().for_each(|point| *point = point.plus(shift));
        self
    }

    fn new(kind: u8, points: &[Vector3<f64>], color: Colour) -> Self {
        Self {
            kind,
            pose: Placement::none(),
            thickness: 2.0,
            scale_invariant: true,
            points: points.iter().map(Xyz::of).collect(),
            color,
            colors: [],
            indices: [],
        }
    }
}

/// Triangles between points.
#[derive(Debug, Serialize)]
pub struct Triangles {
    pose: Placement,
    points: Vec<Xyz>,
    color: Colour,
    colors: Nothing,
    indices: Vec<usize>,
}

impl Triangles {
    /// Between points by their numbers, three a triangle.
    pub fn new(points: Vec<Xyz>, indices: Vec<usize>, color: Colour) -> Self {
        Self { pose: Placement::none(), points, color, colors: [], indices }
    }
}

/// An arrow.
#[derive(Debug, Serialize)]
pub struct Arrow {
    pose: Placement,
    shaft_length: f64,
    shaft_diameter: f64,
    head_length: f64,
    head_diameter: f64,
    color: Colour,
}

impl Arrow {
    /// From a point along a vector, of a length (m).
    pub fn new(from: &Vector3<f64>, way: &Vector3<f64>, length: f64, color: Colour) -> Self {
        // Arrows of viewers are along x
        let turn = UnitQuaternion::rotation_between(&Vector3::x(), way);
        let back = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
        Self {
            pose: Placement {
                position: Xyz::of(from),
                orientation: Xyzw::of(&turn.unwrap_or(back)),
            },
            shaft_length: 0.75 * length,
            shaft_diameter: 0.06 * length,
            head_length: 0.25 * length,
            head_diameter: 0.16 * length,
            color,
        }
    }
}

/// An ellipsoid, or a cylinder along z with its radii at the bottom and at the top over its semi-axes.
#[derive(Debug, Serialize)]
pub struct Solid {
    /// Where it is.
    pub pose: Placement,
    /// Its extents (m).
    pub size: Xyz,
    /// Radius at the bottom over the semi-axis.
    pub bottom_scale: f64,
    /// Radius at the top over the semi-axis.
    pub top_scale: f64,
    /// Its colour.
    pub color: Colour,
}

/// A pose as viewers know it.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Placement {
    /// Of the origin.
    pub position: Xyz,
    /// Of the axes.
    pub orientation: Xyzw,
}

impl Placement {
    pub fn none() -> Self {
        Self {
            position: Xyz::of(&Vector3::zeros()),
            orientation: Xyzw::of(&UnitQuaternion::identity()),
        }
    }
}

/// A colour, with its opacity.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Colour {
    r: f64,
    g: f64,
    b: f64,
    a: f64,
}

impl Colour {
    /// That of bodies.
    pub const BODY: Self = Self::new([0.25, 0.27, 0.30, 1.0]);

    /// By red, green, blue and opacity.
    pub const fn new([r, g, b, a]: [f64; 4]) -> Self {
        Self { r, g, b, a }
    }
}

/// A vector as viewers know it.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Xyz {
    x: f64,
    y: f64,
    z: f64,
}

impl Xyz {
    /// That of a vector.
    pub fn of(vector: &Vector3<f64>) -> Self {
        Self { x: vector.x, y: vector.y, z: vector.z }
    }

    /// The sum with another one.
    pub fn plus(self, vector: &Vector3<f64>) -> Self {
        Self { x: self.x + vector.x, y: self.y + vector.y, z: self.z + vector.z }
    }
}

/// A rotation as viewers know it.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Xyzw {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

impl Xyzw {
    /// That of a rotation.
    pub fn of(rotation: &UnitQuaternion<f64>) -> Self {
        Self { x: rotation.i, y: rotation.j, z: rotation.k, w: rotation.w }
    }
}

/// A simulated time as viewers know it.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Timestamp {
    sec: u64,
    nsec: u64,
}

impl Timestamp {
    /// That of a time (s).
    pub fn of(time: f64) -> Self {
        let nanoseconds = nanoseconds(time);
        Self { sec: nanoseconds / 1_000_000_000, nsec: nanoseconds % 1_000_000_000 }
    }
}

/// Simulated time as the unsigned nanoseconds of a message; times before zero count as zero.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
pub fn nanoseconds(time: f64) -> u64 {
    (time * 1e9).round() as u64
}

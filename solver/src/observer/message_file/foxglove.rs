//! The messages of `run.mcap` as JSON: those viewers know by name, and our own.
//!
//! Viewers recognise a schema by its name alone, so the names of the `foxglove` messages and
//! their fields are theirs. Times are simulated seconds.

use serde::Serialize;
use serde_json::{Value, json};

use super::primitives::{Timestamp, Xyz, Xyzw};
use crate::body::{Pose, Twist, Wrench, in_space};
use crate::run::{BodyReport, Snapshot};

/// Frame all others are given in.
pub const WORLD: &str = "world";

/// Kinds of message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Pose of each body's frame in the world.
    Transforms,
    /// Outlines of the bodies, each in its body's frame.
    Scene,
    /// What happened to the run.
    Log,
    /// One step: numbers of the solver.
    Step,
    /// One body: pose, twist, loads.
    Body,
    /// Particles that the flow carries, or scalars at nodes.
    Points,
}

impl Kind {
    /// Name of the schema.
    pub fn schema_name(self) -> &'static str {
        match self {
            Self::Transforms => "foxglove.FrameTransforms",
            Self::Scene => "foxglove.SceneUpdate",
            Self::Log => "foxglove.Log",
            Self::Step => "alewife.Step",
            Self::Body => "alewife.Body",
            Self::Points => "foxglove.PointCloud",
        }
    }

    /// The schema, by the rules of JSON Schema.
    pub fn schema(self) -> Value {
        let wrench = || object([("force", vector_schema()), ("torque", vector_schema())]);
        let mut schema = match self {
            Self::Transforms => object([(
                "transforms",
                list(object([
                    ("timestamp", timestamp_schema()),
                    ("parent_frame_id", text_schema()),
                    ("child_frame_id", text_schema()),
                    ("translation", vector_schema()),
                    ("rotation", rotation_schema()),
                ])),
            )]),
            Self::Scene => scene_schema(),
            Self::Points => points_schema(),
            Self::Log => object([
                ("timestamp", timestamp_schema()),
                ("level", json!({"type": "integer"})),
                ("message", text_schema()),
                ("name", text_schema()),
                ("file", text_schema()),
                ("line", json!({"type": "integer"})),
            ]),
            Self::Step => object([
                ("step", json!({"type": "integer"})),
                ("time", number_schema()),
                ("time_step", number_schema()),
                ("iterations", json!({"type": "integer"})),
                ("n_dofs", json!({"type": "integer"})),
            ]),
            Self::Body => object([
                ("step", json!({"type": "integer"})),
                ("time", number_schema()),
                (
                    "pose",
                    object([
                        ("center", vector_schema()),
                        ("rotation", rotation_schema()),
                        ("angle", number_schema()),
                    ]),
                ),
                ("twist", object([("linear", vector_schema()), ("angular", vector_schema())])),
                ("load", wrench()),
                ("surface_load", wrench()),
                ("contact", wrench()),
                ("power", number_schema()),
                ("recoil", recoil_schema()),
            ]),
        };
        schema["title"] = json!(self.schema_name());
        schema
    }
}

fn number_schema() -> Value {
    json!({"type": "number"})
}

fn text_schema() -> Value {
    json!({"type": "string"})
}

fn vector_schema() -> Value {
    object([("x", number_schema()), ("y", number_schema()), ("z", number_schema())])
}

fn rotation_schema() -> Value {
    object([
        ("x", number_schema()),
        ("y", number_schema()),
        ("z", number_schema()),
        ("w", number_schema()),
    ])
}

fn recoil_schema() -> Value {
    let mut schema = object([
        ("center", vector_schema()),
        ("velocity", vector_schema()),
        ("angle", number_schema()),
        ("angular_velocity", number_schema()),
    ]);
    schema["type"] = json!(["object", "null"]);
    schema
}

fn points_schema() -> Value {
    let pose = object([("position", vector_schema()), ("orientation", rotation_schema())]);
    let integer = || json!({"type": "integer"});
    let field = object([("name", text_schema()), ("offset", integer()), ("type", integer())]);
    object([
        ("timestamp", timestamp_schema()),
        ("frame_id", text_schema()),
        ("pose", pose),
        ("point_stride", integer()),
        ("fields", list(field)),
        ("data", json!({"type": "string", "contentEncoding": "base64"})),
    ])
}

fn scene_schema() -> Value {
    let pose = || object([("position", vector_schema()), ("orientation", rotation_schema())]);
    let colour = || {
        object([
            ("r", number_schema()),
            ("g", number_schema()),
            ("b", number_schema()),
            ("a", number_schema()),
        ])
    };
    let solid = || object([("pose", pose()), ("size", vector_schema()), ("color", colour())]);
    let cylinder = || {
        let mut schema = solid();
        for scale in ["bottom_scale", "top_scale"] {
            schema["properties"][scale] = number_schema();
        }
        schema
    };
    let integers = || list(json!({"type": "integer"}));
    let triangles = || {
        object([
            ("pose", pose()),
            ("points", list(vector_schema())),
            ("color", colour()),
            ("colors", list(colour())),
            ("indices", integers()),
        ])
    };
    let line = || {
        let mut schema = triangles();
        schema["properties"]["type"] = json!({"type": "integer"});
        schema["properties"]["thickness"] = number_schema();
        schema["properties"]["scale_invariant"] = json!({"type": "boolean"});
        schema
    };
    let arrow = || {
        object([
            ("pose", pose()),
            ("shaft_length", number_schema()),
            ("shaft_diameter", number_schema()),
            ("head_length", number_schema()),
            ("head_diameter", number_schema()),
            ("color", colour()),
        ])
    };
    object([
        ("deletions", list(json!({"type": "object"}))),
        (
            "entities",
            list(object([
                ("timestamp", timestamp_schema()),
                ("frame_id", text_schema()),
                ("id", text_schema()),
                ("lifetime", timestamp_schema()),
                ("frame_locked", json!({"type": "boolean"})),
                ("spheres", list(solid())),
                ("cylinders", list(cylinder())),
                ("lines", list(line())),
                ("triangles", list(triangles())),
                ("arrows", list(arrow())),
                ("metadata", list(object([("key", text_schema()), ("value", text_schema())]))),
            ])),
        ),
    ])
}

/// Poses of all body frames in the world.
pub fn transforms(bodies: &[BodyReport], time: f64) -> impl Serialize {
    let transforms = bodies.iter().map(|body| TransformMessage {
        timestamp: Timestamp::of(time),
        parent_frame_id: WORLD,
        child_frame_id: &body.name,
        translation: Xyz::of(&body.pose.center),
        rotation: Xyzw::of(&body.pose.rotation()),
    });
    TransformsMessage { transforms: transforms.collect() }
}

#[derive(Serialize)]
struct TransformsMessage<'a> {
    transforms: Vec<TransformMessage<'a>>,
}

#[derive(Serialize)]
struct TransformMessage<'a> {
    timestamp: Timestamp,
    parent_frame_id: &'static str,
    child_frame_id: &'a str,
    translation: Xyz,
    rotation: Xyzw,
}

/// Severity of a log message.
#[derive(Debug, Clone, Copy)]
pub enum Severity {
    /// As expected.
    Info = 2,
    /// Something is not as it should be.
    Warning = 3,
    /// The run stopped.
    Error = 4,
}

/// One line about the run.
pub fn log(severity: Severity, message: &str, time: f64) -> Value {
    json!({
        "timestamp": Timestamp::of(time),
        "level": severity as u8,
        "message": message,
        "name": "alewife",
        "file": "",
        "line": 0,
    })
}

/// One step.
pub fn step<const D: usize>(snapshot: &Snapshot<'_, D>) -> Value {
    json!({
        "step": snapshot.step,
        "time": snapshot.time,
        "time_step": snapshot.time_step,
        "iterations": snapshot.iterations,
        "n_dofs": snapshot.n_dofs,
    })
}

/// One body.
pub fn body(report: &BodyReport, step: usize, time: f64) -> impl Serialize {
    let Pose { center, .. } = &report.pose;
    let Twist { linear, angular } = &report.twist;
    let recoil = report.recoil.map(|recoil| RecoilMessage {
        center: Xyz::of(&in_space(&recoil.center)),
        velocity: Xyz::of(&in_space(&recoil.velocity)),
        angle: recoil.angle,
        angular_velocity: recoil.angular_velocity,
    });
    BodyMessage {
        step,
        time,
        pose: PoseMessage {
            center: Xyz::of(center),
            rotation: Xyzw::of(&report.pose.rotation()),
            angle: report.pose.heading(),
        },
        twist: TwistMessage { linear: Xyz::of(linear), angular: Xyz::of(angular) },
        load: WrenchMessage::of(&report.load),
        surface_load: WrenchMessage::of(&report.surface_load),
        contact: WrenchMessage::of(&report.contact),
        power: report.power,
        recoil,
    }
}

#[derive(Serialize)]
struct BodyMessage {
    step: usize,
    time: f64,
    pose: PoseMessage,
    twist: TwistMessage,
    load: WrenchMessage,
    surface_load: WrenchMessage,
    contact: WrenchMessage,
    power: f64,
    recoil: Option<RecoilMessage>,
}

#[derive(Serialize)]
struct PoseMessage {
    center: Xyz,
    rotation: Xyzw,
    angle: f64,
}

#[derive(Serialize)]
struct TwistMessage {
    linear: Xyz,
    angular: Xyz,
}

#[derive(Serialize)]
struct WrenchMessage {
    force: Xyz,
    torque: Xyz,
}

impl WrenchMessage {
    fn of(wrench: &Wrench) -> Self {
        Self { force: Xyz::of(&wrench.force), torque: Xyz::of(&wrench.torque) }
    }
}

#[derive(Serialize)]
struct RecoilMessage {
    center: Xyz,
    velocity: Xyz,
    angle: f64,
    angular_velocity: f64,
}

fn timestamp_schema() -> Value {
    object([("sec", json!({"type": "integer"})), ("nsec", json!({"type": "integer"}))])
}

fn object<'a>(properties: impl IntoIterator<Item = (&'a str, Value)>) -> Value {
    let properties = properties.into_iter().map(|(name, value)| (name.to_owned(), value));
    json!({"type": "object", "properties": properties.collect::<serde_json::Map<_, _>>()})
}

fn list(items: Value) -> Value {
    json!({"type": "array", "items": items})
}

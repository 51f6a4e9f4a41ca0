//! The messages of `run.mcap` as JSON: those viewers know by name, and our own.
//!
//! Viewers recognise a schema by its name alone, so the names of the `foxglove` messages and
//! their fields are theirs. Times are simulated seconds.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use serde_json::{Value, json};

use super::solids::{Solids, body_colour, quaternion, vector};
use crate::body::{Pose, Twist, Wrench, in_space};
use crate::case::{Body, Geometry, ShapeSpec};
use crate::simulation::{BodyReport, Snapshot};

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
    /// One step: numbers of the solver and all quantities.
    Step,
    /// One body: pose, twist, loads.
    Body,
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
                ("quantities", json!({"type": "object", "additionalProperties": number_schema()})),
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
                ("cylinders", list(solid())),
                ("lines", list(json!({"type": "object"}))),
            ])),
        ),
    ])
}

/// Poses of all body frames in the world.
pub fn transforms(bodies: &[BodyReport], time: f64) -> Value {
    let transforms = bodies.iter().map(|body| {
        json!({
            "timestamp": timestamp(time),
            "parent_frame_id": WORLD,
            "child_frame_id": body.name,
            "translation": vector(&body.pose.center),
            "rotation": quaternion(&body.pose.rotation()),
        })
    });
    json!({"transforms": transforms.collect::<Vec<_>>()})
}

/// Outlines of all bodies, which stay with the bodies' frames: with where those are.
pub fn scene(bodies: &[Body], reports: &[BodyReport], geometry: Geometry, time: f64) -> Value {
    let entities = bodies.iter().zip(reports).map(|(body, report)| {
        let (mut solids, mut lines) = (Solids::default(), vec![]);
        let centered = Isometry3::identity();
        match &body.shape {
            // A flat cylinder
            ShapeSpec::Disc { radius } => solids.cylinder([*radius, *radius, *radius / 50.0]),
            ShapeSpec::Ellipse { semi_axes: [a, b] } => solids.cylinder([*a, *b, *b / 50.0]),
            ShapeSpec::Sphere { .. } | ShapeSpec::Spheroid { .. } | ShapeSpec::Ellipsoid { .. } => {
                body.shape.semi_axes().into_iter().for_each(|own| solids.ellipsoid(&centered, own));
            }
            ShapeSpec::Capsule { .. }
            | ShapeSpec::Helix(_)
            | ShapeSpec::Curve(_)
            | ShapeSpec::Revolved { .. }
            | ShapeSpec::Union(_) => {
                // The frame is at the centre of mass, the origin of the shape is not
                let from = report.pose.rotation().inverse();
                let origin = from * (body.pose_in_space().translation.vector - report.pose.center);
                let place = Isometry3::translation(origin.x, origin.y, origin.z);
                solids.parts(&place, &body.shape.parts().unwrap_or_default());
            }
            ShapeSpec::Cylinder { radius, length, .. } => {
                for part in body.shape.parts().unwrap_or_default() {
                    solids.cylinder_along_x(&part.pose, *radius, 0.5 * length);
                }
            }
            ShapeSpec::Spline { .. }
            | ShapeSpec::Fish(_)
            | ShapeSpec::Flagellate(_)
            | ShapeSpec::Tube(_) => {
                lines.push(closed_line(&body.shape.points()));
            }
        }
        let Solids { spheres, cylinders } = solids;
        json!({
            "timestamp": timestamp(time),
            "frame_id": body.name,
            "id": body.name,
            "lifetime": timestamp(0.0),
            "frame_locked": true,
            "metadata": [{"key": "geometry", "value": geometry.name()}],
            "arrows": [],
            "cubes": [],
            "spheres": spheres,
            "cylinders": cylinders,
            "lines": lines,
            "triangles": [],
            "texts": [],
            "models": [],
        })
    });
    json!({"deletions": [], "entities": entities.collect::<Vec<_>>()})
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
        "timestamp": timestamp(time),
        "level": severity as u8,
        "message": message,
        "name": "alewife",
        "file": "",
        "line": 0,
    })
}

/// One step.
pub fn step<const D: usize>(snapshot: &Snapshot<'_, D>) -> Value {
    let quantities = snapshot.names.iter().cloned().zip(snapshot.values.iter().map(|v| json!(v)));
    json!({
        "step": snapshot.step,
        "time": snapshot.time,
        "time_step": snapshot.time_step,
        "iterations": snapshot.iterations,
        "n_dofs": snapshot.n_dofs,
        "quantities": quantities.collect::<serde_json::Map<_, _>>(),
    })
}

/// One body.
pub fn body(report: &BodyReport, step: usize, time: f64) -> Value {
    let Pose { center, .. } = &report.pose;
    let Twist { linear, angular } = &report.twist;
    let recoil = report.recoil.map(|recoil| {
        json!({
            "center": vector(&in_space(&recoil.center)),
            "velocity": vector(&in_space(&recoil.velocity)),
            "angle": recoil.angle,
            "angular_velocity": recoil.angular_velocity,
        })
    });
    json!({
        "step": step,
        "time": time,
        "pose": {
            "center": vector(center),
            "rotation": quaternion(&report.pose.rotation()),
            "angle": report.pose.heading(),
        },
        "twist": {"linear": vector(linear), "angular": vector(angular)},
        "load": wrench(&report.load),
        "surface_load": wrench(&report.surface_load),
        "contact": wrench(&report.contact),
        "power": report.power,
        "recoil": recoil,
    })
}

/// Simulated time as the unsigned nanoseconds of a message; times before zero count as zero.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
pub fn nanoseconds(time: f64) -> u64 {
    (time * 1e9).round() as u64
}

fn timestamp(time: f64) -> Value {
    let nanoseconds = nanoseconds(time);
    json!({"sec": nanoseconds / 1_000_000_000, "nsec": nanoseconds % 1_000_000_000})
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

fn wrench(wrench: &Wrench) -> Value {
    json!({"force": vector(&wrench.force), "torque": vector(&wrench.torque)})
}

fn no_offset() -> Value {
    json!({
        "position": vector(&Vector3::zeros()),
        "orientation": quaternion(&UnitQuaternion::identity()),
    })
}

fn closed_line(points: &[[f64; 2]]) -> Value {
    const LINE_LOOP: u8 = 1;
    let points = points.iter().map(|&[x, y]| vector(&Vector3::new(x, y, 0.0)));
    json!({
        "type": LINE_LOOP,
        "pose": no_offset(),
        "thickness": 2.0,
        "scale_invariant": true,
        "points": points.collect::<Vec<_>>(),
        "color": body_colour(),
        "colors": [],
        "indices": [],
    })
}

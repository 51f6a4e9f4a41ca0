//! `Case`: the typed contents of a case file; `Model`: what follows from them.

mod angle;
mod axial_vector;
mod balls;
mod body;
mod case;
mod case_text;
mod check;
mod contact;
mod copies;
mod csv_line;
mod deserialize;
mod diagnostic;
mod domain;
mod extent;
mod fluid;
mod gait;
mod geometry;
mod joint;
pub mod library;
mod link;
mod mean_flow;
mod meant;
mod mesh;
mod mesh_file;
mod model;
mod names;
mod nearest;
mod numbers;
mod orientation;
mod output;
mod part_pose;
mod parts;
mod problem_keys;
mod quantity;
mod random;
mod read;
mod read_mesh;
mod reference;
mod reference_table;
mod region;
mod schema;
mod setting;
mod shape_names;
mod skin;
mod solid;
mod solid_shape;
mod source;
mod speed;
mod spring;
mod statistic;
mod stroke;
mod stroke_file;
mod sweep;
mod swimmer;
mod time;
mod time_function;
mod toml_help;
mod tree;
mod type_error;
mod typing;
mod units;
mod variants;
mod wall_time;

pub use axial_vector::AxialVector;
pub use body::{
    Body, CurveShape, CylinderAxis, GaitSpec, HelixShape, ImposedMotion, LoadFrame, Lock, Motion,
    PartSpec, ShapeSpec, SquirmerGait,
};
pub use case::Case;
pub use check::check;
pub use contact::ContactSpec;
pub use diagnostic::{CaseError, Diagnostic, Severity, printable};
pub use domain::{BoundaryCondition, DomainSpec, Geometry, TimeFunction};
pub use extent::Extent;
pub use fluid::{FlowModel, Fluid};
pub use gait::{
    AnguilliformGait, BentJoint, CarangiformGait, FishShape, FlagellateShape, FlagellumGait,
    JointsGait, PulsatingGait, TubeShape,
};
pub use joint::{Ball, Hinge, Joint, JointKind, Slider};
pub use link::{Link, ShapedLink};
pub use mean_flow::MeanFlowSpec;
pub use mesh::{MeshEquation, MeshSettings, MovingMesh, RefinementBox};
pub use mesh_file::MeshFile;
pub use model::{Model, SwimmerModel};
pub use nearest::{nearest, several_nearest};
pub use numbers::{
    DerivedNumber, derived_numbers, geometry_name, number_table, rounded, significant,
};
pub use orientation::Orientation;
pub use output::{Cadence, Checkpoints, Output, Precision, Probe};
pub use problem_keys::collect_keys;
pub use quantity::{
    BodyQuantity, Column, Component, Condition, FlowQuantity, JointQuantity, NamedComponent,
    ProbeQuantity, Quantity, Shape, Source, SwimmerQuantity, columns, known_quantities,
};
pub use read::CaseFile;
pub use reference::{Expected, Numbers, Reference, ReferenceKind, Scales, Statistics, Variant};
pub use region::{normal_axis, opposite};
pub use schema::schema;
pub use source::Location;
pub use spring::SpringSpec;
pub use statistic::{ForceComponent, Statistic, StatisticKind};
pub use stroke::{Stroke, smooth_ramp};
pub use sweep::{Sweep, SweepPoint, SweepQuantity};
pub use swimmer::{Copies, Pivot, Skin, SwimmerKind, SwimmerSpec};
pub use time::{Adaptive, Convection, Initial, Scheme, Steady, TimeSettings, Unsteady, Until};
pub use units::{UnitLabels, Units};
pub use wall_time::WallTime;

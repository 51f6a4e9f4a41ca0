//! `Case`: the typed contents of a case file; `Model`: what follows from them.

mod model;
mod quantity;
mod read;
mod rules;
pub mod soft;
mod spec;
mod sweep;
mod text;

pub use model::commands::{Asked, CommandError, Commands};
pub use model::derived_number::DerivedNumber;
pub use model::numbers::{derived_numbers, geometry_name, number_table, rounded, significant};
pub use model::random::SplitMix64;
pub use model::region::{normal_axis, opposite};
pub use model::{Model, SwimmerModel};
pub use quantity::signals::{Action as SignalAction, Input, Mistake, Signals};
pub use quantity::{
    BodyQuantity, Column, Component, Condition, FlowQuantity, JointQuantity, NamedComponent,
    NoGradientInTime, ProbeQuantity, Quantity, ScalarProbeQuantity, ScalarQuantity, ScalarSurface,
    ScalarSurfaceQuantity, Shape, SideQuantity, Source, SwimmerQuantity, TracerQuantity, columns,
    differentiable_columns, known_quantities, no_gradient_in_time, reports_sides,
};
pub use read::directory_name::directory_name;
pub use read::elsewhere::data_elsewhere;
pub use read::library;
pub use read::problem_keys::collect_keys;
pub use read::recording::Recording;
pub use read::schema::schema;
pub use read::sought::{SOLVED_TABLES, SoughtNumber, numbers_at};
pub use read::{CaseFile, WrittenNumber};
pub use rules::body::rod::bent::{BentByLoad, bent_by_loads};
pub use rules::{at_rest, check, check_flow, check_reduced, check_starts};
pub use spec::body::axial_vector::AxialVector;
pub use spec::body::command::{Command, Follower};
pub use spec::body::gait::{
    AnguilliformGait, BentJoint, CarangiformGait, FishShape, FlagellateShape, FlagellumGait,
    JointsGait, PulsatingGait, TubeShape,
};
pub use spec::body::given::hole::HoleShape;
pub use spec::body::given::midline::{MidlineGait, MidlineLaw, MidlineTable, MidlineValues};
pub use spec::body::given::surface::{SurfaceCenter, SurfaceShape};
pub use spec::body::joint::{Ball, Hinge, Joint, JointKind, Slider};
pub use spec::body::link::{Link, ShapedLink};
pub use spec::body::motion::by_axis::{
    AxisMotion, Driven, DrivenLaw, GivenRate, MotionsByAxis, TurningMotion,
};
pub use spec::body::motion::inertia::InertiaSpec;
pub use spec::body::motion::{ImposedMotion, LoadFrame, Lock, Motion};
pub use spec::body::orientation::Orientation;
pub use spec::body::rod::{
    Activation, AlongBody, Attached, EndFrame, EndLoadSpec, EndLoads, EndMoment, Hold, LoadedEnd,
    RestShape, RodEnd, RodSpec,
};
pub use spec::body::slip::SlipGait;
pub use spec::body::spring::SpringSpec;
pub use spec::body::squirmer::SquirmerGait;
pub use spec::body::stroke::{Cycle, Stroke, smooth_ramp};
pub use spec::body::swimmer::{Copies, Pivot, Skin, SwimmerKind, SwimmerSpec};
pub use spec::body::{Body, CurveShape, CylinderAxis, GaitSpec, HelixShape, PartSpec, ShapeSpec};
pub use spec::case::Case;
pub use spec::comparison::data::DataSpec;
pub use spec::comparison::reference::{
    Expected, Numbers, Reference, ReferenceKind, Scales, Statistics, Variant,
};
pub use spec::comparison::statistic::{ForceComponent, Statistic, StatisticKind};
pub use spec::comparison::uncertainty::Uncertainty;
pub use spec::contact::{ContactLosses, ContactSpec};
pub use spec::domain::{BoundaryCondition, DomainSpec, Geometry};
pub use spec::environment::{
    Action, Ending, EnvironmentSpec, Law, Observation, Randomised, RangedAction, RewardTerm,
    ScaledObservation,
};
pub use spec::extent::Extent;
pub use spec::field::{DipoleField, FieldSpec, LinearField, MagneticSpec, RotatingField};
pub use spec::fluid::mean_flow::MeanFlowSpec;
pub use spec::fluid::scalar::{ScalarCondition, ScalarSpec};
pub use spec::fluid::tracer::{SeedGrid, SeedLine, TracerRegion, TracerSpec};
pub use spec::fluid::viscosity::{HerschelBulkley, Plateaus, PowerLaw, ShearLaw, ViscositySpec};
pub use spec::fluid::{FlowModel, Fluid};
pub use spec::formula::expressions::{CaseExpression, ExpressionPlace};
pub use spec::formula::{Definitions, Expression, Formula, FormulaError, ParsedFormula};
pub use spec::given_mesh::mesh_file::MeshFile;
pub use spec::given_mesh::region_mesh::{RegionFault, unit_hint};
pub use spec::given_mesh::region_spec::{NamedSolid, RegionSpec, SidePart};
pub use spec::initial::InitialFlow;
pub use spec::mesh::{MeshEquation, MeshSettings, MovingMesh, RefinementBox};
pub use spec::optimisation::{
    Bound, FlowConstraint, FlowObjective, FlowOptimisation, FlowParameter, Limit, NamedQuantity,
    ObjectiveExpression, OptimumReference, SearchSettings, WeightedQuantity,
};
pub use spec::output::{Cadence, Checkpoints, Output, Precision, Probe};
pub use spec::profile::{ColumnAxis, ProfileColumn, ProfileSpec};
pub use spec::reduced::calibration::{
    CalibrationSpec, FitBy, FitName, ProposalSpec, Proposer, RecordFrame, RecordSpec,
};
pub use spec::reduced::law::{Coefficient, LoadLaw};
pub use spec::reduced::mechanics::{EllipsoidSpec, KeelSpec, ServoSpec, SiteSpec, TendonSpec};
pub use spec::reduced::parts::{
    BuoyancySpec, CalibratedSpec, ConnectionSpec, LagSpec, ThrusterSpec,
};
pub use spec::reduced::{AddedMassSpec, LiftSpec, ReducedSpec};
pub use spec::time::{
    Adaptive, Convection, Initial, Scheme, Steady, TimeSettings, Unsteady, Until,
};
pub use spec::time_function::TimeFunction;
pub use spec::units::{UnitLabels, Units};
pub use sweep::{Sweep, SweepPoint, SweepQuantity};
pub use text::diagnostic::{CaseError, Diagnostic, Severity, printable};
pub use text::nearest::{nearest, several_nearest};
pub use text::source::Location;
pub use text::type_error::suggestion;
pub use text::wall_time::WallTime;

//! Names of tables that hold exactly one of several alternatives.

/// Tables that hold exactly one of several alternatives.
///
/// Where two texts name different alternatives, the later one replaces the earlier one whole.
pub const CHOICES: [&str; 32] = [
    "kind",
    "length",
    "angle",
    "torque",
    "force",
    "copies",
    "domain",
    "time",
    "shape",
    "motion",
    "gait",
    "orientation",
    "rest_orientation",
    "contact",
    "factor",
    "load_factor",
    "turn",
    "beat",
    "bend",
    "fields",
    "series",
    "until",
    "viscosity",
    "curvature",
    "hold",
    "moment",
    "rest",
    "angular_factor",
    "rotation",
    "x",
    "y",
    "z",
];

//! Which columns gradients are known of: loads, powers and velocities of bodies in a steady flow, and where they have got
//! to at the end of a run, with averages over the last cycle.

use super::{Column, columns};
use crate::{Case, FlowModel, Model, Scheme, TimeSettings};

/// Names, after that of their owner, of the quantities that follow from loads and velocities of bodies.
const NAMES: [&str; 11] = [
    "velocity",
    "angular_velocity",
    "force",
    "torque",
    "power",
    "shape_power",
    "lighthill_efficiency",
    "drag_coefficient",
    "lift_coefficient",
    "side_coefficient",
    "moment_coefficient",
];

/// The same of those at the end of a run; places are their components.
const AT_THE_END: [&str; 10] = [
    "x",
    "y",
    "z",
    "angle",
    "cycle",
    "cycle.angle",
    "cycle.speed",
    "cycle.power",
    "cycle.cost_of_transport",
    "cycle.lighthill_efficiency",
];

/// Of these the one that a reduced model does not have, and those that one without loads does not.
const OF_A_FLOW: &str = "cycle.lighthill_efficiency";
const OF_LOADS: [&str; 2] = ["cycle.power", "cycle.cost_of_transport"];

impl Case {
    /// Whether a search follows the gradient of its reduced model: where it has no other, or the full solver has no
    /// gradient.
    #[must_use]
    pub fn is_searched_reduced(&self) -> bool {
        self.is_reduced_only() || (self.reduced.is_some() && no_gradient_in_time(self).is_some())
    }
}

/// The columns of a case whose gradients are known.
#[must_use]
pub fn differentiable_columns(model: &Model) -> Vec<Column> {
    let bodies_and_swimmers = model.bodies.iter().map(|body| &body.name);
    let owners: Vec<&String> =
        bodies_and_swimmers.chain(model.swimmers.iter().map(|swimmer| &swimmer.name)).collect();
    let is_reduced = model.case.is_searched_reduced();
    let has_loads = !is_reduced || model.case.reduced_model().connection.is_none();
    let known: &[&str] = match model.case.time {
        TimeSettings::Steady(_) => &NAMES,
        TimeSettings::Unsteady(_) => &AT_THE_END,
    };
    let is_differentiable = |column: &Column| {
        let of = |owner: &&&String| column.name.strip_prefix(owner.as_str())?.strip_prefix('.');
        owners.iter().filter_map(|owner| of(&owner)).any(|name| {
            let whole = name.strip_suffix(['x', 'y', 'z']);
            let whole = whole.and_then(|name| name.strip_suffix('.')).unwrap_or(name);
            known.contains(&whole)
                && !(is_reduced && whole == OF_A_FLOW)
                && (has_loads || !OF_LOADS.contains(&whole))
        })
    };
    columns(model).into_iter().filter(is_differentiable).collect()
}

/// Why a run has no gradient of what it ends with, and what has one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoGradientInTime {
    /// The key it is about.
    pub key: &'static str,
    /// Why.
    pub message: &'static str,
    /// What to do instead.
    pub help: &'static str,
}

/// Why the run of a case has no gradient, if it has none; steady flows have theirs.
#[must_use]
pub fn no_gradient_in_time(case: &Case) -> Option<NoGradientInTime> {
    let TimeSettings::Unsteady(settings) = &case.time else { return None };
    let is_explicit = settings.scheme == Scheme::Rk3 && settings.adaptive.is_none();
    let refused = [
        (
            case.fluid.model != FlowModel::Stokes || !is_explicit,
            NoGradientInTime {
                key: "time",
                message: "gradients are those of steady flows, and of runs without inertia by fixed steps of the scheme `rk3`",
                help: "write [time.steady], or `fluid.model = \"stokes\"` with `step` and `scheme = \"rk3\"` in \
                       [time.unsteady]",
            },
        ),
        (
            settings.until.is_some(),
            NoGradientInTime {
                key: "time.unsteady.until",
                message: "gradients are those of runs whose end is given",
                help: "leave `until` out",
            },
        ),
        (
            case.contact.is_some(),
            NoGradientInTime {
                key: "contact",
                message: "gradients of runs know no contact yet",
                help: "leave [contact] out where bodies stay apart",
            },
        ),
        (
            case.frame.is_some(),
            NoGradientInTime {
                key: "frame",
                message: "gradients of runs know no frame that travels yet",
                help: "leave `frame` out",
            },
        ),
    ];
    refused.into_iter().find_map(|(is_so, why)| is_so.then_some(why))
}

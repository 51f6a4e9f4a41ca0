//! `Quantity`: what a run measures; names, columns, references and the user's page follow from it.
//!
//! A new quantity is one row of `table.rs` and one arm of its `match` in the measurements of a run.

mod differentiable;
mod row;
mod scalars;
mod sides;
pub(crate) mod signals;
mod table;

use crate::{FlowModel, Geometry, MagneticSpec, Model, SwimmerModel, TimeSettings};

pub use self::differentiable::{NoGradientInTime, differentiable_columns, no_gradient_in_time};
pub use self::row::{Component, Condition, NamedComponent, Quantity, Shape};
pub use self::scalars::ScalarSurface;
use self::scalars::is_crossed;
use self::sides::reported_sides;
pub use self::table::{
    BodyQuantity, FlowQuantity, JointQuantity, ProbeQuantity, ScalarProbeQuantity, ScalarQuantity,
    ScalarSurfaceQuantity, SideQuantity, SwimmerQuantity, TracerQuantity,
};

/// A column of `series.csv`: which quantity, and of what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Of a body, by its number in [`Model::bodies`].
    Body(usize, BodyQuantity),
    /// Of a joint, counted in the order of the bodies that are their children.
    Joint(usize, JointQuantity),
    /// Of a swimmer, by its number in [`Model::swimmers`].
    Swimmer(usize, SwimmerQuantity),
    /// Of a probe, by its number in [`Case::probe`](crate::Case::probe).
    Probe(usize, ProbeQuantity),
    /// Of a cloud of tracers, by its number in [`Case::tracer`](crate::Case::tracer).
    Tracer(usize, TracerQuantity),
    /// Of a scalar, by its number in [`Case::scalar`](crate::Case::scalar).
    Scalar(usize, ScalarQuantity),
    /// Of a scalar on a body or a side.
    ScalarSurface(usize, ScalarSurface, ScalarSurfaceQuantity),
    /// Of a scalar at a probe.
    ScalarProbe(usize, usize, ScalarProbeQuantity),
    /// Of the flow.
    Flow(FlowQuantity),
    /// Of a side, by its number in [`Case::sides`](crate::Case::sides).
    Side(usize, SideQuantity),
}

/// A named column of `series.csv`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Name, such as `cylinder.force.x`.
    pub name: String,
    /// Whose quantity it is, and which.
    pub source: Source,
    /// Which number of the quantity.
    pub component: Component,
}

/// The columns of `series.csv` after `time`.
#[must_use]
pub fn columns(model: &Model) -> Vec<Column> {
    let case = &model.case;
    let of_case = conditions_of_case(model);
    let mut columns = Vec::new();
    for (nth, body) in model.bodies.iter().enumerate() {
        let source = |quantity| Source::Body(nth, quantity);
        let is_magnet = case.magnetic_field().is_some() && !body.magnetic_moment.is_empty();
        let own = [
            Condition::Moment.holding_if(is_magnet),
            Condition::Rod.holding_if(body.rod.is_some()),
            Condition::Activation.holding_if(body.activation.is_some()),
            Condition::EndLoad.holding_if(body.end_loads().next().is_some()),
            Condition::Attached.holding_if(body.attached.is_some()),
        ];
        let known: Vec<Condition> =
            of_case.iter().copied().chain(own.into_iter().flatten()).collect();
        add(&mut columns, &body.name, BodyQuantity::TABLE, &known, source);
    }
    let joints = model.bodies.iter().enumerate().filter_map(|(index, child)| {
        let joint = model.joint_above(index)?;
        Some((child, model.joints[joint].kind.is_arm()))
    });
    for (nth, (child, is_arm)) in joints.enumerate() {
        let source = |quantity| Source::Joint(nth, quantity);
        let kind = if is_arm { Condition::Arm } else { Condition::Pivot };
        let known = [&of_case[..], &[kind]].concat();
        add(&mut columns, &child.name, JointQuantity::TABLE, &known, source);
    }
    for (nth, swimmer) in model.swimmers.iter().enumerate() {
        let source = |quantity| Source::Swimmer(nth, quantity);
        let own = conditions_of_swimmer(model, swimmer);
        let known = [&of_case[..], &own].concat();
        add(&mut columns, &swimmer.name, SwimmerQuantity::TABLE, &known, source);
    }
    for (nth, probe) in case.probe.iter().enumerate() {
        let source = |quantity| Source::Probe(nth, quantity);
        add(&mut columns, &probe.name, ProbeQuantity::TABLE, &of_case, source);
    }
    for (nth, tracer) in case.tracer.iter().enumerate() {
        let source = |quantity| Source::Tracer(nth, quantity);
        let region = Condition::Region.holding_if(tracer.region.is_some());
        let known: Vec<Condition> = of_case.iter().copied().chain(region).collect();
        add(&mut columns, &tracer.name, TracerQuantity::TABLE, &known, source);
    }
    add_scalars(&mut columns, model, &of_case);
    add(&mut columns, "flow", FlowQuantity::TABLE, &of_case, Source::Flow);
    for side in reported_sides(model) {
        let source = |quantity| Source::Side(side.number, quantity);
        add(&mut columns, side.name, SideQuantity::TABLE, &of_case, source);
    }
    columns
}

/// Adds the columns of all scalars.
fn add_scalars(columns: &mut Vec<Column>, model: &Model, of_case: &[Condition]) {
    let case = &model.case;
    for (nth, scalar) in case.scalar.iter().enumerate() {
        let owner = format!("scalar.{}", scalar.name);
        let source = |quantity| Source::Scalar(nth, quantity);
        add(columns, &owner, ScalarQuantity::TABLE, of_case, source);
        let difference = Condition::Difference.holding_if(scalar.difference.is_some());
        let on_bodies: Vec<Condition> = of_case.iter().copied().chain(difference).collect();
        for (body, known) in model.bodies.iter().enumerate() {
            let source = |quantity| Source::ScalarSurface(nth, ScalarSurface::Body(body), quantity);
            let owner = format!("{owner}.{}", known.name);
            add(columns, &owner, ScalarSurfaceQuantity::TABLE, &on_bodies, source);
        }
        let sides = case.sides().into_iter().enumerate();
        for (side, name) in sides.filter(|(_, name)| is_crossed(model, name)) {
            let source = |quantity| Source::ScalarSurface(nth, ScalarSurface::Side(side), quantity);
            let owner = format!("{owner}.{name}");
            add(columns, &owner, ScalarSurfaceQuantity::TABLE, of_case, source);
        }
        for (probe, known) in case.probe.iter().enumerate() {
            let source = |quantity| Source::ScalarProbe(nth, probe, quantity);
            let owner = format!("{owner}.{}", known.name);
            add(columns, &owner, ScalarProbeQuantity::TABLE, of_case, source);
        }
    }
}

/// The conditions that hold in a case, whatever the owner of a quantity.
fn conditions_of_case(model: &Model) -> Vec<Condition> {
    let case = &model.case;
    let is_spatial = case.geometry == Geometry::Spatial;
    let has_gradient = case.magnetic_field().is_some_and(MagneticSpec::has_gradient);
    let has_convection = case.fluid.model == FlowModel::NavierStokes;
    let conditions = [
        Condition::Planar.holding_if(!is_spatial),
        Condition::Spatial.holding_if(is_spatial),
        Condition::Scales.holding_if(case.has_coefficients()),
        Condition::Contact.holding_if(case.contact.is_some()),
        Condition::IdleSides.holding_if(model.balances_energy()),
        Condition::ClosedSides.holding_if(model.balances_momentum()),
        Condition::MeanFlow.holding_if(case.flow.is_some()),
        Condition::Convection.holding_if(has_convection),
        Condition::Unsteady.holding_if(matches!(case.time, TimeSettings::Unsteady(_))),
        Condition::MovingMesh.holding_if(model.mesh_moves()),
        Condition::FieldGradient.holding_if(has_gradient),
    ];
    conditions.into_iter().flatten().collect()
}

/// The conditions that hold for a swimmer.
fn conditions_of_swimmer(model: &Model, swimmer: &SwimmerModel) -> Vec<Condition> {
    let is_unsteady = matches!(model.case.time, TimeSettings::Unsteady(_));
    let has_cycles = swimmer.period.is_some() && is_unsteady;
    let conditions = [
        Condition::SeveralBodies.holding_if(swimmer.bodies.len() > 1),
        Condition::SeparateBodies.holding_if(has_separate_bodies(model, &swimmer.bodies)),
        Condition::Cycles.holding_if(has_cycles),
        Condition::NoCycles.holding_if(!has_cycles),
        Condition::Resistance.holding_if(swimmer.resistance.is_some()),
    ];
    conditions.into_iter().flatten().collect()
}

/// Whether two of these bodies share no pivot: there are more pairs than pivots.
fn has_separate_bodies(model: &Model, bodies: &[usize]) -> bool {
    let is_on_pivot = |body: usize| {
        let joint = model.joint_above(body).map(|joint| &model.joints[joint]);
        joint.is_some_and(|joint| {
            let parent = model.body_index(&joint.parent);
            !joint.kind.is_arm() && parent.is_some_and(|parent| bodies.contains(&parent))
        })
    };
    let n_pivots = bodies.iter().filter(|body| is_on_pivot(**body)).count();
    bodies.len() * bodies.len().saturating_sub(1) / 2 > n_pivots
}

/// Adds those quantities of an owner that exist.
fn add<T: Copy>(
    columns: &mut Vec<Column>,
    owner: &str,
    table: &[Quantity<T>],
    known: &[Condition],
    source: impl Fn(T) -> Source,
) {
    for row in table {
        let existing = row.components().into_iter().filter(|one| one.exists_where(known));
        columns.extend(existing.map(|NamedComponent { name, component, .. }| Column {
            name: format!("{owner}.{name}"),
            source: source(row.id),
            component,
        }));
    }
}

/// Names of all quantities of a run: the columns of `series.csv` after `time`.
#[must_use]
pub fn known_quantities(model: &Model) -> Vec<String> {
    columns(model).into_iter().map(|column| column.name).collect()
}

/// Whether any side of a case has quantities.
#[must_use]
pub fn reports_sides(model: &Model) -> bool {
    !reported_sides(model).is_empty()
}

/// Whether a quantity would be one of a side, if the sides were reported.
pub(crate) fn is_of_a_side(model: &Model, name: &str) -> bool {
    let Some((owner, quantity)) = name.split_once('.') else { return false };
    let mut numbers = SideQuantity::TABLE.iter().flat_map(Quantity::components);
    model.case.sides().contains(&owner) && numbers.any(|one| one.name == quantity)
}

/// Quantities that had another name once, and what they are called.
const RENAMED: [(&str, &str); 2] =
    [("least_gap", "minimum_gap"), ("spent_power", "expended_power")];

/// The name by which a quantity of an old name is known now.
pub(crate) fn renamed(name: &str) -> Option<String> {
    let (owner, quantity) = name.rsplit_once('.')?;
    let (_, new) = RENAMED.iter().find(|(old, _)| *old == quantity)?;
    Some(format!("{owner}.{new}"))
}

/// The conditions under which quantities of a name exist, whatever the case.
pub(crate) fn conditions_of(name: &str) -> Vec<Vec<Condition>> {
    fn of<T>(table: &[Quantity<T>], name: &str) -> Vec<Vec<Condition>> {
        let all = table.iter().flat_map(Quantity::components);
        let found = all.filter(|one| name.ends_with(&format!(".{}", one.name)));
        found.map(|one| one.when).collect()
    }
    let mut found = of(BodyQuantity::TABLE, name);
    found.extend(of(SwimmerQuantity::TABLE, name));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Case;

    fn names(setting: &[&str]) -> Vec<String> {
        let text = r#"
            title = "all quantities"
            geometry = "planar"
            fluid = { model = "stokes", viscosity = 1.0, density = 1.0 }
            domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
            boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
            mesh = { size = 0.5 }
            time.unsteady = { step = 0.1, end = 1.0 }
            probe = [{ name = "point", point = [1.0, 1.0] }]
            [[swimmer]]
            name = "pair"
            center = [0.0, 0.0]
            resistance = 2.0
            [swimmer.kind.linked-spheres]
            radii = [0.2, 0.2]
            arms = [{ sine = { mean = 1.0, amplitude = 0.2, period = 1.0 } }]
        "#;
        let settings: Vec<String> = setting.iter().map(|&setting| setting.to_owned()).collect();
        known_quantities(&Case::parse("all.toml", text, &settings).unwrap().model)
    }

    #[test]
    fn columns_are_named_and_ordered_as_before() {
        let body = "x y angle velocity.x velocity.y angular_velocity acceleration.x \
                    acceleration.y force.x force.y torque surface_force.x surface_force.y \
                    surface_torque power";
        let of = |owner: &str, names: &str| -> Vec<String> {
            names.split_whitespace().map(|name| format!("{owner}.{name}")).collect()
        };
        let arm = "joint.length joint.rate joint.force joint.power";
        let group = "x y angle velocity.x velocity.y angular_velocity force.x force.y torque power \
                     shape_power expended_power thrust drag minimum_gap";
        let cycle = "cycle.x cycle.y cycle.angle cycle.speed cycle.power cycle.cost_of_transport \
                     cycle.efficiency cycle.drift cycle.lighthill_efficiency";
        let flow = "dissipation kinetic_energy mass_defect energy_defect";
        let expected = [
            of("pair-1", body),
            of("pair-2", body),
            of("pair-2", arm),
            of("pair", group),
            of("pair", cycle),
            of("point", "velocity.x velocity.y pressure"),
            of("flow", flow),
            of("flow", "minimum_gap cells remeshes"),
        ];
        assert_eq!(names(&[]), expected.concat());

        let coefficients = "drag_coefficient lift_coefficient moment_coefficient";
        let contact = "contact_force.x contact_force.y contact_torque";
        let loaded = names(&[
            "scales={ length=1.0, velocity=1.0 }",
            "contact.barrier={ range=0.1, stiffness=1.0 }",
        ]);
        let expected = [of("pair-1", body), of("pair-1", coefficients), of("pair-1", contact)];
        assert_eq!(loaded[..21], expected.concat());

        let open = names(&["boundary.left=traction-free"]);
        assert!(open.contains(&"flow.energy_defect".to_owned()), "no work without traction");
        let given = names(&["boundary.left={ velocity = { value = [0.1, 0.0] } }"]);
        assert!(!given.contains(&"flow.energy_defect".to_owned()), "that side works, too");
        let sheet = Case::read("taylor-sheet", &[]).unwrap().model;
        assert!(known_quantities(&sheet).contains(&"flow.energy_defect".to_owned()));

        let convected = names(&["fluid.model=navier-stokes"]);
        assert!(convected.contains(&"flow.momentum_defect".to_owned()), "{convected:?}");
        let open = names(&["fluid.model=navier-stokes", "boundary.left=do-nothing"]);
        assert!(!open.contains(&"flow.momentum_defect".to_owned()), "momentum leaves");

        let steady = names(&["time.steady={}"]);
        assert!(
            !steady.iter().any(|name| name.contains(".cycle.") || name.contains("minimum_gap"))
        );
        assert!(steady.contains(&"pair.lighthill_efficiency".to_owned()), "{steady:?}");
    }
}

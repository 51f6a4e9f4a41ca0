//! Problems of `[fluid]`, and numbers that disagree.

use super::viscosity;
use crate::model::numbers::{density_ratio, reynolds, significant};
use crate::rules::Findings;
use crate::spec::fluid::viscosity::ViscositySpec;
use crate::{Case, FlowModel, Geometry, Model, Motion};

/// Largest relative difference between a declared number and the derived one.
const AGREEMENT: f64 = 1e-6;

/// Cell Reynolds number of the finest cells above which no layer at a surface is resolved: a cell
/// is then more than thirty layers of the thickness sqrt(nu h / U) thick.
const UNRESOLVED: f64 = 1e3;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let fluid = &case.fluid;
    if fluid.model != FlowModel::Stokes && fluid.density == 0.0 {
        let model = if fluid.model == FlowModel::UnsteadyStokes {
            "unsteady-stokes"
        } else {
            "navier-stokes"
        };
        findings.error(
            "fluid.density",
            format!("the model `{model}` has inertia, but the fluid has no density"),
            "add `density = ...` to [fluid], or set `model = \"stokes\"`",
        );
    }
    if findings.is_vector(&fluid.gravity)
        && case.geometry == Geometry::Axisymmetric
        && fluid.gravity[1] != 0.0
    {
        findings.error(
            "fluid.gravity",
            format!("gravity {:?} is not along the axis", fluid.gravity),
            "in an axisymmetric case write gravity = [g, 0.0]",
        );
    }
    let pulls = fluid.gravity.iter().any(|part| *part != 0.0);
    let mut bodies = findings.model().bodies.iter();
    if pulls
        && fluid.density == 0.0
        && bodies.any(|body| {
            let own = body.mass.or(body.density).unwrap_or(0.0);
            body.motion == Motion::Free && own > 0.0
        })
    {
        findings.warning(
            "fluid.gravity",
            "gravity acts, but the fluid has no density: nothing is buoyant".to_owned(),
            "add `density = ...` to [fluid]; in slow flow (stokes) it is used for buoyancy only",
        );
    }
    viscosity::check(findings);
    declared_numbers(findings);
    resolution(findings);
}

/// Warns of a flow that is far too fast, or a fluid far too thin, for the finest cells there are.
fn resolution(findings: &mut Findings<'_>) {
    let Some(Crossing { speed, reynolds }) = finest_crossing(findings.model()) else { return };
    if reynolds > UNRESOLVED {
        findings.warning(
            "fluid.viscosity",
            format!(
                "with the speed {} the cell Reynolds number of the finest cells is {reynolds:.1e}: the \
                 mesh does not resolve such a flow, and the run will not be right, if it ends at all",
                significant(speed)
            ),
            "take a larger viscosity, smaller cells, or units in which they fit",
        );
    }
}

/// What the finest cells meet.
struct Crossing {
    /// The speed that can be expected (m/s).
    speed: f64,
    /// Cell Reynolds number.
    reynolds: f64,
}

/// The flow over the finest cells that are asked for; none without convection.
fn finest_crossing(model: &Model) -> Option<Crossing> {
    if model.case.is_reduced_only() {
        return None;
    }
    let Case { fluid, mesh, .. } = &model.case;
    let speed = model.expected_speed().filter(|_| fluid.model == FlowModel::NavierStokes)?;
    let sizes = mesh.surface.into_iter().chain(mesh.sides.values().copied());
    let sizes = sizes.chain(mesh.boxes.iter().map(|refined| refined.size));
    let sizes = sizes.chain(model.bodies.iter().filter_map(|body| body.size));
    let size = mesh.scale * sizes.fold(mesh.size, f64::min);
    Some(Crossing {
        speed,
        reynolds: fluid.density * speed * size / model.case.reference_viscosity(),
    })
}

/// `[numbers]` against what follows from the rest of the case.
fn declared_numbers(findings: &mut Findings<'_>) {
    let case = findings.case();
    let formula = "density * scales.velocity * scales.length / viscosity";
    let ratio = "density of the first body / density of the fluid";
    let numbers = [
        ("numbers.reynolds", "Reynolds number", case.numbers.reynolds, reynolds(case), formula),
        (
            "numbers.density_ratio",
            "density ratio",
            case.numbers.density_ratio,
            density_ratio(findings.model()),
            ratio,
        ),
    ];
    let viscosity = case.reference_viscosity();
    let is_newtonian = matches!(case.fluid.viscosity, ViscositySpec::Newtonian(_));
    let has_mass = findings.model().bodies.first().is_some_and(|body| body.mass.is_some());
    let ways = ["fluid.viscosity", "body.0.density"];
    for ((key, name, declared, derived, formula), way) in numbers.into_iter().zip(ways) {
        match (declared, derived) {
            (Some(declared), Some(derived)) => {
                // Written so that a difference that is not a number disagrees, too.
                let agrees = (declared - derived).abs() <= AGREEMENT * derived.abs();
                if !agrees {
                    findings.error(
                        key,
                        format!(
                            "the {name} is declared as {declared}, but the case gives {} \
                             = {formula}",
                            significant(derived)
                        ),
                        &match way {
                            "fluid.viscosity" if declared > 0.0 && is_newtonian => format!(
                                "correct it, write {way} = {}, or sweep {key}, which the viscosity follows",
                                significant(viscosity * derived / declared)
                            ),
                            "body.0.density" if !has_mass => format!(
                                "correct it, or write {way} = {}",
                                significant(declared * case.fluid.density)
                            ),
                            _ => "correct the declared number, or the values it follows from".to_owned(),
                        },
                    );
                }
            }
            (Some(declared), None) => findings.error(
                key,
                format!("the {name} is declared as {declared}, but cannot be derived"),
                &format!("it is {formula}: give all of them"),
            ),
            (None, _) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::read::library;

    fn warnings(name: &str, settings: &[&str]) -> Vec<String> {
        let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
        let found = check(&Case::read(name, &settings).unwrap());
        let cells = found.into_iter().filter(|one| one.message.contains("cell Reynolds"));
        cells.map(|one| one.message).collect()
    }

    #[test]
    fn a_mesh_that_cannot_resolve_the_flow_is_warned_of() {
        let of = |name: &str| {
            let crossing = finest_crossing(&Case::read(name, &[]).unwrap().model);
            crossing.map_or(0.0, |crossing| crossing.reynolds)
        };
        let mut most = 0.0f64;
        for case in library::list() {
            most = most.max(of(case.name));
            for variant in Case::read(case.name, &[]).unwrap().variants {
                most = most.max(of(&format!("{}/{variant}", case.name)));
            }
        }
        println!("cell Reynolds numbers of shipped cases: up to {most}");
        assert!(most > 1.0 && most < 0.2 * UNRESOLVED, "{most}");
        assert_eq!(warnings("lid-driven-cavity", &[]), [""; 0]);
        let thin = ["fluid.viscosity=1e-9", "numbers={}", "reference=[]", "variant=[]"];
        let found = warnings("lid-driven-cavity", &thin);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("with the speed 1 the cell Reynolds number"), "{found:?}");
    }
}

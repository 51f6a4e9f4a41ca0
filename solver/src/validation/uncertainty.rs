//! What a mesh and a step leave: the rule of Roache, from a run and its companion with coarser ones.
//!
//! The grid convergence index (@roache1994): with a factor of safety `F` and an order `p`, a value `f` and that
//! of a companion `g`, whose cells and steps are `r` times as long, have the uncertainty
//! `F |f - g| / (r^p - 1)`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::comparison::Comparison;
use crate::case::{Case, DomainSpec, Scheme, TimeSettings};

/// Factor of safety where two meshes are compared and the order is not observed but taken for granted.
const SAFETY: f64 = 3.0;

/// How much longer the cells and the steps of a companion shall be.
const COARSER: f64 = std::f64::consts::SQRT_2;

/// The ratio of lengths below which the difference of a companion is no estimate.
const LEAST_RATIO: f64 = 1.1;

/// The order that is taken for granted: velocities and pressures converge faster where flow and boundary are
/// smooth, but not at edges, in thin gaps and with steps of second order.
const ORDER: f64 = 2.0;

/// The part of a value below which no uncertainty of it is taken to be: that two meshes agree better is chance.
const LEAST_SHARE: f64 = 2e-5;

/// The size of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeshSize {
    /// Cells.
    pub cells: usize,
    /// Shortest edge (m).
    pub shortest_edge: f64,
}

/// What a run was made with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSize {
    /// The mesh it began with.
    pub mesh: MeshSize,
    /// Unknowns of the linear system.
    pub dofs: usize,
    /// Steps; 0 of a steady solution.
    pub steps: usize,
    /// CPU seconds.
    pub cpu_seconds: f64,
}

/// Why a companion of a case would not show what its mesh leaves, if so.
#[must_use]
pub fn no_companion(case: &Case) -> Option<&'static str> {
    // The surface of a file has errors of its own, and each mesh is cut out of it
    let is_given = matches!(case.domain, DomainSpec::Mesh(_));
    is_given.then_some("a mesh file gives its sides, which a companion would share")
}

/// Settings of the companion of a case, as on the command line.
#[must_use]
pub fn coarser_settings(case: &Case) -> Vec<String> {
    let mut settings = vec![format!("mesh.scale={:?}", case.mesh.scale * COARSER)];
    let TimeSettings::Unsteady(unsteady) = &case.time else { return settings };
    let Some(adaptive) = &unsteady.adaptive else {
        // Whole steps to the end, as most cases have them
        let steps = (unsteady.end / unsteady.step / COARSER).round().max(1.0);
        settings.push(format!("time.unsteady.step={:?}", unsteady.end / steps));
        return settings;
    };
    settings.push(format!("time.unsteady.step={:?}", unsteady.step * COARSER));
    // What a step of a method of order p is wrong by grows with its length to p + 1
    let tolerance = adaptive.tolerance * COARSER.powf(order_in_time(unsteady.scheme) + 1.0);
    settings.push(format!("time.unsteady.adaptive.tolerance={tolerance:?}"));
    if let Some(largest) = adaptive.largest {
        settings.push(format!("time.unsteady.adaptive.largest={:?}", largest * COARSER));
    }
    settings
}

fn order_in_time(scheme: Scheme) -> f64 {
    match scheme {
        Scheme::Bdf1 => 1.0,
        Scheme::Bdf2 | Scheme::Rk3 => ORDER,
    }
}

/// How a companion differs from a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refinement {
    /// How much longer its cells are, or its steps if they are less so (1).
    pub ratio: f64,
    /// The order that is taken for granted.
    pub order: f64,
}

impl Refinement {
    /// Between the run of a case and its companion, by their numbers of cells and steps.
    ///
    /// # Errors
    /// Why they show nothing: one of them is hardly coarser.
    pub fn between(case: &Case, fine: RunSize, coarse: RunSize) -> Result<Self, String> {
        let quotient = |fine: usize, coarse: usize| fine as f64 / coarse.max(1) as f64;
        let dimensions = case.geometry.dimensions() as f64;
        let cells = quotient(fine.mesh.cells, coarse.mesh.cells).powf(dimensions.recip());
        let (steps, order) = match &case.time {
            TimeSettings::Steady(_) => (f64::INFINITY, ORDER),
            TimeSettings::Unsteady(unsteady) => {
                (quotient(fine.steps, coarse.steps), order_in_time(unsteady.scheme))
            }
        };
        let (ratio, what) = if cells <= steps { (cells, "cells") } else { (steps, "steps") };
        if ratio < LEAST_RATIO {
            return Err(format!("its {what} are only {ratio:.2} times as long"));
        }
        Ok(Self { ratio, order })
    }

    /// The uncertainty of a value, whose companion is another one.
    #[must_use]
    pub fn uncertainty(self, fine: f64, coarse: f64) -> f64 {
        SAFETY * (fine - coarse).abs() / (self.ratio.powf(self.order) - 1.0)
    }
}

/// Gives the values of a run their uncertainties by those of its companion, or the reason why there are none.
pub fn set_uncertainties(
    values: &mut [Comparison],
    companion: &[Comparison],
    refinement: &Result<Refinement, String>,
) {
    for (index, value) in values.iter_mut().enumerate() {
        let Ok(fine) = value.computed else { continue };
        value.numerical = Some(refinement.clone().and_then(|refinement| {
            let other = companion.get(index).ok_or("it has no such value")?;
            let difference = refinement.uncertainty(fine, other.computed.clone()?);
            Ok(difference.max(LEAST_SHARE * fine.abs()))
        }));
    }
}

/// Raises uncertainties of a case that are small by chance to the median of the same quantity, relative to the
/// reference where the tolerance is.
pub fn raise_coincidences<'a>(values: impl Iterator<Item = &'a mut Comparison>) {
    let mut of_quantity: BTreeMap<(String, bool), Vec<&mut Comparison>> = BTreeMap::new();
    for value in values.filter(|value| value.numerical_uncertainty().is_some()) {
        let is_relative = value.reference.expected.relative.is_some();
        of_quantity.entry((value.quantity.clone(), is_relative)).or_default().push(value);
    }
    for values in of_quantity.values_mut() {
        let shares = values.iter().filter_map(|value| value.numerical_share()).collect();
        let Some(least) = median(shares) else { continue };
        for value in values.iter_mut() {
            let scale = match value.reference.expected.relative {
                Some(_) => value.reference.expected.value.abs(),
                None => 1.0,
            };
            let raised = value.numerical_uncertainty().map(|own| own.max(least * scale));
            value.numerical = raised.map(Ok);
        }
    }
}

/// The value in the middle, or half way between the two there.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let above = *values.get(values.len() / 2)?;
    let below = *values.get(values.len().checked_sub(1)? / 2)?;
    Some(0.5 * (below + above))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Model, Reference};
    use crate::validation::comparison::judge;

    fn case(name: &str, settings: &[&str]) -> Case {
        let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
        Case::read(name, &settings).unwrap().model.case
    }

    fn size(cells: usize, steps: usize) -> RunSize {
        let mesh = MeshSize { cells, shortest_edge: 0.1 };
        RunSize { mesh, dofs: 9 * cells, steps, cpu_seconds: 1.0 }
    }

    /// Of values f + c h^p the error of the fine one is exactly (f - g) / (r^p - 1).
    #[test]
    fn the_uncertainty_of_a_sequence_of_known_order_is_three_times_its_error() {
        for order in [1.0_f64, 2.0] {
            for (fine, coarse) in [(0.1_f64, 0.2_f64), (0.3, 0.3 * COARSER), (0.5, 0.7)] {
                let value = |length: f64| 4.0 - 7.0 * length.powf(order);
                let refinement = Refinement { ratio: coarse / fine, order };
                let own = refinement.uncertainty(value(fine), value(coarse));
                let error = (value(fine) - 4.0).abs();
                assert!((own / error - SAFETY).abs() < 1e-12, "{order} {fine} {coarse}: {own}");
            }
        }
        // Of a value that converges faster than is taken for granted it is too large, never too small
        let refinement = Refinement { ratio: 2.0, order: 2.0 };
        let value = |length: f64| length.powi(4);
        assert!(refinement.uncertainty(value(0.1), value(0.2)) > SAFETY * value(0.1));
    }

    #[test]
    fn the_ratio_is_that_of_cells_or_of_steps_whichever_is_less() {
        let steady = case("dfg-2d-1", &[]);
        let of = |fine, coarse| Refinement::between(&steady, fine, coarse);
        assert_eq!(of(size(400, 0), size(100, 0)).unwrap(), Refinement { ratio: 2.0, order: 2.0 });
        let reported = of(size(110, 0), size(100, 0)).unwrap_err();
        assert_eq!(reported, "its cells are only 1.05 times as long");
        let unsteady = case("dfg-2d-2", &[]);
        let of = |fine, coarse| Refinement::between(&unsteady, fine, coarse);
        assert_eq!(of(size(400, 90), size(100, 60)).unwrap().ratio, 1.5);
        assert_eq!(of(size(144, 90), size(100, 30)).unwrap().ratio, 1.2);
        let reported = of(size(400, 90), size(100, 90)).unwrap_err();
        assert_eq!(reported, "its steps are only 1.00 times as long");
        let euler = case("dfg-2d-2", &["time.unsteady.scheme=\"bdf1\""]);
        let of_euler = Refinement::between(&euler, size(400, 80), size(100, 40));
        assert_eq!(of_euler.unwrap(), Refinement { ratio: 2.0, order: 1.0 });
        let in_space = case("dfg-3d-1z", &[]);
        let of_space = Refinement::between(&in_space, size(8000, 0), size(1000, 0)).unwrap();
        assert!((of_space.ratio - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_companion_has_whole_steps_to_the_same_end() {
        let fine = case("dfg-2d-2", &["mesh.scale=2"]);
        let settings = coarser_settings(&fine);
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let coarse = case("dfg-2d-2", &settings);
        assert!((coarse.mesh.scale - 2.0 * COARSER).abs() < 1e-12);
        let (TimeSettings::Unsteady(was), TimeSettings::Unsteady(is)) = (&fine.time, &coarse.time)
        else {
            panic!("both are unsteady")
        };
        let steps = is.end / is.step;
        assert!((steps - steps.round()).abs() < 1e-9 && is.end == was.end, "{steps}");
        assert!((is.step / was.step / COARSER - 1.0).abs() < 1e-3, "{}", is.step);
        // Nothing else is another one
        let mut same = coarse.clone();
        same.mesh.scale = fine.mesh.scale;
        same.time = fine.time.clone();
        assert!(Model::new(same).unwrap().case == fine);
    }

    #[test]
    fn values_that_agree_by_chance_keep_an_uncertainty() {
        let reference: Reference = case("dfg-2d-1", &[]).reference.remove(0);
        let value = |computed: f64| judge("c", &reference, Ok(computed), 1, 0.0);
        let refinement = Ok(Refinement { ratio: 2.0, order: 1.0 });
        let of = |fine: f64, coarse: f64| {
            let mut values = [value(fine)];
            set_uncertainties(&mut values, &[value(coarse)], &refinement);
            values[0].clone()
        };
        let reported = |value: &Comparison| value.numerical_uncertainty().unwrap();
        assert!((reported(&of(5.5, 5.5)) / (LEAST_SHARE * 5.5) - 1.0).abs() < 1e-12);
        let mut values = [of(5.5, 5.5), of(5.5, 5.4), of(5.5, 5.3)];
        raise_coincidences(values.iter_mut());
        let raised = values.each_ref().map(reported);
        assert!((raised[0] - 0.3).abs() < 1e-9 && (raised[1] - 0.3).abs() < 1e-9, "{raised:?}");
        assert!((raised[2] - 0.6).abs() < 1e-9, "{raised:?}");
        // What is not known stays so, and other quantities are not asked
        let mut other = of(5.5, 5.5);
        other.quantity = "cylinder.force.y".to_owned();
        let mut values = [value(5.5), other, of(5.5, 5.4)];
        raise_coincidences(values.iter_mut());
        assert_eq!(values[0].numerical, None);
        assert!(reported(&values[1]) < 2e-4, "{:?}", values[1].numerical);
        assert_eq!(median(vec![]), None);
    }

    #[test]
    fn a_mesh_file_has_no_companion() {
        assert!(no_companion(&case("sphere-in-oblique-tube-3d", &[])).is_some());
        assert!(no_companion(&case("vessel", &[])).is_some());
        assert!(no_companion(&case("sphere-in-tube-3d", &[])).is_none());
    }

    #[test]
    fn a_value_without_a_companion_says_why() {
        let reference: Reference = case("dfg-2d-1", &[]).reference.remove(0);
        let value = |computed| judge("c", &reference, computed, 1, 0.0);
        let reported = |values: &[Comparison]| values[0].numerical.clone();
        let mut values = [value(Ok(5.5))];
        let refinement = Ok(Refinement { ratio: 2.0, order: 1.0 });
        set_uncertainties(&mut values, &[value(Ok(5.4))], &refinement);
        assert!((reported(&values).unwrap().unwrap() - 0.3).abs() < 1e-12);
        set_uncertainties(&mut values, &[value(Err("no period".to_owned()))], &refinement);
        assert_eq!(reported(&values), Some(Err("no period".to_owned())));
        set_uncertainties(&mut values, &[], &Err("no mesh".to_owned()));
        assert_eq!(reported(&values), Some(Err("no mesh".to_owned())));
    }
}

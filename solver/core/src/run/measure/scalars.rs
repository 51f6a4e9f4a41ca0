//! The quantities of scalars: amounts, what comes through bodies and sides, values at probes.

use alewife_mesh::{BoundaryKind, Mesh};

use super::probes::Probes;
use super::value::Value;
use crate::case::{ScalarQuantity, ScalarSurface, ScalarSurfaceQuantity};
use crate::run::build::Scalars;
use crate::scalar::{Amount, Scalar, ScalarField, amount};
use crate::space::{FacetRule, Tables};
use crate::state::State;

/// What is measured of a scalar.
pub(super) struct ScalarMeasurement {
    amount: Amount,
    /// What is made in the fluid (m3/s; m2/s planar).
    source: f64,
    /// What there would be of it with nothing missing in its balance (m3; m2 planar).
    expected: f64,
    probes: Vec<f64>,
    /// What comes through each boundary.
    fluxes: Vec<f64>,
    /// The flux of each boundary for which its Sherwood number is 1; none without a difference.
    unit_fluxes: Option<Vec<f64>>,
}

impl ScalarMeasurement {
    fn new<const D: usize>(
        scalar: &Scalar<D>,
        field: &ScalarField,
        mesh: &Mesh<D>,
        tables: &Tables<D>,
        probes: Vec<f64>,
    ) -> Self {
        let unit_fluxes = scalar.scale.map(|[difference, length]| {
            let areas = areas(mesh, tables);
            areas.iter().map(|area| scalar.diffusivity * difference * area / length).collect()
        });
        Self {
            amount: amount(mesh, tables, &field.now),
            source: field.source,
            expected: field.initial + field.added,
            probes,
            fluxes: field.fluxes.clone(),
            unit_fluxes,
        }
    }

    pub(super) fn value(&self, quantity: ScalarQuantity) -> Value {
        let Amount { total, volume, minimum, maximum } = self.amount;
        match quantity {
            ScalarQuantity::Total => total.into(),
            ScalarQuantity::Mean => (total / volume).into(),
            ScalarQuantity::Minimum => minimum.into(),
            ScalarQuantity::Maximum => maximum.into(),
            ScalarQuantity::Source => self.source.into(),
            ScalarQuantity::Defect => (total - self.expected).into(),
        }
    }

    /// Of a surface, if the mesh has it as a boundary.
    pub(super) fn of_surface(
        &self,
        boundary: Option<usize>,
        quantity: ScalarSurfaceQuantity,
    ) -> Value {
        let flux = boundary.map_or(0.0, |boundary| self.fluxes[boundary]);
        match quantity {
            ScalarSurfaceQuantity::Flux => flux.into(),
            ScalarSurfaceQuantity::Sherwood => {
                let unit = self.unit_fluxes.as_ref().zip(boundary);
                unit.map_or(f64::NAN, |(units, boundary)| flux / units[boundary]).into()
            }
        }
    }

    pub(super) fn at_probe(&self, probe: usize) -> Value {
        self.probes[probe].into()
    }
}

/// All scalars of a state.
pub(super) fn measure_scalars<const D: usize>(
    scalars: Option<&Scalars<D>>,
    state: &State<D>,
    probes: &Probes<D>,
) -> Vec<ScalarMeasurement> {
    let Some(scalars) = scalars else { return Vec::new() };
    let tables = Tables::new(scalars.metric());
    let pairs = scalars.given().iter().zip(&state.scalars);
    pairs
        .map(|(scalar, field)| {
            let at_probes = probes.of_scalar(state, &field.now);
            ScalarMeasurement::new(scalar, field, &state.mesh, &tables, at_probes)
        })
        .collect()
}

/// The boundary of a mesh that a surface is, by the names of the sides of its case.
pub(super) fn boundary_of<const D: usize>(
    mesh: &Mesh<D>,
    surface: ScalarSurface,
    sides: &[String],
) -> Option<usize> {
    mesh.boundaries.iter().position(|boundary| match (surface, boundary.kind) {
        (ScalarSurface::Body(wanted), BoundaryKind::Body(body)) => wanted == body,
        (ScalarSurface::Side(wanted), BoundaryKind::Side) => {
            sides.get(wanted).is_some_and(|side| *side == boundary.name)
        }
        _ => false,
    })
}

/// The area of each boundary (m2; m planar).
fn areas<const D: usize>(mesh: &Mesh<D>, tables: &Tables<D>) -> Vec<f64> {
    let rule = FacetRule::new(tables.metric());
    let mut areas = vec![0.0; mesh.boundaries.len()];
    for facet in &mesh.facets {
        let area = &mut areas[facet.boundary.index()];
        rule.for_each_point(mesh, facet, |at| *area += at.normal_ds.norm());
    }
    areas
}

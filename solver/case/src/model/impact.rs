//! How hard bodies meet: the energy of a fall from where they start, and the gap at which contact stores it.

use std::f64::consts::PI;

use super::derived_number::DerivedNumber;
use super::speed::{load_in_space, norm, terminal_speed};
use crate::{Body, Case, ContactSpec, FlowModel, Geometry, Model, Motion};

/// Mean free path of a body over its radius below which fluid stops it before a wall: a Stokes number of nine is
/// where rebounds begin.
const LEAST_STOKES_NUMBER: f64 = 9.0;

/// An impact that can be expected.
#[derive(Debug, Clone, PartialEq)]
pub struct Impact {
    /// Name of the body.
    pub body: String,
    /// Speed (m/s).
    pub speed: f64,
    /// Kinetic energy of the body and the fluid it displaces (J; J/m planar).
    pub energy: f64,
    /// Its mass times speed over 6 pi viscosity radius^2 (in the plane that of a sphere of this radius).
    pub stokes_number: f64,
}

impl Model {
    /// The hardest impact of a body that falls or is pulled from where it starts to the end of the domain; none where
    /// the fluid stops all bodies before.
    #[must_use]
    pub fn hardest_impact(&self) -> Option<Impact> {
        let case = &self.case;
        if case.fluid.model == FlowModel::Stokes {
            return None;
        }
        let free = self.bodies.iter().filter(|body| body.motion == Motion::Free);
        let impacts = free.filter_map(|body| impact(case, body));
        impacts
            .filter(|impact| impact.stokes_number > LEAST_STOKES_NUMBER)
            .max_by(|one, other| one.energy.total_cmp(&other.energy))
    }
}

/// The impact of a body that falls along its load.
fn impact(case: &Case, body: &Body) -> Option<Impact> {
    let load = load_in_space(case, body);
    let size = norm(&load);
    let volume = body.shape.volume_in(case.geometry);
    let mass = body.mass_in(case);
    let displaced = case.fluid.density * volume;
    if !(size > 0.0 && mass > 0.0) {
        return None;
    }
    let height = way_to_end(case, body, &load.map(|part| part / size));
    let speed = (2.0 * size / (mass + displaced) * height).sqrt().min(terminal_speed(case, body));
    let radius = body.shape.reach();
    let sphere = match case.geometry {
        Geometry::Planar => mass * 4.0 / 3.0 * radius,
        Geometry::Axisymmetric | Geometry::Spatial => mass,
    };
    Some(Impact {
        body: body.name.clone(),
        speed,
        energy: 0.5 * (mass + displaced) * speed * speed,
        stokes_number: sphere * speed / (6.0 * PI * case.reference_viscosity() * radius * radius),
    })
}

/// How far a body gets along a direction before it meets the end of the domain (m); infinite where that repeats.
fn way_to_end(case: &Case, body: &Body, direction: &[f64; 3]) -> f64 {
    let (extent, periodic) = (case.extent(), case.periodic_axes());
    let reach = body.shape.half_width();
    let along = |axis: usize| {
        let slope = direction[axis];
        if slope == 0.0 || periodic[axis] {
            return f64::INFINITY;
        }
        let at = body.center.get(axis).copied().unwrap_or(0.0);
        let end = if slope > 0.0 { extent.max[axis] - reach } else { extent.min[axis] + reach };
        ((end - at) / slope).max(0.0)
    };
    (0..3).map(along).fold(f64::INFINITY, f64::min)
}

/// The hardest impact that can be expected, and what contact leaves of the gap then.
pub fn numbers_of_impact(model: &Model) -> Vec<DerivedNumber> {
    let (Some(contact), Some(impact)) = (&model.case.contact, model.hardest_impact()) else {
        return Vec::new();
    };
    let range = contact.range();
    let (name, value, formula) = match contact {
        ContactSpec::Barrier { .. } => (
            "contact: stiffness for half the range at impact",
            impact.energy / (0.25 * range * range * 2f64.ln()),
            "energy of the impact / (range^2 ln(2) / 4)",
        ),
        ContactSpec::Quadratic { .. } => (
            "contact: epsilon for half the range at impact",
            range.powi(3) / (24.0 * impact.energy),
            "range^3 / (24 energy of the impact)",
        ),
    };
    let of =
        format!("of \"{}\", by its fall from where it starts or its terminal speed", impact.body);
    let number = |name: &str, value: f64, formula: &str| DerivedNumber {
        name: name.to_owned(),
        value,
        formula: formula.to_owned(),
    };
    vec![
        number("contact: speed of impact", impact.speed, &of),
        number(
            "contact: Stokes number of impact",
            impact.stokes_number,
            "mass speed / (6 pi viscosity radius^2); no rebound below about 10",
        ),
        number(name, value, formula),
        number(
            "contact: least gap at impact",
            contact.gap_of_energy(impact.energy),
            "where the law has stored the energy of the impact",
        ),
    ]
}

#[cfg(test)]
mod tests {
    use crate::Case;

    const CASE: &str = "
title = 'A heavy disc'
geometry = 'planar'
fluid = { model = 'navier-stokes', viscosity = 1e-3, density = 1.0, gravity = [0.0, -1.0] }
domain = { box = { min = [-3.0, 0.0], max = [3.0, 6.0] } }
mesh = { size = 0.6 }
time.unsteady = { step = 0.02, end = 3.0 }
contact.barrier = { range = 0.08, stiffness = 1e4 }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
[[body]]
name = 'disc'
shape.disc = { radius = 0.5 }
center = [0.0, 1.5]
density = 100.0
motion = 'free'
";

    /// It falls by 1.0, and 1e4 0.08^2 ln(0.08 / gap) (1 - gap / 0.08)^2 is that energy.
    #[test]
    fn a_fall_gives_the_speed_and_the_gap() {
        let model = Case::parse("t.toml", CASE, &[]).unwrap().model;
        let impact = model.hardest_impact().unwrap();
        assert!((impact.speed - (2.0f64 * 99.0 / 101.0).sqrt()).abs() < 1e-12, "{impact:?}");
        assert!((impact.energy - 99.0 * 0.25 * std::f64::consts::PI).abs() < 1e-9);
        let contact = model.case.contact.unwrap();
        let gap = contact.gap_of_energy(impact.energy);
        assert!((contact.energy(gap) / impact.energy - 1.0).abs() < 1e-9, "{gap}");
        assert!((0.01..0.02).contains(&gap), "{gap}");
    }

    #[test]
    fn what_the_fluid_stops_does_not_meet_anything() {
        for setting in ["fluid.viscosity=100.0", "fluid.model='stokes'", "body.0.density=1.0"] {
            let model = Case::parse("t.toml", CASE, &[setting.to_owned()]).unwrap().model;
            assert_eq!(model.hardest_impact(), None, "{setting}");
        }
    }
}

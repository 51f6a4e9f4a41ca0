//! How a body of a case may move: whether it translates, turns or deforms, and its mass.

use super::by_axis::Settled;
use crate::{Body, Case, GaitSpec, Geometry, Lock, Motion, ShapeSpec};

impl Body {
    /// Whether the body may translate.
    #[must_use]
    pub fn translates(&self, geometry: Geometry) -> bool {
        let is_translation = |motion: &&Lock| **motion != Lock::Rotation;
        let mut translations = geometry.motions().iter().filter(is_translation);
        match &self.motion {
            Motion::Held => false,
            Motion::Free => {
                let is_driven = self.driven.iter().any(|driven| driven.motion != Lock::Rotation);
                is_driven || translations.any(|motion| !self.locked.contains(motion))
            }
            Motion::ByAxis(_) => true,
            Motion::Imposed(imposed) => imposed.velocity.iter().any(|part| *part != 0.0),
        }
    }

    /// Whether the body may turn.
    #[must_use]
    pub fn turns(&self) -> bool {
        match &self.motion {
            Motion::Held => false,
            Motion::Free => !self.locked.contains(&Lock::Rotation) || self.drives(Lock::Rotation),
            Motion::ByAxis(_) => true,
            Motion::Imposed(imposed) => !imposed.angular_velocity.is_zero(),
        }
    }

    /// Has motions by axis be those of a free body that are locked, or locked and driven.
    pub(crate) fn settle_motion(&mut self) {
        let Motion::ByAxis(motions) = &self.motion else { return };
        let Settled { moves, locked, driven } = motions.settled();
        self.motion = if moves { Motion::Free } else { Motion::Held };
        self.locked = if moves { locked } else { Vec::new() };
        self.driven = driven;
    }

    /// Whether the rate of a motion is given while others may be free.
    #[must_use]
    pub fn drives(&self, motion: Lock) -> bool {
        self.driven.iter().any(|driven| driven.motion == motion)
    }

    /// Whether its outline changes in time.
    #[must_use]
    pub fn deforms(&self) -> bool {
        if self.rod.is_some() {
            return true;
        }
        match self.gait {
            None | Some(GaitSpec::Squirmer(_) | GaitSpec::Slip(_)) => false,
            Some(
                GaitSpec::Carangiform(_)
                | GaitSpec::Anguilliform(_)
                | GaitSpec::Flagellum(_)
                | GaitSpec::Midline(_)
                | GaitSpec::Pulsating(_)
                | GaitSpec::Joints(_),
            ) => true,
        }
    }

    /// Whether the body looks the same however it turns about its centre of mass.
    #[must_use]
    pub fn is_round(&self) -> bool {
        let is_centred = self.center_of_mass.iter().all(|part| *part == 0.0);
        is_centred && matches!(self.shape, ShapeSpec::Disc { .. } | ShapeSpec::Sphere { .. })
    }

    /// Its mass (kg; kg/m planar) in a case, by the volume of its shape (m3; m2 planar) where none is given.
    pub(crate) fn mass_in(&self, case: &Case) -> f64 {
        let density = self.density.unwrap_or(case.fluid.density);
        self.mass.unwrap_or_else(|| density * self.shape.volume_in(case.geometry))
    }
}

#[cfg(test)]
mod tests {
    use crate::Case;

    #[test]
    fn a_body_on_the_axis_locked_along_it_stays() {
        let text = "
title = 't'
geometry = 'axisymmetric'
fluid = { model = 'stokes', viscosity = 1.0 }
domain = { half-disc = { radius = 4.0 } }
mesh = { size = 0.2 }
time = { unsteady = { step = 0.1, end = 1.0 } }
body = [{ name = 'b', shape = { sphere = { radius = 1.0 } }, center = [0, 0], motion = 'free' }]
";
        let moves = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
            let model = Case::parse("t.toml", text, &settings).unwrap().model;
            let is_carried = model.case.frame.is_some();
            assert_eq!(
                model.mesh_moves(),
                model.bodies[0].translates(model.case.geometry) && !is_carried
            );
            model.mesh_moves()
        };
        assert!(moves(&[]));
        assert!(moves(&["body.0.locked=['y']"]));
        assert!(!moves(&["body.0.locked=['x']"]));
        assert!(!moves(&["frame=b"]));
    }
}

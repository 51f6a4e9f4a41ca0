//! How contact and the film of fluid together bring a body to rest.

use std::f64::consts::{LN_2, PI, SQRT_2};

use super::{Body, ContactSpec, Geometry, Model};

impl Model {
    /// The rate at which a body in contact swings over the rate at which the film damps that, with half
    /// the range as gap, of the body for which it is largest (1): below one nothing bounces.
    #[must_use]
    pub fn bouncing(&self) -> f64 {
        let Some(contact) = self.case.contact else { return 0.0 };
        let (ContactSpec::Barrier { range, .. } | ContactSpec::Quadratic { range, .. }) = contact;
        let gap = 0.5 * range;
        // Minus the derivatives of both laws by the gap
        let stiffness = match contact {
            ContactSpec::Barrier { stiffness, .. } => stiffness * (5.0 + 2.0 * LN_2),
            ContactSpec::Quadratic { epsilon, .. } => range / epsilon,
        };
        let of_body = |body: &Body| {
            let mass = body.density.unwrap_or(self.case.fluid.density)
                * body.shape.volume_in(self.case.geometry);
            let reach = body.shape.reach();
            // Leading terms of Jeffrey and Onishi 1981 for a disc, of Brenner 1961 for a sphere
            let resistance = self.case.fluid.viscosity
                * match self.case.geometry {
                    Geometry::Planar => 3.0 * SQRT_2 * PI * (reach / gap).powf(1.5),
                    Geometry::Axisymmetric | Geometry::Spatial => 6.0 * PI * reach * reach / gap,
                };
            2.0 * (stiffness * mass).sqrt() / resistance
        };
        self.bodies.iter().map(of_body).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use crate::Case;

    #[test]
    fn a_heavy_body_bounces_and_a_light_one_does_not() {
        let bouncing = |name: &str| Case::read(name, &[]).unwrap().model.bouncing();
        assert!(bouncing("disc-on-wall/heavy") > 1.5);
        assert!(bouncing("disc-on-wall/barrier") < 0.5);
        assert_eq!(bouncing("disc-sinking-to-wall/adaptive-steps"), 0.0);
    }
}

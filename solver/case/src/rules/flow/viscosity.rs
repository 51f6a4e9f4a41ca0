//! Problems of a viscosity that depends on the rate of shear.

use crate::rules::Findings;
use crate::{Plateaus, Scheme, ShearLaw, TimeSettings};

/// Index up to which a viscosity at extrapolated rates of shear is stable without inertia: a small change of the rate g of a
/// power law under a given stress obeys g'' = (1 - index) (2 g' - g) from step to step.
const THICKENING: f64 = 4.0 / 3.0;

pub fn check(findings: &mut Findings<'_>) {
    let Some(law) = findings.case().fluid.viscosity.law() else { return };
    if let ShearLaw::Carreau(plateaus) | ShearLaw::Cross(plateaus) = law {
        check_plateaus(findings, law.name(), plateaus);
    }
    if let ShearLaw::Cross(plateaus) = law
        && plateaus.index >= 1.0
    {
        findings.error(
            "fluid.viscosity.cross.index",
            format!(
                "the law `cross` thins the fluid with an index below 1 only, not {}",
                plateaus.index
            ),
            "write an index between 0 and 1, or take `carreau`",
        );
    }
    if findings.case().contact.is_some() && law.index() > THICKENING {
        let key = format!("fluid.viscosity.{}.index", law.name());
        findings.error(
            &key,
            format!(
                "`{key}` is {}, but with [contact] the viscosity is that of extrapolated rates of shear, which is stable up to \
                 an index of 4/3 only",
                law.index()
            ),
            "write a smaller index, or leave [contact] out",
        );
    }
    let is_explicit = matches!(&findings.case().time, TimeSettings::Unsteady(unsteady)
        if unsteady.scheme == Scheme::Rk3);
    if is_explicit && findings.case().contact.is_some() {
        findings.error(
            "time.unsteady.scheme",
            "the scheme `rk3` cannot be used: contact is added to a flow that depends linearly on its loads, \
             which it does not where the viscosity depends on the rate of shear"
                .to_owned(),
            "leave `scheme` out for `bdf2`, or leave [contact] out",
        );
    }
}

/// The viscosity at small rates is the larger one.
fn check_plateaus(findings: &mut Findings<'_>, name: &str, plateaus: &Plateaus) {
    let Plateaus { zero, infinite, .. } = *plateaus;
    if infinite > zero && zero > 0.0 {
        let key = format!("fluid.viscosity.{name}.infinite");
        findings.error(
            &key,
            format!(
                "`{key}` is {infinite}, but must not be above the viscosity at small rates, zero = {zero}"
            ),
            "exchange them, or write a smaller `infinite`; a fluid that shear thickens has an index above 1",
        );
    }
}

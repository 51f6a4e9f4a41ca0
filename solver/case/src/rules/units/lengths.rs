//! Surfaces from files whose lengths are in another unit than those of the case.

use crate::model::numbers::significant;
use crate::rules::Findings;
use crate::{CaseFile, DomainSpec, ShapeSpec};

/// Size of a body over that of the domain from which on its unit of length is asked for: bodies fit into their
/// domain, and units of length are a thousand apart.
const LARGER: f64 = 10.0;

/// The same of the domain over the body: a thousand times as large, the body would fit, too.
const SMALLER: f64 = 1000.0;

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    let lengths = file.case().extent().lengths();
    let domain = lengths.iter().copied().filter(|length| length.is_finite()).fold(0.0, f64::max);
    // As large as one cell: it would be meshed all the same
    if let DomainSpec::Surface(region) = &file.case().domain
        && domain > 0.0
        && domain <= file.case().mesh.size
    {
        findings.warning(
            "domain.surface",
            format!(
                "the surface of the domain is {} across, and mesh.size is {}",
                significant(domain),
                significant(file.case().mesh.size)
            ),
            &format!(
                "where lengths of the file are in another unit than the case, such as m in a case in mm, write \
                 scale = {:?}",
                region.scale * 1e3
            ),
        );
    }
    for (index, body) in file.case().body.iter().enumerate() {
        let ShapeSpec::Surface(surface) = &body.shape else { continue };
        let size = 2.0 * body.shape.reach();
        if !(size > 0.0 && size.is_finite() && domain > 0.0) {
            continue;
        }
        let factor = if size >= LARGER * domain {
            1e-3
        } else if size * SMALLER <= domain {
            1e3
        } else {
            continue;
        };
        findings.warning(
            &format!("body.{index}.shape.surface"),
            format!(
                "the surface of \"{}\" is about {} across, and the domain {}",
                body.name,
                significant(size),
                significant(domain)
            ),
            &format!(
                "where lengths of the file are in another unit than the case, such as mm, write scale = {:?}",
                surface.scale * factor
            ),
        );
    }
}

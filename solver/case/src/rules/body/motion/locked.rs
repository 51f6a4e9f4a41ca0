//! Problems of `body.locked`: motions that no body makes in the geometry of a case.

use crate::rules::Findings;
use crate::{Body, Geometry};

/// Checks what is written of a body; what motions by axis amount to is checked where they are written.
pub fn check(findings: &mut Findings<'_>, index: usize, body: &Body) {
    let case = findings.case();
    let Some(written) = case.body.get(index) else { return };
    let geometry = case.geometry;
    for (nth, lock) in written.locked.iter().enumerate() {
        if geometry.motions().contains(lock) {
            continue;
        }
        let (place, accepted) = match geometry {
            Geometry::Planar => ("in the plane", "accepted: x, y, rotation"),
            Geometry::Axisymmetric => ("on the axis", "accepted: x; a body stays on the axis"),
            Geometry::Spatial => ("in space", "accepted: x, y, z, rotation"),
        };
        let name = &body.name;
        let help = format!("leave \"{}\" out; {accepted}", lock.name());
        findings.error(
            &format!("body.{index}.locked.{nth}"),
            format!(
                "\"{name}\" makes no motion \"{}\" {place}, so that none is locked",
                lock.name()
            ),
            &help,
        );
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    #[test]
    fn motions_of_other_geometries_cannot_be_locked() {
        for (case, locked, wrong) in [
            ("squirmer-pair", "'x', 'rotation'", None),
            ("squirmer-pair", "'x', 'z'", Some("body.0.locked.1")),
            ("sphere-free-fall", "'x'", None),
            ("sphere-free-fall", "'y'", Some("body.0.locked.0")),
            ("sphere-free-fall", "'rotation'", Some("body.0.locked.0")),
            ("magnetic-sphere-3d", "'x', 'y', 'z', 'rotation'", None),
        ] {
            let settings = ["body.0.locked=[".to_owned() + locked + "]"];
            let file = Case::read(case, &settings).unwrap();
            let found = check(&file);
            let mut own = found.iter().filter(|one| one.key.starts_with("body.0.locked."));
            let one = own.next();
            assert_eq!(one.map(|one| one.key.as_str()), wrong, "{case}: {locked}");
            assert!(one.is_none_or(|one| one.help.contains("accepted: x")), "{one:?}");
            assert!(own.next().is_none());
        }
    }
}

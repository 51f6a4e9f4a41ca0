//! Bodies that are cut by a plane of symmetry: they must not move out of it.

use alewife_mesh::spatial::{Domain, cutting_planes};

use crate::rules::Findings;
use crate::{Body, Motion};

/// What can be done about it.
const REMEDY: &str = "take the whole body and no plane of symmetry, or let the body be held or move within the plane";

pub fn check(findings: &mut Findings<'_>, domain: &Domain) {
    let model = findings.model();
    for (index, body) in model.bodies.iter().enumerate() {
        let Some(solid) = body.solid(model.case.mesh.scale) else { continue };
        for side in cutting_planes(domain, &solid).unwrap_or_default() {
            check_motion(
                findings,
                &format!("body.{index}.motion"),
                body,
                domain.sides()[side],
                side / 2,
            );
        }
    }
}

/// A body that a side cuts, which is normal to an axis.
///
/// A free one is not known from its part: the fluid acts on that part alone, and what the plane does not let happen
/// is not told to Newton's law.
fn check_motion(findings: &mut Findings<'_>, key: &str, body: &Body, side: &str, axis: usize) {
    let name = &body.name;
    match &body.motion {
        Motion::Held => {}
        Motion::Free | Motion::ByAxis(_) => findings.error(
            key,
            format!("\"{name}\" is free, and the plane of symmetry `{side}` cuts it"),
            REMEDY,
        ),
        Motion::Imposed(imposed) => {
            let turns = imposed.angular_velocity.0;
            let leaves = imposed.velocity.get(axis).is_some_and(|part| *part != 0.0)
                || (0..3).any(|about| about != axis && turns[about] != 0.0);
            if leaves {
                findings.error(
                    key,
                    format!(
                        "\"{name}\" moves out of the plane of symmetry `{side}`, which cuts it"
                    ),
                    REMEDY,
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    /// Messages about a sphere, half of which is in a box, with a motion.
    fn said_of(motion: &str) -> Vec<String> {
        let text = format!(
            "title = 't'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4.0, 0.0, -4.0], max = [4.0, 4.0, 4.0] }}
mesh = {{ size = 0.3 }}
time = {{ steady = {{}} }}
boundary = {{ left = 'no-slip', right = 'no-slip', bottom = 'symmetry', top = 'no-slip', back = 'no-slip', front = 'no-slip' }}
body = [{{ name = 'b', shape = {{ sphere = {{ radius = 1.0 }} }}, center = [0.0, 0.0, 0.0], motion = {motion} }}]
"
        );
        let file = Case::parse("t.toml", &text, &[]).unwrap();
        check(&file).into_iter().map(|found| found.message).collect()
    }

    #[test]
    fn a_body_that_is_cut_stays_in_the_plane() {
        for motion in [
            "'held'",
            "{ imposed = { velocity = [1.0, 0.0, 2.0] } }",
            "{ imposed = { angular_velocity = [0.0, 1.0, 0.0] } }",
        ] {
            assert_eq!(said_of(motion), Vec::<String>::new());
        }
        for motion in [
            "'free'",
            "{ imposed = { velocity = [1.0, 1.0, 0.0] } }",
            "{ imposed = { angular_velocity = [1.0, 0.0, 0.0] } }",
        ] {
            let said = said_of(motion);
            assert!(said.len() == 1 && said[0].contains("`bottom`"), "{motion}: {said:?}");
        }
    }
}

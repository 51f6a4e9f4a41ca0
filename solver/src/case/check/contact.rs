//! Problems of `[contact]`: numbers that make no law.

use super::Findings;
use crate::case::Contact;

pub fn check(findings: &mut Findings<'_>) {
    match findings.case().contact {
        None => {}
        Some(Contact::Quadratic { range, epsilon }) => {
            findings.positive("contact.quadratic.range", range);
            findings.positive("contact.quadratic.epsilon", epsilon);
        }
        Some(Contact::Barrier { range, stiffness }) => {
            findings.positive("contact.barrier.range", range);
            findings.positive("contact.barrier.stiffness", stiffness);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::case::{Case, Contact, Severity, check};

    const CASE: &str = "
title = 'A disc in a box'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain = { box = { min = [-1.0, -1.0], max = [1.0, 1.0] } }
mesh = { size = 0.2 }
time = { steady = {} }
[boundary]
left = 'no-slip'
right = 'no-slip'
bottom = 'no-slip'
top = 'no-slip'
[[body]]
name = 'disc'
shape = { disc = { radius = 0.3 } }
center = [0.0, 0.0]
motion = 'held'
";

    /// Keys and messages of the errors of a case with this contact.
    fn errors(contact: Contact) -> Vec<(String, String)> {
        let mut file = Case::parse("t.toml", CASE, &[]).unwrap();
        file.case.contact = Some(contact);
        let errors = check(&file).into_iter().filter(|p| p.severity == Severity::Error);
        errors.map(|problem| (problem.key, problem.message)).collect()
    }

    #[test]
    fn numbers_that_are_not_positive_are_refused() {
        assert_eq!(errors(Contact::Quadratic { range: 0.03, epsilon: 1e-6 }), []);
        assert_eq!(errors(Contact::Barrier { range: 0.03, stiffness: 10.0 }), []);
        let refused = |contact, key: &str, value: &str| {
            let wanted = (key.to_owned(), format!("`{key}` is {value}, but must be positive"));
            assert_eq!(errors(contact), [wanted]);
        };
        let quadratic = |range, epsilon| Contact::Quadratic { range, epsilon };
        refused(quadratic(0.0, 1e-6), "contact.quadratic.range", "0");
        refused(quadratic(0.03, -1.0), "contact.quadratic.epsilon", "-1");
        let barrier = |range, stiffness| Contact::Barrier { range, stiffness };
        refused(barrier(-0.03, 10.0), "contact.barrier.range", "-0.03");
        refused(barrier(0.03, 0.0), "contact.barrier.stiffness", "0");
    }
}

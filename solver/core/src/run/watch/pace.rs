//! `Pace`: how fast a flow is beside what drives it, and whether it has blown up.

use crate::run::Excess;

/// Energy over that of the start and the work done since from which a flow has blown up. The scheme keeps the balance as
/// an inequality, with an energy of two levels that is at least half of that of the last one; in the shipped cases with
/// inertia that `validate --quick` runs the largest was 0.998.
const TOO_MUCH_ENERGY: f64 = 2.5;

/// Root mean square of the velocity over the speed of what drives it, from which a flow has blown up: fluid in a
/// narrow passage is faster than any boundary, but not all of it.
const TOO_FAST_ON_AVERAGE: f64 = 30.0;

/// Cell Reynolds number above which cells resolve nothing of a flow: a hundred times that of the finest cells
/// above which `check` warns.
const UNRESOLVED: f64 = 1e5;

/// Largest speed over that of what drives it above which an unresolved flow has blown up: in films, where
/// fluid is faster than what drives it, cell Reynolds numbers are small.
const TOO_FAST: f64 = 30.0;

/// The same where no step succeeds.
const TOO_FAST_TO_STEP: f64 = 10.0;

/// Speed of a body over that of what drives it from which it has blown up: a body in a narrow passage, or pressed
/// out between others, is faster than what drives it.
const TOO_FAST_A_BODY: f64 = 300.0;

/// The same, over that from which the flow has blown up, below which its state is worth keeping.
const SOUND: f64 = 0.45;

/// How fast a flow is, beside what drives it, and how well its cells resolve it.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::run) struct Pace {
    /// Kinetic and elastic energy over that at the start and the work done since.
    pub energy: f64,
    /// Root mean square of the velocity over the speed of what drives it.
    pub mean_speed: f64,
    /// Largest speed of the fluid, over the same.
    pub largest_speed: f64,
    /// Largest speed of a body, over the same.
    pub body_speed: f64,
    /// Largest cell Reynolds number.
    pub cell_reynolds: f64,
}

impl Pace {
    /// By what the flow has blown up; `None` where it has not.
    pub fn excess(self) -> Option<Excess> {
        let Self { energy, mean_speed, largest_speed, body_speed, cell_reynolds } = self;
        if energy > TOO_MUCH_ENERGY {
            Some(Excess::Energy(energy))
        } else if mean_speed > TOO_FAST_ON_AVERAGE {
            Some(Excess::MeanSpeed(mean_speed))
        } else if body_speed > TOO_FAST_A_BODY {
            Some(Excess::BodySpeed(body_speed))
        } else {
            (cell_reynolds > UNRESOLVED && largest_speed > TOO_FAST)
                .then_some(Excess::LargestSpeed(largest_speed))
        }
    }

    /// Whether the flow is far from having blown up.
    pub fn is_sound(self) -> bool {
        let Self { energy, mean_speed, largest_speed, body_speed, cell_reynolds } = self;
        let is_resolved = cell_reynolds <= UNRESOLVED || largest_speed <= SOUND * TOO_FAST;
        energy <= SOUND * TOO_MUCH_ENERGY
            && mean_speed <= SOUND * TOO_FAST_ON_AVERAGE
            && body_speed <= SOUND * TOO_FAST_A_BODY
            && is_resolved
    }

    /// What is wrong with a flow in which no step succeeds; `None` where it looks sound.
    pub fn trouble(self) -> Option<String> {
        let Self { mean_speed, largest_speed, cell_reynolds, .. } = self;
        let cells = format!("cell Reynolds numbers are up to {cell_reynolds:.1e}");
        let remedy = "a finer mesh, a shorter time.unsteady.step or more viscosity";
        if mean_speed > 1.0 || (cell_reynolds > UNRESOLVED && largest_speed > TOO_FAST_TO_STEP) {
            Some(format!(
                "the flow has blown up: it is up to {largest_speed:.0} times as fast as what drives it can \
                 make it, and {cells}; start again with {remedy}"
            ))
        } else {
            (cell_reynolds > UNRESOLVED)
                .then(|| format!("{cells}, far too many for the cells: start again with {remedy}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flow_faster_than_all_that_drives_it_has_blown_up() {
        let trouble = |mean_speed, cell_reynolds, largest_speed| {
            Pace { mean_speed, cell_reynolds, largest_speed, ..Pace::default() }.trouble()
        };
        // As in a film
        assert_eq!(trouble(0.9, 300.0, 50.0), None);
        for told in [trouble(4.0, 300.0, 50.0), trouble(0.1, 2e7, 50.0)].map(Option::unwrap) {
            assert!(told.starts_with("the flow has blown up: it is up to 50 times"), "{told}");
        }
        let told = trouble(0.1, 2e7, 2.0).unwrap();
        assert!(told.starts_with("cell Reynolds numbers are up to 2.0e7, far too many"), "{told}");
    }

    #[test]
    fn each_measure_alone_ends_a_run_and_films_do_not() {
        let film = Pace { largest_speed: 200.0, cell_reynolds: 300.0, ..Pace::default() };
        assert_eq!(film.excess(), None);
        assert!(film.is_sound());
        for pace in [
            Pace { energy: 5.0, ..film },
            Pace { mean_speed: 31.0, ..film },
            Pace { body_speed: 301.0, ..film },
            Pace { cell_reynolds: 2e5, ..film },
        ] {
            let excess = pace.excess().unwrap();
            assert!(excess.times() >= 5.0 && !pace.is_sound(), "{excess}");
        }
    }
}

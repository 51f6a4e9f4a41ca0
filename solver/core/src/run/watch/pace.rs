//! `Pace`: how fast a flow is beside what drives it, and whether that is why no step succeeds.

/// Cell Reynolds number above which cells resolve nothing of a flow: a hundred times that of the finest cells
/// above which `check` warns.
const UNRESOLVED: f64 = 1e5;

/// Speed over the largest one of a boundary so far above which an unresolved flow has blown up: in films, where
/// fluid is faster than what drives it, cell Reynolds numbers are small.
const TOO_FAST: f64 = 10.0;

/// How fast a flow is, beside what drives it, and how well its cells resolve it.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::run) struct Pace {
    /// Root mean square of the velocity over the largest speed of a boundary so far.
    pub times: f64,
    /// Largest cell Reynolds number.
    pub cell_reynolds: f64,
}

impl Pace {
    /// What is wrong with a flow in which no step succeeds, with its largest speed over that of a boundary;
    /// `None` where it looks sound.
    pub fn trouble(self, fastest: f64) -> Option<String> {
        let Self { times, cell_reynolds } = self;
        let cells = format!("cell Reynolds numbers are up to {cell_reynolds:.1e}");
        let remedy = "a finer mesh, a shorter time.unsteady.step or more viscosity";
        if times > 1.0 || (cell_reynolds > UNRESOLVED && fastest > TOO_FAST) {
            Some(format!(
                "the flow has blown up: it is up to {fastest:.0} times as fast as the fastest boundary ever \
                 was, and {cells}; start again with {remedy}"
            ))
        } else {
            (cell_reynolds > UNRESOLVED)
                .then(|| format!("{cells}, far too many for the cells: start again with {remedy}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    #[test]
    fn a_flow_faster_than_all_that_drives_it_has_blown_up() {
        let trouble =
            |times, cell_reynolds, fastest| Pace { times, cell_reynolds }.trouble(fastest);
        // As in a film
        assert_eq!(trouble(0.9, 300.0, 50.0), None);
        for told in [trouble(4.0, 300.0, 50.0), trouble(0.1, 2e7, 50.0)].map(Option::unwrap) {
            assert!(told.starts_with("the flow has blown up: it is up to 50 times"), "{told}");
        }
        let told = trouble(0.1, 2e7, 2.0).unwrap();
        assert!(told.starts_with("cell Reynolds numbers are up to 2.0e7, far too many"), "{told}");
    }
}

//! Words of formulae and of other programs, and what they are called in a case.

/// A word that cases call otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Meant {
    /// What it is called here.
    pub word: &'static str,
    /// In which relation the two are; nothing to be said of words for the same.
    pub how: &'static str,
}

/// The word that is written, what is accepted instead, and how the one follows from the other.
const WORDS: [(&str, &str, &str); 77] = [
    ("frequency", "period", "the inverse of the frequency"),
    ("freq", "period", "the inverse of the frequency"),
    ("f", "period", "the inverse of the frequency"),
    ("omega", "period", "2 pi over the angular frequency"),
    ("start_phase", "phase", "a part of the period"),
    ("wavenumber", "wavelength", "2 pi over the wavenumber"),
    ("k", "wavelength", "2 pi over the wavenumber"),
    ("lambda", "wavelength", ""),
    ("dt", "step", "the time of a step"),
    ("timestep", "step", "the time of a step"),
    ("time_step", "step", "the time of a step"),
    ("t_end", "end", ""),
    ("tend", "end", ""),
    ("t_max", "end", ""),
    ("tmax", "end", ""),
    ("final_time", "end", ""),
    ("mu", "viscosity", "the dynamic viscosity"),
    ("eta", "viscosity", "the dynamic viscosity"),
    ("nu", "viscosity", "the kinematic viscosity times the density"),
    ("kinematic_viscosity", "viscosity", "the kinematic viscosity times the density"),
    ("re", "viscosity", "density, speed and length over the Reynolds number"),
    ("reynolds", "viscosity", "density, speed and length over the Reynolds number"),
    ("rho", "density", ""),
    ("g", "gravity", "a vector such as [0.0, -9.81]"),
    ("h", "size", "the length of an edge"),
    ("dx", "size", "the length of an edge"),
    ("resolution", "size", "the length of an edge"),
    ("r", "radius", ""),
    ("diameter", "radius", "half of the diameter"),
    ("d", "radius", "half of the diameter"),
    ("position", "center", ""),
    ("pos", "center", ""),
    ("location", "center", ""),
    ("centre", "center", ""),
    ("b1", "modes", "[B1, B2, ...], where beta is B2 / B1"),
    ("b2", "modes", "[B1, B2, ...], where beta is B2 / B1"),
    ("beta", "modes", "[B1, B2, ...], where beta is B2 / B1"),
    ("u", "velocity", "a vector"),
    ("stl", "surface", "{ file = \"body.stl\" }"),
    ("obj", "surface", "{ file = \"body.obj\" }"),
    ("every", "steps", "a number of steps between two of them, or `time`"),
    ("circle", "disc", ""),
    ("circle", "sphere", ""),
    ("ball", "sphere", ""),
    ("ball", "disc", ""),
    ("rectangle", "box", ""),
    ("square", "box", ""),
    ("cube", "box", ""),
    ("rod", "capsule", ""),
    ("outlet", "do-nothing", "fluid leaves undisturbed"),
    ("outflow", "do-nothing", "fluid leaves undisturbed"),
    ("open", "do-nothing", "fluid leaves undisturbed"),
    ("pressure", "do-nothing", "fluid leaves undisturbed"),
    ("inlet", "parabolic", "or `velocity`, the same everywhere"),
    ("inflow", "parabolic", "or `velocity`, the same everywhere"),
    ("dirichlet", "velocity", ""),
    ("neumann", "traction-free", ""),
    ("wall", "no-slip", ""),
    ("slip", "symmetry", "it lets fluid slide along"),
    ("free-slip", "symmetry", "it lets fluid slide along"),
    ("inlet", "left", ""),
    ("inflow", "left", ""),
    ("outlet", "right", ""),
    ("outflow", "right", ""),
    ("lower", "bottom", ""),
    ("upper", "top", ""),
    ("fixed", "held", ""),
    ("static", "held", ""),
    ("moving", "imposed", "or `free`"),
    ("prescribed", "imposed", ""),
    ("transient", "unsteady", ""),
    ("stationary", "steady", ""),
    ("2d", "planar", ""),
    ("3d", "spatial", ""),
    ("axial", "axisymmetric", ""),
    ("creeping", "stokes", ""),
    ("ns", "navier-stokes", ""),
];

/// What a word stands for among those that are accepted.
pub fn meant<S: AsRef<str>>(word: &str, accepted: &[S]) -> Option<Meant> {
    let lower = word.to_lowercase();
    let is_accepted = |word: &str| accepted.iter().any(|one| one.as_ref() == word);
    let mut words = WORDS.iter().filter(|(from, _, _)| *from == lower);
    words.find(|(_, to, _)| is_accepted(to)).map(|(_, word, how)| Meant { word, how })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lead_to_what_cases_have() {
        let schema = include_str!("../../alewife.schema.json");
        for (from, to, _) in WORDS {
            let is_side = ["left", "right", "bottom", "top"].contains(&to);
            assert!(is_side || schema.contains(&format!("\"{to}\"")), "{from} leads to {to}");
        }
    }

    #[test]
    fn what_is_accepted_decides_what_a_word_means() {
        let word = |word: &str, accepted: &[&str]| meant(word, accepted).map(|meant| meant.word);
        assert_eq!(word("Inlet", &["no-slip", "velocity", "parabolic"]), Some("parabolic"));
        assert_eq!(word("inlet", &["left", "right", "bottom", "top"]), Some("left"));
        assert_eq!(word("circle", &["disc", "sphere"]), Some("disc"));
        assert_eq!(word("circle", &["sphere", "spheroid"]), Some("sphere"));
        assert_eq!(word("B1", &["modes", "heading"]), Some("modes"));
        assert_eq!(word("dt", &["model", "viscosity"]), None);
    }
}

//! The known word nearest to a misspelt one.

/// The word of `known` that takes the fewest edits to reach, if it is near enough to be meant.
///
/// An edit inserts, removes or replaces a letter, or swaps it with its neighbour.
#[must_use]
pub fn nearest<'a, S: AsRef<str>>(word: &str, known: &'a [S]) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let edits = |candidate: &str| strsim::osa_distance(&lower, &candidate.to_lowercase());
    let (edits, candidate) = known
        .iter()
        .map(|candidate| (edits(candidate.as_ref()), candidate.as_ref()))
        .min_by_key(|(edits, _)| *edits)?;
    let length = word.chars().count().max(candidate.chars().count());
    (edits <= 1 + length / 3).then_some(candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_word_leads_to_the_known_one() {
        let known = ["viscosity", "density", "gravity"];
        assert_eq!(nearest("viscoisty", &known), Some("viscosity"));
        assert_eq!(nearest("Viscocity", &known), Some("viscosity"));
        assert_eq!(nearest("densty", &known), Some("density"));
    }

    #[test]
    fn a_word_far_from_all_is_near_none() {
        assert_eq!(nearest("visc", &["viscosity", "density"]), None);
        assert_eq!(nearest::<&str>("visc", &[]), None);
    }
}

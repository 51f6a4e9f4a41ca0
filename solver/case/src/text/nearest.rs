//! The known word nearest to a misspelt one.

/// The word of `known` that takes the fewest edits to reach, if it is near enough to be meant.
///
/// An edit inserts, removes or replaces a letter, or swaps it with its neighbour. A word that was not written to its
/// end is nearest to the shortest that begins with it.
#[must_use]
pub fn nearest<'a, S: AsRef<str>>(word: &str, known: &'a [S]) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let begins = |candidate: &&str| lower.len() > 2 && candidate.to_lowercase().starts_with(&lower);
    if let Some(longer) = known.iter().map(AsRef::as_ref).filter(begins).min_by_key(|one| one.len())
    {
        return Some(longer);
    }
    let edits = |candidate: &str| strsim::osa_distance(&lower, &candidate.to_lowercase());
    let (edits, candidate) = known
        .iter()
        .map(|candidate| (edits(candidate.as_ref()), candidate.as_ref()))
        .min_by_key(|(edits, _)| *edits)?;
    let length = word.chars().count().max(candidate.chars().count());
    (edits <= 1 + length / 3).then_some(candidate)
}

/// Most words that are offered for one that is not known.
const MOST_OFFERED: usize = 4;

/// The words of `known` near a misspelt one: the nearest one, and those that hold it or begin with
/// its first part.
#[must_use]
pub fn several_nearest<'a>(word: &str, known: &[&'a str]) -> Vec<&'a str> {
    let lower = word.to_lowercase();
    let first = lower.split('-').next().unwrap_or_default();
    let is_alike = |candidate: &&&str| {
        lower.len() > 2 && candidate.contains(&lower)
            || first.len() > 2 && candidate.split('-').any(|part| part == first)
    };
    let mut found: Vec<&str> =
        known.iter().filter(|one| nearest(word, &[**one]).is_some()).copied().collect();
    found.sort_by_key(|one| (!one.starts_with(&lower), strsim::osa_distance(&lower, one)));
    for alike in known.iter().filter(is_alike) {
        if !found.contains(alike) {
            found.push(alike);
        }
    }
    found.truncate(MOST_OFFERED);
    found
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
        let columns = ["sphere.x", "sphere.y", "sphere.angle", "sphere.drag_coefficient"];
        assert_eq!(nearest("sphere.drag", &columns), Some("sphere.drag_coefficient"));
    }

    #[test]
    fn a_few_words_are_offered_the_nearest_first() {
        let known = ["sphere-in-tube", "squirmer-alone", "squirmer-pair", "three-sphere"];
        assert_eq!(several_nearest("squirmer-par", &known)[0], "squirmer-pair");
        assert_eq!(several_nearest("squirmer", &known), ["squirmer-pair", "squirmer-alone"]);
        assert_eq!(several_nearest("sphere", &known), ["sphere-in-tube", "three-sphere"]);
        assert!(several_nearest("robot", &known).is_empty());
    }

    #[test]
    fn a_word_far_from_all_is_near_none() {
        assert_eq!(nearest("visc", &["viscosity", "density"]), None);
        assert_eq!(nearest::<&str>("visc", &[]), None);
    }
}

//! Finds the known name that a misspelled or shortened name most likely means.

/// Suffixes that denote the unit of a named quantity.
const UNITS: [&str; 7] = ["_over_t", "_mm", "_deg", "_MPa", "_kg_m2", "_kg_m3", "_N"];

/// Returns `name` without the suffix of its unit.
fn quantity(name: &str) -> &str {
    UNITS.iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name)
}

/// Returns true if `part` is a word of `name`, or a sequence of words at its end.
///
/// Words are separated by underscores.
pub fn has_part(name: &str, part: &str) -> bool {
    name.split('_').any(|word| word == part)
        || name.strip_suffix(part).is_some_and(|rest| rest.ends_with('_'))
}

/// Returns the candidate that `key` most likely abbreviates or misspells.
///
/// `None` if no candidate is similar enough.
pub fn nearest<'c>(key: &str, candidates: &[&'c str]) -> Option<&'c str> {
    // A missing unit is the most frequent mistake, so `gap` means `gap_over_t`, not `gaps`.
    if let Some(whole) = candidates.iter().find(|c| **c != key && quantity(c) == key) {
        return Some(whole);
    }
    // A word that several candidates contain, such as `force`, could mean any of them.
    if candidates.iter().filter(|c| has_part(c, key)).count() > 1 {
        return None;
    }
    // If `key` has a unit, keep only candidates with a unit: `gap_mm` means neither `gaps` nor
    // `gap_cv`.
    let (has_unit, all) = (quantity(key) != key, candidates);
    let kept: Vec<&'c str> =
        all.iter().copied().filter(|c| !has_unit || quantity(c) != *c).collect();
    if has_unit && let Some(same) = kept.iter().find(|c| quantity(c) == quantity(key)) {
        return Some(same);
    }
    let typos = |candidate: &str| strsim::damerau_levenshtein(key, candidate);
    let typed = kept.iter().min_by_key(|candidate| typos(candidate))?;
    if typos(typed) <= key.chars().count() / 3 {
        return Some(typed);
    }
    // The edit distance rejects abbreviations such as `slant`. The Jaro–Winkler similarity accepts
    // them, because it favours common prefixes.
    let similarity = |candidate: &str| strsim::jaro_winkler(key, candidate);
    let alike = kept.iter().max_by(|a, b| similarity(a).total_cmp(&similarity(b)))?;
    (similarity(alike) > 0.8).then_some(alike)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn only_similar_names_are_suggested() {
        assert_eq!(nearest("depth", &["depth_stability_force", "stable_under_depth"]), None);
        assert_eq!(nearest("gap_mm", &["gaps", "gap_cv", "bend_radius_mm"]), None);
        assert_eq!(nearest("force", &["fold_force_N", "critical_force"]), None);
    }
}

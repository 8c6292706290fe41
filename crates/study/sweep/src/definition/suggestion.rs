//! Suggests known keys in place of unknown keys.

use text::nearest;

use crate::named_values::NAME_KEYS;
use crate::parameter::{PARAMETERS, Parameter, key};

/// Section of the axes.
pub(crate) const DESIGNS: &str = "designs";

/// Section of the variables: parameters that a search or a random draw varies.
pub(crate) const VARIABLES: &str = "variables";

/// Section of the manufacturing deviations.
pub(crate) const TOLERANCE: &str = "tolerance";

/// Keys and sections at the top level, except the sections of parameters.
const TOP: [&str; 4] = ["name", "measures", VARIABLES, TOLERANCE];

/// Keys with the same meaning for puncture and bending.
const TWINS: [[&str; 2]; 1] = [[key::UNLOAD, key::UNBEND]];

/// Returns the sections, each once, in the order of the parameters.
pub(crate) fn sections() -> Vec<&'static str> {
    let mut sections: Vec<_> = PARAMETERS.iter().map(|parameter| parameter.section).collect();
    // The list of parameters is grouped by section.
    sections.dedup();
    sections
}

/// Suggests a replacement for the unknown `key` in `section` (empty for a top-level key).
pub(crate) fn for_key(section: &str, key: &str) -> String {
    let known = keys_of(section);
    if let Some(parameter) = Parameter::named(key) {
        // `key` belongs to another section. Prefer a key of this section with the same end: in
        // `[substrate]`, `thickness_mm` means `tissue_thickness_mm`.
        let end = format!("_{key}");
        let twin = TWINS.iter().find(|twins| twins.contains(&key));
        let mut known = known.iter().filter(|_| parameter.section != section);
        let own =
            known.find(|own| own.ends_with(&end) || twin.is_some_and(|twins| twins.contains(own)));
        let path = own.map_or_else(|| parameter.path(), |own| format!("{section}.{own}"));
        return format!("did you mean {path}?");
    }
    // For a key that does not end in `m`, suggest the length divided by the thickness, although
    // the name of the length in mm is more similar.
    match nearest(key, &known).map(|near| {
        let of = Parameter::named(near).filter(|_| !key.ends_with('m')).and_then(Parameter::over_t);
        of.map_or(near, |of| of.key)
    }) {
        Some(near) if section.is_empty() => format!("did you mean {near}?"),
        Some(near) => format!("did you mean {section}.{near}?"),
        None => format!("expected one of {}", known.join(", ")),
    }
}

fn keys_of(section: &str) -> Vec<&'static str> {
    if section.is_empty() {
        return TOP.into_iter().chain(sections()).collect();
    }
    let names = NAME_KEYS.iter().filter(|name| name.section == section).map(|name| name.key);
    PARAMETERS
        .iter()
        .filter(|parameter| {
            section == DESIGNS || section == VARIABLES || section == parameter.section
        })
        .map(|parameter| parameter.key)
        .chain(names)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggested_keys_are_similar() {
        assert_eq!(for_key("contact", "cc2"), "did you mean contact.c2?");
        assert_eq!(for_key("contact", "c3"), "expected one of c1, c2, friction");
        assert_eq!(for_key("designs", "slant"), "did you mean designs.slant_deg?");
        assert_eq!(for_key("designs", "gap"), "did you mean designs.gap_over_t?");
        assert_eq!(for_key("designs", "lenght"), "did you mean designs.length_over_t?");
        assert_eq!(for_key("flexure", "gap"), "did you mean flexure.gaps?");
        assert_eq!(for_key("scale", "c2"), "did you mean contact.c2?");
        let tissue = "did you mean substrate.tissue_thickness_mm?";
        assert_eq!(for_key("substrate", "thickness_mm"), tissue);
        assert_eq!(for_key("flexure", "unload"), "did you mean flexure.unbend?");
        assert_eq!(for_key("puncture", "unbend"), "did you mean puncture.unload?");
        assert_eq!(for_key("scale", "width"), "did you mean scale.width_over_t?");
        assert_eq!(for_key("scale", "width_m"), "did you mean scale.width_mm?");
        assert_eq!(for_key("", "conatct"), "did you mean contact?");
        assert_eq!(for_key("", "mesures"), "did you mean measures?");
    }

    #[test]
    fn parameter_keys_are_unique_and_sections_contiguous() {
        let mut keys: Vec<_> = PARAMETERS.iter().map(|parameter| parameter.key).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), PARAMETERS.len());
        let mut sections = sections();
        let count = sections.len();
        sections.sort_unstable();
        sections.dedup();
        assert_eq!(sections.len(), count);
    }
}

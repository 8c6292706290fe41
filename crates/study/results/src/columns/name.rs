//! Column names of the measured values to which code of tables, rankings or pages refers.

/// Coverage: fraction of the scale layer that a vertical line crosses as solid scale.
pub const COVERAGE: &str = "coverage";
/// Puncture force at the critical tilt.
pub const CRITICAL_FORCE: &str = "critical_force";
/// Depth of the deepest base corner at the critical tilt.
pub const PENETRATION: &str = "penetration";
/// Flexural compliance.
pub const COMPLIANCE: &str = "compliance";
/// Flexural compliance at rest.
pub const INITIAL_COMPLIANCE: &str = "initial_compliance";
/// Puncture force at the first fold of the surface.
pub const FOLD_FORCE: &str = "fold_force";
/// Largest puncture force at which the model is valid.
pub const SOUND_FORCE: &str = "sound_force";
/// Smallest critical force over the load positions.
pub const WEAKEST_FORCE: &str = "weakest_force";
/// Load position with the smallest critical force.
pub const WEAKEST_PLACE: &str = "weakest_place";
/// Depth of the punctured point at the critical tilt.
pub const CRITICAL_DISPLACEMENT: &str = "critical_displacement";
/// Puncture force at the first failure.
pub const FAILURE_FORCE: &str = "failure_force";
/// Puncture force at the critical tilt of the row across, which is perpendicular to the row.
pub const FORCE_ACROSS: &str = "force_across";
/// Smaller one of the critical forces along the row and across the row.
pub const FORCE_ANY_DIRECTION: &str = "force_any_direction";
/// Smallest puncture force on bodies between two radii.
pub const WORST_FORCE_BETWEEN: &str = "worst_force_between";
/// Largest pressure on the tissue.
pub const TISSUE_PRESSURE_MAX: &str = "tissue_pressure_max";
/// Pressure on the tissue at the given force of the needle.
pub const TISSUE_PRESSURE_AT_FORCE: &str = "tissue_pressure_at_force";
/// Mode of the first failure.
pub const FIRST_FAILURE: &str = "first_failure";
/// Event that ended the path of a guided needle.
pub const CRITICAL_EVENT: &str = "critical_event";
/// Depth of the punctured point at first contact of scales.
pub const FIRST_CONTACT: &str = "first_contact_displacement";
/// Tilt of the punctured scale where a guided needle first touches a corner or another scale.
pub const PASSING_TILT: &str = "passing_tilt_deg";
/// Width of the tightest gap at the critical tilt divided by its width at rest; 0 or less if
/// folded.
pub const GAP_STRETCH_MIN: &str = "gap_stretch_min";
/// Width of the widest gap at the critical tilt divided by its width at rest.
pub const GAP_STRETCH_MAX: &str = "gap_stretch_max";
/// Puncture stiffness at rest.
pub const INITIAL_STIFFNESS: &str = "initial_stiffness";
/// Largest puncture stiffness on the path.
pub const MAX_STIFFNESS: &str = "max_stiffness";
/// Puncture force divided by displacement at the critical tilt.
pub const SECANT_STIFFNESS: &str = "secant_stiffness";
/// Number of closed contacts.
pub const CONTACTS: &str = "contacts";
/// Work dissipated by friction between scales.
pub const FRICTION_WORK: &str = "friction_work";
/// Whether bending closes contacts.
pub const FLEXURE_CONTACT: &str = "flexure_contact";
/// Curvature at first contact in closed form, also if the path ends before first contact.
pub const CONTACT_CURVATURE: &str = "contact_curvature";
/// Mean curvature at first contact on the path.
pub const FIRST_CONTACT_CURVATURE: &str = "first_contact_curvature";
/// Largest strain of the membrane.
pub const MEMBRANE_STRAIN: &str = "membrane_strain_max";
/// Settings of a rerun design.
pub const SETTINGS: &str = "settings";
/// Mass of the scales per area of the skin.
pub const AREAL_MASS: &str = "areal_mass_kg_m2";

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use crate::columns::values::VALUES;

    /// Names that code also uses for other objects: parameters, charts, drawing groups or measures.
    const WORDS: [&str; 5] = ["compliance", "coverage", "gaps", "penetration", "scales"];

    /// Collects the source files of the program below `folder`.
    fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
        for path in fs::read_dir(folder).expect("folder").map(|entry| entry.expect("entry").path())
        {
            let is = |names: &[&str]| names.iter().any(|name| path.ends_with(name));
            let kind = path.extension().unwrap_or_default().to_string_lossy();
            if path.is_dir() && !is(&["tests", "benches", "examples", "target", "doc"]) {
                sources(&path, found);
            } else if ["rs", "js", "html", "py"].contains(&&*kind) && !is(&["tests.rs"]) {
                found.push(path);
            }
        }
    }

    /// Returns the code of a file without tests, comments and Python docstrings.
    fn code(path: &Path) -> String {
        let mut text = fs::read_to_string(path).expect("readable");
        if path.extension().is_some_and(|kind| kind == "py") {
            text = text.split("\"\"\"").step_by(2).collect();
        }
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        text.lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .collect::<Vec<_>>()
            .join("\n")
    }

    /// Allows one file for the column and one file for the derivative.
    ///
    /// The first is `name.rs` or `values.rs`, the second is in `mechanics`.
    #[test]
    fn the_name_of_a_value_occurs_in_at_most_two_source_files() {
        let mut paths = Vec::new();
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."), &mut paths);
        let files: Vec<_> = paths.iter().map(|path| (path, code(path))).collect();
        for value in VALUES.iter().filter(|value| !WORDS.contains(&value.name)) {
            let quoted = ['"', '\'', '`'].map(|quote| format!("{quote}{}{quote}", value.name));
            let names = |code: &str| {
                code.contains(value.name) && quoted.iter().any(|quoted| code.contains(quoted))
            };
            let holders: Vec<_> = files.iter().filter(|(_, code)| names(code)).collect();
            let holders: Vec<_> = holders.iter().map(|(path, _)| path).collect();
            assert!((1..=2).contains(&holders.len()), "{}: {holders:?}", value.name);
        }
    }
}

//! The names of the measured values that code names: tables, derivatives, rankings and pages refer to a value by its name.

/// The share of the thickness that scales fill.
pub const COVERAGE: &str = "coverage";
/// The force at the critical tilt.
pub const CRITICAL_FORCE: &str = "critical_force";
/// How deep scales have sunk at the critical tilt.
pub const PENETRATION: &str = "penetration";
/// The flexural compliance.
pub const COMPLIANCE: &str = "compliance";
/// The flexural compliance at rest.
pub const INITIAL_COMPLIANCE: &str = "initial_compliance";
/// The force at which the surface first folds over.
pub const FOLD_FORCE: &str = "fold_force";
/// The force that the model can answer for.
pub const SOUND_FORCE: &str = "sound_force";
/// The smallest force over the places of the load.
pub const WEAKEST_FORCE: &str = "weakest_force";
/// The place with that force.
pub const WEAKEST_PLACE: &str = "weakest_place";
/// The depth of the load at the critical tilt.
pub const CRITICAL_DISPLACEMENT: &str = "critical_displacement";
/// What ended the path of a guided needle.
pub const CRITICAL_EVENT: &str = "critical_event";
/// The depth at which scales first touch.
pub const FIRST_CONTACT: &str = "first_contact_displacement";
/// The tilt at which a guided needle leaves its face.
pub const PASSING_TILT: &str = "passing_tilt_deg";
/// The stretch of the tightest gap, not above 0 where the surface is folded over.
pub const GAP_STRETCH_MIN: &str = "gap_stretch_min";
/// The stretch of the widest gap.
pub const GAP_STRETCH_MAX: &str = "gap_stretch_max";
/// The stiffness at rest.
pub const INITIAL_STIFFNESS: &str = "initial_stiffness";
/// The largest stiffness on the path.
pub const MAX_STIFFNESS: &str = "max_stiffness";
/// The stiffness of the secant.
pub const SECANT_STIFFNESS: &str = "secant_stiffness";
/// Closed contacts.
pub const CONTACTS: &str = "contacts";
/// The work that friction between scales has taken.
pub const FRICTION_WORK: &str = "friction_work";
/// Whether bending brings scales into contact.
pub const FLEXURE_CONTACT: &str = "flexure_contact";
/// The curvature at which scales touch, wherever bending ends.
pub const CONTACT_CURVATURE: &str = "contact_curvature";
/// Mean curvature at which scales first touch along the path.
pub const FIRST_CONTACT_CURVATURE: &str = "first_contact_curvature";
/// The largest strain of the membrane.
pub const MEMBRANE_STRAIN: &str = "membrane_strain_max";
/// The settings of a design that was solved again.
pub const SETTINGS: &str = "settings";
/// The mass of the scales, which needs no solution.
pub const AREAL_MASS: &str = "areal_mass_kg_m2";

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use crate::columns::values::VALUES;

    /// Names that are also words for other things: parameters, charts, groups of a drawing, what a sweep measures.
    const WORDS: [&str; 5] = ["compliance", "coverage", "gaps", "penetration", "scales"];

    /// The files below `folder` that the program is made of.
    fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
        for path in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("it").path()) {
            let is = |names: &[&str]| names.iter().any(|name| path.ends_with(name));
            let kind = path.extension().unwrap_or_default().to_string_lossy();
            if path.is_dir() && !is(&["tests", "benches", "examples", "target", "doc"]) {
                sources(&path, found);
            } else if ["rs", "js", "html", "py"].contains(&&*kind) && !is(&["tests.rs"]) {
                found.push(path);
            }
        }
    }

    /// A file without tests, comments and the texts of Python's documentation.
    fn code(path: &Path) -> String {
        let mut text = fs::read_to_string(path).expect("a text");
        if path.extension().is_some_and(|kind| kind == "py") {
            text = text.split("\"\"\"").step_by(2).collect();
        }
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        let is_code = |line: &&str| !line.trim_start().starts_with("//");
        text.lines().filter(is_code).collect::<Vec<_>>().join("\n")
    }

    /// One home, and at most the place in the mechanics where a derivative gets its name.
    #[test]
    fn a_name_stands_in_two_files_at_most() {
        let mut paths = Vec::new();
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."), &mut paths);
        let files: Vec<_> = paths.iter().map(|path| (path, code(path))).collect();
        for value in VALUES.iter().filter(|value| !WORDS.contains(&value.name)) {
            let quoted = ['"', '\'', '`'].map(|quote| format!("{quote}{}{quote}", value.name));
            let names = |code: &str| quoted.iter().any(|quoted| code.contains(quoted));
            let holders: Vec<_> = files.iter().filter(|(_, code)| names(code)).collect();
            let holders: Vec<_> = holders.iter().map(|(path, _)| path).collect();
            assert!((1..=2).contains(&holders.len()), "{}: {holders:?}", value.name);
        }
    }
}

//! Parameters that say how something is measured: designs in which they differ cannot be compared.

use sweep::{PARAMETERS, Sweep};

use crate::columns::about;

/// The parameters that say how a column is measured: only designs of the same values can be compared by it.
pub fn yardsticks(column: &str) -> Vec<&'static str> {
    let Some((value, quantity)) = about(column) else { return Vec::new() };
    let measuring = PARAMETERS.iter().filter(|parameter| value.is_measured_by(parameter, quantity));
    measuring.map(|parameter| parameter.key).collect()
}

/// The parameter in which the designs of a sweep differ so that they cannot be compared by a column, if there is one.
pub fn incomparable_by(sweep: &Sweep, column: &str) -> Option<&'static str> {
    let differs =
        |parameter: &&str| sweep.grid().axis(parameter).is_some_and(|axis| axis.len() > 1);
    yardsticks(column).into_iter().find(differs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_at_different_tilts_cannot_be_compared() {
        let sweep = |designs: &str| {
            let text = format!("name = 'x'\n[designs]\ngap_over_t = [0.1, 0.2]\n{designs}");
            Sweep::parse(&text, "x.toml", &[]).unwrap()
        };
        let tilts = sweep("critical_tilt_deg = [5, 10]");
        assert_eq!(incomparable_by(&tilts, "critical_force_N"), Some("critical_tilt_deg"));
        assert_eq!(incomparable_by(&tilts, "compliance"), None);
        assert_eq!(incomparable_by(&sweep("critical_tilt_deg = [5]"), "critical_force"), None);
        let membranes = sweep("membrane_thickness_over_t = [0.1, 0.2]");
        assert_eq!(incomparable_by(&membranes, "compliance"), Some("membrane_thickness_over_t"));
        assert_eq!(incomparable_by(&membranes, "flexural_rigidity_N_mm2"), None);
    }

    /// What is measured where a path ends depends on where that is, and nothing else does.
    #[test]
    fn whatever_depends_on_the_end_of_a_puncture_is_measured_by_its_tilt() {
        let at_the_end = [
            "critical_force",
            "peak_force",
            "sound_force",
            "penetration",
            "sink",
            "contacts",
            "engaged_scales",
            "critical_displacement",
            "secant_stiffness",
            "max_stiffness",
            "peak_displacement",
            "peak_tilt_deg",
            "gap_stretch_min",
            "gap_stretch_max",
            "snaps",
            "max_stiffness_N_mm",
            "critical_force_p05_N",
            "friction_work",
        ];
        for column in at_the_end {
            let by = ["needle", "critical_tilt_deg", "needle_friction"];
            assert_eq!(yardsticks(column), by, "{column}");
        }
        for column in [
            "initial_stiffness",
            "first_contact_displacement",
            "fold_force",
            "coverage",
            "contact_curvature",
            "locking_curvature",
        ] {
            assert!(yardsticks(column).is_empty(), "{column}");
        }
        let bending = ["membrane_length_over_t", "membrane_length_mm", "max_end_rotation_deg"];
        assert_eq!(yardsticks("membrane_strain_max"), bending);
        assert_eq!(yardsticks("flexural_rigidity_N_mm2"), bending);
        assert_eq!(yardsticks("max_moment_N_mm"), bending);
        assert!(yardsticks("flexure_friction_work").contains(&bending[2]));
        let unit = ["membrane_thickness_over_t", "membrane_thickness_mm"];
        assert_eq!(yardsticks("initial_compliance"), unit);
    }
}

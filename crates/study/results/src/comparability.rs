//! Parameters that define how a value is measured, and must be equal to compare designs.

use sweep::{PARAMETERS, Sweep};

use crate::columns::about;

/// Returns the keys of the parameters that define how a column is measured.
///
/// Designs can be compared by the column only if they have the same values of these parameters.
pub fn measurement_conditions(column: &str) -> Vec<&'static str> {
    let Some((value, quantity)) = about(column) else { return Vec::new() };
    PARAMETERS
        .iter()
        .filter(|parameter| value.is_measured_by(parameter, quantity))
        .map(|parameter| parameter.key)
        .collect()
}

/// Returns an axis parameter that makes the designs of `sweep` incomparable by `column`, if any.
pub fn incomparable_by(sweep: &Sweep, column: &str) -> Option<&'static str> {
    measurement_conditions(column)
        .into_iter()
        .find(|parameter| sweep.grid().axis(parameter).is_some_and(|axis| axis.len() > 1))
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

    #[test]
    fn only_values_at_the_end_of_a_puncture_depend_on_the_critical_tilt() {
        let values_at_end = [
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
        for column in values_at_end {
            let conditions = ["needle", "critical_tilt_deg", "needle_friction"];
            assert_eq!(measurement_conditions(column), conditions, "{column}");
        }
        for column in [
            "initial_stiffness",
            "first_contact_displacement",
            "fold_force",
            "coverage",
            "contact_curvature",
            "locking_curvature",
        ] {
            assert!(measurement_conditions(column).is_empty(), "{column}");
        }
        let bending = ["membrane_length_over_t", "membrane_length_mm", "max_end_rotation_deg"];
        assert_eq!(measurement_conditions("membrane_strain_max"), bending);
        assert_eq!(measurement_conditions("flexural_rigidity_N_mm2"), bending);
        assert_eq!(measurement_conditions("max_moment_N_mm"), bending);
        assert!(measurement_conditions("flexure_friction_work").contains(&bending[2]));
        let unit = ["membrane_thickness_over_t", "membrane_thickness_mm"];
        assert_eq!(measurement_conditions("initial_compliance"), unit);
    }
}

//! Parameters that say how something is measured: designs in which they differ cannot be compared.

use sweep::Sweep;

/// A parameter that says how something is measured, and the columns that can be compared only where it is the same.
#[derive(Debug)]
pub struct Yardstick {
    /// The key of the parameter.
    pub parameter: &'static str,
    /// Beginnings of the names of the columns.
    columns: &'static [&'static str],
}

const PUNCTURE: &[&str] = &[
    "critical_force",
    "penetration",
    "critical_displacement",
    "sink",
    "secant_stiffness",
    "peak_force",
    "sound_force",
];
const BENDING: &[&str] = &["compliance", "max_moment", "flexural_rigidity", "axial_energy_share"];

/// The parameters that say how something is measured. The dimensionless compliances are those of one membrane: `C_f*`
/// counts in `1/(E_m I_m)`, which another thickness changes.
pub const YARDSTICKS: [Yardstick; 5] = [
    Yardstick { parameter: "critical_tilt_deg", columns: PUNCTURE },
    Yardstick { parameter: "needle_friction", columns: PUNCTURE },
    Yardstick {
        parameter: "membrane_thickness_over_t",
        columns: &["compliance", "initial_compliance", "max_moment"],
    },
    Yardstick { parameter: "max_end_rotation_deg", columns: BENDING },
    Yardstick { parameter: "membrane_length_over_t", columns: BENDING },
];

/// Columns in physical units end so. They can be compared whatever the membrane.
const PHYSICAL: [&str; 3] = ["_N", "_N_mm", "_N_mm2"];

/// The parameters that say how a column is measured: only designs of the same values can be compared by it.
pub fn yardsticks(column: &str) -> Vec<&'static str> {
    let measuring = YARDSTICKS.iter().filter(|yardstick| yardstick.measures(column));
    measuring.map(|yardstick| yardstick.parameter).collect()
}

/// The parameter in which the designs of a sweep differ so that they cannot be compared by a column, if there is one.
pub fn incomparable_by(sweep: &Sweep, column: &str) -> Option<&'static str> {
    let differs =
        |parameter: &&str| sweep.grid().axis(parameter).is_some_and(|axis| axis.len() > 1);
    yardsticks(column).into_iter().find(differs)
}

impl Yardstick {
    /// Whether the values of a column depend on it in a way that leaves nothing to compare.
    pub fn measures(&self, column: &str) -> bool {
        let is_physical = PHYSICAL.iter().any(|unit| column.ends_with(unit));
        let is_free = is_physical && self.parameter == "membrane_thickness_over_t";
        !is_free && self.columns.iter().any(|beginning| column.starts_with(beginning))
    }
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
}

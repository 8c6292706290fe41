//! The row of a design near a solved one, by the derivatives of its measures.

use skin::flexure::FlexureMeasures;
use skin::puncture::PunctureMeasures;
use sweep::{Measure, Parameter};

use super::design_result::DesignResult;
use super::parameter_derivative::ParameterDerivative;
use super::row::DesignRow;
use super::sample_statistics::SampleStatistics;

/// Which of the two one-sided derivatives a row is extrapolated by; away from kinks they are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlopeSide {
    /// The derivative where the parameter decreases.
    Left,
    /// The derivative where the parameter increases.
    Right,
}

impl SlopeSide {
    /// The derivative on this side.
    fn of(self, derivative: &ParameterDerivative) -> Option<f64> {
        match self {
            Self::Left => derivative.left,
            Self::Right => derivative.right,
        }
    }
}

impl DesignRow {
    /// The row of the design whose `parameter` is larger `by` so much, its measures extrapolated by their derivatives on one
    /// side: `m + by dm/dq`. A column of such rows has the derivatives of the column, whatever it makes of measures and
    /// parameters.
    ///
    /// A measure that depends on the parameter and has no derivative does not exist in the row. Counts stay. `None` if the
    /// parameter is no number.
    pub fn extrapolated(&self, parameter: &Parameter, by: f64, side: SlopeSide) -> Option<Self> {
        let case = parameter.moved(&self.case, by)?;
        let mut result = self.result.without_dependent_values(parameter);
        for derivative in &self.result.sensitivity {
            if derivative.parameter == parameter.key
                && let Some(slope) = side.of(derivative)
                && let Some(value) = result.value_mut(&derivative.measure)
            {
                *value = Some(derivative.value + by * slope);
            }
        }
        Some(Self { case, result, ..*self })
    }
}

impl DesignResult {
    /// The result without the values that depend on `parameter`.
    fn without_dependent_values(&self, parameter: &Parameter) -> Self {
        let depends = |measure: Measure| measure.sections().contains(&parameter.section);
        let mut result = Self {
            samples: SampleStatistics::default(),
            sensitivity: Vec::new(),
            settings: String::new(),
            failures: Vec::new(),
            ..self.clone()
        };
        if depends(Measure::Coverage) {
            result.coverage = None;
        }
        if depends(Measure::Puncture) {
            result.at_tilts.clear();
            if let Some(puncture) = &mut result.puncture {
                puncture.measures = counts_of(&puncture.measures);
            }
        }
        if depends(Measure::Flexure)
            && let Some(flexure) = &mut result.flexure
        {
            let contact = flexure.measures.contact;
            flexure.measures = FlexureMeasures { contact, ..FlexureMeasures::default() };
        }
        result
    }

    /// The value of the measure of that name, to be changed; `None` if no measure that has derivatives has that name, or it was not
    /// asked for.
    fn value_mut(&mut self, measure: &str) -> Option<&mut Option<f64>> {
        if measure == "coverage" {
            return Some(&mut self.coverage);
        }
        let puncture =
            self.puncture.as_mut().and_then(|p| puncture_value(&mut p.measures, measure));
        let flexure = self.flexure.as_mut().and_then(|f| flexure_value(&mut f.measures, measure));
        puncture.or(flexure)
    }
}

/// The measures of a puncture that are counts or answers, not continuous values.
fn counts_of(measures: &PunctureMeasures) -> PunctureMeasures {
    let PunctureMeasures { contacts, engaged_scales, scales, snaps, .. } = *measures;
    let PunctureMeasures { stable_under_load, stable_under_depth, .. } = *measures;
    PunctureMeasures {
        contacts,
        engaged_scales,
        scales,
        snaps,
        stable_under_load,
        stable_under_depth,
        ..PunctureMeasures::default()
    }
}

fn puncture_value<'m>(m: &'m mut PunctureMeasures, name: &str) -> Option<&'m mut Option<f64>> {
    Some(match name {
        "critical_force" => &mut m.critical_force,
        "peak_force" => &mut m.peak_force,
        "critical_displacement" => &mut m.critical_displacement,
        "penetration" => &mut m.penetration,
        "sink" => &mut m.sink,
        "first_contact_displacement" => &mut m.first_contact_displacement,
        "initial_stiffness" => &mut m.initial_stiffness,
        "max_stiffness" => &mut m.max_stiffness,
        "secant_stiffness" => &mut m.secant_stiffness,
        "peak_displacement" => &mut m.peak_displacement,
        "peak_tilt_deg" => &mut m.peak_tilt_deg,
        "gap_stretch_min" => &mut m.gap_stretch_min,
        "gap_stretch_max" => &mut m.gap_stretch_max,
        "sound_force" => &mut m.sound_force,
        _ => return None,
    })
}

fn flexure_value<'m>(m: &'m mut FlexureMeasures, name: &str) -> Option<&'m mut Option<f64>> {
    Some(match name {
        "compliance" => &mut m.compliance,
        "initial_compliance" => &mut m.initial_compliance,
        "first_contact_curvature" => &mut m.first_contact_curvature,
        "max_moment" => &mut m.max_moment,
        "axial_energy_share" => &mut m.axial_energy_share,
        "membrane_strain_max" => &mut m.membrane_strain_max,
        _ => return None,
    })
}

//! A measured value of a design: the one entry from which its columns, its criterion and its place on a page follow.

use skin::flexure::FlexureMeasures;
use skin::puncture::{PunctureMeasures, TiltMeasures};
use sweep::{Measure, Parameter, Role};

use super::cell::Cell;
use crate::design::design_result::DesignResult;
use crate::design::sample_statistics::{SampleStatistics, Statistics};
use crate::folder::MEASURE_TABLES;
use crate::quantity::Quantity;

/// A measured value: all that tables, rankings, derivatives and pages have to know of it.
#[derive(Debug)]
pub struct MeasuredValue {
    /// The header of its column.
    pub name: &'static str,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// The meaning, in half a sentence.
    pub meaning: &'static str,
    /// The tables in which it stands besides `designs.csv`.
    pub(super) tables: &'static [&'static str],
    /// Where on its path it is measured.
    pub(super) place: Place,
    /// The value in a result.
    pub(super) value: Value,
    /// What it is in physical units; the statistics of samples are written in the first of these.
    pub(super) physical: &'static [Physical],
    /// Which of its values are good, where that is plain.
    pub good: Option<Goal>,
    /// Its statistics over imperfect samples.
    pub(super) samples: Option<SampledValue>,
    /// Its value where the tilt is one of several.
    pub(super) at_tilts: Option<TiltValue>,
    /// Whether the table of a page shows it unless others are chosen.
    pub shown: Shown,
    /// Whether only runs with a guided needle have it.
    pub(super) is_of_guided_needle: bool,
    /// The parameters, in two units, that say where it is measured: only runs that set one of them have it.
    pub(super) needs: &'static [&'static str],
}

/// The value of a measure in a result.
#[derive(Debug)]
pub(super) enum Value {
    /// The coverage.
    Coverage,
    /// A number of a puncture, which has derivatives.
    Puncture(fn(&mut PunctureMeasures) -> &mut Option<f64>),
    /// A number of bending, which has derivatives.
    Flexure(fn(&mut FlexureMeasures) -> &mut Option<f64>),
    /// A count, a text, or a number without derivatives.
    Other(fn(&DesignResult) -> Cell),
    /// A count of imperfect samples.
    Samples(fn(&SampleStatistics) -> Option<usize>),
    /// None but over imperfect samples.
    SamplesAlone,
    /// The mass of the scales over the area of the skin, which needs no solution.
    ArealMass,
}

/// Where on its path a value is measured, which says whether the end of the path matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// On no path, or on all of it without a meaning for the skin.
    Nowhere,
    /// At rest.
    Rest,
    /// Where scales touch.
    Contact,
    /// Where the row becomes unstable.
    Instability,
    /// At the first fold of the surface.
    Fold,
    /// At the first fold or at the end, whichever comes first.
    FoldOrEnd,
    /// At the largest load.
    Peak,
    /// Anywhere, up to the end.
    Anywhere,
    /// At the end.
    End,
}

impl Place {
    /// Whether the value depends on where the path ends.
    pub(super) fn depends_on_end(self) -> bool {
        matches!(self, Self::FoldOrEnd | Self::Peak | Self::Anywhere | Self::End)
    }

    /// Whether it is where a skin gives way.
    pub(super) fn is_limit(self) -> bool {
        matches!(self, Self::Instability | Self::Fold | Self::FoldOrEnd | Self::Peak)
    }
}

/// A measured value in physical units.
#[derive(Debug)]
pub(super) struct Physical {
    pub(super) quantity: Quantity,
    /// Name without the unit, and meaning, of another thing than the dimensionless value.
    pub(super) other: Option<(&'static str, &'static str)>,
}

/// The statistics of a value over imperfect samples.
#[derive(Debug)]
pub(super) struct SampledValue {
    /// The value in words.
    pub(super) noun: &'static str,
    pub(super) statistics: fn(&SampleStatistics) -> Option<Statistics>,
}

/// The value where the tilt is one of several.
#[derive(Debug)]
pub(super) struct TiltValue {
    pub(super) meaning: &'static str,
    pub(super) value: fn(&TiltMeasures) -> f64,
}

/// Whether the table of a page shows a value unless others are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Among the first columns.
    First,
    /// Behind the columns in physical units.
    Then,
    /// Behind all others.
    Last,
    /// Not at first.
    Chosen,
}

/// Which values of a column are good.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Large ones.
    Maximize,
    /// Small ones.
    Minimize,
}

impl Goal {
    /// The goal as criteria are written.
    pub fn key(self) -> &'static str {
        match self {
            Self::Maximize => "max",
            Self::Minimize => "min",
        }
    }

    /// Whether one value is better than another.
    pub fn prefers(self, value: f64, other: f64) -> bool {
        match self {
            Self::Maximize => value > other,
            Self::Minimize => value < other,
        }
    }

    /// The goal of an inverse.
    pub(super) fn inverse(self) -> Self {
        match self {
            Self::Maximize => Self::Minimize,
            Self::Minimize => Self::Maximize,
        }
    }
}

impl MeasuredValue {
    /// The cell of the value in a result; of what a result does not tell an empty one.
    pub(super) fn cell(&self, result: &DesignResult) -> Cell {
        match self.value {
            Value::Coverage => result.coverage.into(),
            // Measures are a copy of some hundred bytes: cheaper than a second accessor for each of them.
            Value::Puncture(field) => {
                result.puncture.and_then(|mut p| *field(&mut p.measures)).into()
            }
            Value::Flexure(field) => {
                result.flexure.and_then(|mut f| *field(&mut f.measures)).into()
            }
            Value::Other(cell) => cell(result),
            Value::Samples(count) => count(&result.samples).into(),
            Value::SamplesAlone | Value::ArealMass => Cell::Empty,
        }
    }

    /// The number in a result, if it has one.
    pub fn number(&self, result: &DesignResult) -> Option<f64> {
        self.cell(result).number()
    }

    /// The number in a result, to be changed; `None` if it has no derivatives, or was not asked for.
    pub(crate) fn number_mut<'r>(
        &self,
        result: &'r mut DesignResult,
    ) -> Option<&'r mut Option<f64>> {
        match self.value {
            Value::Coverage => Some(&mut result.coverage),
            Value::Puncture(field) => result.puncture.as_mut().map(|p| field(&mut p.measures)),
            Value::Flexure(field) => result.flexure.as_mut().map(|f| field(&mut f.measures)),
            _ => None,
        }
    }

    /// Whether it is a finite number of a puncture, if it is one at all.
    pub(crate) fn is_finite_in_puncture(&self, measures: &mut PunctureMeasures) -> bool {
        let Value::Puncture(field) = self.value else { return true };
        field(measures).is_none_or(f64::is_finite)
    }

    /// Whether it is a finite number of a bending, if it is one at all.
    pub(crate) fn is_finite_in_flexure(&self, measures: &mut FlexureMeasures) -> bool {
        let Value::Flexure(field) = self.value else { return true };
        field(measures).is_none_or(f64::is_finite)
    }

    /// Whether it is a number that has derivatives.
    pub(crate) fn has_derivatives(&self) -> bool {
        matches!(self.value, Value::Coverage | Value::Puncture(_) | Value::Flexure(_))
    }

    /// The measure for which it is solved; `None` if it needs none, or tells how designs were solved.
    pub fn measure(&self) -> Option<Measure> {
        let of =
            |(table, measure): &(&str, Measure)| self.tables.contains(table).then_some(*measure);
        // The mass stands in the table of coverage, but no measure has to be asked for to have it.
        let is_solved = !matches!(self.value, Value::ArealMass);
        MEASURE_TABLES.iter().find_map(of).filter(|_| is_solved)
    }

    /// Whether a parameter says how it is measured, so that nothing can be compared where that differs. The dimensionless
    /// measures of bending are those of one membrane: `C_f*` counts in `1/(E_m I_m)`, which another thickness changes.
    pub(crate) fn is_measured_by(&self, parameter: &Parameter, quantity: Option<Quantity>) -> bool {
        let ends = match self.measure() {
            Some(Measure::Puncture) => parameter.has(Role::EndsPuncture),
            Some(Measure::Flexure) => parameter.has(Role::EndsBending),
            _ => false,
        };
        // In physical units the membrane is part of the number, and any two designs compare.
        let is_unit = quantity.is_none() && self.unit.contains("E_m I_m");
        // Manufactured properties stay comparable: designs with and without friction may compete.
        let marks = self.needs.contains(&parameter.key) && !parameter.has(Role::Made);
        marks
            || (ends && self.place.depends_on_end())
            || (is_unit && parameter.has(Role::UnitOfBending))
    }

    /// Whether it is what a table of its own is about.
    pub(super) fn leads(&self) -> bool {
        MEASURE_TABLES.iter().any(|(table, _)| *table == self.name)
    }

    /// The first table in which it stands.
    pub(super) fn first_table(&self) -> Option<usize> {
        MEASURE_TABLES.iter().position(|(table, _)| self.tables.contains(table))
    }
}

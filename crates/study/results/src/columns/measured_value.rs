//! Entries of measured values, from which columns, ranking criteria and page layout derive.

use skin::flexure::FlexureMeasures;
use skin::puncture::{PunctureMeasures, TiltMeasures};
use sweep::{Measure, Parameter, Role};

use super::cell::Cell;
use crate::design::path_result::{FlexureResult, PunctureResult};
use crate::design::sample_statistics::{SampleStatistics, Statistics};
use crate::folder::MEASURE_TABLES;
use crate::quantity::Quantity;

/// A measured value, with the data that tables, rankings, derivatives and pages need.
#[derive(Debug)]
pub struct MeasuredValue {
    /// Header of the column.
    pub name: &'static str,
    /// Unit, or `-` for a value without a unit.
    pub unit: &'static str,
    /// Meaning, as a phrase without a full stop.
    pub meaning: &'static str,
    /// Tables that contain the value in addition to `designs.csv`.
    pub(super) tables: &'static [&'static str],
    /// Point of the path at which the value is measured.
    pub(super) point: PathPoint,
    /// Accessor of the value in a result.
    pub(crate) value: Value,
    /// Conversions to physical units. Statistics over samples use only the first conversion.
    pub(super) physical: &'static [Physical],
    /// Whether large or small values are better; `None` if neither is generally better.
    pub good: Option<Goal>,
    /// Statistics over imperfect samples.
    pub(super) samples: Option<SampledValue>,
    /// Value at each of several critical tilts.
    pub(super) at_tilts: Option<TiltValue>,
    /// Position in the default table of a page.
    pub shown: Shown,
    /// Whether the value exists only in sweeps with a guided needle.
    pub(super) is_of_guided_needle: bool,
    /// Whether the value of a puncture needs more of the path than the critical state.
    pub(super) needs_path: bool,
    /// Keys of the parameters, in both units, that request the value.
    ///
    /// Unless the list is empty, the value exists only in sweeps that set one of these parameters.
    pub(super) needs: &'static [&'static str],
}

/// Accessor of a measured value in a result.
#[derive(Debug)]
pub(crate) enum Value {
    Coverage,
    /// Of the puncture: a number with derivatives.
    Puncture(fn(&mut PunctureMeasures) -> &mut Option<f64>),
    /// Of bending: a number with derivatives.
    Flexure(fn(&mut FlexureMeasures) -> &mut Option<f64>),
    /// Of the puncture: a count, a text, or a number without derivatives.
    OfPuncture(fn(&PunctureResult) -> Cell),
    /// Of bending: a count, a text, or a number without derivatives.
    OfBending(fn(&FlexureResult) -> Cell),
    /// The settings of a rerun design.
    Settings,
    /// A count of imperfect samples.
    Samples(fn(&SampleStatistics) -> Option<usize>),
    /// A value that exists only as statistics over imperfect samples.
    SamplesAlone,
    /// Mass of the scales per area of the skin, computed without a solution.
    ArealMass,
}

/// Point of the path at which a value is measured.
///
/// The point determines whether the value depends on the end of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathPoint {
    /// No point: the value needs no path, or is a property of its solution, e.g. a count.
    Nowhere,
    /// At rest, before the load acts.
    Rest,
    /// At first contact of scales.
    Contact,
    /// At the point where the row loses its stability.
    Instability,
    /// At the first fold of the surface.
    Fold,
    /// At the first fold or at the end, whichever comes first.
    FoldOrEnd,
    /// At the largest load.
    Peak,
    /// At any point up to the end of the path.
    Anywhere,
    /// At the end of the path.
    End,
}

impl PathPoint {
    /// Returns true if the value depends on the end of the path.
    pub(super) fn depends_on_end(self) -> bool {
        matches!(self, Self::FoldOrEnd | Self::Peak | Self::Anywhere | Self::End)
    }

    /// Returns true if the value is a limit of the skin: instability, fold or peak.
    pub(super) fn is_limit(self) -> bool {
        matches!(self, Self::Instability | Self::Fold | Self::FoldOrEnd | Self::Peak)
    }
}

/// Conversion of a measured value to physical units.
#[derive(Debug)]
pub(super) struct Physical {
    pub(super) quantity: Quantity,
    /// Name without the unit, and meaning; `None` if they equal the ones of the dimensionless
    /// value.
    pub(super) other: Option<(&'static str, &'static str)>,
}

/// Statistics of a value over imperfect samples.
#[derive(Debug)]
pub(super) struct SampledValue {
    /// Noun for the value in the descriptions of its statistics.
    pub(super) noun: &'static str,
    pub(super) statistics: fn(&SampleStatistics) -> Option<Statistics>,
}

/// Value at each of several critical tilts.
#[derive(Debug)]
pub(super) struct TiltValue {
    pub(super) meaning: &'static str,
    pub(super) value: fn(&TiltMeasures) -> f64,
}

/// Position of a value in the default table of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Among the first columns.
    First,
    /// After the columns in physical units.
    Then,
    /// After all other columns.
    Last,
    /// Hidden until the reader selects it.
    Chosen,
}

/// Whether large or small values of a column are better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Large values are better.
    Maximize,
    /// Small values are better.
    Minimize,
}

impl Goal {
    /// Returns the key of the goal in ranking criteria.
    pub fn key(self) -> &'static str {
        match self {
            Self::Maximize => "max",
            Self::Minimize => "min",
        }
    }

    /// Returns true if `value` is better than `other`.
    pub fn prefers(self, value: f64, other: f64) -> bool {
        match self {
            Self::Maximize => value > other,
            Self::Minimize => value < other,
        }
    }

    /// Returns the goal of the inverse of a value.
    pub(super) fn inverse(self) -> Self {
        match self {
            Self::Maximize => Self::Minimize,
            Self::Minimize => Self::Maximize,
        }
    }
}

impl MeasuredValue {
    /// Returns false if the value is a number of a puncture that is not finite.
    pub(crate) fn is_finite_in_puncture(&self, measures: &mut PunctureMeasures) -> bool {
        let Value::Puncture(field) = self.value else { return true };
        field(measures).is_none_or(f64::is_finite)
    }

    /// Returns false if the value is a number of bending that is not finite.
    pub(crate) fn is_finite_in_flexure(&self, measures: &mut FlexureMeasures) -> bool {
        let Value::Flexure(field) = self.value else { return true };
        field(measures).is_none_or(f64::is_finite)
    }

    /// Returns true if the value is a number with derivatives.
    pub(crate) fn has_derivatives(&self) -> bool {
        matches!(self.value, Value::Coverage | Value::Puncture(_) | Value::Flexure(_))
    }

    /// Returns the measure that must be solved for this value.
    ///
    /// `None` for the areal mass, which needs no solution, and for solver information.
    pub fn measure(&self) -> Option<Measure> {
        let of =
            |(table, measure): &(&str, Measure)| self.tables.contains(table).then_some(*measure);
        // The areal mass is in the table of coverage, but needs no measure to be solved.
        let is_solved = !matches!(self.value, Value::ArealMass);
        MEASURE_TABLES.iter().find_map(of).filter(|_| is_solved)
    }

    /// Returns true if [`skin::PathDetail::Critical`] omits the value.
    pub(super) fn is_along_path(&self) -> bool {
        let is_before_end = matches!(
            self.point,
            PathPoint::Rest | PathPoint::Contact | PathPoint::Instability | PathPoint::Peak
        );
        self.measure() == Some(Measure::Puncture) && (is_before_end || self.needs_path)
    }

    /// Returns true if the value may belong to the first fold of the surface.
    pub(super) fn is_at_fold(&self) -> bool {
        matches!(self.point, PathPoint::Fold | PathPoint::FoldOrEnd)
    }

    /// Returns true if `parameter` defines how the value is measured.
    ///
    /// Designs with different values of such a parameter cannot be compared. The dimensionless
    /// measures of bending refer to one membrane: the unit of `C_f*` is `1/(E_m I_m)`, which
    /// depends on the thickness of the membrane.
    pub(crate) fn is_measured_by(&self, parameter: &Parameter, quantity: Option<Quantity>) -> bool {
        let ends = match self.measure() {
            Some(Measure::Puncture) => parameter.has(Role::EndsPuncture),
            Some(Measure::Flexure) => parameter.has(Role::EndsBending),
            _ => false,
        };
        // Values in physical units can be compared between designs with different membranes.
        let is_unit = quantity.is_none() && self.unit.contains("E_m I_m");
        // A parameter with manufacturing deviations is a property of the product, not of the
        // measurement: designs with and without friction can be compared.
        let is_required = self.needs.contains(&parameter.key) && !parameter.has(Role::Toleranced);
        is_required
            || (ends && self.point.depends_on_end())
            || (is_unit && parameter.has(Role::UnitOfBending))
    }

    /// Returns true if a measure table is named after this value.
    pub(super) fn names_a_table(&self) -> bool {
        MEASURE_TABLES.iter().any(|(table, _)| *table == self.name)
    }

    /// Returns the index of the first table that contains the value.
    pub(super) fn first_table(&self) -> Option<usize> {
        MEASURE_TABLES.iter().position(|(table, _)| self.tables.contains(table))
    }
}

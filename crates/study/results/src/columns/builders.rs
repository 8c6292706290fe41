//! Constant builders for the entries of measured values.

use skin::flexure::FlexureMeasures;
use skin::puncture::{PunctureMeasures, TiltMeasures};

use super::cell::Cell;
use super::measured_value::{
    Goal, MeasuredValue, PathPoint, Physical, SampledValue, Shown, TiltValue, Value,
};
use super::name;
use crate::design::path_result::{FlexureResult, PunctureResult};
use crate::design::sample_statistics::{SampleStatistics, Statistics};
use crate::quantity::Quantity;

// Tables that contain a value in addition to `designs.csv`.
pub(super) const NONE: &[&str] = &[];
pub(super) const COVERAGE: &[&str] = &[name::COVERAGE];
pub(super) const FORCE: &[&str] = &[name::CRITICAL_FORCE];
pub(super) const DEPTH: &[&str] = &[name::PENETRATION];
pub(super) const BOTH: &[&str] = &[name::CRITICAL_FORCE, name::PENETRATION];
pub(super) const COMPLIANCE: &[&str] = &[name::COMPLIANCE];

/// Default values of an entry.
const BLANK: MeasuredValue = MeasuredValue {
    name: "",
    unit: "-",
    meaning: "",
    tables: NONE,
    point: PathPoint::Nowhere,
    value: Value::SamplesAlone,
    physical: &[],
    good: None,
    samples: None,
    at_tilts: None,
    shown: Shown::Chosen,
    is_of_guided_needle: false,
    needs_path: false,
    needs: NONE,
};

type PunctureField = fn(&mut PunctureMeasures) -> &mut Option<f64>;
type FlexureField = fn(&mut FlexureMeasures) -> &mut Option<f64>;

// The builders are `const`, because the list of entries is a static.
/// Builds a conversion that keeps the column name and adds the suffix of `quantity`.
pub(super) const fn same(quantity: Quantity) -> Physical {
    Physical { quantity, other: None }
}

/// Builds a conversion that changes the column name, e.g. from compliance to rigidity.
pub(super) const fn renamed(
    quantity: Quantity,
    name: &'static str,
    meaning: &'static str,
) -> Physical {
    Physical { quantity, other: Some((name, meaning)) }
}

/// Builds an entry with the accessor `value` and the measure tables that contain the value.
pub(super) const fn value(
    name: &'static str,
    tables: &'static [&'static str],
    value: Value,
) -> MeasuredValue {
    MeasuredValue { name, tables, value, ..BLANK }
}

/// Builds an entry of the puncture: a count, a text, or a number without derivatives.
pub(super) const fn of_puncture(
    name: &'static str,
    tables: &'static [&'static str],
    cell: fn(&PunctureResult) -> Cell,
) -> MeasuredValue {
    value(name, tables, Value::OfPuncture(cell))
}

/// Builds an entry of bending: a count, a text, or a number without derivatives.
pub(super) const fn of_bending(
    name: &'static str,
    tables: &'static [&'static str],
    cell: fn(&FlexureResult) -> Cell,
) -> MeasuredValue {
    value(name, tables, Value::OfBending(cell))
}

/// Builds an entry of the puncture: a number with derivatives.
pub(super) const fn number(
    name: &'static str,
    point: PathPoint,
    field: PunctureField,
) -> MeasuredValue {
    value(name, FORCE, Value::Puncture(field)).at(point)
}

pub(super) const fn force(
    name: &'static str,
    point: PathPoint,
    field: PunctureField,
) -> MeasuredValue {
    // A named constant: a slice borrowed from a call result would not live beyond this function.
    const IN_NEWTON: &[Physical] = &[same(Quantity::Force)];
    number(name, point, field).in_unit("E_s L t/(1-nu^2)").physical(IN_NEWTON)
}

pub(super) const fn depth(
    name: &'static str,
    point: PathPoint,
    field: PunctureField,
) -> MeasuredValue {
    const IN_MM: &[Physical] = &[same(Quantity::Length)];
    number(name, point, field).in_unit("t").physical(IN_MM)
}

pub(super) const fn stiffness(
    name: &'static str,
    point: PathPoint,
    field: PunctureField,
) -> MeasuredValue {
    const PER_MM: &[Physical] = &[same(Quantity::Stiffness)];
    number(name, point, field).in_unit("E_s t").physical(PER_MM)
}

/// Builds an entry of bending: a number with derivatives.
pub(super) const fn bending(
    name: &'static str,
    point: PathPoint,
    field: FlexureField,
) -> MeasuredValue {
    value(name, COMPLIANCE, Value::Flexure(field)).at(point)
}

impl MeasuredValue {
    /// Sets the unit.
    pub(super) const fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Restricts the value to sweeps with a guided needle.
    pub(super) const fn guided(self) -> Self {
        Self { is_of_guided_needle: true, ..self }
    }

    /// Marks a value of a puncture that needs more of the path than the critical state.
    pub(super) const fn along_path(self) -> Self {
        Self { needs_path: true, ..self }
    }

    /// Restricts the value to sweeps that set one of these parameters.
    pub(super) const fn needing(self, needs: &'static [&'static str]) -> Self {
        Self { needs, ..self }
    }

    /// Marks large values as better.
    pub(super) const fn large(self) -> Self {
        Self { good: Some(Goal::Maximize), ..self }
    }

    /// Marks small values as better.
    pub(super) const fn small(self) -> Self {
        Self { good: Some(Goal::Minimize), ..self }
    }

    /// Sets the measure tables that contain the value.
    pub(super) const fn within(self, tables: &'static [&'static str]) -> Self {
        Self { tables, ..self }
    }

    /// Sets the point of the path at which the value is measured.
    pub(super) const fn at(self, point: PathPoint) -> Self {
        Self { point, ..self }
    }

    /// Sets the conversions to physical units.
    pub(super) const fn physical(self, physical: &'static [Physical]) -> Self {
        Self { physical, ..self }
    }

    /// Adds statistics over imperfect samples, with a noun for the value in their descriptions.
    pub(super) const fn sampled(
        self,
        noun: &'static str,
        statistics: fn(&SampleStatistics) -> Option<Statistics>,
    ) -> Self {
        Self { samples: Some(SampledValue { noun, statistics }), ..self }
    }

    /// Adds the value at each of several critical tilts.
    pub(super) const fn at_tilts(
        self,
        meaning: &'static str,
        value: fn(&TiltMeasures) -> f64,
    ) -> Self {
        Self { at_tilts: Some(TiltValue { meaning, value }), ..self }
    }

    /// Shows the value among the first columns of the default table of a page.
    pub(super) const fn first(self) -> Self {
        Self { shown: Shown::First, ..self }
    }

    /// Shows the value after the columns in physical units of the default table of a page.
    pub(super) const fn then(self) -> Self {
        Self { shown: Shown::Then, ..self }
    }

    /// Shows the value after all other columns of the default table of a page.
    pub(super) const fn last(self) -> Self {
        Self { shown: Shown::Last, ..self }
    }
}

//! Requirements on columns of nominal designs and samples, and the margins to them.

use ranking::{Relation, Requirement, tightest};
use results::DesignRow;
use results::columns::name;
use sweep::{Measure, Parameter, Sweep};

use crate::column::NumberColumn;
use crate::slopes::Slopes;

/// A requirement with the column (or other source) of its value.
pub(crate) struct Bound<C> {
    pub requirement: Requirement,
    pub column: C,
}

/// Requirements on columns, which apply to a nominal design and to each of its samples.
pub(crate) struct Bounds {
    pub all: Vec<Bound<NumberColumn>>,
    /// Index of the requirement of an unfolded surface; `None` if not required.
    pub soundness: Option<usize>,
}

/// Returns the requirement of an unfolded surface: no gap may be closed at the critical tilt.
///
/// `None` if `sweep` does not measure puncture.
pub(crate) fn soundness(sweep: &Sweep) -> Option<Requirement> {
    sweep.measures().contains(&Measure::Puncture).then(|| Requirement {
        column: name::GAP_STRETCH_MIN.to_owned(),
        // The inequality is strict, because the surface folds when a gap closes.
        relation: Relation::Above,
        limit: 0.0,
    })
}

/// Returns true if the surface folds at some point of the puncture path.
pub(crate) fn has_folded(row: &DesignRow) -> bool {
    row.result.puncture.is_some_and(|puncture| puncture.measures.fold_force.is_some())
}

impl Bounds {
    /// Returns the value of a design for each requirement; `None` for an empty column.
    pub fn values<'a>(&'a self, row: &'a DesignRow) -> impl Iterator<Item = Option<f64>> + 'a {
        self.all.iter().map(|bound| bound.column.value(row))
    }

    /// Returns the requirement with the smallest margin, and this margin.
    ///
    /// `values` are the values for all requirements. `None` if there are no requirements.
    pub fn tightest(
        &self,
        values: impl Iterator<Item = Option<f64>>,
    ) -> Option<(&Bound<NumberColumn>, f64)> {
        let bounds = self.all.iter().map(|bound| &bound.requirement).zip(values);
        tightest(bounds).map(|(k, margin)| (&self.all[k], margin))
    }

    /// Returns the smallest margin to a requirement; infinite without requirements.
    pub fn margin(&self, values: impl Iterator<Item = Option<f64>>) -> f64 {
        self.tightest(values).map_or(f64::INFINITY, |(_, margin)| margin)
    }

    /// Returns true if the surface folded along the path, but is unfolded again at the end.
    ///
    /// Returns false if folds are allowed. Also returns false for a surface that is folded at the
    /// end, because the requirement of an unfolded surface already covers this case.
    pub fn has_reopened(&self, row: &DesignRow) -> bool {
        self.soundness.is_some_and(|k| {
            let Bound { requirement, column } = &self.all[k];
            column.value(row).is_some_and(|value| requirement.is_met(value))
        }) && has_folded(row)
    }

    /// Returns the derivatives of the smallest margin with respect to `parameter`.
    ///
    /// Only the requirement with the smallest margin contributes.
    pub fn margin_slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        let tightest = self.tightest(self.values(row));
        tightest.map_or(Slopes::UNKNOWN, |(bound, _)| {
            bound.column.slopes(row, parameter).scaled(bound.requirement.margin_rate())
        })
    }
}

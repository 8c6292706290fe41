//! Margins of a design within the bounds of a goal.

use ranking::{Relation, Requirement, tightest};
use results::DesignRow;
use results::columns::name;
use sweep::{Measure, Parameter, Sweep};

use crate::column::NumberColumn;
use crate::slopes::Slopes;

/// A requirement with its column.
pub(crate) struct Bound<C> {
    pub requirement: Requirement,
    pub column: C,
}

/// Bounds on a nominal design and on each of its samples.
pub(crate) struct Bounds {
    pub all: Vec<Bound<NumberColumn>>,
    /// Index of the bound against a folded surface, if required.
    pub soundness: Option<usize>,
}

/// Returns the requirement of an unfolded surface, if `sweep` measures puncture.
///
/// No gap may be closed at the critical tilt.
pub(crate) fn soundness(sweep: &Sweep) -> Option<Requirement> {
    sweep.measures().contains(&Measure::Puncture).then(|| Requirement {
        column: name::GAP_STRETCH_MIN.to_owned(),
        // Strict: the surface folds as a gap closes.
        relation: Relation::Above,
        limit: 0.0,
    })
}

/// Returns true if the surface folds along the path.
pub(crate) fn has_folded(row: &DesignRow) -> bool {
    row.result.puncture.is_some_and(|puncture| puncture.measures.fold_force.is_some())
}

impl Bounds {
    /// Returns the values of a design in the columns of the bounds.
    pub fn values<'a>(&'a self, row: &'a DesignRow) -> impl Iterator<Item = Option<f64>> + 'a {
        self.all.iter().map(|bound| bound.column.value(row))
    }

    /// Returns the bound with the least margin, and the margin; `None` without bounds.
    pub fn tightest(
        &self,
        values: impl Iterator<Item = Option<f64>>,
    ) -> Option<(&Bound<NumberColumn>, f64)> {
        let bounds = self.all.iter().map(|bound| &bound.requirement).zip(values);
        tightest(bounds).map(|(k, margin)| (&self.all[k], margin))
    }

    /// Returns the least margin over all bounds; infinite without bounds.
    pub fn margin(&self, values: impl Iterator<Item = Option<f64>>) -> f64 {
        self.tightest(values).map_or(f64::INFINITY, |(_, margin)| margin)
    }

    /// Returns true if the surface folded along the path and is open again at the end.
    ///
    /// False if folds are allowed. If the surface is folded at the end, the margin of the bound
    /// measures it.
    pub fn has_reopened(&self, row: &DesignRow) -> bool {
        self.soundness.is_some_and(|k| {
            let Bound { requirement, column } = &self.all[k];
            column.value(row).is_some_and(|value| requirement.is_met(value))
        }) && has_folded(row)
    }

    /// Returns the derivatives of the least margin, from the tightest bound.
    pub fn margin_slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        let tightest = self.tightest(self.values(row));
        tightest.map_or(Slopes::UNKNOWN, |(bound, _)| {
            bound.column.slopes(row, parameter).scaled(bound.requirement.margin_rate())
        })
    }
}

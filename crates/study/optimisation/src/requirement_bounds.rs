//! How far a design is within the bounds of a goal.

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

/// The bounds of a nominal design and of every sample of it.
pub(crate) struct Bounds {
    pub all: Vec<Bound<NumberColumn>>,
    /// The index of the one that the surface has not folded, if that is wanted.
    pub soundness: Option<usize>,
}

/// The requirement that the surface of the substrate has not folded, if `sweep` tells: no gap has closed at the critical tilt.
pub(crate) fn soundness(sweep: &Sweep) -> Option<Requirement> {
    sweep.measures().contains(&Measure::Puncture).then(|| Requirement {
        column: name::GAP_STRETCH_MIN.to_owned(),
        // Strict: where a gap has just closed, the surface has folded.
        relation: Relation::Above,
        limit: 0.0,
    })
}

/// Whether the surface of a design folds on the way.
pub(crate) fn has_folded(row: &DesignRow) -> bool {
    row.result.puncture.is_some_and(|puncture| puncture.measures.fold_force.is_some())
}

impl Bounds {
    /// The values of a design in the columns of the bounds.
    pub fn values<'a>(&'a self, row: &'a DesignRow) -> impl Iterator<Item = Option<f64>> + 'a {
        self.all.iter().map(|bound| bound.column.value(row))
    }

    /// The bound that a design with these values is least within, and its margin; `None` if there are no bounds.
    pub fn tightest(
        &self,
        values: impl Iterator<Item = Option<f64>>,
    ) -> Option<(&Bound<NumberColumn>, f64)> {
        let bounds = self.all.iter().map(|bound| &bound.requirement).zip(values);
        tightest(bounds).map(|(k, margin)| (&self.all[k], margin))
    }

    /// The least margin over all bounds; infinite if there are none.
    pub fn margin(&self, values: impl Iterator<Item = Option<f64>>) -> f64 {
        self.tightest(values).map_or(f64::INFINITY, |(_, margin)| margin)
    }

    /// Whether the surface of a design, open at the end, folded on the way, and that counts. Where it is folded at the end, a bound
    /// tells how far.
    pub fn has_reopened(&self, row: &DesignRow) -> bool {
        let is_open = |k: usize| {
            let Bound { requirement, column } = &self.all[k];
            column.value(row).is_some_and(|value| requirement.is_met(value))
        };
        self.soundness.is_some_and(is_open) && has_folded(row)
    }

    /// The derivatives of the least margin: those of the tightest bound.
    pub fn margin_slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        let tightest = self.tightest(self.values(row));
        tightest.map_or(Slopes::UNKNOWN, |(bound, _)| {
            bound.column.slopes(row, parameter).scaled(bound.requirement.margin_rate())
        })
    }
}

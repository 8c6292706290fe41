//! Summary of a run: counts and best values.

use std::collections::BTreeMap;

use results::columns::{ValueColumn, is_invalid_after_fold, measure_name, name};
use results::round_off::Leader;
use results::{DesignRow, Outcome, incomparable_by};
use sweep::{DesignNumber, Measure, Sweep};

/// Counts and best values of the designs of a run.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Number of solved designs.
    pub designs: u64,
    /// Number of designs that lack a requested value.
    pub failed: u64,
    /// Number of designs for each status, for puncture and flexure separately.
    pub statuses: BTreeMap<Measure, BTreeMap<&'static str, u64>>,
    /// Number of designs with a fold of the substrate's surface.
    pub folded: u64,
    contests: Vec<Contest>,
}

/// Best value of a measure in a run, and the first design that has this value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// Description of the value, for example "largest critical force".
    pub label: &'static str,
    /// Physical unit of the value; `None` for dimensionless values.
    pub unit: Option<&'static str>,
    /// Value, the first design with this value, and the number of other designs with this value.
    pub leader: Leader<DesignNumber>,
    /// Parameter that differs between designs and makes their values incomparable, if any.
    pub incomparable_by: Option<&'static str>,
    /// True if the value is not valid because the surface of the substrate folds.
    pub is_folded: bool,
    /// Best value of the designs without a fold, if the best value of all designs is not valid.
    pub unfolded: Option<Leader<DesignNumber>>,
}

/// A measure with its best value so far.
#[derive(Clone, Copy, Debug)]
struct Contest {
    label: &'static str,
    column: &'static ValueColumn,
    best: Option<Leader<DesignNumber>>,
    /// Best value of the designs without a fold.
    unfolded: Option<Leader<DesignNumber>>,
    incomparable_by: Option<&'static str>,
    /// Whether a fold of the surface invalidates the measure.
    is_invalid_after_fold: bool,
}

/// Measures in the summary: column names and labels.
const MEASURES: [(&str, &str); 5] = [
    (name::COVERAGE, "best coverage"),
    (name::CRITICAL_FORCE, "largest critical force"),
    (name::PENETRATION, "least penetration"),
    (name::COMPLIANCE, "largest compliance"),
    (name::SOUND_FORCE, "largest force before a fold"),
];

/// Label if the compliance is stated in physical units, as flexural rigidity (its inverse).
const RIGIDITY: &str = "least flexural rigidity";

impl Summary {
    /// Creates a summary without designs.
    pub(crate) fn new(sweep: &Sweep) -> Self {
        let contest = |(name, label)| {
            let column = ValueColumn::in_units_of(sweep, name)?;
            let is_rigidity = name == name::COMPLIANCE && column.physical_unit().is_some();
            Some(Contest {
                label: if is_rigidity { RIGIDITY } else { label },
                column,
                best: None,
                unfolded: None,
                incomparable_by: incomparable_by(sweep, column.name()),
                is_invalid_after_fold: is_invalid_after_fold(name),
            })
        };
        Self { contests: MEASURES.into_iter().filter_map(contest).collect(), ..Self::default() }
    }

    /// Adds a design to the counts and best values.
    ///
    /// Designs must be added in the order of their numbers, because the first of several designs
    /// with the best value is kept.
    pub(crate) fn add(&mut self, row: &DesignRow) {
        self.designs += 1;
        self.failed += u64::from(row.result.failed());
        let puncture = row.result.puncture.map(|puncture| (Measure::Puncture, puncture.outcome));
        let flexure = row.result.flexure.map(|flexure| (Measure::Flexure, flexure.outcome));
        puncture
            .into_iter()
            .chain(flexure)
            .for_each(|(measure, outcome)| self.count(measure, outcome));
        // Measures of designs with a fold exist but may be invalid, so folds are counted
        // separately.
        let fold = row.result.puncture.and_then(|puncture| puncture.measures.fold_force);
        self.folded += u64::from(fold.is_some());
        for contest in &mut self.contests {
            let column = contest.column;
            let Some((number, goal)) = column.number(row).zip(column.good()) else { continue };
            Leader::enter(&mut contest.best, row.number, number, goal);
            if fold.is_none() || !contest.is_invalid_after_fold {
                Leader::enter(&mut contest.unfolded, row.number, number, goal);
            }
        }
    }

    fn count(&mut self, measure: Measure, outcome: Outcome) {
        *self.statuses.entry(measure).or_default().entry(outcome.text()).or_default() += 1;
    }

    /// Returns the best value of each measure that has a value.
    pub fn best(&self) -> impl Iterator<Item = Best> {
        // Without any fold, the force before a fold equals the critical force and is omitted.
        self.contests
            .iter()
            .filter(|contest| {
                self.folded > 0 || measure_name(contest.column.name()) != name::SOUND_FORCE
            })
            .filter_map(|contest| {
                let (leader, unfolded) = (contest.best?, contest.unfolded);
                let is_folded = unfolded.is_none_or(|unfolded| unfolded.first != leader.first);
                let unfolded = unfolded.filter(|_| is_folded);
                let Contest { label, column, incomparable_by, .. } = *contest;
                let unit = column.physical_unit();
                Some(Best { label, unit, leader, incomparable_by, is_folded, unfolded })
            })
    }
}

#[cfg(test)]
mod tests {
    use results::{DesignResult, PunctureResult};
    use sweep::Sweep;

    use super::*;

    #[test]
    fn the_summary_has_counts_and_best_values() {
        let sweep = Sweep::parse("name = 'x'", "x.toml", &[]).expect("a valid sweep");
        let text = "name = 'x'\ndesigns.critical_tilt_deg = [5, 10]";
        let tilts = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
        let [mut summary, mut of_tilts] = [&sweep, &tilts].map(Summary::new);
        for (index, penetration) in [(0, Some(0.5)), (1, None), (2, Some(0.25))] {
            let outcome = penetration.map_or(Outcome::RowLimit, |_| Outcome::Complete);
            let mut puncture = PunctureResult::without_path(outcome);
            puncture.measures.penetration = penetration;
            puncture.measures.critical_force = penetration.map(|_| 2.0);
            puncture.measures.sound_force = penetration;
            puncture.measures.fold_force = penetration.filter(|_| index == 2);
            let result = DesignResult { puncture: Some(puncture), ..DesignResult::default() };
            let (number, case) = (sweep.grid().number(index), sweep.grid().case(index));
            let row = DesignRow { number, case, result };
            summary.add(&row);
            of_tilts.add(&row);
        }
        assert_eq!((summary.designs, summary.folded), (3, 1));
        let counts = &summary.statuses[&Measure::Puncture];
        assert_eq!((counts["complete"], counts["row limit"]), (2, 1));
        let best: Vec<_> =
            summary.best().map(|b| (b.label, b.leader.first.to_string(), b.leader.ties)).collect();
        let expected = [
            ("largest critical force", "0001", 1),
            ("least penetration", "0003", 0),
            ("largest force before a fold", "0001", 0),
        ];
        assert_eq!(best, expected.map(|(what, design, ties)| (what, design.to_owned(), ties)));
        let folds: Vec<_> = summary
            .best()
            .map(|best| (best.is_folded, best.unfolded.map(|leader| leader.first.to_string())))
            .collect();
        // Design 0003 has the least penetration, but its surface folds.
        let unfolded = Some("0001".to_owned());
        assert_eq!(folds, [(false, None), (true, unfolded), (false, None)]);
        let best = of_tilts.best().next();
        assert_eq!(best.and_then(|best| best.incomparable_by), Some("critical_tilt_deg"));
    }
}

//! The summary of a run: counts and best values.

use std::collections::BTreeMap;

use results::columns::SOUND_FORCE;
use results::round_off::Leader;
use results::{DesignResult, DesignRow, Outcome, incomparable_by};
use sweep::{DesignNumber, Measure, Sweep};

/// Counts and best values of the designs of a run.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Designs that were solved.
    pub designs: u64,
    /// Designs that lack a value that was asked for.
    pub failed: u64,
    /// The number of designs of each status, by its text, for each measure that has a path.
    pub statuses: BTreeMap<Measure, BTreeMap<&'static str, u64>>,
    /// Designs on whose path the surface of the substrate folds over.
    pub folded: u64,
    best: [Option<Leader<DesignNumber>>; 5],
    /// For each of these, the parameter that says how it is measured and in which the designs differ.
    apart: [Option<&'static str>; 5],
}

/// The best value of its kind, and the first design that has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// The name of the value, in words.
    pub what: &'static str,
    /// The value, its first design, and how many others have it too.
    pub leader: Leader<DesignNumber>,
    /// The parameter in which designs differ so that they cannot be compared by it.
    pub apart: Option<&'static str>,
}

/// A value of which the best is told.
struct Contest {
    what: &'static str,
    column: &'static str,
    is_better: fn(&f64, &f64) -> bool,
    value: fn(&DesignResult) -> Option<f64>,
}

/// The value that is told only if designs have folded: of all others it is the critical force.
const SOUND: &str = "largest force before a fold";

/// The values of which the best is told.
static CONTESTS: [Contest; 5] = [
    Contest {
        what: "best coverage",
        column: "coverage",
        is_better: f64::gt,
        value: |r| r.coverage,
    },
    Contest {
        what: "largest critical force",
        column: "critical_force",
        is_better: f64::gt,
        value: |r| r.puncture?.measures.critical_force,
    },
    Contest {
        what: "least penetration",
        column: "penetration",
        is_better: f64::lt,
        value: |r| r.puncture?.measures.penetration,
    },
    Contest {
        what: "largest compliance",
        column: "compliance",
        is_better: f64::gt,
        value: |r| r.flexure?.measures.compliance,
    },
    Contest {
        what: SOUND,
        column: SOUND_FORCE,
        is_better: f64::gt,
        value: |r| r.puncture?.measures.sound_force,
    },
];

impl Summary {
    /// The summary of no design of a sweep.
    pub(crate) fn new(sweep: &Sweep) -> Self {
        let apart = CONTESTS.each_ref().map(|contest| incomparable_by(sweep, contest.column));
        Self { apart, ..Self::default() }
    }

    /// Counts a design. Designs must come in their order, because of equal ones the first is the best.
    pub(crate) fn add(&mut self, row: &DesignRow) {
        self.designs += 1;
        self.failed += u64::from(row.result.failed());
        let puncture = row.result.puncture.map(|puncture| (Measure::Puncture, puncture.outcome));
        let flexure = row.result.flexure.map(|flexure| (Measure::Flexure, flexure.outcome));
        puncture
            .into_iter()
            .chain(flexure)
            .for_each(|(measure, outcome)| self.count(measure, outcome));
        for (best, contest) in self.best.iter_mut().zip(&CONTESTS) {
            contest.enter(row, best);
        }
        // Folded designs have measures too; that their surface folds is why the largest of them may mean nothing.
        let fold = row.result.puncture.and_then(|puncture| puncture.measures.fold_force);
        self.folded += u64::from(fold.is_some());
    }

    fn count(&mut self, measure: Measure, outcome: Outcome) {
        *self.statuses.entry(measure).or_default().entry(outcome.text()).or_default() += 1;
    }

    /// The best values, those that exist.
    pub fn best(&self) -> impl Iterator<Item = Best> {
        // Where nothing folds it would repeat the largest critical force.
        let is_told = |contest: &Contest| contest.what != SOUND || self.folded > 0;
        let contests = CONTESTS.iter().zip(self.best).zip(self.apart);
        contests.filter(move |((contest, _), _)| is_told(contest)).filter_map(
            |((contest, leader), apart)| Some(Best { what: contest.what, leader: leader?, apart }),
        )
    }
}

impl Contest {
    /// Enters the value of a design.
    fn enter(&self, row: &DesignRow, best: &mut Option<Leader<DesignNumber>>) {
        if let Some(value) = (self.value)(&row.result) {
            Leader::enter(best, row.number, value, self.is_better);
        }
    }
}

#[cfg(test)]
mod tests {
    use results::PunctureResult;
    use sweep::Sweep;

    use super::*;

    #[test]
    fn counts_and_best_values() {
        let sweep = Sweep::parse("name = 'x'", "x.toml", &[]).expect("a valid sweep");
        let mut summary = Summary::new(&sweep);
        for (index, penetration) in [(0, Some(0.5)), (1, None), (2, Some(0.25))] {
            let outcome = penetration.map_or(Outcome::RowLimit, |_| Outcome::Complete);
            let mut puncture = PunctureResult::without_path(outcome);
            puncture.measures.penetration = penetration;
            puncture.measures.critical_force = penetration.map(|_| 2.0);
            puncture.measures.sound_force = penetration;
            puncture.measures.fold_force = penetration.filter(|_| index == 2);
            let result = DesignResult { puncture: Some(puncture), ..DesignResult::default() };
            let (number, case) = (sweep.grid().number(index), sweep.grid().case(index));
            summary.add(&DesignRow { number, case, result });
        }
        assert_eq!((summary.designs, summary.folded), (3, 1));
        let counts = &summary.statuses[&Measure::Puncture];
        assert_eq!((counts["complete"], counts["row limit"]), (2, 1));
        let best: Vec<_> =
            summary.best().map(|b| (b.what, b.leader.first.to_string(), b.leader.ties)).collect();
        let expected = [
            ("largest critical force", "0001", 1),
            ("least penetration", "0003", 0),
            ("largest force before a fold", "0001", 0),
        ];
        assert_eq!(best, expected.map(|(what, design, ties)| (what, design.to_owned(), ties)));
        let text = "name = 'x'\ndesigns.critical_tilt_deg = [5, 10]";
        let tilts = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
        let apart = Summary { best: summary.best, ..Summary::new(&tilts) }.best().next();
        assert_eq!(apart.and_then(|best| best.apart), Some("critical_tilt_deg"));
    }
}

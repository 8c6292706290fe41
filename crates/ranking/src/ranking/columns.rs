//! The columns of the tables of a ranking.

use results::Column;
use results::columns::{Cell, explain_value, number};
use sweep::Parameter;

use super::RankedDesign;
use crate::criteria::{Criterion, SOUND_CRITERIA};

type RankedColumns<'a> = Vec<Column<RankedDesign<'a>>>;

/// The columns of `ranking.csv` for designs with these parameters, ranked by these criteria.
pub fn ranking_columns<'a>(
    parameters: &[&'static Parameter],
    by: &'static [Criterion; 4],
) -> RankedColumns<'a> {
    let rank =
        Column::new("rank", "-", "place by fitness, 1 is the best", |s: &RankedDesign<'a>| {
            s.rank.into()
        });
    let mut columns = vec![rank];
    columns.extend(design(parameters));
    columns.push(fitness("fitness by the weights of the ranking, from 0 to 1"));
    columns.extend(criteria(by));
    columns.extend(rescaled(by));
    columns.push(Column::new(
        "pareto",
        "-",
        "yes or no: whether no other design beats it in every criterion",
        |s| if s.on_front() { "yes" } else { "no" }.into(),
    ));
    columns
}

/// The columns of `pareto.csv`.
pub fn pareto_columns<'a>(
    parameters: &[&'static Parameter],
    by: &'static [Criterion; 4],
) -> RankedColumns<'a> {
    let mut columns = design(parameters);
    columns.extend(criteria(by));
    columns.push(share("part of all weights for which it is the best design"));
    columns
}

/// The columns of `winners.csv`.
pub fn winner_columns<'a>(
    parameters: &[&'static Parameter],
    by: &'static [Criterion; 4],
) -> RankedColumns<'a> {
    let mut columns = design(parameters);
    columns.push(share("part of all weights for which it is the best design"));
    columns.push(Column::new("nodes", "-", "nodes of the grid of weights that it wins", |s| {
        Cell::Count(i64::try_from(s.candidate.nodes).unwrap_or(i64::MAX))
    }));
    columns.extend(criteria(by));
    columns.extend(rescaled(by));
    columns
}

/// The columns of `quaternary.csv`.
pub fn quaternary_columns<'a>(parameters: &[&'static Parameter]) -> RankedColumns<'a> {
    let mut columns: RankedColumns<'a> = vec![
        Column::new("coverage_weight", "-", "weight m of the coverage", |s| s.weight(0)),
        Column::new("critical_force_weight", "-", "weight n of the critical force", |s| {
            s.weight(1)
        }),
        Column::new("penetration_weight", "-", "weight k of the resistance to penetration", |s| {
            s.weight(2)
        }),
        Column::new("compliance_weight", "-", "weight l of the flexural compliance", |s| {
            s.weight(3)
        }),
    ];
    columns.extend(design(parameters));
    columns.push(fitness("fitness of the best design by these weights"));
    columns.push(share("part of all weights for which the same design is the best"));
    columns
}

/// Number and parameters.
fn design<'a>(parameters: &[&'static Parameter]) -> RankedColumns<'a> {
    let mut columns = vec![number(|s: &RankedDesign<'a>| s.design().to_owned().into())];
    let parameter = |parameter: &&'static Parameter| {
        Column::parameter(parameter, |s: &RankedDesign<'a>, parameter| {
            s.results.parameter(s.row(), parameter).to_owned().into()
        })
    };
    columns.extend(parameters.iter().map(parameter));
    columns
}

fn fitness<'a>(meaning: &'static str) -> Column<RankedDesign<'a>> {
    Column::new("fitness", "-", meaning, |s| s.fitness.into())
}

fn share<'a>(meaning: &'static str) -> Column<RankedDesign<'a>> {
    Column::new("share", "-", meaning, |s| s.share().into())
}

/// The values that the criteria are made from, as in `designs.csv`.
fn criteria<'a>(by: &'static [Criterion; 4]) -> RankedColumns<'a> {
    let cells: [fn(&RankedDesign<'a>) -> Cell; 4] =
        [|s| s.measured(0), |s| s.measured(1), |s| s.measured(2), |s| s.measured(3)];
    let column = |(criterion, cell): (&'static Criterion, fn(&RankedDesign<'a>) -> Cell)| {
        let (unit, meaning) = explain_value(criterion.column).unwrap_or(("-", ""));
        Column::new(criterion.column, unit, meaning, cell)
    };
    by.iter().zip(cells).map(column).collect()
}

fn rescaled<'a>(by: &'static [Criterion; 4]) -> RankedColumns<'a> {
    let [force, meaning] = if by == &SOUND_CRITERIA {
        ["sound_force_rescaled", "sound force, likewise"]
    } else {
        ["critical_force_rescaled", "critical force, likewise"]
    };
    vec![
        Column::new(
            "coverage_rescaled",
            "-",
            "coverage from 0, the least of all ranked designs, to 1, the most",
            |s| s.rescaled()[0].into(),
        ),
        Column::new(force, "-", meaning, |s| s.rescaled()[1].into()),
        Column::new(
            "penetration_resistance_rescaled",
            "-",
            "inverse of the penetration, likewise",
            |s| s.rescaled()[2].into(),
        ),
        Column::new("compliance_rescaled", "-", "flexural compliance, likewise", |s| {
            s.rescaled()[3].into()
        }),
    ]
}

impl RankedDesign<'_> {
    fn weight(&self, criterion: usize) -> Cell {
        self.weights.values()[criterion].into()
    }

    /// The value that a criterion is made from.
    fn measured(&self, criterion: usize) -> Cell {
        self.values()[criterion].into()
    }
}

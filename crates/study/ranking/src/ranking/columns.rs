//! Columns of the tables of a ranking.

use results::Column;
use results::columns::{explain_value, number};
use sweep::Parameter;

use super::{FOUR, RankedDesign};
use crate::preferences::Preferences;

type RankedColumns<'a> = Vec<Column<RankedDesign<'a>>>;

/// Returns the columns of `ranking.csv`, with a column for each of `parameters`.
pub fn ranking_columns<'a>(
    parameters: &[&'static Parameter],
    preferences: &Preferences,
) -> RankedColumns<'a> {
    let rank = Column::new(
        "rank",
        "-",
        "rank by fitness, 1 is the best; equal designs share their rank",
        |s: &RankedDesign<'a>| s.rank.into(),
    );
    let mut columns = vec![rank];
    columns.extend(design(parameters));
    columns.push(fitness("fitness by the weights of the ranking, from 0 to 1"));
    columns.extend(criteria(preferences));
    columns.extend(rescaled(preferences));
    columns.push(Column::new(
        "pareto",
        "-",
        "yes or no: whether the design is on the Pareto front, where no other design dominates it",
        |s| if s.on_front() { "yes" } else { "no" }.into(),
    ));
    columns
}

/// Returns the columns of `pareto.csv`, with a column for each of `parameters`.
pub fn pareto_columns<'a>(
    parameters: &[&'static Parameter],
    preferences: &Preferences,
) -> RankedColumns<'a> {
    let mut columns = design(parameters);
    columns.extend(criteria(preferences));
    // The fraction of all weights is computed only for four criteria.
    if preferences.criteria.len() == FOUR {
        columns.push(share("fraction of all weights for which the design is the best"));
    }
    columns
}

/// Returns the columns of `winners.csv`, with a column for each of `parameters`.
pub fn winner_columns<'a>(
    parameters: &[&'static Parameter],
    preferences: &Preferences,
) -> RankedColumns<'a> {
    let mut columns = design(parameters);
    columns.push(share("fraction of all weights for which the design is the best"));
    columns.push(Column::new(
        "nodes",
        "-",
        "number of nodes of the grid of weights at which the design is the best",
        |s| s.wins().nodes.into(),
    ));
    columns.extend(criteria(preferences));
    columns.extend(rescaled(preferences));
    columns
}

/// Returns the columns of `quaternary.csv`, with a column for each of `parameters`.
pub fn quaternary_columns<'a>(
    parameters: &[&'static Parameter],
    preferences: &Preferences,
) -> RankedColumns<'a> {
    let mut columns: RankedColumns<'a> = preferences
        .criteria
        .iter()
        .enumerate()
        .map(|(c, criterion)| {
            let name = format!("{}_weight", criterion.column);
            Column::computed(
                name.into(),
                "-",
                "weight of the criterion",
                move |s: &RankedDesign<'a>| s.weights.values()[c].into(),
            )
        })
        .collect();
    columns.extend(design(parameters));
    columns.push(fitness("fitness of the best design for the weights of this row"));
    columns.push(share("fraction of all weights for which the design of this row is the best"));
    columns
}

/// Returns the columns of the number and the parameters of a design.
fn design<'a>(parameters: &[&'static Parameter]) -> RankedColumns<'a> {
    let mut columns = vec![number(|s: &RankedDesign<'a>| s.design().to_owned().into())];
    columns.extend(parameters.iter().map(|parameter| {
        Column::parameter(parameter, |s: &RankedDesign<'a>| {
            s.ranking.results.parameter(s.row(), parameter).into_owned().into()
        })
    }));
    columns
}

fn fitness<'a>(meaning: &'static str) -> Column<RankedDesign<'a>> {
    Column::new("fitness", "-", meaning, |s| s.fitness.into())
}

fn share<'a>(meaning: &'static str) -> Column<RankedDesign<'a>> {
    Column::new("share", "-", meaning, |s| s.share().into())
}

/// Returns the columns of the criteria as in `designs.csv`, except criteria that are parameters.
///
/// The columns of [`design`] already contain the parameters.
fn criteria<'a>(preferences: &Preferences) -> RankedColumns<'a> {
    preferences
        .criteria
        .iter()
        .enumerate()
        .filter(|(_, criterion)| results::columns::parameter_of(&criterion.column).is_none())
        .map(|(c, criterion)| {
            let (unit, meaning) = explain_value(&criterion.column).unwrap_or(("-", ""));
            let name = criterion.column.clone().into_owned();
            Column::computed(name.into(), unit, meaning, move |s: &RankedDesign<'a>| {
                s.value(c).into()
            })
        })
        .collect()
}

fn rescaled<'a>(preferences: &Preferences) -> RankedColumns<'a> {
    preferences
        .criteria
        .iter()
        .enumerate()
        .map(|(c, criterion)| {
            // Use `key`: the criterion of the column `penetration` is the resistance to
            // penetration.
            let name = format!("{}_rescaled", criterion.key());
            let meaning = "criterion from 0, the worst of all ranked designs, to 1, the best";
            Column::computed(name.into(), "-", meaning, move |s: &RankedDesign<'a>| {
                s.rescaled(c).into()
            })
        })
        .collect()
}

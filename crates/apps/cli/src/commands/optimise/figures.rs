//! Draws the figures of a search, and its best design.

use optimisation::{Answer, BestDesign, DesignGoal, Found, Judgement};
use ranking::Goal;
use report::{EVALUATION, Figure, SearchFigure, SearchedDesign};
use sweep::Measure;

use super::super::draw::draw_row;

/// Draws the history of the search, and the front or the best design.
///
/// If no design meets the requirements, draws only the history.
pub fn figures(goal: &DesignGoal, found: &Found) -> anyhow::Result<Vec<Figure>> {
    let mut figures = vec![history(goal, found)];
    match &found.answer {
        Answer::Optimum(best) => figures.push(optimum(goal, best)?),
        Answer::Front(front) => figures.push(self::front(goal, found, &front.designs)),
        Answer::Infeasible(_) => {}
    }
    Ok(figures)
}

/// Draws the best design at rest and, if the goal measures the puncture, at the critical tilt.
fn optimum(goal: &DesignGoal, best: &BestDesign) -> anyhow::Result<Figure> {
    let with_load = goal.space.sweep().measures().contains(&Measure::Puncture);
    let title = format!("{}: the best design", goal.name());
    let svg = draw_row(&title, &best.row.case, with_load)?;
    Ok(Figure::new("optimum", svg))
}

/// Lists the judged designs with their positions in a figure.
///
/// `position` computes the position from the index and the objectives of a design.
fn designs(found: &Found, position: impl Fn(usize, &[f64]) -> [f64; 2]) -> Vec<SearchedDesign> {
    found
        .history
        .iter()
        .enumerate()
        .filter_map(|(index, candidate)| match &candidate.verdict {
            Judgement::Judged(worth) => {
                Some(SearchedDesign { point: position(index, &worth.objectives), met: worth.met })
            }
            _ => None,
        })
        .collect()
}

/// Draws the first objective of every judged design, and a line through the successive best values.
fn history(goal: &DesignGoal, found: &Found) -> Figure {
    let designs = designs(found, |index, objectives| [(index + 1) as f64, objectives[0]]);
    let sign = if goal.objectives[0].goal == Goal::Maximize { 1.0 } else { -1.0 };
    let mut line: Vec<[f64; 2]> = Vec::new();
    for design in designs.iter().filter(|design| design.met) {
        if line.last().is_none_or(|best| sign * design.point[1] > sign * best[1]) {
            line.push(design.point);
        }
    }
    let title = format!("{}: the search", goal.name());
    let figure = SearchFigure {
        title: &title,
        axes: [EVALUATION, &goal.objectives[0].column],
        designs: &designs,
        line: &line,
        legend: "the best so far",
    };
    Figure::new("history", figure.svg())
}

/// Draws the first two objectives of every judged design, and a line through the front.
fn front(goal: &DesignGoal, found: &Found, front: &[BestDesign]) -> Figure {
    let designs = designs(found, |_, objectives| [objectives[0], objectives[1]]);
    let line: Vec<[f64; 2]> = front
        .iter()
        .filter_map(|best| match &best.candidate.verdict {
            Judgement::Judged(worth) => Some([worth.objectives[0], worth.objectives[1]]),
            _ => None,
        })
        .collect();
    let title = format!("{}: the front", goal.name());
    let figure = SearchFigure {
        title: &title,
        axes: [&goal.objectives[0].column, &goal.objectives[1].column],
        designs: &designs,
        line: &line,
        legend: "non-dominated designs",
    };
    Figure::new("front", figure.svg())
}

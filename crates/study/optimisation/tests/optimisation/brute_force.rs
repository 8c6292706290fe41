//! Compares the optima of searches with fine grids and dense sequences of designs.
//!
//! These tests run only in long campaigns (`SQUAMA_CAMPAIGNS`), because they evaluate tens of
//! thousands of designs, or a million with `SQUAMA_GRID=100`.

use std::path::Path;

use optimisation::{DesignGoal, Judge, Judgement, SpacePoint};
use ranking::Requirement;
use rayon::prelude::*;
use results::columns::{design_columns, measure_of};
use results::{Column, DesignRow};
use run::{Evaluator, Start};
use sweep::Measure;

use crate::searches::{found_in, objectives, optimum};

/// Number of points along each axis of a grid.
///
/// `SQUAMA_GRID` replaces this number for the grid over the whole space.
const POINTS: usize = 12;

/// Half-width of the grid around the optimum, as a fraction of the intervals.
const NEAR: f64 = 0.001;

/// Best of several points, and the number of feasible points.
#[derive(Clone, Debug)]
struct GridBest {
    /// Objective of the best point, to be maximised.
    objective: f64,
    /// Best point, as fractions of the intervals.
    fractions: Vec<f64>,
    /// Number of feasible points.
    met: usize,
}

impl GridBest {
    const NONE: Self = Self { objective: f64::NEG_INFINITY, fractions: Vec::new(), met: 0 };

    /// Returns the better of two points, and the sum of the numbers of feasible points.
    fn or(self, other: Self) -> Self {
        let met = self.met + other.met;
        let better = if other.objective > self.objective { other } else { self };
        Self { met, ..better }
    }
}

/// Returns the best point of a grid with `points` values along each of three variables.
///
/// `ranges` are the ends of the grid, as fractions of the intervals.
fn best_of_grid(goal: &DesignGoal, ranges: &[[f64; 2]], points: usize) -> GridBest {
    let axes: Vec<Vec<f64>> = ranges
        .iter()
        .map(|[from, to]| {
            (0..points).map(|k| from + (to - from) * k as f64 / (points - 1) as f64).collect()
        })
        .collect();
    // Each solver evaluates the designs of one gap, because its evaluators cache the springs, which
    // depend only on gap and length.
    axes[0]
        .par_iter()
        .map(|gap| {
            let solver = GoalSolver::new(goal);
            let mut best = GridBest::NONE;
            for length in &axes[1] {
                for slant in &axes[2] {
                    best = best.or(solver.best(vec![*gap, *length, *slant]));
                }
            }
            best
        })
        .reduce(|| GridBest::NONE, GridBest::or)
}

/// Returns the best of `count` points of a low-discrepancy sequence in `ranges`.
///
/// `ranges` are fractions of the intervals.
fn best_of_sequence(goal: &DesignGoal, ranges: &[[f64; 2]], count: usize) -> GridBest {
    const RATIO: f64 = 1.220_744_084_605_759_5;
    let solver = GoalSolver::new(goal);
    (0..count)
        .into_par_iter()
        .map(|k| {
            let fractions = ranges.iter().enumerate().map(|(j, [from, to])| {
                from + (to - from) * (0.137 + k as f64 * RATIO.powi(-(j as i32 + 1))).fract()
            });
            solver.best(fractions.collect())
        })
        .reduce(|| GridBest::NONE, GridBest::or)
}

/// Evaluator of some measures, and the requirements that depend only on these measures.
struct Stage {
    evaluator: Evaluator,
    bounds: Vec<(Requirement, Column<DesignRow>)>,
}

impl Stage {
    fn new(goal: &DesignGoal, measures: &[Measure]) -> Self {
        let mut bounds = Vec::new();
        for required in &goal.requirements {
            if measure_of(&required.column).is_none_or(|measure| measures.contains(&measure)) {
                let mut columns = design_columns(goal.space.sweep()).into_iter();
                let column = columns.find(|column| column.name == required.column);
                bounds.push((required.clone(), column.expect("a column")));
            }
        }
        Self { evaluator: Evaluator::new(measures), bounds }
    }
}

/// Evaluates points, the fastest measures first.
///
/// Puncture is the slowest measure, so it is only solved for designs that meet the requirements on
/// coverage and bending.
struct GoalSolver<'g> {
    goal: &'g DesignGoal,
    judge: Judge,
    stages: Vec<Stage>,
    whole: Evaluator,
}

impl<'g> GoalSolver<'g> {
    fn new(goal: &'g DesignGoal) -> Self {
        let stages = vec![
            Stage::new(goal, &[Measure::Coverage]),
            Stage::new(goal, &[Measure::Coverage, Measure::Flexure]),
        ];
        let whole = Evaluator::new(&Measure::USUAL);
        Self { goal, judge: Judge::new(goal), stages, whole }
    }

    /// Evaluates one point; returns `GridBest::NONE` if it is not feasible.
    fn best(&self, fractions: Vec<f64>) -> GridBest {
        let point = SpacePoint { fractions, chosen: Vec::new() };
        let case = self.goal.space.case(&point);
        let number = self.goal.space.sweep().grid().number(0);
        for Stage { evaluator, bounds } in &self.stages {
            let row = evaluator.solve(number, &case).row;
            if !bounds.iter().all(|(requirement, column)| {
                column.cell(&row).number().is_some_and(|value| requirement.is_met(value))
            }) {
                return GridBest::NONE;
            }
        }
        let Judgement::Judged(worth) = self.judge.verdict(&self.whole.solve(number, &case).row)
        else {
            return GridBest::NONE;
        };
        let objective = self.judge.sign(0) * worth.objectives[0];
        let best = GridBest { objective, fractions: point.fractions, met: 1 };
        if worth.met { best } else { GridBest::NONE }
    }
}

#[test]
fn no_grid_has_a_better_design_than_the_optimum() {
    if std::env::var_os("SQUAMA_CAMPAIGNS").is_none_or(|campaigns| campaigns != "long") {
        return;
    }
    let points = std::env::var("SQUAMA_GRID").ok().and_then(|text| text.parse().ok());
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let goal = DesignGoal::read(&root.join("sweeps/goals/strong-and-covered.toml"), &[]);
    let goal = goal.expect("a goal");
    let folder = tempfile::tempdir().expect("a folder");
    let found = found_in(folder.path(), &goal, 2, Start::New);
    let (best, fractions) = (optimum(&found), &optimum(&found).candidate.point.fractions);
    let optimum = objectives(best)[0];
    let near: Vec<[f64; 2]> =
        fractions.iter().map(|x| [(x - NEAR).max(0.0), (x + NEAR).min(1.0)]).collect();
    for (name, ranges) in [("round the optimum", near), ("everywhere", vec![[0.0, 1.0]; 3])] {
        let points = if name == "everywhere" { points.unwrap_or(POINTS) } else { POINTS };
        let best = best_of_grid(&goal, &ranges, points);
        let off = best.objective / optimum - 1.0;
        println!(
            "{name}: optimum {optimum} at {fractions:?}; {} feasible points, the best {} at {:?}, {off:+.2e}",
            best.met, best.objective, best.fractions
        );
        assert!(best.met > 0 && off <= 1e-6, "{name}: {off:+.2e}");
        assert!(name == "everywhere" || off > -1e-3, "{name}: {off:+.2e}");
    }
}

/// Objectives and requirements that were not used to tune the settings of the search.
const GOALS: [(&str, &str); 12] = [
    ("maximize = 'critical_force_N'", "'coverage >= 0.5', 'compliance >= 0.35'"),
    ("maximize = 'critical_force_N'", "'coverage >= 0.62', 'areal_mass_kg_m2 <= 0.8'"),
    ("maximize = 'critical_force_N'", "'coverage >= 0.72', 'compliance >= 0.25'"),
    ("maximize = 'critical_force_N'", "'coverage >= 0.8', 'compliance >= 0.15'"),
    ("maximize = 'critical_force_N'", "'coverage >= 0.85'"),
    ("maximize = 'compliance'", "'coverage >= 0.6', 'critical_force_N >= 0.8'"),
    ("minimize = 'areal_mass_kg_m2'", "'coverage >= 0.55', 'critical_force_N >= 0.5'"),
    ("minimize = 'bend_radius_mm'", "'coverage >= 0.65', 'critical_force_N >= 0.3'"),
    ("maximize = 'critical_force_N'", "'coverage >= 0.78', 'bend_radius_mm <= 60'"),
    ("minimize = 'penetration'", "'coverage >= 0.58', 'compliance >= 0.3'"),
    ("maximize = 'coverage'", "'critical_force_N >= 0.4', 'compliance >= 0.2'"),
    (
        "maximize = 'critical_force_N'",
        "'coverage >= 0.67', 'areal_mass_kg_m2 <= 0.85', 'bend_radius_mm <= 300'",
    ),
];

/// Tests that no design of a dense sequence is better than the optima of twelve goals.
///
/// `SQUAMA_CAMPAIGNS=endless` evaluates for each goal 50,000 designs in the whole space and 20,000
/// designs near the optimum. `SQUAMA_CAMPAIGNS=long` evaluates 4 % of these designs for every
/// second goal.
#[test]
fn no_design_beats_the_optima_of_twelve_goals() {
    let (part, each) = match std::env::var("SQUAMA_CAMPAIGNS").as_deref() {
        Ok("endless") => (1, 1),
        Ok("long") => (25, 2),
        _ => return,
    };
    let [in_box, near_optimum] = [50_000 / part, 20_000 / part];
    let mut beaten = Vec::new();
    for (k, (objective, required)) in GOALS.into_iter().enumerate().step_by(each) {
        let goals = [0, 1].map(|seed| {
            let text = format!(
                "name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n[variables]\n\
            gap_over_t = {{ from = 0.1, to = 1 }}\nlength_over_t = {{ from = 0.025, to = 1 }}\n\
            slant_deg = {{ from = 0, to = 75 }}\n[material]\nthickness_mm = 1\nsubstrate_modulus_MPa = 1\n\
            membrane_modulus_MPa = 4.5\nscale_density_kg_m3 = 1200\n[goal]\n{objective}\nrequire = [{required}]\nseed = {seed}"
            );
            DesignGoal::parse(&text, "x.toml", &[]).expect("a goal")
        });
        let sign = Judge::new(&goals[0]).sign(0);
        let found = goals.each_ref().map(|goal| {
            let folder = tempfile::tempdir().expect("a folder");
            let found = found_in(folder.path(), goal, 2, Start::New);
            let best = optimum(&found);
            (sign * objectives(best)[0], best.candidate.point.fractions.clone(), found.evaluations)
        });
        let [(one, fractions, evaluations), (other, ..)] = &found;
        let space = &goals[0].space;
        // The range of each variable extends by 5 % of its optimal value to both sides.
        let near: Vec<[f64; 2]> = space
            .intervals()
            .iter()
            .zip(fractions)
            .map(|(interval, fraction)| {
                let by = 0.05 * interval.value(*fraction) / interval.length();
                [(fraction - by).max(0.0), (fraction + by).min(1.0)]
            })
            .collect();
        let everywhere = best_of_sequence(&goals[0], &[[0.0, 1.0]; 3], in_box);
        let near = best_of_sequence(&goals[0], &near, near_optimum);
        let [everywhere_off, near_off, other_off] =
            [everywhere.objective, near.objective, *other].map(|value| (value - one) / one.abs());
        println!(
            "{k}: {objective} {required}: {one} at {fractions:?} after {evaluations}, seed 1 {other_off:+.1e}; {} of {in_box} feasible, best {everywhere_off:+.2e} at {:?}; {} of {near_optimum} near the optimum, best {near_off:+.2e}",
            everywhere.met, everywhere.fractions, near.met,
        );
        if everywhere_off > 1e-6 || near_off > 1e-6 || other_off.abs() > 1e-6 {
            beaten.push(k);
        }
    }
    assert!(beaten.is_empty(), "{beaten:?}");
}

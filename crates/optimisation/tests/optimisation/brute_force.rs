//! The optimum of the reference goal against grids so fine that nothing is missed. In a long campaign alone: tens of thousands of
//! designs are looked at, a million with `SQUAMA_GRID=100`.

use std::path::Path;

use optimisation::{DesignGoal, Judge, Judgement, SpacePoint};
use rayon::prelude::*;
use results::DesignRow;
use run::{Evaluator, Start};
use sweep::Measure;

use crate::searches::{found_in, objectives, optimum};

/// Points along each axis of a grid; `SQUAMA_GRID` says otherwise for that over the whole box.
const POINTS: usize = 24;

/// The half-width of the grid round the optimum, a share of the intervals.
const NEAR: f64 = 0.001;

/// The best of the points of a grid, and how many of them meet every requirement.
#[derive(Clone, Debug)]
struct GridBest {
    objective: f64,
    shares: Vec<f64>,
    met: usize,
}

impl GridBest {
    const NONE: Self = Self { objective: f64::NEG_INFINITY, shares: Vec::new(), met: 0 };

    fn or(self, other: Self) -> Self {
        let met = self.met + other.met;
        let better = if other.objective > self.objective { other } else { self };
        Self { met, ..better }
    }
}

/// The best point of the grid with `points` values from the first to the second share of each of three intervals.
fn best_of_grid(goal: &DesignGoal, ranges: &[[f64; 2]], points: usize) -> GridBest {
    let share = |j: usize, k: usize| {
        let [from, to] = ranges[j];
        from + (to - from) * k as f64 / (points - 1) as f64
    };
    // Designs of one gap and length share their springs, which an evaluator keeps.
    let of_gap = |gap: usize| {
        let solver = GridSolver::new(goal);
        let pairs = (0..points).flat_map(|length| (0..points).map(move |slant| [length, slant]));
        let found = pairs.map(|[length, slant]| {
            solver.best(vec![share(0, gap), share(1, length), share(2, slant)])
        });
        found.fold(GridBest::NONE, GridBest::or)
    };
    (0..points).into_par_iter().map(of_gap).reduce(|| GridBest::NONE, GridBest::or)
}

/// Solves points of a grid: the puncture, which takes the longest, of those alone that cover and bend well enough.
struct GridSolver<'g> {
    goal: &'g DesignGoal,
    judge: Judge,
    cover: Evaluator,
    cheap: Evaluator,
    whole: Evaluator,
}

impl<'g> GridSolver<'g> {
    fn new(goal: &'g DesignGoal) -> Self {
        let [cover, cheap, whole] =
            [&[Measure::Coverage][..], &[Measure::Coverage, Measure::Flexure], &Measure::USUAL]
                .map(Evaluator::new);
        Self { goal, judge: Judge::new(goal), cover, cheap, whole }
    }

    fn best(&self, shares: Vec<f64>) -> GridBest {
        let point = SpacePoint { shares, chosen: Vec::new() };
        let case = self.goal.space.case(&point);
        let number = self.goal.space.sweep().grid().number(0);
        let covers = covers(&self.cover.solve(number, &case).row);
        if !covers || !bends(&self.cheap.solve(number, &case).row) {
            return GridBest::NONE;
        }
        let Judgement::Judged(worth) = self.judge.verdict(&self.whole.solve(number, &case).row)
        else {
            return GridBest::NONE;
        };
        let best = GridBest { objective: worth.objectives[0], shares: point.shares, met: 1 };
        if worth.met { best } else { GridBest::NONE }
    }
}

fn covers(row: &DesignRow) -> bool {
    row.result.coverage.is_some_and(|coverage| coverage >= 0.5 - 1e-9)
}

fn bends(row: &DesignRow) -> bool {
    let compliance = row.result.flexure.and_then(|flexure| flexure.measures.compliance);
    compliance.is_some_and(|compliance| compliance >= 0.2 - 1e-9)
}

#[test]
fn no_grid_has_a_better_design_than_the_optimum() {
    if std::env::var_os("SQUAMA_CAMPAIGNS").is_none_or(|campaigns| campaigns != "long") {
        return;
    }
    let points = std::env::var("SQUAMA_GRID").ok().and_then(|text| text.parse().ok());
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let goal = DesignGoal::read(&root.join("sweeps/goals/strong-and-covered.toml"), &[]);
    let goal = goal.expect("a goal");
    let folder = tempfile::tempdir().expect("a folder");
    let found = found_in(folder.path(), &goal, 2, Start::New);
    let (best, shares) = (optimum(&found), &optimum(&found).candidate.point.shares);
    let optimum = objectives(best)[0];
    let near: Vec<[f64; 2]> =
        shares.iter().map(|x| [(x - NEAR).max(0.0), (x + NEAR).min(1.0)]).collect();
    for (name, ranges) in [("round the optimum", near), ("everywhere", vec![[0.0, 1.0]; 3])] {
        let points = if name == "everywhere" { points.unwrap_or(POINTS) } else { POINTS };
        let best = best_of_grid(&goal, &ranges, points);
        let off = best.objective / optimum - 1.0;
        println!(
            "{name}: optimum {optimum} at {shares:?}; {} points meet, the best {} at {:?}, {off:+.2e}",
            best.met, best.objective, best.shares
        );
        assert!(best.met > 0 && off <= 1e-6, "{name}: {off:+.2e}");
        assert!(name == "everywhere" || off > -1e-3, "{name}: {off:+.2e}");
    }
}

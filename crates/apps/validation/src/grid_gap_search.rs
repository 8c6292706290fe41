//! Searches between the grid points, compared with the 720 designs of the grid.

use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;

use anyhow::{Context as _, bail};
use optimisation::{
    Answer, BestDesign, DesignGoal, Found, Judgement, SearchOptions, SearchProgress,
};
use ranking::{CRITERIA, Ranking, TetrahedralGrid, Weights};
use run::{Program, Start};
use text::number;

use crate::claims::{digits, named};
use crate::page::lines;
use crate::study::{MeasuredDesign, Study};

/// Start of the definition of every search: the parameter ranges of the grid, and settings.
///
/// The searches leave out designs with a fold.
const BOX: &str = "name = \"between\"\nmeasures = [\"coverage\", \"puncture\", \"flexure\"]\n\
    [variables]\ngap_over_t = { from = 0.1, to = 1 }\nlength_over_t = { from = 0.025, to = 1 }\nslant_deg = { from = 0, to = 75 }\n\
    [goal]\nsamples = 256\n";

/// Objectives and requirement of the front that is compared with the grid.
// Four points suffice to equal or dominate every design of the grid.
const FRONT: &str = "maximize = [\"critical_force\", \"coverage\"]\nrequire = [\"compliance >= 0.2\"]\npoints = 4\n";
/// The compliance that [`FRONT`] requires.
const LEAST_COMPLIANCE: f64 = 0.2;

/// Error of a search without a result.
const NO_OPTIMUM: &str = "a search between the grid points has no optimum";

/// The best designs on the grid and between its points.
#[derive(Clone, Debug)]
pub struct GridGapSearch {
    /// The fittest design for each of several weights.
    pub fittest: Vec<FittestDesign>,
    /// The front of critical force and coverage.
    pub front: FrontOverGrid,
}

/// The fittest design for some weights, on the grid and between its points.
#[derive(Clone, Debug)]
pub struct FittestDesign {
    /// The weights in words.
    pub weights: String,
    /// The fittest design on the grid.
    pub on_grid: String,
    /// Fitness of the design on the grid.
    pub grid_fitness: f64,
    /// The design found by the search.
    pub found: String,
    /// Fitness of the design found, with criteria scaled so that the best grid value is 1.
    pub found_fitness: f64,
}

/// A front compared with the designs of the grid.
#[derive(Clone, Debug)]
pub struct FrontOverGrid {
    /// Number of designs on the front.
    pub designs: usize,
    /// The number of grid designs without a fold and with the required compliance.
    pub grid: usize,
    /// The number of grid designs, of those in `grid`, that no other grid design dominates.
    pub grid_front: usize,
    /// The number of grid designs, of those in `grid`, that the front neither equals nor dominates.
    pub undominated: usize,
}

impl GridGapSearch {
    /// Searches within the parameter ranges of the grid of `study`.
    ///
    /// # Errors
    /// If the grid cannot be ranked or the temporary folder cannot be written.
    pub(crate) fn run(study: &Study) -> anyhow::Result<Self> {
        let rows: Vec<usize> =
            (0..study.designs.len()).filter(|&row| is_sound(&study.designs[row])).collect();
        let sound = study.results.only(&rows);
        let ranking = Ranking::new(&sound, TetrahedralGrid::default())?;
        let ends = ends(&ranking);
        let alone = Weights::alone().zip(CRITERIA.iter().map(|criterion| criterion.name.as_ref()));
        let weights = alone.chain([(Weights::BALANCED, "all four equal")]);
        let fittest = weights.map(|weights| {
            let winner = ranking.winner(weights.0);
            // The rows of the ranking are indices into the designs without a fold.
            let on_grid = named(&study.designs[rows[winner.row()]]);
            fittest(weights, &ends, (winner.fitness, on_grid))
        });
        Ok(Self { fittest: fittest.collect::<Result<_, _>>()?, front: FrontOverGrid::run(study)? })
    }

    /// Returns the parts of the page in Markdown, by their names.
    pub(crate) fn parts(&self) -> [(&'static str, String); 2] {
        let FrontOverGrid { designs, grid, grid_front, undominated } = self.front;
        let front = format!(
            "The Pareto front of critical force and coverage, with a compliance of at least \
             {LEAST_COMPLIANCE}, has\n{designs} designs. {grid} designs of the grid have no fold \
             and this compliance; {grid_front} of them are on\ntheir own Pareto front. Designs of the \
             grid that the front of the search\nneither equals nor dominates: {undominated}."
        );
        [("between", lines(&self.fittest, FittestDesign::row)), ("front", front)]
    }
}

impl FittestDesign {
    /// Returns the relative gain in fitness, compared with the best grid design.
    pub fn gain(&self) -> f64 {
        self.found_fitness / self.grid_fitness - 1.0
    }

    /// Returns the row of the table in Markdown.
    fn row(&self) -> String {
        format!(
            "| {} | {} | {} | {} | {} | {:+.1} % |",
            self.weights,
            self.on_grid,
            digits(self.grid_fitness),
            self.found,
            digits(self.found_fitness),
            100.0 * self.gain() + 0.0
        )
    }
}

impl FrontOverGrid {
    fn run(study: &Study) -> anyhow::Result<Self> {
        let found = search(&format!("{BOX}{FRONT}"))?;
        let Answer::Front(front) = &found.answer else { bail!(NO_OPTIMUM) };
        let front: Vec<&[f64]> = front.designs.iter().filter_map(objectives).collect();
        let sound = study.designs.iter().filter(|design| is_sound(design));
        let grid: Vec<[f64; 2]> = sound
            .filter(|d| d.compliance.is_some_and(|c| c >= LEAST_COMPLIANCE))
            .filter_map(|d| Some([d.critical_force?, d.coverage?]))
            .collect();
        let dominated = grid.iter().filter(|a| grid.iter().any(|b| b != *a && at_least(b, *a)));
        Ok(Self {
            designs: front.len(),
            grid: grid.len(),
            grid_front: grid.len() - dominated.count(),
            undominated: grid.iter().filter(|a| !front.iter().any(|b| at_least(b, *a))).count(),
        })
    }
}

/// Returns the values of the objectives of a design.
fn objectives(best: &BestDesign) -> Option<&[f64]> {
    match &best.candidate.verdict {
        Judgement::Judged(worth) => Some(&worth.objectives),
        _ => None,
    }
}

/// Returns true if `one` is at least as good as `other` in both objectives, up to round-off.
fn at_least(one: &[f64], other: &[f64]) -> bool {
    // The values of a design on the grid and in the search differ by the round-off of their paths.
    one.iter().zip(other).all(|(a, b)| *a >= b * (1.0 - 1e-9))
}

/// Returns true if the surface does not fold.
fn is_sound(design: &MeasuredDesign) -> bool {
    design.fold_force.is_none() && design.gap_stretch_min.is_none_or(|least| least > 0.0)
}

/// Formats the worst and best value of each criterion in a ranking as the key `rescale` of a goal.
fn ends(ranking: &Ranking<'_>) -> String {
    let designs: Vec<_> = ranking.by_fitness(Weights::BALANCED).collect();
    // The key has values of columns instead of criteria, because the goal inverts the penetration.
    let ends = CRITERIA.iter().enumerate().map(|(c, criterion)| {
        let worst = designs.iter().min_by(|a, b| a.criterion(c).total_cmp(&b.criterion(c)));
        let best = designs.iter().max_by(|a, b| a.criterion(c).total_cmp(&b.criterion(c)));
        let [worst, best] = [worst, best]
            .map(|design| number::text(design.map_or(f64::NAN, |design| design.value(c))));
        format!("{} = [{worst}, {best}]", criterion.column)
    });
    format!("{{ {} }}", ends.collect::<Vec<_>>().join(", "))
}

/// Searches for the fittest design for `weights` between the grid points.
///
/// `ends` is the text from [`ends()`]. The last argument is the best fitness on the grid, with its
/// design.
fn fittest(
    weights: (Weights, &str),
    ends: &str,
    (grid_fitness, on_grid): (f64, String),
) -> anyhow::Result<FittestDesign> {
    let (weights, name) = weights;
    let weighted = CRITERIA.iter().zip(weights.values());
    let weighted: Vec<_> =
        weighted.map(|(c, weight)| format!("{} = {}", c.column, number::text(*weight))).collect();
    // Require coverage, because the ranking of the grid leaves out designs without it.
    let found = search(&format!(
        "{BOX}maximize = \"fitness\"\nrequire = \"coverage > 0\"\nweights = {{ {} }}\nrescale = {ends}\n",
        weighted.join(", ")
    ))?;
    let Answer::Optimum(best) = &found.answer else { bail!(NO_OPTIMUM) };
    let design = best.row.case.design;
    let [gap, length, slant] =
        [design.gap, design.length, design.slant_deg].map(|value| number::rounded(value, 3));
    Ok(FittestDesign {
        weights: name.to_owned(),
        on_grid,
        grid_fitness,
        found: format!("({gap}, {length}, {slant}°)"),
        found_fitness: objectives(best).context(NO_OPTIMUM)?[0],
    })
}

fn search(goal: &str) -> anyhow::Result<Found> {
    let goal = DesignGoal::parse(goal, "between", &[])?;
    let (folder, stop) =
        (tempfile::tempdir().context("no temporary folder")?, AtomicBool::new(false));
    let threads = available_parallelism().map_or(1, usize::from);
    let meter = SearchProgress::default();
    let options = SearchOptions { threads, start: Start::New, stop: &stop, progress: &meter };
    // The revision is omitted because the folder is temporary.
    let program = Program { version: env!("CARGO_PKG_VERSION"), revision: "" };
    let found = optimisation::optimise(&goal, folder.path(), &options, &program)?;
    found.context(NO_OPTIMUM)
}

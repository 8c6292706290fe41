//! Tests of the fitness as an objective: optimum in closed form, and derivatives.

use optimisation::{Judge, Judgement, SpacePoint};
use run::{Evaluator, Start};
use sweep::Measure;

use crate::searches::{found_in, goal, objectives, optimum};

/// Keys of a goal that maximises the fitness of coverage and mass. Both criteria are rescaled
/// between given worst and best values.
const FITNESS: &str = "maximize = 'fitness'\nweights = { coverage = 1, areal_mass_kg_m2 = 3 }\n\
    rescale = { coverage = [0.1, 0.9], areal_mass_kg_m2 = [1, 0.5] }";

#[test]
fn optimum_of_the_fitness_matches_the_closed_form() {
    let goal = goal(FITNESS);
    let folder = tempfile::tempdir().expect("a folder");
    let found = found_in(folder.path(), &goal, 1, Start::New);
    let best = optimum(&found);
    // At 60° the coverage is λ = (S − d)/S. The mass is m = 1/(1 + d), and its inverse 1 + d is
    // rescaled between 1 and 2.
    let reach = 60_f64.to_radians().tan();
    let fittest = (100..=1000)
        .map(|k| {
            let d = f64::from(k) * 1e-3;
            (((reach - d) / reach - 0.1) / 0.8).powf(0.25) * d.powf(0.75)
        })
        .fold(0.0, f64::max);
    assert!((objectives(best)[0] / fittest - 1.0).abs() < 1e-6, "{:?}", objectives(best));
    assert_eq!(found.rescaled, goal.fitness.expect("a fitness").ends);
}

#[test]
fn missing_worst_and_best_values_are_taken_from_the_space_filling_points() {
    let (first, _) = FITNESS.rsplit_once('\n').expect("several lines");
    let goal = goal(first);
    let folder = tempfile::tempdir().expect("a folder");
    let found = found_in(folder.path(), &goal, 1, Start::New);
    let ends: Vec<(f64, f64)> = found.rescaled.iter().map(|e| (e.worst, e.best)).collect();
    // The space-filling points include the corners of the space. The corner with a gap of 0.1 and a
    // slant of 60° nearly has the largest coverage. The smallest and the largest mass are at the
    // ends of the gap.
    let reach = 60_f64.to_radians().tan();
    assert!(ends[0].0 > 0.0 && ends[0].1 >= (reach - 0.1) / reach - 0.1, "{ends:?}");
    assert_eq!(ends[1], (1.0 / 1.1, 0.5));
    assert!(objectives(optimum(&found))[0] > 0.5);
}

#[test]
fn derivatives_of_the_fitness_match_finite_differences() {
    let text = "name = 'x'\n[variables]\ngap_over_t = { from = 0.2, to = 0.6 }\nlength_over_t = { from = 0.3, to = 1 }\n\
        slant_deg = { from = 35, to = 75 }\n[goal]\nmaximize = 'fitness'\n\
        rescale = { coverage = [0, 0.9], critical_force = [0, 3], penetration = [1, 0.01], compliance = [0, 0.9] }";
    let goal = optimisation::DesignGoal::parse(text, "x.toml", &[]).expect("a goal");
    let judge = Judge::new(&goal);
    let number = goal.space.sweep().grid().number(0);
    let (all, plain) = (Evaluator::new(&Measure::ALL), Evaluator::new(&Measure::USUAL));
    let point = SpacePoint { fractions: vec![0.31, 0.57, 0.43], chosen: Vec::new() };
    let row = all.solve(number, &goal.space.case(&point)).row;
    for (j, interval) in goal.space.intervals().iter().enumerate() {
        let step = 1e-4;
        let [below, above] = [-step, step].map(|by| {
            let mut moved = point.clone();
            moved.fractions[j] += by;
            let row = plain.solve(number, &goal.space.case(&moved)).row;
            let Judgement::Judged(worth) = judge.verdict(&row) else { panic!("a valid judgement") };
            worth.objectives[0]
        });
        let difference = (above - below) / (2.0 * step * interval.length());
        let slope = judge
            .objective_slope(0, &row, interval.parameter)
            .expect("a derivative without a kink");
        let key = interval.parameter.key;
        assert!(
            (slope - difference).abs() < 1e-4 * difference.abs(),
            "{key}: {slope} {difference}"
        );
    }
}

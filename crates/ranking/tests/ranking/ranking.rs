//! The best designs of a run.

use proptest::prelude::*;
use ranking::{RankedDesign, Ranking, TetrahedralGrid, Weights, write_ranking};
use results::Results;
use tempfile::TempDir;

use crate::samples::{Criteria, write_results};

const HEADER: &str =
    "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,compliance";

/// The results of a run with these values of the four criteria.
fn results(rows: &[&str]) -> Results {
    let folder = TempDir::new().expect("a folder");
    let row = |(i, values): (usize, &&str)| format!("\n{:04},0.1,{},45,{values}", i + 1, i + 1);
    let rows: String = rows.iter().enumerate().map(row).collect();
    std::fs::write(folder.path().join("designs.csv"), format!("{HEADER}{rows}")).expect("writable");
    Results::read(folder.path()).expect("results")
}

fn grid(resolution: &str) -> TetrahedralGrid {
    resolution.parse().expect("a resolution")
}

fn weights(text: &str) -> Weights {
    text.parse().expect("weights")
}

fn order(ranking: &Ranking<'_>, by: &str) -> String {
    let standings = ranking.by_fitness(weights(by));
    standings.iter().map(RankedDesign::design).collect::<Vec<_>>().join(" ")
}

#[test]
fn fitness_is_the_product_of_rescaled_criteria() {
    let results = results(&["0.2,1,0.5,10", "0.6,5,0.25,20", "1,3,0.2,40"]);
    let ranking = Ranking::new(&results, grid("4")).expect("a ranking");
    let second = ranking.by_fitness(weights("0.4,0.3,0.2,0.1"))[1];
    // Rescaled: 0.5, 1, (4 - 2)/(5 - 2), (20 - 10)/(40 - 10).
    assert_eq!(second.design(), "0002");
    let expected = 0.5_f64.powf(0.4) * (2.0_f64 / 3.0).powf(0.2) * (1.0_f64 / 3.0).powf(0.1);
    assert!((second.fitness - expected).abs() < 1e-14, "{}", second.fitness);
    assert_eq!(order(&ranking, "0.4,0.3,0.2,0.1"), "0003 0002 0001");
    assert_eq!(order(&ranking, "0,1,0,0"), "0002 0003 0001");
}

#[test]
fn equal_designs_stand_in_the_order_of_their_numbers() {
    let results = results(&["0.5,1,1,1", "0.9,3,1,1", "0.7,3,1,1", "0.9,2,1,1"]);
    let ranking = Ranking::new(&results, grid("1")).expect("a ranking");
    // Equal coverage, no weight on anything else.
    assert_eq!(order(&ranking, "1,0,0,0"), "0002 0004 0003 0001");
    assert_eq!(order(&ranking, "0,1,0,0"), "0002 0003 0004 0001");
    // Penetration and compliance tell nothing apart.
    assert_eq!(ranking.ties(), [2, 3]);
    assert_eq!(order(&ranking, "0,0,0.5,0.5"), "0001 0002 0003 0004");
}

#[test]
fn designs_without_coverage_or_without_a_value_are_left_out() {
    let results =
        results(&["0,,,", "0.5,,1,1", "0.5,1,,1", "0.5,1,0,1", "0.5,1,1,", ",1,1,1", "1,1,1,1"]);
    let ranking = Ranking::new(&results, grid("1")).expect("a ranking");
    assert_eq!(order(&ranking, "0.25,0.25,0.25,0.25"), "0007");
    let left_out = ranking.left_out().iter().map(|(why, count)| format!("{count}: {why}\n"));
    insta::assert_snapshot!(left_out.collect::<String>(), @r"
    1: coverage is 0
    1: no coverage
    1: no critical_force
    1: no penetration
    1: no compliance
    1: penetration is not above 0
    ");
}

#[test]
fn one_design_alone_is_the_best() {
    let results = results(&["0.5,1,1,1"]);
    let ranking = Ranking::new(&results, grid("2")).expect("a ranking");
    let best = ranking.winner(Weights::BALANCED);
    assert_eq!(
        (best.fitness.to_bits(), best.share().to_bits()),
        (1.0_f64.to_bits(), 1.0_f64.to_bits())
    );
    assert!(best.on_front());
}

#[test]
fn without_a_design_there_is_no_ranking() {
    let message = |rows: &[&str]| {
        let results = results(rows);
        let message = Ranking::new(&results, grid("2")).expect_err("none").to_string();
        message.replace(&results.folder().display().to_string(), "x")
    };
    insta::assert_snapshot!(message(&["0,1,1,1", "0.5,1,1,", "0,,,"]), @"x/designs.csv: no design can be ranked (2: coverage is 0; 1: no compliance), expected one with all of coverage, critical_force, penetration, compliance");
    insta::assert_snapshot!(message(&["0.5,one,1,1"]), @r#"x/designs.csv: design 0001: critical_force: "one" is not accepted, expected a number"#);
}

#[test]
fn results_that_are_none_say_why() {
    let folder = TempDir::new().expect("a folder");
    let message = |table: Option<&str>| {
        if let Some(table) = table {
            std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
        }
        let message = Results::read(folder.path()).expect_err("none").to_string();
        message.replace(&folder.path().display().to_string(), "x")
    };
    insta::assert_snapshot!(message(None), @"x/designs.csv: cannot be read (No such file or directory), expected the file that squama run writes");
    insta::assert_snapshot!(message(Some("")), @r#"x/designs.csv: the first column is "", expected design"#);
    insta::assert_snapshot!(message(Some("a,b\n1,2")), @r#"x/designs.csv: the first column is "a", expected design"#);
    insta::assert_snapshot!(message(Some("design,b\n1,2\n3")), @"x/designs.csv: cannot be read (line 3 has 1 cells, the first one 2), expected the table that squama run writes");
}

#[test]
fn the_tables_of_a_ranking() {
    let folder = TempDir::new().expect("a folder");
    write_results(folder.path(), 4, Criteria::Independent, 0);
    let results = Results::read(folder.path()).expect("results");
    let ranking = Ranking::new(&results, grid("5")).expect("a ranking");
    let files = write_ranking(folder.path(), &ranking, Weights::BALANCED).expect("writable");
    let table = |file: &str| std::fs::read_to_string(folder.path().join(file)).expect("a table");
    let headers =
        files.map(|file| format!("{file}: {}\n", table(file).lines().next().expect("a header")));
    insta::assert_snapshot!(headers.concat());
    // Three of four slants have no coverage.
    assert_eq!(table("ranking.csv").lines().count(), 1 + 2500);
    assert_eq!(table("quaternary.csv").lines().count(), 1 + 56);
    assert_eq!(table("pareto.csv").lines().count(), 1 + ranking.front().len());
    assert_eq!(table("winners.csv").lines().count(), 1 + ranking.winners().len());
}

#[test]
fn whoever_wins_at_some_weights_is_first_in_the_ranking_by_them() {
    let folder = TempDir::new().expect("a folder");
    write_results(folder.path(), 4, Criteria::Conflicting, 0);
    let results = Results::read(folder.path()).expect("results");
    let ranking = Ranking::new(&results, grid("6")).expect("a ranking");
    for winner in ranking.quaternary() {
        let first = ranking.by_fitness(winner.weights)[0];
        assert_eq!(
            (winner.design(), winner.fitness.to_bits()),
            (first.design(), first.fitness.to_bits())
        );
    }
}

proptest! {
    #[test]
    fn shares_sum_to_one(
        rows in prop::collection::vec(prop::array::uniform4(1_u32..9), 1..30),
        resolution in 1_u32..9,
    ) {
        let rows: Vec<_> = rows.iter().map(|[a, b, c, d]| format!("{a},{b},{c},{d}")).collect();
        let results = results(&rows.iter().map(String::as_str).collect::<Vec<_>>());
        let ranking = Ranking::new(&results, grid(&resolution.to_string())).expect("a ranking");
        let sum: f64 = ranking.winners().iter().map(RankedDesign::share).sum();
        prop_assert!((sum - 1.0).abs() < 1e-12, "{sum}");
    }
}

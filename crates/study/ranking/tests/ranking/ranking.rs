//! Tests of the ranking of the designs of a run.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use proptest::prelude::*;
use ranking::{
    Criterion, Goal, InvalidRanking, Preferences, RankedDesign, Ranking, Scale, TetrahedralGrid,
    UnmetRequirement, Weights, check_comparable, comparable_groups, write_ranking, write_unmet,
};
use results::{Completeness, Results, VerifiedFolder};
use tempfile::TempDir;

use crate::samples::{Criteria, write_results};

const HEADER: &str =
    "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,compliance";

/// Returns results with one design per row, each row with the values of the four criteria.
fn results(rows: &[&str]) -> Results {
    let folder = TempDir::new().expect("a folder");
    let mut table = HEADER.to_owned();
    for (i, values) in rows.iter().enumerate() {
        let _ = write!(table, "\n{:04},0.1,{},45,{values}", i + 1, i + 1);
    }
    std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
    Results::read(folder.path()).expect("results")
}

fn grid(resolution: &str) -> TetrahedralGrid {
    resolution.parse().expect("a resolution")
}

fn weights(text: &str) -> Weights {
    text.parse().expect("weights")
}

fn order(ranking: &Ranking<'_>, by: &str) -> String {
    let ranked = ranking.by_fitness(weights(by));
    ranked.map(|design| design.design()).collect::<Vec<_>>().join(" ")
}

#[test]
fn fitness_is_the_product_of_rescaled_criteria() {
    let results = results(&["0.2,1,0.5,10", "0.6,5,0.25,20", "1,3,0.2,40"]);
    let ranking = Ranking::new(&results, grid("4")).expect("a ranking");
    let second = ranking.by_fitness(weights("0.4,0.3,0.2,0.1")).nth(1).expect("two designs");
    // Rescaled criteria of 0002: 0.5, 1, (4 - 2)/(5 - 2), (20 - 10)/(40 - 10).
    assert_eq!(second.design(), "0002");
    let expected = 0.5_f64.powf(0.4) * (2.0_f64 / 3.0).powf(0.2) * (1.0_f64 / 3.0).powf(0.1);
    assert!((second.fitness - expected).abs() < 1e-14, "{}", second.fitness);
    assert_eq!(order(&ranking, "0.4,0.3,0.2,0.1"), "0003 0002 0001");
    assert_eq!(order(&ranking, "0,1,0,0"), "0002 0003 0001");
}

#[test]
fn equal_designs_are_ordered_by_number() {
    let results = results(&["0.5,1,1,1", "0.9,3,1,1", "0.7,3,1,1", "0.9,2,1,1"]);
    let ranking = Ranking::new(&results, grid("1")).expect("a ranking");
    // Designs 2 and 4 have equal coverage, and only coverage has a weight.
    assert_eq!(order(&ranking, "1,0,0,0"), "0002 0004 0003 0001");
    assert_eq!(order(&ranking, "0,1,0,0"), "0002 0003 0004 0001");
    // Penetration and compliance are equal for all designs.
    assert_eq!(ranking.ties(), [2, 3]);
    assert_eq!(order(&ranking, "0,0,0.5,0.5"), "0001 0002 0003 0004");
}

#[test]
fn designs_without_coverage_or_without_a_value_are_excluded() {
    let results =
        results(&["0,,,", "0.5,,1,1", "0.5,1,,1", "0.5,1,0,1", "0.5,1,1,", ",1,1,1", "1,1,1,1"]);
    let ranking = Ranking::new(&results, grid("1")).expect("a ranking");
    assert_eq!(order(&ranking, "0.25,0.25,0.25,0.25"), "0007");
    let exclusions = ranking.exclusions().iter().map(|(why, count)| format!("{count}: {why}\n"));
    insta::assert_snapshot!(exclusions.collect::<String>(), @r"
    1: coverage is 0
    1: no coverage
    1: no critical_force
    1: no penetration
    1: no compliance
    1: penetration is not above 0
    ");
}

#[test]
fn a_single_design_is_the_best() {
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
fn rankings_without_designs_are_refused() {
    let message = |rows: &[&str]| {
        let results = results(rows);
        let message = Ranking::new(&results, grid("2")).expect_err("refused").to_string();
        message.replace(&results.folder().display().to_string(), "x")
    };
    insta::assert_snapshot!(message(&["0,1,1,1", "0.5,1,1,", "0,,,"]), @"x/designs.csv: no design can be ranked (2: coverage is 0; 1: no compliance), expected one with all of coverage, critical_force, penetration, compliance");
    insta::assert_snapshot!(message(&["0.5,one,1,1"]), @r#"x/designs.csv: design 0001: critical_force: "one" is not accepted, expected a number"#);
}

#[test]
fn invalid_tables_are_refused_with_a_reason() {
    let folder = TempDir::new().expect("a folder");
    let message = |table: Option<&str>| {
        if let Some(table) = table {
            std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
        }
        let message = Results::read(folder.path()).expect_err("refused").to_string();
        message.replace(&folder.path().display().to_string(), "x")
    };
    insta::assert_snapshot!(message(None), @"x/designs.csv: cannot be read (No such file or directory), expected the file that squama run writes");
    insta::assert_snapshot!(message(Some("")), @r#"x/designs.csv: the first column is "", expected design"#);
    insta::assert_snapshot!(message(Some("a,b\n1,2")), @r#"x/designs.csv: the first column is "a", expected design"#);
    insta::assert_snapshot!(message(Some("\"a\nb\",c\n1,2")), @r#"x/designs.csv: the first column is "a\nb", expected design"#);
    insta::assert_snapshot!(message(Some("design,b\n1,2\n3")), @"x/designs.csv: cannot be read (line 3 has 1 cells, the first one 2), expected the table that squama run writes");
}

#[test]
fn headers_of_ranking_tables_match_the_snapshot() {
    let folder = TempDir::new().expect("a folder");
    write_results(folder.path(), 4, Criteria::Independent, 0);
    let results = Results::read(folder.path()).expect("results");
    let ranking = Ranking::new(&results, grid("5")).expect("a ranking");
    let (files, _) = write_ranking(folder.path(), &ranking).expect("writable");
    let table = |file: &str| std::fs::read_to_string(folder.path().join(file)).expect("a table");
    let headers = files.iter().filter(|file| **file != "ranking.toml");
    let headers =
        headers.map(|file| format!("{file}: {}\n", table(file).lines().next().expect("a header")));
    insta::assert_snapshot!(headers.collect::<String>());
    // The coverage is 0 for three of the four slants.
    assert_eq!(table("ranking.csv").lines().count(), 1 + 2500);
    assert_eq!(table("quaternary.csv").lines().count(), 1 + 56);
    assert_eq!(table("pareto.csv").lines().count(), 1 + ranking.front().len());
    assert_eq!(table("winners.csv").lines().count(), 1 + ranking.winners().len());
}

#[test]
fn winners_of_nodes_are_first_in_the_ranking_with_their_weights() {
    let folder = TempDir::new().expect("a folder");
    write_results(folder.path(), 4, Criteria::Conflicting, 0);
    let results = Results::read(folder.path()).expect("results");
    let ranking = Ranking::new(&results, grid("6")).expect("a ranking");
    for winner in ranking.quaternary() {
        let first = ranking.by_fitness(winner.weights).next().expect("a design");
        assert_eq!(
            (winner.design(), winner.fitness.to_bits()),
            (first.design(), first.fitness.to_bits())
        );
    }
}

/// Ranks `results` by preferences in TOML.
fn by<'r>(results: &'r Results, text: &str) -> Result<Ranking<'r>, InvalidRanking> {
    let preferences = Preferences::parse(text, "x.toml").expect("preferences");
    Ranking::by(results, preferences, grid("2"))
}

#[test]
fn only_designs_that_meet_every_requirement_are_ranked() {
    let results = results(&["0.2,1,0.5,10", "0.6,5,0.25,20", "1,3,0.2,40", "0.7,,0.1,50"]);
    let text = "requirements = ['coverage >= 0.6', 'critical_force < 4']";
    let ranking = by(&results, text).expect("a ranking");
    let order = ranking.by_fitness(Weights::BALANCED);
    assert_eq!(order.map(|design| design.design()).collect::<Vec<_>>(), ["0003"]);
    let exclusions: Vec<_> =
        ranking.exclusions().iter().map(|(why, n)| format!("{n} {why}")).collect();
    // A missing value meets no requirement.
    assert_eq!(exclusions, ["1 not coverage >= 0.6", "2 not critical_force < 4"]);
}

#[test]
fn unmet_requirements_report_the_nearest_design_and_binding_requirements() {
    let results = results(&["0.5,1,1,1", "0.8,2,1,1", "0.9,1.5,1,1"]);
    let text = "requirements = ['coverage >= 0.9', 'critical_force >= 2']";
    let Err(InvalidRanking::Unmet(unmet)) = by(&results, text) else { panic!("none meets both") };
    // Relative shortfalls: coverage of 0002 by 1/9, force of 0003 by 1/4.
    assert_eq!(unmet.nearest, Some(1));
    let [coverage, force] = unmet.requirements.as_slice() else { panic!("two requirements") };
    assert!((coverage.shortfall - 1.0 / 9.0).abs() < 1e-12 && force.shortfall == 0.0);
    assert_eq!((coverage.met, coverage.met_without, force.met, force.met_without), (1, 1, 1, 1));
    assert!(coverage.binds() && force.binds());

    let text = "requirements = ['coverage >= 2', 'critical_force >= 1']";
    let Err(InvalidRanking::Unmet(unmet)) = by(&results, text) else { panic!("none meets both") };
    assert_eq!(unmet.nearest, Some(2));
    assert_eq!(
        unmet.requirements.iter().map(UnmetRequirement::binds).collect::<Vec<_>>(),
        [true, false]
    );
}

#[test]
fn any_column_can_be_a_criterion() {
    let results = results(&["0.2,1,0.5,10", "0.6,5,0.25,20", "1,3,0.2,40", "0,9,9,9"]);
    let text = "criteria = ['max:critical_force', 'min:length_over_t']\nweights = [3, 1]";
    let ranking = by(&results, text).expect("a ranking");
    // The `length_over_t` of a design equals its number. The design with a coverage of 0 is ranked,
    // because coverage is not a criterion.
    assert_eq!(ranking.len(), 4);
    let winner = ranking.winner(ranking.preferences().weights);
    // Rescaled criteria of 0001: (1 - 1)/8 and 1; of 0002: (5 - 1)/8 and (1/2 - 1/4)/(1 - 1/4).
    assert_eq!((winner.design(), winner.rescaled(0)), ("0002", 0.5));
    assert!((winner.fitness - 0.5_f64.powf(0.75) * (1.0_f64 / 3.0).powf(0.25)).abs() < 1e-12);
    assert!(ranking.winners().is_empty(), "two criteria have no grid of weights");
    let front: Vec<_> = ranking.front().iter().map(RankedDesign::design).collect();
    assert_eq!(front, ["0001", "0002", "0004"]);
    // Sums of rescaled criteria on the front: 0 + 1, 0.5 + 1/3, 1 + 0. The first of equals counts.
    assert_eq!(ranking.knee().expect("a knee").design(), "0001");
}

#[test]
fn the_knee_has_the_largest_sum_of_rescaled_criteria() {
    let rows = ["0.1,10,1,1", "0.9,9,1,1", "0.95,5,1,1", "1,1,1,1"];
    let results = results(&rows);
    let ranking = by(&results, "criteria = ['coverage', 'critical_force']").expect("a ranking");
    assert_eq!(ranking.front().len(), 4);
    assert_eq!(ranking.knee().expect("a knee").design(), "0002");
}

#[test]
fn a_weighted_mean_compensates_the_worst_criterion() {
    let results = results(&["1,1,1,1", "0.9,100,1,10", "0.8,1000,1,100"]);
    let criteria = "criteria = ['coverage', 'critical_force']\nscale = ";
    let [paper, linear, log] = ["paper", "linear", "log"].map(|scale| {
        let ranking = by(&results, &format!("{criteria}'{scale}'")).expect("a ranking");
        let mut ranked: Vec<_> = ranking.by_fitness(ranking.preferences().weights).collect();
        ranked.sort_by_key(RankedDesign::row);
        ranked.iter().map(|design| design.fitness).collect::<Vec<_>>()
    });
    assert_eq!(paper[0], 0.0);
    for (found, expected) in [
        (linear[0], 0.5),
        (linear[1], 0.5 * (0.5 + 99.0 / 999.0)),
        (log[1], 0.5 * ((0.9_f64 / 0.8).ln() / (1.0_f64 / 0.8).ln() + 2.0 / 3.0)),
    ] {
        assert!((found - expected).abs() < 1e-12, "{found}");
    }
}

#[test]
fn designs_equal_up_to_round_off_share_their_rank() {
    let results =
        results(&["0.5,1,1,0.7999999999", "0.5,1,1,0.8", "0.5,1,1,0.5", "0.5,1,1,0.80000000001"]);
    let ranking = by(&results, "criteria = ['compliance']").expect("a ranking");
    let ranks = ranking.by_fitness(Weights::equal(1));
    let ranks: Vec<_> = ranks.map(|design| (design.rank, design.design())).collect();
    assert_eq!(ranks, [(1, "0001"), (1, "0002"), (1, "0004"), (4, "0003")]);
    assert_eq!(ranking.winner(Weights::equal(1)).design(), "0001");
    assert_eq!(ranking.equals(Weights::equal(1)), 2);

    let all = by(&results, "requirements = ['compliance > 0.7']").expect("a ranking");
    assert_eq!(all.ties(), [0, 1, 2, 3], "values that differ by round-off count as equal");
}

#[test]
fn incomparable_designs_are_refused() {
    let folder = TempDir::new().expect("a folder");
    let table = "design,gap_over_t,critical_tilt_deg,membrane_thickness_over_t,coverage,\
                 critical_force,penetration,compliance,flexural_rigidity_N_mm2\n\
                 0001,0.1,5,0.1,1,1,1,1,1\n0002,0.1,8,0.1,1,2,1,1,1\n0003,0.1,8,0.2,1,3,1,1,1";
    std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
    let results = Results::read(folder.path()).expect("results");
    let check = |text: &str| {
        let preferences = Preferences::parse(text, "x").expect("preferences");
        let message = check_comparable(&results, &preferences).err().map(|e| e.to_string());
        message.unwrap_or_default().replace(&folder.path().display().to_string(), "x")
    };
    insta::assert_snapshot!(check(""), @"x/designs.csv: critical_force cannot be compared between designs of different critical_tilt_deg (5, 8), expected one of them, e.g. --require 'critical_tilt_deg == 5', or other criteria");
    insta::assert_snapshot!(check("requirements = ['critical_tilt_deg == 8']"), @"x/designs.csv: compliance cannot be compared between designs of different membrane_thickness_over_t (0.1, 0.2), expected one of them, e.g. --require 'membrane_thickness_over_t == 0.1', or other criteria, e.g. --minimize flexural_rigidity_N_mm2 with a [material]");
    assert_eq!(check("criteria = ['flexural_rigidity_N_mm2']"), "");
    assert_eq!(check("requirements = ['critical_tilt_deg == 5']"), "");
    let table = "design,needle_friction,coverage,critical_force,penetration,compliance\n\
                 0001,none,1,1,1,1\n0002,0.1,1,2,1,1\n0003,0.2,1,3,1,1";
    std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
    let results = Results::read(folder.path()).expect("results");
    let preferences = Preferences::parse("", "x").expect("preferences");
    let refused = check_comparable(&results, &preferences).expect_err("incomparable").to_string();
    assert!(refused.contains("of different needle_friction (0.1, 0.2)"), "{refused}");
}

#[test]
fn incomparable_designs_are_ranked_within_groups() {
    let folder = TempDir::new().expect("a folder");
    let table = "design;critical_tilt_deg;membrane_thickness_over_t;coverage;critical_force;penetration;compliance\n\
                 0001;5;0,1;1;1;1;1\n0002;8;0,1;1;2;1;1\n0003;8;0,2;1;3;1;1\n0004;8;0,1;1;4;1;1";
    std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
    let results = Results::read(folder.path()).expect("results");
    let [all, coverage] = ["", "criteria = ['coverage']"]
        .map(|text| Preferences::parse(text, "x").expect("preferences"));
    let groups = comparable_groups(&results, &all).expect("groups").into_iter();
    let best = groups.map(|preferences| {
        check_comparable(&results, &preferences).expect("comparable");
        let ranking = Ranking::by(&results, preferences, TetrahedralGrid::default());
        ranking.ok().map(|ranking| ranking.winner(Weights::BALANCED).design().to_owned())
    });
    // No design has a tilt of 5° and a membrane of 0.2 t.
    let expected = [Some("0001"), None, Some("0004"), Some("0003")];
    assert!(best.eq(expected.map(|design| design.map(str::to_owned))));
    assert_eq!(comparable_groups(&results, &coverage).expect("groups"), [coverage]);
}

#[test]
fn preferences_are_written_beside_the_tables() {
    let folder = TempDir::new().expect("a folder");
    let results = results(&["0.2,1,0.5,10", "0.6,5,0.25,20"]);
    write_ranking(folder.path(), &by(&results, "").expect("a ranking")).expect("writable");
    let text = "criteria = ['min:critical_force']\nrequirements = ['coverage > 0.1']";
    let ranking = by(&results, text).expect("a ranking");
    let (files, lock) = write_ranking(folder.path(), &ranking).expect("writable");
    // The lock prevents another ranking from removing the files before the caller has read them.
    let refused = write_ranking(folder.path(), &ranking).expect_err("locked").to_string();
    assert!(refused.contains("another squama process is writing there"), "{refused}");
    drop(lock);
    assert_eq!(files, ["ranking.csv", "pareto.csv", "ranking.toml"]);
    assert!(
        !folder.path().join("quaternary.csv").exists(),
        "the table of four criteria was removed"
    );
    let verified = VerifiedFolder::open(folder.path(), Completeness::Whole).expect("a folder");
    let read = Preferences::read(&verified).expect("readable");
    assert_eq!(read.as_ref(), Some(ranking.preferences()));
    write_unmet(folder.path(), ranking.preferences()).expect("writable");
    assert!(!folder.path().join("ranking.csv").exists());
}

proptest! {
    #[test]
    fn winning_fractions_sum_to_one(
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

/// Fronts and ranks use the same tolerance, so that a difference in the last digit has no effect.
#[test]
fn round_off_does_not_put_designs_on_the_front() {
    let folder = tempfile::tempdir().expect("a folder");
    // The coverages differ only in the last digit; the third design has the largest force.
    let table = "design,coverage,critical_force\n0001,0.826794919243112,1\n\
                 0002,0.8267949192431123,2\n0003,0.8267949192431121,3\n";
    std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
    let results = Results::read(folder.path()).expect("a table");
    for (criteria, expected) in [
        (&["coverage", "critical_force"][..], &["0003"][..]),
        (&["coverage"], &["0001", "0002", "0003"]),
    ] {
        let criteria = criteria.iter().map(|column| Criterion::new(column, Goal::Maximize));
        let preferences = Preferences::new(Vec::new(), criteria.collect(), None, Scale::Paper);
        let ranking = Ranking::by(&results, preferences.expect("preferences"), grid("4"));
        let ranking = ranking.expect("a ranking");
        assert!(ranking.front().iter().map(RankedDesign::design).eq(expected.iter().copied()));
    }
}

/// Returns number, rank and membership of the front of each design, ordered by number.
fn ranks_and_front(table: &str, criteria: &[&str], scale: Scale) -> Vec<(String, usize, bool)> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
    let results = Results::read(folder.path()).expect("a table");
    let weights = Weights::equal(criteria.len());
    let criteria = criteria.iter().map(|column| Criterion::new(column, Goal::Maximize));
    let preferences = Preferences::new(Vec::new(), criteria.collect(), None, scale);
    let ranking = Ranking::by(&results, preferences.expect("preferences"), grid("4"));
    let ranking = ranking.expect("a ranking");
    let row =
        |design: RankedDesign<'_>| (design.design().to_owned(), design.rank, design.on_front());
    let mut rows: Vec<_> = ranking.by_fitness(weights).map(row).collect();
    rows.sort();
    rows
}

proptest! {
    /// Adds up to eight units of the last digit to each value.
    #[test]
    fn round_off_changes_neither_ranks_nor_fronts(
        // Few values, so that ties in some criteria and equal designs are common.
        designs in prop::collection::vec((prop::array::uniform3(1_u32..5), prop::array::uniform3(-8_i32..9)), 2..25),
        count in 1_usize..4,
    ) {
        let criteria = &["coverage", "critical_force", "compliance"][..count];
        let [exact, noisy] = [0.0, f64::EPSILON].map(|noise| {
            let mut table = "design,coverage,critical_force,compliance\n".to_owned();
            for (number, (values, digits)) in designs.iter().enumerate() {
                let cells = values.iter().zip(digits).map(|(value, digit)| {
                    let value = f64::from(*value) / 7.0 * (1.0 + noise * f64::from(*digit));
                    value.to_string()
                });
                let cells = cells.collect::<Vec<_>>().join(",");
                table.extend([&format!("{:04}", number + 1), ",", &cells, "\n"]);
            }
            table
        });
        for scale in [Scale::Paper, Scale::Linear] {
            let exact = ranks_and_front(&exact, criteria, scale);
            prop_assert_eq!(&ranks_and_front(&noisy, criteria, scale), &exact);
            if count == 1 {
                let front_by_rank: BTreeSet<_> = exact.iter().map(|(_, rank, on)| (rank, on)).collect();
                let ranks: BTreeSet<_> = exact.iter().map(|(_, rank, _)| rank).collect();
                prop_assert_eq!(front_by_rank.len(), ranks.len(), "of the designs with equal rank, all or none are on the front");
            }
        }
    }
}

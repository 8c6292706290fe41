//! Sweeps with imperfect samples draw the same samples in any run of the same designs.

use crate::Place;
use crate::table::cell;

/// A sweep of four designs with four imperfect samples each.
const UNEVEN: &str = "name = 'uneven'\n[designs]\nlength_over_t = [0.5, 1]\nslant_deg = 45\n\
                      gap_cv = [0, 0.1]\n[imperfection]\nslant_sd_deg = 0.5\nsamples = 4\n\
                      [flexure]\nmembrane_length_over_t = 20\n";

#[test]
fn threads_shards_and_subsets_draw_the_same_samples() {
    let place = Place::with(UNEVEN);
    place.squama("run x.toml -q --out one --threads 1").assert().code(0);
    place.squama("run x.toml -q --out two --threads 2").assert().code(0);
    place.assert_same_tables("one", "two");
    for shard in 1..=3 {
        let run = format!("run x.toml -q --shard {shard}/3 --out s{shard} --threads 1");
        place.squama(&run).assert().code(0);
    }
    place.squama("merge -q s1 s2 s3 --out merged").assert().code(0);
    place.assert_same_tables("one", "merged");
    place.squama("run x.toml -q --sample 3 --seed 2 --out some").assert().code(0);
    let (all, some) = (place.read("one/designs.csv"), place.read("some/designs.csv"));
    assert_eq!(some.lines().count(), 4);
    assert!(some.lines().all(|row| all.lines().any(|other| other == row)));
    // A sweep that consists of one of these designs draws the same samples.
    place
        .squama("run x.toml -q --out alone --set designs.gap_cv=0.1 --set designs.length_over_t=1")
        .assert()
        .code(0);
    let alone = place.read("alone/critical_force.csv");
    let both = place.read("one/critical_force.csv");
    let number = all.lines().nth(4).expect("a design").split(',').next().expect("a number");
    assert_eq!(cell(&both, number, "gap_cv"), "0.1");
    for column in ["critical_force", "critical_force_mean", "critical_force_p95"] {
        assert_eq!(cell(&alone, "0001", column), cell(&both, number, column), "{column}");
    }
}

#[test]
fn another_seed_changes_the_samples_but_not_the_nominal_values() {
    let place = Place::with(UNEVEN);
    place.squama("run x.toml -q --out first --set designs.length_over_t=1").assert().code(0);
    place
        .squama(
            "run x.toml -q --out second --set designs.length_over_t=1 --set imperfection.seed=2",
        )
        .assert()
        .code(0);
    let [first, second] = ["first", "second"].map(|run| place.read(&format!("{run}/designs.csv")));
    let columns = ["critical_force", "penetration", "compliance", "first_contact_curvature"];
    for column in columns {
        assert_eq!(cell(&first, "0002", column), cell(&second, "0002", column), "{column}");
    }
    for column in ["critical_force_mean", "penetration_p50", "compliance_p05"] {
        assert_ne!(cell(&first, "0002", column), cell(&second, "0002", column), "{column}");
    }
    assert_eq!(cell(&first, "0002", "puncture_samples_failed"), "0");
    assert_eq!(cell(&first, "0002", "flexure_samples_failed"), "0");
}

#[test]
fn a_rerun_keeps_its_columns_and_repeats_its_samples() {
    let place = Place::with(UNEVEN);
    place.squama("run x.toml -q --out r --set designs.length_over_t=1").assert().code(0);
    let before = place.read("r/designs.csv");
    place.squama("rerun r --design 2 -q").assert().code(0);
    assert_eq!(place.read("r/designs.csv"), before);
    place.squama("rerun r --design 2 -q --set imperfection.samples=6").assert().code(0);
    let after = place.read("r/designs.csv");
    assert_ne!(
        cell(&before, "0002", "critical_force_mean"),
        cell(&after, "0002", "critical_force_mean")
    );
    assert_eq!(cell(&after, "0002", "settings"), "imperfection.samples=6");
    place
        .squama("run x.toml -q --out p --set designs.gap_cv=0 --set imperfection.slant_sd_deg=0")
        .assert()
        .code(0);
    assert!(!place.read("p/designs.csv").contains("_mean"));
    let message = place.refused("rerun p --design 2 --set imperfection.slant_sd_deg=1");
    insta::assert_snapshot!(message, @"error: imperfections are off in the run and on in the settings; they must be the same, because a run keeps its columns");
}

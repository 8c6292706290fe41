//! Shards of a sweep are solved separately and merged.

use crate::interruptions::MANY;
use crate::{FEW, Place};

#[test]
fn tables_do_not_depend_on_the_number_of_shards() {
    let place = Place::with(MANY);
    place.squama("run x.toml -q --out whole").assert().code(0);
    for count in [1, 3, 7] {
        for shard in 1..=count {
            place.squama(&format!("run x.toml -q --shard {shard}/{count}")).assert().code(0);
        }
        let folders: Vec<_> =
            (1..=count).map(|shard| format!("results/many/shards/{shard}-of-{count}")).collect();
        let merge = format!("merge -q {} --out merged{count}", folders.join(" "));
        place.squama(&merge).assert().code(0).stdout("");
        place.assert_same_tables("whole", &format!("merged{count}"));
        let journal = place.read(&format!("merged{count}/journal.jsonl"));
        place.squama(&merge).assert().code(0);
        assert_eq!(place.read(&format!("merged{count}/journal.jsonl")), journal, "merged twice");
    }
}

#[test]
fn missing_designs_are_listed_and_can_be_added_later() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out whole").assert().code(0);
    place.squama("run x.toml -q --shard 1/3 --out 1").assert().code(0);
    place.squama("run x.toml -q --shard 3/3 --out 3").assert().code(0);
    let merged = place.squama("merge 1 3 --out all").assert().code(1).get_output().stdout.clone();
    let text = String::from_utf8(merged).expect("text");
    assert!(
        text.starts_with("merged: 5 designs from 2 folders\nmissing designs: 0002 0005 0008\n"),
        "{text}"
    );
    assert_eq!(place.read("all/designs.csv").lines().count(), 1 + 5);
    place.squama("run x.toml -q --shard 2/3 --out 2").assert().code(0);
    place.squama("merge 1 2 3 --out all").assert().code(0);
    place.assert_same_tables("whole", "all");
    // A run can be resumed in a merged folder.
    place.squama("merge 1 3 --out part").assert().code(1);
    place.squama("run x.toml -q --resume --out part").assert().code(0);
    place.assert_same_tables("whole", "part");
}

#[test]
fn shards_of_different_sweeps_are_rejected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --shard 1/2 --out 1").assert().code(0);
    place.squama("run x.toml -q --shard 2/2 --out 2 --set contact.c1=2").assert().code(0);
    insta::assert_snapshot!(place.refused("merge 1 2 --out all"), @"error: 2/journal.jsonl: has another definition: contact.c1 is 2 in the journal and 1.1 now; expected shards of one sweep by one program");
    assert_eq!(place.list("."), "1 2 x.toml");
}

#[test]
fn a_merge_keeps_designs_that_were_solved_again() {
    let place = Place::with(FEW);
    for shard in [1, 2] {
        place.squama(&format!("run x.toml -q --shard {shard}/2 --out {shard}")).assert().code(0);
    }
    place.squama("rerun 2 --design 2 -q --set puncture.scales=31").assert().code(0);
    place.squama("merge -q 1 2 --out all").assert().code(0);
    place.squama("rerun all --design 3 -q --set puncture.scales=31").assert().code(0);
    let (designs, reruns) = (place.read("all/designs.csv"), place.read("all/reruns.csv"));
    assert_eq!(designs.matches(",puncture.scales=31,").count(), 2);
    assert!(reruns.contains("\r\n0002,1,puncture.scales=31,,scales,21,31\r\n"), "{reruns}");
    assert!(reruns.contains("\r\n0003,2,puncture.scales=31,,scales,21,31\r\n"), "{reruns}");
    place.squama("merge -q 1 2 --out all").assert().code(0);
    assert_eq!(place.read("all/designs.csv"), designs);
    assert_eq!(place.read("all/reruns.csv"), reruns);
}

#[test]
fn a_random_subset_is_the_same_for_the_same_seed() {
    let place = Place::with(MANY);
    let run = "run x.toml -q --sample 10 --seed 7";
    place.squama(&format!("{run} --out a")).assert().code(0);
    for shard in [1, 2] {
        place.squama(&format!("{run} --shard {shard}/2 --out s{shard}")).assert().code(0);
    }
    place.squama("merge -q s1 s2 --out b").assert().code(0);
    place.assert_same_tables("a", "b");
    place.squama("run x.toml -q --sample 10 --seed 8 --out c").assert().code(0);
    assert_ne!(place.read("a/designs.csv"), place.read("c/designs.csv"));
    assert_eq!(place.read("a/designs.csv").lines().count(), 1 + 10);
}

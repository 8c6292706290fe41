//! `squama slurm`: tests its files, and runs its scripts without a cluster.
//!
//! `scripts/check-slurm` tests the scripts with Slurm.
#![cfg(unix)]

use crate::{FEW, Place};

/// A substitute for `sbatch` that records its arguments and prints a job number.
const SBATCH: &str = "#!/bin/sh\necho \"$@\" >> sbatch.txt\nwc -l < sbatch.txt | tr -d ' '\n";

impl Place {
    /// Returns the command that runs a script in `r/slurm` as the element `element` of a job array.
    ///
    /// The program `sbatch` is found in the folder of this test, if the folder contains it.
    fn script(&self, name: &str, arguments: &str, element: u64) -> assert_cmd::Command {
        let path =
            format!("{}:{}", self.path("").display(), std::env::var("PATH").expect("a path"));
        let mut command = assert_cmd::Command::new(self.path("r/slurm").join(name));
        command.current_dir(self.path("")).args(arguments.split_whitespace());
        command.env("PATH", path).env("SLURM_ARRAY_TASK_ID", element.to_string());
        command
    }
}

#[test]
fn slurm_scripts_write_the_tables_of_an_unsharded_run() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --set contact.c1=2 --out whole").assert().code(0);
    place.prints("slurm x.toml --shards 3 --set contact.c1=2 --out r");
    assert_eq!(place.list("r/slurm"), "array.sh merge.sh submit.sh sweep.sh sweep.toml");
    place.script("array.sh", "r/slurm", 1).assert().code(0);
    place.script("array.sh", "r/slurm", 3).assert().code(0);
    // Simulate a shard that was killed before it wrote anything.
    std::fs::create_dir(place.path("r/shards/2-of-3")).expect("writable");
    std::fs::write(place.path("r/shards/2-of-3/journal.jsonl"), "").expect("writable");
    let merged =
        place.script("merge.sh", "r/slurm", 0).assert().code(1).get_output().stdout.clone();
    let text = String::from_utf8(merged).expect("text");
    assert!(text.contains("\nmissing designs: 0002 0005 0008\n"), "{text}");
    place.script("array.sh", "r/slurm", 2).assert().code(0);
    place.script("merge.sh", "r/slurm", 0).assert().code(0);
    place.assert_same_tables("whole", "r");
}

#[test]
fn the_merge_job_waits_for_the_whole_array() {
    let place = Place::with(FEW);
    place.prints("slurm x.toml --shards 3 --out r");
    std::fs::write(place.path("sbatch"), SBATCH).expect("writable");
    assert_cmd::Command::new("chmod").arg("+x").arg(place.path("sbatch")).assert().success();
    let printed =
        place.script("submit.sh", "--time=60", 0).assert().code(0).get_output().stdout.clone();
    let text = String::from_utf8(printed).expect("text");
    assert!(text.starts_with("few: shards 1, merger 2, logs in "), "{text}");
    let calls = place.read("sbatch.txt");
    let calls: Vec<_> = calls.lines().collect();
    assert!(calls[0].contains("--array=1-3 ") && calls[0].contains("--time=60 "), "{}", calls[0]);
    assert!(calls[1].contains("--dependency=afterany:1 "), "{}", calls[1]);
}

#[test]
fn per_cent_signs_in_paths_are_preserved() {
    let place = Place::with(FEW);
    place.prints("slurm x.toml --shards 3 --out r");
    std::fs::create_dir(place.path("50%a")).expect("a folder");
    std::fs::rename(place.path("r"), place.path("50%a/r")).expect("a folder");
    std::os::unix::fs::symlink(place.path("50%a/r"), place.path("r")).expect("a link");
    std::fs::write(place.path("sbatch"), SBATCH).expect("writable");
    assert_cmd::Command::new("chmod").arg("+x").arg(place.path("sbatch")).assert().success();
    let path = format!("{}:{}", place.path("").display(), std::env::var("PATH").expect("a path"));
    let mut submit = assert_cmd::Command::new(place.path("50%a/r/slurm/submit.sh"));
    submit.current_dir(place.path("")).env("PATH", path).assert().code(0);
    let calls = place.read("sbatch.txt");
    assert!(calls.contains("/50%%a/r/slurm/log/%A_%a.txt"), "{calls}");
    assert!(calls.contains("/50%a/r/slurm/array.sh"), "{calls}");
}

#[test]
fn numbers_of_shards_out_of_range_are_rejected() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused("slurm x.toml --out r --shards 1001"), @"error: --shards 1001: expected 1 to 1000, the largest index of a job array in Slurm (MaxArraySize is 1001 by default); a shard may have any number of designs");
    insta::assert_snapshot!(place.refused("slurm x.toml --out r --shards 0"), @"error: --shards 0: expected 1 to 1000, the largest index of a job array in Slurm (MaxArraySize is 1001 by default); a shard may have any number of designs");
    insta::assert_snapshot!(place.refused("slurm x.toml --out r --shards 9"), @"error: --shards 9: there are only 8 designs, expected 1 to 8");
    assert_eq!(place.list("."), "x.toml");
}

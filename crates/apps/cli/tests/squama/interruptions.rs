//! A run loses no completed design if it is killed or interrupted, or if the disk is full.
//!
//! After `--resume`, the tables are identical to the tables of an uninterrupted run.

use std::path::Path;
use std::time::Duration;

use crate::process::Running;
use crate::runs::TABLES;
use crate::{FEW, Place};

/// A sweep of 54 designs, which takes long enough to be interrupted.
pub const MANY: &str = "name = 'many'\n[designs]\ngap_over_t = [0.1, 0.2, 0.4]\n\
                    length_over_t = [0.1, 0.3, 1]\nslant_deg = { from = 0, to = 75, step = 15 }\n\
                    [puncture]\nscales = 61\n";

impl Place {
    /// Starts `squama` in this folder.
    fn spawn(&self, arguments: &str) -> Running {
        Running::spawn(&self.path(""), arguments)
    }

    /// Runs `squama` and kills the process `delay` after `file` has at least `lines` lines.
    ///
    /// Returns true if the process was killed, false if it ended by itself before.
    pub fn kill_at(&self, arguments: &str, file: &str, lines: usize, delay: Duration) -> bool {
        let mut run = self.spawn(arguments);
        while self.lines(file) < lines {
            if run.end_within(Duration::from_millis(1)).is_some() {
                return false;
            }
        }
        run.end_within(delay).is_none() && run.kill().code().is_none()
    }

    /// Returns the number of lines of a file; 0 if the file does not exist.
    pub fn lines(&self, file: &str) -> usize {
        std::fs::read_to_string(self.path(file)).map_or(0, |text| text.lines().count())
    }

    /// Asserts that the results folders `one` and `other` have identical tables.
    pub fn assert_same_tables(&self, one: &str, other: &str) {
        for table in TABLES {
            let [one, other] = [one, other].map(|folder| self.read(&format!("{folder}/{table}")));
            assert_eq!(one, other, "{table}");
        }
    }
}

#[test]
fn the_design_on_a_truncated_last_line_is_solved_again() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out a").assert().code(0);
    let journal = place.read("a/journal.jsonl");
    let torn = &journal[..journal.len() - 7];
    std::fs::create_dir(place.path("b")).expect("a folder");
    std::fs::write(place.path("b/journal.jsonl"), torn).expect("writable");
    let status = place.squama("status b").assert().code(1).get_output().stdout.clone();
    assert!(String::from_utf8_lossy(&status).contains("missing     1\n"));
    let run = place.squama("run x.toml -q --out b --resume").assert().code(0);
    place.assert_same_tables("a", "b");
    let message = String::from_utf8(run.get_output().stderr.clone()).expect("text");
    let tail = torn.rsplit('\n').next().expect("a tail");
    let expected = format!(
        "note: b/journal.jsonl: {} damaged bytes at its end were cut off; a copy of them is in b/journal.cut-1\n",
        tail.len()
    );
    assert_eq!(message, expected);
    assert_eq!(place.read("b/journal.cut-1"), tail);
}

#[test]
fn results_are_not_overwritten_without_fresh() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q").assert().code(0);
    let before = place.read("results/few/designs.csv");
    insta::assert_snapshot!(place.refused("run x.toml"), @"error: results/few: already holds results; use --resume to continue from them, or --fresh to discard them");
    insta::assert_snapshot!(place.refused("run x.toml --resume --set contact.c1=2 --set designs.slant_deg=30"), @"error: results/few/journal.jsonl: has another definition: contact.c1 is 1.1 in the journal and 2 now; designs.slant_deg is [0, 45] in the journal and [30] now; expected no difference, or --fresh to discard the results");
    insta::assert_snapshot!(place.refused("run x.toml --resume --sample 3"), @"error: results/few/journal.jsonl: contains all designs instead of --sample 3 --seed 0; expected no difference, or --fresh to discard the results");
    assert_eq!(place.read("results/few/designs.csv"), before);
    place.squama("run x.toml -q --fresh --set contact.c1=2").assert().code(0);
    assert_ne!(place.read("results/few/designs.csv"), before);
    std::fs::remove_file(place.path("results/few/journal.jsonl")).expect("a file");
    insta::assert_snapshot!(place.refused("run x.toml --resume"), @"error: results/few: holds designs.csv without a journal; choose another folder with --out DIR, or use --fresh to delete the files that have the names of results");
}

#[test]
fn files_of_other_programs_are_not_overwritten() {
    let names = ["run.toml", "failures.csv", "penetration.csv", "reruns.csv", "contents.toml"];
    for name in names {
        let place = Place::with(FEW);
        std::fs::create_dir(place.path("r")).expect("a folder");
        std::fs::write(place.path("r").join(name), "a stranger's").expect("writable");
        let message = place.refused("run x.toml --out r");
        assert!(
            message.starts_with(&format!("error: r: holds {name} without a journal")),
            "{message}"
        );
        place.refused("run x.toml --out r --resume");
        assert_eq!(place.list("r"), name);
        assert_eq!(place.read(&format!("r/{name}")), "a stranger's");
    }
    // A file with the name of the journal, which squama did not write, is not overwritten either.
    let place = Place::with(FEW);
    std::fs::create_dir(place.path("r")).expect("a folder");
    std::fs::write(place.path("r/journal.jsonl"), "{\"a\": 1}").expect("writable");
    insta::assert_snapshot!(place.refused("run x.toml --out r"), @"error: r/journal.jsonl:1: not the first line of a journal (it does not begin with a checksum); restore the line, or use --fresh to discard all results");
    assert_eq!(place.read("r/journal.jsonl"), "{\"a\": 1}");
}

#[test]
fn a_file_of_zeros_is_rejected_as_a_journal() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let journal = place.read("r/journal.jsonl");
    std::fs::create_dir(place.path("zeros")).expect("a folder");
    add_zero_bytes(&place.path("zeros/journal.jsonl"));
    for command in ["run x.toml --out zeros", "status zeros", "merge zeros --out all"] {
        let message = place.refused(command);
        assert!(message.contains("not the first line of a journal"), "{message}");
    }
    // Zero bytes after valid lines are treated as a damaged end of the journal.
    add_zero_bytes(&place.path("r/journal.jsonl"));
    let status = place.squama("status r").assert().code(1).get_output().stdout.clone();
    assert!(String::from_utf8_lossy(&status).contains("done        8\n"));
    std::fs::write(place.path("r/journal.jsonl"), journal).expect("writable");
    place.prints("status r");
}

/// Appends 256 MiB of zero bytes to a file; the file is sparse, so it takes no disk space.
fn add_zero_bytes(path: &Path) {
    let file = std::fs::OpenOptions::new().append(true).create(true).open(path).expect("writable");
    file.set_len(file.metadata().expect("a file").len() + (1 << 28)).expect("a hole");
}

#[test]
fn journals_of_other_versions_of_squama_are_rejected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q").assert().code(0);
    let journal = place.read("results/few/journal.jsonl");
    let (header, rest) = journal.split_once('\n').expect("lines");
    let content = header.replace("\"version\":\"", "\"version\":\"9.").split_off(18);
    let sum = crc32fast::hash(content.as_bytes());
    let forged = format!("{{\"crc\":\"{sum:08x}\",{content}\n{rest}");
    std::fs::write(place.path("results/few/journal.jsonl"), forged).expect("writable");
    let message = place.refused("run x.toml --resume");
    assert!(message.contains("was written by squama 9."), "{message}");
}

#[test]
fn a_second_run_on_a_folder_is_rejected() {
    let place = Place::with(MANY);
    let slow = "run x.toml -q --threads 1 --resume --set solver.max_step=0.0005";
    let mut first = place.spawn(slow);
    first.until(|| place.lines("results/many/journal.jsonl") >= 3);
    insta::assert_snapshot!(place.refused(slow), @"error: results/many: another squama process is writing there; wait until it ends");
    let status = place.squama("status results/many").assert().code(1).get_output().stdout.clone();
    let status = String::from_utf8_lossy(&status).into_owned();
    assert!(
        status.starts_with("many: running\n") && status.contains("running     1\n"),
        "{status}"
    );
    first.kill();
    let status = place.squama("status results/many").assert().code(1).get_output().stdout.clone();
    assert!(String::from_utf8_lossy(&status).starts_with("many: not running\n"));
}

#[cfg(unix)]
mod signals {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

    use super::*;

    #[test]
    fn a_first_signal_keeps_the_completed_designs() {
        for (signal, code) in [(SIGINT, 130), (SIGTERM, 143), (SIGHUP, 129)] {
            let place = Place::with(MANY);
            let mut run =
                place.spawn("run x.toml -q --threads 2 --resume --set solver.max_step=0.002");
            run.until(|| place.lines("results/many/journal.jsonl") >= 4);
            run.send(signal);
            run.send(signal);
            assert_eq!(run.end().code(), Some(code));
            assert!(place.path("results/many/contents.toml").exists(), "all tables are written");
            let journal = place.lines("results/many/journal.jsonl");
            let rows = place.lines("results/many/designs.csv");
            // The journal begins with a header and a session, the table with a header.
            assert_eq!(rows, journal - 1, "the table has every design of the journal");
            assert!((3..54).contains(&rows), "{rows}");
        }
    }

    #[test]
    fn the_first_signal_prints_a_message() {
        let place = Place::with(ENDLESS);
        let mut run = place.spawn("run x.toml --threads 1");
        run.until(|| place.lines("results/endless/journal.jsonl") >= 3);
        run.send(SIGINT);
        let message = "ending without the designs in progress; a second signal ends at once; --resume continues\n";
        run.until_printed(message);
        assert_eq!(run.end().code(), Some(130));

        // Unlike a run, `squama tolerance` begins with the first design, so make the first design
        // quick.
        let place = Place::with(&ENDLESS.replace("[10001, 1]", "[1, 10001]"));
        let mut tolerance = place.spawn(
            "tolerance x.toml --samples 2 --threads 1 --set tolerance.slant_deg={batch_sd=1}",
        );
        let samples = "results/endless/tolerance/samples";
        tolerance.until(|| place.path(samples).exists() && place.list(samples).contains(".csv"));
        tolerance.send(SIGINT);
        tolerance.until_printed(
            "ending without the samples in progress; a second signal ends at once; to continue, run the same command again\n",
        );
        assert_eq!(tolerance.end().code(), Some(130));
    }

    #[test]
    fn long_designs_report_their_progress() {
        let place = Place::with(&format!("{ENDLESS}[tolerance]\nslant_deg = {{ batch_sd = 1 }}\n"));
        let goal = ENDLESS.replace("slant_deg = 0\nscales = [10001, 1]", "scales = 10001");
        let more =
            "[variables]\nslant_deg = { from = 0, to = 1 }\n[goal]\nmaximize = 'critical_force'\n";
        std::fs::write(place.path("goal.toml"), goal + more).expect("writable");
        let mut tolerance = place.spawn("tolerance x.toml --design 1 --samples 2");
        let mut search = place.spawn("optimise goal.toml");
        tolerance.until_printed("design 0001: ");
        search.until_printed("a design of the search: ");
    }

    /// A sweep of two designs: one with 10,001 scales takes minutes, one with one scale is quick.
    ///
    /// Both designs take ten thousand steps. A run begins in the middle of the grid, so it solves
    /// the quick second design first. The substrate is nonlinear, because then the system of
    /// equations contains all scales.
    const ENDLESS: &str = "name = 'endless'\nmeasures = ['puncture']\n[designs]\ngap_over_t = 0.1\n\
                           length_over_t = 1\nslant_deg = 0\nscales = [10001, 1]\n\
                           [substrate]\nlaw = 'neo-hookean'\n[solver]\nmax_step = 1e-4\nfirst_step = 1e-4\n";

    /// An interrupted design counts as not solved, not as failed.
    #[test]
    fn a_first_signal_ends_the_design_in_progress() {
        let place = Place::with(ENDLESS);
        let mut run = place.spawn("run x.toml -q --threads 1");
        // The three lines are the header, the session and the second design; now the first design
        // is in progress.
        run.until(|| place.lines("results/endless/journal.jsonl") >= 3);
        // Send two signals, as the program `timeout` does: to the process and to its group.
        run.send(SIGTERM);
        run.send(SIGTERM);
        let ended = run.end_within(Duration::from_secs(10)).expect("the run ends");
        assert_eq!(ended.code(), Some(143));
        assert_eq!(place.lines("results/endless/journal.jsonl"), 3);
        assert_eq!(place.lines("results/endless/designs.csv"), 2, "a header and one design");
        assert_eq!(place.lines("results/endless/failures.csv"), 1, "a header");

        let goal = ENDLESS.replace("slant_deg = 0\nscales = [10001, 1]", "scales = 10001");
        let more =
            "[variables]\nslant_deg = { from = 0, to = 1 }\n[goal]\nmaximize = 'critical_force'\n";
        std::fs::write(place.path("goal.toml"), goal + more).expect("writable");
        let mut search = place.spawn("optimise goal.toml --out search");
        search.until_printed("a design of the search: ");
        search.send(SIGTERM);
        let ended = search.end_within(Duration::from_secs(10)).expect("the search ends");
        assert_eq!(ended.code(), Some(143));
        let journal = place.read("search/evaluations.jsonl");
        assert!(!journal.contains("internal"), "{journal}");
    }

    #[test]
    fn terminated_commands_leave_no_partial_files() {
        let place = Place::with(
            "name = 'x'\nmeasures = ['coverage']\n[designs]\n\
                                 gap_over_t = { from = 0.1, to = 2, step = 0.005 }\n\
                                 slant_deg = { from = 0, to = 75, step = 5 }\n",
        );
        place.squama("run x.toml -q --out r").assert().code(0);
        let partial = || place.list("r").contains(".partial");
        for signal in [SIGTERM, SIGHUP] {
            let mut export = place.spawn("export r --xlsx r/x.xlsx");
            export.until(partial);
            export.send(signal);
            assert_eq!(export.end().code(), Some(128 + signal));
            assert!(!partial(), "{}", place.list("r"));
        }
        // A killed process leaves a partial file, which the next run removes.
        let mut export = place.spawn("export r --xlsx r/x.xlsx");
        export.until(partial);
        export.kill();
        assert!(partial());
        place.squama("run x.toml -q --out r --resume").assert().code(0);
        assert!(!partial(), "{}", place.list("r"));
    }

    #[test]
    fn pipes_are_rejected_as_journals() {
        let place = Place::with(FEW);
        std::fs::create_dir(place.path("r")).expect("a folder");
        let journal = place.path("r/journal.jsonl");
        let status = std::process::Command::new("mkfifo").arg(&journal).status();
        assert!(status.is_ok_and(|status| status.success()), "a pipe");
        for command in
            ["run x.toml --out r", "status r", "merge r --out all", "rerun r --failed", "rank r"]
        {
            let mut squama = place.spawn(command);
            let code = squama.end_within(Duration::from_secs(20)).expect("squama ends").code();
            assert_eq!(code, Some(2), "{command}");
        }
        insta::assert_snapshot!(place.refused("run x.toml --fresh --out r"), @"error: r/journal.jsonl: is not a regular file, expected a journal that squama writes");
    }

    #[test]
    fn runs_can_be_resumed_after_a_full_disk() {
        let place = Place::with(MANY);
        place.squama("run x.toml -q --out whole").assert().code(0);
        // Each limit truncates the journal (70 kB) at another line. A limit on the file size cannot
        // truncate tables, which are smaller than the journal.
        for blocks in [5, 8, 15] {
            let out = format!("out{blocks}");
            let run = format!("run x.toml -q --out {out}");
            let message = place.refused_on_a_full_disk(blocks, &run);
            let begin = format!("error: {out}/");
            assert!(message.starts_with(&begin) && message.lines().count() == 1, "{message}");
            assert!(message.contains(": cannot be written (File too large)"), "{message}");
            place.squama(&format!("run x.toml -q --resume --out {out}")).assert().code(0);
            place.assert_same_tables("whole", &out);
        }
    }
}

#[test]
fn fail_fast_ends_a_run_at_the_first_failure() {
    let place = Place::with(MANY);
    let run = "run x.toml -q --threads 1 --set solver.max_points=3";
    place.squama(&format!("{run} --fail-fast")).assert().code(1);
    let done = place.lines("results/many/designs.csv") - 1;
    // The run solves some designs before the first failure, but not all 54.
    assert!((1..27).contains(&done), "{done}");
    place.squama(&format!("{run} --resume")).assert().code(1);
    assert_eq!(place.lines("results/many/failures.csv"), 1 + 2 * 54);
}

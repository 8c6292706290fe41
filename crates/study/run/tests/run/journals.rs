//! Damaged journals are refused with the number of a line, or continued to the same tables.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use run::{Options, Program, RunError, Start, WorkMeter};
use sweep::{Subset, Sweep};

/// Definition of 48 designs. The punctures of some designs stop early.
const DESIGNS: &str = "name = 'x'\nmeasures = ['coverage', 'puncture']\n[designs]\n\
                       gap_over_t = [0.1, 0.3, 0.5]\nlength_over_t = [0.2, 1]\n\
                       slant_deg = { from = 0, to = 70, step = 10 }\n\
                       [puncture]\nscales = 5\n[solver]\nmax_points = 7\n";

/// File name of the journal.
const JOURNAL: &str = "journal.jsonl";

/// Continues the run in `folder`.
pub fn resume(folder: &Path) -> Result<(), RunError> {
    let sweep = Sweep::parse(DESIGNS, "x.toml", &[]).expect("a valid sweep");
    let stop = AtomicBool::new(false);
    let options = Options {
        threads: 1,
        format: None,
        fail_fast: false,
        tables_every: Duration::MAX,
        stop: &stop,
        work: &WorkMeter::default(),
    };
    let program = Program { version: "0", revision: "none" };
    let all = Subset::default();
    run::run(&sweep, all, folder, Start::Resume, &options, &program, |_| ()).map(|_| ())
}

/// Returns the texts of all tables, concatenated.
fn tables(folder: &Path) -> String {
    let tables = ["designs.csv", "coverage.csv", "critical_force.csv", "failures.csv"];
    tables.map(|table| fs::read_to_string(folder.join(table)).expect("a table")).concat()
}

/// Damages `journal` at a random position, and returns a description of the damage.
fn damage(journal: &mut Vec<u8>, random: &mut ChaCha8Rng) -> String {
    let at = random.random_range(0..journal.len());
    let length = random.random_range(1..300_usize).min(journal.len() - at);
    let kind = random.random_range(0..7);
    match kind {
        0 => journal[at] ^= 1 << random.random_range(0..8),
        1 => journal[at] = random.random_range(b'0'..=b'9'),
        2 => journal.truncate(at),
        3 => drop(journal.drain(at..at + length)),
        4 => journal[at..at + length].fill(0),
        5 => {
            let piece = journal[at..at + length].to_vec();
            journal.splice(at..at, piece);
        }
        _ => {
            let piece: Vec<_> = (0..length).map(|_| random.random_range(0..=255)).collect();
            journal.splice(at..at + length, piece);
        }
    }
    format!("kind {kind} at {at}, {length} bytes")
}

/// Returns the number (from 1) of the first line in which two texts differ.
fn first_difference(one: &[u8], other: &[u8]) -> usize {
    let same = one.iter().zip(other).take_while(|(a, b)| a == b).count();
    1 + String::from_utf8_lossy(&one[..same]).matches('\n').count()
}

#[test]
fn damaged_journals_are_refused_or_give_the_same_tables() {
    let place = tempfile::tempdir().expect("a folder");
    resume(place.path()).expect("a run");
    let (journal, expected) =
        (fs::read(place.path().join(JOURNAL)).expect("a journal"), tables(place.path()));
    assert!(expected.contains("too many points") && expected.contains("complete"));
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let [mut refused, mut recovered] = [0; 2];
    for _ in 0..200 {
        let mut damaged = journal.clone();
        let what = damage(&mut damaged, &mut random);
        let line = first_difference(&journal, &damaged);
        fs::write(place.path().join(JOURNAL), &damaged).expect("writable");
        match resume(place.path()) {
            Ok(()) => {
                assert!(tables(place.path()) == expected, "{what}: the tables differ");
                recovered += 1;
            }
            Err(error) => {
                let error = error.to_string();
                let name = format!("/{JOURNAL}:{line}: ");
                assert!(error.contains(&name), "{what} in line {line}: {error}");
                let states_remedy = ["expected", "restore the line", "restore it"]
                    .iter()
                    .any(|what| error.contains(what));
                assert!(error.lines().count() == 1 && states_remedy, "{error}");
                let after = fs::read(place.path().join(JOURNAL)).expect("a journal");
                assert!(after == damaged, "{what}: a refused journal was changed");
                refused += 1;
            }
        }
    }
    // Truncated journals are continued; damage before intact lines is refused.
    assert!(refused > 50 && recovered > 20, "{refused} refused, {recovered} recovered");
}

#[test]
fn a_journal_continues_after_removal_of_a_damaged_line() {
    let place = tempfile::tempdir().expect("a folder");
    resume(place.path()).expect("a run");
    let path = place.path().join(JOURNAL);
    let (journal, expected) = (fs::read_to_string(&path).expect("text"), tables(place.path()));
    let mut lines: Vec<_> = journal.split_inclusive('\n').collect();
    let damaged = lines[20].replace("complete", "completf");
    lines[20] = &damaged;
    fs::write(&path, lines.concat()).expect("writable");
    let error = resume(place.path()).expect_err("refused").to_string();
    assert!(error.contains("journal.jsonl:21: damaged line (its checksum"), "{error}");
    lines.remove(20);
    fs::write(&path, lines.concat()).expect("writable");
    resume(place.path()).expect("a run");
    assert!(tables(place.path()) == expected, "the tables differ");
}

//! Kills runs at random moments, some runs several times, and resumes them.
//!
//! The tables must equal the tables of an undisturbed run, for any number of threads and shards.

use std::time::Duration;

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::Place;

/// A sweep of two hundred quick designs; the punctures of some designs stop early.
const DESIGNS: &str = "name = 'x'\n[designs]\ngap_over_t = [0.1, 0.3, 0.5, 1]\n\
                       length_over_t = [0.1, 0.2, 0.3, 0.6, 1]\n\
                       slant_deg = { from = 0, to = 72, step = 8 }\n\
                       [puncture]\nscales = 5\n[solver]\nmax_points = 7\n";

/// Counts of killed processes.
#[derive(Debug, Default)]
struct Kills {
    /// Number of processes killed before they completed.
    all: usize,
    /// Number of processes killed with at least one design in the journal.
    midway: usize,
    /// Number of runs that were killed more than once.
    repeated: usize,
}

/// A series of runs with processes that are killed at random moments.
struct Campaign {
    place: Place,
    random: ChaCha8Rng,
    /// Number of lines of the journal of an undisturbed run.
    lines: usize,
    kills: Kills,
}

impl Campaign {
    /// Runs a command that writes to `folder`, kills it up to `times` times, then lets it complete.
    ///
    /// A process is killed up to 10 ms after its journal has a random number of lines, at most
    /// `most`. A random time after the start would kill slow machines early and fast machines late.
    fn survive(&mut self, arguments: &str, folder: &str, times: usize, most: usize) {
        let before = self.kills.all;
        let journal = format!("{folder}/journal.jsonl");
        for _ in 0..times {
            let lines = self.random.random_range(0..=most);
            let delay = Duration::from_millis(10).mul_f64(self.random.random_range(0.0..1.0));
            let killed = self.place.kill_at(arguments, &journal, lines, delay);
            self.kills.all += usize::from(killed);
            // The journal starts with a header and a session; designs and more sessions follow.
            self.kills.midway += usize::from(killed && self.place.lines(&journal) > 2);
        }
        self.kills.repeated += usize::from(self.kills.all > before + 1);
        self.place.squama(arguments).assert().code(1);
    }

    /// Runs the sweep into the folder `name`, as one run, or as shards that are merged.
    fn run(&mut self, name: &str, threads: u32, shards: u32) {
        let run = format!("run x.toml -q --resume --threads {threads}");
        if shards == 1 {
            let times = self.random.random_range(2..=4);
            self.survive(&format!("{run} --out {name}"), name, times, self.lines);
            return;
        }
        let most = self.lines / shards as usize;
        let mut folders = String::new();
        for shard in 1..=shards {
            let folder = format!("{name}-{shard}");
            let times = self.random.random_range(0..=1);
            let run = format!("{run} --shard {shard}/{shards} --out {folder}");
            self.survive(&run, &folder, times, most);
            folders = format!("{folders} {folder}");
        }
        self.survive(&format!("merge -q {folders} --out {name}"), name, 1, 1);
    }
}

/// Returns the number of runs: 9, or 50 in a long campaign.
///
/// Nine runs cover all combinations of 1, 2 and 8 threads with 1, 3 and 7 shards.
fn runs() -> usize {
    if crate::long_campaigns() { 50 } else { 9 }
}

#[test]
fn runs_killed_at_random_moments_resume_to_the_same_tables() {
    let place = Place::with(DESIGNS);
    place.squama("run x.toml -q --threads 1 --out whole").assert().code(1);
    let (lines, random) = (place.lines("whole/journal.jsonl"), ChaCha8Rng::seed_from_u64(50));
    let mut campaign = Campaign { place, random, lines, kills: Kills::default() };
    for run in 0..runs() {
        let (threads, shards) = ([1, 2, 8][run % 3], [1, 3, 7][run / 3 % 3]);
        let name = run.to_string();
        campaign.run(&name, threads, shards);
        campaign.place.assert_same_tables("whole", &name);
        let list = campaign.place.list(&name);
        assert!(!list.contains(".partial"), "{list}");
    }
    let kills = campaign.kills;
    // Check that the test is effective: fifty runs must have at least fifty kills, twenty of them
    // after the first design, and three runs that were killed several times.
    for (count, minimum) in [(kills.all, 50), (kills.midway, 20), (kills.repeated, 3)] {
        assert!(count >= minimum * runs() / 50, "{kills:?}");
    }
}

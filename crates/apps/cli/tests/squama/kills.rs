//! Runs that are killed at random moments, some several times.
//!
//! Each resumes to the tables of an undisturbed run, for any number of threads and shards.

use std::time::{Duration, Instant};

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::Place;

/// Two hundred quick designs; the punctures of some stop early.
const DESIGNS: &str = "name = 'x'\n[designs]\ngap_over_t = [0.1, 0.3, 0.5, 1]\n\
                       length_over_t = [0.1, 0.2, 0.3, 0.6, 1]\n\
                       slant_deg = { from = 0, to = 72, step = 8 }\n\
                       [puncture]\nscales = 5\n[solver]\nmax_points = 7\n";

/// Counts of killed processes.
#[derive(Debug, Default)]
struct Kills {
    /// Killed before completion.
    all: usize,
    /// Killed with some designs in the journal, but not all.
    midway: usize,
    /// Runs that were killed more than once.
    repeated: usize,
}

struct Campaign {
    place: Place,
    random: ChaCha8Rng,
    /// Duration of an undisturbed run.
    whole: Duration,
    kills: Kills,
}

impl Campaign {
    /// Kills `arguments`, which writes to `folder`, up to `times` times, then lets it complete.
    fn survive(&mut self, arguments: &str, folder: &str, times: usize, longest: Duration) {
        let before = self.kills.all;
        for _ in 0..times {
            let after = longest.mul_f64(self.random.random_range(0.0..1.0));
            let killed = self.place.kill(arguments, after);
            self.kills.all += usize::from(killed);
            // The journal starts with a header and a session; designs and more sessions follow.
            let lines = self.place.lines(&format!("{folder}/journal.jsonl"));
            self.kills.midway += usize::from(killed && lines > 2);
        }
        self.kills.repeated += usize::from(self.kills.all > before + 1);
        self.place.squama(arguments).assert().code(1);
    }

    /// Performs one run in the folder `name`.
    fn run(&mut self, name: &str, threads: u32, shards: u32) {
        let run = format!("run x.toml -q --resume --threads {threads}");
        if shards == 1 {
            let times = self.random.random_range(2..=4);
            self.survive(&format!("{run} --out {name}"), name, times, self.whole);
            return;
        }
        // Time to start, plus the shard's part of the total duration.
        let longest = self.whole / shards + Duration::from_millis(20);
        let mut folders = String::new();
        for shard in 1..=shards {
            let folder = format!("{name}-{shard}");
            let times = self.random.random_range(0..=1);
            let run = format!("{run} --shard {shard}/{shards} --out {folder}");
            self.survive(&run, &folder, times, longest);
            folders = format!("{folders} {folder}");
        }
        let merge = format!("merge -q {folders} --out {name}");
        self.survive(&merge, name, 1, Duration::from_millis(20));
    }
}

/// Returns the number of runs: one for each number of threads and shards, or fifty in a long
/// campaign.
fn runs() -> usize {
    if crate::long_campaigns() { 50 } else { 9 }
}

#[test]
fn runs_killed_at_random_moments_make_the_same_tables() {
    let place = Place::with(DESIGNS);
    let begun = Instant::now();
    place.squama("run x.toml -q --threads 1 --out whole").assert().code(1);
    let (whole, random) = (begun.elapsed(), ChaCha8Rng::seed_from_u64(50));
    let mut campaign = Campaign { place, random, whole, kills: Kills::default() };
    for run in 0..runs() {
        let (threads, shards) = ([1, 2, 8][run % 3], [1, 3, 7][run / 3 % 3]);
        let name = run.to_string();
        campaign.run(&name, threads, shards);
        campaign.place.assert_same_tables("whole", &name);
        let list = campaign.place.list(&name);
        assert!(!list.contains(".partial"), "{list}");
    }
    let kills = campaign.kills;
    println!("{kills:?} in {:.0?}", begun.elapsed());
    // Of fifty runs at least fifty kills, twenty of them midway, and three runs with several kills.
    let least = |of_fifty: usize| of_fifty * runs() / 50;
    assert!(kills.all >= least(50), "{kills:?}");
    assert!(kills.midway >= least(20), "{kills:?}");
    assert!(kills.repeated >= least(3), "{kills:?}");
}

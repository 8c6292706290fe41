//! Record of a run, `run.toml`.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use journal::{OutputError, Program};
use results::ResultsFolder;
use text::toml_source::quoted;

use super::summary::Summary;
use crate::options::Options;
use crate::run_journal::Archive;

/// Program version, threads and start time of a run, for `run.toml`.
pub(crate) struct RunInfo<'a> {
    program: &'a Program,
    threads: usize,
    clock: Instant,
}

impl<'a> RunInfo<'a> {
    pub fn new(program: &'a Program, options: &Options<'_>, clock: Instant) -> Self {
        Self { program, threads: options.threads, clock }
    }

    /// Returns version and revision of the program.
    pub fn program(&self) -> String {
        format!("{} ({})", self.program.version, self.program.revision)
    }

    /// Returns the time since the session began.
    pub fn elapsed(&self) -> Duration {
        self.clock.elapsed()
    }

    /// Writes `run.toml` to `folder` and returns its SHA-256.
    pub fn write(
        &self,
        archive: &Archive,
        folder: &ResultsFolder,
        summary: &Summary,
    ) -> Result<String, OutputError> {
        let definition = archive.sweep().to_toml_under("definition");
        let text = format!("{}{}\n{definition}", self.run(archive, summary), statuses(summary));
        folder.write_text(ResultsFolder::RUN_INFO, &text)
    }

    fn run(&self, archive: &Archive, summary: &Summary) -> String {
        let subset = *archive.header().subset();
        let started = archive.sessions().first().map(|session| session.started.as_str());
        let designs = archive.designs().len();
        let mut text = format!(
            "# Record of a run. This file is also a sweep definition: running it repeats the run.\n\
             [run]\nversion = {}\ngit_revision = {}\nstarted = {}\nduration_s = {:.3}\nthreads = {}\n\
             sessions = {}\ndesigns = {designs}\ndone = {}\nfailed = {}\nmissing = {}\n",
            quoted(self.program.version),
            quoted(self.program.revision),
            // A journal without solved designs may have no session and hence no start time.
            started.unwrap_or("1970-01-01T00:00:00Z"),
            self.elapsed().as_secs_f64(),
            self.threads,
            archive.sessions().len(),
            summary.designs,
            summary.failed,
            designs - summary.designs,
        );
        // `writeln!` to a string cannot fail, so its result is ignored.
        if let Some(sample) = subset.sample {
            let _ = writeln!(text, "sample = {}\nseed = {}", sample.designs, sample.seed);
        }
        if let Some(shard) = subset.shard {
            let _ = writeln!(text, "shard = {}", quoted(&shard.to_string()));
        }
        text
    }
}

fn statuses(summary: &Summary) -> String {
    let mut text = String::new();
    for (measure, counts) in &summary.statuses {
        let _ = write!(text, "\n[run.{}_status]\n", measure.key());
        for (status, count) in counts {
            let _ = writeln!(text, "{} = {count}", quoted(status));
        }
    }
    text
}

//! Options and results folder of `squama tolerance` and `squama sensitivity`, which solve samples.

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;
use results::{Claim, Maker, ResultsFolder};
use sweep::Sweep;
use uncertainty::{AnalysisError, SampleStore};

use super::options::SolveOptions;
use super::source::{Definition, folder_within};
use crate::interrupt::Interrupt;
use crate::print::note;
use crate::progress::Display;

/// Options of the commands that solve samples.
#[derive(Debug, Args)]
pub struct SampleArgs {
    /// Folder for the tables [default: RESULTS/COMMAND, in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub solving: SolveOptions,
}

/// Message that is printed after the first termination signal.
const ENDING: &str = "ending without the samples in progress; a second signal ends at once; to continue, run the same command again";

/// The results folder of a command that solves samples.
pub struct SampleFolder<'a> {
    definition: &'a Definition,
    arguments: &'a SampleArgs,
    maker: Maker,
    /// Folder of the tables.
    pub folder: ResultsFolder,
}

impl<'a> SampleFolder<'a> {
    /// Returns the results folder of the command `name`, which writes files as `maker`.
    ///
    /// Rejects a folder in which the command would overwrite files of the user. This check precedes
    /// the solution of the samples, which may take hours.
    pub fn new(
        (definition, sweep): (&'a Definition, &Sweep),
        arguments: &'a SampleArgs,
        (name, maker): (&str, Maker),
    ) -> anyhow::Result<Self> {
        let folder = ResultsFolder::new(
            arguments.out.clone().unwrap_or_else(|| folder_within(definition, sweep, name)),
        );
        Claim::check(&folder, maker)?;
        Ok(Self { definition, arguments, maker, folder })
    }

    /// Runs `solve`, which solves `samples` samples, and claims the folder for the tables.
    ///
    /// After an interruption, prints a note and returns `None`.
    pub fn solved<T: Send>(
        &self,
        (samples, interrupt): (u64, &Interrupt),
        solve: impl FnOnce(&SampleStore) -> Result<T, AnalysisError> + Send,
    ) -> anyhow::Result<Option<(T, Claim<'_>)>> {
        let store = SampleStore::new(&self.folder.file("samples"));
        interrupt.end_gracefully();
        store.work().begin(samples);
        let display =
            Display::new(self.arguments.solving.quiet, interrupt, store.work().clone(), ENDING);
        let solved = self.arguments.solving.threads.pool()?.install(|| solve(&store));
        drop(display);
        match solved {
            // Claim the folder after solving, because the claim removes the earlier tables.
            Ok(solved) => Ok(Some((solved, Claim::take(&self.folder, self.maker)?))),
            Err(stopped @ AnalysisError::Stopped { .. }) => {
                note(&format!(
                    "{stopped}, which are kept; to continue, run the same command again"
                ));
                Ok(None)
            }
            Err(error) => Err(error).with_context(|| self.definition.path.display().to_string()),
        }
    }
}

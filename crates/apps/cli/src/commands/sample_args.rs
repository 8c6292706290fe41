//! What the commands that solve samples share: arguments, and the folder in which samples and tables are kept.

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;
use results::{Claim, Maker, RunFolder};
use sweep::Sweep;
use uncertainty::{NoAnalysis, SampleStore};

use super::options::SolveOptions;
use super::source::{Definition, folder_within};
use crate::interrupt::Interrupt;
use crate::print::note;
use crate::progress::Display;

/// How samples are solved, and where they are kept.
#[derive(Debug, Args)]
pub struct SampleArgs {
    /// Folder for the tables [default: one of the command's name in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub solving: SolveOptions,
}

/// What is said when the first signal has come.
const ENDING: &str = "ending after the samples in progress; a second signal ends at once, and the same command continues";

/// The folder in which samples are kept and tables are written.
pub struct SampleFolder<'a> {
    definition: &'a Definition,
    arguments: &'a SampleArgs,
    maker: Maker,
    pub folder: RunFolder,
}

impl<'a> SampleFolder<'a> {
    /// The folder of the command called `name`. One that holds files of others is refused before hours of work, and not behind them.
    pub fn new(
        (definition, sweep): (&'a Definition, &Sweep),
        arguments: &'a SampleArgs,
        (name, maker): (&str, Maker),
    ) -> anyhow::Result<Self> {
        let default = || folder_within(definition, sweep, name);
        let folder = RunFolder::new(arguments.out.clone().unwrap_or_else(default));
        Claim::check(&folder, maker)?;
        Ok(Self { definition, arguments, maker, folder })
    }

    /// What `solve` makes of so many `samples`, and the claim on the tables; `None`, and a word about it, if it was told to stop.
    pub fn solved<T: Send>(
        &self,
        (samples, interrupt): (u64, &Interrupt),
        solve: impl FnOnce(&SampleStore) -> Result<T, NoAnalysis> + Send,
    ) -> anyhow::Result<Option<(T, Claim<'_>)>> {
        let store = SampleStore::new(&self.folder.file("samples"));
        interrupt.ask_first();
        store.work().begin(samples);
        let display =
            Display::new(self.arguments.solving.quiet, interrupt, store.work().clone(), ENDING);
        let solved = self.arguments.solving.threads.pool()?.install(|| solve(&store));
        drop(display);
        match solved {
            // Claimed now, and not before the samples: a claim removes the tables of the last time.
            Ok(solved) => Ok(Some((solved, Claim::take(&self.folder, self.maker)?))),
            Err(stopped @ NoAnalysis::Stopped { .. }) => {
                note(&format!("{stopped}, which are kept; the same command continues from them"));
                Ok(None)
            }
            Err(error) => Err(error).with_context(|| self.definition.path.display().to_string()),
        }
    }
}

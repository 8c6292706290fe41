//! The command `squama validate`, which writes the validation page.

use std::path::PathBuf;

use anyhow::ensure;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use sweep::Sweep;
use validation::{PartProgress, SettingSearch, Validation};

use super::figure_file::write_file;
use super::source::require_folder_of;
use super::{DONE, INCOMPLETE};
use crate::print::print;

/// Arguments of `squama validate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama validate
  squama validate --out validation.md
  squama validate --search sweeps/open-questions.toml sweeps/gaps.toml

Solves problems with known answers, both sweeps of the paper, sweeps over what the paper leaves open, and
searches between the grid points; prints the tables and writes them to a page. Takes half a minute on two
cores, half of it for the searches. With --search, checks the claims for every setting of sweeps over
what the paper leaves open, and prints which claims each setting reproduces.
Exit code: 0 done, 1 a benchmark is outside its band, 2 a disk error. Claims do not affect the exit code.")]
pub struct Arguments {
    /// Page to write
    #[arg(long, value_name = "FILE", default_value = "docs/validation.md")]
    pub out: PathBuf,

    /// Skip the searches between the grid points
    #[arg(long)]
    pub quick: bool,

    /// Sweeps over choices that the paper leaves open; shows which settings reproduce most claims
    #[arg(long, value_name = "SWEEP.toml", num_args = 1.., conflicts_with_all = ["out", "quick"])]
    pub search: Vec<PathBuf>,
}

/// Runs the validation, prints its page and writes it to a file.
pub fn validate(arguments: &Arguments) -> anyhow::Result<u8> {
    if !arguments.search.is_empty() {
        let sweeps = arguments.search.iter().map(|path| Sweep::read(path, &[]));
        let sweeps = sweeps.collect::<Result<Vec<_>, _>>()?;
        print(&with_bar(|progress| SettingSearch::run(&sweeps, progress))?.table())?;
        return Ok(DONE);
    }
    let out = &arguments.out;
    // Check the path of the page before solving, which takes half a minute.
    ensure!(
        out.file_name().is_some(),
        "--out {}: not accepted, expected the name of a file",
        out.display()
    );
    require_folder_of("--out", out)?;
    let validation = with_bar(|progress| Validation::run(!arguments.quick, progress))?;
    let page = validation.page();
    write_file(out, page.as_bytes())?;
    print(&page)?;
    let outside: Vec<_> = validation.benchmarks.iter().filter(|b| !b.is_within_band()).collect();
    for benchmark in &outside {
        print(&format!("outside its band: {}\n", benchmark.row()))?;
    }
    // A claim of the paper that squama does not reproduce may be wrong, so only benchmarks
    // determine the exit code.
    Ok(if outside.is_empty() { DONE } else { INCOMPLETE })
}

/// Runs `work` with a progress bar that names the current part.
fn with_bar<T>(
    work: impl FnOnce(&mut dyn FnMut(PartProgress<'_>)) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    let bar = ProgressBar::new(0);
    let template = "{wide_bar} {pos}/{len} parts  {elapsed}  {eta} left  {msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    let done = work(&mut |progress| {
        bar.set_length(progress.parts as u64);
        bar.set_position(progress.done as u64);
        bar.set_message(progress.part.to_owned());
    });
    bar.finish_and_clear();
    done
}

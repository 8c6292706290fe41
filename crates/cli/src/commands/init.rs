//! `squama init`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use clap::Args;
use clap::builder::PossibleValuesParser;
use sweep::Sweep;

use super::DONE;
use super::source::require_folder_of;
use crate::print::{counted, print};
use crate::templates;

/// Arguments of `squama init`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama init                       the sweep of the paper, in paper.toml
  squama init smoke mine.toml       a dozen designs, as a sweep of the name mine

Every key that may be set is explained in the definition of the paper. A file that exists is left alone.
Exit code: 0 done, 2 bad input or disk.")]
pub struct Arguments {
    /// Definition to begin with
    #[arg(value_name = "TEMPLATE", default_value = "paper", value_parser = PossibleValuesParser::new(templates::names()))]
    pub template: String,

    /// File of the definition; its name becomes that of the sweep [default: TEMPLATE.toml]
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
}

/// Writes a commented definition.
pub fn init(arguments: &Arguments) -> anyhow::Result<u8> {
    let template = &arguments.template;
    let default = || PathBuf::from(format!("{template}.toml"));
    let file = arguments.file.clone().unwrap_or_else(default);
    let shown = file.display().to_string();
    ensure!(
        file.symlink_metadata().is_err(),
        "{shown}: is there already, expected the name of a new file, e.g. squama init {template} mine.toml"
    );
    require_folder_of("FILE", &file)?;
    let name = file.file_stem().context("expected the name of a new file")?.to_string_lossy();
    let text = templates::text(template, &name, &shown).context("there is no such definition")?;
    // A name that is none of a sweep is refused before it is written.
    let sweep = Sweep::parse(&text, &shown, &[])?;
    let folder = file.parent().unwrap_or(Path::new(""));
    let file_name = file.file_name().unwrap_or_default().to_string_lossy();
    results::write_text(folder, &file_name, &text)?;
    let designs = counted(sweep.grid().len(), "design");
    print(&format!("{shown}: {designs}; to solve them: squama run {shown}\n"))?;
    Ok(DONE)
}

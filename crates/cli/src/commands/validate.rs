//! `squama validate`.

use std::path::Path;

use anyhow::Context as _;
use indicatif::{ProgressBar, ProgressStyle};
use sweep::Sweep;
use validation::{SettingSearch, Validation};

use super::source::require_folder_of;
use super::{DONE, INCOMPLETE};
use crate::args;
use crate::print::print;

/// Carries out the validation, prints its page and writes it down.
pub fn validate(arguments: &args::ValidateArguments) -> anyhow::Result<u8> {
    if let Some(path) = &arguments.search {
        print(&SettingSearch::run(Sweep::read(path, &[])?)?.table())?;
        return Ok(DONE);
    }
    let out = &arguments.out;
    let name = out.file_name().with_context(|| {
        format!("--out {}: not accepted, expected the name of a file", out.display())
    })?;
    require_folder_of("--out", out)?;
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let validation = with_bar()?;
    let page = validation.page();
    results::write_text(folder, &name.to_string_lossy(), &page)?;
    print(&page)?;
    let outside: Vec<_> = validation.benchmarks.iter().filter(|b| !b.holds()).collect();
    for benchmark in &outside {
        print(&format!("outside of its band: {}\n", benchmark.row()))?;
    }
    Ok(if outside.is_empty() { DONE } else { INCOMPLETE })
}

/// Carries out the validation behind a bar on the terminal that names the part in hand.
fn with_bar() -> Result<Validation, validation::ValidationError> {
    let bar = ProgressBar::new(0);
    if let Ok(style) =
        ProgressStyle::with_template("{wide_bar} {pos}/{len} parts  {elapsed}  {msg}")
    {
        bar.set_style(style);
    }
    let validation = Validation::run(|progress| {
        bar.set_length(progress.parts as u64);
        bar.set_position(progress.done as u64);
        bar.set_message(progress.part.to_owned());
    });
    bar.finish_and_clear();
    validation
}

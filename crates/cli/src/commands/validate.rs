//! `squama validate`.

use std::path::Path;

use anyhow::Context as _;
use sweep::Sweep;
use validation::{Search, Validation};

use super::{DONE, INCOMPLETE};
use crate::args;
use crate::print::print;

/// Carries out the validation, prints its page and writes it down.
pub fn validate(arguments: &args::ValidateArguments) -> anyhow::Result<u8> {
    if let Some(path) = &arguments.search {
        print(&Search::run(Sweep::read(path, &[])?)?.table())?;
        return Ok(DONE);
    }
    let out = &arguments.out;
    let name = out.file_name().with_context(|| {
        format!("--out {}: not accepted, expected the name of a file", out.display())
    })?;
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    // What cannot be written in the end is refused in the beginning.
    results::make_folder(folder)?;
    let validation = Validation::run()?;
    let page = validation.page();
    results::write_text(folder, &name.to_string_lossy(), &page)?;
    print(&page)?;
    let outside: Vec<_> = validation.benchmarks.iter().filter(|b| !b.holds()).collect();
    for benchmark in &outside {
        print(&format!("outside of its band: {}\n", benchmark.row()))?;
    }
    Ok(if outside.is_empty() { DONE } else { INCOMPLETE })
}

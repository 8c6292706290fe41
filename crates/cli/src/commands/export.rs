//! `squama export`.

use super::DONE;
use super::source::{require_folder_of, results_folder};
use crate::args;
use crate::interrupt::Interrupt;
use crate::print::{aligned, counted, print};

/// Writes the tables of a run as one workbook.
pub fn export(arguments: &args::ExportArguments) -> anyhow::Result<u8> {
    // A disk that is full is told of in an error, and not by whatever panics over it.
    std::panic::set_hook(Box::new(|_| ()));
    Interrupt::survive_file_limits()?;
    require_folder_of("--xlsx", &arguments.xlsx)?;
    let exported = report::export(&results_folder(&arguments.results)?, &arguments.xlsx)?;
    let row = |(table, rows): &(String, u32)| [table.clone(), counted(u64::from(*rows), "row")];
    let rows: Vec<_> = exported.tables.iter().map(row).collect();
    print(&format!("{}\n{}", arguments.xlsx.display(), aligned(&rows)))?;
    Ok(DONE)
}

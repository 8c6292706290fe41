//! The command `squama slurm`, which writes the scripts for a Slurm cluster.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use clap::Args;
use results::{make_folder, write_text};
use sweep::Sweep;
use text::{shell_quoted, shell_word};

use super::DONE;
use super::options::whole;
use super::own_files::require_own;
use super::source::{Definition, folder_of, read};
use crate::print::print;

/// Arguments of `squama slurm`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama slurm sweeps/paper.toml --shards 20
  results/paper/slurm/submit.sh --time=12:00:00 --cpus-per-task=4

Writes submit.sh and the complete definition to DIR/slurm. submit.sh submits a job array with one element for
each shard, and a job that merges the shards. Shards write to DIR/shards, the merged sweep to DIR. Shards
that are submitted again continue where they stopped. The folder may be moved.
Exit code: 0 done, 2 bad input or a disk error.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Number of shards (elements of the job array), 1 to 1000
    // The parser accepts any number, because the function `check` explains the limit of Slurm.
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = whole::<0, { u64::MAX }>)]
    pub shards: u64,

    /// Results folder [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Names and texts of the scripts that are identical for every sweep.
const SCRIPTS: [(&str, &str); 3] = [
    ("submit.sh", include_str!("../../slurm/submit.sh")),
    ("array.sh", include_str!("../../slurm/array.sh")),
    ("merge.sh", include_str!("../../slurm/merge.sh")),
];

/// Largest index of a job array, one less than the default 1001 of Slurm's `MaxArraySize`.
const LARGEST: u64 = 1000;

/// Writes the scripts that run a sweep as a job array.
pub fn slurm(arguments: &Arguments) -> anyhow::Result<u8> {
    let sweep = read(&arguments.definition)?;
    check(arguments.shards, &sweep)?;
    let results = folder_of(&sweep, arguments.out.as_deref());
    let folder = results.join("slurm");
    make_folder(&folder)?;
    for (name, text) in SCRIPTS {
        require_own(&folder.join(name))?;
        write_text(&folder, name, text)?;
        make_executable(&folder.join(name))?;
    }
    for name in ["sweep.sh", "sweep.toml"] {
        require_own(&folder.join(name))?;
    }
    write_text(&folder, "sweep.sh", &settings(&sweep, arguments.shards)?)?;
    // Write the complete definition with all defaults, so that shards submitted later use the same
    // settings, also with another version of squama.
    let definition = format!("# Written by squama slurm.\n{}", sweep.to_toml());
    write_text(&folder, "sweep.toml", &definition)?;
    print(&format!(
        "{}: sweep.toml sweep.sh submit.sh array.sh merge.sh\n\
         {} designs in {} shards; to submit them: {}\n",
        folder.display(),
        sweep.grid().len(),
        arguments.shards,
        shell_word(&folder.join("submit.sh").display().to_string())
    ))?;
    Ok(DONE)
}

/// Rejects a number of shards beyond the limit of Slurm or the number of designs.
fn check(shards: u64, sweep: &Sweep) -> anyhow::Result<()> {
    ensure!(
        (1..=LARGEST).contains(&shards),
        "--shards {shards}: expected 1 to {LARGEST}, the largest index of a job array in Slurm \
         (MaxArraySize is {} by default); a shard may have any number of designs",
        LARGEST + 1
    );
    let designs = sweep.grid().len();
    ensure!(
        shards <= designs,
        "--shards {shards}: there are only {designs} designs, expected 1 to {designs}"
    );
    Ok(())
}

/// Returns the text of `sweep.sh`, which contains the settings of the scripts for this sweep.
fn settings(sweep: &Sweep, shards: u64) -> anyhow::Result<String> {
    // The variable SQUAMA overrides this path, because the program may lie elsewhere on the nodes.
    let program = std::env::current_exe().context("the path of squama is not known")?;
    Ok(format!(
        "# Settings of the scripts in this folder for the sweep in sweep.toml. Written by squama slurm.\n\
         NAME={}\n\
         # Shards can be resumed only while this number is unchanged.\n\
         SHARDS={shards}\n\
         # Path of squama on the nodes.\n\
         SQUAMA=${{SQUAMA:-{}}}\n",
        shell_quoted(sweep.name()),
        shell_quoted(&program.display().to_string())
    ))
}

#[cfg(unix)]
fn make_executable(script: &Path) -> anyhow::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    let permissions = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(script, permissions)
        .with_context(|| format!("{}: cannot be made executable", script.display()))
}

#[cfg(not(unix))]
fn make_executable(_: &Path) -> anyhow::Result<()> {
    Ok(())
}

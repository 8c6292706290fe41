//! Tests of the `squama` program: exit codes, messages and files of its commands.

mod agreement;
mod bad_input;
mod cliffs;
mod clusters;
mod contents;
mod couplings;
mod design;
mod failure;
mod first_steps;
mod fits;
mod fronts;
mod guarantees;
mod images;
mod imperfections;
mod interruptions;
mod json;
mod json_schema;
mod kills;
mod making;
mod materials;
mod optimising;
mod output;
mod process;
mod rankings;
mod reruns;
mod runs;
mod sampled_searches;
mod schema;
mod searches;
mod selection;
mod shards;
mod table;
mod tolerances;
mod tutorial;
mod validation;
mod workbooks;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::TempDir;

/// A sweep of eight designs: upright and slanted scales, with and without contact.
const FEW: &str = "name = 'few'\n[designs]\ngap_over_t = [0.1, 0.5]\nlength_over_t = [0.2, 1]\n\
                   slant_deg = [0, 45]\n[puncture]\nscales = 21\n";

/// Returns true if `SQUAMA_CAMPAIGNS=long` requests long campaigns.
fn long_campaigns() -> bool {
    std::env::var_os("SQUAMA_CAMPAIGNS").is_some_and(|value| value == "long")
}

/// A temporary folder, initially empty, in which tests run `squama`.
struct Place {
    folder: TempDir,
}

impl Place {
    fn new() -> Self {
        Self { folder: TempDir::new().expect("a folder") }
    }

    /// Creates a folder with the file `x.toml`, which contains `text`.
    fn with(text: &str) -> Self {
        let place = Self::new();
        std::fs::write(place.path("x.toml"), text).expect("writable");
        place
    }

    /// Returns the path of a file in the folder.
    fn path(&self, file: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(file)
    }

    /// Returns the text of a file in the folder.
    fn read(&self, file: &str) -> String {
        std::fs::read_to_string(self.path(file)).expect("a file")
    }

    /// Returns the sorted names of the files in the subfolder `folder`, separated by spaces.
    fn list(&self, folder: &str) -> String {
        let entries = std::fs::read_dir(self.path(folder)).expect("a folder");
        let mut names: Vec<_> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names.join(" ")
    }

    /// Returns the command `squama` with `arguments`, a text that is split at spaces.
    fn squama(&self, arguments: &str) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("squama"));
        command.current_dir(self.folder.path()).args(arguments.split_whitespace());
        command
    }

    /// Returns the command `squama` with `arguments`, which may contain spaces.
    fn squama_with(&self, arguments: &[String]) -> Command {
        let mut command = self.squama("");
        command.args(arguments);
        command
    }

    /// Runs `squama` with a limit on the size of files, and returns its error message.
    ///
    /// The limit is a number of blocks of 512 or 1024 bytes. The command must fail.
    fn refused_on_a_full_disk(&self, blocks: u32, arguments: &str) -> String {
        let squama = assert_cmd::cargo::cargo_bin!("squama").display();
        let output = std::process::Command::new("sh")
            .args(["-c", &format!("ulimit -f {blocks}; exec {squama} {arguments}")])
            .current_dir(self.path(""))
            .output()
            .expect("a shell");
        let message = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{blocks}: {message}");
        message
    }

    /// Runs `squama`, which must fail, and returns its error message.
    ///
    /// The message must be one line, and there must be no other output.
    fn refused(&self, arguments: &str) -> String {
        let assert = self.squama(arguments).assert().code(2).stdout("");
        let message = String::from_utf8(assert.get_output().stderr.clone()).expect("text");
        assert_eq!(message.lines().count(), 1, "{message}");
        message
    }

    /// Returns the error message of `squama optimise` for a modified goal.
    ///
    /// The goal is `goal` with `from` replaced by `to`. The message must be one line, and no file
    /// may be written.
    fn refused_goal(goal: &str, from: &str, to: &str) -> String {
        assert!(goal.contains(from), "{from}");
        let place = Self::with(&goal.replace(from, to));
        let message = place.refused("optimise x.toml");
        assert_eq!(place.list("."), "x.toml", "no file is written");
        message
    }

    /// Runs `squama`, which must succeed, and returns its output.
    fn prints(&self, arguments: &str) -> String {
        let output = self.squama(arguments).assert().code(0).get_output().stdout.clone();
        String::from_utf8(output).expect("text")
    }
}

//! Records the source revision in the program.
//!
//! The revision is the commit of a clean checkout. In any other build, the revision also contains a
//! hash of the sources. Builds of different sources therefore have different revisions, and a
//! program does not resume results that other sources computed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo:rustc-env=SQUAMA_REVISION={}", revision());
    println!("cargo:rerun-if-changed=../..");
    println!("cargo:rerun-if-changed=../../../Cargo.lock");
    println!("cargo:rerun-if-changed=../../../Cargo.toml");
    for file in ["HEAD", "index"] {
        if let Some(path) = git(&["rev-parse", "--git-path", file]) {
            println!("cargo:rerun-if-changed={path}");
        }
    }
}

fn revision() -> String {
    if let Some(commit) = packaged_commit() {
        return commit;
    }
    match commit() {
        Some((commit, true)) => commit,
        Some((commit, false)) => format!("{commit}-dirty-{}", sources()),
        None => format!("sources-{}", sources()),
    }
}

/// Returns the commit that Cargo recorded in a published package.
///
/// A published package contains neither a git repository nor the other crates. If it was packaged
/// with uncommitted changes, a hash of its sources is appended to the commit.
fn packaged_commit() -> Option<String> {
    let info = fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let (_, commit) = info.split_once("\"sha1\": \"")?;
    let commit = commit.get(..12)?.to_owned();
    if !info.contains("\"dirty\": true") {
        return Some(commit);
    }
    let mut files = vec![PathBuf::from("Cargo.toml"), PathBuf::from("Cargo.lock")];
    collect(Path::new("src"), &mut files);
    Some(format!("{commit}-dirty-{}", hash(files)))
}

/// Returns the current commit, and true if all tracked files are unchanged since this commit.
fn commit() -> Option<(String, bool)> {
    // If this source is a copy within another repository, git does not track this file. The commit
    // of that repository is not the revision of this source.
    git(&["ls-files", "--error-unmatch", "Cargo.toml"])?;
    let revision = git(&["rev-parse", "--short=12", "HEAD"])?;
    let changes = git(&["status", "--porcelain", "--untracked-files=no"])?;
    Some((revision, changes.is_empty()))
}

/// Returns a hash of the sources of all crates, the workspace manifest and the lock file.
fn sources() -> String {
    let mut files =
        vec![PathBuf::from("../../../Cargo.toml"), PathBuf::from("../../../Cargo.lock")];
    collect(Path::new("../.."), &mut files);
    hash(files)
}

/// Returns a hash of the names and contents of files.
fn hash(mut files: Vec<PathBuf>) -> String {
    files.sort();
    let mut hash = Fnv::default();
    for file in files {
        hash.add(file.to_string_lossy().as_bytes());
        hash.add(&fs::read(&file).unwrap_or_default());
    }
    format!("{:016x}", hash.state)
}

/// Appends the files below `folder` to `files`, without tests, benches and Python sources.
///
/// The omitted files do not affect the program.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = entry.file_name();
        if path.is_dir()
            && !["tests", "benches", "target", "python"].iter().any(|other| name == **other)
        {
            collect(&path, files);
        } else if path.is_file() {
            files.push(path);
        }
    }
}

/// The 64-bit hash FNV-1a, implemented here because the build script has no dependencies.
///
/// See Fowler, Noll & Vo, draft-eastlake-fnv.
struct Fnv {
    state: u64,
}

impl Default for Fnv {
    fn default() -> Self {
        Self { state: 0xcbf2_9ce4_8422_2325 }
    }
}

impl Fnv {
    /// Adds `bytes`, followed by their number, to the hash.
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().chain(&(bytes.len() as u64).to_le_bytes()) {
            self.state = (self.state ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

//! Tells the program which revision of its source it is made from.

use std::process::Command;

fn main() {
    println!("cargo:rustc-env=SQUAMA_REVISION={}", revision().unwrap_or("unknown".to_owned()));
    println!("cargo:rerun-if-changed=..");
    for file in ["HEAD", "index"] {
        if let Some(path) = git(&["rev-parse", "--git-path", file]) {
            println!("cargo:rerun-if-changed={path}");
        }
    }
}

fn revision() -> Option<String> {
    // A copy of the source inside of another repository has no revision of its own.
    git(&["ls-files", "--error-unmatch", "build.rs"])?;
    let revision = git(&["rev-parse", "--short=12", "HEAD"])?;
    let changes = git(&["status", "--porcelain", "--untracked-files=no"])?;
    Some(if changes.is_empty() { revision } else { format!("{revision}-dirty") })
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

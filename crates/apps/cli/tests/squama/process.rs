//! A running `squama` process, observed by a test.
//!
//! Every wait has a timeout. It is an error if the process ends too early or the expected event
//! does not occur.

#[cfg(unix)]
use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Timeout for an expected event, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// Polling interval.
const PAUSE: Duration = Duration::from_millis(2);

/// A running process; dropping it kills the process.
pub struct Running {
    child: Child,
}

/// Returns the command with default signal handling.
///
/// A shell may start the tests in the background with signals ignored, which children inherit.
fn squama() -> Command {
    let program = assert_cmd::cargo::cargo_bin!("squama");
    let listening = "--default-signal=HUP,INT,TERM";
    let can = Command::new("env").args([listening, "true"]).stderr(Stdio::null()).status();
    if can.is_ok_and(|status| status.success()) {
        let mut command = Command::new("env");
        command.arg(listening).arg(program);
        command
    } else {
        Command::new(program)
    }
}

impl Running {
    /// Starts `squama` in `folder` with `arguments` separated by spaces.
    pub fn spawn(folder: &Path, arguments: &str) -> Self {
        let child = squama()
            .args(arguments.split_whitespace())
            .current_dir(folder)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn();
        Self { child: child.expect("the command") }
    }

    /// Waits until `happened` returns true.
    pub fn until(&mut self, happened: impl Fn() -> bool) {
        let begun = Instant::now();
        while !happened() {
            let ended = self.child.try_wait().expect("a process");
            assert_eq!(ended, None, "the process ended before the expected event");
            assert!(
                begun.elapsed() < PATIENCE,
                "the expected event did not occur within {PATIENCE:?}"
            );
            sleep(PAUSE);
        }
    }

    /// Waits until the process prints `word` on standard error.
    #[cfg(unix)]
    pub fn until_said(&mut self, word: &str) {
        let mut said = vec![0; word.len()];
        self.child.stderr.as_mut().expect("a pipe").read_exact(&mut said).expect("a word");
        assert_eq!(String::from_utf8_lossy(&said), word);
    }

    /// Returns the exit status if the process ends within `time`.
    pub fn end_within(&mut self, time: Duration) -> Option<ExitStatus> {
        let begun = Instant::now();
        loop {
            let ended = self.child.try_wait().expect("a process");
            let left = time.saturating_sub(begun.elapsed());
            if ended.is_some() || left.is_zero() {
                return ended;
            }
            sleep(left.min(PAUSE));
        }
    }

    /// Returns the exit status of a process that ends by itself.
    pub fn end(&mut self) -> ExitStatus {
        self.end_within(PATIENCE).expect("the process ends")
    }

    /// Kills the process.
    ///
    /// The exit status has a code only if the process had ended before.
    pub fn kill(&mut self) -> ExitStatus {
        self.child.kill().expect("a process");
        self.child.wait().expect("an end")
    }

    /// Sends a signal to the process.
    #[cfg(unix)]
    pub fn send(&self, signal: i32) {
        let kill = format!("kill -{signal} {}", self.child.id());
        let status = Command::new("sh").args(["-c", &kill]).status();
        assert!(status.expect("a shell").success());
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Both have no effect on a process that has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

//! Starts `squama` as a background process, and waits for events.
//!
//! Every wait has a timeout. A test fails if the process ends before the expected event, or if the
//! event does not occur in time.

#[cfg(unix)]
use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Time in which an expected event must occur, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// Time between two checks for an event.
const PAUSE: Duration = Duration::from_millis(2);

/// A running process; dropping it kills the process.
pub struct Running {
    child: Child,
}

/// Returns the command `squama` with default signal handling.
///
/// A shell that runs the tests in the background may ignore signals. Child processes would also
/// ignore these signals, and `squama` would never receive them.
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
    /// Starts `squama` in `folder` with `arguments`, a text that is split at spaces.
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

    /// Waits until the process prints `text` as its next output on standard error.
    #[cfg(unix)]
    pub fn until_printed(&mut self, text: &str) {
        let mut printed = vec![0; text.len()];
        self.child.stderr.as_mut().expect("a pipe").read_exact(&mut printed).expect("a text");
        assert_eq!(String::from_utf8_lossy(&printed), text);
    }

    /// Returns the exit status if the process ends within `time`, otherwise `None`.
    pub fn end_within(&mut self, time: Duration) -> Option<ExitStatus> {
        let begun = Instant::now();
        loop {
            let ended = self.child.try_wait().expect("a process");
            let remaining = time.saturating_sub(begun.elapsed());
            if ended.is_some() || remaining.is_zero() {
                return ended;
            }
            sleep(remaining.min(PAUSE));
        }
    }

    /// Waits until the process ends by itself, and returns its exit status.
    pub fn end(&mut self) -> ExitStatus {
        self.end_within(PATIENCE).expect("the process ends")
    }

    /// Kills the process and returns its exit status.
    ///
    /// The status has an exit code only if the process had ended by itself before the kill.
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
        // The calls fail, without consequences, if the process has already ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

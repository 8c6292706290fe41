//! A process of `squama` that goes on while a test watches it. No wait is without an end: a process that dies too
//! early, or does not do what is waited for, is an error.

#[cfg(unix)]
use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Timeout for an expected event, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// How often a test looks whether it has happened.
const PAUSE: Duration = Duration::from_millis(2);

/// A process that is killed, if it is still there, when the test is done with it.
pub struct Running {
    child: Child,
}

/// The command, with the signals listened to that whoever runs the tests may have it ignore, as a shell does in the background.
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

    /// Waits until something `happened` that the process does.
    pub fn until(&mut self, happened: impl Fn() -> bool) {
        let begun = Instant::now();
        while !happened() {
            let ended = self.child.try_wait().expect("a process");
            assert_eq!(ended, None, "the process ended before it did what is waited for");
            assert!(begun.elapsed() < PATIENCE, "waited in vain for {PATIENCE:?}");
            sleep(PAUSE);
        }
    }

    /// Waits until the process says `word` on its standard error.
    #[cfg(unix)]
    pub fn until_said(&mut self, word: &str) {
        let mut said = vec![0; word.len()];
        self.child.stderr.as_mut().expect("a pipe").read_exact(&mut said).expect("a word");
        assert_eq!(String::from_utf8_lossy(&said), word);
    }

    /// The exit status of the process, if it ends within `time`.
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

    /// The exit status of a process that ends by itself.
    pub fn end(&mut self) -> ExitStatus {
        self.end_within(PATIENCE).expect("the process ends")
    }

    /// The exit status of a process that is sent a signal again and again until it ends.
    #[cfg(unix)]
    pub fn end_by(&mut self, signal: i32) -> ExitStatus {
        let begun = Instant::now();
        loop {
            self.send(signal);
            if let Some(status) = self.end_within(Duration::from_millis(200)) {
                return status;
            }
            assert!(begun.elapsed() < PATIENCE, "sent in vain for {PATIENCE:?}");
        }
    }

    /// Kills the process; its exit status has no code unless it was done before.
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
        // Both do nothing to a process that has been waited for.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

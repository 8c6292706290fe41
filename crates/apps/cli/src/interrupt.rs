//! Handles termination signals.
//!
//! After the first signal, commands that solve many designs discard the designs in progress and
//! save the completed designs. Every other command removes its partial files and exits.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::flag;

/// Difference between the exit code after a signal and the signal number, as in shells.
const BASE: u8 = 128;

/// State that the signal handlers share with the running command.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    /// True if the first signal requests a graceful end instead of ending the process.
    is_graceful: Arc<AtomicBool>,
    /// True once a signal has requested a graceful end.
    stop: Arc<AtomicBool>,
    /// Number of the signal that requested the graceful end; 0 if there was none.
    signal: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Installs the signal handlers.
    ///
    /// After this call, exceeding the file size limit is a write error and does not end the
    /// process.
    pub fn listen() -> io::Result<Self> {
        let interrupt = Self::default();
        system::listen(interrupt.clone())?;
        Ok(interrupt)
    }

    /// From now on, lets the first signal request a graceful end instead of ending the process.
    pub fn end_gracefully(&self) {
        self.is_graceful.store(true, Ordering::Relaxed);
    }

    /// Returns the flag that is true once a signal has requested a graceful end.
    pub fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    /// Returns the exit code if a signal has requested a graceful end.
    pub fn exit_code(&self) -> Option<u8> {
        let signal = u8::try_from(self.signal.load(Ordering::Relaxed)).unwrap_or_default();
        (signal > 0).then(|| BASE + signal)
    }
}

#[cfg(unix)]
mod system {
    use std::thread;
    use std::time::{Duration, Instant};

    use results::exit_without_partial_files;
    use run::interrupt_paths;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;

    use super::{Arc, BASE, Interrupt, Ordering, flag, io};

    /// Time after the first signal in which further signals belong to the same request.
    ///
    /// The program `timeout` sends one signal to the process and one to its process group.
    const ONE_REQUEST: Duration = Duration::from_secs(1);

    pub fn listen(interrupt: Interrupt) -> io::Result<()> {
        // With a handler, SIGXFSZ (file size limit) does not end the process; the write returns an
        // error instead.
        flag::register(SIGXFSZ, Arc::default())?;
        // Signals that are ignored at the start stay ignored, so that `nohup` has its effect.
        let handled = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal));
        let mut signals = Signals::new(handled)?;
        thread::Builder::new()
            .name("signals".to_owned())
            .spawn(move || {
                let mut first_request: Option<Instant> = None;
                for signal in signals.forever() {
                    // This thread removes partial files, because a signal handler may call only
                    // async-signal-safe functions.
                    let is_request = interrupt.is_graceful.load(Ordering::Relaxed)
                        && first_request.is_none_or(|first| first.elapsed() < ONE_REQUEST);
                    if !is_request {
                        exit_without_partial_files(signal + i32::from(BASE));
                    }
                    first_request.get_or_insert_with(Instant::now);
                    let number = usize::try_from(signal).unwrap_or_default();
                    // The first signal determines the exit code.
                    let first = interrupt.signal.compare_exchange(
                        0,
                        number,
                        Ordering::Relaxed,
                        Ordering::Relaxed,
                    );
                    if first.is_ok() {
                        // Set `stop` before interrupting the paths in progress, so that a worker
                        // does not start another design after an interrupted one.
                        interrupt.stop.store(true, Ordering::SeqCst);
                        interrupt_paths();
                    }
                }
            })
            .map(|_| ())
    }

    /// Returns true if the process ignores `signal` from its start, as under `nohup`.
    ///
    /// The function reads `/proc`, so it returns false on systems other than Linux.
    fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        // Bit n − 1 of the mask is signal n.
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
    }
}

#[cfg(not(unix))]
mod system {
    use signal_hook::consts::{SIGINT, SIGTERM};

    use super::{Arc, Interrupt, flag, io};

    pub fn listen(interrupt: Interrupt) -> io::Result<()> {
        for signal in [SIGINT, SIGTERM] {
            // Handlers run in the order of registration. The conditional shutdown is registered
            // before the flag `stop`, so that only a second signal ends the process.
            let code = signal + i32::from(super::BASE);
            flag::register_conditional_shutdown(signal, code, Arc::clone(&interrupt.stop))?;
            let number = usize::try_from(signal).unwrap_or_default();
            flag::register_usize(signal, Arc::clone(&interrupt.signal), number)?;
            flag::register(signal, Arc::clone(&interrupt.stop))?;
        }
        Ok(())
    }
}

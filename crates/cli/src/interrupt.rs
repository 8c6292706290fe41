//! Signals that ask a run to end.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// A shell adds this to the number of a signal that ended a process.
const BASE: u8 = 128;

/// Listens to SIGINT and SIGTERM: the first asks the run to end, the second ends the process.
pub struct Interrupt {
    stop: Arc<AtomicBool>,
    signal: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Begins to listen.
    pub fn listen() -> io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let signal = Arc::new(AtomicUsize::new(0));
        let asked = Arc::new(AtomicBool::new(false));
        for number in [SIGINT, SIGTERM] {
            // In this order, so that the first signal does not meet its own flag.
            let code = number + i32::from(BASE);
            flag::register_conditional_shutdown(number, code, Arc::clone(&asked))?;
            flag::register(number, Arc::clone(&asked))?;
            let known = usize::try_from(number).unwrap_or_default();
            flag::register_usize(number, Arc::clone(&signal), known)?;
            flag::register(number, Arc::clone(&stop))?;
        }
        Self::survive_file_limits()?;
        Ok(Self { stop, signal })
    }

    /// Set once the run is asked to end.
    pub fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    /// The exit code of a run that was asked to end.
    pub fn exit_code(&self) -> Option<u8> {
        let signal = u8::try_from(self.signal.load(Ordering::Relaxed)).unwrap_or_default();
        (signal > 0).then(|| BASE + signal)
    }

    /// A file that may not grow any more is an error like a full disk, not the end of the process.
    #[cfg(unix)]
    pub fn survive_file_limits() -> io::Result<()> {
        flag::register(signal_hook::consts::SIGXFSZ, Arc::default()).map(|_| ())
    }

    /// Elsewhere it is an error anyway.
    #[cfg(not(unix))]
    pub fn survive_file_limits() -> io::Result<()> {
        Ok(())
    }
}

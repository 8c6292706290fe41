//! The functions exported by the WebAssembly module.
//!
//! A page writes a request as UTF-8 to the address that [`squama_room`] returns, and calls
//! [`squama_answer`] with the length of the request. It then calls [`squama_room`] again for the
//! address of the answer, and reads the number of bytes that [`squama_answer`] returned.
#![allow(unsafe_code)]

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use crate::Solver;

/// The solver and the buffer for requests and answers.
static MODULE: LazyLock<Mutex<(Solver, Vec<u8>)>> = LazyLock::new(Mutex::default);

fn module() -> MutexGuard<'static, (Solver, Vec<u8>)> {
    // A poisoned lock is harmless: after a failed request the cached springs are complete, and the
    // next request overwrites the buffer.
    MODULE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reserves `length` bytes for a request, and returns the address of the buffer.
#[unsafe(no_mangle)]
pub extern "C" fn squama_room(length: usize) -> *const u8 {
    let mut module = module();
    if module.1.len() < length {
        module.1.resize(length, 0);
    }
    module.1.as_ptr()
}

/// Answers the request in the first `length` bytes of the buffer.
///
/// Returns the length of the answer in the buffer.
#[unsafe(no_mangle)]
pub extern "C" fn squama_answer(length: usize) -> usize {
    let mut module = module();
    let (solver, bytes) = &mut *module;
    let request = String::from_utf8_lossy(&bytes[..length.min(bytes.len())]).into_owned();
    *bytes = solver.answer(&request).into_bytes();
    bytes.len()
}

//! The names that a module of WebAssembly exports.
//!
//! A page writes a request as UTF-8 to where [`squama_room`] points, calls [`squama_answer`] with its length, and reads that many
//! bytes as it returns from where [`squama_room`] points then.
#![allow(unsafe_code)]

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use crate::Solver;

/// The solver of the module, and the bytes that go in and out.
static MODULE: LazyLock<Mutex<(Solver, Vec<u8>)>> = LazyLock::new(Mutex::default);

fn module() -> MutexGuard<'static, (Solver, Vec<u8>)> {
    // A module has one thread; a request that failed leaves its own bytes and complete springs.
    MODULE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes room for `length` bytes of a request, if that is more than there is, and returns where.
#[unsafe(no_mangle)]
pub extern "C" fn squama_room(length: usize) -> *const u8 {
    let mut module = module();
    if module.1.len() < length {
        module.1.resize(length, 0);
    }
    module.1.as_ptr()
}

/// Answers the request that stands in the first `length` bytes of the room, and returns the length of the answer, which stands there then.
#[unsafe(no_mangle)]
pub extern "C" fn squama_answer(length: usize) -> usize {
    let mut module = module();
    let (solver, bytes) = &mut *module;
    let request = String::from_utf8_lossy(&bytes[..length.min(bytes.len())]).into_owned();
    *bytes = solver.answer(&request).into_bytes();
    bytes.len()
}

//! Answers requests from standard input, one per line.
//!
//! `scripts/check-wasm` compares these answers with the WebAssembly module.

use std::io::{self, BufRead as _};

fn main() -> io::Result<()> {
    let mut solver = wasm::Solver::default();
    for request in io::stdin().lock().lines() {
        println!("{}", solver.answer(&request?));
    }
    Ok(())
}

//! Answers requests, a line each, from standard input: what `scripts/check-wasm` compares the module of the pages with.

use std::io::{self, BufRead as _};

fn main() -> io::Result<()> {
    let mut solver = wasm::Solver::default();
    for request in io::stdin().lock().lines() {
        println!("{}", solver.answer(&request?));
    }
    Ok(())
}

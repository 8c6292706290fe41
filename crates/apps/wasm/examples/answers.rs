//! Answers requests from standard input, one per line, for comparison by `scripts/check-wasm`.

use std::io::{self, BufRead as _};

fn main() -> io::Result<()> {
    let mut solver = wasm::Solver::default();
    for request in io::stdin().lock().lines() {
        println!("{}", solver.answer(&request?));
    }
    Ok(())
}

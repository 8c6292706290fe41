//! Generates `src/table.bin`, the Chebyshev coefficients of the springs in [`substrate`]:
//!
//! ```text
//! nice cargo run --release -p squama-substrate --example table \
//!     -- crates/mechanics/substrate/src/table.bin
//! ```
//!
//! The computation takes four minutes of processor time. `src/table.rs` documents the layout.

use std::error::Error;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, thread};

use substrate::boundary_element::{Unresolved, row_reactions_at};
use substrate::table::{GAPS, NEAREST, RATIOS, ROW, WIDTHS, poisson_ratio};
use substrate::{Footprint, NEIGHBOURS};

/// Numbers of cells per side of the three meshes: `FINE` for rows of three scales, `COARSE` for
/// long rows.
///
/// For long rows the table stores only their small difference from rows of three scales.
const FINE: [usize; 3] = [12, 16, 20];
const COARSE: [usize; 3] = [6, 8, 10];

fn main() -> Result<(), Box<dyn Error>> {
    let path = env::args().nth(1).ok_or("the path of the table is missing")?;
    let mut numbers = coefficients(NEAREST, &|footprint| nearest(footprint))?;
    numbers.extend(coefficients(ROW, &|footprint| row(footprint))?);
    let bytes: Vec<u8> = numbers.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect();
    fs::write(path, bytes)?;
    Ok(())
}

/// Function that computes the values to be tabulated for a footprint.
type Solve<'a> = &'a (dyn Fn(&Footprint) -> Result<Vec<f64>, Unresolved> + Sync);

/// Computes the coefficients of the polynomials through `nodes × nodes` points.
///
/// The coefficients of one function of the footprint are contiguous.
fn coefficients(nodes: usize, solve: Solve<'_>) -> Result<Vec<f64>, Unresolved> {
    let next = AtomicUsize::new(0);
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let mut solved = thread::scope(|scope| {
        let threads: Vec<_> =
            (0..workers).map(|_| scope.spawn(|| solve_nodes(&next, nodes, solve))).collect();
        let found = threads.into_iter().map(|thread| thread.join().expect("no thread panics"));
        found.collect::<Result<Vec<_>, _>>().map(|parts| parts.concat())
    })?;
    solved.sort_by_key(|(number, _)| *number);
    let mut coefficients = Vec::new();
    for function in 0..solved[0].1.len() {
        let values: Vec<f64> = solved.iter().map(|(_, values)| values[function]).collect();
        let by_gap = transposed(&transform(&values, nodes), nodes);
        coefficients.extend(transposed(&transform(&by_gap, nodes), nodes));
    }
    Ok(coefficients)
}

/// Solves unsolved points until all are solved; returns their numbers and values.
///
/// `next` is the number of the next unsolved point, shared by all threads.
fn solve_nodes(
    next: &AtomicUsize,
    nodes: usize,
    solve: Solve<'_>,
) -> Result<Vec<(usize, Vec<f64>)>, Unresolved> {
    let mut solved = Vec::new();
    loop {
        let number = next.fetch_add(1, Ordering::Relaxed);
        if number >= nodes * nodes {
            return Ok(solved);
        }
        let [gap, width] = [(number / nodes, GAPS), (number % nodes, WIDTHS)]
            .map(|(k, [low, high])| low * (high / low).powf(0.5 + 0.5 * node(k, nodes)));
        let footprint = Footprint::new(gap, width, 0.5).expect("lengths are positive");
        solved.push((number, solve(&footprint)?));
    }
}

/// Transforms each row of a matrix with `nodes` columns to Chebyshev coefficients.
fn transform(values: &[f64], nodes: usize) -> Vec<f64> {
    let mut coefficients = Vec::with_capacity(values.len());
    for row in values.chunks(nodes) {
        for order in 0..nodes {
            let terms = row.iter().enumerate().map(|(k, value)| {
                value * (order as f64 * (k as f64 + 0.5) * PI / nodes as f64).cos()
            });
            let factor = if order == 0 { 1.0 } else { 2.0 };
            coefficients.push(terms.sum::<f64>() * factor / nodes as f64);
        }
    }
    coefficients
}

fn transposed(values: &[f64], nodes: usize) -> Vec<f64> {
    (0..nodes * nodes).map(|i| values[i % nodes * nodes + i / nodes]).collect()
}

/// Returns the root number `k` of the Chebyshev polynomial of order `nodes`.
fn node(k: usize, nodes: usize) -> f64 {
    ((k as f64 + 0.5) * PI / nodes as f64).cos()
}

/// Returns the values for Eq. (1) at a footprint.
///
/// First `ln α_y, ln α_φ, β_y/α_y, β_φ/α_φ`, then the coefficients of `ln α_x` and of `β_x/α_x` as
/// polynomials in `log(1 − ν)`.
fn nearest(footprint: &Footprint) -> Result<Vec<f64>, Unresolved> {
    let rows = extrapolated(footprint, 1, FINE)?;
    let part =
        |ratio: usize, direction: usize| -rows[ratio][3 + direction] / rows[ratio][direction];
    let normal = [rows[0][1].ln(), rows[0][2].ln(), part(0, 1), part(0, 2)];
    let direct = transform(&rows.iter().map(|row| row[0].ln()).collect::<Vec<_>>(), RATIOS);
    let coupling = transform(&(0..RATIOS).map(|ratio| part(ratio, 0)).collect::<Vec<_>>(), RATIOS);
    Ok(normal.into_iter().chain(direct).chain(coupling).collect())
}

/// Returns the differences of a long row from a row of three scales, divided by `α`.
///
/// First `y` and then `φ`, each for the scale itself and for its neighbours; then `c` divided by
/// `√(α_y α_φ)`; then the coefficients of `x` as polynomials in `log(1 − ν)`.
fn row(footprint: &Footprint) -> Result<Vec<f64>, Unresolved> {
    let long = extrapolated(footprint, NEIGHBOURS, COARSE)?;
    let short = extrapolated(footprint, 1, COARSE)?;
    let mut numbers = Vec::new();
    for direction in [1, 2] {
        numbers.extend((0..=NEIGHBOURS).map(|scale| added(&long[0], &short[0], scale, direction)));
    }
    let size = (short[0][1] * short[0][2]).sqrt();
    numbers.extend((1..=NEIGHBOURS).map(|scale| {
        f64::midpoint(reaction(&long[0], scale, 3), reaction(&long[0], scale, 4)) / size
    }));
    for scale in 0..=NEIGHBOURS {
        let by_ratio: Vec<f64> =
            long.iter().zip(&short).map(|(long, short)| added(long, short, scale, 0)).collect();
        numbers.extend(transform(&by_ratio, RATIOS));
    }
    Ok(numbers)
}

/// Returns the difference of a reaction between a long and a short row, divided by `α`.
fn added(long: &[f64], short: &[f64], scale: usize, direction: usize) -> f64 {
    (reaction(long, scale, direction) - reaction(short, scale, direction)) / short[direction]
}

/// Returns a reaction on the displaced scale (`scale` 0) or on its neighbour number `scale`.
///
/// Returns 0 for a neighbour beyond the end of the row.
fn reaction(row: &[f64], scale: usize, direction: usize) -> f64 {
    match scale {
        0 => row[direction],
        _ => row.get(3 + 5 * (scale - 1) + direction).copied().unwrap_or(0.0),
    }
}

/// Computes the reactions for the Poisson's ratios of the table, extrapolated from three meshes.
///
/// The error decreases with the third power of the number of cells. After the first extrapolation
/// the remainder decreases with the fourth power, so a second one follows.
fn extrapolated(
    footprint: &Footprint,
    neighbours: usize,
    cells: [usize; 3],
) -> Result<Vec<Vec<f64>>, Unresolved> {
    let ratios: Vec<f64> = (0..RATIOS).map(|k| poisson_ratio(node(k, RATIOS))).collect();
    let [coarse, medium, fine] = cells.map(|n| row_reactions_at(footprint, &ratios, neighbours, n));
    let meshes = coarse?.into_iter().zip(medium?).zip(fine?);
    let rows = meshes.map(|((coarse, medium), fine)| {
        let [coarse, medium, fine] = [coarse, medium, fine].map(|mesh| mesh.numbers());
        let check = limit([&coarse, &medium], [cells[0], cells[1]], 3);
        let best = limit([&medium, &fine], [cells[1], cells[2]], 3);
        limit([&check, &best], [cells[1], cells[2]], 4)
    });
    Ok(rows.collect())
}

/// Extrapolates from two meshes if the error falls with the power `order` of the number of cells.
fn limit([coarse, fine]: [&[f64]; 2], cells: [usize; 2], order: i32) -> Vec<f64> {
    let factor = 1.0 / ((cells[1] as f64 / cells[0] as f64).powi(order) - 1.0);
    coarse.iter().zip(fine).map(|(coarse, fine)| fine + (fine - coarse) * factor).collect()
}

//! The co-rotational beam: large deflections of a cantilever.

use super::Benchmark;
use super::frame::{Drive, Frame, Node};
use crate::Error;

/// Tip of the inextensible cantilever under a transverse load `P L²/EI`: deflection, shortening, rotation.
const TABLE: [(f64, [f64; 3]); 3] = [
    (1.0, [0.30172, 0.05643, 0.46135]),
    (5.0, [0.71379, 0.38763, 1.21537]),
    (10.0, [0.81061, 0.55500, 1.43029]),
];
/// Half a unit of the last digit of the table, and what is left of the finest mesh.
const DIGITS: f64 = 5e-6;
/// So stiff in tension that the cantilever does not stretch.
const AXIAL: f64 = 1e7;
/// Elements of the three meshes.
const MESHES: [usize; 3] = [8, 16, 64];

/// Deflection, shortening and rotation of the tip under a load; `None` if the path does not get there.
fn tip(elements: usize, load: f64) -> Option<[f64; 3]> {
    let place = |i: usize| Node::free([i as f64 / elements as f64, 0.0]);
    let mut nodes: Vec<_> = (0..=elements).map(place).collect();
    nodes[0].held = [true; 3];
    let end = Frame::new(nodes, AXIAL, elements, Drive::Load(load))?.path(0.02)?.pop()?;
    let at = 3 * elements;
    Some([-end.state.z[at + 1], -end.state.z[at], -end.state.z[at + 2]])
}

pub(super) fn benchmarks() -> Result<Vec<Benchmark>, Error> {
    let rows = TABLE.into_iter().map(|(load, reference)| {
        let missing = || Error::Benchmark(format!("no equilibrium of the cantilever at {load}"));
        let [coarse, medium, fine] = MESHES.map(|elements| tip(elements, load));
        let (coarse, medium) = (coarse.ok_or_else(missing)?, medium.ok_or_else(missing)?);
        let fine = fine.ok_or_else(missing)?;
        let names = ["deflection", "shortening", "rotation"];
        let error = move |tip: [f64; 3]| {
            (0..3).map(|k| (tip[k] - reference[k]).powi(2)).sum::<f64>().sqrt()
        };
        let order = (error(coarse) / error(medium)).log2();
        Ok((0..3).map(move |k| {
            let name = format!("cantilever, P L²/EI = {load}: {} of the tip", names[k]);
            // The error falls with the square of the element: what the finest mesh leaves, and the digits.
            let left = error(coarse) / 64.0;
            let band = (left + DIGITS) / reference[k];
            let values = [reference[k], fine[k]];
            Benchmark {
                order: Some(order),
                ..Benchmark::new(name, "Mattiasson 1981", values, band)
            }
        }))
    });
    Ok(rows.collect::<Result<Vec<_>, Error>>()?.into_iter().flatten().collect())
}

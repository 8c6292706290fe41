//! Paths past limit points: a toggle, and Lee's frame.

use super::Benchmark;
use super::frame::{Drive, Frame, Node};
use crate::Error;

pub(super) fn benchmarks() -> Result<Vec<Benchmark>, Error> {
    Ok(vec![toggle()?, lees_frame()?])
}

/// Half of a toggle: a bar from a hinge up to a slide. With the length `l` of the bar the load is
/// `P = EA (1/l − 1/L) h`, largest where `l³ = L b²`.
fn toggle() -> Result<Benchmark, Error> {
    let (base, height, axial) = (1.0_f64, 0.2_f64, 1e3);
    let hinge = Node { place: [0.0, 0.0], held: [true, true, false] };
    let slide = Node { place: [base, height], held: [true, false, false] };
    let rest = base.hypot(height);
    let limit = (rest * base * base).cbrt();
    let exact = axial * (1.0 / limit - 1.0 / rest) * (limit * limit - base * base).sqrt();
    let frame = Frame::new(vec![hinge, slide], axial, 1, Drive::Depth(2.5 * height));
    let load = frame.and_then(|frame| frame.limit_load(0.05));
    let ours = load.ok_or_else(|| Error::Benchmark("the toggle has no limit load".to_owned()))?;
    Ok(Benchmark::new("toggle that snaps through: limit load", "closed form", [exact, ours], 1e-9))
}

/// A hinged column that carries a hinged beam, loaded at a fifth of the beam.
fn lee(elements: usize, axial: f64) -> Option<f64> {
    let column = (0..elements).map(|i| [0.0, i as f64 / elements as f64]);
    let beam = (0..=elements).map(|i| [i as f64 / elements as f64, 1.0]);
    let mut nodes: Vec<_> = column.chain(beam).map(Node::free).collect();
    for end in [0, 2 * elements] {
        nodes[end].held = [true, true, false];
    }
    let loaded = elements + elements / 5;
    Frame::new(nodes, axial, loaded, Drive::Depth(0.6))?.limit_load(0.01)
}

fn lees_frame() -> Result<Benchmark, Error> {
    let missing = || Error::Benchmark("Lee's frame has no limit load".to_owned());
    // A thickness of a sixtieth of the length.
    let axial = 43_200.0;
    let [coarse, medium, fine] = [10, 20, 40].map(|elements| lee(elements, axial));
    let (coarse, medium) = (coarse.ok_or_else(missing)?, medium.ok_or_else(missing)?);
    let fine = fine.ok_or_else(missing)?;
    let order = ((coarse - medium) / (medium - fine)).abs().log2();
    let name = "Lee's frame: first limit load P L²/EI";
    let source = "Lee, Manuel & Rossow 1968, inextensible";
    Ok(Benchmark { order: Some(order), ..Benchmark::new(name, source, [18.552, fine], 5e-3) })
}

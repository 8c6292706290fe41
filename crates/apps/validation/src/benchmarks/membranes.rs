//! Benchmarks of the co-rotational beam: large deflections of a cantilever.

use analytical::elastica::{MATTIASSON, Tip};

use anyhow::Context as _;

use super::Benchmark;
use super::frame::{Drive, FrameNode, PlaneFrame};

/// Loads `P L²/EI`, for small, medium and large rotations.
const LOADS: [f64; 3] = [1.0, 5.0, 10.0];
/// Half a unit of the last digit in Mattiasson's table.
const DIGITS: f64 = 5e-6;
/// Axial stiffness of a cantilever with unit length and bending stiffness.
///
/// With this value, the strain at the largest load is only 1e-6.
const AXIAL: f64 = 1e7;
/// Numbers of elements: two meshes for the order of convergence, and the mesh that is compared.
const MESHES: [usize; 3] = [8, 16, 64];

/// Returns the displacement of the tip under a load; `None` if the path stops before.
fn tip(elements: usize, load: f64) -> Option<Tip> {
    let mut nodes: Vec<_> =
        (0..=elements).map(|i| FrameNode::free([i as f64 / elements as f64, 0.0])).collect();
    nodes[0].fixed = [true; 3];
    let end = PlaneFrame::new(nodes, AXIAL, elements, Drive::Load(load))?.path(0.02)?.pop()?;
    let [x, y, turn] = [0, 1, 2].map(|k| end.state.z[3 * elements + k]);
    Some(Tip { deflection: -y, shortening: -x, rotation: -turn })
}

pub(super) fn benchmarks() -> anyhow::Result<Vec<Benchmark>> {
    let rows = MATTIASSON.iter().filter(|(load, _)| LOADS.contains(load));
    let rows = rows.map(|(load, reference)| cantilever(*load, reference));
    Ok(rows.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// Compares the displacements and rotation of the tip under a load.
fn cantilever(load: f64, reference: &Tip) -> anyhow::Result<[Benchmark; 3]> {
    let [coarse, medium, fine] = MESHES.map(|elements| {
        tip(elements, load).with_context(|| format!("no equilibrium of the cantilever at {load}"))
    });
    let (coarse, medium, fine) = (coarse?, medium?, fine?.values());
    let reference = reference.values();
    let [coarse, medium] = [coarse, medium].map(|tip| {
        let squares =
            tip.values().into_iter().zip(reference).map(|(ours, known)| (ours - known).powi(2));
        squares.sum::<f64>().sqrt()
    });
    let order = (coarse / medium).log2();
    // The error is quadratic in the element length, and the finest mesh has 8 times the elements of
    // the coarsest.
    let remaining = coarse / 64.0;
    let names = ["deflection", "shortening", "rotation"];
    Ok(std::array::from_fn(|k| {
        let name = format!("cantilever, P L²/EI = {load}: {} of the tip", names[k]);
        let (values, band) = ([reference[k], fine[k]], (remaining + DIGITS) / reference[k]);
        Benchmark { order: Some(order), ..Benchmark::new(name, "Mattiasson 1981", values, band) }
    }))
}

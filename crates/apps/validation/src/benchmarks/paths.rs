//! Benchmarks of path following: limit points of a toggle frame and of Lee's frame.

use analytical::frames::{LEES_FRAME, toggle_limit_load};

use anyhow::{Context as _, bail};

use super::Benchmark;
use super::frame::{Drive, FrameNode, PlaneFrame};

pub(super) fn benchmarks() -> anyhow::Result<Vec<Benchmark>> {
    Ok(vec![toggle()?, lees_frame()?])
}

/// Compares the limit load of half a toggle frame with its closed form.
fn toggle() -> anyhow::Result<Benchmark> {
    let (base, height, axial) = (1.0, 0.2, 1e3);
    let hinge = FrameNode { position: [0.0, 0.0], fixed: [true, true, false] };
    let slide = FrameNode { position: [base, height], fixed: [true, false, false] };
    let frame = PlaneFrame::new(vec![hinge, slide], axial, 1, Drive::Depth(2.5 * height));
    let load = frame.and_then(|frame| frame.limit_load(0.05));
    let ours = load.context("the toggle has no limit load")?;
    let values = [toggle_limit_load(base, height, axial), ours];
    Ok(Benchmark::new("toggle that snaps through: limit load", "closed form", values, 1e-9))
}

/// Returns the limit load of Lee's frame.
///
/// A hinged column carries a hinged beam, which is loaded at a fifth of its length.
fn lee(elements: usize, axial: f64) -> Option<f64> {
    let column = (0..elements).map(|i| [0.0, i as f64 / elements as f64]);
    let beam = (0..=elements).map(|i| [i as f64 / elements as f64, 1.0]);
    let mut nodes: Vec<_> = column.chain(beam).map(FrameNode::free).collect();
    for end in [0, 2 * elements] {
        nodes[end].fixed = [true, true, false];
    }
    let loaded = elements + elements / 5;
    PlaneFrame::new(nodes, axial, loaded, Drive::Depth(0.6))?.limit_load(0.01)
}

/// Compares the limit load of Lee's frame with the literature, and returns the convergence order.
fn lees_frame() -> anyhow::Result<Benchmark> {
    // EA L²/EI = 12 (L/h)² for a thickness h of L/60.
    let axial = 43_200.0;
    // Multiples of five place a node under the load, at a fifth of the beam.
    let loads = [10, 20, 40].map(|elements| lee(elements, axial));
    let [Some(coarse), Some(medium), Some(fine)] = loads else {
        bail!("Lee's frame has no limit load")
    };
    let order = ((coarse - medium) / (medium - fine)).abs().log2();
    let name = "Lee's frame: first limit load P L²/EI";
    // The reference is inextensible. The frame of squama is not, so a difference remains on all
    // meshes.
    let source = "Lee, Manuel & Rossow 1968, inextensible";
    Ok(Benchmark { order: Some(order), ..Benchmark::new(name, source, [LEES_FRAME, fine], 5e-3) })
}

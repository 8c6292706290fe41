//! Drawings say what the numbers say, and say it the same every time.

mod overlap;
mod page;

use report::drawings;
use skin::puncture::{At, PunctureParameters, RowSnapshot, snapshots};
use skin::{Base, Common, Design};
use substrate::Springs;

/// A design whose scales touch before the critical tilt.
fn design(slant_deg: f64) -> Design {
    Design { gap: 0.1, length: 1.0, slant_deg, base: Base::L, width: 1.0 }
}

/// A design punctured with contacts so soft that overlaps are seen, at a displacement and at the
/// critical tilt.
fn punctured(design: &Design, modulus: f64) -> Vec<RowSnapshot> {
    let springs: Springs =
        substrate::calibrate(&design.footprint(0.5).expect("a footprint")).expect("springs");
    let parameters = PunctureParameters {
        contact_modulus_over_substrate: modulus,
        scales: skin::puncture::RowLength::Scales(9),
        ..PunctureParameters::default()
    };
    let at = [At::Displacement(0.15), At::Tilt(10.0), At::Force(0.05)];
    let solved =
        snapshots(design, &springs, &Common::default(), &parameters, &at).expect("a design");
    solved.at.into_iter().map(|state| state.expect("reached")).collect()
}

fn svg(design: &Design, states: &[RowSnapshot]) -> String {
    let drawing = drawings::PunctureDrawing {
        name: "test",
        design,
        load_position: 1.0,
        thickness_mm: None,
        states,
    };
    drawing.svg().expect("a drawing")
}

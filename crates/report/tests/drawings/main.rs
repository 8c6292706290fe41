//! Drawings say what the numbers say, and say it the same every time.

mod overlap;
mod page;

use report::drawings;
use skin::puncture::{At, Needle, PunctureParameters, RowSnapshot, snapshots};
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
    drawn(design, states, None)
}

fn drawn(design: &Design, states: &[RowSnapshot], needle_radius: Option<f64>) -> String {
    let drawing = drawings::PunctureDrawing {
        name: "test",
        design,
        load_position: 1.0,
        needle_radius,
        thickness_mm: None,
        states,
    };
    drawing.svg().expect("a drawing")
}

/// Where scales rub, contacts that slip have rings, and the others discs; the caption counts them.
#[test]
fn contacts_that_slip_have_rings() {
    let design = design(60.0);
    let springs: Springs =
        substrate::calibrate(&design.footprint(0.5).expect("a footprint")).expect("springs");
    let common = Common { friction: 0.2, ..Common::default() };
    let parameters = PunctureParameters::default();
    let solved = snapshots(&design, &springs, &common, &parameters, &[At::Tilt(10.0)]);
    let state = solved.expect("a design").at.remove(0).expect("reached");
    let slip = state.contacts.iter().filter(|contact| contact.slips == Some(true)).count();
    let stick = state.contacts.iter().filter(|contact| contact.slips == Some(false)).count();
    assert!(slip > 0 && stick > 0 && slip + stick == state.contacts.len());
    let drawn = svg(&design, std::slice::from_ref(&state));
    assert_eq!(drawn.matches("fill-opacity=\"0.22\"").count(), stick);
    assert!(drawn.contains(&format!("{} contacts, {slip} slip (rings)", slip + stick)));
}

/// A needle that is guided stands at one place in all panels, whatever the scale below it does, and a ring goes with the scale.
#[test]
fn a_guided_needle_stays_where_it_was_set_down() {
    let design = design(45.0);
    let springs: Springs =
        substrate::calibrate(&design.footprint(0.5).expect("a footprint")).expect("springs");
    let needle = Needle::Guided { friction: 0.3 };
    let parameters = PunctureParameters { needle, ..PunctureParameters::default() };
    let at = [At::Displacement(0.05), At::Displacement(0.1)];
    let solved =
        snapshots(&design, &springs, &Common::default(), &parameters, &at).expect("a design");
    let states: Vec<_> = solved.at.into_iter().map(|state| state.expect("reached")).collect();
    let text = svg(&design, &states);
    // The first number of that name behind the beginning of each group of a load.
    let places = |name: &str| -> Vec<f64> {
        let loads = text.split("class=\"load\"").skip(1);
        let after = |load: &str| load.split(&format!(" {name}=\"")).nth(1).map(str::to_owned);
        let numbers = loads.filter_map(after);
        numbers.map(|rest| rest.split('"').next().expect("an end").parse().expect("px")).collect()
    };
    let [needles, rings] = ["x1", "cx"].map(places);
    assert_eq!((needles.len(), rings.len()), (2, 2), "{text}");
    assert_eq!(needles[0], needles[1]);
    assert!(rings[0] > needles[0] + 1.0 && rings[1] > rings[0], "{rings:?} {needles:?}");
    assert!(!svg(&design, &punctured(&design, 9677.0)).contains("set-down"));
}

/// A round tip between two scales hangs between their corners: drawn at rest it is lower than their tops, and touches both.
#[test]
fn a_round_tip_stands_where_it_touches() {
    let design = Design { gap: 0.6, ..design(0.0) };
    let springs: Springs =
        substrate::calibrate(&design.footprint(0.5).expect("a footprint")).expect("springs");
    let parameters = PunctureParameters {
        needle: Needle::Guided { friction: 0.0 },
        needle_radius: Some(0.5),
        // In the middle of the gap.
        load_position: 1.3 / design.length,
        ..PunctureParameters::default()
    };
    let at = [At::Displacement(0.05)];
    let solved = snapshots(&design, &springs, &Common::default(), &parameters, &at);
    let state = solved.expect("a design").at.remove(0).expect("reached");
    // At rest its centre is 0.4 above the corners, 0.3 beside them.
    let lowest = 1.0 + 0.4 - 0.5 - 0.05;
    let [x, y] = state.tip.expect("a tip");
    assert!((x - (0.5 * design.length + 0.3)).abs() < 1e-12 && (y - lowest).abs() < 1e-12);
    let text = drawn(&design, &[state], Some(0.5));
    assert!(text.contains("class=\"tip\""), "{text}");
}

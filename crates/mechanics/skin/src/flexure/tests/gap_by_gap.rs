//! Tests of strips with prescribed unequal gaps and slants.

use approx::assert_relative_eq;
use geometry::{Parallelogram, UnevenRow};

use super::super::problem::FlexureProblem;
use super::super::{BentSample, Flexure, FlexureParameters, MembraneMesh, Method, gap_by_gap};
use crate::arrangement::Arrangement;
use crate::{Base, Common, ContactChange, Design, Status};

const GAPS: [f64; 6] = [0.05, 0.07, 0.04, 0.06, 0.055, 0.045];

fn parameters() -> FlexureParameters {
    FlexureParameters {
        contact_modulus_over_membrane: 667.0,
        method: Method::Chain,
        membrane_length: 6.0,
        membrane_thickness: 0.125,
        membrane_axis_offset: 0.0,
        gaps: None,
        elements_per_gap: MembraneMesh::Elements(2),
        max_end_rotation_deg: 60.0,
        unload: false,
    }
}

fn design(slant_deg: f64) -> Design {
    Design { gap: 0.05, length: 1.0, slant_deg, base: Base::L, width: 1.0 }
}

fn bent(gaps: &[f64], slants_deg: &[f64]) -> Flexure {
    both(gaps, slants_deg).0
}

/// Bends the strip as a chain, and with separately solved gaps.
fn both(gaps: &[f64], slants_deg: &[f64]) -> (Flexure, BentSample) {
    let scales = slants_deg.iter().map(|&slant| Parallelogram::leaning(0.5, slant).unwrap());
    let row = UnevenRow::new(scales.collect(), gaps.to_vec()).unwrap();
    let row = Arrangement::Uneven(row);
    let (design, parameters, common) = (design(0.0), parameters(), Common::default());
    let gaps = gaps.len();
    let problem =
        FlexureProblem::new(&design, &common, &parameters, row, gaps as f64, gaps).unwrap();
    let flexure = problem.solve().unwrap();
    assert_eq!(flexure.status, Status::Complete);
    (flexure, gap_by_gap::solve(&problem).unwrap().expect("gaps solved separately"))
}

fn close(a: Option<f64>, b: Option<f64>, max_relative: f64) {
    assert_relative_eq!(a.unwrap(), b.unwrap(), max_relative = max_relative);
}

/// Checks that upright scales touch at `M* = 1` in all gaps at once.
///
/// The membrane of each gap is an arc of radius `1/M*` for any length, and the tops meet where the
/// radius equals their height. Discretised with `m` elements the arc is a polygon with sides
/// `d/m = 2 sin(θ/2m)` at first contact, and the moment is `M* = θ/d`.
#[test]
fn upright_scales_touch_in_all_gaps_at_the_same_moment() {
    let flexure = bent(&GAPS, &[0.0; 7]);
    let closed: Vec<_> =
        flexure.events.iter().filter(|event| event.change == ContactChange::Closed).collect();
    assert_eq!(closed.len(), GAPS.len());
    for event in closed {
        let (gap, elements) = (GAPS[event.left_scale.unwrap() as usize], 2.0);
        let moment = 2.0 * elements / gap * (gap / (2.0 * elements)).asin();
        assert_relative_eq!(event.point.moment, moment, max_relative = 1e-9);
        let (free, whole) = (GAPS.iter().sum::<f64>(), GAPS.iter().sum::<f64>() + 6.0);
        assert_relative_eq!(event.point.curvature, free / whole, max_relative = 1e-4);
    }
    assert!(flexure.closing_range().unwrap() < 1e-4 * 0.05);
}

#[test]
fn mirrored_strips_have_equal_measures() {
    let slants = [60.0, 59.8, 60.1, 59.9, 60.2, 60.05, 59.95];
    let flexure = bent(&GAPS, &slants);
    let (mut gaps, mut mirrored) = (GAPS, slants.map(|slant| -slant));
    gaps.reverse();
    mirrored.reverse();
    let mirrored = bent(&gaps, &mirrored);
    assert!(flexure.measures.contact == Some(true));
    let (ours, theirs) = (flexure.measures, mirrored.measures);
    close(ours.compliance, theirs.compliance, 1e-7);
    close(ours.first_contact_curvature, theirs.first_contact_curvature, 1e-7);
    close(ours.max_moment, theirs.max_moment, 1e-7);
    close(flexure.closing_range(), mirrored.closing_range(), 1e-7);
    assert!(flexure.closing_range() > Some(1e-3));
}

#[test]
fn separately_solved_gaps_and_their_mirror_image_match_the_chain() {
    let slants = [60.0, 59.8, 60.1, 59.9, 60.2, 60.05, 59.95];
    let (mut gaps, mut mirrored) = (GAPS, slants.map(|slant| -slant));
    gaps.reverse();
    mirrored.reverse();
    let (chain, ours) = both(&GAPS, &slants);
    let (_, image) = both(&gaps, &mirrored);
    for bent in [&ours, &image] {
        let (bent, of_chain) = (bent.measures, chain.measures);
        close(bent.compliance, of_chain.compliance, 1e-9);
        close(bent.first_contact_curvature, of_chain.first_contact_curvature, 1e-9);
        close(bent.max_moment, of_chain.max_moment, 1e-9);
        close(bent.axial_energy_share, of_chain.axial_energy_share, 1e-9);
        close(bent.membrane_strain_max, of_chain.membrane_strain_max, 1e-9);
    }
    close(ours.closing_range, chain.closing_range(), 1e-7);
    close(image.closing_range, ours.closing_range, 1e-7);
}

#[test]
fn equal_gaps_match_the_even_strip() {
    let uneven = bent(&[0.05; 6], &[60.0; 7]);
    let (common, parameters) = (Common::default(), parameters());
    let even = FlexureProblem::even(&design(60.0), &common, &parameters).unwrap().solve().unwrap();
    assert_eq!(even.gaps, 6);
    let [(ours, our_shape), (theirs, their_shape)] = [uneven, even].map(|flexure| {
        let m = flexure.measures;
        let measures =
            [m.compliance, m.first_contact_curvature, m.max_moment, m.axial_energy_share];
        (measures, flexure.shape(flexure.path.len() - 1).unwrap())
    });
    for (ours, theirs) in ours.into_iter().zip(theirs) {
        assert_relative_eq!(ours.unwrap(), theirs.unwrap(), max_relative = 1e-7);
    }
    for (ours, theirs) in our_shape.into_iter().flatten().zip(their_shape.into_iter().flatten()) {
        assert_relative_eq!(ours, theirs, epsilon = 1e-7);
    }
}

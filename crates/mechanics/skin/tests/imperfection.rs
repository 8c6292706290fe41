//! Tests of rows and strips with random gaps and slants.

use approx::assert_relative_eq;
use skin::flexure::{self, Flexure, MembraneMesh, Method};
use skin::puncture::{self, RowLength};
use skin::{Base, Common, ContactChange, Design, Imperfection, Sample, Status};
use substrate::calibrate;

const STEEP: Design = Design { gap: 0.1, length: 1.0, slant_deg: 60.0, base: Base::L, width: 1.0 };

fn strip() -> flexure::FlexureParameters {
    flexure::FlexureParameters {
        contact_modulus_over_membrane: 667.0,
        method: Method::Chain,
        membrane_length: 22.0,
        membrane_thickness: 0.125,
        membrane_axis_offset: 0.0,
        gaps: None,
        elements_per_gap: MembraneMesh::Auto,
        max_end_rotation_deg: 40.0,
        unload: false,
    }
}

fn sample(gap_cv: f64, slant_sd_deg: f64, seed: u64, number: u64) -> Sample {
    Imperfection { gap_cv, slant_sd_deg }.sample(&STEEP, seed, number).unwrap()
}

fn bent(sample: &Sample) -> Flexure {
    let flexure = flexure::solve_sample(&STEEP, &Common::default(), &strip(), sample).unwrap();
    assert_eq!(flexure.status, Status::Complete);
    flexure
}

/// Returns the gaps of an imperfect row of 20,001 scales.
fn gaps(gap_cv: f64, slant_sd_deg: f64) -> Vec<f64> {
    sample(gap_cv, slant_sd_deg, 1, 1).row(10_000, 10_000).unwrap().gaps().to_vec()
}

#[test]
fn gaps_and_slants_have_the_requested_scatter() {
    // The gaps are so wide that no draw is rejected.
    let wide = Design { gap: 3.0, slant_deg: 30.0, ..STEEP };
    let imperfection = Imperfection { gap_cv: 0.1, slant_sd_deg: 2.0 };
    let row = imperfection.sample(&wide, 3, 5).unwrap().row(10_000, 10_000).unwrap();
    let slants: Vec<_> = row.scales().iter().map(|scale| scale.slant().to_degrees()).collect();
    let [gaps, (mean, deviation)] = [row.gaps(), &slants].map(|values| {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
        (mean, variance.sqrt())
    });
    // Tolerances are four standard errors: for 20,000 gaps the relative standard error is
    // 0.1/√20000 for the mean and 1/√40000 for the deviation.
    assert_relative_eq!(gaps.0, 3.0, max_relative = 0.003);
    assert_relative_eq!(gaps.1 / gaps.0, 0.1, max_relative = 0.025);
    assert_relative_eq!(mean, 30.0, epsilon = 0.057);
    assert_relative_eq!(deviation, 2.0, max_relative = 0.02);
}

#[test]
fn a_longer_row_contains_the_scales_of_a_shorter_row_in_its_middle() {
    let sample = sample(0.2, 2.0, 7, 3);
    let (short, long) = (sample.row(3, 4).unwrap(), sample.row(9, 20).unwrap());
    assert_eq!(short.scales(), &long.scales()[6..14]);
    assert_eq!(short.gaps(), &long.gaps()[6..13]);
}

#[test]
fn scales_never_overlap_at_rest() {
    // At a slant of 60° one degree moves the top by 0.07, so many draws overlap at a gap of 0.1.
    let sample = sample(0.3, 1.5, 1, 1);
    // `row` fails if scales overlap, because `UnevenRow` rejects them.
    let row = sample.row(500, 500).unwrap();
    assert_eq!(row.scales().len(), 1001);
    let crowd = Imperfection { gap_cv: 0.0, slant_sd_deg: 30.0 };
    let tight = Design { gap: 1e-9, slant_deg: 80.0, ..STEEP };
    let error = crowd.sample(&tight, 1, 1).unwrap().row(0, 1000).unwrap_err();
    assert_eq!(
        error.to_string(),
        "standard deviation of the slants is 30, expected a smaller value, so that scales do not overlap"
    );
}

#[test]
fn samples_are_reproducible_and_depend_on_number_seed_and_design() {
    let [first, repeated, other_number, other_seed] = [(1, 1), (1, 1), (1, 2), (2, 1)]
        .map(|(seed, number)| bent(&sample(0.1, 0.5, seed, number)).measures.compliance);
    assert!(first == repeated && first != other_number && first != other_seed);
    let [wide, narrow] = [STEEP, Design { gap: 0.05, ..STEEP }].map(|design| {
        let sample = Imperfection { gap_cv: 0.1, slant_sd_deg: 0.0 }.sample(&design, 1, 1).unwrap();
        sample.row(0, 1).unwrap().gaps()[0] / design.gap
    });
    assert_ne!(wide, narrow);
}

/// Recovers the normal deviates of a sample by inverting (I1).
#[test]
fn normal_deviates_do_not_depend_on_the_amount_of_scatter() {
    let [some, more] = [0.05_f64, 0.1].map(|cv| {
        let s = (cv * cv).ln_1p().sqrt();
        let z = gaps(cv, 0.0).into_iter().map(move |gap| ((gap / 0.1).ln() + 0.5 * s * s) / s);
        z.collect::<Vec<_>>()
    });
    for (a, b) in some.iter().zip(&more).take(100) {
        assert_relative_eq!(*a, *b, epsilon = 1e-9);
    }
}

#[test]
fn a_sample_without_scatter_has_the_measures_of_the_perfect_row() {
    let sample = sample(0.0, 0.0, 1, 1);
    let common = Common::default();
    let springs = calibrate(&STEEP.footprint(0.5).unwrap()).unwrap();
    for scales in [RowLength::Auto, RowLength::Scales(8)] {
        let parameters =
            puncture::PunctureParameters { scales, ..puncture::PunctureParameters::default() };
        let perfect = puncture::solve(&STEEP, &springs, &common, &parameters).unwrap();
        let ours = puncture::solve_sample(&STEEP, &springs, &common, &parameters, &sample).unwrap();
        assert_eq!(ours.status, perfect.status);
        assert_eq!(ours.measures.scales, perfect.measures.scales);
        let pairs = [
            (ours.measures.critical_force, perfect.measures.critical_force),
            (ours.measures.penetration, perfect.measures.penetration),
            (ours.measures.max_stiffness, perfect.measures.max_stiffness),
        ];
        for (ours, perfect) in pairs {
            assert_relative_eq!(ours.unwrap(), perfect.unwrap(), max_relative = 1e-8);
        }
    }
}

/// Computes the width of the range of curvatures in which gaps close, averaged over five strips.
fn closing_range(gap_cv: f64, slant_sd_deg: f64) -> f64 {
    let strips = (1..=5).map(|number| bent(&sample(gap_cv, slant_sd_deg, 1, number)));
    strips.map(|strip| strip.closing_range().unwrap()).sum::<f64>() / 5.0
}

/// All gaps of a perfect strip close at the same curvature. The gaps of an imperfect strip close in
/// a range of curvatures, and the range grows with the scatter (Fig. 10b).
#[test]
fn the_gaps_of_an_imperfect_strip_close_one_by_one() {
    let perfect = flexure::solve(&STEEP, &Common::default(), &strip()).unwrap();
    assert!(perfect.closing_range().unwrap() < 1e-12);
    let first = perfect.measures.first_contact_curvature.unwrap();
    let (mut last, mut by_slants) = (0.0, 0.0);
    for gap_cv in [0.02, 0.05, 0.1, 0.2] {
        let range = closing_range(gap_cv, 0.0);
        assert!(range > 1.5 * last, "{range} {last}");
        last = range;
    }
    // Unequal gaps have little effect: neighbours touch at a moment that hardly depends on the gap.
    assert!(last < 0.02 * first, "{last} {first}");
    for slant_sd_deg in [0.05, 0.1, 0.2, 0.4] {
        let range = closing_range(0.0, slant_sd_deg);
        assert!(range > 1.5 * by_slants, "{range} {by_slants}");
        by_slants = range;
    }
    assert!(by_slants > 0.2 * first, "{by_slants} {first}");
    let strip = bent(&sample(0.05, 0.4, 1, 1));
    let closed = strip.events.iter().filter(|event| event.change == ContactChange::Closed);
    let mut closed: Vec<_> = closed.map(|event| event.point.curvature).collect();
    closed.dedup();
    assert!(closed.len() >= strip.gaps, "{} of {}", closed.len(), strip.gaps);
}

/// The stiffness of a perfect strip jumps at first contact; the stiffness of an imperfect strip
/// grows with every gap that closes.
#[test]
fn a_perfect_strip_stiffens_abruptly_and_an_imperfect_strip_gradually() {
    let perfect = flexure::solve(&STEEP, &Common::default(), &strip()).unwrap();
    let imperfect = bent(&sample(0.05, 0.4, 1, 1));
    // Width of the range of curvatures with two to ten times the initial stiffness.
    let [of_perfect, of_imperfect] = [&perfect, &imperfect].map(|strip| {
        let [low, high] = [2.0, 10.0].map(|factor| {
            let limit = factor * strip.path[0].stiffness;
            strip.path.iter().find(|point| point.stiffness > limit).unwrap().curvature
        });
        high - low
    });
    assert!(of_perfect == 0.0);
    assert!(of_imperfect > 0.05 * perfect.measures.first_contact_curvature.unwrap());
}

#[test]
fn common_samples_have_the_same_random_numbers_for_all_designs() {
    let imperfection = Imperfection { gap_cv: 0.1, slant_sd_deg: 0.0 };
    let wide = Design { gap: 2.0 * STEEP.gap, ..STEEP };
    let [narrow, wide, next] = [(STEEP, 5), (wide, 5), (STEEP, 6)].map(|(design, number)| {
        let sample = imperfection.common_sample(&design, 1, number).unwrap();
        sample.row(3, 3).unwrap().gaps().to_vec()
    });
    for (one, other) in narrow.iter().zip(wide) {
        assert!((other / one - 2.0).abs() < 1e-12, "{one} {other}");
    }
    assert_ne!(narrow, next);
}

/// Compares the closed form (F9) of first contact with solved imperfect strips.
#[test]
fn an_imperfect_strip_first_touches_at_the_closed_form_curvature() {
    for (gap_cv, slant_sd_deg) in [(0.2, 0.0), (0.2, 0.5)] {
        for number in 1..=2 {
            let measures = bent(&sample(gap_cv, slant_sd_deg, 3, number)).measures;
            let [exact, solved] = [measures.contact_curvature, measures.first_contact_curvature];
            assert_relative_eq!(exact.unwrap(), solved.unwrap(), max_relative = 1e-9);
        }
    }
}

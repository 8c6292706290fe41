//! Compares separately solved gaps of imperfect strips with the assembled chain.

use contact::Law;
use skin::flexure::{self, BentSample, FlexureParameters, MembraneMesh};
use skin::{Base, Common, Design, Imperfection, PathDetail, Sample, Status};

use crate::samples::{SplitMix64, long_campaigns, random as random_designs};

/// A design, its parameters, and the scatter of its gaps and slants.
#[derive(Clone, Copy, Debug)]
struct Uneven {
    design: Design,
    common: Common,
    parameters: FlexureParameters,
    imperfection: Imperfection,
}

/// Returns a strip of nine gaps that is bent until all gaps are closed.
///
/// Its scales are as long as thick, and its gaps a tenth of the thickness.
fn slanted() -> Uneven {
    let design = Design { gap: 0.1, length: 1.0, slant_deg: 60.0, base: Base::L, width: 1.0 };
    let parameters = FlexureParameters {
        gaps: Some(9),
        max_end_rotation_deg: 18.0,
        ..FlexureParameters::default()
    };
    let imperfection = Imperfection { gap_cv: 0.05, slant_sd_deg: 0.3 };
    Uneven { design, common: Common::default(), parameters, imperfection }
}

impl Uneven {
    fn sample(&self, seed: u64) -> Sample {
        self.imperfection.sample(&self.design, seed, 1).unwrap()
    }

    /// Bends a sample with separately solved gaps, and as a chain.
    fn bent(&self, seed: u64) -> [BentSample; 2] {
        let Self { design, common, parameters, .. } = self;
        let sample = self.sample(seed);
        let gaps = flexure::bend_sample(design, common, parameters, &sample).unwrap();
        let chain = flexure::solve_sample(design, common, parameters, &sample).unwrap();
        [gaps, BentSample::from(&chain)]
    }
}

/// Computes the largest relative difference of all measures except the dissipation.
fn difference([gaps, chain]: [&BentSample; 2]) -> f64 {
    let [ours, theirs] = [gaps, chain].map(|bent| {
        let m = bent.measures;
        let last_closing = m.first_contact_curvature.zip(bent.closing_range);
        [
            m.compliance,
            m.initial_compliance,
            m.first_contact_curvature,
            last_closing.map(|(first, range)| first.abs() + range),
            m.max_moment,
            m.axial_energy_share,
            m.membrane_strain_max,
            m.locking_curvature,
        ]
    });
    let differences = ours.into_iter().zip(theirs).map(|(ours, theirs)| {
        assert_eq!(ours.is_some(), theirs.is_some(), "{gaps:?} {chain:?}");
        ours.zip(theirs)
            .map_or(0.0, |(ours, theirs)| (ours - theirs).abs() / theirs.abs().max(1e-9))
    });
    differences.fold(0.0, f64::max)
}

/// Solver parameters were not tuned with the seeds of this test.
#[test]
fn separately_solved_gaps_match_the_chain() {
    let slanted = slanted();
    let Uneven { design, parameters, .. } = slanted;
    let steep = Design { gap: 0.1, length: 0.1, slant_deg: 75.0, ..design };
    let cases = [
        Uneven { imperfection: Imperfection { gap_cv: 0.2, slant_sd_deg: 0.0 }, ..slanted },
        Uneven { imperfection: Imperfection { gap_cv: 0.0, slant_sd_deg: 0.5 }, ..slanted },
        // Upright scales: all gaps close at the same moment.
        Uneven { design: Design { slant_deg: 0.0, ..design }, ..slanted },
        // Steep scales: corners pass each other.
        Uneven {
            design: steep,
            parameters: FlexureParameters { max_end_rotation_deg: 30.0, ..parameters },
            ..slanted
        },
        Uneven {
            parameters: FlexureParameters { membrane_axis_offset: 0.06, ..parameters },
            ..slanted
        },
        Uneven {
            parameters: FlexureParameters {
                elements_per_gap: MembraneMesh::Elements(2),
                ..parameters
            },
            ..slanted
        },
        // Bending with scales on the outside: no contact.
        Uneven {
            parameters: FlexureParameters { max_end_rotation_deg: -18.0, ..parameters },
            ..slanted
        },
    ];
    for (number, case) in cases.iter().enumerate() {
        for seed in [3, 71] {
            let [gaps, chain] = case.bent(seed);
            assert_eq!([gaps.status, chain.status], [Status::Complete; 2], "{number} {seed}");
            // Equal numbers of points would mean that `bend_sample` fell back to the chain.
            assert_ne!(gaps.points, chain.points, "{number} {seed}");
            let difference = difference([&gaps, &chain]);
            assert!(difference < 1e-8, "{number} {seed}: {difference:e}");
        }
    }
}

/// Returns imperfect strips of random designs. Some of the strips lock.
fn random_strips(count: usize, seed: u64) -> Vec<Uneven> {
    let mut random = SplitMix64(seed);
    let strips = random_designs(count, seed).into_iter().map(|design| Uneven {
        design,
        common: Common::default(),
        parameters: FlexureParameters {
            gaps: Some(random.between(10.0, 40.0) as usize),
            max_end_rotation_deg: random.between(10.0, 170.0),
            membrane_thickness: random.between(0.05, 0.3),
            ..FlexureParameters::default()
        },
        imperfection: Imperfection {
            gap_cv: random.between(0.0, 0.25),
            slant_sd_deg: random.between(0.0, 0.6),
        },
    });
    strips.collect()
}

/// Most gaps are solved only at first contact, in the stiffest state and at the end, starting from
/// similar gaps. Measures of the stiffest state start with a coarser membrane.
#[test]
fn measures_of_the_stiffest_state_equal_measures_of_complete_bending() {
    let mut few = 0;
    let cases = random_strips(if long_campaigns() { 2_000 } else { 40 }, 49);
    for case in &cases {
        let common = Common { detail: PathDetail::Critical, ..case.common };
        let sample = case.sample(1);
        let [whole, early] = [&case.common, &common].map(|common| {
            flexure::bend_sample(&case.design, common, &case.parameters, &sample).unwrap()
        });
        assert_eq!(whole.status, early.status, "{case:?}");
        let compliances = [whole, early].map(|bent| bent.measures.compliance);
        assert_eq!(compliances[0].is_some(), compliances[1].is_some(), "{case:?}");
        if let [Some(whole), Some(early)] = compliances {
            // The finer membrane changes a measure by at most 1e-4.
            assert!((whole - early).abs() <= 1e-4 * whole, "{case:?}: {whole} {early}");
        }
        let first = whole.measures.first_contact_curvature;
        if let (Some(first), [Some(whole), Some(early)]) =
            (first, [whole, early].map(|bent| bent.closing_range))
        {
            assert!((whole - early).abs() <= 1e-7 * (whole + first.abs()), "{case:?}");
        }
        few += usize::from(early.points < 8 * case.parameters.gaps.unwrap());
    }
    println!("{few} of {} strips have few equilibria", cases.len());
    assert!(4 * few > cases.len(), "{few}");
}

/// Dissipation and stick–slip transitions agree up to the error of the step size.
#[test]
fn separately_solved_gaps_with_friction_match_the_chain() {
    let slanted = slanted();
    let solver = solver::Settings { first_step: 0.02, max_step: 0.02, ..slanted.common.solver };
    for friction in [0.1, 0.25] {
        let case = Uneven { common: Common { friction, solver, ..slanted.common }, ..slanted };
        let [gaps, chain] = case.bent(5);
        assert_eq!([gaps.status, chain.status], [Status::Complete; 2], "{friction}");
        assert_ne!(gaps.points, chain.points, "{friction}");
        let off = difference([&gaps, &chain]);
        assert!(off < 1e-7, "{friction}: {off:e}");
        let works = [&gaps, &chain].map(|bent| bent.measures.friction_work.unwrap());
        // With the larger friction nothing slips, so the dissipation is zero.
        assert!((works[0] - works[1]).abs() <= 1e-5 * works[1], "{friction}: {works:?}");
        assert!(gaps.measures.locking_curvature.is_some());
    }
}

/// If gaps cannot be solved separately, the result is the result of the chain, complete or not.
#[test]
fn strips_that_cannot_be_solved_separately_fall_back_to_the_chain() {
    let slanted = slanted();
    let unloading = FlexureParameters { unload: true, ..slanted.parameters };
    let [gaps, chain] = Uneven { parameters: unloading, ..slanted }.bent(3);
    assert_eq!(gaps.measures, chain.measures);
    assert!(gaps.measures.remains.loop_work.is_some());
    // Soft contacts that stiffen under load: the strip is stiffest between two events. In the
    // second case steep scales slide off each other, so the moment decreases.
    let steep = Design { gap: 0.2, length: 0.5, slant_deg: 80.0, ..slanted.design };
    let far = FlexureParameters { max_end_rotation_deg: 80.0, ..slanted.parameters };
    let soft = Common { law: Law::EXCHANGED, ..slanted.common };
    let cases = [
        Uneven { common: soft, ..slanted },
        Uneven { design: steep, common: soft, parameters: far, ..slanted },
    ];
    for case in cases {
        let [gaps, chain] = case.bent(2);
        assert_eq!((gaps.status, gaps.measures), (chain.status, chain.measures));
    }
}

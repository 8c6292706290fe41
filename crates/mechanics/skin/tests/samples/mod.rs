//! Designs with known traits, for the tests and benches of this crate.

// Each target uses only a part of this module.
#![allow(dead_code)]

use contact::Law;
use skin::puncture::{self, Puncture, PunctureParameters, RowLength};
use skin::{Base, Common, Design};
use solver::Settings;
use substrate::{Calibrations, Springs};

/// Both meanings of the length of a scale.
pub const BASES: [Base; 2] = [Base::L, Base::TwoL];

/// Both variants of the contact law.
pub const LAWS: [Law; 2] = [Law::PRINTED, Law::EXCHANGED];

/// Aspect ratios of the reference study.
const LENGTHS: [f64; 12] = [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// A design of unit width.
pub fn design(gap: f64, length: f64, slant_deg: f64, base: Base) -> Design {
    Design { gap, length, slant_deg, base, width: 1.0 }
}

/// Blocks as long as thick and close together: one contact, which slides.
pub fn blocks() -> Design {
    design(0.1, 1.0, 0.0, Base::L)
}

/// Longest domino chain of the reference study.
///
/// Dozens of slender, steep scales touch.
pub fn domino() -> Design {
    design(0.1, 0.1, 75.0, Base::L)
}

/// Design with contacts up to a dozen scales from the load.
///
/// Longer rows do not change its path.
pub fn settled() -> Design {
    design(0.2, 0.5, 60.0, Base::L)
}

/// A variety of designs.
///
/// From no contact to many contacts; open, at edges, corners and tips; loads that rise, fall and
/// turn back.
pub fn spread() -> Vec<Design> {
    vec![
        blocks(),
        settled(),
        design(0.1, 1.0, 75.0, Base::L),
        design(0.1, 1.0, 45.0, Base::TwoL),
        design(0.3, 0.1, 75.0, Base::L),
        design(0.05, 0.3, 30.0, Base::TwoL),
        design(0.4, 0.05, 60.0, Base::TwoL),
        design(1.0, 0.025, 75.0, Base::L),
        design(1.0, 0.5, 45.0, Base::L),
        folding(),
        design(0.05, 0.15, 80.0, Base::TwoL),
        design(0.6, 2.0, 80.0, Base::TwoL),
        design(0.1, 0.15, 80.0, Base::TwoL),
    ]
}

/// Scales so steep and long that a side becomes flush with a base, and passes it.
///
/// The left side rotates to the base of the left neighbour, and then the tip carries the contact.
pub fn folding() -> Design {
    design(0.2, 2.8, 79.5, Base::TwoL)
}

/// The 720 designs of the reference study.
pub fn reference_study(base: Base) -> Vec<Design> {
    let mut designs = Vec::with_capacity(720);
    for gap in 1..=10 {
        for length in LENGTHS {
            for slant in 0..6 {
                let gap = f64::from(gap) / 10.0;
                designs.push(design(gap, length, 15.0 * f64::from(slant), base));
            }
        }
    }
    designs
}

/// Forty designs of the reference study, evenly spread over both bases.
///
/// They include the steepest one with the smallest gap.
pub fn forty() -> Vec<Design> {
    let all = BASES.into_iter().flat_map(reference_study);
    // 37 is coprime to the numbers of slants, lengths and gaps.
    all.skip(5).step_by(37).take(39).chain([design(0.1, 1.0, 75.0, Base::TwoL)]).collect()
}

/// Draws designs uniformly, with both bases.
///
/// `d/t` from 0.05 to 2, `L/t` from 0.02 to 3, slants from 0° to 80°.
pub fn random(count: usize, seed: u64) -> Vec<Design> {
    let mut random = SplitMix64(seed);
    let designs = (0..count).map(|_| {
        let [gap, length, slant] =
            [(0.05, 2.0), (0.02, 3.0), (0.0, 80.0)].map(|(low, high)| random.between(low, high));
        design(gap, length, slant, BASES[usize::from(random.next() >= 0.5)])
    });
    designs.collect()
}

/// Returns true if `SQUAMA_CAMPAIGNS=long` requests long campaigns.
pub fn long_campaigns() -> bool {
    std::env::var_os("SQUAMA_CAMPAIGNS").is_some_and(|value| value == "long")
}

/// The generator of Steele, Lea & Flood 2014 (doi 10.1145/2660193.2660195).
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// Evenly distributed in `[0, 1)`.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly distributed in `[low, high)`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Settings with small steps, for many points along a path.
pub fn in_small_steps() -> Common {
    let solver = Settings { first_step: 0.01, max_step: 0.05, ..Settings::default() };
    Common { solver, ..Common::default() }
}

/// Reference parameters on a row of this many scales.
pub fn on_row(scales: usize) -> PunctureParameters {
    PunctureParameters { scales: RowLength::Scales(scales), ..PunctureParameters::default() }
}

/// Returns these settings with ten times smaller steps.
pub fn finer(settings: Settings) -> Settings {
    Settings {
        first_step: settings.first_step / 10.0,
        max_step: settings.max_step / 10.0,
        ..settings
    }
}

/// Returns the springs under a design.
pub fn springs(design: &Design, parameters: &PunctureParameters, known: &Calibrations) -> Springs {
    known.get(&design.footprint(parameters.poisson_ratio).unwrap()).unwrap()
}

/// Solves a design with cached springs.
pub fn solve_with(
    known: &Calibrations,
    design: &Design,
    parameters: &PunctureParameters,
) -> Puncture {
    solve_as(known, design, &Common::default(), parameters)
}

/// Solves a design with cached springs and other common parameters.
pub fn solve_as(
    known: &Calibrations,
    design: &Design,
    common: &Common,
    parameters: &PunctureParameters,
) -> Puncture {
    puncture::solve(design, &springs(design, parameters, known), common, parameters).unwrap()
}

/// Common parameters with another contact law.
pub fn with_law(law: Law) -> Common {
    Common { law, ..Common::default() }
}

/// Solves a design.
pub fn solve(design: &Design, parameters: &PunctureParameters) -> Puncture {
    solve_with(&Calibrations::default(), design, parameters)
}

//! Designs with known behaviour, shared by the tests and benches of this crate.

// Each test and bench target uses only a part of this module.
#![allow(dead_code)]

use contact::Law;
use skin::puncture::{self, Puncture, PunctureParameters, RowLength};
use skin::{Base, Common, Design};
use solver::Settings;
use substrate::{Calibrations, Springs};

/// Both meanings of the length `L`: the base, or half of the base.
pub const BASES: [Base; 2] = [Base::L, Base::TwoL];

/// Both variants of the contact law: as printed in the paper, and with exchanged constants.
pub const LAWS: [Law; 2] = [Law::PRINTED, Law::EXCHANGED];

/// Aspect ratios `L/t` of the reference study.
const LENGTHS: [f64; 12] = [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// Returns a design of unit width.
pub fn design(gap: f64, length: f64, slant_deg: f64, base: Base) -> Design {
    Design { gap, length, slant_deg, base, width: 1.0 }
}

/// Returns upright blocks, as long as thick, at a small gap; one contact closes and slides.
pub fn blocks() -> Design {
    design(0.1, 1.0, 0.0, Base::L)
}

/// Returns the design of the reference study in which the largest number of scales touch.
///
/// Dozens of slender, steep scales lean on each other like dominoes.
pub fn domino() -> Design {
    design(0.1, 0.1, 75.0, Base::L)
}

/// Returns a design with contacts up to a dozen scales from the load.
///
/// Its path does not depend on the length of a longer row.
pub fn settled() -> Design {
    design(0.2, 0.5, 60.0, Base::L)
}

/// Returns designs that cover the kinds of behaviour of the puncture model.
///
/// Their numbers of contacts range from none to many. Contacts are at edges, corners and tips. Some
/// loads increase monotonically, others decrease or reverse.
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

/// Returns steep and long scales in which a left side becomes flush with the neighbour's base.
///
/// The scale rotates beyond this position, and then its tip carries the contact.
pub fn folding() -> Design {
    design(0.2, 2.8, 79.5, Base::TwoL)
}

/// Returns the 720 designs of the reference study.
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

/// Returns forty designs of the reference study, evenly spread over both bases.
///
/// They include the design of base `2L` with the smallest gap, largest length and largest slant.
pub fn forty() -> Vec<Design> {
    let all = BASES.into_iter().flat_map(reference_study);
    // The step 37 is coprime to the numbers of slants, lengths and gaps, so all values occur.
    all.skip(5).step_by(37).take(39).chain([design(0.1, 1.0, 75.0, Base::TwoL)]).collect()
}

/// Draws random designs with uniformly distributed parameters and both bases.
///
/// `d/t` ranges from 0.05 to 2, `L/t` from 0.02 to 3, slants from 0° to 80°.
pub fn random(count: usize, seed: u64) -> Vec<Design> {
    let mut random = SplitMix64(seed);
    let designs = (0..count).map(|_| {
        let [gap, length, slant] =
            [(0.05, 2.0), (0.02, 3.0), (0.0, 80.0)].map(|(low, high)| random.between(low, high));
        design(gap, length, slant, BASES[usize::from(random.next() >= 0.5)])
    });
    designs.collect()
}

/// Returns true if the environment variable `SQUAMA_CAMPAIGNS=long` requests more test cases.
pub fn long_campaigns() -> bool {
    std::env::var_os("SQUAMA_CAMPAIGNS").is_some_and(|value| value == "long")
}

/// The random number generator of Steele, Lea & Flood 2014 (doi 10.1145/2660193.2660195).
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// Returns a random number, uniformly distributed in `[0, 1)`.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a random number, uniformly distributed in `[low, high)`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Returns settings with small steps, which give many points along a path.
pub fn in_small_steps() -> Common {
    let solver = Settings { first_step: 0.01, max_step: 0.05, ..Settings::default() };
    Common { solver, ..Common::default() }
}

/// Returns the default parameters for a row with the given number of scales.
pub fn on_row(scales: usize) -> PunctureParameters {
    PunctureParameters { scales: RowLength::Scales(scales), ..PunctureParameters::default() }
}

/// Returns `settings` with steps a tenth as large.
pub fn finer(settings: Settings) -> Settings {
    Settings {
        first_step: settings.first_step / 10.0,
        max_step: settings.max_step / 10.0,
        ..settings
    }
}

/// Returns the substrate springs of a design, from the cache `known` if possible.
pub fn springs(design: &Design, parameters: &PunctureParameters, known: &Calibrations) -> Springs {
    known.get(&design.footprint(parameters.poisson_ratio).unwrap()).unwrap()
}

/// Solves the puncture of a design with cached springs.
pub fn solve_with(
    known: &Calibrations,
    design: &Design,
    parameters: &PunctureParameters,
) -> Puncture {
    solve_as(known, design, &Common::default(), parameters)
}

/// Solves the puncture of a design with cached springs and the given common parameters.
pub fn solve_as(
    known: &Calibrations,
    design: &Design,
    common: &Common,
    parameters: &PunctureParameters,
) -> Puncture {
    puncture::solve(design, &springs(design, parameters, known), common, parameters).unwrap()
}

/// Returns the default common parameters with the given contact law.
pub fn with_law(law: Law) -> Common {
    Common { law, ..Common::default() }
}

/// Solves the puncture of a design.
pub fn solve(design: &Design, parameters: &PunctureParameters) -> Puncture {
    solve_with(&Calibrations::default(), design, parameters)
}

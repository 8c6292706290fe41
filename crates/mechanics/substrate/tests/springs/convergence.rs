//! Convergence of the boundary elements: order, reciprocity and reliability of the error estimate.

use std::sync::LazyLock;

use substrate::boundary_element::{CrossTerms, RowReactions, row_reactions};
use substrate::{Footprint, RowStiffness, Springs, calibrate};

/// Largest acceptable relative error of the springs.
const REQUIRED: f64 = 3e-3;

/// Line of `reference.csv`, a file that `examples/reference.rs` generates.
struct Reference {
    footprint: Footprint,
    coefficients: [f64; 6],
}

impl Reference {
    fn parse(line: &str) -> Self {
        let numbers: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let [gap, width, poisson_ratio, coefficients @ ..] = &numbers[..] else {
            panic!("too few columns: {line}")
        };
        Self {
            footprint: Footprint::new(*gap, *width, *poisson_ratio).unwrap(),
            coefficients: coefficients.try_into().unwrap(),
        }
    }

    /// Returns the errors of the six coefficients, divided by the `α` of the same direction.
    fn errors(&self, found: &Springs) -> [f64; 6] {
        let exact = &self.coefficients;
        std::array::from_fn(|i| {
            let value = if i < 3 { found.direct[i] } else { found.coupling[i - 3] };
            (value - exact[i]).abs() / exact[i % 3]
        })
    }

    /// Solves for the springs by boundary elements, also within the range of the table.
    fn solved(&self) -> Springs {
        (&RowStiffness::solve(&self.footprint, 1).unwrap()).into()
    }
}

/// References for both sweeps of the paper and for a grid over `b/a` 0.25 … 80, `d/a` 0.017 … 80.
static REFERENCES: LazyLock<Vec<Reference>> =
    LazyLock::new(|| include_str!("reference.csv").lines().skip(1).map(Reference::parse).collect());

#[test]
fn every_design_of_the_paper_has_a_reference() {
    for half_over_length in [0.5, 1.0] {
        for length in [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0] {
            for gap in 1..=10 {
                let a = half_over_length * length;
                let key = Footprint::new(f64::from(gap) / 10.0 / a, 1.0 / a, 0.5).unwrap();
                assert!(REFERENCES.iter().any(|row| row.footprint == key), "{key:?}");
            }
        }
    }
}

#[test]
fn solved_springs_agree_with_the_references() {
    for row in REFERENCES.iter() {
        let actual = row.errors(&row.solved());
        for (i, error) in actual.into_iter().enumerate() {
            assert!(
                error < REQUIRED / 10.0,
                "coefficient {i} is off by {error:.1e} for {:?}",
                row.footprint
            );
            // A coupling is also compared relative to itself if it is at least a thousandth of the
            // direct stiffness in the same direction.
            let ratio = row.coefficients[i].abs() / row.coefficients[i % 3];
            assert!(
                ratio < 1e-3 || error < REQUIRED * ratio,
                "coefficient {i} is off by {:.1e} of its own value for {:?}",
                error / ratio,
                row.footprint
            );
        }
    }
}

/// The tolerance includes the error of the references themselves, at most 6e-6.
#[test]
fn the_table_agrees_with_the_references() {
    for row in REFERENCES.iter() {
        let found = calibrate(&row.footprint).unwrap();
        let worst = row.errors(&found).into_iter().fold(0.0, f64::max);
        assert!(worst < found.error + 6e-6, "{worst:.1e} for {:?}", row.footprint);
        assert!(found.error <= 1e-5, "{:?}", row.footprint);
    }
}

#[test]
fn the_estimated_error_bounds_the_actual_error() {
    let mut factors: Vec<f64> = Vec::new();
    for row in REFERENCES.iter() {
        let solved = row.solved();
        let (actual, estimate) = (row.errors(&solved), solved.error);
        let worst = actual.into_iter().fold(0.0, f64::max);
        assert!(estimate >= worst, "{estimate:.1e} < {worst:.1e} for {:?}", row.footprint);
        assert!(estimate < REQUIRED / 2.0, "{estimate:.1e} for {:?}", row.footprint);
        factors.push(estimate / worst);
    }
    factors.sort_by(f64::total_cmp);
    let median = factors[factors.len() / 2];
    assert!(median < 8.0, "the estimate is {median:.1} times the error");
}

/// Compares 4, 8 and 16 cells per side. The extrapolation (S7) assumes the third order.
#[test]
fn reactions_converge_with_third_order() {
    for (gap, width) in [(1e3, 2.0), (2.0, 2.0), (0.05, 2.0), (0.05, 80.0), (2.0, 0.25)] {
        let footprint = Footprint::new(gap, width, 0.5).unwrap();
        let [coarse, medium, fine] =
            [4, 8, 16].map(|n| row_reactions(&footprint, 1, n).unwrap().direct[2]);
        let order = ((coarse - medium) / (medium - fine)).log2();
        assert!((2.5..3.5).contains(&order), "order {order:.2} at d/a = {gap}, b/a = {width}");
    }
}

/// Returns the relative difference of the two cross terms, which is 0 by Betti's theorem.
fn reciprocity_defect(found: &RowReactions) -> f64 {
    let CrossTerms { force, moment } = found.cross[0];
    (force - moment).abs() / force.abs().max(moment.abs())
}

/// The difference of the cross terms decreases at least with the square of the number of cells.
///
/// Collocation does not satisfy Betti's theorem exactly, so this difference measures its error.
#[test]
fn cross_terms_converge_to_bettis_theorem() {
    for (gap, width) in [(0.05, 0.25), (0.2, 2.0), (2.0, 2.0), (0.05, 80.0), (4.0, 80.0)] {
        let footprint = Footprint::new(gap, width, 0.5).unwrap();
        let [coarse, used, fine] =
            [4, 8, 16].map(|n| reciprocity_defect(&row_reactions(&footprint, 1, n).unwrap()));
        assert!(used < 1e-2, "{used:.1e} at d/a = {gap}, b/a = {width}");
        assert!(fine < coarse / 16.0, "{coarse:.1e} to {fine:.1e} at d/a = {gap}, b/a = {width}");
    }
}

/// The error estimate remains reliable far outside the range of the table.
#[test]
fn extreme_footprints_have_larger_error_estimates() {
    for (gap, width) in [(1e-3, 2.0), (1e-6, 2.0), (1.0, 1e-2), (1.0, 1e4), (1e-3, 100.0)] {
        let footprint = Footprint::new(gap, width, 0.5).unwrap();
        let found = calibrate(&footprint).unwrap();
        let exact = substrate::extrapolated(&footprint, [12, 18]).unwrap();
        for i in 0..3 {
            assert!((found.direct[i] - exact[i]).abs() < found.error * exact[i], "{footprint:?}");
            assert!((found.coupling[i] - exact[i + 3]).abs() < found.error * exact[i]);
        }
        assert!(found.error < 2e-2, "{} for {footprint:?}", found.error);
    }
}

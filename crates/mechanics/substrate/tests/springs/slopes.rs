//! Derivatives of the springs with respect to the footprint.
//!
//! Within the range of the table they are compared with finite differences, outside it with known
//! values.

use substrate::FootprintParameter::{Gap, PoissonRatio, Size, Width};
use substrate::{Coupling, Footprint, RowStiffness, StiffnessSlopes};

fn numbers(stiffness: &RowStiffness) -> Vec<f64> {
    let neighbours = stiffness.neighbours.iter();
    let neighbours = neighbours.flat_map(|n| n.direct.into_iter().chain([n.cross]));
    stiffness.direct.into_iter().chain(neighbours).collect()
}

fn slopes(gap: f64, width: f64, poisson_ratio: f64, coupling: Coupling) -> StiffnessSlopes {
    let footprint = Footprint::new(gap, width, poisson_ratio).unwrap();
    let slopes = StiffnessSlopes::compute(&footprint, coupling).unwrap();
    assert_eq!(slopes.stiffness, RowStiffness::compute(&footprint, coupling).unwrap());
    slopes
}

/// Asserts that errors are at most `tolerance` times the sum of value and a tenth of the largest.
fn assert_close(ours: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let largest = expected.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
    for (ours, expected) in ours.iter().zip(expected) {
        let allowed = tolerance * (expected.abs() + 0.1 * largest);
        assert!((ours - expected).abs() <= allowed, "{what}: {ours} {expected}");
    }
}

#[test]
fn derivatives_agree_with_differences_of_the_table() {
    let step = 1e-5;
    for [gap, width, ratio] in
        [[0.2, 1.7, 0.1], [0.03, 3.1, 0.37], [60.0, 0.6, 0.45], [1.3, 40.0, 0.2]]
    {
        for coupling in [Coupling::Nearest, Coupling::Full] {
            let found = slopes(gap, width, ratio, coupling);
            for (parameter, [by_gap, by_width, by_ratio], unit) in [
                (Gap, [gap, 0.0, 0.0], gap),
                (Width, [0.0, width, 0.0], width),
                (Size, [gap, width, 0.0], 1.0),
                (PoissonRatio, [0.0, 0.0, 1.0], 1.0),
            ] {
                let [high, low] = [step, -step].map(|h| {
                    let footprint = Footprint::new(
                        gap + h * by_gap,
                        width + h * by_width,
                        ratio + h * by_ratio,
                    );
                    numbers(&RowStiffness::compute(&footprint.unwrap(), coupling).unwrap())
                });
                let expected: Vec<_> =
                    high.iter().zip(low).map(|(high, low)| (high - low) / (2.0 * step)).collect();
                let what = format!("{gap} {width} {ratio} {coupling:?} {parameter:?}");
                let slope = found.by(parameter).unwrap().clone() * unit;
                assert_close(&numbers(&slope), &expected, 1e-6, &what);
            }
        }
    }
}

/// Known derivatives of seven stiffness values for footprints outside the table.
///
/// A line holds gap, width, Poisson's ratio, and the derivatives of `K_0` and `K_1` in `x`, `y`,
/// `φ` and of `c`. The three lines of a footprint are derivatives with respect to gap, width and
/// Poisson's ratio. They were computed by differentiating the matrices and the mesh.
const BEYOND: &str = "
0.005 1.7 0.3 -107.7784891 -107.7603129 -104.7822641 54.0507774 54.09815128 -53.07484983 0.0
0.005 1.7 0.3 2.339886676 2.366220771 2.042487522 -1.090018983 -1.086563414 0.7467053108 0.0
0.005 1.7 0.3 -1.330555712 0.0 0.0 0.205055342 0.0 0.0 0.0
0.3 130.0 0.5 -121.6590887 -121.3575518 -68.60084465 61.67330042 61.82349687 -46.10784962 0.0
0.3 130.0 0.5 1.060035698 1.062294965 0.9796698657 -0.5016773238 -0.4977950747 0.1737823535 0.0
0.3 130.0 0.5 -3.994382755 0.0 0.0 -1.840484687 0.0 0.0 0.0
300.0 3.0 0.1 -3.604048545e-07 -3.387576681e-07 -7.652323751e-12 2.837400676e-05 2.820169217e-05 -1.908832946e-09 0.0
300.0 3.0 0.1 0.4999204968 0.5148957563 0.7983540962 -0.00316443526 -0.003082719285 1.063922887e-07 0.0
300.0 3.0 0.1 -1.454323579 0.0 0.0 -0.0003142722621 0.0 0.0 0.0
0.3 0.1 0.3 -0.06432499196 -0.06944072606 -0.02168993609 0.06956291147 0.08157508792 -0.04655505034 0.0599530447
0.3 0.1 0.3 1.863620214 2.240072324 1.467607424 -0.4454317348 -0.5004358257 0.1380342658 -0.2210465345
0.3 0.1 0.3 -0.7062879061 0.0 0.0 0.06926553856 0.0 0.0 0.0
";

/// Outside the range of the table the program differentiates boundary-element solutions.
#[test]
fn derivatives_outside_the_table_agree_with_exact_derivatives() {
    let rows: Vec<Vec<f64>> = BEYOND
        .trim()
        .lines()
        .map(|line| line.split(' ').map(|number| number.parse().expect("a number")).collect())
        .collect();
    let couplings = [Coupling::Nearest, Coupling::Nearest, Coupling::Nearest, Coupling::Full];
    assert_eq!(rows.len(), 3 * couplings.len());
    for (of_footprint, coupling) in rows.chunks(3).zip(couplings) {
        let [gap, width, ratio] = [0, 1, 2].map(|k| of_footprint[0][k]);
        let found = slopes(gap, width, ratio, coupling);
        let found = [Gap, Width, PoissonRatio].map(|parameter| found.by(parameter).unwrap());
        for (found, known) in found.into_iter().zip(of_footprint) {
            assert_close(
                &numbers(found)[..7],
                &known[3..],
                1e-7,
                &format!("{gap} {width} {ratio}"),
            );
        }
    }
}

//! The table agrees with boundary elements at points between the nodes of its polynomials.

use substrate::boundary_element::row_reactions;
use substrate::table::{GAPS, WIDTHS};
use substrate::{Coupling, Footprint, NEIGHBOURS, RowStiffness, calibrate};

/// Returns footprints scattered over the range, from fractional parts of multiples of square roots.
fn footprints(count: usize) -> impl Iterator<Item = Footprint> {
    (1..=count).map(|k| {
        let [gap, width, ratio] = [5.0, 2.0, 3.0].map(|step| (k as f64 * f64::sqrt(step)).fract());
        let [gap, width] =
            [(GAPS, gap), (WIDTHS, width)].map(|([low, high], part)| low * (high / low).powf(part));
        // Every second footprint has an incompressible substrate.
        let ratio = if k % 2 == 0 { 0.5 } else { 0.5 * ratio };
        Footprint::new(gap, width, ratio).unwrap()
    })
}

/// Solves a row on three meshes and extrapolates the results twice.
fn solved(footprint: &Footprint, neighbours: usize, cells: [usize; 3]) -> Vec<f64> {
    let [coarse, medium, fine] =
        cells.map(|n| row_reactions(footprint, neighbours, n).unwrap().numbers());
    let finer = [1, 2].map(|k| cells[k] as f64 / cells[k - 1] as f64);
    let check = limit([&coarse, &medium], finer[0], 3);
    let best = limit([&medium, &fine], finer[1], 3);
    limit([&check, &best], finer[1], 4)
}

fn limit([coarse, fine]: [&[f64]; 2], finer: f64, order: i32) -> Vec<f64> {
    let factor = 1.0 / (finer.powi(order) - 1.0);
    coarse.iter().zip(fine).map(|(coarse, fine)| fine + (fine - coarse) * factor).collect()
}

#[test]
fn tabulated_springs_agree_with_fine_meshes() {
    for footprint in footprints(12) {
        let springs = calibrate(&footprint).unwrap();
        let exact = solved(&footprint, 1, [10, 14, 20]);
        for k in 0..3 {
            let off = [springs.direct[k] - exact[k], springs.coupling[k] + exact[3 + k]];
            for off in off.map(|off| (off / exact[k]).abs()) {
                assert!(off < springs.error, "{off:.1e} in {k} for {footprint:?}");
            }
        }
    }
}

/// The stated error is also smaller than the neglected coupling beyond eight neighbours.
#[test]
fn long_rows_agree_with_boundary_elements() {
    for footprint in footprints(2) {
        let row = RowStiffness::compute(&footprint, Coupling::Full).unwrap();
        let exact = solved(&footprint, NEIGHBOURS, [6, 8, 12]);
        let mut errors: Vec<f64> = (0..3).map(|k| 1.0 - exact[k] / row.direct[k]).collect();
        let size = (row.direct[1] * row.direct[2]).sqrt();
        assert_eq!(row.neighbours.len(), NEIGHBOURS);
        for (neighbour, exact) in row.neighbours.iter().zip(exact[3..].chunks(5)) {
            errors.extend((0..3).map(|k| (neighbour.direct[k] - exact[k]) / row.direct[k]));
            errors.push((neighbour.cross - f64::midpoint(exact[3], exact[4])) / size);
        }
        assert!(errors.iter().all(|off| off.abs() < row.error), "{errors:?} for {footprint:?}");
        assert!(row.error <= 1e-4 && row.truncation > row.error);
    }
}

/// Compares springs just within and just beyond the limits of the range.
///
/// Boundary elements, used beyond the limits, state a larger error than the table.
#[test]
fn table_and_boundary_elements_agree_at_the_range_limits() {
    for [gap, width] in [[0.0125, 0.25], [0.0125, 80.0], [100.0, 0.25], [100.0, 80.0]] {
        let outside =
            [gap, width].map(|size| size * if size > 1.0 { 1.0 + 1e-9 } else { 1.0 - 1e-9 });
        let [within, beyond] = [[gap, width], outside]
            .map(|[gap, width]| calibrate(&Footprint::new(gap, width, 0.4).unwrap()).unwrap());
        assert!(beyond.error > 3.0 * within.error, "{beyond:?}");
        for k in 0..3 {
            let off = (within.direct[k] - beyond.direct[k]).abs() / within.direct[k];
            assert!(off < 3e-4 && off < beyond.error, "{off} {within:?}");
        }
    }
}

//! The closed form of the far field against long finite rows.

use substrate::{Coupling, FarField, Footprint, Neighbour, RowStiffness, Springs};

fn springs(alpha: f64, ratio: f64) -> RowStiffness {
    let direct = [alpha, 2.0 * alpha, 0.5 * alpha];
    let coupling = [0.5 * ratio, 0.4 * ratio, -0.45 * ratio];
    let coupling = std::array::from_fn(|k| direct[k] * coupling[k]);
    RowStiffness::from(&Springs { direct, coupling, error: 0.0 })
}

/// Displacements of the free scales of a row whose first scale is displaced by 1, and the force on that scale: by Thomas's
/// algorithm, from the far end, in the direction `k`.
fn finite_row(stiffness: &RowStiffness, k: usize, scales: usize) -> (Vec<f64>, f64) {
    let (alpha, beta) = (stiffness.direct[k], -stiffness.neighbours[0].direct[k]);
    let mut ratios = Vec::new();
    let mut own = alpha;
    for _ in 1..scales {
        ratios.push(beta / own);
        own = alpha - beta * beta / own;
    }
    let mut displacements = vec![1.0];
    for ratio in ratios.iter().rev() {
        displacements.push(ratio * displacements[displacements.len() - 1]);
    }
    (displacements, own)
}

#[test]
fn a_long_row_behaves_like_an_endless_one() {
    for ratio in [-0.98, -0.3, 0.0, 0.2, 0.7, 0.98] {
        let stiffness = springs(3.0, ratio);
        let far = stiffness.far_field().unwrap();
        for k in 0..3 {
            let (displacements, force) = finite_row(&stiffness, k, 400);
            assert!(((stiffness.direct[k] - far.relief[k]) / force - 1.0).abs() < 1e-13);
            for (distance, displacement) in displacements.iter().take(20).enumerate() {
                let found = far.displacement([1.0; 3], distance)[k];
                assert!(
                    (found - displacement).abs() <= 1e-12 * displacement.abs(),
                    "{k} {distance}"
                );
            }
        }
    }
}

#[test]
fn rows_of_bases_on_a_half_space_decay() {
    for [gap, width] in [[0.2, 2.0], [0.0125, 0.25], [40.0, 80.0], [0.2, 20.0]] {
        let footprint = Footprint::new(gap, width, 0.5).unwrap();
        let stiffness = RowStiffness::of(&footprint, Coupling::Nearest).unwrap();
        let FarField { decay, relief } = stiffness.far_field().unwrap();
        // Shear and depth have one sign, rotations alternate.
        assert!(0.0 < decay[0] && decay[0] < 1.0 && 0.0 < decay[1] && decay[1] < 1.0, "{decay:?}");
        assert!(-1.0 < decay[2] && decay[2] < 0.0, "{decay:?}");
        assert!((0..3).all(|k| relief[k] > 0.0 && relief[k] < 0.5 * stiffness.direct[k]));
    }
}

#[test]
fn couplings_beyond_the_nearest_neighbour_have_no_such_form() {
    let footprint = Footprint::new(0.2, 2.0, 0.5).unwrap();
    assert_eq!(RowStiffness::solve(&footprint, 2).unwrap().far_field(), None);
    assert_eq!(RowStiffness::solve(&footprint, 1).unwrap().far_field(), None);
    // Nothing decays where a scale is held by its neighbours alone.
    let mut loose = springs(1.0, 0.5);
    loose.neighbours = vec![Neighbour { direct: [-0.5, -0.1, 0.1], cross: 0.0 }];
    assert_eq!(loose.far_field(), None);
}

//! Footprints as keys, and calibrations shared between threads.

use std::thread;

use substrate::{Calibrations, Footprint, calibrate};

fn footprints(count: u32) -> Vec<Footprint> {
    (1..=count).map(|k| Footprint::new(0.1 * f64::from(k), 2.0, 0.5).unwrap()).collect()
}

#[test]
fn each_footprint_is_solved_once() {
    let (shared, asked) = (Calibrations::default(), footprints(5));
    thread::scope(|scope| {
        for start in 0..8 {
            let (shared, asked) = (&shared, &asked);
            scope.spawn(move || {
                for k in 0..asked.len() {
                    let footprint = asked[(start + k) % asked.len()];
                    assert_eq!(shared.get(&footprint), calibrate(&footprint));
                }
            });
        }
    });
    assert_eq!(shared.solved(), asked.len());
    assert_eq!(shared.held(), asked.len());
}

#[test]
fn memory_is_bounded_and_nothing_depends_on_it() {
    let (small, asked) = (Calibrations::with_capacity(4), footprints(9));
    for _ in 0..2 {
        for footprint in &asked {
            assert_eq!(small.get(footprint), calibrate(footprint));
            assert!(small.held() <= 4, "{} held", small.held());
        }
    }
    assert_eq!(small.solved(), 18);
}

/// What is asked again and again survives any number of others.
#[test]
fn what_is_used_is_kept() {
    let (small, asked) = (Calibrations::with_capacity(4), footprints(12));
    for footprint in &asked {
        small.get(footprint).unwrap();
        small.get(&asked[0]).unwrap();
    }
    assert_eq!(small.solved(), asked.len());
}

#[test]
fn errors_are_remembered() {
    let lost = Footprint::new(1e-17, 2.0, 0.5).unwrap();
    let shared = Calibrations::default();
    let error = shared.get(&lost).unwrap_err();
    assert_eq!(
        error.to_string(),
        "no tractions found under rectangles of gap/a = 1e-17 and width/a = 2e0 with 4 cells a side"
    );
    assert_eq!((shared.get(&lost), shared.solved()), (Err(error), 1));
}

#[test]
fn numbers_out_of_range_are_refused() {
    let message = |gap, width, ratio| Footprint::new(gap, width, ratio).unwrap_err().to_string();
    assert_eq!(message(0.0, 2.0, 0.5), "gap over a is 0, expected a positive length");
    assert_eq!(message(f64::NAN, 2.0, 0.5), "gap over a is NaN, expected a positive length");
    assert_eq!(message(1.0, f64::INFINITY, 0.5), "width over a is inf, expected a positive length");
    assert_eq!(message(1.0, -2.0, 0.5), "width over a is -2, expected a positive length");
    assert_eq!(message(1.0, 2.0, 0.51), "poisson's ratio is 0.51, expected a ratio from 0 to 0.5");
    assert_eq!(
        message(1.0, 2.0, f64::NAN),
        "poisson's ratio is NaN, expected a ratio from 0 to 0.5"
    );
}

#[test]
fn a_negative_zero_is_the_same_key() {
    assert_eq!(Footprint::new(1.0, 2.0, -0.0), Footprint::new(1.0, 2.0, 0.0));
}

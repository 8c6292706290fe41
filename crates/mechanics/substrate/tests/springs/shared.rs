//! Tests of footprints as keys of a cache, and of springs shared by threads.

use std::thread;

use substrate::{Calibrations, Footprint, calibrate};

fn footprints(count: u32) -> Vec<Footprint> {
    (1..=count).map(|k| Footprint::new(0.1 * f64::from(k), 2.0, 0.5).unwrap()).collect()
}

#[test]
fn all_threads_get_the_springs_of_their_footprint() {
    // A small cache, which drops footprints during the test.
    let (shared, requested) = (Calibrations::with_capacity(4), footprints(5));
    thread::scope(|scope| {
        for start in 0..8 {
            let count = requested.len();
            let (shared, requested) = (&shared, requested.iter().cycle().skip(start).take(count));
            scope.spawn(move || {
                for footprint in requested {
                    assert_eq!(shared.get(footprint), calibrate(footprint));
                }
            });
        }
    });
}

#[test]
fn a_gap_that_vanishes_by_rounding_is_an_error_at_each_request() {
    let lost = Footprint::new(1e-17, 2.0, 0.5).unwrap();
    let shared = Calibrations::default();
    let error = shared.get(&lost).unwrap_err();
    assert_eq!(
        error.to_string(),
        "cannot solve for the tractions under rectangles of gap/a = 1e-17 and width/a = 2e0 with \
         4 cells a side: use a wider gap"
    );
    assert_eq!(shared.get(&lost), Err(error));
}

#[test]
fn footprints_out_of_range_are_refused() {
    for (gap, width, ratio, message) in [
        (0.0, 2.0, 0.5, "gap over a is 0, expected a positive length"),
        (f64::NAN, 2.0, 0.5, "gap over a is NaN, expected a positive length"),
        (1.0, f64::INFINITY, 0.5, "width over a is inf, expected a positive length"),
        (1.0, -2.0, 0.5, "width over a is -2, expected a positive length"),
        (1.0, 2.0, 0.51, "poisson's ratio is 0.51, expected a ratio from 0 to 0.5"),
        (1.0, 2.0, f64::NAN, "poisson's ratio is NaN, expected a ratio from 0 to 0.5"),
    ] {
        assert_eq!(Footprint::new(gap, width, ratio).unwrap_err().to_string(), message);
    }
}

#[test]
fn poissons_ratios_of_zero_and_negative_zero_are_equal() {
    assert_eq!(Footprint::new(1.0, 2.0, -0.0), Footprint::new(1.0, 2.0, 0.0));
}

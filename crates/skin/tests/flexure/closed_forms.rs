//! Closed forms: `M*/κ* = p/d` before contact, and where upright blocks meet.

use approx::assert_relative_eq;
use skin::flexure::{Flexure, Parameters, solve};
use skin::{Base, ContactChange};

use crate::samples::{design, forty, small_steps};

#[test]
fn before_contact_the_moment_is_the_curvature_times_pitch_over_gap() {
    let mut compared = 0;
    for design in forty() {
        let pitch = design.row().unwrap().pitch();
        let parameters = Parameters { solver: small_steps(), ..Parameters::default() };
        let flexure = solve(&design, &parameters).unwrap();
        let free = flexure.path.iter().skip(1).take_while(|point| point.contacts == 0);
        for point in free {
            let expected = point.curvature * pitch / design.gap;
            assert_relative_eq!(point.moment, expected, max_relative = 1e-10);
            compared += 1;
        }
        let initial = flexure.measures.initial_compliance.unwrap();
        assert_relative_eq!(initial, design.gap / pitch, max_relative = 1e-10);
    }
    assert!(compared > 400, "{compared}");
}

/// Upright blocks on a strip so short that they meet, with this many elements in each gap.
fn blocks(gap: f64, length: f64, elements_per_gap: usize) -> Flexure {
    let parameters = Parameters { membrane_length: 4.0, elements_per_gap, ..Parameters::default() };
    solve(&design(gap, length, 0.0, Base::L), &parameters).unwrap()
}

/// The tops of upright blocks are closer to the centre of curvature by 1 than the axis of the membrane: they
/// meet where the arc of the gap, seen from there, has shrunk to nothing. With `M d/EI = θ` that is `θ = d`,
/// whatever the length of the blocks.
#[test]
fn upright_blocks_meet_at_a_moment_of_one() {
    for (gap, length) in [(0.1, 1.0), (0.1, 0.2), (0.3, 0.5), (0.5, 1.0)] {
        let flexure = blocks(gap, length, 128);
        let first = flexure.events[0];
        assert_eq!(first.change, ContactChange::Closed);
        assert_relative_eq!(first.point.moment, 1.0, max_relative = 1e-6);
        let curvature = flexure.measures.first_contact_curvature.unwrap();
        assert_relative_eq!(curvature, gap / (gap + length), max_relative = 1e-6);
    }
}

/// Bent by `θ`, `m` elements form a polygon whose sides keep their length: its ends are
/// `d sin(θ/2)/(m sin(θ/2m))` apart, and the blocks meet where that is `2 sin(θ/2)`: `θ = 2m asin(d/2m)`, which
/// tends to `d` as `1/m²`.
#[test]
fn with_few_elements_they_meet_where_the_polygon_says() {
    for elements in [1, 2, 3, 8] {
        for gap in [0.1, 0.5, 1.0] {
            let first = blocks(gap, 1.0, elements).events[0];
            let m = elements as f64;
            let expected = 2.0 * m * (gap / (2.0 * m)).asin() / gap;
            assert_relative_eq!(first.point.moment, expected, max_relative = 1e-9);
        }
    }
}

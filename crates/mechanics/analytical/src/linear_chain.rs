//! Response of a row of scales coupled by the substrate, before the first contact.
//!
//! Without contact, the displacements `y_i` and the rotations `φ_i` of the scales are solutions of
//! two separate tridiagonal systems. Both have the form `α u_i − β (u_{i−1} + u_{i+1}) = f_i` with
//! the load `f_i` on scale `i` (Eq. 1 of Shafiei et al. 2021, doi 10.1016/j.jmps.2020.104176).

/// Displacements due to a unit load on the middle scale of a row (Green's function).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance {
    /// Displacement of the middle scale.
    pub middle: f64,
    /// Displacement of the nearest neighbours of the middle scale.
    pub neighbour: f64,
}

/// Returns the compliance of a finite row for a load on its middle scale.
///
/// `scales` is the number of scales, odd and at least 3; `direct` is `α` and `coupling` is `β`. The
/// system is solved by the Thomas algorithm.
pub fn compliance(scales: usize, direct: f64, coupling: f64) -> Compliance {
    let middle = scales / 2;
    let (mut above, mut right) = (vec![0.0; scales], vec![0.0; scales]);
    for i in 0..scales {
        let [c, r] = if i > 0 { [above[i - 1], right[i - 1]] } else { [0.0; 2] };
        let pivot = direct + coupling * c;
        above[i] = -coupling / pivot;
        right[i] = (f64::from(u8::from(i == middle)) + coupling * r) / pivot;
    }
    let mut u = right;
    for i in (0..scales - 1).rev() {
        u[i] -= above[i] * u[i + 1];
    }
    Compliance { middle: u[middle], neighbour: u[middle + 1] }
}

/// Returns the compliance of an infinite row.
///
/// The scale `i` positions from the loaded scale is displaced by `r^|i|/√(α² − 4β²)`, where `r` is
/// the solution of `β (r + 1/r) = α` with `|r| < 1`. Requires `α > 2 |β| > 0`; `direct` is `α` and
/// `coupling` is `β`.
pub fn endless(direct: f64, coupling: f64) -> Compliance {
    let root = (direct * direct - 4.0 * coupling * coupling).sqrt();
    let decay = (direct - root) / (2.0 * coupling);
    Compliance { middle: 1.0 / root, neighbour: decay / root }
}

#[cfg(test)]
mod tests {
    use super::{compliance, endless};

    #[test]
    fn a_row_of_201_scales_has_the_compliance_of_an_infinite_row() {
        for (direct, coupling) in [(3.376, 1.082), (2.473, -0.428)] {
            let (long, limit) = (compliance(201, direct, coupling), endless(direct, coupling));
            assert!((long.middle - limit.middle).abs() < 1e-14, "{long:?} {limit:?}");
            assert!((long.neighbour - limit.neighbour).abs() < 1e-14, "{long:?} {limit:?}");
        }
    }
}

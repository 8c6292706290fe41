//! Computes relative lengths, divided by the scale thickness `t`, from lengths in mm.
//!
//! The solvers read only relative lengths. After every change of a parameter, [`settle`] computes
//! them from the lengths given in mm, e.g. `gap_over_t = gap_mm/t`. The order of setting length and
//! thickness does not matter.

use std::sync::LazyLock;

use super::{PARAMETERS, Parameter, Role, key, modulus};
use crate::case::{Case, Millimetres};
use crate::scalar::Scalar;
use text::number;

/// Pairs of parameters: a length in mm, and the relative length that it determines.
///
/// Cached, because [`settle`] runs for every design and the search by key is slow.
static LENGTHS_IN_MM: LazyLock<Vec<(&Parameter, &Parameter)>> = LazyLock::new(|| {
    let of_role = PARAMETERS.iter().flat_map(|parameter| {
        parameter.roles.iter().filter_map(move |role| match role {
            Role::InMm(key) => Some((parameter, Parameter::named(key)?)),
            _ => None,
        })
    });
    of_role.collect()
});

impl Parameter {
    /// Returns the parameter of the same length divided by the thickness.
    ///
    /// `None` if this parameter is not a length in mm.
    pub fn over_t(&self) -> Option<&'static Self> {
        LENGTHS_IN_MM.iter().find(|(in_mm, _)| *in_mm == self).map(|&(_, over_t)| over_t)
    }

    /// Returns the parameters in mm that determine this relative length.
    pub fn in_mm(&self) -> impl Iterator<Item = &'static Self> {
        Self::with(Role::InMm(self.key))
    }

    /// Returns true if this parameter is `key`, or the length `key` in mm.
    pub(crate) fn is_or_determines(&self, key: &str) -> bool {
        // Exclude the pitch: if it counted as a gap, a definition with a pitch would also give a
        // gap, so every pitch would determine the length.
        let is_pitch = self.key == key::PITCH;
        self.key == key || self.over_t().is_some_and(|of| !is_pitch && of.key == key)
    }

    /// Returns the parameter that this length in mm determines in `case`.
    ///
    /// A pitch determines the gap or the length. `None` if this parameter is not a length in mm.
    pub(crate) fn determines(&self, case: &Case) -> Option<&'static Self> {
        let determines_length = self.key == key::PITCH && case.in_mm.pitch_determines_length;
        if determines_length { Self::named(key::LENGTH) } else { self.over_t() }
    }

    /// Returns true if a length in mm or a modulus determines this parameter.
    pub fn follows(&self, case: &Case) -> bool {
        given(case).any(|(in_mm, ..)| in_mm.determines(case).is_some_and(|of| of == self))
            || self.follows_modulus(case)
    }

    /// Returns the value of this length in mm, which is given or follows from the thickness.
    ///
    /// The parameter must be a length in mm. `None` if neither it nor the thickness is given.
    pub fn millimetres(&self, case: &Case) -> Option<f64> {
        // Return the given value, because dividing it by the thickness and multiplying again may
        // change its last digits.
        if let Some(given) = self.get(case).number() {
            return Some(given);
        }
        let thickness = case.material.thickness_mm?;
        let length = match self.key {
            key::PITCH => case.pitch(),
            _ => self.over_t()?.get(case).number()?,
        };
        Some(product(length, thickness))
    }
}

/// Returns the lengths that a case gives in mm.
///
/// Each item holds the parameter in mm, the parameter of the relative length, and the length in mm.
fn given(case: &Case) -> impl Iterator<Item = (&'static Parameter, &'static Parameter, f64)> {
    // Skip the search if no length is given in mm, because a sweep creates one case per design.
    let is_none = case.in_mm == Millimetres::default();
    let all = if is_none { &[] } else { LENGTHS_IN_MM.as_slice() };
    all.iter().filter_map(|&(in_mm, over_t)| Some((in_mm, over_t, in_mm.get(case).number()?)))
}

/// Computes the relative lengths from the lengths in mm.
pub(super) fn settle(case: &mut Case) {
    let Some(thickness) = case.material.thickness_mm else { return };
    for (in_mm, over_t, length) in given(case).collect::<Vec<_>>() {
        if in_mm.key != key::PITCH {
            over_t.assign(case, Scalar::Number(quotient(length, thickness)));
        }
    }
    // The pitch comes last, because the gap follows from the pitch and the length, or the length
    // from the pitch and the gap.
    if let Some(pitch) = case.in_mm.pitch {
        let (pitch, design) = (quotient(pitch, thickness), &mut case.design);
        let base = 2.0 * design.half_base();
        if case.in_mm.pitch_determines_length {
            // Scale the length by the ratio of the bases, because the base is `L` or `2L`. A base
            // of zero, from a pitch that equals the gap, stays zero and is refused; scaling it
            // again would give NaN.
            if base != 0.0 {
                let length = design.length * (pitch - design.gap) / base;
                design.length = number::short_decimal(length, pitch);
            }
        } else {
            design.gap = number::short_decimal(pitch - base, pitch);
        }
    }
}

/// Divides a length in mm by the thickness, and removes the round-off of the quotient.
fn quotient(length: f64, thickness: f64) -> f64 {
    // Unrounded, 0.3/3 is slightly less than 0.1, so the same skin in mm and in units of the
    // thickness would be two designs.
    number::short_decimal(length / thickness, length / thickness)
}

/// Multiplies a relative length by the thickness, and removes the round-off of the product.
fn product(length: f64, thickness: f64) -> f64 {
    number::short_decimal(length * thickness, length * thickness)
}

/// Updates the parameters that follow from the parameter `changed`.
///
/// These are the same length in the other unit, all lengths after a change of the thickness, and
/// the ratios after a change of a modulus, strength or force.
pub(super) fn keep_in_step(case: &mut Case, changed: &Parameter) {
    if changed.is_in_mm() || changed.key == key::THICKNESS {
        settle(case);
        // The unit of a force given in N, `E_s t²`, depends on the thickness.
        modulus::settle(case);
    } else if changed.is_modulus() {
        modulus::settle(case);
    } else {
        restate(case, changed);
        modulus::restate(case, changed);
    }
}

/// Updates the lengths in mm after a change of the relative length `moved`.
fn restate(case: &mut Case, moved: &Parameter) {
    let Some(thickness) = case.material.thickness_mm else { return };
    // Update the pitch too, because otherwise the next `settle` would revert the change.
    let moves_pitch = [key::GAP, key::LENGTH].contains(&moved.key);
    for (in_mm, over_t, _) in given(case).collect::<Vec<_>>() {
        let length = match in_mm.key {
            key::PITCH if moves_pitch => case.pitch(),
            key::PITCH => continue,
            _ if over_t == moved => match moved.get(case).number() {
                Some(length) => length,
                None => continue,
            },
            _ => continue,
        };
        in_mm.assign(case, Scalar::Number(product(length, thickness)));
    }
}

/// Returns the case with another thickness, in mm, and unchanged lengths in mm.
///
/// `None` if the case gives no thickness.
pub(crate) fn with_thickness(case: &Case, thickness: f64) -> Option<Case> {
    let factor = case.material.thickness_mm? / thickness;
    let lengths = PARAMETERS.iter().filter(|p| p.has(Role::Continuous) && p.unit == "t");
    let mut moved = *case;
    // `settle` updates the lengths that follow from a length in mm.
    for parameter in lengths.filter(|parameter| !parameter.follows(case)) {
        if let Some(length) = parameter.get(case).number() {
            parameter.assign(&mut moved, Scalar::Number(length + (factor - 1.0) * length));
        }
    }
    moved.material.thickness_mm = Some(thickness);
    // The force in N remains the same, but its unit `E_s t²` changes.
    moved.needle_force = case.needle_force.map(|force| force * factor.powi(2));
    settle(&mut moved);
    modulus::settle(&mut moved);
    Some(moved)
}

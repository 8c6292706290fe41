//! Lengths in mm, and those over the thickness that follow from them.
//!
//! What lies behind a case reads lengths over the thickness alone. Whatever sets a parameter, [`settle`] has them follow from the
//! lengths that are given in mm: `gap_over_t = gap_mm/t`, with whichever of the two is known last.

use super::{PARAMETERS, Parameter, Role, Scalar, key, modulus};
use crate::case::{Case, Millimetres};

impl Parameter {
    /// The parameter of the same length over the thickness, of one in mm.
    pub fn over_t(&self) -> Option<&'static Self> {
        self.roles.iter().find_map(|role| match role {
            Role::InMm(key) => Self::named(key),
            _ => None,
        })
    }

    /// The parameters that say this length in mm.
    pub fn in_mm(&self) -> impl Iterator<Item = &'static Self> {
        Self::with(Role::InMm(self.key))
    }

    /// Whether it is the parameter of that key, or the same length in mm.
    pub(crate) fn is_or_says(&self, key: &str) -> bool {
        // Counted as a gap, a pitch would always stand beside one, and so always say a length.
        let is_other_way = self.key != key::PITCH;
        self.key == key || self.over_t().is_some_and(|of| is_other_way && of.key == key)
    }

    /// The parameter over the thickness that this one in mm says in `case`.
    pub(crate) fn said_in(&self, case: &Case) -> Option<&'static Self> {
        let says_length = self.key == key::PITCH && case.in_mm.pitch_says_length;
        if says_length { Self::named(key::LENGTH) } else { self.over_t() }
    }

    /// Whether it is a length over the thickness that follows from one in mm, or a ratio that follows from a modulus.
    pub fn follows(&self, case: &Case) -> bool {
        let says = |in_mm: &Self| in_mm.said_in(case).is_some_and(|of| of == self);
        given(case).any(|(in_mm, _)| says(in_mm)) || self.follows_modulus(case)
    }

    /// The length of this parameter in mm; `None` if it is no length, or the thickness is not given.
    pub fn millimetres(&self, case: &Case) -> Option<f64> {
        // As it is given: over the thickness and back its last digits may become others.
        if let Some(given) = self.get(case).number() {
            return Some(given);
        }
        let thickness = case.material.thickness_mm?;
        let length = match self.key {
            key::PITCH => pitch(case),
            _ => self.over_t()?.get(case).number()?,
        };
        Some(length * thickness)
    }
}

/// The lengths that a case gives in mm.
fn given(case: &Case) -> impl Iterator<Item = (&'static Parameter, f64)> {
    // Most cases give none, and a sweep makes one for each design.
    let all = if case.in_mm == Millimetres::default() { &[] } else { PARAMETERS };
    all.iter().filter(|p| p.is_in_mm()).filter_map(|p| Some((p, p.get(case).number()?)))
}

/// Base and gap over the thickness.
fn pitch(case: &Case) -> f64 {
    2.0 * case.design.half_base() + case.design.gap
}

/// Has the lengths over the thickness follow from those in mm.
pub(super) fn settle(case: &mut Case) {
    let Some(thickness) = case.material.thickness_mm else { return };
    for (in_mm, length) in given(case).collect::<Vec<_>>() {
        if let Some(of) = in_mm.over_t().filter(|_| in_mm.key != key::PITCH) {
            of.assign(case, Scalar::Number(length / thickness));
        }
    }
    // Behind the others: what a pitch says depends on the length or the gap beside it.
    if let Some(pitch) = case.in_mm.pitch {
        let (pitch, design) = (pitch / thickness, &mut case.design);
        let base = 2.0 * design.half_base();
        if case.in_mm.pitch_says_length {
            // A factor, because the base is `L` or `2L`.
            design.length *= (pitch - design.gap) / base;
        } else {
            design.gap = pitch - base;
        }
    }
}

/// Has the other unit of a length that has changed follow, or all lengths the thickness, or the ratios a modulus.
pub(super) fn keep_in_step(case: &mut Case, changed: &Parameter) {
    if changed.is_in_mm() || changed.key == key::THICKNESS {
        settle(case);
    } else if changed.is_modulus() {
        modulus::settle(case);
    } else {
        restate(case, changed);
        modulus::restate(case, changed);
    }
}

/// Has the lengths in mm say what `moved`, a length over the thickness, says now.
fn restate(case: &mut Case, moved: &Parameter) {
    let Some(thickness) = case.material.thickness_mm else { return };
    // A pitch that still said the old length would take the move back when it is settled next.
    let moves_pitch = [key::GAP, key::LENGTH].contains(&moved.key);
    for (in_mm, _) in given(case).collect::<Vec<_>>() {
        let length = match in_mm.key {
            key::PITCH if moves_pitch => pitch(case),
            key::PITCH => continue,
            _ if in_mm.over_t() == Some(moved) => match moved.get(case).number() {
                Some(length) => length,
                None => continue,
            },
            _ => continue,
        };
        in_mm.assign(case, Scalar::Number(length * thickness));
    }
}

/// The case of another thickness whose lengths stay as long as they are in mm, however they are given.
pub(crate) fn with_thickness(case: &Case, thickness: f64) -> Option<Case> {
    let factor = case.material.thickness_mm? / thickness;
    // Those that follow from a length in mm are settled at the end.
    let stays = |p: &&Parameter| p.has(Role::Continuous) && p.unit == "t" && !p.follows(case);
    let mut moved = *case;
    for parameter in PARAMETERS.iter().filter(stays) {
        if let Some(length) = parameter.get(case).number() {
            parameter.assign(&mut moved, Scalar::Number(length + (factor - 1.0) * length));
        }
    }
    moved.material.thickness_mm = Some(thickness);
    settle(&mut moved);
    Some(moved)
}

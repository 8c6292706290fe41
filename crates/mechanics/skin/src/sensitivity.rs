//! Derivatives of the measures of a path with respect to parameters.
//!
//! A measure is a function of the equilibrium at one place of the path: its end, the first contact, the place of a maximum. The
//! place moves with a parameter by (D2), the active set held, and the measure with it; explicit functions alone are differenced.
//! Where a contact changes, or another scale takes over, within the step of these differences, the measure has a kink: both sides
//! are solved for, each with its active set.

mod curve;
mod measured_points;

use solver::{AnchoredPoint, Change, Linearisation, Moved, Neighbours, Settings};

use crate::ContactChange;
use crate::contacts::SkinState;
use crate::record::Skin;

pub use curve::CurvePoint;
pub(crate) use curve::{Curve, curve_point};
pub(crate) use measured_points::{end, first_contact, is_held, rest, summit, turn, vanished};

/// The derivative of a measure with respect to a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivative {
    /// Name of the measure, as in the tables.
    pub measure: &'static str,
    /// Index of the parameter among the variations.
    pub parameter: usize,
    /// Value of the measure.
    pub value: f64,
    /// Derivative where the parameter decreases; `None` if there is none.
    pub left: Option<f64>,
    /// Derivative where the parameter increases; the other one but at a kink.
    pub right: Option<f64>,
    /// The change at a kink; `None` where the measure is smooth.
    pub kink: Option<String>,
}

impl Derivative {
    /// The derivative of a measure of this `value` from those on both sides, by differences over twice the `step`. Those that are alike but
    /// for round-off are one.
    pub(crate) fn sided(
        (measure, parameter): (&'static str, usize),
        [left, right]: [Option<f64>; 2],
        value: f64,
        step: f64,
        kink: impl FnOnce() -> String,
    ) -> Self {
        let smooth = left.zip(right).is_some_and(|(left, right)| {
            // A difference over the step magnifies the round-off of the measure by its inverse.
            let round_off = ROUND_OFF * value.abs() / step;
            (left - right).abs() <= SMOOTH * left.abs().max(right.abs()) + round_off
        });
        let (right, kink) = (if smooth { left } else { right }, (!smooth).then(kink));
        Self { measure, parameter, value, left, right, kink }
    }
}

/// A quantity of an equilibrium, which may be the largest or the least of several.
pub(crate) struct MeasuredQuantity<S: Skin> {
    pub(crate) measure: &'static str,
    pub(crate) value: ValueOf<S>,
    /// Of one that is the extreme one of several, as many as there are scales: which of two counts.
    pub(crate) extreme: Option<fn(f64, f64) -> f64>,
    /// Whether the direction of the path enters.
    pub(crate) turns: bool,
}

/// The value of a quantity by system, state, direction of the path, and number among several.
pub(crate) type ValueOf<S> = fn(&S, &SkinState, &[f64], usize) -> f64;

/// A quantity of which there is one alone, and into which the direction of the path does not enter.
pub(crate) fn quantity<S: Skin>(measure: &'static str, value: ValueOf<S>) -> MeasuredQuantity<S> {
    MeasuredQuantity { measure, value, extreme: None, turns: false }
}

/// Quantities that are taken at one place of a path.
pub(crate) struct MeasuredPoint<S: Skin> {
    /// The place; `None` where it is not known.
    pub(crate) place: Option<AnchoredPoint<S::Mode>>,
    pub(crate) quantities: Vec<MeasuredQuantity<S>>,
}

/// One-sided derivatives that differ by less than this part belong to a smooth measure.
const SMOOTH: f64 = 1e-9;

/// A value that is farther from the extreme one than this part of the largest does not take its place within the step of a difference, some
/// millionths of a parameter.
const NEAR: f64 = 1e-3;

/// Round-off of a measure, as a part of its value.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Contacts that change within the step of a difference, one after the other, are at most so many.
const MOST_CHANGES: usize = 8;

/// The derivatives of the quantities of all `spots` with respect to the parameter of each variation. `settings` are those with
/// which the path was followed. A quantity whose place is not known has none.
pub(crate) fn derivatives<S: Skin>(
    system: &S,
    spots: Vec<MeasuredPoint<S>>,
    variations: &[Neighbours<S>],
    settings: &Settings,
) -> Vec<Derivative> {
    let mut derivatives = Vec::new();
    // One factorisation serves all that is measured at a place.
    for MeasuredPoint { place, quantities } in merged(spots) {
        let here = place.and_then(|place| Linearisation::new(system, place).ok());
        // A singular tangent has no single direction, so what is measured there has no derivative.
        let Some(here) = here else { continue };
        let turns = quantities.iter().any(|quantity| quantity.turns);
        let mut linearised = Linearised { system, settings, here, turns };
        // All quantities of a place move with it, so its motion is found once for each parameter.
        let sides: Vec<_> = variations.iter().map(|v| linearised.sides(v)).collect();
        for quantity in &quantities {
            let (value, contenders) = quantity.value_at(system, linearised.here.place());
            let of = |(parameter, (sides, variation))| {
                let rates = quantity.rates(variation, sides, &contenders);
                let kink = || sides.change().unwrap_or("another scale takes over").to_owned();
                let of = (quantity.measure, parameter);
                Derivative::sided(of, rates, value, variation.step, kink)
            };
            derivatives.extend(sides.iter().zip(variations).enumerate().map(of));
        }
    }
    derivatives
}

/// The spots, those at one place together.
fn merged<S: Skin>(spots: Vec<MeasuredPoint<S>>) -> Vec<MeasuredPoint<S>> {
    let mut merged: Vec<MeasuredPoint<S>> = Vec::new();
    for spot in spots {
        let is_there = |other: &&mut MeasuredPoint<S>| match (&other.place, &spot.place) {
            // The same state moves otherwise where another condition holds it.
            (Some(one), Some(other)) => one.state == other.state && one.anchor == other.anchor,
            _ => false,
        };
        match merged.iter_mut().find(is_there) {
            Some(there) => there.quantities.extend(spot.quantities),
            None => merged.push(spot),
        }
    }
    merged
}

/// A place whose tangent is factorised.
struct Linearised<'a, S: Skin> {
    system: &'a S,
    settings: &'a Settings,
    here: Linearisation<S::Mode>,
    turns: bool,
}

/// How a place moves on both sides of a parameter.
struct Sides<M> {
    left: SideMotion<M>,
    /// `None` where the place moves on the right as on the left.
    right: Option<SideMotion<M>>,
}

impl<M> Sides<M> {
    /// The contact that changes on a side, if one does.
    fn change(&self) -> Option<&str> {
        let right = self.right.as_ref().and_then(|right| right.change.as_deref());
        right.or(self.left.change.as_deref())
    }
}

/// How a place moves on one side of a parameter.
struct SideMotion<M> {
    /// The place below and above; `None` if there is no equilibrium on this side.
    moved: Option<[Moved<M>; 2]>,
    /// The contact that changes on this side.
    change: Option<String>,
}

impl<S: Skin> Linearised<'_, S> {
    /// How the place moves on both sides of a parameter.
    fn sides(&mut self, neighbours: &Neighbours<S>) -> Sides<S::Mode> {
        let moved = self.here.moved(self.system, neighbours, self.turns);
        let on_left = self.here.violated(&neighbours.below, &moved[0]);
        let on_right = self.here.violated(&neighbours.above, &moved[1]);
        // Nothing changes within the step, so one motion serves both sides.
        if (on_left, on_right) == (None, None) {
            return Sides { left: SideMotion { moved: Some(moved), change: None }, right: None };
        }
        let right = Some(self.side(neighbours, 1, moved.clone(), on_right));
        Sides { left: self.side(neighbours, 0, moved, on_left), right }
    }

    /// How the place moves on one side, where `violated` is the first contact that has to change.
    fn side(
        &self,
        neighbours: &Neighbours<S>,
        side: usize,
        mut moved: [Moved<S::Mode>; 2],
        mut violated: Option<Change>,
    ) -> SideMotion<S::Mode> {
        let (mut here, mut name) = (self.here.clone(), None);
        let at_side = [&neighbours.below, &neighbours.above][side];
        for _ in 0..MOST_CHANGES {
            let Some(change) = violated else {
                return SideMotion { moved: Some(moved), change: name };
            };
            let next = here.beyond(self.system, change, self.settings);
            let after = next.as_ref().map_or(&here.place().state, |next| &next.place().state);
            // The first change gives the kink its name: the others only follow on the same side.
            name.get_or_insert_with(|| self.name(&here.place().state, after, change));
            let Some(next) = next else { break };
            here = next;
            moved = here.moved(self.system, neighbours, self.turns);
            violated = here.violated(at_side, &moved[side]);
        }
        // Without an equilibrium behind the changes this side has no derivative.
        SideMotion { moved: None, change: name }
    }

    /// The change of a contact in words.
    fn name(&self, before: &SkinState, after: &SkinState, change: Change) -> String {
        if change.constraint >= self.system.contacts().forces.len() {
            return "the needle moves otherwise".to_owned();
        }
        let contacts = self.system.contacts();
        let edge = |state: &SkinState| contacts.corner_edge(&state.mode, change.constraint);
        let edge = edge(after).or_else(|| edge(before)).map_or("contact", |edge| edge.name());
        let [left_index, right_index] = contacts.scales_of(change.constraint);
        let scales = match (self.system.number(left_index), self.system.number(right_index)) {
            // Neighbours are named by the left one: only distant scales need both numbers.
            (Some(left), _) if right_index == left_index + 1 => format!(" right of scale {left}"),
            (Some(left), Some(right)) => format!(" of scales {left} and {right}"),
            _ => String::new(),
        };
        format!("{edge}{scales} {}", ContactChange::classify(contacts, after, change).name())
    }
}

/// Derivatives that are not known, because what sticks keeps something of the way that a parameter changes in an unknown way.
pub(crate) fn missing<S: Skin>(
    skin: &S,
    spots: &[MeasuredPoint<S>],
    parameters: usize,
) -> Vec<Derivative> {
    let mut derivatives = Vec::new();
    for MeasuredPoint { place, quantities } in spots {
        for (quantity, place) in quantities.iter().zip(std::iter::repeat(place)) {
            let value = place.as_ref().map_or(0.0, |place| quantity.at(skin, place));
            let kink = "something sticks where something else changes, too";
            derivatives.extend((0..parameters).map(|parameter| Derivative {
                measure: quantity.measure,
                parameter,
                value,
                left: None,
                right: None,
                kink: Some(kink.to_owned()),
            }));
        }
    }
    derivatives
}

impl<S: Skin> MeasuredQuantity<S> {
    /// The value at a place.
    pub(crate) fn at(&self, system: &S, place: &AnchoredPoint<S::Mode>) -> f64 {
        self.value_at(system, place).0
    }

    /// The value at a place, and the numbers of those of several that may be the extreme one beside it.
    fn value_at(&self, system: &S, place: &AnchoredPoint<S::Mode>) -> (f64, Vec<usize>) {
        let count = self.extreme.map_or(1, |_| system.contacts().scales.len());
        let value = |number| (self.value)(system, &place.state, &place.direction, number);
        let values: Vec<f64> = (0..count).map(value).collect();
        let extreme = values.iter().copied().reduce(|one, other| self.outer(one, other));
        // The extreme one of none is no number, and what is not finite is left out as a derivative.
        let extreme = extreme.unwrap_or(f64::NAN);
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        // Beside the place only these are evaluated again: the others are too far to take over.
        let is_near = |number: &usize| (values[*number] - extreme).abs() <= NEAR * size;
        (extreme, (0..count).filter(is_near).collect())
    }

    /// The one of two values that counts; a number, if one is none.
    fn outer(&self, one: f64, other: f64) -> f64 {
        self.extreme.map_or(one, |outer| outer(one, other))
    }

    /// The derivatives on both sides of a parameter, as far as they are known.
    fn rates(
        &self,
        neighbours: &Neighbours<S>,
        sides: &Sides<S::Mode>,
        contenders: &[usize],
    ) -> [Option<f64>; 2] {
        // What depends on the direction of the path jumps where a contact changes, and the place of a maximum with it.
        let jumps = self.turns && sides.change().is_some();
        let left = self.rate(neighbours, &sides.left, 0, contenders);
        let right = match &sides.right {
            // With one contender and one motion both sides have the same rate.
            None if contenders.len() == 1 => left,
            right => self.rate(neighbours, right.as_ref().unwrap_or(&sides.left), 1, contenders),
        };
        [left, right].map(|rate| rate.filter(|rate| rate.is_finite() && !jumps))
    }

    /// The derivative on one side, of the one of the contenders that is the extreme one there.
    fn rate(
        &self,
        neighbours: &Neighbours<S>,
        motion: &SideMotion<S::Mode>,
        side: usize,
        contenders: &[usize],
    ) -> Option<f64> {
        let moved = motion.moved.as_ref()?;
        let systems = [&neighbours.below, &neighbours.above];
        let value = |side: usize, number: usize| {
            let Moved { state, direction } = &moved[side];
            (self.value)(systems[side], state, direction, number)
        };
        let on_side = contenders.iter().map(|&number| (number, value(side, number)));
        let (number, here) = on_side.reduce(|one, other| {
            // `min` and `max` pass over what is no number, so that such a contender never counts.
            let counts = self.outer(one.1, other.1).total_cmp(&other.1).is_eq();
            if counts { other } else { one }
        })?;
        // The same contender counts on both sides: another one may be the extreme one there, and
        // the difference of the two would be the derivative of neither.
        let there = value(1 - side, number);
        let rise = if side == 1 { here - there } else { there - here };
        Some(rise / (2.0 * neighbours.step))
    }
}

//! Derivatives of the measures of a path with respect to parameters.
//!
//! A measure is a function of the equilibrium at one point of the path: the end, the first contact,
//! a maximum. That point moves with a parameter by (D2) at a fixed active set, and the measure with
//! it; only explicit functions are differenced. If a contact changes or another scale becomes the
//! extreme one within the difference step, the measure has a kink: both sides are then solved
//! separately, each with its own active set.

mod curve;
mod measured_points;

use solver::{AnchoredPoint, Change, Linearisation, MovedPoint, Neighbours, Settings};

use crate::ContactChange;
use crate::contacts::SkinState;
use crate::record::Skin;

pub use curve::CurvePoint;
pub(crate) use curve::{Curve, curve_point};
pub(crate) use measured_points::{end, first_contact, is_held, rest, summit, turn, vanished};

/// Derivative of a measure with respect to a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivative {
    /// Name of the measure, as in the tables.
    pub measure: &'static str,
    /// Index of the parameter among the variations.
    pub parameter: usize,
    /// Value of the measure.
    pub value: f64,
    /// Derivative for a decreasing parameter; `None` if it does not exist.
    pub left: Option<f64>,
    /// Derivative for an increasing parameter.
    ///
    /// It differs from the left one only at a kink.
    pub right: Option<f64>,
    /// Cause of a kink; `None` where the measure is smooth.
    pub kink: Option<String>,
}

impl Derivative {
    /// Combines the one-sided derivatives of a measure with this `value`.
    ///
    /// They are differences over twice the `step`. Sides that agree up to round-off become one
    /// derivative.
    pub(crate) fn sided(
        (measure, parameter): (&'static str, usize),
        [left, right]: [Option<f64>; 2],
        value: f64,
        step: f64,
        kink: impl FnOnce() -> String,
    ) -> Self {
        let smooth = left.zip(right).is_some_and(|(left, right)| {
            // Dividing by the step magnifies the round-off of the measure.
            let round_off = ROUND_OFF * value.abs() / step;
            (left - right).abs() <= SMOOTH * left.abs().max(right.abs()) + round_off
        });
        let (right, kink) = (if smooth { left } else { right }, (!smooth).then(kink));
        Self { measure, parameter, value, left, right, kink }
    }
}

/// A quantity of an equilibrium; optionally the extreme one of several values.
pub(crate) struct MeasuredQuantity<S: Skin> {
    pub(crate) measure: &'static str,
    pub(crate) value: ValueOf<S>,
    /// For an extreme value over all scales: selects the extreme of two values.
    pub(crate) extreme: Option<fn(f64, f64) -> f64>,
    /// True if the value depends on the path direction.
    pub(crate) turns: bool,
}

/// Value from system, state, path direction, and index among several values.
pub(crate) type ValueOf<S> = fn(&S, &SkinState, &[f64], usize) -> f64;

/// Defines a single-valued quantity that does not depend on the path direction.
pub(crate) fn quantity<S: Skin>(measure: &'static str, value: ValueOf<S>) -> MeasuredQuantity<S> {
    MeasuredQuantity { measure, value, extreme: None, turns: false }
}

/// Quantities measured at one point of a path.
pub(crate) struct MeasuredPoint<S: Skin> {
    /// The point; `None` if unknown.
    pub(crate) point: Option<AnchoredPoint<S::Mode>>,
    pub(crate) quantities: Vec<MeasuredQuantity<S>>,
}

impl<S: Skin> MeasuredPoint<S> {
    pub(crate) fn new(
        point: Option<AnchoredPoint<S::Mode>>,
        quantities: impl Into<Vec<MeasuredQuantity<S>>>,
    ) -> Self {
        Self { point, quantities: quantities.into() }
    }
}

/// Relative difference of one-sided derivatives below which a measure is smooth.
const SMOOTH: f64 = 1e-9;

/// Relative distance to the extreme value at which other values may become extreme.
///
/// Beyond it they cannot within a difference step of a few millionths.
const NEAR: f64 = 1e-3;

/// Relative round-off of a measure.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Maximum number of successive contact changes within a difference step.
const MOST_CHANGES: usize = 8;

/// Differentiates all quantities with respect to the parameter of each variation.
///
/// `settings` are the solver settings of the path. Quantities at unknown points get no derivatives.
pub(crate) fn derivatives<S: Skin>(
    system: &S,
    spots: Vec<MeasuredPoint<S>>,
    variations: &[Neighbours<S>],
    settings: &Settings,
) -> Vec<Derivative> {
    let mut derivatives = Vec::new();
    // One factorisation serves all quantities at a point.
    for MeasuredPoint { point, quantities } in merged(spots) {
        let here = point.and_then(|point| Linearisation::new(system, point).ok());
        // A singular tangent has no unique direction, so there are no derivatives here.
        let Some(here) = here else { continue };
        let turns = quantities.iter().any(|quantity| quantity.turns);
        let mut linearised = Linearised { system, settings, here, turns };
        // Compute the motion of the point once per parameter for all quantities.
        let sides: Vec<_> = variations.iter().map(|v| linearised.sides(v)).collect();
        for quantity in &quantities {
            let (value, contenders) = quantity.value_at(system, linearised.here.point());
            derivatives.extend(sides.iter().zip(variations).enumerate().map(
                |(parameter, (sides, variation))| {
                    let rates = quantity.rates(variation, sides, &contenders);
                    let of = (quantity.measure, parameter);
                    Derivative::sided(of, rates, value, variation.step, || {
                        sides.change().unwrap_or("another scale has the extreme value").to_owned()
                    })
                },
            ));
        }
    }
    derivatives
}

/// Merges measured points at the same location.
fn merged<S: Skin>(spots: Vec<MeasuredPoint<S>>) -> Vec<MeasuredPoint<S>> {
    let mut merged: Vec<MeasuredPoint<S>> = Vec::new();
    for spot in spots {
        match merged.iter_mut().find(|other| {
            match (&other.point, &spot.point) {
                // The same state moves differently under another anchor.
                (Some(one), Some(other)) => one.state == other.state && one.anchor == other.anchor,
                _ => false,
            }
        }) {
            Some(there) => there.quantities.extend(spot.quantities),
            None => merged.push(spot),
        }
    }
    merged
}

/// A measured point with a factorised tangent.
struct Linearised<'a, S: Skin> {
    system: &'a S,
    settings: &'a Settings,
    here: Linearisation<S::Mode>,
    turns: bool,
}

/// Motion of a point on both sides of a parameter value.
struct Sides<M> {
    left: SideMotion<M>,
    /// `None` if both sides have the same motion.
    right: Option<SideMotion<M>>,
}

impl<M> Sides<M> {
    /// Returns the contact change on either side, if any.
    fn change(&self) -> Option<&str> {
        let right = self.right.as_ref().and_then(|right| right.change.as_deref());
        right.or(self.left.change.as_deref())
    }
}

/// Motion of a point on one side of a parameter value.
struct SideMotion<M> {
    /// The point for the smaller and the larger parameter.
    ///
    /// `None` if this side has no equilibrium.
    moved: Option<[MovedPoint<M>; 2]>,
    /// The contact change on this side.
    change: Option<String>,
}

impl<S: Skin> Linearised<'_, S> {
    /// Computes the motion of the point on both sides of a parameter value.
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

    /// Computes the motion on one side; `violated` is the first contact to change.
    fn side(
        &self,
        neighbours: &Neighbours<S>,
        side: usize,
        mut moved: [MovedPoint<S::Mode>; 2],
        mut violated: Option<Change>,
    ) -> SideMotion<S::Mode> {
        let (mut here, mut name) = (self.here.clone(), None);
        let at_side = [&neighbours.below, &neighbours.above][side];
        for _ in 0..MOST_CHANGES {
            let Some(change) = violated else {
                return SideMotion { moved: Some(moved), change: name };
            };
            let next = here.beyond(self.system, change, self.settings);
            let after = next.as_ref().map_or(&here.point().state, |next| &next.point().state);
            // The first change names the kink; later ones follow from it.
            name.get_or_insert_with(|| self.name(&here.point().state, after, change));
            let Some(next) = next else { break };
            here = next;
            moved = here.moved(self.system, neighbours, self.turns);
            violated = here.violated(at_side, &moved[side]);
        }
        // No equilibrium exists after the changes, so there is no derivative on this side.
        SideMotion { moved: None, change: name }
    }

    /// Describes the change of a contact.
    fn name(&self, before: &SkinState, after: &SkinState, change: Change) -> String {
        if change.constraint >= self.system.contacts().forces.len() {
            return "the contact of the needle changes".to_owned();
        }
        let contacts = self.system.contacts();
        let edge = [after, before]
            .into_iter()
            .find_map(|state| contacts.corner_edge(&state.mode, change.constraint))
            .map_or("contact", |edge| edge.name());
        let [left_index, right_index] = contacts.scales_of(change.constraint);
        let scales = match (self.system.number(left_index), self.system.number(right_index)) {
            // Neighbours are named by the left scale; distant scales need both numbers.
            (Some(left), _) if right_index == left_index + 1 => format!(" right of scale {left}"),
            (Some(left), Some(right)) => format!(" of scales {left} and {right}"),
            _ => String::new(),
        };
        format!("{edge}{scales} {}", ContactChange::classify(contacts, after, change).name())
    }
}

/// Lists unknown derivatives.
///
/// They depend on a history variable with an unknown dependence on the parameter.
pub(crate) fn missing<S: Skin>(
    skin: &S,
    spots: &[MeasuredPoint<S>],
    parameters: usize,
) -> Vec<Derivative> {
    let mut derivatives = Vec::new();
    for MeasuredPoint { point, quantities } in spots {
        for (quantity, point) in quantities.iter().zip(std::iter::repeat(point)) {
            let value = point.as_ref().map_or(0.0, |point| quantity.at(skin, point));
            let kink = "no derivative: a stick position depends on another event";
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
    /// Evaluates the quantity at a point.
    pub(crate) fn at(&self, system: &S, point: &AnchoredPoint<S::Mode>) -> f64 {
        self.value_at(system, point).0
    }

    /// Evaluates the quantity, and lists the indices that may become extreme nearby.
    fn value_at(&self, system: &S, point: &AnchoredPoint<S::Mode>) -> (f64, Vec<usize>) {
        let count = self.extreme.map_or(1, |_| system.contacts().scales.len());
        let values: Vec<f64> = (0..count)
            .map(|number| (self.value)(system, &point.state, &point.direction, number))
            .collect();
        let extreme = values.iter().copied().reduce(|one, other| self.outer(one, other));
        // The extreme of no values is NaN, and non-finite derivatives are dropped.
        let extreme = extreme.unwrap_or(f64::NAN);
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        // Only contenders are evaluated again; the other values are too far from the extreme one.
        (
            extreme,
            (0..count).filter(|number| (values[*number] - extreme).abs() <= NEAR * size).collect(),
        )
    }

    /// Selects the extreme of two values; ignores NaN if the other is a number.
    fn outer(&self, one: f64, other: f64) -> f64 {
        self.extreme.map_or(one, |outer| outer(one, other))
    }

    /// Computes the derivatives on both sides as far as they exist.
    fn rates(
        &self,
        neighbours: &Neighbours<S>,
        sides: &Sides<S::Mode>,
        contenders: &[usize],
    ) -> [Option<f64>; 2] {
        // A value that depends on the path direction jumps where a contact changes, and so does the
        // location of a maximum.
        let jumps = self.turns && sides.change().is_some();
        let left = self.rate(neighbours, &sides.left, 0, contenders);
        let right = match &sides.right {
            // With a single contender and motion both sides have the same rate.
            None if contenders.len() == 1 => left,
            right => self.rate(neighbours, right.as_ref().unwrap_or(&sides.left), 1, contenders),
        };
        [left, right].map(|rate| rate.filter(|rate| rate.is_finite() && !jumps))
    }

    /// Computes the derivative on one side for the contender that is extreme there.
    fn rate(
        &self,
        neighbours: &Neighbours<S>,
        motion: &SideMotion<S::Mode>,
        side: usize,
        contenders: &[usize],
    ) -> Option<f64> {
        let moved = motion.moved.as_ref()?;
        let sides = [(&neighbours.below, &moved[0]), (&neighbours.above, &moved[1])];
        let (system, MovedPoint { state, direction }) = sides[side];
        let on_side = contenders
            .iter()
            .map(|&number| (number, (self.value)(system, state, direction, number)));
        let (number, here) = on_side.reduce(|one, other| {
            // `min` and `max` ignore NaN, so a contender with NaN never counts.
            let counts = self.outer(one.1, other.1).total_cmp(&other.1).is_eq();
            if counts { other } else { one }
        })?;
        // Use the same contender on both sides: another one may be extreme there, and the
        // difference of the two would be the derivative of neither.
        let (system, MovedPoint { state, direction }) = sides[1 - side];
        let there = (self.value)(system, state, direction, number);
        let rise = if side == 1 { here - there } else { there - here };
        Some(rise / (2.0 * neighbours.step))
    }
}

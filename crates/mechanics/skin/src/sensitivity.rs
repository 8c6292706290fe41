//! Derivatives of the measures of a path with respect to parameters.
//!
//! A measure is a function of the equilibrium at one point of the path, such as the end, the first
//! contact or a maximum. If a parameter changes, this point moves by (D2) at a fixed active set.
//! The derivative of the measure is a difference of explicit functions at the moved points. If
//! within the difference step a contact changes, or another scale attains the extreme value, the
//! measure has a kink. Then each side is computed separately, with its own active set or scale.

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
    /// Name of the measure: its column in the tables of results.
    pub measure: &'static str,
    /// Index of the parameter among the variations.
    pub parameter: usize,
    /// Value of the measure.
    pub value: f64,
    /// One-sided derivative towards smaller parameters; `None` if it does not exist.
    pub left: Option<f64>,
    /// One-sided derivative towards larger parameters; `None` if it does not exist.
    ///
    /// It differs from `left` only at a kink.
    pub right: Option<f64>,
    /// Cause of a kink; `None` where the measure is smooth.
    pub kink: Option<String>,
}

impl Derivative {
    /// Combines the one-sided derivatives of a measure.
    ///
    /// `value` is the value of the measure, and `step` half the difference of the parameter in the
    /// difference quotients. If both sides agree up to round-off, the measure is smooth and both
    /// fields get the left derivative.
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

/// A quantity of an equilibrium: a single value, or the extreme value over all scales.
pub(crate) struct MeasuredQuantity<S: Skin> {
    pub(crate) measure: &'static str,
    pub(crate) value: ValueOf<S>,
    /// For an extreme value over all scales: selects the extreme of two values.
    pub(crate) extreme: Option<fn(f64, f64) -> f64>,
    /// True if the value depends on the path direction.
    pub(crate) depends_on_direction: bool,
}

/// Function that evaluates a quantity.
///
/// Its arguments are the system, the state, the path direction, and the index of the scale if the
/// quantity is an extreme value over all scales.
pub(crate) type ValueOf<S> = fn(&S, &SkinState, &[f64], usize) -> f64;

/// Defines a single-valued quantity that does not depend on the path direction.
pub(crate) fn quantity<S: Skin>(measure: &'static str, value: ValueOf<S>) -> MeasuredQuantity<S> {
    MeasuredQuantity { measure, value, extreme: None, depends_on_direction: false }
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

/// Relative difference of the one-sided derivatives below which a measure counts as smooth.
const SMOOTH: f64 = 1e-9;

/// Relative difference from the extreme value up to which a scale is a candidate for this value.
///
/// Scales with a larger difference cannot attain the extreme value within a difference step of a
/// few millionths.
const NEAR: f64 = 1e-3;

/// Relative round-off of a measure.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Maximum number of contact changes within one difference step.
const MOST_CHANGES: usize = 8;

/// Differentiates all quantities with respect to the parameter of each variation.
///
/// `settings` are the solver settings of the path. Quantities at unknown points, and at points with
/// a singular tangent, get no entry.
pub(crate) fn derivatives<S: Skin>(
    system: &S,
    points: Vec<MeasuredPoint<S>>,
    variations: &[Neighbours<S>],
    settings: &Settings,
) -> Vec<Derivative> {
    let mut derivatives = Vec::new();
    // One factorisation serves all quantities at a point.
    for MeasuredPoint { point, quantities } in merged(points) {
        let here = point.and_then(|point| Linearisation::new(system, point).ok());
        // A singular tangent does not determine the direction of the path, so no derivative exists.
        let Some(here) = here else { continue };
        let depends_on_direction = quantities.iter().any(|quantity| quantity.depends_on_direction);
        let mut linearised = Linearised { system, settings, here, depends_on_direction };
        // Compute the motion of the point once for each parameter; all quantities share it.
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

/// Merges measured points with equal state and anchor, so that they share one factorisation.
fn merged<S: Skin>(points: Vec<MeasuredPoint<S>>) -> Vec<MeasuredPoint<S>> {
    let mut merged: Vec<MeasuredPoint<S>> = Vec::new();
    for measured in points {
        match merged.iter_mut().find(|other| {
            match (&other.point, &measured.point) {
                // The motion of a point depends on its anchor, so state and anchor must agree.
                (Some(one), Some(other)) => one.state == other.state && one.anchor == other.anchor,
                _ => false,
            }
        }) {
            Some(there) => there.quantities.extend(measured.quantities),
            None => merged.push(measured),
        }
    }
    merged
}

/// A measured point with a factorised tangent.
struct Linearised<'a, S: Skin> {
    system: &'a S,
    settings: &'a Settings,
    here: Linearisation<S::Mode>,
    depends_on_direction: bool,
}

/// Motion of a point for a decreasing (`left`) and an increasing (`right`) parameter.
struct Sides<M> {
    left: SideMotion<M>,
    /// `None` if the motion is the same on both sides.
    right: Option<SideMotion<M>>,
}

impl<M> Sides<M> {
    /// Returns the name of the contact change on the right side, or else on the left side, if any.
    fn change(&self) -> Option<&str> {
        let right = self.right.as_ref().and_then(|right| right.change.as_deref());
        right.or(self.left.change.as_deref())
    }
}

/// Motion of a point with the active set of one side of a parameter value.
struct SideMotion<M> {
    /// Predicted points for the smaller and for the larger parameter.
    ///
    /// `None` if no equilibrium exists on this side.
    moved: Option<[MovedPoint<M>; 2]>,
    /// Name of the first contact change on this side; `None` without a change.
    change: Option<String>,
}

impl<S: Skin> Linearised<'_, S> {
    /// Computes the motion of the point on both sides of a parameter value.
    fn sides(&mut self, neighbours: &Neighbours<S>) -> Sides<S::Mode> {
        let moved = self.here.moved(self.system, neighbours, self.depends_on_direction);
        let on_left = self.here.violated(&neighbours.below, &moved[0]);
        let on_right = self.here.violated(&neighbours.above, &moved[1]);
        // No contact changes within the step, so both sides have the same motion.
        if (on_left, on_right) == (None, None) {
            return Sides { left: SideMotion { moved: Some(moved), change: None }, right: None };
        }
        let right = Some(self.side(neighbours, 1, moved.clone(), on_right));
        Sides { left: self.side(neighbours, 0, moved, on_left), right }
    }

    /// Computes the motion on one side: 0 for a decreasing, 1 for an increasing parameter.
    ///
    /// `moved` are the points predicted with the active set of the measured point, and `violated`
    /// is the constraint that changes first on this side.
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
            // Name the kink after the first change; later changes are consequences of it.
            name.get_or_insert_with(|| self.name(&here.point().state, after, change));
            let Some(next) = next else { break };
            here = next;
            moved = here.moved(self.system, neighbours, self.depends_on_direction);
            violated = here.violated(at_side, &moved[side]);
        }
        // No equilibrium exists after the changes, so there is no derivative on this side.
        SideMotion { moved: None, change: name }
    }

    /// Names the change of a contact, e.g. for the table of derivatives.
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
            // A contact between neighbours is identified by the left scale, a contact between
            // distant scales by both scales.
            (Some(left), _) if right_index == left_index + 1 => format!(" right of scale {left}"),
            (Some(left), Some(right)) => format!(" of scales {left} and {right}"),
            _ => String::new(),
        };
        format!("{edge}{scales} {}", ContactChange::classify(contacts, after, change).name())
    }
}

/// Returns entries with unknown derivatives for all quantities at `points` and all parameters.
///
/// These quantities depend on a stick position with unknown derivatives.
pub(crate) fn missing<S: Skin>(
    skin: &S,
    points: &[MeasuredPoint<S>],
    parameters: usize,
) -> Vec<Derivative> {
    let mut derivatives = Vec::new();
    for MeasuredPoint { point, quantities } in points {
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

    /// Evaluates the quantity, and lists the scales that may attain the extreme value nearby.
    ///
    /// A quantity with a single value has the list `[0]`.
    fn value_at(&self, system: &S, point: &AnchoredPoint<S::Mode>) -> (f64, Vec<usize>) {
        let count = self.extreme.map_or(1, |_| system.contacts().scales.len());
        let values: Vec<f64> = (0..count)
            .map(|number| (self.value)(system, &point.state, &point.direction, number))
            .collect();
        let extreme = values.iter().copied().reduce(|one, other| self.outer(one, other));
        // Without any scale the value is NaN; derivatives that are not finite are dropped later.
        let extreme = extreme.unwrap_or(f64::NAN);
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        // Derivatives are computed only for scales with a value near the extreme value.
        (
            extreme,
            (0..count).filter(|number| (values[*number] - extreme).abs() <= NEAR * size).collect(),
        )
    }

    /// Returns the extreme of two values; ignores NaN if the other value is a number.
    fn outer(&self, one: f64, other: f64) -> f64 {
        self.extreme.map_or(one, |outer| outer(one, other))
    }

    /// Computes the left and right derivatives; `None` for a side without a derivative.
    ///
    /// `contenders` lists the scales that may attain the extreme value.
    fn rates(
        &self,
        neighbours: &Neighbours<S>,
        sides: &Sides<S::Mode>,
        contenders: &[usize],
    ) -> [Option<f64>; 2] {
        // Where a contact changes, the path direction jumps. Values that depend on this direction
        // jump with it and have no derivative.
        let jumps = self.depends_on_direction && sides.change().is_some();
        let left = self.rate(neighbours, &sides.left, 0, contenders);
        let right = match &sides.right {
            // Both sides have the same motion and the same scale, hence the same rate.
            None if contenders.len() == 1 => left,
            right => self.rate(neighbours, right.as_ref().unwrap_or(&sides.left), 1, contenders),
        };
        [left, right].map(|rate| rate.filter(|rate| rate.is_finite() && !jumps))
    }

    /// Computes the derivative on one side: 0 for a decreasing, 1 for an increasing parameter.
    ///
    /// Of the `contenders` it uses the scale that attains the extreme value on this side.
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
            // `outer` ignores NaN, so a contender with the value NaN is never selected.
            let counts = self.outer(one.1, other.1).total_cmp(&other.1).is_eq();
            if counts { other } else { one }
        })?;
        // Difference the value of one and the same contender, even if another contender attains
        // the extreme value on the other side.
        let (system, MovedPoint { state, direction }) = sides[1 - side];
        let there = (self.value)(system, state, direction, number);
        let rise = if side == 1 { here - there } else { there - here };
        Some(rise / (2.0 * neighbours.step))
    }
}

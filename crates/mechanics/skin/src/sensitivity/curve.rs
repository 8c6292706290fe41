//! Points of a curve, such as the force as a function of the displacement, and their derivatives.

use solver::{AnchoredPoint, Equilibrium, Neighbours, PathAnchor, Settings};

use super::{MeasuredPoint, ValueOf, derivatives, quantity};
use crate::contacts::SkinPoint;
use crate::record::Skin;

/// A point of a curve `y(x)` at a chosen `x`.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePoint {
    /// Value `y` of the curve.
    pub value: f64,
    /// Slope `dy/dx` along the curve.
    pub slope: f64,
    /// Derivative `∂y/∂q` at constant `x` for each parameter `q`; `None` if unknown.
    ///
    /// At a kink it is the mean of both one-sided derivatives.
    pub rates: Vec<Option<f64>>,
}

/// A curve `y(x)` along a path: the functions that evaluate `x` and `y` at a state.
pub(crate) type Curve<S> = [ValueOf<S>; 2];

/// Half-width of the central difference for the slope of a curve, as a multiple of the direction.
const ALONG: f64 = 1e-5;

/// Evaluates a curve at an equilibrium.
///
/// The result holds one derivative for each parameter in `variations`.
pub(crate) fn curve_point<S: Skin>(
    system: &S,
    point: &SkinPoint,
    variations: &[Neighbours<S>],
    settings: &Settings,
    curve: Curve<S>,
) -> CurvePoint {
    let Equilibrium { state, arriving, .. } = point;
    let [rise_x, rise_y] = curve.map(|f| {
        // At a kink of the path the point belongs to the incoming segment.
        let [before, after] =
            [-ALONG, ALONG].map(|by| f(system, &state.moved(by, arriving), arriving, 0));
        after - before
    });
    let slope = rise_y / rise_x;
    // Keep the point in a section through the path, so that it moves little even where the curve
    // reverses in `x`. The slope of the curve then corrects the change of `y` to constant `x`.
    let anchored = AnchoredPoint::arriving(point, PathAnchor::Still);
    let point =
        MeasuredPoint::new(Some(anchored), [quantity("x", curve[0]), quantity("y", curve[1])]);
    let derivatives = derivatives(system, vec![point], variations, settings);
    // At a singular tangent `derivatives` is empty, and all rates remain `None`.
    let mut rates = vec![None; variations.len()];
    let (of_x, of_y) = derivatives.split_at(derivatives.len() / 2);
    for (rate, (x, y)) in rates.iter_mut().zip(of_x.iter().zip(of_y)) {
        let sides = [(x.left, y.left), (x.right, y.right)]
            .map(|(x, y)| Some(y? - slope * x?).filter(|rate| rate.is_finite()));
        *rate = match sides {
            [Some(left), Some(right)] => Some(0.5 * (left + right)),
            // If one side has no equilibrium, use the rate of the other side for both sides.
            [left, right] => left.or(right),
        };
    }
    CurvePoint { value: (curve[1])(system, state, arriving, 0), slope, rates }
}

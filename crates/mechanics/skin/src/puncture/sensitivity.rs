//! Derivatives of the measures of a puncture.

use geometry::OutOfRange;
use solver::{AnchoredPoint, Neighbours, Path, PathAnchor};
use substrate::RowStiffness;

use super::needle::{HistoryVariable, anchors, event_before, history, with};
use super::observers::PathObservers;
use super::snapshot::farther;
use super::surface_fold::{Fold, FoldObserver};
use super::system::{Chain, DEPTH_MARK, DEPTH_RATE, LOAD_RATE, RowLayout};
use super::{At, Followed, PerturbedScale, Problem, Puncture, PunctureParameters, Rows};
use crate::contacts::{SkinMode, SkinPoint, SkinState};
use crate::record::{PathFunction, Skin};
use crate::sensitivity::{
    self, Curve, CurvePoint, Derivative, MeasuredPoint, MeasuredQuantity, ValueOf, curve_point,
    derivatives, end, first_contact, missing, quantity, rest,
};
use crate::{Common, Design, Status};

/// Everything that a puncture depends on.
#[derive(Clone, Debug)]
pub struct PunctureInput {
    /// The design.
    pub design: Design,
    /// The stiffness of the substrate under its row.
    pub stiffness: RowStiffness,
    /// Contact law and solver settings.
    pub common: Common,
    /// The other parameters.
    pub parameters: PunctureParameters,
    /// The scale that differs from all others, if one does.
    pub odd: Option<PerturbedScale>,
}

/// Functions whose largest values are measures besides the stiffness.
const FOLLOWED: [PathFunction<Chain>; 1] = [|chain, state, _| chain.force(state)];
const LOAD: usize = 0;

/// The force at the critical tilt, of which the weakest place has one of its own.
pub(super) const CRITICAL_FORCE: &str = "critical_force";

/// Follows a puncture as [`solve`](super::solve) does, and returns the derivatives of its measures with respect to the parameter
/// of each variation as well. There are none where the path did not come to its end.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn differentiate(
    input: &PunctureInput,
    variations: &[Neighbours<PunctureInput>],
) -> Result<(Puncture, Vec<Derivative>), OutOfRange> {
    let PunctureInput { design, stiffness, common, parameters, .. } = input;
    let rows = Rows::Even(design.row()?);
    let problem = Problem::new(rows, design, stiffness.clone(), common, parameters)?;
    let (followed, mut derivatives) = problem.differentiated(variations)?;
    let puncture = followed.puncture(parameters.unload).with_places(problem.load_positions()?);
    derivatives.extend(problem.at_weakest(&puncture.places, variations)?);
    Ok((puncture, derivatives))
}

/// The force over the depth of the needle.
const FORCE_OVER_DEPTH: Curve<Chain> =
    [|chain, state, _, _| chain.depth(&state.z), |chain, state, _, _| chain.force(state)];

/// Follows a puncture, beyond the critical tilt if need be, and returns its force at each of the `displacements` where the needle
/// first comes there, with the derivatives with respect to the parameter of each variation; `None` where the path does not come.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn force_curve(
    input: &PunctureInput,
    variations: &[Neighbours<PunctureInput>],
    displacements: &[f64],
) -> Result<Vec<Option<CurvePoint>>, OutOfRange> {
    let at: Vec<_> = displacements.iter().copied().map(At::Displacement).collect();
    let mut tilt = input.parameters.critical_tilt_deg;
    loop {
        let PunctureInput { design, stiffness, common, parameters, .. } = input;
        let parameters = PunctureParameters { critical_tilt_deg: tilt, ..*parameters };
        let rows = Rows::Even(design.row()?);
        let problem = Problem::new(rows, design, stiffness.clone(), common, &parameters)?;
        let mut followed = problem.follow(&[], &at)?;
        let is_short = followed.watch.requested.points.iter().any(Option::is_none);
        if farther(&mut tilt, followed.status, is_short) {
            continue;
        }
        // The critical tilt scales the control, by which neighbours are to be measured alike.
        let as_far = |input: &PunctureInput| {
            let parameters = PunctureParameters { critical_tilt_deg: tilt, ..input.parameters };
            Ok::<_, OutOfRange>(PunctureInput { parameters, ..input.clone() })
        };
        return problem.curve(&mut followed, &Neighbours::map_all(variations, as_far)?);
    }
}

impl Problem<'_> {
    /// The path, and the derivatives of its measures if it comes to its end.
    pub(super) fn differentiated(
        &self,
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<(Followed, Vec<Derivative>), OutOfRange> {
        let mut followed = self.follow(&FOLLOWED, &[])?;
        let derivatives = match followed.status {
            Status::Complete => self.derivatives(&mut followed, variations)?,
            _ => Vec::new(),
        };
        Ok((followed, derivatives))
    }

    /// The points of the curve at the places that were looked for.
    fn curve(
        &self,
        followed: &mut Followed,
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<Vec<Option<CurvePoint>>, OutOfRange> {
        let Followed { watch, path, .. } = followed;
        // Neighbours are as long as the row has become: their unknowns are those of the path.
        let layout = path.system().layout;
        let chain = |input: &PunctureInput| input.chain(layout);
        let variations = Neighbours::map_all(variations, chain)?;
        let anchors = anchors(path, &watch.history.segments, &variations);
        let system = path.system();
        let point = |found: &Option<SkinPoint>| {
            let point = found.as_ref()?;
            // With something kept of the way, neighbours come to these places on ways of their own.
            let varied = with(&anchors, &point.state, &variations);
            let known = varied.as_deref().unwrap_or_default();
            let mut on_curve = curve_point(system, point, known, &self.settings, FORCE_OVER_DEPTH);
            on_curve.rates.resize(variations.len(), None);
            Some(on_curve)
        };
        Ok(watch.requested.points.iter().map(point).collect())
    }

    fn derivatives(
        &self,
        followed: &mut Followed,
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<Vec<Derivative>, OutOfRange> {
        let Followed { watch, path, .. } = followed;
        let layout = path.system().layout;
        let chain = |input: &PunctureInput| input.chain(layout);
        let variations = Neighbours::map_all(variations, chain)?;
        let anchors = anchors(path, &watch.history.segments, &variations);
        let mut found = Vec::new();
        // Neighbours are made once for all places that keep the same of the way.
        for spots in group_by_history(self.measured_points(watch, path)) {
            let state = spots.iter().find_map(|spot| Some(&spot.place.as_ref()?.state));
            // Nothing can be said of a place that is not known.
            let Some(state) = state else { continue };
            let system = path.system();
            // Neighbours come to these places on ways of their own.
            found.extend(match with(&anchors, state, &variations) {
                Some(varied) => derivatives(system, spots, &varied, &self.settings),
                None => missing(system, &spots, variations.len()),
            });
        }
        Ok(found)
    }

    /// The places of the path at which measures are taken.
    fn measured_points(
        &self,
        watch: &PathObservers,
        path: &mut Path<Chain>,
    ) -> Vec<MeasuredPoint<Chain>> {
        let PathObservers { record, needle, passage, depth: marked, .. } = watch;
        let FoldObserver { folds, first } = &watch.folds;
        let settings = &self.settings;
        let stiffest = record.stiffness_summit(path);
        let stiffest = sensitivity::summit(stiffest, path, Chain::stiffness, settings);
        let highest = record.highest_point(LOAD);
        let highest = sensitivity::summit(highest.as_ref(), path, FOLLOWED[LOAD], settings);
        let passed = passage.passed.as_ref();
        let passed = passed.and_then(|[from, to]| event_before(path, [from, to]));
        let chain = path.system();
        let peak = highest.as_ref().map(|place| chain.extremum(place));
        // A place that is no event has nothing to hold it where a parameter moves it.
        let load_limit = needle.load_limit.as_ref().filter(|point| point.event.is_some());
        let load_limit = load_limit.and_then(|point| sensitivity::turn(chain, point, LOAD_RATE));
        let depth_limit = needle.depth_limit.as_ref();
        let depth_limit = depth_limit.and_then(|point| sensitivity::turn(chain, point, DEPTH_RATE));
        let touching = record.touching.as_ref().and_then(|point| first_contact(chain, point));
        let spot = |place, quantities| MeasuredPoint { place, quantities };
        let folded = first.as_ref().zip(folds.first());
        let folded = folded.map(|(point, fold)| chain.folded_at(point, fold));
        let deep = marked.points.iter().flatten().next();
        let deep = deep.map(|p| AnchoredPoint::arriving(p, PathAnchor::Marker(DEPTH_MARK)));
        let (mut end_quantities, fold_quantities) = at_end_and_fold(folded.is_some());
        // A path that ends before it is so deep has the force of its end as the measure.
        if !marked.points.is_empty() && deep.is_none() {
            end_quantities.push(force("force_at_depth"));
        }
        let mut passing =
            vec![force("passing_force"), depth("passing_displacement"), tilt("passing_tilt_deg")];
        if chain.needle.is_some() {
            // The shift is that where the needle first touches more than its face, or else that of the end.
            let left = if passage.passed.is_some() { &mut passing } else { &mut end_quantities };
            left.push(quantity("needle_shift", |chain, state, _, _| {
                chain.shift(state).unwrap_or(f64::NAN)
            }));
        }
        let mut at_rest = rest(chain);
        at_rest.state = chain.at_rest();
        vec![
            spot(Some(chain.end_of(end(path))), end_quantities),
            spot(folded, fold_quantities),
            spot(passed, passing),
            spot(deep, vec![force("force_at_depth")]),
            spot(highest, vec![force("peak_force")]),
            at_turn(peak, [depth("peak_displacement"), tilt("peak_tilt_deg")]),
            at_turn(load_limit, [force("load_stability_force")]),
            at_turn(depth_limit, [force("depth_stability_force")]),
            spot(touching, vec![depth("first_contact_displacement")]),
            spot(Some(at_rest), vec![stiffness("initial_stiffness")]),
            spot(stiffest, vec![stiffness("max_stiffness")]),
        ]
    }
}

impl PunctureInput {
    /// The system of a row of so many scales.
    fn chain(&self, layout: RowLayout) -> Result<Chain, OutOfRange> {
        let Self { design, stiffness, common, parameters, odd } = self;
        // The neighbour of an upright design leans to the left.
        let row = design.leaning_row()?;
        let rows = odd.map_or(Rows::Even(row), |odd| Rows::Odd(row, odd));
        // At the end of a range one neighbour lies beyond it.
        let problem = Problem::unchecked(rows, design, stiffness.clone(), common, parameters)?;
        problem.part(layout)
    }
}

/// The spots, together where the equations keep the same of the way to them.
fn group_by_history(spots: Vec<MeasuredPoint<Chain>>) -> Vec<Vec<MeasuredPoint<Chain>>> {
    let mut groups: Vec<(Vec<HistoryVariable>, Vec<MeasuredPoint<Chain>>)> = Vec::new();
    for spot in spots {
        let kept = spot.place.as_ref().map(|place| history(&place.state)).unwrap_or_default();
        match groups.iter_mut().find(|(other, _)| *other == kept) {
            Some((_, group)) => group.push(spot),
            None => groups.push((kept, vec![spot])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

impl Chain {
    /// The end of a path, held by what ended it: the tilt, or under a guided needle one of its constraints.
    fn end_of(&self, place: AnchoredPoint<SkinMode>) -> AnchoredPoint<SkinMode> {
        let ended = self.needle.as_ref().and_then(|n| n.ended_at(self, &place.state));
        AnchoredPoint { anchor: ended.map_or(place.anchor, PathAnchor::Guard), ..place }
    }

    /// The place of the largest load: held by that where nothing else holds it.
    fn extremum(&self, place: &AnchoredPoint<SkinMode>) -> AnchoredPoint<SkinMode> {
        let held = sensitivity::is_held(self, place);
        let anchor = if held { place.anchor } else { PathAnchor::Stationary(LOAD_RATE) };
        AnchoredPoint { anchor, ..place.clone() }
    }

    /// The equilibrium at which a gap vanishes.
    fn folded_at(&self, point: &SkinPoint, fold: &Fold) -> AnchoredPoint<SkinMode> {
        let pair = (fold.left_scale as isize + self.layout.left.cast_signed()).cast_unsigned();
        AnchoredPoint::arriving(point, PathAnchor::Marker(pair))
    }
}

/// Quantities at a place. Where load or depth turns back smoothly, the direction of the path tells the place.
fn at_turn<const N: usize>(
    place: Option<AnchoredPoint<SkinMode>>,
    quantities: [MeasuredQuantity<Chain>; N],
) -> MeasuredPoint<Chain> {
    let turns = place.as_ref().is_some_and(|p| matches!(p.anchor, PathAnchor::Stationary(_)));
    let quantities = quantities.into_iter();
    let quantities = quantities.map(|quantity| MeasuredQuantity { turns, ..quantity }).collect();
    MeasuredPoint { place, quantities }
}

/// The quantities at the critical tilt and at the first fold. The model can answer for the force at that of the two that comes first.
fn at_end_and_fold(folds: bool) -> (Vec<MeasuredQuantity<Chain>>, Vec<MeasuredQuantity<Chain>>) {
    let mut end = critical();
    let mut fold = vec![force("fold_force"), depth("fold_displacement"), tilt("fold_tilt_deg")];
    (if folds { &mut fold } else { &mut end }).push(force("sound_force"));
    (end, fold)
}

fn tilt(measure: &'static str) -> MeasuredQuantity<Chain> {
    quantity(measure, |chain, state, _, _| chain.angle_deg(state))
}

fn critical() -> Vec<MeasuredQuantity<Chain>> {
    // There is a gap for each scale, too: beyond the last one there are those that are not solved for, as one.
    let extreme = |measure, value: ValueOf<Chain>, outer: fn(f64, f64) -> f64| MeasuredQuantity {
        extreme: Some(outer),
        ..quantity(measure, value)
    };
    vec![
        force(CRITICAL_FORCE),
        depth("critical_displacement"),
        extreme("penetration", |chain, state, _, i| chain.base_depth(&state.z, i), f64::max),
        extreme("sink", |chain, state, _, i| -chain.displacement(&state.z, i)[1], f64::max),
        quantity("secant_stiffness", |chain, state, _, _| {
            chain.plane_modulus * chain.force(state) * chain.length / chain.depth(&state.z)
        }),
        extreme(
            "gap_stretch_min",
            |chain, state, _, i| stretch(chain, state, i, f64::min),
            f64::min,
        ),
        extreme(
            "gap_stretch_max",
            |chain, state, _, i| stretch(chain, state, i, f64::max),
            f64::max,
        ),
    ]
}

/// The stretch of a gap, or, beyond the last one, the outer of those that are not solved for; no number, if there are none.
fn stretch(chain: &Chain, state: &SkinState, gap: usize, outer: fn(f64, f64) -> f64) -> f64 {
    if gap < chain.layout.scales() - 1 {
        return chain.gap_stretch(state, gap);
    }
    chain.stretches_beyond(&state.z).into_iter().reduce(outer).unwrap_or(f64::NAN)
}

fn force(measure: &'static str) -> MeasuredQuantity<Chain> {
    quantity(measure, |chain, state, _, _| chain.force(state))
}

fn depth(measure: &'static str) -> MeasuredQuantity<Chain> {
    quantity(measure, |chain, state, _, _| chain.depth(&state.z))
}

fn stiffness(measure: &'static str) -> MeasuredQuantity<Chain> {
    let value = |chain: &Chain, state: &SkinState, direction: &[f64], _| {
        chain.plane_modulus * chain.stiffness(state, direction)
    };
    MeasuredQuantity { turns: true, ..quantity(measure, value) }
}

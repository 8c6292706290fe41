//! Derivatives of the measures of a puncture.

use geometry::OutOfRange;
use solver::{AnchoredPoint, Continuation, Neighbours, PathAnchor};
use substrate::RowStiffness;

use super::failure::{MAXIMA, TISSUE_PRESSURE};
use super::needle::{HistoryVariable, anchors, event_before, history, with};
use super::observers::PathObservers;
use super::row_layout::RowLayout;
use super::snapshot::raise_tilt;
use super::surface_fold::{Fold, FoldObserver};
use super::system::{Chain, DEPTH_MARK, DEPTH_RATE, FORCE_MARK, LOAD_RATE};
use super::{
    At, FailureMode, Followed, PerturbedScale, Problem, Puncture, PunctureParameters, Rows,
};
use crate::contacts::{SkinMode, SkinPoint, SkinState};
use crate::record::{PathFunction, Skin};
use crate::sensitivity::{
    self, Curve, CurvePoint, Derivative, MeasuredPoint, MeasuredQuantity, ValueOf, curve_point,
    derivatives, end, first_contact, missing, quantity, rest,
};
use crate::unloading::unloaded;
use crate::{Common, Design, PathDetail, Status};

/// Complete input of a puncture problem.
#[derive(Clone, Debug)]
pub struct PunctureInput {
    /// The design.
    pub design: Design,
    /// Stiffness of the substrate under the row.
    pub stiffness: RowStiffness,
    /// Contact law and solver settings.
    pub common: Common,
    /// All other parameters.
    pub parameters: PunctureParameters,
    /// One scale that deviates from the others, if any.
    pub perturbed: Option<PerturbedScale>,
}

/// Functions with a tracked maximum along the path, in addition to the stiffness.
const FOLLOWED: [PathFunction<Chain>; 1] = [|chain, state, _| chain.force(state)];

/// Index of the load in [`FOLLOWED`].
const LOAD: usize = 0;

/// Name of the measure of the force at the critical tilt.
pub(super) const CRITICAL_FORCE: &str = "critical_force";

/// Name of the measure of the force at the first failure.
const FAILURE_FORCE: &str = "failure_force";

/// Solves a puncture like [`solve`](super::solve), and differentiates its measures.
///
/// Each of the `variations` holds the input with a smaller and a larger value of one parameter. The
/// list of derivatives is empty if the path ended neither at its target nor at the limit of linear
/// bending.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn differentiate(
    input: &PunctureInput,
    variations: &[Neighbours<PunctureInput>],
) -> Result<(Puncture, Vec<Derivative>), OutOfRange> {
    let problem = Problem::of_input(input)?;
    let functions: &[_] = if input.common.detail == PathDetail::Critical { &[] } else { &FOLLOWED };
    let mut followed = problem.follow(functions, &[])?;
    let mut derivatives = problem.derivatives(&mut followed, variations)?;
    let puncture = problem.result(followed)?;
    let ends = puncture.end.as_ref();
    derivatives.extend(problem.at_weakest(&puncture, ends, variations, &derivatives)?);
    Ok((puncture, derivatives))
}

/// Coordinates of the curve of the force against the depth of the loaded point.
const FORCE_OVER_DEPTH: Curve<Chain> =
    [|chain, state, _, _| chain.depth(&state.z), |chain, state, _, _| chain.force(state)];

/// Computes the force at given `displacements`, and its derivatives for each variation.
///
/// Follows the path beyond the critical tilt if necessary. Each value belongs to the first point at
/// its displacement; `None` if the path does not reach this displacement.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn force_curve(
    input: &PunctureInput,
    variations: &[Neighbours<PunctureInput>],
    displacements: &[f64],
) -> Result<Vec<Option<CurvePoint>>, OutOfRange> {
    let at: Vec<_> = displacements.iter().copied().map(At::Displacement).collect();
    with_path(input, &at, |problem, mut followed| {
        // The critical tilt is the scale of the control parameter and may have been raised, so use
        // the same tilt for the perturbed inputs.
        let tilt = problem.parameters.critical_tilt_deg;
        let variations = Neighbours::map_all(variations, |input| {
            let parameters = PunctureParameters { critical_tilt_deg: tilt, ..input.parameters };
            Ok::<_, OutOfRange>(PunctureInput { parameters, ..input.clone() })
        })?;
        problem.curve(&mut followed, &variations)
    })
}

/// Computes the force at given `displacements` while the load is removed, without derivatives.
///
/// Unloading begins at the displacement `turn`. An entry is `None` if its displacement is smaller
/// than the residual displacement, and all are `None` if the path does not reach `turn`.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn unloading_curve(
    input: &PunctureInput,
    turn: f64,
    displacements: &[f64],
) -> Result<Vec<Option<CurvePoint>>, OutOfRange> {
    with_path(input, &[At::Displacement(turn)], |problem, mut followed| {
        let locations = displacements.iter().map(|at| At::Displacement(*at).location());
        let turn = followed.watch.requested.points.swap_remove(0);
        Ok(unloaded(&mut followed.path, turn, locations, &problem.common.solver, FORCE_OVER_DEPTH))
    })
}

/// Follows the path of `input` up to the points `at`, beyond the critical tilt if necessary.
fn with_path<T>(
    input: &PunctureInput,
    at: &[At],
    evaluate: impl FnOnce(&Problem, Followed) -> Result<T, OutOfRange>,
) -> Result<T, OutOfRange> {
    let PunctureInput { design, stiffness, common, parameters, .. } = input;
    let mut parameters = *parameters;
    loop {
        let rows = Rows::Even(design.row()?);
        let problem = Problem::new(rows, design, stiffness.clone(), common, &parameters)?;
        let followed = problem.follow(&[], at)?;
        let is_short = followed.watch.requested.points.iter().any(Option::is_none);
        let mut tilt = parameters.critical_tilt_deg;
        if !raise_tilt(&mut tilt, followed.status, is_short) {
            return evaluate(&problem, followed);
        }
        parameters.critical_tilt_deg = tilt;
    }
}

impl Problem<'_> {
    /// Computes the force and its derivatives at the requested points of the path.
    fn curve(
        &self,
        followed: &mut Followed,
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<Vec<Option<CurvePoint>>, OutOfRange> {
        let Followed { watch, path, .. } = followed;
        // Perturbed rows get the final layout of the path, so that all rows have the same unknowns.
        let layout = path.system().layout;
        let variations = Neighbours::map_all(variations, |input| input.chain(layout))?;
        let anchors = anchors(path, &watch.history.segments, &variations);
        let system = path.system();
        Ok(watch
            .requested
            .points
            .iter()
            .map(|point| {
                let point = point.as_ref()?;
                // Perturbed rows have their own values of the history variables at this point.
                let varied = with(&anchors, &point.state, &variations);
                let known = varied.as_deref().unwrap_or_default();
                let mut on_curve =
                    curve_point(system, point, known, &self.common.solver, FORCE_OVER_DEPTH);
                on_curve.rates.resize(variations.len(), None);
                Some(on_curve)
            })
            .collect())
    }

    /// Differentiates the measures of a path.
    ///
    /// The result is empty unless the path ended at its target or at the limit of linear bending.
    pub(super) fn derivatives(
        &self,
        followed: &mut Followed,
        variations: &[Neighbours<PunctureInput>],
    ) -> Result<Vec<Derivative>, OutOfRange> {
        let Followed { watch, path, status, .. } = followed;
        if !matches!(status, Status::Complete | Status::Bent) {
            return Ok(Vec::new());
        }
        let is_bent = *status == Status::Bent;
        let layout = path.system().layout;
        let variations = Neighbours::map_all(variations, |input| input.chain(layout))?;
        let anchors = anchors(path, &watch.history.segments, &variations);
        let mut entries = Vec::new();
        // Build the perturbed rows once for all points with the same history variables.
        for points in group_by_history(self.measured_points(watch, path, is_bent)) {
            let state = points.iter().find_map(|point| Some(&point.point.as_ref()?.state));
            // A group without any located point has no derivatives.
            let Some(state) = state else { continue };
            let system = path.system();
            // Perturbed rows have their own values of the history variables at these points.
            entries.extend(match with(&anchors, state, &variations) {
                Some(varied) => derivatives(system, points, &varied, &self.common.solver),
                None => missing(system, &points, variations.len()),
            });
        }
        Ok(entries)
    }

    /// Lists the points of the path to which measures belong.
    ///
    /// A path that `is_bent` ended at the limit of linear bending. It has no measures at its end
    /// except the failure force.
    fn measured_points(
        &self,
        watch: &PathObservers,
        path: &mut Continuation<Chain>,
        is_bent: bool,
    ) -> Vec<MeasuredPoint<Chain>> {
        let PathObservers { record, passage, failure, depth: marked, .. } = watch;
        let FoldObserver { folds, first, .. } = &watch.folds;
        let bent =
            is_bent.then(|| path.system().limit_at(path.point(), FailureMode::Bend)).flatten();
        let summits = self.summits(watch, path, is_bent, bent.as_ref());
        let passed = passage.passed.as_ref();
        let passed = passed.and_then(|[from, to]| event_before(path, [from, to]));
        let chain = path.system();
        let folded = first.as_ref().zip(folds.first());
        let folded = folded.map(|(point, fold)| chain.folded_at(point, fold));
        let touching = record.touching.as_ref().filter(|_| !chain.is_critical_only());
        let touching = touching.and_then(|point| first_contact(chain, point));
        let deep = first_marked(&marked.points, DEPTH_MARK);
        let loaded = first_marked(&watch.force.points, FORCE_MARK);
        let failed = failure.as_ref().and_then(|failure| failure.first.as_ref());
        // A fold is anchored to its gap, other failures to the limit of a scale.
        let failed = failed
            .and_then(|(mode, point)| chain.limit_at(point, *mode).or_else(|| folded.clone()));
        let (mut at_end, at_fold) = at_end_and_fold(folded.is_some(), is_bent);
        if !chain.measures_folds() {
            at_end.retain(|quantity| quantity.measure != "sound_force");
        }
        // If the path ends before this depth, the measure is the force at its end.
        if !is_bent && !marked.points.is_empty() && deep.is_none() {
            at_end.push(force("force_at_depth"));
        }
        if failure.as_ref().is_some_and(|failure| failure.first.is_none()) {
            at_end.push(force(FAILURE_FORCE));
        }
        let mut passing =
            vec![force("passing_force"), depth("passing_displacement"), tilt("passing_tilt_deg")];
        if chain.needle.is_some() {
            // The shift belongs to the first contact beyond the initial face, or to the end of the
            // path without such a contact.
            let at_shift = if passage.passed.is_some() { &mut passing } else { &mut at_end };
            at_shift.push(quantity("needle_shift", |chain, state, _, _| {
                chain.shift(state).unwrap_or(f64::NAN)
            }));
        }
        let mut points = vec![
            MeasuredPoint::new(bent.or_else(|| Some(chain.end_of(end(path)))), at_end),
            MeasuredPoint::new(folded, at_fold),
            MeasuredPoint::new(passed, passing),
            MeasuredPoint::new(deep, [force("force_at_depth")]),
            MeasuredPoint::new(loaded, [tissue_pressure("tissue_pressure_at_force")]),
        ];
        points.extend(summits.load);
        points.extend(chain.stability_limits(watch));
        points.push(MeasuredPoint::new(touching, [depth("first_contact_displacement")]));
        points.extend(chain.point_at_rest(failure.is_some()));
        points.push(summits.stiffness);
        points.push(MeasuredPoint::new(failed, [force(FAILURE_FORCE)]));
        points.extend(summits.stresses);
        points
    }

    /// Locates the maxima of load, stiffness and stresses along the path.
    ///
    /// For a path that `is_bent`, `bent` is its end, anchored to the limit of linear bending.
    fn summits(
        &self,
        watch: &PathObservers,
        path: &mut Continuation<Chain>,
        is_bent: bool,
        bent: Option<&AnchoredPoint<SkinMode>>,
    ) -> Summits {
        let PathObservers { record, failure, .. } = watch;
        let settings = &self.common.solver;
        let has_end = !is_bent && !path.system().is_critical_only();
        let stiffest = if has_end { record.stiffness_summit(path) } else { None };
        let stiffest = sensitivity::summit(stiffest, path, Chain::stiffness, settings);
        let highest = match (record.highest_point(LOAD), bent) {
            // The load is largest at the end of the path, which the limit of bending anchors.
            (Some(highest), Some(bent)) if highest.point.state.z == bent.state.z => {
                Some(bent.clone())
            }
            (highest, _) => sensitivity::summit(highest.as_ref(), path, FOLLOWED[LOAD], settings),
        };
        let failure = failure.as_ref().filter(|_| !is_bent);
        let maxima = failure.map(|failure| failure.summits(path)).into_iter().flatten();
        let mut stresses = Vec::new();
        for ((point, f), quantity) in maxima.zip(MAXIMA).zip(largest_stresses()) {
            let point = sensitivity::summit(point.as_ref(), path, f, settings);
            stresses.push(MeasuredPoint::new(point, [quantity]));
        }
        let chain = path.system();
        let [highest, stiffest] =
            [highest, stiffest].map(|point| point.map(|point| chain.end_of_target(point)));
        let peak = highest.as_ref().map(|point| chain.extremum(point));
        Summits {
            load: [
                MeasuredPoint::new(highest, [force("peak_force")]),
                at_turn(peak, [depth("peak_displacement"), tilt("peak_tilt_deg")]),
            ],
            stiffness: MeasuredPoint::new(stiffest, [stiffness("max_stiffness")]),
            stresses,
        }
    }
}

/// Points of the maxima along a path, with the measures at each point.
struct Summits {
    /// Point of the largest load, for the load itself, then for displacement and tilt.
    load: [MeasuredPoint<Chain>; 2],
    stiffness: MeasuredPoint<Chain>,
    stresses: Vec<MeasuredPoint<Chain>>,
}

/// Returns the first located point, anchored to the marker `mark`; `None` without such a point.
fn first_marked(points: &[Option<SkinPoint>], mark: usize) -> Option<AnchoredPoint<SkinMode>> {
    let point = points.iter().flatten().next()?;
    Some(AnchoredPoint::arriving(point, PathAnchor::Marker(mark)))
}

impl Chain {
    /// Lists the points at which stability under load control and depth control is lost.
    fn stability_limits(&self, watch: &PathObservers) -> [MeasuredPoint<Self>; 2] {
        // A point of instability that is not an event has no guard that could anchor it when a
        // parameter changes.
        let load = watch.snaps.load_limit.as_ref().filter(|point| point.event.is_some());
        let load = load.and_then(|point| sensitivity::turn(self, point, LOAD_RATE));
        let depth = watch.snaps.depth_limit.as_ref();
        let depth = depth.and_then(|point| sensitivity::turn(self, point, DEPTH_RATE));
        [
            at_turn(load, [force("load_stability_force")]),
            at_turn(depth, [force("depth_stability_force")]),
        ]
    }

    /// Returns the state at rest with its measures; `None` without measures at rest.
    ///
    /// The measures include the clearance if `has_failures` is true.
    fn point_at_rest(&self, has_failures: bool) -> Option<MeasuredPoint<Self>> {
        let mut quantities = Vec::new();
        if !self.is_critical_only() {
            quantities.push(stiffness("initial_stiffness"));
        }
        if has_failures {
            quantities.push(quantity("clearance", |chain, _, _, _| {
                chain.clearance().unwrap_or(f64::NAN)
            }));
        }
        let mut at_rest = rest(self);
        at_rest.state = self.at_rest();
        (!quantities.is_empty()).then(|| MeasuredPoint::new(Some(at_rest), quantities))
    }
}

impl PunctureInput {
    /// Builds the system of a row with this layout.
    fn chain(&self, layout: RowLayout) -> Result<Chain, OutOfRange> {
        let Self { design, stiffness, common, parameters, perturbed } = self;
        // An upright design with a perturbed slant may lean to the left.
        let row = design.leaning_row()?;
        let rows = perturbed.map_or(Rows::Even(row), |scale| Rows::Perturbed(row, scale));
        // At the end of a parameter range, a perturbed value lies outside the range.
        let problem = Problem::unchecked(rows, design, stiffness.clone(), common, parameters)?;
        problem.part(layout)
    }
}

/// Groups measured points by their history variables.
fn group_by_history(points: Vec<MeasuredPoint<Chain>>) -> Vec<Vec<MeasuredPoint<Chain>>> {
    let mut groups: Vec<(Vec<HistoryVariable>, Vec<MeasuredPoint<Chain>>)> = Vec::new();
    for measured in points {
        let variables =
            measured.point.as_ref().map(|point| history(&point.state)).unwrap_or_default();
        match groups.iter_mut().find(|(other, _)| *other == variables) {
            Some((_, group)) => group.push(measured),
            None => groups.push((variables, vec![measured])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

impl Chain {
    /// Anchors the end of a path to the critical tilt, or to a constraint of a guided needle.
    fn end_of(&self, point: AnchoredPoint<SkinMode>) -> AnchoredPoint<SkinMode> {
        let ended = self.needle.as_ref().and_then(|n| n.ended_at(self, &point.state));
        AnchoredPoint { anchor: ended.map_or(point.anchor, PathAnchor::Guard), ..point }
    }

    /// Anchors a point to the limit of a failure mode; `None` if no single scale has this limit.
    fn limit_at(&self, point: &SkinPoint, mode: FailureMode) -> Option<AnchoredPoint<SkinMode>> {
        let mark = self.limit_mark(&point.state, mode)?;
        Some(AnchoredPoint::arriving(point, PathAnchor::Marker(mark)))
    }

    /// Anchors a point at the end of the path like this end; other points keep their anchor.
    fn end_of_target(&self, point: AnchoredPoint<SkinMode>) -> AnchoredPoint<SkinMode> {
        if point.anchor == PathAnchor::Target { self.end_of(point) } else { point }
    }

    /// Anchors the point of largest load to the zero rate of the load.
    ///
    /// A point that an event or the target fixes keeps its anchor.
    fn extremum(&self, point: &AnchoredPoint<SkinMode>) -> AnchoredPoint<SkinMode> {
        let is_held = sensitivity::is_held(self, point);
        let anchor = if is_held { point.anchor } else { PathAnchor::Stationary(LOAD_RATE) };
        AnchoredPoint { anchor, ..point.clone() }
    }

    /// Anchors the equilibrium at a fold to the zero stretch of its gap.
    fn folded_at(&self, point: &SkinPoint, fold: &Fold) -> AnchoredPoint<SkinMode> {
        let pair = (fold.left_scale as isize + self.layout.left.cast_signed()).cast_unsigned();
        AnchoredPoint::arriving(point, PathAnchor::Marker(pair))
    }
}

/// Creates a measured point from a point and its quantities.
///
/// At a smooth extremum, the point and its quantities depend on the direction of the path.
fn at_turn<const N: usize>(
    point: Option<AnchoredPoint<SkinMode>>,
    quantities: [MeasuredQuantity<Chain>; N],
) -> MeasuredPoint<Chain> {
    let depends_on_direction =
        point.as_ref().is_some_and(|p| matches!(p.anchor, PathAnchor::Stationary(_)));
    MeasuredPoint::new(
        point,
        quantities.map(|quantity| MeasuredQuantity { depends_on_direction, ..quantity }),
    )
}

/// Lists the quantities at the critical tilt and at the first fold.
///
/// The largest valid force (`sound_force`) belongs to the fold if the surface `folds`, otherwise to
/// the critical tilt. If the path ended early because a scale `is_bent` up to the limit of linear
/// bending, only the quantities at the fold exist.
fn at_end_and_fold(
    folds: bool,
    is_bent: bool,
) -> (Vec<MeasuredQuantity<Chain>>, Vec<MeasuredQuantity<Chain>>) {
    let mut fold = vec![force("fold_force"), depth("fold_displacement"), tilt("fold_tilt_deg")];
    if is_bent {
        return (Vec::new(), fold);
    }
    let mut end = critical();
    (if folds { &mut fold } else { &mut end }).push(force("sound_force"));
    (end, fold)
}

fn tilt(measure: &'static str) -> MeasuredQuantity<Chain> {
    quantity(measure, |chain, state, _, _| chain.angle_deg(state))
}

fn critical() -> Vec<MeasuredQuantity<Chain>> {
    // The index `i` of a scale also denotes the gap on its right. The index of the last scale
    // denotes all gaps beyond the solved part.
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

/// Lists the largest stresses on the path, in the order of [`MAXIMA`].
fn largest_stresses() -> [MeasuredQuantity<Chain>; MAXIMA.len()] {
    [
        largest("scale_stress_max", |chain, state, _, i| chain.scale_values(state, i).tracked[0]),
        largest("scale_deflection_max", |chain, state, _, i| {
            chain.scale_values(state, i).tracked[1]
        }),
        largest("bond_stress_max", |chain, state, _, i| chain.scale_values(state, i).tracked[2]),
        tissue_pressure("tissue_pressure_max"),
    ]
}

fn tissue_pressure(measure: &'static str) -> MeasuredQuantity<Chain> {
    largest(measure, |chain, state, _, i| chain.scale_values(state, i).tracked[TISSUE_PRESSURE])
}

/// Creates the measure of the largest value of any scale.
fn largest(measure: &'static str, value: ValueOf<Chain>) -> MeasuredQuantity<Chain> {
    MeasuredQuantity { extreme: Some(f64::max), ..quantity(measure, value) }
}

/// Returns the stretch of a solved gap, or the extreme stretch of the gaps beyond the solved part.
///
/// The index after the last solved gap denotes the gaps beyond the solved part. `outer` selects the
/// extreme value of their stretches, which follow in closed form. NaN if there are no such gaps.
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
    let quantity = quantity(measure, |chain: &Chain, state, direction, _| {
        chain.plane_modulus * chain.stiffness(state, direction)
    });
    MeasuredQuantity { depends_on_direction: true, ..quantity }
}

/// Creates the measure of the extreme value over all scales, or over all gaps.
fn extreme(
    measure: &'static str,
    value: ValueOf<Chain>,
    outer: fn(f64, f64) -> f64,
) -> MeasuredQuantity<Chain> {
    MeasuredQuantity { extreme: Some(outer), ..quantity(measure, value) }
}

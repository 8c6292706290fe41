//! Rows under a guided needle.

mod round_tip;

use approx::assert_relative_eq;
use substrate::Springs;

use super::*;
use crate::puncture::needle::NEEDLE_UNKNOWNS;
use crate::puncture::{self, CriticalEvent, Needle, Puncture, RowLength};

/// Returns a design of width `t` with a base of `L`.
pub(super) fn design(gap: f64, length: f64, slant_deg: f64) -> Design {
    Design { gap, length, slant_deg, base: Base::L, width: 1.0 }
}

/// Returns parameters with the needle at the distance `inside` to the left of the top right corner.
fn parameters(design: &Design, friction: f64, inside: f64) -> PunctureParameters {
    let load_position = 1.0 - inside / (2.0 * design.half_base());
    let needle = Needle::Guided { friction };
    PunctureParameters { load_position, needle, ..PunctureParameters::default() }
}

fn springs(design: &Design) -> Springs {
    calibrate(&design.footprint(0.5).unwrap()).unwrap()
}

fn guided(design: &Design, friction: f64, inside: f64) -> Puncture {
    let parameters = parameters(design, friction, inside);
    puncture::solve(design, &springs(design), &Common::default(), &parameters).unwrap()
}

/// Starts the path of a row of 21 scales under a guided needle, with steps of at most `step`.
pub(super) fn guided_path(
    design: &Design,
    friction: f64,
    inside: f64,
    step: f64,
) -> Continuation<Chain> {
    let layout = RowLayout { left: 10, right: 10, needle: NEEDLE_UNKNOWNS, contacts: 6 };
    let stiffness = (&springs(design)).into();
    let law = law(design, Law::PRINTED, HARD);
    let chain = whole(&stiffness, design, law, layout, &parameters(design, friction, inside));
    let settings = Settings { first_step: step, max_step: step, ..Settings::default() };
    let rest = chain.at_rest();
    Continuation::new(chain, rest, settings)
}

/// Gap, length, slant, friction of the needle, and its distance from the top right corner.
///
/// The tips stick, slide in both directions, and pass over the right or the left corner.
pub(super) const CASES: [(f64, f64, f64, f64, f64); 7] = [
    (0.1, 1.0, 0.0, 0.0, 0.0),
    (0.1, 1.0, 45.0, 0.0, 0.0),
    (0.1, 1.0, 60.0, 0.176, 0.0),
    (0.2, 0.8, 30.0, 0.3, 0.05),
    (0.1, 0.2, 0.0, 0.3, 0.05),
    (0.3, 0.2, 60.0, 0.3, 0.05),
    (0.2, 0.1, 0.0, 0.0, 0.0),
];

/// Integrates `F du` by Boole's rule on `[F, u]` at five points.
///
/// `du` is the derivative of the polynomial through the five values of `u`.
pub(super) fn integral(values: [[f64; 2]; 5]) -> f64 {
    let u = values.map(|[_, u]| u);
    let slopes = [
        [-25.0, 48.0, -36.0, 16.0, -3.0],
        [-3.0, -10.0, 18.0, -6.0, 1.0],
        [1.0, -8.0, 0.0, 8.0, -1.0],
        [-1.0, 6.0, -18.0, 10.0, 3.0],
        [3.0, -16.0, 36.0, -48.0, 25.0],
    ]
    .map(|row| row.iter().zip(u).map(|(w, u)| w * u).sum::<f64>() / 3.0);
    let weights = [7.0, 32.0, 12.0, 32.0, 7.0];
    (0..5).map(|k| weights[k] * values[k][0] * slopes[k]).sum::<f64>() / 90.0
}

/// Compares critical forces with an independent program; the tip stays on the top of its scale.
#[test]
fn a_frictionless_needle_slides_inward() {
    for (gap, length, slant, expected) in [
        (0.1, 1.0, 0.0, 0.188),
        (0.5, 1.0, 0.0, 0.127),
        (0.1, 0.2, 0.0, 1.16),
        (0.3, 0.5, 45.0, 0.0314),
    ] {
        let puncture = guided(&design(gap, length, slant), 0.0, 0.0);
        assert_eq!(puncture.status, Status::Complete);
        assert_eq!(puncture.measures.passage.critical_event, Some(CriticalEvent::Tilt));
        assert_eq!(puncture.measures.passage.passing_force, None);
        // The reference values are rounded to within half a percent.
        let force = puncture.measures.critical_force.unwrap();
        assert_relative_eq!(force, expected, max_relative = 5e-3);
        assert_eq!(puncture.measures.stable_under_load, Some(true));
    }
    let shift = guided(&design(0.1, 1.0, 0.0), 0.0, 0.0).measures.passage.needle_shift.unwrap();
    assert_relative_eq!(shift, 0.12, max_relative = 0.02);
}

/// The tip sticks at the right corner of the top. At 45° this corner touches the next scale.
#[test]
fn a_needle_that_never_slides_matches_references() {
    for (slant, expected) in [(0.0, 0.2804), (45.0, 0.4314)] {
        let puncture = guided(&design(0.1, 1.0, slant), 1e9, 0.0);
        let force = puncture.measures.critical_force.unwrap();
        assert_relative_eq!(force, expected, max_relative = 5e-4);
    }
}

/// The row pushes the scale to the left below the needle.
///
/// The tip reaches the corner of the scale, and then the face of the next scale.
#[test]
fn a_needle_passes_into_the_notch() {
    for (slant, friction, inside, force, tilt) in [
        (45.0, 0.0, 0.0, 0.214, 6.9),
        (60.0, 0.0, 0.0, 0.148, 3.5),
        (60.0, 0.176, 0.0, 0.266, 4.2),
        (75.0, 0.0, 0.0, 0.105, 1.5),
        (75.0, 0.0, 0.2, 0.88, 2.7),
        (75.0, 0.3, 0.0, 2.18, 4.4),
    ] {
        let Puncture { status, measures, .. } = guided(&design(0.1, 1.0, slant), friction, inside);
        let passage = measures.passage;
        assert_eq!(status, Status::Complete);
        assert_relative_eq!(passage.passing_force.unwrap(), force, max_relative = 0.01);
        assert_relative_eq!(passage.passing_tilt_deg.unwrap(), tilt, max_relative = 0.02);
        assert!(measures.critical_force > passage.passing_force);
    }
}

/// Compares with ten results of an independent program.
///
/// The program has rigid contacts, active sets, steps of 2e-4 in depth, and rows of 41 scales. Each
/// row below holds gap, length and slant, friction, distance of the needle from the right corner,
/// and the results: force, depth and distance of the tip from the corner. The results belong to the
/// first contact beyond the initial face, or to a tilt of 10° without such a contact.
#[test]
fn needle_matches_an_independent_program() {
    let ten: [([f64; 3], f64, f64, [f64; 3]); 10] = [
        ([0.2, 0.5, 30.0], 0.3, 0.05, [0.085_635, 0.174_785, 0.176_906]),
        ([0.1, 0.2, 0.0], 0.3, 0.05, [1.914_79, 0.624_262, 0.05]),
        ([0.2, 0.3, 60.0], 0.3, 0.05, [0.069_753, 0.326_839, 0.171_75]),
        ([0.4, 0.8, 15.0], 0.1, 0.0, [0.080_290, 0.166_937, 0.141_219]),
        ([0.3, 0.7, 60.0], 0.3, 0.05, [0.280_929, 0.417_332, 0.132_162]),
        ([0.2, 1.0, 60.0], 0.0, 0.0, [0.211_452, 0.318_856, 0.0]),
        ([0.3, 0.3, 75.0], 0.3, 0.05, [5.5719, 0.838_531, 0.034_574]),
        ([0.2, 0.6, 45.0], 0.3, 0.05, [0.099_419, 0.261_184, 0.154_083]),
        ([0.5, 0.4, 30.0], 0.2, 0.0, [0.035_299, 0.141_638, 0.154_333]),
        ([0.1, 0.4, 30.0], 0.1, 0.1, [0.135_583, 0.167_713, 0.229_73]),
    ];
    for ([gap, length, slant], friction, inside, [force, depth, inward]) in ten {
        let design = design(gap, length, slant);
        let parameters = PunctureParameters {
            scales: RowLength::Scales(41),
            ..parameters(&design, friction, inside)
        };
        let solved = puncture::solve(&design, &springs(&design), &Common::default(), &parameters);
        let measures = solved.unwrap().measures;
        let passage = measures.passage;
        let found = [
            passage.passing_force.or(measures.critical_force),
            passage.passing_displacement.or(measures.critical_displacement),
            passage.needle_shift.map(|shift| shift + inside),
        ];
        let [our_force, our_depth, our_inward] = found.map(Option::unwrap);
        assert_relative_eq!(our_force, force, max_relative = 1e-4);
        assert_relative_eq!(our_depth, depth, max_relative = 1e-4);
        assert_relative_eq!(our_inward, inward, epsilon = 1e-5);
    }
}

#[test]
fn tangent_matches_finite_differences() {
    for (gap, length, slant, friction, inside) in CASES {
        let design = design(gap, length, slant);
        for_segments(guided_path(&design, friction, inside, 0.1), |path, from, to| {
            if path.spans(from, to)[0].abs() < 1e-6 {
                // Between two simultaneous events, forces that begin to act are too small for
                // finite differences.
                return;
            }
            let Some(between) = path.between(from, to, 0.5) else { return };
            check_tangent(path.system(), &between.state, 1e-5).unwrap();
        });
    }
}

/// Compares `Chain::instability` with the dense stiffness for displacements and depth.
///
/// The tips slide without friction, stick, and pass over corners.
#[test]
fn negative_eigenvalues_match_the_dense_stiffness() {
    let mut compared = HashSet::new();
    for (gap, length, slant, friction) in
        [(0.6, 1.0, 60.0, 0.0), (0.6, 1.0, 60.0, 1e9), (0.1, 1.0, 60.0, 0.0), (0.2, 0.5, 30.0, 0.3)]
    {
        let design = design(gap, length, slant);
        let layout = RowLayout { left: 7, right: 9, needle: NEEDLE_UNKNOWNS, contacts: 6 };
        let parameters =
            PunctureParameters { critical_tilt_deg: 40.0, ..parameters(&design, friction, 0.05) };
        let law = law(&design, Law::EXCHANGED, HARD);
        let chain = whole(&(&springs(&design)).into(), &design, law, layout, &parameters);
        let rest = chain.at_rest();
        for_segments(Continuation::new(chain, rest, Settings::default()), |path, from, to| {
            let Some(point) = path.between(from, to, 0.5) else { return };
            let (chain, state) = (path.system(), &point.state);
            if chain.is_nonconservative(state) {
                return assert_eq!(chain.instability(state), None);
            }
            let dense = dense_stiffness(chain, state);
            let ridges = chain.contacts.ridges(state);
            let [depth, tilt] = [dense.nrows() - 1, 3 * chain.layout.left + 2].map(|entry| {
                let mut unit = DVector::zeros(dense.nrows());
                unit[entry] = 1.0;
                negative_eigenvalues(&dense, Some(&unit)) + ridges
            });
            let load = negative_eigenvalues(&dense, None) + ridges;
            let expected = Instability { load, depth, tilt };
            let falls =
                [chain.load(), chain.load() + 1].map(|unknown| point.leaving[unknown] < 0.0);
            assert_eq!(falls, [expected.load, expected.depth].map(|count| count % 2 == 1));
            assert_eq!(chain.instability(state), Some(expected), "{:?}", chain.path_point(&point));
            compared.insert((expected.load, expected.depth, expected.tilt));
        });
    }
    assert!(compared.len() > 2, "{compared:?}");
}

#[test]
fn needle_work_is_stored_or_dissipated() {
    let cases = CASES.map(|(gap, length, slant, friction, inside)| {
        guided_path(&design(gap, length, slant), friction, inside, 0.01)
    });
    let most = cases.map(dissipated_fraction).into_iter().fold(0.0, f64::max);
    assert!(most > 0.01, "{most}");
}

/// Returns the fraction of the work of a needle that is dissipated along a path.
///
/// Asserts that all other work is stored as elastic energy.
fn dissipated_fraction(path: Continuation<Chain>) -> f64 {
    let (mut done, mut dissipated, mut off) = (0.0, 0.0, 0.0_f64);
    for_segments(path, |path, from, to| {
        done += work(path, from, to);
        let inner = [0.25, 0.5, 0.75].map(|x| path.between(from, to, x).unwrap().state);
        // Combine the unknowns at the end with the mode of the segment, because the mode may change
        // at the end.
        let mut end = inner[2].clone();
        end.z.clone_from(&to.state.z);
        let chain = path.system();
        let states = [&from.state, &inner[0], &inner[1], &inner[2], &end];
        let tip_friction = states.map(|state| chain.tip_friction(state));
        dissipated += (0..tip_friction[0].len())
            .map(|slot| integral(tip_friction.each_ref().map(|all| all[slot])))
            .sum::<f64>();
        let stored = chain.substrate_energy(&to.state) + chain.contacts.energy(&to.state);
        off = off.max((done - stored - dissipated).abs());
    });
    assert!(off < 1e-8 * done, "{:e}", off / done);
    assert!(dissipated > -1e-12, "{dissipated}");
    dissipated / done
}

/// Compares one scale on its springs with a closed form.
///
/// With the spring constants `k`, the arm `ρ` of the needle along the top, and the tip at `X`,
///
/// ```text
/// k_φ φ = −N ρ,   N sin φ = −k_x x,   ρ cos φ − sin φ = X − x                  F = N cos φ
/// ```
#[test]
fn an_isolated_scale_matches_a_scalar_equation() {
    let design = design(0.1, 1.0, 0.0);
    let parameters =
        PunctureParameters { scales: RowLength::Scales(1), ..parameters(&design, 0.0, 0.0) };
    let springs = springs(&design);
    let puncture = puncture::solve(&design, &springs, &Common::default(), &parameters).unwrap();
    let direct = RowStiffness::from(&springs).with_lengths_over(design.half_base()).direct;
    let rotation = (-10.0_f64).to_radians();
    let (sin, cos) = rotation.sin_cos();
    let (mut low, mut high) = (0.01, 1.0);
    for _ in 0..200 {
        let arm = f64::midpoint(low, high);
        // The force on the scale is −N n, with n = (−sin φ, cos φ).
        let x = -direct[2] * rotation / arm * sin / direct[0];
        *(if arm * cos - sin > 0.5 - x { &mut high } else { &mut low }) = arm;
    }
    let expected = -direct[2] * rotation / low * cos / design.length;
    assert_relative_eq!(puncture.measures.critical_force.unwrap(), expected, max_relative = 1e-9);
}

/// Compares needles at the same distance from the left and the right corner of an upright scale.
#[test]
fn mirrored_needles_have_mirrored_results() {
    for friction in [0.0, 0.2] {
        let upright = design(0.3, 0.6, 0.0);
        let right = guided(&upright, friction, 0.1);
        let left = guided(&upright, friction, 0.5);
        assert_eq!([left.status, right.status], [Status::Complete; 2]);
        let ends = [&left, &right].map(|puncture| *puncture.path.last().unwrap());
        let [left, right] = ends;
        for (left, right) in [
            (left.force, right.force),
            (left.displacement, right.displacement),
            (left.lateral_force, -right.lateral_force),
            (left.tilt_deg, -right.tilt_deg),
            (left.contact_energy, right.contact_energy),
        ] {
            assert_relative_eq!(left, right, max_relative = 1e-8, epsilon = 1e-14);
        }
    }
}

/// The tip slides down the left face of the next scale to the foot of this face.
#[test]
fn the_path_of_a_needle_that_reaches_a_foot_ends_as_through() {
    for friction in [0.0, 0.3] {
        let design = design(1.0, 1.0, 60.0);
        let parameters =
            PunctureParameters { critical_tilt_deg: 60.0, ..parameters(&design, friction, 0.1) };
        let springs = springs(&design);
        let through = puncture::solve(&design, &springs, &Common::default(), &parameters).unwrap();
        assert_eq!(through.status, Status::Complete);
        assert_eq!(through.measures.passage.critical_event, Some(CriticalEvent::Through));
        let end = through.path.last().unwrap();
        assert!(end.tilt_deg < 59.0 && through.measures.critical_force == Some(end.force));
        let next = through.scales.iter().find(|scale| scale.scale == 1).unwrap();
        let (sin, cos) = next.rotation_deg.to_radians().sin_cos();
        let a = design.half_base();
        let foot = [2.0 * a + design.gap - a * cos, -a * sin];
        let tip = [a + 60.0_f64.to_radians().tan() - 0.1, 1.0 - end.displacement];
        for ((foot, moved), tip) in foot.into_iter().zip(next.displacement).zip(tip) {
            assert_relative_eq!(foot + moved, tip, epsilon = 1e-9);
        }
    }
}

/// A row that leans to the left has its needle at the mirrored position.
#[test]
fn rows_leaning_left_mirror_rows_leaning_right() {
    for (gap, length, slant, friction, inside) in
        [(0.3, 0.5, 45.0, 0.0, 0.0), (0.3, 0.7, 60.0, 0.3, 0.05), (0.2, 0.8, 30.0, 0.3, 0.05)]
    {
        let [right, left] = [slant, -slant].map(|slant_deg| {
            let design = design(gap, length, slant_deg);
            let mut parameters = parameters(&design, friction, inside);
            if slant_deg < 0.0 {
                parameters.load_position = 1.0 - parameters.load_position;
            }
            let (row, common) = (design.leaning_row().unwrap(), Common::default());
            let stiffness = (&springs(&design)).into();
            Problem::new(Rows::Even(row), &design, stiffness, &common, &parameters)
                .unwrap()
                .solve()
                .unwrap()
        });
        assert_eq!([left.status, right.status], [Status::Complete; 2]);
        let [left, right] = [left, right].map(|puncture| *puncture.path.last().unwrap());
        assert_relative_eq!(left.force, right.force, max_relative = 1e-8);
        assert_relative_eq!(left.displacement, right.displacement, max_relative = 1e-8);
        assert_relative_eq!(left.lateral_force, -right.lateral_force, max_relative = 1e-8);
        assert_relative_eq!(left.tilt_deg, -right.tilt_deg, max_relative = 1e-8);
    }
}

/// A needle in the middle of an upright scale pushes it straight down.
#[test]
fn an_untilted_scale_has_no_critical_force() {
    let upright = design(0.3, 0.6, 0.0);
    let puncture = guided(&upright, 0.2, 0.3);
    assert_eq!(puncture.status, Status::Untilted);
    assert_eq!(puncture.measures.critical_force, None);
}

/// The passing force and the critical force must not depend on the largest step.
#[test]
fn passage_does_not_depend_on_the_step_size() {
    let steep = design(0.1, 1.0, 75.0);
    let forces = [0.2, 0.02].map(|step| {
        let settings = Settings { max_step: step, ..Settings::default() };
        let common = Common { solver: settings, ..Common::default() };
        let parameters = parameters(&steep, 0.3, 0.0);
        let puncture = puncture::solve(&steep, &springs(&steep), &common, &parameters).unwrap();
        [puncture.measures.passage.passing_force, puncture.measures.critical_force]
            .map(Option::unwrap)
    });
    for (coarse, fine) in forces[0].iter().zip(forces[1]) {
        assert_relative_eq!(*coarse, fine, max_relative = 1e-8);
    }
}

type Value = fn(&puncture::PunctureMeasures) -> Option<f64>;

const MEASURES: [(&str, Value); 10] = [
    ("force_at_depth", |m| m.force_at_depth),
    ("critical_force", |m| m.critical_force),
    ("critical_displacement", |m| m.critical_displacement),
    ("penetration", |m| m.penetration),
    ("secant_stiffness", |m| m.secant_stiffness),
    ("initial_stiffness", |m| m.initial_stiffness),
    ("passing_force", |m| m.passage.passing_force),
    ("passing_displacement", |m| m.passage.passing_displacement),
    ("passing_tilt_deg", |m| m.passage.passing_tilt_deg),
    ("needle_shift", |m| m.passage.needle_shift),
];

/// Applies a change of the given size to a parameter.
type Change = fn(&mut puncture::PunctureInput, f64);

/// Makes the scales longer by `by`.
fn longer(input: &mut puncture::PunctureInput, by: f64) {
    input.design.length += by;
}

/// Moves the load position to the right by `by`.
fn move_load_right(input: &mut puncture::PunctureInput, by: f64) {
    input.parameters.load_position += by;
}

/// Compares derivatives with differences of complete solutions.
///
/// The tips slide, stick from the start, stop sliding, or are locked in a notch.
#[test]
fn derivatives_account_for_history_variables() {
    let changes: [(Change, f64); 4] = [
        (longer, 2e-6),
        (move_load_right, 2e-6),
        (|input, h| input.parameters.critical_tilt_deg += h, 2e-5),
        (
            |input, h| {
                if let Needle::Guided { friction } = &mut input.parameters.needle {
                    *friction += h;
                }
            },
            2e-6,
        ),
    ];
    let mut ends = HashSet::new();
    for (gap, length, slant, friction, inside, of_scales) in [
        (0.5, 1.0, 0.0, 0.1, 0.05, 0.0),
        (0.5, 1.0, 0.0, 2.0, 0.1, 0.0),
        (0.1, 0.2, 0.0, 0.3, 0.05, 0.0),
        (0.3, 0.7, 60.0, 0.3, 0.05, 0.0),
        (0.3, 0.3, 75.0, 0.3, 0.05, 0.0),
        (0.1, 1.0, 60.0, 0.176, 0.02, 0.0),
        (0.1, 1.0, 75.0, 0.3, 0.05, 0.0),
        (0.1, 1.0, 45.0, 0.05, 0.02, 0.0),
        (0.2, 1.0, 60.0, 0.3, 0.0125, 0.1),
        (0.3, 0.8, 75.0, 0.3, 0.0125, 0.1),
    ] {
        let design = design(gap, length, slant);
        let common = Common { friction: of_scales, ..Common::default() };
        let measures = derivatives_are_differences(
            design,
            common,
            parameters(&design, friction, inside),
            &changes,
        );
        ends.insert(measures.passage.passing_force.is_some());
    }
    assert_eq!(ends, [false, true].into());
}

/// Returns the input after a `change` of one parameter by `step`.
fn moved(input: &puncture::PunctureInput, change: Change, step: f64) -> puncture::PunctureInput {
    let mut input = input.clone();
    change(&mut input, step);
    input
}

/// Asserts that every derivative of a puncture equals a difference of complete solutions.
fn derivatives_are_differences(
    design: Design,
    common: Common,
    parameters: PunctureParameters,
    changes: &[(Change, f64)],
) -> puncture::PunctureMeasures {
    let input = puncture::PunctureInput {
        design,
        stiffness: (&springs(&design)).into(),
        common,
        parameters: PunctureParameters { depth: Some(0.15), ..parameters },
        perturbed: None,
    };
    let variations: Vec<_> = changes
        .iter()
        .map(|&(change, step)| {
            let [below, above] = [-step, step].map(|step| moved(&input, change, step));
            crate::Neighbours { below, above, step }
        })
        .collect();
    let (puncture, derivatives) = puncture::differentiate(&input, &variations).unwrap();
    for (parameter, &(change, step)) in changes.iter().enumerate() {
        // The step must be large enough to suppress round-off, and small enough to neglect the
        // curvature of the measure.
        let [below, above] = [-50.0, 50.0].map(|times| {
            let input = moved(&input, change, times * step);
            puncture::differentiate(&input, &[]).unwrap().0.measures
        });
        let mut compared = 0;
        for (name, value) in MEASURES {
            let Some([above, below]) = value(&above).zip(value(&below)).map(<[f64; 2]>::from)
            else {
                assert!(name.starts_with("passing"), "{name}");
                continue;
            };
            let expected = (above - below) / (100.0 * step);
            let of = derivatives.iter().find(|d| d.measure == name && d.parameter == parameter);
            let found = of.and_then(|derivative| derivative.left).expect(name);
            assert_relative_eq!(found, expected, max_relative = 1e-5, epsilon = 1e-8);
            compared += 1;
        }
        assert!(compared >= 6);
    }
    puncture.measures
}

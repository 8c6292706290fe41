//! Verdicts on constructed evidence.

use Verdict::{InPart, NotReproduced, Reproduced};

use super::evidence::{Balanced, BentStrip, CurveEnd, Evidence, LoadedRow, PunctureCurve};
use super::verdict::{Limits, Optimum, Verdict};
use super::{STATEMENTS, judge, statements, verdict};
use crate::study::MeasuredDesign;

/// Returns the verdict on the claim `id`.
fn on(id: &str, evidence: &Evidence) -> Verdict {
    let claims = statements().expect("tables");
    let (_, statements) = claims.iter().find(|(claim, _)| claim.id == id).expect("a claim");
    verdict(statements, evidence).expect("limits")
}

fn limits(text: &str) -> Limits {
    Limits::read(text).expect("limits")
}

fn design(gap: f64, length: f64, slant: f64) -> MeasuredDesign {
    MeasuredDesign { gap, length, slant, ..MeasuredDesign::default() }
}

fn designs(designs: impl IntoIterator<Item = MeasuredDesign>) -> Evidence {
    Evidence { designs: designs.into_iter().collect(), ..Evidence::default() }
}

#[test]
fn every_claim_has_statements_and_every_statement_a_claim_and_limits() {
    let claims = statements().expect("tables");
    assert!(claims.iter().all(|(_, statements)| !statements.is_empty()));
    let of_claims: usize = claims.iter().map(|(_, statements)| statements.len()).sum();
    assert_eq!(of_claims, STATEMENTS.lines().count() - 1);
    let all = claims.iter().flat_map(|(_, statements)| statements);
    all.for_each(|statement| drop(statement.find(&Evidence::default()).expect("a check")));
}

#[test]
fn a_claim_has_a_row_for_itself_and_one_for_each_of_several_statements() {
    let evidence = [Evidence::default(), grid(|d| d.coverage = Some(d.slant))];
    let judged = judge(&evidence).expect("claims");
    let rows_of =
        |id: &str| judged.iter().find(|claim| claim.claim.id == id).expect("a claim").rows();
    let first = rows_of("C01");
    assert!(
        first.ends_with(
            "| not reproduced: none | **reproduced**: 0 | by the definition of coverage |\n"
        ),
        "{first}"
    );
    assert_eq!(first.lines().count(), 1);
    let rows = rows_of("C10");
    let labels: Vec<_> = rows.lines().filter_map(|row| row.split(" | ").next()).collect();
    assert_eq!(labels, ["| C10", "| C10a", "| C10b", "| C10c"]);
    for row in
        judged.iter().flat_map(|claim| claim.rows().lines().map(str::to_owned).collect::<Vec<_>>())
    {
        assert_eq!(row.matches('|').count(), 9, "{row}");
    }
}

#[test]
fn without_evidence_nothing_is_reproduced() {
    for (claim, _) in statements().expect("tables") {
        assert_eq!(on(&claim.id, &Evidence::default()), NotReproduced, "{}", claim.id);
    }
}

#[test]
fn claims_combine_the_verdicts_of_their_statements() {
    assert_eq!(Verdict::of_all(&[Reproduced, Reproduced]), Reproduced);
    assert_eq!(Verdict::of_all(&[Reproduced, NotReproduced]), InPart);
    assert_eq!(Verdict::of_all(&[NotReproduced, InPart]), InPart);
    assert_eq!(Verdict::of_all(&[NotReproduced, NotReproduced]), NotReproduced);
}

#[test]
fn limits_include_their_ends() {
    let printed = limits("90 to 110; in part 70 to 130");
    for (number, expected) in [
        (90.0, Reproduced),
        (110.0, Reproduced),
        (89.9, InPart),
        (70.0, InPart),
        (130.0, InPart),
        (69.9, NotReproduced),
        (130.1, NotReproduced),
        (f64::NAN, NotReproduced),
    ] {
        assert_eq!(printed.verdict(number), expected, "{number}");
    }
    assert_eq!(limits("≥ 1").verdict(1.0), Reproduced);
    assert_eq!(limits("≤ 1.5; in part ≤ 2").verdict(1.6), InPart);
    assert_eq!(limits("0").verdict(1e-9), NotReproduced);
    assert_eq!(["", "1 or 2", "> 1"].map(Limits::read), [None; 3]);
}

#[test]
fn one_of_several_equal_designs_counts_in_part() {
    let optimum = Optimum::read("(0.1, 0.1, 60°); in part (any, 0 to 0.2, any) or among equals");
    let optimum = optimum.expect("designs");
    let (printed, other) = (design(0.1, 0.1, 60.0), design(0.1, 1.0, 75.0));
    let fitting = design(1.0, 0.2, 0.0);
    assert_eq!(optimum.verdict(&[printed]), Reproduced);
    assert_eq!(optimum.verdict(&[printed, other]), InPart);
    assert_eq!(optimum.verdict(&[fitting]), InPart);
    assert_eq!(optimum.verdict(&[fitting, other]), NotReproduced);
    assert_eq!(optimum.verdict(&[]), NotReproduced);
}

#[test]
fn the_best_coverage_may_be_shared_with_a_shorter_scale_but_not_with_another_slant() {
    let covering = |length, slant, coverage| MeasuredDesign {
        coverage: Some(coverage),
        ..design(0.1, length, slant)
    };
    let shared = [covering(0.9, 45.0, 0.9), covering(1.0, 45.0, 0.9), covering(1.0, 75.0, 0.8)];
    assert_eq!(on("C02", &designs(shared)), Reproduced);
    let longest_is_worse = [covering(0.9, 45.0, 0.9), covering(1.0, 45.0, 0.8)];
    assert_eq!(on("C02", &designs(longest_is_worse)), InPart);
    let steeper_is_better = [covering(0.9, 75.0, 0.95), covering(1.0, 45.0, 0.9)];
    assert_eq!(on("C02", &designs(steeper_is_better)), NotReproduced);
}

/// Returns a curve with first contact at `[u*, F*]`, and the slope `slope` from there to its end.
fn curve(design: MeasuredDesign, contact: [f64; 2], slope: f64) -> PunctureCurve {
    let [displacement, force] = contact;
    let force = force + slope * (0.7 - displacement);
    let end = CurveEnd { displacement: 0.7, force, ..CurveEnd::default() };
    PunctureCurve { design, contact: Some(contact), end: Some(end), ..PunctureCurve::default() }
}

#[test]
fn curves_have_mean_slopes_before_and_after_contact() {
    let curve = curve(MeasuredDesign::default(), [0.2, 0.1], 3.0);
    assert_eq!(curve.slope_before_contact(), Some(0.5));
    assert!(curve.slope_after_contact().is_some_and(|slope| (slope - 3.0).abs() < 1e-12));
    assert_eq!(PunctureCurve { contact: None, ..curve }.slope_after_contact(), None);
    assert_eq!(PunctureCurve { end: None, ..curve }.slope_after_contact(), None);
}

#[test]
fn stiffness_must_rise_with_the_slant_and_significantly() {
    let by_slant = |slopes: [f64; 3]| Evidence {
        by_slant: [0.0, 45.0, 75.0]
            .iter()
            .zip(slopes)
            .map(|(slant, slope)| curve(design(0.1, 1.0, *slant), [0.1, 0.1], slope))
            .collect(),
        ..Evidence::default()
    };
    assert_eq!(on("C07", &by_slant([1.0, 1.5, 2.5])), Reproduced);
    assert_eq!(on("C07", &by_slant([1.0, 1.1, 1.2])), InPart);
    assert_eq!(on("C07", &by_slant([1.0, 0.9, 2.5])), InPart);
    assert_eq!(on("C07", &by_slant([1.0, 0.9, 1.2])), NotReproduced);
}

#[test]
fn the_claim_on_short_scales_also_requires_less_tilt() {
    let by_length = |tilts: [f64; 3]| Evidence {
        by_length: [0.1, 0.5, 1.0]
            .iter()
            .zip(tilts)
            .map(|(length, tilt_deg)| {
                let mut curve = curve(design(0.1, *length, 45.0), [0.1, 0.1], 1.0 / length);
                let penetration = 0.1 / length;
                curve.end = curve.end.map(|end| CurveEnd { tilt_deg, penetration, ..end });
                PunctureCurve { initial_slope: Some(2.0 - length), ..curve }
            })
            .collect(),
        ..Evidence::default()
    };
    assert_eq!(on("C09", &by_length([5.0, 6.0, 7.0])), Reproduced);
    assert_eq!(on("C09", &by_length([7.0, 6.0, 5.0])), InPart);
}

#[test]
fn rows_without_contact_count_as_latest_contact() {
    let by_gap = |stiffest: f64, contacts: [Option<f64>; 4]| Evidence {
        by_gap: [0.1, 0.2, 0.3, 0.4]
            .iter()
            .zip(contacts)
            .enumerate()
            .map(|(i, (gap, contact))| PunctureCurve {
                contact: contact.map(|u| [u, u]),
                initial_slope: Some(if i == 0 { 1.0 } else { stiffest }),
                ..curve(design(*gap, 0.5, 45.0), [contact.unwrap_or_default(); 2], 2.0)
            })
            .collect(),
        ..Evidence::default()
    };
    let later = [Some(0.1), Some(0.2), Some(0.3), None];
    assert_eq!(on("C10", &by_gap(1.05, later)), Reproduced);
    assert_eq!(on("C10", &by_gap(1.2, later)), InPart);
    let never_in_between = [Some(0.1), None, Some(0.3), None];
    assert_eq!(on("C10", &by_gap(1.05, never_in_between)), InPart);
}

#[test]
fn steps_without_a_value_count_against_a_trend() {
    let line = |values: [Option<f64>; 5]| {
        let gaps = [0.1, 0.2, 0.3, 0.4, 0.5];
        let along = gaps.iter().zip(values);
        designs(along.map(|(gap, critical_force)| MeasuredDesign {
            critical_force,
            ..design(*gap, 1.0, 0.0)
        }))
    };
    let [five, four, three, two, one] = [5.0, 4.0, 3.0, 2.0, 1.0].map(Some);
    assert_eq!(on("C11", &line([five, four, three, two, one])), Reproduced);
    assert_eq!(on("C11", &line([five, four, three, two, None])), InPart);
    assert_eq!(on("C11", &line([five, four, None, two, one])), NotReproduced);
    assert_eq!(on("C11", &line([one, two, three, four, five])), NotReproduced);
}

/// Returns designs with two gaps, lengths from 0.025 and two slants.
///
/// `value` sets the measures.
fn grid(value: impl Fn(&mut MeasuredDesign)) -> Evidence {
    let gaps = [0.1, 0.2].into_iter();
    let all = gaps.flat_map(|gap| [0.025, 0.05, 0.1, 0.2].map(move |length| (gap, length)));
    let all = all.flat_map(|(gap, length)| [0.0, 75.0].map(|slant| design(gap, length, slant)));
    designs(all.map(|mut design| {
        value(&mut design);
        design
    }))
}

#[test]
fn stiffness_claims_are_reproduced_in_part_with_one_of_two_definitions() {
    let force = |d: &MeasuredDesign| d.slant + 1.0 - d.gap - d.length;
    let both = grid(|d| {
        d.critical_force = Some(force(d));
        d.max_stiffness = Some(force(d));
        d.initial_stiffness = Some(force(d));
    });
    let largest_only = grid(|d| {
        d.critical_force = Some(force(d));
        d.max_stiffness = Some(force(d));
        d.initial_stiffness = Some(100.0 - force(d));
    });
    for id in ["C14", "C15", "C16"] {
        assert_eq!(on(id, &both), Reproduced, "{id}");
    }
    for id in ["C14", "C15"] {
        assert_eq!(on(id, &largest_only), InPart, "{id}");
    }
}

#[test]
fn the_slant_must_have_the_largest_effect_among_short_scales_too() {
    let with_short_scales = |effect: f64| {
        grid(move |d| {
            let short = if d.length < 0.1 { effect } else { 1.0 };
            let value = Some(short * (1.0 + d.slant));
            (d.critical_force, d.max_stiffness, d.initial_stiffness) = (value, value, value);
        })
    };
    assert_eq!(on("C16", &with_short_scales(1.0)), Reproduced);
    assert_eq!(on("C16", &with_short_scales(1e-6)), InPart);
}

#[test]
fn claims_of_about_eight_scales_have_tolerances() {
    let domino = |carrying, touching| {
        let row = LoadedRow { carrying, touching, ..LoadedRow::default() };
        Evidence { loaded: Some([row; 2]), ..Evidence::default() }
    };
    assert_eq!(on("C18", &domino(7, 9)), Reproduced);
    assert_eq!(on("C18", &domino(6, 9)), InPart);
    assert_eq!(on("C18", &domino(5, 11)), NotReproduced);
    assert_eq!(on("C17", &domino(1, 0)), Reproduced);
    assert_eq!(on("C17", &domino(0, 0)), NotReproduced);
}

#[test]
fn slanted_scales_soften_and_unslanted_ones_do_not() {
    let strips = |ratios: [f64; 3], short| Evidence {
        short_strip: Some(BentStrip { softening: Some(short), ..BentStrip::default() }),
        strips: [0.0, 30.0, 75.0]
            .iter()
            .zip(ratios)
            .map(|(slant, ratio)| BentStrip {
                slant: *slant,
                softening: Some(ratio),
                ..BentStrip::default()
            })
            .collect(),
        ..Evidence::default()
    };
    assert_eq!(on("C20", &strips([1.0, 0.5, 0.5], 0.95)), Reproduced);
    assert_eq!(on("C20", &strips([1.0, 0.5, 0.5], 0.24)), InPart);
    assert_eq!(on("C20", &strips([0.24, 0.5, 0.5], 0.24)), InPart);
    assert_eq!(on("C20", &strips([0.24, 1.0, 0.5], 0.24)), NotReproduced);
}

#[test]
fn a_loss_of_compliance_near_three_orders_of_magnitude_is_reproduced() {
    let loss = |loss: f64| {
        let touching = MeasuredDesign {
            initial_compliance: Some(0.5),
            compliance: Some(0.5 / loss),
            bends_to_contact: true,
            ..design(0.1, 1.0, 75.0)
        };
        // The figures do not include this length.
        let shorter = MeasuredDesign { length: 0.05, compliance: Some(1e-9), ..touching };
        designs([touching, shorter])
    };
    for (by, expected) in [
        (1e3, Reproduced),
        (5e3, InPart),
        (150.0, InPart),
        (16820.0, NotReproduced),
        (50.0, NotReproduced),
    ] {
        assert_eq!(on("C21", &loss(by)), expected, "{by}");
    }
}

#[test]
fn only_designs_that_touch_count_as_the_most_compliant() {
    let compliant = |gap, slant, compliance, bends_to_contact| MeasuredDesign {
        compliance: Some(compliance),
        bends_to_contact,
        ..design(gap, 0.1, slant)
    };
    let free = [compliant(1.0, 0.0, 0.9, false), compliant(1.0, 30.0, 0.9, false)];
    let as_printed = [compliant(0.1, 0.0, 0.1, true), compliant(0.1, 30.0, 0.1, true)];
    let otherwise = [compliant(0.2, 0.0, 0.2, true), compliant(0.2, 30.0, 0.2, true)];
    assert_eq!(on("C22", &designs(free.into_iter().chain(as_printed))), Reproduced);
    assert_eq!(on("C22", &designs([as_printed[0], as_printed[1], otherwise[1]])), InPart);
    assert_eq!(on("C22", &designs(free.into_iter().chain(otherwise))), NotReproduced);
    assert_eq!(on("C22", &designs(free)), NotReproduced);
}

#[test]
fn the_most_flexible_slant_is_60_only_if_75_is_not_as_good() {
    let flexible = |slant, compliance| MeasuredDesign {
        coverage: Some(0.2),
        compliance: Some(compliance),
        ..design(1.0, 0.025, slant)
    };
    let exposed = MeasuredDesign { coverage: Some(0.0), ..flexible(0.0, 2.0) };
    let with = |other| designs([flexible(60.0, 0.9), flexible(75.0, other), exposed]);
    assert_eq!(on("C26", &with(0.8)), Reproduced);
    // Both compliances are equal up to round-off, which may have either sign.
    assert_eq!(on("C26", &with(0.9 - 1e-10)), InPart);
    assert_eq!(on("C26", &with(0.9 + 1e-10)), InPart);
    assert_eq!(on("C26", &designs([flexible(45.0, 0.9), flexible(60.0, 0.8)])), NotReproduced);
}

#[test]
fn the_claim_on_weights_uses_the_share_of_the_printed_design() {
    let balanced = |best: MeasuredDesign, share_of_printed| Evidence {
        balanced: Some(Balanced { best, fitness: 0.1, share: 90.0, share_of_printed }),
        ..Evidence::default()
    };
    let (printed, ours) = (design(0.7, 0.1, 60.0), design(0.1, 0.2, 60.0));
    assert_eq!(on("C28", &balanced(printed, 90.0)), Reproduced);
    assert_eq!(on("C28", &balanced(design(0.6, 0.2, 75.0), 0.0)), InPart);
    assert_eq!(on("C28", &balanced(ours, 0.0)), NotReproduced);
    assert_eq!(on("C29", &balanced(ours, 0.0)), NotReproduced);
    assert_eq!(on("C29", &balanced(printed, 25.0)), Reproduced);
}

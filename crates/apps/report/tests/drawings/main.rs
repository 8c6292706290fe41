//! Drawings show the solved values and are reproducible.

mod labels;
mod overlap;
mod page;

use report::{DesignCurves, drawings};
use skin::puncture::{At, Needle, Puncture, PunctureParameters, RowSnapshot, snapshots};
use skin::{Base, Common, Design};
use substrate::Springs;
use sweep::{Case, Sweep};

/// Returns a design with contacts before the critical tilt.
fn design(slant_deg: f64) -> Design {
    Design { gap: 0.1, length: 1.0, slant_deg, base: Base::L, width: 1.0 }
}

/// Solves a puncture with the contact modulus `modulus`, relative to the modulus of the substrate.
///
/// A soft contact (a small `modulus`) lets scales overlap visibly. Returns the states at a
/// displacement of 0.15 `t`, at a tilt of 10° and at `F*` = 0.05.
fn punctured(design: &Design, modulus: f64) -> Vec<RowSnapshot> {
    let springs: Springs = substrate::calibrate(&design.footprint(0.5).expect("a valid footprint"))
        .expect("springs of the footprint");
    let parameters = PunctureParameters {
        contact_modulus_over_substrate: modulus,
        scales: skin::puncture::RowLength::Scales(9),
        ..PunctureParameters::default()
    };
    let at = [At::Displacement(0.15), At::Tilt(10.0), At::Force(0.05)];
    let solved =
        snapshots(design, &springs, &Common::default(), &parameters, &at).expect("a valid design");
    solved.at.into_iter().map(|state| state.expect("the path reaches this state")).collect()
}

fn svg(design: &Design, states: &[RowSnapshot]) -> String {
    drawn(&case(design, "", ""), states)
}

fn drawn(case: &Case, states: &[RowSnapshot]) -> String {
    drawings::PunctureDrawing { name: "test", case, states }.svg().expect("a drawing")
}

/// Returns the case of a design with these entries of `[puncture]` and `[material]`.
fn case(design: &Design, puncture: &str, material: &str) -> Case {
    let text = format!("name = 'x'\n[puncture]\n{puncture}\n[material]\n{material}");
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid definition");
    Case { design: *design, ..sweep.grid().case(0) }
}

/// Solves the puncture of a case.
fn solved_puncture(case: &Case) -> Puncture {
    let springs = substrate::calibrate(&case.footprint().expect("a valid footprint"))
        .expect("springs of the footprint");
    skin::puncture::solve(&case.design, &springs, &case.common, &case.punctured())
        .expect("a valid design")
}

/// With a material, captions, axes and titles must be in mm and N, like the scale bar.
#[test]
fn drawings_and_curves_of_a_material_are_in_millimetres_and_newtons() {
    let design = design(60.0);
    let material = "thickness_mm = 2\nsubstrate_modulus_MPa = 0.75\nmembrane_modulus_MPa = 3";
    let case = case(&design, "", material);
    let states = punctured(&design, 9677.0);
    let svg = drawings::PunctureDrawing { name: "x", case: &case, states: &states[..1] }.svg();
    let tags = ["<tspan font-style=\"italic\">", "<tspan>", "</tspan>"];
    let text = tags.iter().fold(svg.expect("a drawing"), |text, tag| text.replace(tag, ""));
    // 0.15 t is 0.3 mm, and E_s/(1 − ν²) L t is 4 N.
    let newtons = format!("u = 0.300 mm,  F = {:.3} N", 4.0 * states[0].force);
    assert!(text.contains(&newtons), "{newtons} in {text}");
    assert!(text.contains("d = 0.2 mm, L = 2 mm, t = 2 mm, α = 60°"), "{text}");

    let puncture = solved_puncture(&case);
    let flexure =
        skin::flexure::solve(&design, &case.common, &case.flexure).expect("a valid design");
    let curves = DesignCurves {
        number: "1".to_owned(),
        case: &case,
        puncture: Some(&puncture),
        flexure: Some(&flexure),
        on_bodies: &[],
        limits: &[],
    };
    let figures = report::curves("x", std::slice::from_ref(&curves), None, report::Paper::WIDE);
    assert_eq!(figures.len(), 4);
    for figure in &figures {
        let is_physical = ["N<", "N mm", "mJ"].iter().any(|unit| figure.svg.contains(unit));
        assert!(is_physical && !figure.svg.contains("dimensionless"), "{}", figure.name);
    }
    // If one of two designs has no material, the curves of both designs are dimensionless.
    let plain = Case { material: sweep::Material::default(), ..case };
    let both = [curves.clone(), DesignCurves { case: &plain, ..curves }];
    for figure in report::curves("x", &both, None, report::Paper::WIDE) {
        assert!(figure.svg.contains("dimensionless"), "{}", figure.name);
    }

    // The work of the load in N mm equals the stored energy in mJ.
    let [mm, newton, energy] = results::puncture_units(&case).expect("units");
    let work: f64 = puncture
        .path
        .windows(2)
        .map(|ends| {
            let [a, b] = [&ends[0], &ends[1]];
            0.5 * (a.force + b.force) * newton * (b.displacement - a.displacement) * mm
        })
        .sum();
    let end = puncture.path.last().expect("a last point");
    let stored = (end.substrate_energy + end.contact_energy) * energy;
    assert!((work / stored - 1.0).abs() < 1e-2, "{work} {stored}");
}

/// A triangle on the curve marks the passage of a guided needle, and a note explains it.
#[test]
fn the_passage_of_a_guided_needle_is_marked_on_the_curve() {
    let marks = ["guided", "free"].map(|needle| {
        let case = case(&design(75.0), &format!("needle = '{needle}'"), "");
        let (number, puncture) = ("1".to_owned(), solved_puncture(&case));
        let of = DesignCurves {
            number,
            case: &case,
            puncture: Some(&puncture),
            flexure: None,
            on_bodies: &[],
            limits: &[],
        };
        let svg = report::curves("x", &[of], None, report::Paper::WIDE).remove(0).svg;
        [svg.matches("class=\"passing\"").count(), svg.matches("▼ passing").count()]
    });
    assert_eq!(marks, [[1, 1], [0, 0]]);
}

/// With friction, slipping contacts have rings, and sticking contacts have discs.
///
/// The caption states the number of all contacts and of slipping contacts.
#[test]
fn slipping_contacts_are_drawn_as_rings() {
    let design = design(60.0);
    let springs: Springs = substrate::calibrate(&design.footprint(0.5).expect("a valid footprint"))
        .expect("springs of the footprint");
    let common = Common { friction: 0.2, ..Common::default() };
    let parameters = PunctureParameters::default();
    let solved = snapshots(&design, &springs, &common, &parameters, &[At::Tilt(10.0)]);
    let state = solved.expect("a valid design").at.remove(0).expect("the path reaches this state");
    let slip = state.contacts.iter().filter(|contact| contact.slips == Some(true)).count();
    let stick = state.contacts.iter().filter(|contact| contact.slips == Some(false)).count();
    assert!(slip > 0 && stick > 0 && slip + stick == state.contacts.len());
    let drawn = svg(&design, std::slice::from_ref(&state));
    assert_eq!(drawn.matches("fill-opacity=\"0.22\"").count(), stick);
    assert!(drawn.contains(&format!("{} contacts, {slip} slip (rings)", slip + stick)));
}

/// A guided needle has the same horizontal position in all panels; the ring moves with the scale.
#[test]
fn a_guided_needle_keeps_its_horizontal_position() {
    let design = design(45.0);
    let springs: Springs = substrate::calibrate(&design.footprint(0.5).expect("a valid footprint"))
        .expect("springs of the footprint");
    let needle = Needle::Guided { friction: 0.3 };
    let parameters = PunctureParameters { needle, ..PunctureParameters::default() };
    let at = [At::Displacement(0.05), At::Displacement(0.1)];
    let solved =
        snapshots(&design, &springs, &Common::default(), &parameters, &at).expect("a valid design");
    let states: Vec<_> =
        solved.at.into_iter().map(|state| state.expect("the path reaches this state")).collect();
    let text = svg(&design, &states);
    // The first value of the attribute `x1` or `cx` in each group `load`.
    let [needles, rings] = ["x1", "cx"].map(|name| -> Vec<f64> {
        let loads = text.split("class=\"load\"").skip(1);
        let numbers =
            loads.filter_map(|load| load.split(&format!(" {name}=\"")).nth(1).map(str::to_owned));
        numbers
            .map(|rest| {
                rest.split('"').next().expect("a closing quote").parse().expect("a number of px")
            })
            .collect()
    });
    assert_eq!((needles.len(), rings.len()), (2, 2), "{text}");
    assert_eq!(needles[0], needles[1]);
    assert!(rings[0] > needles[0] + 1.0 && rings[1] > rings[0], "{rings:?} {needles:?}");
    assert_eq!(text.matches("○ first contact of the needle").count(), 2);
    assert!(!svg(&design, &punctured(&design, 9677.0)).contains("set-down"));
}

/// A round tip between two scales rests on both corners.
///
/// The lowest point of the tip is below the tops of the scales.
#[test]
fn a_round_tip_touches_both_corners() {
    let design = Design { gap: 0.6, ..design(0.0) };
    let springs: Springs = substrate::calibrate(&design.footprint(0.5).expect("a valid footprint"))
        .expect("springs of the footprint");
    let parameters = PunctureParameters {
        needle: Needle::Guided { friction: 0.0 },
        needle_radius: Some(0.5),
        // The needle is in the middle of the gap.
        load_position: 1.3 / design.length,
        ..PunctureParameters::default()
    };
    let at = [At::Displacement(0.05)];
    let solved = snapshots(&design, &springs, &Common::default(), &parameters, &at);
    let state = solved.expect("a valid design").at.remove(0).expect("the path reaches this state");
    // At rest the centre of the tip is 0.4 above the corners and 0.3 beside them.
    let lowest = 1.0 + 0.4 - 0.5 - 0.05;
    let [x, y] = state.tip.expect("a guided tip");
    assert!((x - (0.5 * design.length + 0.3)).abs() < 1e-12 && (y - lowest).abs() < 1e-12);
    // The tip starts between two scales, so no ring marks a first contact.
    let between = format!("load_position = {}", parameters.load_position);
    let needle = format!("needle = 'guided'\nneedle_radius_over_t = 0.5\n{between}");
    let text = drawn(&case(&design, &needle, ""), &[state]);
    assert!(text.contains("class=\"tip\"") && !text.contains("first contact"), "{text}");
}

/// Returns the number of outlines in each group with this class.
fn outlines(svg: &str, class: &str) -> Vec<usize> {
    let start = format!("<g class=\"{class}\"");
    let groups = svg.split(&start).skip(1).filter_map(|group| group.split("</g>").next());
    groups.map(|group| group.matches("<path").count()).collect()
}

/// A row of `n` scales is drawn with `n` scales at rest, `n` punctured, and `n` dashed outlines.
#[test]
fn a_short_row_is_drawn_without_scales_beyond_its_ends() {
    for scales in [1, 2, 3, 4, 5] {
        let design = design(60.0);
        let case = case(&design, &format!("scales = {scales}"), "");
        let springs = substrate::calibrate(&case.footprint().expect("a valid footprint"))
            .expect("springs of the footprint");
        let at = [At::Displacement(0.05)];
        let solved = snapshots(&design, &springs, &case.common, &case.punctured(), &at);
        let state =
            solved.expect("a valid design").at.remove(0).expect("the path reaches this state");
        assert_eq!(state.scales.len(), scales);
        let svg = drawn(&case, &[state]);
        assert_eq!(outlines(&svg, "scales"), [scales, scales]);
        assert_eq!(outlines(&svg, "at-rest"), [scales]);
    }
}

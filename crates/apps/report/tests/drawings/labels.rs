//! Labels of figures are inside the sheet, do not overlap, and are legible on narrow paper.

use std::fmt::Write as _;

use ranking::{Ranking, TetrahedralGrid};
use report::{
    DesignCurves, Designs, FailureLimit, FitPanel, Histogram, MapRequest, MeasuredCurves, Paper,
    figures, map,
};
use results::Results;
use skin::puncture::FailureMode;

/// A text and its box: left, top, right and bottom edge, px.
type TextBox = (String, [f64; 4]);

fn attribute(element: &str, name: &str) -> Option<f64> {
    let start = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[start..].split('"').next()?.parse().ok()
}

/// Returns all texts with their boxes, estimated from the mean width of a letter.
fn texts(svg: &str) -> Vec<TextBox> {
    svg.split("<text")
        .skip(1)
        .filter_map(|part| {
            let (opening, rest) = part.split_once('>')?;
            let (body, _) = rest.split_once("</text>")?;
            let inside = body.split('<').filter_map(|piece| piece.rsplit('>').next());
            let words: String =
                inside.collect::<String>().replace("&lt;", "<").replace("&gt;", ">");
            let [x, y, size] = ["x", "y", "font-size"].map(|name| attribute(opening, name));
            let (x, y, size) = (x?, y?, size?);
            let width = 0.5 * size * words.chars().count() as f64;
            let before = match opening {
                _ if opening.contains("\"middle\"") => 0.5 * width,
                _ if opening.contains("\"end\"") => width,
                _ => 0.0,
            };
            let is_upright = opening.contains("rotate(-90");
            let area = if is_upright {
                [x - 0.7 * size, y - width + before, x, y + before]
            } else {
                [x - before, y - 0.7 * size, x - before + width, y]
            };
            (!words.is_empty()).then_some((words, area))
        })
        .collect()
}

/// Asserts that all texts are inside the sheet and do not overlap.
fn assert_clear(name: &str, svg: &str) {
    let [width, height] = ["width", "height"].map(|side| attribute(svg, side).expect("a size"));
    let texts = texts(svg);
    assert!(texts.len() > 3, "{name}");
    for (k, (words, [left, top, right, bottom])) in texts.iter().enumerate() {
        let is_inside = *left > 0.0 && *top > 0.0 && *right < width && *bottom < height;
        assert!(is_inside, "{name}: {words:?} leaves the sheet of {width} by {height} px");
        for (other, area) in &texts[..k] {
            let is_apart =
                *left > area[2] || *right < area[0] || *top > area[3] || *bottom < area[1];
            assert!(is_apart, "{name}: {words:?} overlaps {other:?}");
        }
    }
}

/// Returns a table of designs with invented values, for ten gaps, ten lengths and six slants.
///
/// If `is_physical`, it also has columns in mm and N, for a thickness of 2 mm.
fn table(is_physical: bool) -> String {
    let mut text =
        "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,compliance,\
         flexure_contact,max_stiffness,secant_stiffness,fold_force,first_failure"
            .to_owned();
    let units = ",gap_mm,length_mm,critical_force_N,penetration_mm,flexural_rigidity_N_mm2,max_stiffness_N_mm";
    text += if is_physical { units } else { "" };
    let mut number = 0;
    for i in 1..=10 {
        for length in (1..=10).map(|j| 0.1 * f64::from(j)) {
            for slant in [0.0, 15.0, 30.0, 45.0, 60.0, 75.0] {
                number += 1;
                let gap = 0.1 * f64::from(i);
                let [force, depth] = [0.01 * (1.0 + slant) * length / gap, 0.3 * length * gap];
                let (coverage, soft) = ((slant / 100.0) * length / (1.0 + gap), gap / (1.0 + gap));
                let fold = if slant > 70.0 { "1" } else { "" };
                let _ = write!(
                    text,
                    "\n{number:04},{gap:.1},{length:.1},{slant},{coverage},{force},{depth},{soft},yes,{force},\
                     {force},{fold},tilt"
                );
                if is_physical {
                    let _ = write!(
                        text,
                        ",{:.1},{:.1},{},{},{},{force}",
                        2.0 * gap,
                        2.0 * length,
                        3.0 * force,
                        2.0 * depth,
                        soft.recip()
                    );
                }
            }
        }
    }
    text
}

fn results(is_physical: bool) -> Results {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("designs.csv"), table(is_physical)).expect("a file");
    Results::read(folder.path()).expect("a table")
}

/// Returns all figures of the table, and a map, for each paper.
fn all<const N: usize>(is_physical: bool, papers: [Paper; N]) -> [Vec<report::Figure>; N] {
    let results = results(is_physical);
    let ranking =
        Ranking::new(&results, TetrahedralGrid::default()).expect("the table has designs to rank");
    let designs = Designs::of(&results);
    let of = if is_physical { "critical_force_N" } else { "critical_force" };
    papers.map(|paper| {
        let mut all = figures("a sweep", &designs, Some((&designs, &ranking)), paper);
        let request = MapRequest {
            x: "gap_over_t".into(),
            y: "slant_deg".into(),
            of: of.into(),
            at: vec![],
            paper,
        };
        all.push(map("a sweep", &designs, &request).expect("a map"));
        all
    })
}

#[test]
fn labels_are_inside_the_sheet_and_do_not_overlap() {
    let widths = [None, Some(85.0), Some(120.0), Some(170.0)];
    for is_physical in [false, true] {
        let papers = widths.map(|width| width.map_or(Paper::WIDE, Paper::of_width));
        for (width, figures) in widths.into_iter().zip(all(is_physical, papers)) {
            for figure in figures {
                assert_clear(&format!("{}, {width:?} mm", figure.name), &figure.svg);
            }
        }
    }
}

#[test]
fn figures_for_a_journal_column_have_fewer_panels_and_legible_letters() {
    let [wide, narrow] = all(false, [Paper::WIDE, Paper::of_width(85.0)]);
    for (wide, narrow) in wide.iter().zip(&narrow) {
        let points = report::smallest_letters(&narrow.svg, 85.0).expect("the figure has text");
        assert!(points >= 6.0, "{}: letters of {points} pt", narrow.name);
        let height = attribute(&narrow.svg, "height").expect("a height");
        assert!(height < 3.2 * 85.0 * 96.0 / 25.4, "{}", narrow.name);
        assert!(wide.omitted.is_none());
    }
    let panels = [&wide[0], &narrow[0]].map(|f| f.svg.matches("class=\"frame\"").count());
    assert_eq!(panels, [10, 4]);
    let omitted = narrow[0].omitted.as_deref();
    assert_eq!(
        omitted,
        Some("shows 4 of 10 values of gap_over_t; choose with --at, e.g. --at gap_over_t=0.1")
    );
}

#[test]
fn each_selected_value_has_a_panel_on_narrow_paper() {
    let designs = Designs::of(&results(false));
    let at = ["0.1", "0.50"].map(|gap| ("gap_over_t".to_owned(), gap.to_owned()));
    let chosen = designs.at(&at).expect("designs");
    assert_eq!(chosen.count(), 2 * 60);
    let all = figures("x", &chosen, None, Paper::of_width(85.0));
    assert_eq!(all[0].svg.matches("class=\"frame\"").count(), 2);
    assert_eq!(all[0].omitted, None);
    let none = [("gap_over_t".to_owned(), "7".to_owned())];
    assert!(designs.at(&none).is_err());
}

/// Returns the texts, separated by `|`, of the first figure with a name that starts with `name`.
fn words(all: &[report::Figure], name: &str) -> String {
    let figure = all.iter().find(|figure| figure.name.starts_with(name)).expect("a figure");
    texts(&figure.svg).into_iter().map(|(words, _)| words).collect::<Vec<_>>().join("|")
}

#[test]
fn figures_of_a_material_have_axes_in_millimetres() {
    let [all] = all(true, [Paper::WIDE]);
    let forces = words(&all, "critical-force");
    assert!(forces.contains("length L (mm)") && !forces.contains("dimensionless"), "{forces}");
    assert!(forces.contains("d = 0.2 mm"), "{forces}");
    let fronts = words(&all, "pareto");
    assert!(fronts.contains("critical force (N)") && fronts.contains("penetration (mm)"));
    assert!(!fronts.contains("resistance"), "{fronts}");
    assert!(words(&all, "coverage").contains("gap d (mm)"));
    assert!(words(&all, "best-designs").contains("d = 0.2 mm"));
}

#[test]
fn contours_are_labelled_with_their_values() {
    let [mut all] = all(false, [Paper::WIDE]);
    let svg = &all.pop().expect("a map").svg;
    let contours: Vec<&str> = svg.split("class=\"contours\"").skip(1).collect();
    assert_eq!(contours.len(), 10, "a map for each aspect ratio");
    let inside = contours[0].split("</g>").next().expect("a group");
    let values: Vec<_> = texts(inside).into_iter().map(|(words, _)| words).collect();
    assert!(!values.is_empty());
    // Each contour is a dark path on a light path.
    assert!(inside.matches("<path").count() < 24 && !inside.contains("<line"), "{inside}");
}

#[test]
fn histograms_name_the_measure_and_its_unit_once() {
    for (measure, label) in [
        ("gap_mm", "gap d (mm)"),
        ("critical_force_N", "critical force (N)"),
        ("tissue_pressure_max_kPa", "tissue pressure max (kPa)"),
    ] {
        let values: Vec<f64> = (0..50).map(|k| f64::from(k).sqrt()).collect();
        let bounds = [("required ≥ 4".to_owned(), 4.0), ("required ≤ 5".to_owned(), 5.0)];
        let histogram =
            Histogram { name: "x", measure, values: &values, nominal: Some(4.1), bounds: &bounds };
        let svg = histogram.svg();
        assert_clear(measure, &svg);
        assert!(texts(&svg).iter().any(|(words, _)| words == label), "{measure}");
    }
}

#[test]
fn labels_of_fits_are_inside_the_sheet_and_do_not_overlap() {
    let points: Vec<[f64; 3]> = (0..30).map(f64::from).map(|x| [x, x, x + 0.1]).collect();
    let axes = ["displacement, mm".to_owned(), "force, N".to_owned()];
    let panel = FitPanel { file: "a.csv", axes: &axes, points: &points, noise: 0.2 };
    assert_clear("residuals", &report::fit_figure("x", &[panel, panel]));
}

#[test]
fn measured_curves_are_thin_black_lines() {
    let case = super::case(&super::design(60.0), "", "");
    let puncture = super::solved_puncture(&case);
    let number = "a long label of a design among others, (0001)".to_owned();
    let of = DesignCurves {
        number,
        case: &case,
        puncture: Some(&puncture),
        flexure: None,
        on_bodies: &[],
        limits: &[],
    };
    let curves = vec![("measured.csv".to_owned(), vec![[0.0, 0.0], [0.1, 0.2], [0.2, 0.5]])];
    let measured =
        MeasuredCurves { bending: false, is_physical: false, curves, band: vec![[0.1, 0.2, 0.1]] };
    for paper in [Paper::WIDE, Paper::of_width(85.0)] {
        let figures =
            report::curves("x", &[of.clone(), of.clone(), of.clone()], Some(&measured), paper);
        for figure in &figures {
            assert_clear(&figure.name, &figure.svg);
        }
        let curve = figures[0].svg.split("class=\"measured\"").nth(1).expect("a measured curve");
        let curve = curve.split("</g>").next().expect("a group");
        assert!(curve.contains("stroke=\"#000\" stroke-width=\"0.9\""), "{curve}");
        assert!(!curve.contains("<circle"));
    }
}

/// The failures of all modes lie at one point, at neighbouring points, or at points along the path.
#[test]
fn names_of_limits_do_not_overlap() {
    let case = super::case(&super::design(60.0), "", "");
    let puncture = super::solved_puncture(&case);
    let last = puncture.path.len() - 1;
    for (from, step) in [(last, 0), (1, 1), (last - 7, 1), (2, last / 9)] {
        let limits: Vec<_> = FailureMode::ALL
            .into_iter()
            .enumerate()
            .map(|(k, mode)| {
                let point = &puncture.path[from + k * step];
                let displacement = (mode != FailureMode::Across).then_some(point.displacement);
                FailureLimit { mode, displacement, force: point.force, is_first: k == 2 }
            })
            .collect();
        let of = DesignCurves {
            number: "1".to_owned(),
            case: &case,
            puncture: Some(&puncture),
            flexure: None,
            on_bodies: &[],
            limits: &limits,
        };
        for paper in [Paper::WIDE, Paper::of_width(85.0)] {
            let svg = report::curves("x", &[of.clone(), of.clone()], None, paper).remove(0).svg;
            assert_clear("limits", &svg);
            let texts = texts(&svg);
            for mode in FailureMode::ALL.map(FailureMode::name) {
                let named = texts.iter().filter(|(words, _)| words.starts_with(mode)).count();
                assert_eq!(named, 2, "{mode} {from} {step}");
            }
            assert_eq!(svg.matches("class=\"limit\"").count(), 14);
            assert_eq!(svg.matches("class=\"level\"").count(), 2);
        }
    }
}

//! Figures and page of a table.

use std::fmt::Write as _;
use std::io::Read as _;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use ranking::{Ranking, TetrahedralGrid};
use report::{Designs, Page, PageDesign, figures, untitled};
use results::Results;

/// A table of 24 designs with made-up values.
fn table() -> String {
    let mut text =
        "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,compliance,\
                    flexure_contact,max_stiffness,secant_stiffness\n"
            .to_owned();
    for k in 0..24_u32 {
        let (gap, length, slant) =
            ([0.1, 0.5][(k / 12) as usize], [0.2, 0.5, 1.0][(k / 4 % 3) as usize], 15 * (k % 4));
        let value = 0.1 * f64::from(k + 1);
        let _ = writeln!(
            text,
            "{:04},{gap},{length},{slant},{},{value},{},{},{},{value},{value}",
            k + 1,
            0.01 * f64::from(k),
            1.0 / value,
            0.5,
            k % 2 == 0
        );
    }
    text
}

/// The results of a run with this table.
fn results(table: &str) -> Results {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("designs.csv"), table).expect("a file");
    Results::read(folder.path()).expect("a table")
}

fn designs() -> Designs {
    Designs::of(&results(&table()))
}

fn page(designs: Designs) -> Page {
    Page {
        name: "a </script> & more".to_owned(),
        version: "1".to_owned(),
        folder: "results/x".to_owned(),
        columns: vec![("-".to_owned(), String::new()); designs.headers().len()],
        designs,
        ..Page::default()
    }
}

#[test]
fn figures_are_named_and_the_same_every_time() {
    let results = results(&table());
    let ranking = Ranking::new(&results, TetrahedralGrid::default()).expect("designs to rank");
    let designs = Designs::of(&results);
    let all = figures("x", &designs, Some(&ranking));
    let names: Vec<_> = all.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "critical-force-by-gap-aspect-slant",
            "penetration-by-gap-aspect-slant",
            "compliance-by-gap-aspect-slant",
            "stiffness-against-critical-force",
            "coverage-maps-by-slant",
            "pareto-fronts-pairwise",
            "best-designs-by-weights-tetrahedron",
        ]
    );
    assert_eq!(all, figures("x", &designs, Some(&ranking)));
}

#[test]
fn what_was_not_measured_has_no_figure() {
    let table =
        "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force\n0001,1,1,0,0,\n";
    let designs = Designs::of(&results(table));
    let names: Vec<_> = figures("x", &designs, None).into_iter().map(|f| f.name).collect();
    assert_eq!(names, ["coverage-maps-by-slant"]);
}

#[test]
fn every_value_of_a_further_axis_has_figures_of_its_own() {
    let mut lines = table().lines().map(str::to_owned).collect::<Vec<_>>();
    for (k, line) in lines.iter_mut().enumerate() {
        line.push_str(if k == 0 { ",width_over_t" } else { [",0.5", ",2"][k % 2] });
    }
    let designs = Designs::of(&results(&lines.join("\n")));
    let all = figures("x", &designs, None);
    let forces = all.iter().filter(|figure| figure.name.starts_with("critical-force"));
    let forces: Vec<_> = forces.collect();
    let names: Vec<_> = forces.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "critical-force-by-gap-aspect-slant-width-over-t-2",
            "critical-force-by-gap-aspect-slant-width-over-t-0.5"
        ]
    );
    // Each has the half of the marks, and says which.
    for (figure, width) in forces.iter().zip(["2", "0.5"]) {
        assert!(figure.svg.contains(&format!("x, b/t = {width}: critical force")));
    }
}

#[test]
fn a_page_is_whole_and_the_same_every_time() {
    let html = page(designs()).html();
    assert_eq!(html, page(designs()).html());
    for place in ["title", "version", "style", "scripts", "data"] {
        assert!(!html.contains(&format!("{{{{{place}}}}}")), "{place} is filled");
    }
    for outside in ["src=\"http", "<link", "@import"] {
        assert!(!html.contains(outside), "{outside}");
    }
    // A name cannot end the script that holds the data.
    assert!(!html.contains("a </script>"));
    // Text that would begin a comment or a script within the script that holds the data.
    let hostile = Page {
        name: "<!--<script>\u{202e}x".to_owned(),
        folder: "a b/<!--".to_owned(),
        ..page(designs())
    };
    let hostile = hostile.html();
    let data = hostile.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next());
    let data = data.expect("a script that holds the data");
    assert!(!data.contains('<') && data.contains("\\u003c!--\\u003cscript"), "{data}");
    assert!(hostile.contains("<title>&lt;!--&lt;script&gt;\\u{202e}x</title>"));
    assert!(data.contains("\"folder\":\"'a b/\\u003c!--'\""), "{data}");
    assert!(!hostile.contains('\u{202e}'));
}

#[test]
fn a_page_of_720_designs_is_below_1_mb() {
    let table = designs();
    let columns = table.headers().iter().map(|header| {
        let cells = (0..720).map(|k| table.text(header, k % 24).to_owned() + "123456789012");
        (header.clone(), cells.collect())
    });
    assert!(page(Designs::new(columns)).html().len() < 1_000_000);
}

#[test]
fn a_page_knows_which_columns_are_numbers() {
    let html = page(designs()).html();
    let numeric = html.split("\"numeric\":[").nth(1).and_then(|rest| rest.split(']').next());
    let numeric = numeric.expect("the columns of numbers");
    for header in designs().headers() {
        assert_eq!(
            numeric.contains(&format!("\"{header}\"")),
            header != "flexure_contact",
            "{header}"
        );
    }
}

/// The figures of a page, unpacked, each with its kind and its choice.
fn figures_of(html: &str) -> Vec<(String, String)> {
    let data = html.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next());
    let data: serde_json::Value = serde_json::from_str(data.expect("data")).expect("JSON");
    let unpacked = |figure: &serde_json::Value| {
        let packed = BASE64_STANDARD.decode(figure["svg"].as_str()?).ok()?;
        let mut svg = String::new();
        flate2::read::DeflateDecoder::new(packed.as_slice()).read_to_string(&mut svg).ok()?;
        Some((format!("{} {}", figure["kind"].as_str()?, figure["choice"].as_str()?), svg))
    };
    let figures = data["figures"].as_array().expect("figures").iter();
    figures.map(|figure| unpacked(figure).expect("a figure")).collect()
}

#[test]
fn the_figures_of_a_page_are_those_of_files() {
    let results = results(&table());
    let ranking = Ranking::new(&results, TetrahedralGrid::default()).expect("designs to rank");
    let files = figures("x", &designs(), Some(&ranking));
    let own = figures_of(&page(designs()).html());
    let kinds = [
        ("critical-force-by-gap-aspect-slant", "critical-force "),
        ("compliance-by-gap-aspect-slant", "compliance "),
        ("stiffness-against-critical-force", "stiffness "),
        ("coverage-maps-by-slant", "coverage "),
        ("pareto-fronts-pairwise", "pareto "),
    ];
    for (name, kind) in kinds {
        let file = files.iter().find(|figure| figure.name == name).expect("a file");
        let (_, svg) = own.iter().find(|(own, _)| own == kind).expect("a figure");
        let drawn = |svg: &str| svg.split_once("</title>").expect("a title").1.to_owned();
        assert!(drawn(svg) == drawn(&untitled(&file.svg)), "{name}");
        assert!(svg.contains("data-design=\"0007\""), "{name}: marks know their designs");
    }
}

#[test]
fn curves_of_solved_designs_stand_in_one_chart() {
    let solved = |number: &str, force| PageDesign {
        number: number.to_owned(),
        puncture: vec![[0.0, 0.0], [0.1, force]],
        flexure: vec![[0.0, 0.0]],
        ..PageDesign::default()
    };
    let solved = vec![solved("0001", 2.0), solved("0002", 0.02)];
    let all = figures_of(&Page { solved, ..page(designs()) }.html());
    for choice in ["curves linear", "curves log"] {
        let (_, svg) = all.iter().find(|(kind, _)| kind == choice).expect("curves");
        assert_eq!(svg.matches("class=\"curve\"").count(), 2, "one point is no curve: {svg}");
        assert!(svg.contains("force") && !svg.contains("moment"));
    }
}

//! Tests of the figures and the page of a table.

use std::fmt::Write as _;
use std::io::Read as _;

use ranking::{CRITERIA, Ranking, TetrahedralGrid};
use report::{Designs, Figure, MapRequest, Page, PageDesign, Paper, figures, map, untitled};
use results::Results;

/// Returns a table of 24 designs with invented values.
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
            if k % 2 == 0 { "yes" } else { "no" }
        );
    }
    text
}

/// Returns the results of a run with this table.
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
        criteria: CRITERIA.to_vec(),
        name: "a </script> & more".to_owned(),
        version: "1".to_owned(),
        folder: "results/x".to_owned(),
        columns: vec![("-".to_owned(), String::new()); designs.headers().len()],
        designs,
        ..Page::default()
    }
}

fn html_of(page: &Page) -> String {
    let mut out = Vec::new();
    page.write(&mut out).expect("writing to memory succeeds");
    String::from_utf8(out).expect("UTF-8 text")
}

#[test]
fn figures_are_named_and_reproducible() {
    let results = results(&table());
    let ranking =
        Ranking::new(&results, TetrahedralGrid::default()).expect("the table has designs to rank");
    let designs = Designs::of(&results);
    let all = figures("x", &designs, Some((&designs, &ranking)), Paper::WIDE);
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
    assert_eq!(all, figures("x", &designs, Some((&designs, &ranking)), Paper::WIDE));
}

/// The page ranks each column in the same direction as `squama rank`.
#[test]
fn the_page_ranks_columns_in_the_same_direction_as_squama_rank() {
    let material = "material.thickness_mm = 1\nmaterial.substrate_modulus_MPa = 0.3\nmaterial.membrane_modulus_MPa = 4.5\n\
                    material.scale_density_kg_m3 = 1200\nimperfection.gap_cv = 0.1";
    let sweep = sweep::Sweep::parse(&format!("name = 'x'\n{material}"), "x.toml", &[])
        .expect("a valid sweep");
    let columns = results::columns::design_columns(&sweep);
    let headers: Vec<_> = columns.iter().map(|column| column.name.to_string()).collect();
    let blank = ",".repeat(headers.len() - 1);
    let designs = Designs::of(&results(&format!("{}\n0001{blank}\n", headers.join(","))));
    let html = html_of(&page(designs));
    let mut directed = 0;
    for name in &headers {
        let plain = name.parse::<ranking::Criterion>().ok().map(|criterion| criterion.goal.key());
        let entry =
            html.split_once(&format!("\"name\":\"{name}\"")).map_or("", |(before, _)| before);
        let goal =
            entry.rsplit_once("\"goal\":").map(|(_, rest)| rest.split(',').next().unwrap_or(""));
        assert_eq!(
            goal,
            Some(plain.map_or("null".to_owned(), |key| format!("\"{key}\"")).as_str()),
            "{name}"
        );
        directed += usize::from(plain.is_some());
    }
    assert!(directed > 12, "{directed} columns have a direction");
}

#[test]
fn columns_without_values_have_no_figure() {
    let table =
        "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force\n0001,1,1,0,0,\n";
    let designs = Designs::of(&results(table));
    let names: Vec<_> =
        figures("x", &designs, None, Paper::WIDE).into_iter().map(|f| f.name).collect();
    assert_eq!(names, ["coverage-maps-by-slant"]);
}

#[test]
fn each_value_of_an_additional_parameter_has_its_own_figures() {
    let mut lines = table().lines().map(str::to_owned).collect::<Vec<_>>();
    for (k, line) in lines.iter_mut().enumerate() {
        line.push_str(if k == 0 { ",width_over_t" } else { [",0.5", ",2"][k % 2] });
    }
    let designs = Designs::of(&results(&lines.join("\n")));
    let all = figures("x", &designs, None, Paper::WIDE);
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
    // Each value of the width has its own figure, with the value in its title.
    for (figure, width) in forces.iter().zip(["2", "0.5"]) {
        assert!(figure.svg.contains(&format!("x, b/t = {width}: critical force")));
    }
}

#[test]
fn pages_are_complete_and_reproducible() {
    let html = html_of(&page(designs()));
    assert_eq!(html, html_of(&page(designs())));
    for place in ["title", "version", "style", "scripts", "data"] {
        assert!(!html.contains(&format!("{{{{{place}}}}}")), "{place} is not filled");
    }
    for outside in ["src=\"http", "<link", "@import"] {
        assert!(!html.contains(outside), "{outside}");
    }
    // A hostile name must not end the script that contains the data.
    assert!(!html.contains("a </script>"));
    // Other text must not open a comment or a script inside the data either.
    let hostile = Page {
        name: "<!--<script>\u{202e}x".to_owned(),
        folder: "a b/<!--".to_owned(),
        ..page(designs())
    };
    let hostile = html_of(&hostile);
    let data = hostile.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next());
    let data = data.expect("a script that contains the data");
    assert!(!data.contains('<') && data.contains("\\u003c!--\\u003cscript"), "{data}");
    assert!(hostile.contains("<title>&lt;!--&lt;script&gt;\\u{202e}x</title>"));
    assert!(data.contains("\"folder\":\"'a b/\\u003c!--'\""), "{data}");
    assert!(!hostile.contains('\u{202e}'));
}

#[test]
fn a_page_of_720_designs_is_below_1_mb() {
    let table = table();
    let (header, rows) = table.split_once('\n').expect("a header");
    let long = rows.replace(',', "123456789012,").repeat(30);
    let designs = Designs::of(&results(&format!("{header}\n{long}")));
    assert_eq!(designs.count(), 720);
    assert!(html_of(&page(designs)).len() < 1_000_000);
}

#[test]
fn the_page_lists_numeric_columns() {
    let html = html_of(&page(designs()));
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

/// Returns for each figure of a page its kind with its variant, and its decompressed SVG.
fn figures_of(html: &str) -> Vec<(String, String)> {
    let data = html.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next());
    let data: serde_json::Value = serde_json::from_str(data.expect("data")).expect("JSON");
    let figures = data["figures"].as_array().expect("figures").iter();
    figures.map(|figure| unpacked(html, figure).expect("a figure")).collect()
}

fn unpacked(html: &str, figure: &serde_json::Value) -> Option<(String, String)> {
    let packed = html.split(&format!("id={}>", figure["svg"])).nth(1)?.split('<').next()?;
    let bits =
        packed.chars().flat_map(|c| (0..7).rev().map(move |k| (u32::from(c) >> k & 1) as u8));
    let bits: Vec<u8> = bits.collect();
    let packed: Vec<u8> = bits
        .chunks_exact(8)
        .map(|eight| eight.iter().fold(0, |byte, bit| byte << 1 | bit))
        .collect();
    let mut svg = String::new();
    flate2::read::DeflateDecoder::new(packed.as_slice()).read_to_string(&mut svg).ok()?;
    Some((format!("{} {}", figure["kind"].as_str()?, figure["choice"].as_str()?), svg))
}

#[test]
fn a_page_has_the_same_figures_as_files() {
    let results = results(&table());
    let ranking =
        Ranking::new(&results, TetrahedralGrid::default()).expect("the table has designs to rank");
    let files = figures("x", &designs(), Some((&designs(), &ranking)), Paper::WIDE);
    let own = figures_of(&html_of(&page(designs())));
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
        let file = untitled(&file.svg);
        let [own, file] = [svg, &file].map(|svg| svg.split_once("</title>").expect("a title").1);
        assert!(own == file, "{name}");
        assert!(svg.contains("data-design=\"0007\""), "{name}: marks state their designs");
    }
}

#[test]
fn curves_of_solved_designs_share_one_chart() {
    let solved = [("0001", 2.0), ("0002", 0.02)].map(|(number, force)| PageDesign {
        number: number.to_owned(),
        puncture: vec![[0.0, 0.0], [0.1, force]],
        flexure: vec![[0.0, 0.0]],
        ..PageDesign::default()
    });
    let solved = Vec::from(solved);
    let all = figures_of(&html_of(&Page { solved, ..page(designs()) }));
    for choice in ["curves linear", "curves log"] {
        let (_, svg) = all.iter().find(|(kind, _)| kind == choice).expect("curves");
        assert_eq!(svg.matches("class=\"curve\"").count(), 2, "one point is no curve: {svg}");
        assert!(svg.contains("force") && !svg.contains("moment"));
        // The smaller curve has its own axis, so that both curves can be shown alone.
        let axes = svg.matches("data-axis=\"y\"").count();
        assert_eq!(axes > 4, choice == "curves linear", "{axes}");
    }
}

/// A column name and its value as a function of the design number.
type Column = (&'static str, fn(u32) -> f64);

/// Returns [`table`] with further columns, computed from the design number.
fn table_with(columns: &[Column]) -> String {
    let own = table();
    let mut lines = own.lines();
    let names = columns.iter().map(|(name, _)| *name);
    let header = lines.next().into_iter().chain(names).collect::<Vec<_>>().join(",");
    let rows = (1..).zip(lines).map(|(k, line)| {
        let cells = columns.iter().map(|(_, value)| value(k).to_string());
        std::iter::once(line.to_owned()).chain(cells).collect::<Vec<_>>().join(",")
    });
    std::iter::once(header).chain(rows).collect::<Vec<_>>().join("\n")
}

/// Returns for each mark of a figure the number of its design, and its y coordinate.
fn marks(svg: &str) -> Vec<(&str, &str)> {
    let uses = svg.split("<use ").filter(|text| text.contains("data-design"));
    uses.filter_map(|text| Some((attribute(text, "data-design")?, attribute(text, "y")?))).collect()
}

fn attribute<'t>(text: &'t str, name: &str) -> Option<&'t str> {
    let start = text.find(&format!("{name}=\""))? + name.len() + 2;
    text[start..].split_once('"').map(|(value, _)| value)
}

fn figure<'a>(all: &'a [report::Figure], name: &str) -> &'a str {
    &all.iter().find(|figure| figure.name.starts_with(name)).expect("a figure").svg
}

#[test]
fn figures_of_random_gaps_show_the_median_and_the_band() {
    let (one, other) = (
        sampled([|k| 0.1 * f64::from(k), |k| 0.2 * f64::from(k), |k| 0.5 * f64::from(k)]),
        // The perfect designs are the same, but their medians differ.
        sampled([|k| 0.1 * f64::from(k), |k| 0.4 * f64::from(k), |k| 0.5 * f64::from(k)]),
    );
    let (one, other) = (figure(&one, "critical-force"), figure(&other, "critical-force"));
    assert_eq!(marks(one).len(), 24);
    assert_ne!(marks(one), marks(other));
    assert_eq!(one.matches("class=\"band\"").count(), 8, "a band for each gap and slant");
    assert!(one.contains("median of critical force") && one.contains("band: 5 % to 95 %"));
    let perfect = figures("x", &designs(), None, Paper::WIDE);
    assert!(!figure(&perfect, "critical-force").contains("class=\"band\""));
    assert!(figure(&sampled([|_| 1.0; 3]), "stiffness").contains("of the perfect designs"));
}

/// Draws designs with quantiles of the critical force, as functions of the row.
fn sampled(quantiles: [fn(u32) -> f64; 3]) -> Vec<Figure> {
    let names = ["critical_force_p05", "critical_force_p50", "critical_force_p95"];
    let columns: Vec<_> = names.into_iter().zip(quantiles).collect();
    figures("x", &Designs::of(&results(&table_with(&columns))), None, Paper::WIDE)
}

#[test]
fn figures_of_a_material_are_in_newtons_and_millimetres() {
    let columns: [Column; 2] =
        [("critical_force_N", |k| 7.0 / f64::from(k)), ("penetration_mm", f64::from)];
    let table = table_with(&columns);
    let all = figures("x", &Designs::of(&results(&table)), None, Paper::WIDE);
    for (name, label) in
        [("critical-force", "critical force (N)"), ("penetration", "penetration (mm)")]
    {
        assert!(figure(&all, name).contains(label), "{name}");
    }
    let plain = figures("x", &designs(), None, Paper::WIDE);
    assert_ne!(marks(figure(&all, "critical-force")), marks(figure(&plain, "critical-force")));
}

#[test]
fn only_measures_affected_by_folds_are_crossed_out() {
    let designs = Designs::of(&results(&table_with(&[
        ("fold_force", |k| f64::from(k)),
        ("bend_radius_mm", |k| f64::from(k)),
    ])));
    assert_eq!(
        [
            "critical_force",
            "penetration",
            "max_stiffness",
            "compliance",
            "bend_radius_mm",
            "coverage"
        ]
        .map(|of| {
            let request = MapRequest {
                x: "gap_over_t".into(),
                y: "slant_deg".into(),
                of: of.into(),
                at: vec![],
                paper: Paper::WIDE,
            };
            map("x", &designs, &request).expect("a map").svg.contains("struck through")
        }),
        [true, true, true, false, false, false]
    );
    let all = figures("x", &designs, None, Paper::WIDE);
    assert!(figure(&all, "critical-force").contains("surface folds: not valid"));
    assert!(!figure(&all, "compliance").contains("surface folds: not valid"));
}

#[test]
fn titles_have_symbols_and_units() {
    let table =
        table_with(&[("thickness_mm", |k| f64::from(1 + k % 2)), ("critical_force_N", f64::from)]);
    let request = MapRequest {
        x: "gap_over_t".into(),
        y: "slant_deg".into(),
        of: "critical_force_N".into(),
        at: vec![("thickness_mm".into(), "1".into())],
        paper: Paper::WIDE,
    };
    let map = map("x", &Designs::of(&results(&table)), &request).expect("a map");
    assert!(map.svg.contains("<title>x: critical force (N) over d/t and α, t = 1 mm</title>"));
}

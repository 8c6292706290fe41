//! Selects results by a definition or a folder, and designs by number, range or value.

use crate::{FEW, Place};

#[test]
fn folders_are_accepted_as_definitions() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let text = place.prints("design r --design 6");
    assert!(text.starts_with("few: design 0006 of 8\n"), "{text}");
    assert!(place.path("r/designs/0006/measures.csv").is_file());
    place.prints("draw r --design 6");
    place.prints("plot curves r --design 6");
    assert_eq!(place.list("r/drawings"), "design-0006-puncture-at-critical-tilt.svg");
    assert!(place.list("r/curves").contains("force-displacement-curves-of-0006.svg"));
    assert!(place.prints("check r").contains("designs       8\n"));
    std::fs::create_dir(place.path("empty")).expect("a folder");
    insta::assert_snapshot!(place.refused("design empty --design 1"), @"error: empty: holds no run.toml, expected a definition in TOML or a results folder");
}

#[test]
fn definitions_are_accepted_as_folders() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused("rank x.toml"), @"error: x.toml: there are no results in results/few; squama run x.toml writes them");
    place.squama("run x.toml -q").assert().code(0);
    for command in ["rank", "plot", "report", "status", "rerun --failed --dry-run"] {
        let by_definition = place.prints(&format!("{command} x.toml"));
        assert_eq!(by_definition, place.prints(&format!("{command} results/few")), "{command}");
    }
    let record = place.prints("rank results/few/run.toml");
    assert_eq!(record, place.prints("rank results/few"));
    place.prints("export x.toml --xlsx x.xlsx");
    assert!(place.prints("compare x.toml results/few").contains("8 designs in both"));
}

#[test]
fn designs_are_selected_by_ranges() {
    let place = Place::with(FEW);
    place.prints("draw x.toml --design 2-4,8 --out d");
    assert_eq!(
        place.list("d"),
        [2, 3, 4, 8]
            .map(|number| format!("design-000{number}-puncture-at-critical-tilt.svg"))
            .join(" ")
    );
    insta::assert_snapshot!(place.refused("draw x.toml --design 4-2"), @"error: x.toml: --design 4-2: there is no design 4-2, expected a number from 1 to 8");
    insta::assert_snapshot!(place.refused("draw x.toml --design 7-9"), @"error: x.toml: --design 7-9: there is no design 9, expected a number from 1 to 8");
    insta::assert_snapshot!(place.refused("design x.toml --design 1-2"), @"error: x.toml: 2 designs are selected, expected one: give a value with --slant …");
    place.squama("run x.toml -q").assert().code(0);
    let text = place.prints("rerun x.toml --design 2-4,8 --dry-run");
    assert!(text.contains("4 designs") && text.contains("0002 0003 0004 0008"), "{text}");
}

#[test]
fn designs_are_selected_by_values() {
    let place = Place::with(FEW);
    place.prints("draw x.toml --gap 0.1 --length 0.2,1 --slant 20..60 --out d");
    assert_eq!(
        place.list("d"),
        [2, 4].map(|number| format!("design-000{number}-puncture-at-critical-tilt.svg")).join(" ")
    );
    place.prints("draw x.toml --gap 0.15 --length 1 --slant 45 --out beside");
    let beside =
        "design-gap_over_t_0.15-length_over_t_1-slant_deg_45-puncture-at-critical-tilt.svg";
    assert_eq!(place.list("beside"), beside);
    place.prints("plot curves x.toml --gap 0.1 --slant 45 --out c");
    assert!(place.list("c").contains("force-displacement-curves-of-0002-0004.svg"));
    insta::assert_snapshot!(place.refused("draw x.toml --slant 10..40"), @"error: --slant 10..40: the sweep has no value in this range, expected some of 0 45");
    insta::assert_snapshot!(place.refused("draw x.toml --slant 10..x"), @"error: --slant 10..x: not accepted, expected FROM..TO, e.g. 15..60");
    insta::assert_snapshot!(place.refused("draw x.toml --slant 1,99"), @"error: --slant 1,99 (several values): designs.slant_deg: 99 is out of range, expected an angle of at least 0 and below 90");
    insta::assert_snapshot!(place.refused("draw x.toml"), @"error: x.toml: has 8 designs; choose with --design, or with --gap, --length and --slant");
    insta::assert_snapshot!(place.refused("design x.toml"), @"error: x.toml: has 8 designs; choose with --design, or with --gap, --length and --slant");
}

#[test]
fn file_names_of_many_designs_are_short() {
    let place = Place::with("name = 'x'\n[puncture]\nscales = 5\n[solver]\nmax_points = 3");
    place.squama("plot curves x.toml --design 1-45 --out c").assert().code(1);
    assert!(place.list("c").contains("force-displacement-curves-of-0001-to-0045-45-designs.svg"));
}

/// Returns a definition with gaps and lengths in the unit `mm` or `over_t`.
fn with_lengths(unit: &str, gaps: &str, lengths: &str) -> String {
    format!(
        "name = \"{unit}\"\nmeasures = [\"coverage\", \"flexure\"]\n[designs]\n\
         gap_{unit} = {gaps}\nlength_{unit} = {lengths}\nslant_deg = [30, 45]\n"
    )
}

/// Round-off must not matter: in floating-point arithmetic, `0.3/3` is not exactly 0.1.
#[test]
fn lengths_in_mm_and_divided_by_the_thickness_give_the_same_designs() {
    let place = Place::with(FEW);
    let in_mm = with_lengths("mm", "{ from = 0.3, to = 3, step = 0.3 }", "[0.9, 2.1]");
    let write =
        |file: &str, text: String| std::fs::write(place.path(file), text).expect("writable");
    write("mm.toml", in_mm + "[material]\nthickness_mm = 3\n");
    write("t.toml", with_lengths("over_t", "{ from = 0.1, to = 1, step = 0.1 }", "[0.3, 0.7]"));
    place.squama("run mm.toml -q --out mm").assert().code(0);
    place.squama("run t.toml -q --out t").assert().code(0);
    for table in ["mm/designs.csv", "mm/compliance.csv"] {
        let designs = place.read(table);
        let mut geometry =
            designs.lines().skip(1).map(|line| line.split(',').take(3).collect::<String>());
        assert!(geometry.all(|cells| cells.len() < 12), "{table}: {designs}");
    }
    assert!(place.prints("compare mm t").contains("40 designs in both"));
    for folder in ["mm", "t"] {
        place.prints(&format!("rank {folder} --criteria coverage,compliance"));
    }
    let [in_mm, over_t] = ["mm", "t"].map(|folder| -> Vec<String> {
        let table = place.read(&format!("{folder}/pareto.csv"));
        table.lines().skip(1).map(|line| line[..4].to_owned()).collect()
    });
    assert_eq!(in_mm, over_t);
    // Commands accept the keys of lengths in mm as axes of maps and in conditions.
    let map = "plot map mm --of compliance --no-title --out maps";
    place.prints(&format!("{map} --x gap_mm --y length_mm"));
    let drawn = place.read("maps/map-of-compliance-over-gap-mm-and-length-mm.svg");
    assert_eq!(drawn.matches("<g class=\"map\">").count(), 2, "one map for each slant");
    let titles = drawn.lines().filter(|line| line.contains("(mm)")).collect::<String>();
    assert!(titles.contains("gap ") && titles.contains("length "), "{drawn}");
    place.prints(&format!("{map} --x gap_mm --y slant_deg --at length_mm=2.1"));
    insta::assert_snapshot!(place.refused(&format!("{map} --x gap_mm --y gap_over_t")), @"error: --y gap_over_t: is on the horizontal axis already; choose another parameter");
    let again = place.prints("rerun mm --where gap_mm=0.30000000000000004 --dry-run");
    assert!(again.contains("4 designs"), "{again}");
    let design = place.prints("design t.toml --gap 0.30000000000000004 --length 0.7 --slant 45");
    assert!(design.starts_with("over_t: design 0012 of 40\n"), "{design}");
    let range = place.prints("draw t.toml --gap 0.30000000000000004..0.4 --length 0.7 --slant 45");
    assert_eq!(range.lines().count(), 2, "{range}");
}

//! Failed designs are listed in the tables, and `squama rerun` solves designs again.

use crate::{FEW, Place};

/// Command that runs eight designs; all of them stop early in puncture and in bending.
const STOPPED: &str = "run x.toml -q --out r --set solver.max_points=3";

#[test]
fn failures_report_their_location_and_a_command_to_reproduce_them() {
    let place = Place::with(FEW);
    place.squama(STOPPED).assert().code(1);
    let table = place.read("r/failures.csv");
    let rows: Vec<_> = table.lines().collect();
    assert_eq!(rows.len(), 1 + 2 * 8);
    assert_eq!(
        rows[0],
        "design,gap_over_t,length_over_t,slant_deg,measure,reason,angle_deg,load,displacement,\
         contacts,step,iteration,residual,settings,command"
    );
    let puncture = "0004,0.1,1,45,puncture,too many points,3.481";
    let row = rows.iter().find(|row| row.starts_with(puncture)).expect("a row");
    assert!(rows.iter().any(|row| row.starts_with("0004,0.1,1,45,flexure,too many points,")));
    let command = row.rsplit(',').next().expect("a command");
    assert_eq!(command, "squama design run.toml --design 0004 --out designs/0004");
    let mut design = place.squama(command.strip_prefix("squama ").expect("squama"));
    design.current_dir(place.path("r")).assert().code(1);
    // The failure is reported at the last equilibrium of the path.
    let path = place.read("r/designs/0004/path.csv");
    let cells: Vec<_> = row.split(',').collect();
    let last = path.lines().last().expect("a point");
    let begin = format!("{},{},{},{},", cells[8], cells[7], cells[6], cells[9]);
    assert!(last.starts_with(&begin), "{last} should begin with {begin}");
}

#[test]
fn reruns_of_failed_designs_report_the_changes() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out whole").assert().code(0);
    place.squama(STOPPED).assert().code(1);
    let plan = place.prints("rerun r --failed --dry-run --set solver.max_points=1000");
    insta::assert_snapshot!(plan, @r"
    solved again: 8 designs with solver.max_points=1000
      0001 0002 0003 0004 0005 0006 0007 0008
    ");
    assert_eq!(
        place.read("r/failures.csv").lines().count(),
        1 + 2 * 8,
        "--dry-run changes nothing"
    );
    place.squama("rerun r --failed -q --set solver.max_points=1000").assert().code(0);
    assert_eq!(place.read("r/failures.csv").lines().count(), 1);
    let settled = place.read("r/designs.csv").replace("solver.max_points=1000", "");
    assert_eq!(settled, place.read("whole/designs.csv"));
    assert_eq!(place.read("r/critical_force.csv"), place.read("whole/critical_force.csv"));
    let changes = place.read("r/reruns.csv");
    let change = "0004,1,solver.max_points=1000,,puncture_status,too many points,complete";
    assert!(changes.lines().any(|line| line == change), "{changes}");
}

#[test]
fn commands_in_tables_quote_a_setting_that_contains_a_list() {
    let place = Place::with(FEW);
    place.squama(STOPPED).assert().code(1);
    let again =
        "rerun r --design 4 -q --set puncture.scales=31 --set puncture.critical_tilt_deg=[5,10]";
    place.squama(again).assert().code(1);
    let table = place.read("r/failures.csv");
    let row = table.lines().find(|row| row.starts_with("0004,")).expect("a row");
    let settings = "--set puncture.scales=31 --set 'puncture.critical_tilt_deg=[5,10]'";
    assert!(row.contains(settings), "{row}");
}

#[test]
fn designs_are_chosen_by_number_and_by_value() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    for (choice, designs) in [
        (&["--design", "7,0002,2"][..], "0002 0007"),
        (&["--where", "slant_deg=45.0"], "0002 0004 0006 0008"),
        (&["--where", "slant_deg=45", "--where", "gap_over_t=0.5"], "0006 0008"),
    ] {
        let mut command = place.squama("rerun r --dry-run");
        let output = command.args(choice).assert().code(0).get_output().stdout.clone();
        let text = String::from_utf8(output).expect("text");
        assert_eq!(text.lines().nth(1).expect("designs").trim(), designs);
    }
    let text =
        place.squama("rerun r --dry-run").args(["--where", "puncture_status=row limit"]).assert();
    text.code(0).stdout("r: no design matches; nothing to solve\n");
    let refused: Vec<_> = [
        &["--design", "9"][..],
        &["--where", "slant=45"],
        &["--where", "slant_deg"],
        &["--failed", "--set", "designs.slant_deg=30"],
        &["--failed", "--set", "name=y"],
        &["--failed", "--set", "solver.max_stepp=1"],
        &["--failed", "--set", "solver.min_step=0.5"],
    ]
    .into_iter()
    .map(|choice| {
        let mut command = place.squama("rerun r --dry-run");
        let message = command.args(choice).assert().code(2).get_output().stderr.clone();
        String::from_utf8(message).expect("text")
    })
    .collect();
    insta::assert_snapshot!(refused.concat());
}

#[test]
fn solving_again_with_the_same_settings_changes_nothing() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let before = place.read("r/designs.csv");
    place.squama("rerun r --design 2 -q").assert().code(0);
    assert_eq!(place.read("r/designs.csv"), before);
    assert_eq!(place.read("r/reruns.csv").lines().nth(1), Some("0002,1,,,,,"));
}

#[test]
fn status_lists_reasons_and_the_slowest_designs() {
    let place = Place::with(FEW);
    place.squama(STOPPED).assert().code(1);
    let output = place.squama("status r").assert().code(1).get_output().stdout.clone();
    let text = String::from_utf8(output).expect("text");
    for line in [
        "few: not running",
        "  designs     8, all designs",
        "  done        8",
        "  failed      8",
        "  missing     0",
        "why designs failed",
        "  puncture  too many points  8 designs",
        "slowest designs",
    ] {
        assert!(text.lines().any(|other| other == line), "{line} is missing in\n{text}");
    }
    assert_eq!(text.lines().skip_while(|line| *line != "slowest designs").count(), 1 + 5);
}

#[test]
fn tables_may_have_decimal_commas() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out plain").assert().code(0);
    place.squama("run x.toml -q --out r --csv excel-eu").assert().code(0);
    let bytes = std::fs::read(place.path("r/coverage.csv")).expect("a file");
    assert!(bytes.starts_with("\u{feff}design;gap_over_t;".as_bytes()));
    let table = place.read("r/coverage.csv");
    assert!(table.contains("\r\n0003;0,1;1;0;0,") || table.contains("\r\n0002;0,1;0,2;45;0,"));
    let plain = table.trim_start_matches('\u{feff}').replace(',', ".").replace(';', ",");
    assert_eq!(plain, place.read("plain/coverage.csv"));
    // The folder keeps the requested format until a command requests another one.
    place.squama("rerun r --design 1 -q").assert().code(0);
    assert_eq!(place.read("r/coverage.csv"), table);
    place.squama("run x.toml -q --resume --out r --csv plain").assert().code(0);
    assert_eq!(place.read("r/coverage.csv"), place.read("plain/coverage.csv"));
}

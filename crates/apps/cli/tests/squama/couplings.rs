//! The coupling and the law of the substrate can be axes of a sweep.

use crate::Place;
use crate::table::cells;

const BOTH: &str = "name = 'both'\nmeasures = ['coverage', 'puncture', 'flexure']\n[designs]\n\
                    slant_deg = [0, 45]\ncoupling = ['nearest', 'full']\ngap_over_t = 0.1\n\
                    length_over_t = 1\n";

#[test]
fn the_coupling_is_an_axis_and_affects_only_punctures() {
    let place = Place::with(BOTH);
    let check = place.prints("check x.toml");
    assert!(check.contains("calibrations  2\n"), "{check}");
    place.squama("run x.toml -q --out both").assert().code(0);
    place.squama("run x.toml -q --out again --threads 1").assert().code(0);
    place.assert_same_tables("both", "again");
    let table = place.read("both/designs.csv");
    assert_eq!(cells(&table, "coupling"), ["nearest", "nearest", "full", "full"]);
    for column in ["coverage", "compliance", "max_moment"] {
        let cells = cells(&table, column);
        assert_eq!(cells[..2], cells[2..], "{column}");
    }
    for column in ["critical_force", "penetration", "calibration_error"] {
        let cells = cells(&table, column);
        assert!(cells[0] != cells[2] && cells[1] != cells[3], "{column}");
    }
    // Coupling of nearest neighbours, as in the paper, is the default.
    place.squama("run x.toml -q --out paper --set designs.coupling=nearest").assert().code(0);
    let paper = place.read("paper/designs.csv");
    assert_eq!(cells(&paper, "critical_force"), cells(&table, "critical_force")[..2]);
    place.squama("rerun both --failed -q").assert().code(0);
}

#[test]
fn the_law_of_the_substrate_is_an_axis_and_affects_only_punctures() {
    let place = Place::with(
        &BOTH.replace("coupling = ['nearest', 'full']", "law = ['linear', 'neo-hookean']"),
    );
    let check = place.prints("check x.toml");
    assert!(check.contains("calibrations  1\n"), "{check}");
    place.squama("run x.toml -q --out both").assert().code(0);
    let table = place.read("both/designs.csv");
    assert_eq!(cells(&table, "law"), ["linear", "linear", "neo-hookean", "neo-hookean"]);
    for column in ["coverage", "compliance", "initial_stiffness", "calibration_error"] {
        let cells = cells(&table, column);
        assert_eq!(cells[..2], cells[2..], "{column}");
    }
    let force = cells(&table, "critical_force");
    assert!(force[0] != force[2] && force[1] != force[3]);
    place.squama("run x.toml -q --out c --set designs.law=rubber").assert().code(2);
}

#[test]
fn a_rerun_may_change_the_coupling() {
    let place = Place::with(BOTH);
    place.squama("run x.toml -q --out full --set designs.coupling=full").assert().code(0);
    let text = BOTH.replace("coupling = ['nearest', 'full']\n", "");
    std::fs::write(place.path("y.toml"), text).expect("writable");
    place.squama("run y.toml -q --out r").assert().code(0);
    place.squama("rerun r --design 2 -q --set substrate.coupling=full").assert().code(0);
    let (rerun, full) = (place.read("r/designs.csv"), place.read("full/designs.csv"));
    assert_eq!(cells(&rerun, "settings"), ["", "substrate.coupling=full"]);
    assert_eq!(cells(&rerun, "critical_force")[1], cells(&full, "critical_force")[1]);
    place.squama("run y.toml -q --out z --set substrate.coupling=all").assert().code(2);
}

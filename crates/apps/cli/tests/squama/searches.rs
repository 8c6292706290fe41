//! Status and HTML page of a search, also while the search is running.

use serde_json::Value;

use crate::Place;
use crate::process::Running;

const GOAL: &str = "name = 'firm'\nmeasures = ['coverage', 'puncture']\n[variables]\n\
    length_over_t = { from = 0.3, to = 1 }\n[designs]\ngap_over_t = 0.3\nslant_deg = 60\n[goal]\n\
    minimize = 'length_over_t'\nrequire = 'critical_force >= 0.3'\nsamples = 8\n";

/// Returns a folder with a finished search in `results/firm`.
fn searched() -> Place {
    let place = Place::with(GOAL);
    place.squama("optimise x.toml -q").assert().code(1);
    place
}

#[test]
fn the_status_of_a_search_has_its_best_design() {
    let place = searched();
    let table = place.read("results/firm/optimum.csv");
    let found: f64 = crate::table::cells(&table, "length_over_t")[0].parse().expect("a number");
    let status: Value =
        serde_json::from_str(&place.prints("status results/firm --json")).expect("JSON");
    let best = &status["best"];
    let length = best["variables"]["length_over_t"].as_f64().expect("a number");
    assert!((length / found - 1.0).abs() < 1e-6, "{status} {found}");
    assert_eq!(best["met"], true);
    assert!(best["values"]["critical_force"].as_f64().is_some_and(|force| force > 0.3 - 1e-9));
    assert!(status["seconds"].is_f64(), "{status}");
    let text = place.prints("status results/firm");
    assert!(text.contains("best so far\n  length_over_t"), "{text}");
    assert!(text.contains(">= 0.3, at the limit") && text.contains("meet every"), "{text}");
}

#[test]
fn a_running_search_has_a_page_that_reloads_itself() {
    let place = searched();
    let page = "results/firm/report.html";
    assert_eq!(place.prints("report results/firm"), format!("{page}\n"));
    let text = place.read(page);
    assert_eq!(text.matches("<svg").count(), 2, "history and parallel coordinates");
    assert!(text.contains("critical_force &gt;= 0.3") && text.contains("class=\"axis\""));
    assert!(!text.contains("location.reload"), "the search has ended");
    assert!(place.refused("report results/firm --front x").contains("--front"));
    // Simulate a running search, which locks its journal.
    let journal = std::fs::File::open(place.path("results/firm/evaluations.jsonl"));
    let journal = journal.expect("a journal");
    journal.lock().expect("a lock");
    let mut report = Running::spawn(&place.path("."), "report results/firm");
    report.until(|| place.read(page).contains("location.reload"));
    assert!(place.read(page).contains("search, running"));
    journal.unlock().expect("the lock is released");
    assert_eq!(report.end().code(), Some(0));
    assert!(!place.read(page).contains("location.reload"));
}

//! Every command that reads results detects incomplete or modified files and names a remedy.

use std::fs;

use crate::{FEW, Place};

/// Commands that read the results in the folder `r`.
const READERS: [&str; 5] = [
    "rank r --out ranked",
    "compare r r",
    "export r --xlsx x.xlsx",
    "plot r --out figures",
    "report r --out page.html",
];

/// Returns a folder in which the results `r` contain three of eight designs.
fn incomplete() -> Place {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --shard 1/3 --out shard").assert().code(0);
    place.squama("merge -q shard --out r").assert().code(1);
    place
}

/// Replaces the first occurrence of `old` in a file with `new`.
fn change(place: &Place, file: &str, old: &str, new: &str) {
    let text = place.read(file);
    let changed = text.replacen(old, new, 1);
    assert_ne!(text, changed, "{file}");
    fs::write(place.path(file), changed).expect("writable");
}

#[test]
fn an_incomplete_run_needs_the_option_partial() {
    let place = incomplete();
    for reader in READERS {
        let message = place.refused(reader);
        assert!(
            message.starts_with("error: r: holds 3 of 8 designs; squama run --resume"),
            "{message}"
        );
    }
    assert_eq!(place.list("."), "r shard x.toml", "no file is written");
    for reader in READERS {
        let text = place.prints(&format!("{reader} --partial"));
        let files = reader.starts_with("plot") || reader.starts_with("report");
        assert!(files || text.contains("made from 3 of 8 designs"), "{text}");
    }
    assert!(place.read("page.html").contains("few (3 of 8 designs)"));
    assert!(place.read("figures/coverage-maps-by-slant.svg").contains("few (3 of 8 designs)"));
    // After more designs are solved, files made from the earlier tables are out of date.
    place.squama("run x.toml -q --resume --out r").assert().code(0);
    let status = place.prints("status r");
    for product in ["ranking", "workbook", "figures", "page"] {
        assert!(status.contains(&format!("\n  {product} ")), "{status}");
    }
    assert!(status.contains("  squama rank r --out ranked --partial\n"), "{status}");
    place.prints("rank r --out ranked");
    assert!(!place.prints("status r").contains("\n  ranking"));
}

#[test]
fn a_run_without_checksums_is_rejected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    fs::remove_file(place.path("r/contents.toml")).expect("a file");
    for reader in READERS {
        let message = place.refused(reader);
        assert!(message.starts_with("error: r: holds a journal but no contents.toml"), "{message}");
    }
    place.squama("merge r -q --out r").assert().code(0);
    for reader in READERS {
        place.prints(reader);
    }
    change(&place, "r/contents.toml", "done = 8", "done = 7");
    insta::assert_snapshot!(place.refused("rank r"), @"error: r/contents.toml: was changed after squama wrote it (its checksum does not match); squama merge r --out r writes it again");
}

#[test]
fn a_changed_digit_is_detected_and_repaired() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let sound = place.read("r/designs.csv");
    change(&place, "r/designs.csv", "0.1,0.2,0,0,", "0.1,0.2,0,1,");
    for reader in READERS {
        let message = place.refused(reader);
        assert!(
            message.starts_with("error: r/designs.csv: was changed after squama wrote it"),
            "{message}"
        );
    }
    let status = place.squama("status r").assert().code(1).get_output().stdout.clone();
    let status = String::from_utf8(status).expect("text");
    assert!(
        status.contains("problems\n  r/designs.csv: was changed after squama wrote it"),
        "{status}"
    );
    place.squama("merge -q r --out r").assert().code(0);
    assert_eq!(place.read("r/designs.csv"), sound);
    place.prints("status r");
    // The change of a table that only `export` reads is detected, too.
    change(&place, "r/penetration.csv", "0001", "0002");
    insta::assert_snapshot!(place.refused("export r --xlsx x.xlsx"), @"error: r/penetration.csv: was changed after squama wrote it; squama merge r --out r writes it again");
    // A deleted table must not be treated as a table that was never written.
    std::fs::remove_file(place.path("r/penetration.csv")).expect("a table");
    let message = place.refused("export r --xlsx x.xlsx");
    assert!(
        message.starts_with("error: r/penetration.csv: cannot be read (No such file"),
        "{message}"
    );
    // Commands that read the record of a run as a definition reject an edited record.
    place.squama("merge -q r --out r").assert().code(0);
    change(&place, "r/run.toml", "slant_deg = [0", "slant_deg = [1");
    for reader in ["design r/run.toml --design 1", "draw r/run.toml --design 1", "run r/run.toml"] {
        let message = place.refused(reader);
        assert!(message.starts_with("error: r/run.toml: was edited"), "{message}");
    }
}

#[test]
fn derivatives_are_verified_like_any_table() {
    let place = Place::with(FEW);
    let with = FEW.replace("[designs]", "measures = ['coverage', 'sensitivity']\n[designs]");
    fs::write(place.path("with.toml"), with).expect("writable");
    place.squama("run with.toml -q --out r").assert().code(0);
    assert!(place.list("r").contains("sensitivity.csv"));
    // A run without derivatives removes an earlier table of derivatives, and rejects a table that
    // it did not write.
    place.squama("run x.toml -q --fresh --out r").assert().code(0);
    assert!(!place.list("r").contains("sensitivity.csv"));
    fs::write(place.path("r/sensitivity.csv"), "design\n0001\n").expect("writable");
    let message = place.refused("export r --xlsx x.xlsx");
    assert!(
        message.starts_with("error: r/sensitivity.csv: was changed after squama wrote it"),
        "{message}"
    );
    // A table that squama did not write is not overwritten.
    fs::create_dir(place.path("strange")).expect("a folder");
    fs::write(place.path("strange/sensitivity.csv"), "mine").expect("writable");
    let message = place.refused("run with.toml -q --out strange");
    assert!(message.contains("holds sensitivity.csv without a journal"), "{message}");
    assert_eq!(place.read("strange/sensitivity.csv"), "mine");
}

/// Changes the lines of a journal after its header, and renews their checksums.
///
/// `change` is called for each of these lines. `key` is the key of the header line that contains
/// the definition and the program.
fn reseal(place: &Place, journal: &str, key: &str, change: impl Fn(&mut serde_json::Value)) {
    let text = place.read(journal);
    let (first, rest) = text.split_once('\n').expect("lines");
    let header: serde_json::Value = serde_json::from_str(first).expect("JSON");
    let words = ["definition_sha256", "version", "revision"];
    let words = words.map(|word| header[key][word].as_str().expect("text"));
    let mut bytes = format!("{first}\n").into_bytes();
    for line in rest.lines() {
        let mut line: serde_json::Value = serde_json::from_str(line).expect("JSON");
        line.as_object_mut().expect("an object").remove("crc");
        change(&mut line);
        bytes.extend(journal::Seal::over(&words).seal(&line));
    }
    fs::write(place.path(journal), bytes).expect("writable");
}

#[test]
fn a_forged_journal_is_rejected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let sound = place.read("r/journal.jsonl");
    // Change the coverage of the third design.
    reseal(&place, "r/journal.jsonl", "journal", |line| {
        // Other lines of the journal are sessions or designs with other numbers.
        if let Some(design) = line.get_mut("design").filter(|design| design["design"] == 3) {
            design["result"]["coverage"] = 0.875.into();
        }
    });
    assert!(place.refused("rank r").contains("is not the journal from which the tables beside it"));
    for command in ["merge r --out r", "run x.toml --resume --out r", "rerun r --design 1"] {
        let message = place.refused(command);
        assert!(message.contains("design 0003 differs from designs.csv"), "{message}");
    }
    fs::write(place.path("r/journal.jsonl"), &sound).expect("writable");
    place.prints("rank r");
    // The order of the lines does not matter.
    let mut swapped: Vec<&str> = sound.lines().collect();
    swapped.swap(3, 5);
    fs::write(place.path("r/journal.jsonl"), swapped.join("\n") + "\n").expect("writable");
    place.squama("merge r --out r").assert().code(0);
    place.prints("rank r");
}

#[test]
fn forged_evaluations_are_rejected() {
    let goal = "name = 'goal'\nmeasures = ['coverage', 'flexure']\n[variables]\nslant_deg = { from = 0, to = 60 }\n\
        [designs]\ngap_over_t = 0.3\nlength_over_t = 1\n[goal]\nmaximize = 'coverage'\nsamples = 16\n";
    let place = Place::with(goal);
    place.prints("optimise x.toml --out found --csv excel-eu");
    let (journal, sound) = ("found/evaluations.jsonl", place.read("found/evaluations.jsonl"));
    let tables = ["history.csv", "optimum.csv"];
    let tables = tables.map(|file| (file, place.read(&format!("found/{file}"))));
    // A changed value in a column of the goal would change the course of the search, so it is
    // rejected.
    reseal(&place, journal, "optimisation", |line: &mut serde_json::Value| {
        let coverage = &mut line["solved"]["result"]["coverage"];
        if coverage.as_f64().is_some_and(|coverage| coverage > 0.76) {
            *coverage = 0.9.into();
        }
    });
    let message = place.refused("optimise x.toml --out found --resume");
    assert!(message.starts_with(&format!("error: {journal}: ")), "{message}");
    assert!(message.contains("differs from history.csv"), "{message}");
    fs::write(place.path(journal), &sound).expect("writable");
    // A changed value in a column other than `coverage` has no effect, because `--resume` solves
    // the best design again.
    reseal(&place, journal, "optimisation", |line: &mut serde_json::Value| {
        line["solved"]["result"]["flexure"]["measures"]["initial_compliance"] = 0.5.into();
    });
    place.prints("optimise x.toml --out found --resume --csv excel-eu");
    for (file, table) in &tables {
        assert_eq!(place.read(&format!("found/{file}")), *table);
    }
    // Designs on lost lines are solved again; the order of the other lines does not matter.
    let mut lines: Vec<&str> = sound.lines().collect();
    lines.swap(3, 5);
    fs::write(place.path(journal), lines[..lines.len() / 2].join("\n") + "\n").expect("writable");
    place.prints("optimise x.toml --out found --resume --csv excel-eu");
    for (file, table) in &tables {
        assert_eq!(place.read(&format!("found/{file}")), *table);
    }
}

#[test]
fn forged_samples_are_rejected() {
    let place = Place::with(
        "name = 'x'\nmeasures = 'coverage'\n[designs]\ngap_over_t = 0.3\nlength_over_t = 1\nslant_deg = 45\n\
         [tolerance]\ngap_over_t = { batch_sd = 0.01 }\n",
    );
    let command = "tolerance x.toml --samples 4 --out made";
    place.prints(command);
    let listed = place.list("made/samples");
    let name = listed.split_whitespace().find(|name| name.contains(".jsonl")).expect("a journal");
    let (journal, table) = (format!("made/samples/{name}"), name.replace("jsonl", "csv"));
    let sound = [&journal, &format!("made/samples/{table}")].map(|file| place.read(file));
    reseal(&place, &journal, "samples", |line| {
        if line["number"] == 3 {
            line["values"][1] = 0.5.into();
        }
    });
    let message = place.refused(command);
    assert!(message.contains(&format!("sample 3 differs from {table}")), "{message}");
    assert_eq!(place.read(&format!("made/samples/{table}")), sound[1]);
    fs::write(place.path(&journal), &sound[0]).expect("writable");
    // If the table was changed instead of the journal, squama restores it from the journal.
    change(&place, &format!("made/samples/{table}"), "0.", "1.");
    place.prints(command);
    assert_eq!(place.read(&format!("made/samples/{table}")), sound[1]);
}

#[test]
fn changed_requirements_of_a_ranking_are_detected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    place.prints("rank r --require coverage>=0.1");
    for reader in ["export r --xlsx x.xlsx", "report r --out page.html"] {
        place.prints(reader);
    }
    change(&place, "r/ranking.toml", "coverage >= 0.1", "coverage >= 0.2");
    for reader in ["export r --xlsx x.xlsx", "report r --out page.html"] {
        insta::allow_duplicates! {
            insta::assert_snapshot!(place.refused(reader), @"error: r/ranking.toml: was changed after squama wrote it; squama rank r writes it again");
        }
    }
    place.prints("rank r --require coverage>=0.2");
    place.prints("export r --xlsx x.xlsx");
}

#[test]
fn tables_older_than_the_journal_are_detected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let tables = ["designs.csv", "contents.toml", "run.toml", "critical_force.csv"];
    let before = tables.map(|table| place.read(&format!("r/{table}")));
    place.squama("rerun r -q --design 8 --set solver.max_points=3").assert().code(1);
    let after = place.read("r/critical_force.csv");
    // Simulate a rerun that was killed before it wrote its first table.
    for (table, text) in tables.iter().zip(&before) {
        fs::write(place.path("r").join(table), text).expect("writable");
    }
    let message = place.refused("rank r");
    assert!(
        message.starts_with("error: r: the journal has more designs than the tables"),
        "{message}"
    );
    place.prints("rank r --partial");
    // Simulate a rerun that was killed after it wrote its first table.
    fs::write(place.path("r/critical_force.csv"), after).expect("writable");
    let message = place.refused("export r --xlsx x.xlsx --partial");
    assert!(
        message.starts_with("error: r/critical_force.csv: was changed after squama wrote it"),
        "{message}"
    );
    place.squama("merge -q r --out r").assert().code(1);
    // The ranking was made from the previous tables.
    insta::assert_snapshot!(place.refused("export r --xlsx x.xlsx"), @"error: r/ranking.csv: was made from other tables; squama rank r writes it again");
    place.prints("rank r");
    place.prints("export r --xlsx x.xlsx");
    assert!(place.read("r/designs.csv").contains("solver.max_points=3"));
}

#[test]
fn an_interrupted_ranking_is_not_exported() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    place.prints("rank r");
    change(&place, "r/pareto.csv", "0006", "0007");
    insta::assert_snapshot!(place.refused("export r --xlsx x.xlsx"), @"error: r/pareto.csv: was changed after squama wrote it; squama rank r writes it again");
    place.prints("rank r");
    // Simulate a ranking that was killed before it wrote its checksums.
    let record = place.read("r/derived/ranking.toml");
    let digest = record.lines().find(|line| line.contains("ranking.csv")).expect("a file");
    change(&place, "r/derived/ranking.toml", digest, "\"ranking.csv\" = \"\"");
    insta::assert_snapshot!(place.refused("export r --xlsx x.xlsx"), @"error: r/ranking.csv: was changed after squama wrote it; squama rank r writes it again");
    place.prints("rank r");
    place.prints("export r --xlsx x.xlsx");
    // Without its record, the origin of the ranking is unknown.
    fs::remove_file(place.path("r/derived/ranking.toml")).expect("a record");
    insta::assert_snapshot!(place.refused("export r --xlsx x.xlsx"), @"error: r/ranking.csv: no record in derived says that squama rank wrote it; move it out of the folder");
    place.refused("rank r");
}

#[test]
fn a_fresh_run_removes_files_made_from_the_earlier_run() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    for command in ["rank r", "plot r", "report r", "export r --xlsx r/a.xlsx"] {
        place.prints(command);
    }
    let edited = place.read("r/figures/coverage-maps-by-slant.svg").replace("few", "mine");
    fs::write(place.path("r/figures/coverage-maps-by-slant.svg"), &edited).expect("writable");
    let run = place.squama("run x.toml -q --fresh --out r --set contact.c1=2").assert().code(0);
    let message = String::from_utf8(run.get_output().stderr.clone()).expect("text");
    assert!(
        message.starts_with("note: removed, because they were made from the earlier results: "),
        "{message}"
    );
    for file in ["ranking.csv", "report.html", "a.xlsx"] {
        assert!(
            message.contains(file) && !place.path("r").join(file).exists(),
            "{file}: {message}"
        );
    }
    let kept = place.read("r/figures/coverage-maps-by-slant.svg");
    assert_eq!(kept, edited, "a changed file is kept");
}

#[test]
fn lost_lines_of_a_journal_are_detected() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    place.squama("rerun r -q --design 8 --set contact.c1=2").assert().code(0);
    let journal = place.read("r/journal.jsonl");
    let end = journal.trim_end().rfind('\n').expect("lines") + 1;
    fs::write(place.path("r/journal.jsonl"), &journal[..end]).expect("writable");
    let message = place.refused("rank r");
    assert!(message.contains("is not the journal from which the tables beside it"), "{message}");
    insta::assert_snapshot!(place.refused("merge r --out all"), @"error: r/journal.jsonl: 1 of the 12 lines from which the tables were written are missing; restore them from a copy of the journal, or solve them again with squama run --resume");
    let run = place.squama("run x.toml -q --resume --out r").assert().code(0);
    let message = String::from_utf8(run.get_output().stderr.clone()).expect("text");
    assert!(
        message.starts_with("note: r/journal.jsonl: 1 of the 12 lines from which"),
        "{message}"
    );
    place.prints("rank r");
}

/// A spreadsheet program that saves `designs.csv` again changes its bytes, but not its values.
#[test]
fn a_table_saved_again_with_equal_values_is_read_with_a_warning() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let printed = place.prints("rank r --out ranked");
    let written = place.read("r/designs.csv");
    let spreadsheet = written.replace("\r\n000", "\r\n").replace("complete", " \"complete\"");
    let spreadsheet =
        spreadsheet.replace(" \"complete\"", "\"complete\" ").replace(",0.1,", ", 0.10 ,");
    for text in [written.replace("\r\n", "\n"), written.replace(",0.1,", ", 0.1,"), spreadsheet] {
        assert_ne!(text, written);
        fs::write(place.path("r/designs.csv"), &text).expect("writable");
        for command in ["rank r --out ranked", "compare r r", "plot r --out figures"] {
            let output = place.squama(command).assert().code(0).get_output().clone();
            let message = String::from_utf8(output.stderr).expect("text");
            assert_eq!(
                message,
                "warning: r/designs.csv: was saved again by another program; its values have not changed\n",
                "{command}"
            );
            if command.starts_with("rank") {
                assert_eq!(String::from_utf8(output.stdout).expect("text"), printed);
            }
        }
    }
    fs::write(place.path("r/designs.csv"), written.replace(",0.5,", ", 0.6,")).expect("writable");
    let message = place.refused("rank r");
    assert!(message.contains("was changed after squama wrote it"), "{message}");
}

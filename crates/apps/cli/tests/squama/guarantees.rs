//! Guarantees for the files of runs, searches, analyses, rankings and other commands.
//!
//! No command overwrites files that squama did not write. Commands that read results detect changed
//! files.

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::{FEW, Place};

/// A sweep with tolerances that measures only coverage, which is quick to compute.
const COVERED: &str = "name = 'covered'\nmeasures = 'coverage'\n[designs]\ngap_over_t = [0.1, 0.3]\nlength_over_t = 1\n\
    slant_deg = [30, 45]\n[tolerance]\ngap_over_t = { batch_sd = 0.01 }\n";

/// A goal that measures only coverage.
const GOAL: &str = "name = 'goal'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
    slant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\n[goal]\nmaximize = 'coverage'\nsamples = 16\n";

/// Commands that write tables to the folder `out`, each with the name of one of its files.
const WRITERS: [(&str, &str); 9] = [
    ("optimise my/goal.toml --out out", "goal.toml"),
    ("optimise my/goal.toml --out out --fresh", "optimum.csv"),
    ("optimise my/goal.toml --out out", "history.csv"),
    ("tolerance x.toml --samples 2 --out out", "yield.csv"),
    ("tolerance x.toml --samples 2 --out out", "tolerance.csv"),
    ("sensitivity --global my/box.toml --samples 4 --out out", "sobol.csv"),
    ("rank r --maximize coverage --out out", "ranking.csv"),
    ("compare r r --out out", "differences.csv"),
    ("design x.toml --design 1 --out out", "measures.csv"),
];

/// Returns a folder with a sweep, its results in `r`, a goal, and a definition with variables.
fn place() -> Place {
    let place = Place::with(COVERED);
    fs::create_dir(place.path("my")).expect("a folder");
    fs::write(place.path("my/goal.toml"), GOAL).expect("writable");
    let (variables, _) = GOAL.split_once("[goal]").expect("a goal");
    fs::write(place.path("my/box.toml"), variables).expect("writable");
    place.squama("run x.toml -q --out r").assert().code(0);
    place
}

#[test]
fn no_command_overwrites_tables_that_squama_did_not_write() {
    for (command, file) in WRITERS {
        let place = place();
        fs::create_dir(place.path("out")).expect("a folder");
        let file = format!("out/{file}");
        fs::write(place.path(&file), "mine").expect("writable");
        let message = place.refused(command);
        assert!(message.starts_with(&format!("error: {file}: cannot be written")), "{message}");
        assert_eq!(place.read(&file), "mine", "{command}");
        // A command may overwrite files that it wrote itself.
        fs::remove_file(place.path(&file)).expect("a file");
        for _ in 0..2 {
            let again = command.replace("--out out", "--out again").replace("--fresh", "");
            let again =
                if command.starts_with("optimise") { format!("{again} --resume") } else { again };
            place.squama(&again).assert().code(0);
        }
    }
}

#[test]
fn obsolete_tables_are_removed_but_files_of_the_user_are_kept() {
    let place = place();
    place.prints("tolerance x.toml --samples 4 --require coverage>=0.1 --out out");
    assert!(place.list("out").contains("yield.csv"));
    place.prints("tolerance x.toml --samples 4 --out out");
    assert!(!place.list("out").contains("yield.csv"));
    fs::write(place.path("out/yield.csv"), "mine").expect("writable");
    place.refused("tolerance x.toml --samples 4 --out out");
    assert_eq!(place.read("out/yield.csv"), "mine");
}

#[test]
fn a_search_does_not_overwrite_its_goal() {
    let place = Place::new();
    let goal = format!("# Mine.\n{GOAL}");
    fs::write(place.path("goal.toml"), &goal).expect("writable");
    for start in ["", "--resume", "--fresh"] {
        place.refused(&format!("optimise goal.toml --out . {start}"));
        assert_eq!(place.read("goal.toml"), goal);
    }
    assert_eq!(place.list("."), "goal.toml");
}

#[test]
fn a_changed_optimum_is_detected_and_repaired() {
    let place = place();
    place.prints("optimise my/goal.toml --out found");
    place.prints("report r --front found");
    for file in ["optimum.csv", "goal.toml"] {
        let sound = place.read(&format!("found/{file}"));
        fs::write(place.path(format!("found/{file}")), sound.replace('1', "2")).expect("writable");
        let message = place.refused("report r --front found");
        assert!(
            message.starts_with(&format!("error: found/{file}: was changed after")),
            "{message}"
        );
        place.prints("optimise my/goal.toml --out found --resume");
        assert_eq!(place.read(&format!("found/{file}")), sound);
        place.prints("report r --front found");
    }
}

#[test]
fn a_changed_analysis_or_optimum_is_detected_and_repaired() {
    let place = place();
    let tolerance = "tolerance x.toml --samples 4 --require coverage>=0.1 --out made";
    let search = "optimise my/goal.toml --out found --resume";
    for (file, again, reader) in [
        ("made/yield.csv", tolerance, "export made --xlsx x.xlsx"),
        ("made/tolerance.csv", tolerance, "export made --xlsx x.xlsx"),
        ("found/optimum.toml", search, "design found --out one"),
    ] {
        place.prints(again);
        place.prints(reader);
        let sound = place.read(file);
        fs::write(place.path(file), sound.replace('1', "2")).expect("writable");
        let message = place.refused(reader);
        assert!(message.starts_with(&format!("error: {file}: was changed after")), "{message}");
        place.prints(again);
        assert_eq!(place.read(file), sound);
        place.prints(reader);
    }
    // The next analysis has no requirements and writes no `yield.csv`. A `yield.csv` of the user is
    // kept, but not accepted as a table of this analysis.
    fs::write(place.path("made/yield.csv"), "mine").expect("writable");
    place.prints("tolerance x.toml --samples 4 --out made");
    let message = place.refused("export made --xlsx x.xlsx");
    assert!(message.starts_with("error: made/yield.csv: was not written"), "{message}");
    assert_eq!(place.read("made/yield.csv"), "mine");
}

#[test]
fn a_forged_record_removes_nothing_outside_its_folder() {
    let place = place();
    let record = "product = 'p'\ncommand = 'c'\nfrom = ''\n[files]\n'../mine.txt' = ''\n";
    fs::write(place.path("mine.txt"), "mine").expect("writable");
    fs::create_dir(place.path("r/derived")).expect("a folder");
    fs::write(place.path("r/derived/x.toml"), record).expect("writable");
    fs::write(place.path("r/derived/notes.txt"), "mine").expect("writable");
    place.squama("run x.toml -q --fresh --out r").assert().code(0);
    assert_eq!(place.read("mine.txt"), "mine");
    assert_eq!(place.list("r/derived"), "notes.txt");
}

/// Returns the texts of the journals of samples in the folder `out`.
fn sample_journals(place: &Place) -> Vec<String> {
    let names = place.list("out/samples");
    let names = names.split(' ').filter(|name| name.contains(".jsonl"));
    names.map(|name| place.read(&format!("out/samples/{name}"))).collect()
}

#[test]
fn samples_of_each_definition_are_kept() {
    let place = place();
    let tolerance = "tolerance x.toml --samples 20 --design 1 --out out";
    place.prints(tolerance);
    let [first] = sample_journals(&place).try_into().expect("one journal");
    // A table of the user, or of an earlier version of squama, is kept as well.
    fs::write(place.path("out/samples/0001.csv"), "mine").expect("writable");
    place.prints(&format!("{tolerance} --set designs.length_over_t=2"));
    assert_eq!(sample_journals(&place).len(), 2);
    assert_eq!(place.list("out/samples").matches(".csv").count(), 3, "two tables of squama");
    assert_eq!(place.read("out/samples/0001.csv"), "mine");
    place.prints(tolerance);
    assert!(sample_journals(&place).contains(&first), "nothing is solved again");
}

#[test]
fn a_million_designs_are_rejected_immediately() {
    let many = "{ from = 0.1, to = 1, step = 0.001 }";
    let slants = "{ from = 0, to = 70, step = 0.01 }";
    let text = COVERED.replace("[0.1, 0.3]", many).replace("[30, 45]", slants);
    let place = Place::with(&text);
    let message = place.refused("tolerance x.toml --samples 2");
    assert!(message.contains("designs exceed the limit of 100000"), "{message}");
}

#[test]
fn partial_files_of_a_killed_process_are_removed() {
    let place = place();
    place.prints("optimise my/goal.toml --out found");
    let abandoned = ".x.csv.squama-1-2.partial";
    for command in [
        "rank r --maximize coverage --out out",
        "compare r r --out out",
        "tolerance x.toml --samples 2 --out out",
        "sensitivity --global my/box.toml --samples 4 --out out",
        "design x.toml --design 1 --out out",
        "export r --xlsx out/x.xlsx",
        "plot r --out out",
        "report r --out out/page.html",
        "make x.toml --design 1 --set material.thickness_mm=1 --out out/x.3mf",
        "explore x.toml --set designs.gap_over_t=0.1 --set designs.slant_deg=30 --out out/x.html",
        "init out/mine.toml",
        "optimise my/goal.toml --out out",
    ] {
        fs::create_dir_all(place.path("out")).expect("a folder");
        fs::write(place.path(format!("out/{abandoned}")), "half").expect("writable");
        place.squama(command).assert().code(0);
        assert!(!place.path(format!("out/{abandoned}")).exists(), "{command}");
    }
}

/// Commands that write files for the user, such as drawings and pages, with the names of the files.
const FILE_WRITERS: [(&str, &[&str]); 12] = [
    ("make m.toml --design 1 --out out/s.3mf", &["s.3mf", "s.parts.txt"]),
    ("make m.toml --design 1 --out out/s.stl", &["s.stl", "s.parts.txt"]),
    ("make m.toml --design 1 --out out/s.step", &["s.step"]),
    ("make m.toml --design 1 --out out/s.dxf", &["s.dxf"]),
    ("make m.toml --design 1 --out out/s.svg", &["s.svg"]),
    ("explore x.toml --no-open --out out/explore.html", &["explore.html"]),
    ("report r --out out/report.html", &["report.html"]),
    (
        "slurm x.toml --shards 1 --out out",
        &["slurm/submit.sh", "slurm/merge.sh", "slurm/array.sh", "slurm/sweep.toml"],
    ),
    ("man out", &["squama.1", "squama-run.1"]),
    ("export r --xlsx out/x.xlsx", &["x.xlsx"]),
    ("draw m.toml --design 1 --out out", &["design-0001-puncture-at-critical-tilt.svg"]),
    ("draw m.toml --design 1 --animate --out out", &["design-0001-puncture-animation.html"]),
];

#[test]
fn files_that_squama_did_not_write_are_never_replaced() {
    let place = place();
    let material = COVERED.replace("[designs]", "[material]\nthickness_mm = 2\n[designs]");
    fs::write(place.path("m.toml"), material).expect("writable");
    for (command, files) in FILE_WRITERS {
        fs::create_dir_all(place.path("out/slurm")).expect("a folder");
        // Run the command twice, because it must replace its own files.
        for _ in 0..2 {
            place.squama(command).assert().code(0);
        }
        for file in files {
            let path = place.path(format!("out/{file}"));
            fs::write(&path, "mine").expect(file);
            let message = place.refused(command);
            assert!(
                message.starts_with(&format!("error: out/{file}: cannot be written")),
                "{message}"
            );
            assert_eq!(fs::read(&path).expect(file), b"mine", "{command}");
            fs::remove_file(&path).expect(file);
        }
        fs::remove_dir_all(place.path("out")).expect("a folder");
    }
}

/// Returns the paths of the CSV files in a folder and its subfolders.
fn tables_below(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let mut tables = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            tables.extend(tables_below(&path));
        } else if path.extension().is_some_and(|extension| extension == "csv") {
            tables.push(path);
        }
    }
    tables
}

#[test]
fn every_command_keeps_the_csv_format_of_its_results_folder() {
    let place = place();
    for command in [
        "run x.toml -q --csv excel-eu --out eu",
        "tolerance eu --samples 2",
        "design eu --design 1",
        "sensitivity --global my/box.toml --samples 4 --out eu/box",
        "rank eu --maximize coverage",
        "optimise my/goal.toml --out found --csv excel-eu",
        "optimise my/goal.toml --out found --resume",
    ] {
        place.squama(command).assert().code(0);
    }
    let tables = [tables_below(&place.path("eu")), tables_below(&place.path("found"))].concat();
    assert!(tables.len() > 12, "{tables:?}");
    for table in tables {
        let bytes = fs::read(&table).expect("a table");
        assert!(bytes.starts_with("\u{feff}".as_bytes()), "{}", table.display());
    }
}

#[test]
fn a_step_file_is_not_replaced_if_its_list_of_parts_cannot_be_written() {
    let place = place();
    let material = COVERED.replace("[designs]", "[material]\nthickness_mm = 2\n[designs]");
    fs::write(place.path("m.toml"), material).expect("writable");
    fs::create_dir(place.path("a.parts.txt")).expect("a folder");
    fs::write(place.path("a.step"), "an earlier part by squama").expect("writable");
    place.refused("make m.toml --design 1 --out a.step");
    assert_eq!(place.read("a.step"), "an earlier part by squama");
}

#[cfg(unix)]
#[test]
fn endless_inputs_are_rejected() {
    let place = place();
    make_pipe(&place.path("p"));
    for (definition, file) in [("pipe.toml", "p"), ("zero.toml", "/dev/zero")] {
        let text = format!(
            "name = 'f'\n[designs]\ngap_over_t = 0.2\nlength_over_t = 0.8\nslant_deg = 60\n\
             [material]\nthickness_mm = 2\n[variables]\nsubstrate_modulus_MPa = {{ from = 0.1, to = 2 }}\n\
             [[curve]]\nfile = '{file}'\nkind = 'puncture'\n"
        );
        fs::write(place.path(definition), text).expect("writable");
    }
    let sections: Vec<String> = (0..150_000).map(|k| format!("[s{k}]")).collect();
    fs::write(place.path("sections.toml"), sections.join("\n")).expect("writable");
    let commands = [
        ("fit pipe.toml", "p: cannot be read (it is not a regular file)"),
        ("fit zero.toml", "/dev/zero: cannot be read (it is not a regular file)"),
        ("check p", "not a regular file"),
        ("run p", "not a regular file"),
        ("make p", "not a regular file"),
        ("optimise p", "not a regular file"),
        ("explore p --no-open", "not a regular file"),
        ("fit p", "not a regular file"),
        ("check /dev/zero", "not a regular file"),
        ("check sections.toml", "it has more than 100000 keys"),
    ];
    for (command, reason) in commands {
        let mut squama = place.squama(command);
        let assert = squama.timeout(Duration::from_secs(60)).assert().code(2);
        let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(message.contains(reason), "{command}: {message}");
        assert_eq!(message.lines().count(), 1, "{command}: {message}");
    }
}

/// Creates a named pipe at `path`.
fn make_pipe(path: &Path) {
    let status = std::process::Command::new("mkfifo").arg(path).status();
    assert!(status.expect("mkfifo").success());
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_rejected_as_records_and_journals() {
    use std::os::unix::fs::symlink;
    for device in ["", "/dev/zero"] {
        for (file, command) in [
            ("r/contents.toml", "rank r --maximize coverage"),
            ("r/derived/ranking.toml", "export r --xlsx x.xlsx"),
            ("r/run.toml", "export r --xlsx x.xlsx"),
            ("r/ranking.toml", "report r"),
            ("found/evaluations.jsonl", "optimise my/goal.toml --out found --resume"),
            ("found/derived/search.toml", "report r --front found"),
            ("found/optimum.csv", "report r --front found"),
        ] {
            let place = place();
            place.prints("rank r --maximize coverage");
            place.prints("optimise my/goal.toml --out found");
            fs::remove_file(place.path(file)).expect("a file");
            if device.is_empty() {
                make_pipe(&place.path(file));
            } else {
                symlink(device, place.path(file)).expect("a link");
            }
            let mut squama = place.squama(command);
            let assert = squama.timeout(Duration::from_secs(60)).assert().code(2);
            let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
            assert_eq!(message.lines().count(), 1, "{command} {device} {file}: {message}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_name_may_be_invalid_utf8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;

    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let strange = OsStr::from_bytes(b"r\xff");
    fs::rename(place.path("r"), place.path(strange)).expect("a folder");
    for command in ["rank", "rank --json", "report", "plot", "export", "status", "compare"] {
        let mut squama = place.squama(command);
        squama.arg(strange);
        match command {
            "compare" => squama.arg(strange),
            "plot" => squama.args(["--out", "figures"]),
            "export" => squama.args(["--xlsx", "x.xlsx"]),
            _ => &mut squama,
        };
        squama.assert().code(0);
    }
}

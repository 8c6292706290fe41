//! Runs the commands of the tutorial and of the README, and checks values that the README quotes.

use std::fs;
use std::path::Path;

use crate::{Place, long_campaigns};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../..");

/// Returns the contents of the fenced code blocks of a kind, such as `sh`.
fn blocks(text: &str, kind: &str) -> Vec<String> {
    let fence = format!("```{kind}\n");
    let blocks = text.split(&fence).skip(1);
    blocks.map(|block| block.split("```").next().expect("a fence").to_owned()).collect()
}

/// Splits a command into words as a shell does, with single quotes.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for (k, part) in line.split('\'').enumerate() {
        let pieces: Vec<&str> = if k % 2 == 1 { vec![part] } else { part.split(' ').collect() };
        for (k, piece) in pieces.into_iter().enumerate() {
            if k > 0 {
                words.push(String::new());
            }
            words.last_mut().expect("a word").push_str(piece);
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Copies the definitions of sweeps and goals to a folder.
fn copy_sweeps(place: &Place) {
    for folder in ["sweeps", "sweeps/goals"] {
        fs::create_dir_all(place.path(folder)).expect("a folder");
        for entry in fs::read_dir(Path::new(ROOT).join(folder)).expect("sweeps") {
            let entry = entry.expect("an entry");
            if entry.path().is_file() {
                let copy = place.path(Path::new(folder).join(entry.file_name()));
                fs::copy(entry.path(), copy).expect("a copy");
            }
        }
    }
}

#[test]
fn every_command_of_the_tutorial_runs_and_writes_its_files() {
    let text = fs::read_to_string(Path::new(ROOT).join("docs/tutorial.md")).expect("a tutorial");
    let place = Place::new();
    copy_sweeps(&place);
    if !long_campaigns() {
        // Make the search quick: the yield takes minutes, and steep slants half of the rest.
        let mut goal = place.read("sweeps/goals/pin.toml");
        for (slow, quick) in [
            (r#", "yield >= 0.9""#, ""),
            ("skins =", "# skins ="),
            ("samples = 48", "samples = 16"),
            ("slant_deg = { from = 0, to = 75 }", "slant_deg = { from = 0, to = 30 }"),
        ] {
            assert!(goal.contains(slow), "{goal}");
            goal = goal.replace(slow, quick);
        }
        fs::write(place.path("sweeps/goals/pin.toml"), goal).expect("a goal");
    }
    for file in blocks(&text, "toml") {
        let name = file.lines().next().and_then(|line| line.strip_prefix("# "));
        fs::write(place.path(name.expect("a name in the first line")), &file).expect("a file");
    }
    let mut count = 0;
    for line in blocks(&text, "sh").iter().flat_map(|block| block.lines()) {
        let Some(arguments) = line.strip_prefix("squama ") else { continue };
        let (arguments, remark) = arguments.split_once('#').unwrap_or((arguments, ""));
        let code = i32::from(remark.contains("exits with 1"));
        place.squama_with(&words(arguments)).assert().code(code);
        count += 1;
    }
    assert!(count > 35, "{count}");
    for file in [
        "results/steep/contents.toml",
        "steep.xlsx",
        "results/short/reruns.csv",
        "results/wrist/report.html",
        "wrist.xlsx",
        "results/palm/optimum.csv",
        "results/palm-front/front.svg",
        "results/palm-fitness/optimum.csv",
        "results/pin/tolerance/yield.csv",
        "pin.3mf",
        "pin.parts.txt",
        "palm.3mf",
        "palm.step",
        "palm-cut.parts.txt",
        "results/made/tolerance/yield.csv",
        "results/box/sensitivity/sobol.csv",
    ] {
        assert!(place.path(file).is_file(), "{file}");
    }
}

#[test]
fn the_readme_quotes_values_of_the_tables() {
    let text = fs::read_to_string(Path::new(ROOT).join("README.md")).expect("a README");
    let place = Place::new();
    copy_sweeps(&place);
    place.prints("run sweeps/paper.toml");
    let printed = place.prints("rank results/paper");
    let answer = blocks(&text, "text");
    assert!(answer[0].lines().count() > 3, "{text}");
    for line in answer[0].lines() {
        assert!(printed.lines().any(|printed| printed == line), "{line}\n{printed}");
    }
    // Nine designs of the glove meet the requirements on a flat body, but none on a finger.
    assert!(text.contains("On a flat body 9 of 240 designs cover 0.6 and withstand 1.2 N, on the"));
    let require = "--require coverage>=0.6 --require failure_force_N>=1.2";
    place.prints("run sweeps/glove.toml --set body.curvature_times_t=0");
    let flat = place.prints(&format!("rank results/glove {require}"));
    assert!(flat.contains("9 of 240 designs ranked"), "{flat}");
    place.prints("run sweeps/glove.toml --fresh");
    let finger = place.squama(&format!("rank results/glove {require}")).assert().code(1);
    let finger = String::from_utf8_lossy(&finger.get_output().stdout).into_owned();
    assert!(finger.contains("none of 240 designs meets all requirements"), "{finger}");
}

//! Commands that need no files: templates of definitions, completions, manual pages, version.

use crate::Place;

#[test]
fn init_writes_a_definition_that_run_solves() {
    let place = Place::new();
    let text = place.prints("init smoke mine.toml");
    assert_eq!(text, "mine.toml: 12 designs; to solve them: squama run mine.toml\n");
    let definition = place.read("mine.toml");
    let comment = definition.strip_prefix("#:schema ./squama.schema.json\n# ");
    assert!(comment.is_some_and(|text| text.contains("name = \"mine\"")), "{definition}");
    assert_eq!(place.read("squama.schema.json"), place.prints("schema"));
    assert!(definition.contains("squama run mine.toml     the tables, in results/mine/"));
    place.squama("run mine.toml -q").assert().code(0);
    assert!(place.path("results/mine/designs.csv").is_file());
}

#[test]
fn every_template_is_valid() {
    let names = ["paper", "smoke", "gaps", "imperfection", "paper-as-written", "paper-neo-hookean"];
    for name in names {
        let place = Place::new();
        place.prints(&format!("init {name}"));
        let text = place.prints(&format!("check {name}.toml"));
        assert!(text.starts_with(&format!("{name}.toml is valid\n")), "{text}");
        assert!(text.lines().any(|line| line.ends_with(&format!(" results/{name}"))), "{text}");
    }
}

#[test]
fn goals_and_fits_are_templates_that_check_accepts() {
    let templates = [("goal", "goal for squama optimise"), ("fit", "test for squama fit")];
    for (name, kind) in templates.into_iter().chain([("pin", "goal for squama optimise")]) {
        let place = Place::new();
        place.prints(&format!("init {name} mine.toml"));
        let text = place.prints("check mine.toml");
        assert!(text.starts_with(&format!("mine.toml is a valid {kind}\n")), "{text}");
        assert!(place.read("mine.toml").contains("name = \"mine\""));
        let record = place.prints("check mine.toml --json");
        assert!(record.contains("\"mine\""), "{record}");
    }
}

#[test]
fn init_overwrites_no_file_and_refuses_missing_folders() {
    let place = Place::new();
    place.prints("init");
    let before = place.read("paper.toml");
    std::fs::write(place.path("squama.schema.json"), "{}").expect("writable");
    insta::assert_snapshot!(place.refused("init"), @"error: paper.toml: exists already; give the name of a new file, e.g. squama init paper mine.toml");
    insta::assert_snapshot!(place.refused("init smoke nowhere/mine.toml"), @"error: FILE nowhere/mine.toml: there is no folder nowhere");
    insta::assert_snapshot!(place.refused("init smoke .hidden.toml"), @r#"error: .hidden.toml:7: name: ".hidden" is not accepted, expected a name for a folder on any system: letters, digits, - _ + . and spaces, a letter or digit first, and not a device name of Windows such as con or lpt1"#);
    insta::assert_snapshot!(place.refused("init smok"), @"error: invalid value 'smok' for '[TEMPLATE]', [possible values: paper, smoke, glove, goal, pin, fit, gaps, imperfection, paper-as-written, paper-neo-hookean], tip: a similar value exists: 'smoke'");
    assert_eq!(place.list("."), "paper.toml squama.schema.json");
    place.prints("init smoke");
    let both = [place.read("paper.toml"), place.read("squama.schema.json")];
    assert_eq!(both, [before, "{}".to_owned()]);
}

#[test]
fn completions_of_every_shell_contain_commands_and_options() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = place.prints(&format!("completions {shell}"));
        for word in ["squama", "rerun", "dry-run"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
}

#[test]
fn manual_pages_are_written_for_every_command() {
    let place = Place::new();
    place.prints("man pages");
    let pages = place.list("pages");
    for page in ["squama.1", "squama-run.1", "squama-plot-curves.1"] {
        assert!(pages.contains(page), "{pages}");
    }
    let page = place.read("pages/squama-run.1");
    assert!(page.contains(".TH") && page.contains("fail\\-fast"), "{page}");
    assert!(page.contains("squama run sweeps/paper.toml"), "{page}");
}

#[test]
fn the_version_states_the_source_revision() {
    let text = Place::new().prints("--version");
    let revision = text.trim_end().rsplit_once(" (").expect("a revision").1;
    let revision = revision.trim_end_matches(')');
    // If the sources differ from the commit, the revision also contains a hash of the sources.
    let (commit, changes) = revision.split_once("-dirty-").unwrap_or((revision, ""));
    let is_hash = commit.chars().chain(changes.chars()).all(|c| c.is_ascii_hexdigit());
    let is_named = commit.len() == 12 && is_hash;
    assert!(is_named || revision == "unknown", "{text}");
}

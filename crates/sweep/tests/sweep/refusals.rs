//! Refusals: one line with file, key, value and what would be right.

use sweep::{Setting, Sweep};

fn refused(text: &str, settings: &[&str]) -> String {
    let settings: Vec<_> = settings.iter().map(|s| Setting::parse(s).expect("valid")).collect();
    let message = Sweep::parse(text, "x.toml", &settings).expect_err("refused").to_string();
    assert_eq!(message.lines().count(), 1, "{message}");
    message
}

/// The messages for definitions that are a name and `lines`.
fn all(lines: &[&str]) -> String {
    let message = |line: &&str| refused(&format!("name = 'x'\n{line}"), &[]);
    lines.iter().map(message).collect::<Vec<_>>().join("\n")
}

#[test]
fn keys() {
    insta::assert_snapshot!(all(&[
        "contact.cc2 = 0.23",
        "contact.c3 = 0.23",
        "conatct.c1 = 1",
        "scales = 41",
        "scale.c2 = 1",
        "designs.slant = 45",
        "designs.gap_over_t.form = 1",
        "definition.name = 'y'",
    ]));
    insta::assert_snapshot!(refused("", &[]));
}

#[test]
fn values() {
    insta::assert_snapshot!(all(&[
        "designs.gap_over_t = -0.1",
        "designs.slant_deg = 90",
        "designs.slant_deg = [0, 90]",
        "designs.slant_deg = []",
        "designs.slant_deg = [0, 45, 45.0]",
        "contact.c2 = 0",
        "contact.c1 = nan",
        "contact.c1 = -inf",
        "contact.c1 = '1.1'",
        "contact.c1 = [1, 2]",
        "contact.c1 = true",
        "contact.c1 = 1979-05-27",
        "contact = 3",
        "substrate.poisson_ratio = 0.6",
        "scale.base = '3L'",
        "puncture.scales = 0",
        "puncture.scales = 2.5",
        "puncture.scales = 'many'",
        "solver.max_iterations = -1",
        "solver.min_step = 0.2",
        "designs.min_step = [1e-9, 0.2]",
        "flexure.method = 'cell'",
        "flexure.membrane_length_over_t = 0",
        "flexure.membrane_thickness_over_t = -0.125",
        "flexure.membrane_axis_offset_over_t = inf",
        "flexure.gaps = 0",
        "flexure.gaps = 42\nflexure.membrane_length_over_t = 50",
        "flexure.gaps = 42\ndesigns.membrane_length_over_t = [50, 100]",
        "flexure.membrane_length_over_t = 50\ndesigns.gaps = ['auto', 42]",
        "flexure.elements_per_gap = 0",
        "flexure.elements_per_gap = 1.5",
        "flexure.max_end_rotation_deg = 181",
        "flexure.contact_modulus_over_membrane = 0",
        "designs.method = ['chain', 'chains']",
        "measures = ['couverage']",
        "measures = ['flexibility']",
        "measures = ['coverage', 'coverage']",
        "measures = []",
        "measures = 3",
    ]));
}

#[test]
fn ranges() {
    insta::assert_snapshot!(all(&[
        "designs.slant_deg = { from = 0, to = 75, step = 0 }",
        "designs.slant_deg = { from = 0, to = 75, step = -15 }",
        "designs.slant_deg = { from = 75, to = 0, step = 15 }",
        "designs.slant_deg = { from = 0, to = 75, step = 10 }",
        "designs.slant_deg = { from = 0, to = 90, step = 15 }",
        "designs.slant_deg = { from = 0, to = 75 }",
        "designs.slant_deg = { from = 0, to = 75, steps = 5 }",
        "designs.slant_deg = { from = 0, to = 75, step = '15' }",
        "designs.slant_deg = { from = 0, to = 75, step = nan }",
        "designs.scales = { from = 1, to = 4, step = 1.5 }",
        "designs.base = { from = 1, to = 2, step = 1 }",
        "designs.gap_over_t = { from = 1e-30, to = 1, step = 1e-30 }",
    ]));
}

#[test]
fn contradictions_and_excess() {
    insta::assert_snapshot!(all(&[
        "contact.c1 = 2\ndesigns.c1 = [1, 2]",
        "designs.c1 = { from = 0.001, to = 1e6, step = 0.001 }",
        &["c1", "c2", "gap_over_t", "width_over_t"]
            .map(|key| format!("designs.{key} = {{ from = 1e-5, to = 1, step = 1e-5 }}\n"))
            .concat(),
    ]));
    insta::assert_snapshot!(refused("name = 'x'", &["contact.c1=2", "designs.c1=[1, 2]"]));
}

#[test]
fn names() {
    let names = ["''", "'a/b'", "'..'", "'.hidden'", "'-x'", "'a\\b'", "'x '", "3"];
    let messages = names.map(|name| refused(&format!("name = {name}"), &[]));
    insta::assert_snapshot!(messages.join("\n"));
}

#[test]
fn files_that_are_no_toml() {
    let texts = ["this is no toml", "name = 'x'\n[contact", "name = 'x'\nname = 'y'", "\u{0}\u{1}"];
    insta::assert_snapshot!(texts.map(|text| refused(text, &[])).join("\n"));
}

#[test]
fn settings() {
    let messages = [
        "contact.c3=1",
        "contact.c2=0",
        "puncture.scales=many",
        "designs.slant_deg=[]",
        "name=../x",
        "c1=2",
        "name.x=2",
    ];
    insta::assert_snapshot!(messages.map(|set| refused("name = 'x'", &[set])).join("\n"));
}

proptest::proptest! {
    #[test]
    fn any_text_is_a_sweep_or_refused_in_one_line(text in "(name|designs|contact|c1|scales|base|gap_over_t|from|to|step|=|\\.|\\[|\\]|\\{|\\}|'|,|\n| |-|[0-9]|e|x){0,40}") {
        if let Err(error) = Sweep::parse(&text, "x.toml", &[]) {
            proptest::prop_assert_eq!(error.to_string().lines().count(), 1);
        }
    }
}

/// A list takes time in proportion to its length: each value is not compared with all before it.
#[test]
fn a_long_list_with_a_value_twice_is_refused_at_once() {
    let numbers = (1..=300_000).map(|k| format!("{k}e-6")).chain(["0.000001".to_owned()]);
    let list = numbers.collect::<Vec<_>>().join(", ");
    let start = std::time::Instant::now();
    let message = all(&[&format!("designs.gap_over_t = [{list}]")]);
    assert!(message.contains("0.000001"), "{message}");
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

//! Tests of refused definitions: messages of one line with file, key, value and accepted values.

use sweep::{PARAMETERS, Setting, Sweep};

/// Returns the message for the invalid definition `text`, one line per error.
fn errors(text: &str, settings: &[&str]) -> String {
    let settings: Vec<_> = settings.iter().map(|s| Setting::parse(s).expect("valid")).collect();
    Sweep::parse(text, "x.toml", &settings).expect_err("refused").to_string()
}

fn refused(text: &str, settings: &[&str]) -> String {
    let message = errors(text, settings);
    assert_eq!(message.lines().count(), 1, "{message}");
    message
}

/// Returns the messages for definitions that consist of a name and one of `lines`.
fn all(lines: &[&str]) -> String {
    lines
        .iter()
        .map(|line| refused(&format!("name = 'x'\n{line}"), &[]))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn invalid_keys_are_refused() {
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

/// Lengths and moduli of 1e-30 and 1e30 are refused without internal errors.
#[test]
fn extreme_lengths_and_moduli_are_refused() {
    let mut count = 0;
    for parameter in PARAMETERS.iter().filter(|parameter| {
        parameter.unit == "t"
            || parameter.unit.contains("mm")
            || parameter.key.contains("modulus")
            || ["c1", "c2"].contains(&parameter.key)
    }) {
        for value in ["1e-30", "1e30"] {
            let text = format!("name = 'x'\n{} = {value}", parameter.path());
            let message = Sweep::parse(&text, "x.toml", &[]).err().map(|error| error.to_string());
            // The range of these lengths contains 1e-30, so this value is not out of range. In mm
            // the length is still refused, because the thickness is missing.
            let small = ["load_inset", "membrane_axis_offset", "radius_mm", "radius_to_mm"];
            let may_be_small = small.iter().any(|start| parameter.key.starts_with(start));
            let is_refused = message.is_some_and(|message| message.contains("out of range"));
            assert!(is_refused || (value == "1e-30" && may_be_small), "{text}");
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}

#[test]
fn invalid_values_are_refused() {
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
        "puncture.critical_tilt_deg = [5, 10]\npuncture.needle_friction = 0.1",
        "puncture.critical_tilt_deg = 10\ndesigns.needle_friction = [0.1, 0.2]",
        "puncture.critical_tilt_deg = [10, 5]",
        "puncture.critical_tilt_deg = [5, 95]",
        "puncture.critical_tilt_deg = []",
        "puncture.needle_friction = [0.1, 0.1]",
        "designs.critical_tilt_deg = [[5, 10], 15]",
        "flexure.elements_per_gap = 0",
        "flexure.elements_per_gap = 1.5",
        "flexure.max_end_rotation_deg = 181",
        "flexure.contact_modulus_over_membrane = 0",
        "puncture.needle_friction = 1e30",
        "designs.length_over_t = 1e-30",
        "designs.method = ['chain', 'chains']",
        "measures = ['couverage']",
        "measures = ['flexibility']",
        "measures = ['coverage', 'coverage']",
        "measures = []",
        "measures = 3",
    ]));
}

#[test]
fn invalid_ranges_are_refused() {
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
        "designs.gap_over_t = { from = 1, to = 2, step = 1e-30 }",
    ]));
}

#[test]
fn contradictory_keys_and_too_many_values_are_refused() {
    insta::assert_snapshot!(all(&[
        "contact.c1 = 2\ndesigns.c1 = [1, 2]",
        "designs.c1 = { from = 0.001, to = 1e6, step = 0.001 }",
        &["c1", "c2", "gap_over_t", "width_over_t"]
            .map(|key| format!("designs.{key} = {{ from = 0.05, to = 1, step = 1e-5 }}\n"))
            .concat(),
    ]));
    insta::assert_snapshot!(refused("name = 'x'", &["contact.c1=2", "designs.c1=[1, 2]"]));
}

#[test]
fn invalid_names_are_refused() {
    let names = ["''", "'a/b'", "'..'", "'.hidden'", "'-x'", "'a\\b'", "'x '", "3"];
    let messages = names.map(|name| refused(&format!("name = {name}"), &[]));
    insta::assert_snapshot!(messages.join("\n"));
}

#[test]
fn invalid_toml_is_refused() {
    let texts = ["this is no toml", "name = 'x'\n[contact", "name = 'x'\nname = 'y'", "\u{0}\u{1}"];
    insta::assert_snapshot!(texts.map(|text| refused(text, &[])).join("\n"));
}

#[test]
fn all_errors_are_reported_at_once() {
    let text = "names = 'x'\n[designs]\ngap = 0.1\nslant_deg = [0, 90]\nc1 = 1\n\
                [contact]\nc1 = 2\nc2 = 0\n[puncture]\nscales = 'many'";
    insta::assert_snapshot!(errors(text, &["solver.max_step=0"]), @r#"
    x.toml:1: names: unknown key (its value is "x"), did you mean name?
    x.toml:3: designs.gap: unknown key (its value is 0.1), did you mean designs.gap_over_t?
    x.toml:4: designs.slant_deg: 90 is out of range, expected an angle of at least 0 and below 90
    x.toml:8: contact.c2: 0 is out of range, expected a number of at least 0.05 and at most 1.5
    x.toml:10: puncture.scales: "many" is not accepted, expected a whole number from 1 to 1000000 or "auto"
    --set solver.max_step=0: solver.max_step: 0 is out of range, expected a fraction above 0 and at most 1
    x.toml:7: contact.c1: 2 conflicts with designs.c1 at x.toml:5; keep one of the two
    x.toml: name: missing, expected the name of the sweep, e.g. name = "paper"
    "#);
    let text = "name = x\n[designs]\nslant_deg 30\ngap_over_t = 0.1";
    insta::assert_snapshot!(errors(text, &[]), @r#"
    x.toml:1: name = x: not valid TOML (string values must be quoted, expected literal string), expected key = value or [section]
    x.toml:3: slant_deg 30: not valid TOML (key with no value, expected `=`), expected key = value or [section]
    "#);
}

#[test]
fn invalid_settings_are_refused() {
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
    fn any_text_is_a_sweep_or_refused_in_a_line_for_each_error(text in "(name|designs|contact|c1|scales|base|gap_over_t|from|to|step|=|\\.|\\[|\\]|\\{|\\}|'|,|\n| |-|[0-9]|e|x){0,40}") {
        if let Err(error) = Sweep::parse(&text, "x.toml", &[]) {
            let message = error.to_string();
            proptest::prop_assert!(message.lines().all(|line| line.starts_with("x.toml")), "{}", message);
        }
    }
}

/// The time limit excludes algorithms that compare all pairs of values, which take minutes.
#[test]
fn a_long_list_with_a_repeated_value_is_refused_quickly() {
    let numbers = (1..=300_000).map(|k| format!("{k}e-3")).chain(["0.001".to_owned()]);
    let list = numbers.collect::<Vec<_>>().join(", ");
    let start = std::time::Instant::now();
    let message = all(&[&format!("designs.gap_over_t = [{list}]")]);
    assert!(message.contains("0.001 is in the list twice"), "{message}");
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

#[test]
fn device_names_of_windows_are_refused() {
    for name in ["con", "NUL", "aux.1", "Com1", "lpt9", "com²", "prn .x"] {
        let text = format!("name = '{name}'");
        let error = Sweep::parse(&text, "x.toml", &[]).expect_err("refused").to_string();
        assert!(error.contains("not a device name of Windows such as con or lpt1"), "{error}");
    }
    for name in ["control", "com10", "console.1", "lpt", "nul-1"] {
        let text = format!("name = '{name}'");
        assert!(Sweep::parse(&text, "x.toml", &[]).is_ok(), "{name}");
    }
}

/// The time limit allows for a busy machine; an algorithm of quadratic time would take minutes.
#[test]
fn long_lists_and_many_keys_are_processed_quickly() {
    let begun = std::time::Instant::now();
    let values: Vec<_> = (1..=300_000).map(|k| format!("{}", f64::from(k) * 1e-3)).collect();
    let text = format!("name = 'x'\n[designs]\ngap_over_t = [\n{}\n]", values.join(",\n"));
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a sweep");
    assert_eq!(sweep.grid().axis("gap_over_t").expect("an axis").len(), 300_000);
    let twice = text.replace("\n]", ",\n0.25\n]");
    let error = Sweep::parse(&twice, "x.toml", &[]).expect_err("refused").to_string();
    assert!(error.contains("0.25 is in the list twice"), "{error}");
    let equal = "name = 'x'\ndesigns.gap_over_t = [0.2, 0.25, 0.25000000000000006]";
    let error = Sweep::parse(equal, "x.toml", &[]).expect_err("refused").to_string();
    assert!(error.contains("0.25000000000000006 is in the list twice"), "{error}");
    let keys: Vec<_> = (0..100_000).map(|k| format!("key{k} = {k}")).collect();
    let keys = keys.join("\n");
    let error = Sweep::parse(&keys, "x.toml", &[]).expect_err("refused").to_string();
    assert!(error.starts_with("x.toml:1: key0: unknown key"), "{error}");
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
}

#[test]
fn deeply_nested_settings_are_refused() {
    let deep = format!("{}x=1", "a.".repeat(20_000));
    let error = sweep::Setting::parse(&deep).expect_err("refused").to_string();
    assert!(error.contains("a key of 20001 parts"), "{}", &error[error.len() - 100..]);
    for nested in [
        "[".repeat(20_000),
        "{a=".repeat(20_000),
        format!("{}{}", "[".repeat(20_000), "]".repeat(20_000)),
    ] {
        assert!(sweep::Setting::parse(&format!("designs.slant_deg={nested}")).is_err());
    }
}

#[test]
fn invalid_variables_are_refused() {
    insta::assert_snapshot!(all(&[
        "variables = 3",
        "variables.gap = [1, 2]",
        "variables.gap_over_t = 1",
        "variables.gap_over_t = [1]",
        "variables.gap_over_t = { from = 1, to = 1 }",
        "variables.gap_over_t = { from = 1, to = 2, step = 1 }",
        "variables.gap_over_t = { from = 1 }",
        "variables.gap_over_t = { from = 0, to = 1 }",
        "variables.needle_friction = { from = 'none', to = 1 }",
        "variables.scales = { from = 3, to = 5 }",
        "variables.base = { from = 3, to = 5 }",
        "variables.c1 = [1, 2]\ncontact.c1 = 1",
        "variables.c1 = [1, 2]\ndesigns.c1 = 1",
        "variables.critical_tilt_deg = { from = 5, to = 10 }\npuncture.needle_friction = 0.1",
        "variables.needle_friction = [0.1, 0.2]\npuncture.critical_tilt_deg = [5, 10]",
    ]));
}

#[test]
fn invalid_deviations_are_refused() {
    insta::assert_snapshot!(all(&[
        "tolerance = 1e-3",
        "tolerance.gap = 0.1",
        "tolerance.gap_over_t = 0.1",
        "tolerance.gap_over_t = {}",
        "tolerance.gap_over_t = { sd = 0.1 }",
        "tolerance.gap_over_t = { batch_sd = -0.1 }",
        "tolerance.gap_over_t = { batch_sd = 0.1, batch_within = 0.1 }",
        "tolerance.length_over_t = { scale_sd = 0.1 }",
        "tolerance.gap_mm = { batch_sd = 0.1 }",
        "tolerance.thickness_mm = { batch_sd = 0.1 }",
        "tolerance.scales = { batch_sd = 1 }",
        "tolerance.critical_tilt_deg = { batch_sd = 1 }",
        "tolerance.gap_over_t = { batch_sd = 1 }\nmaterial.thickness_mm = 1\ntolerance.gap_mm = { batch_sd = 1 }",
    ]));
}

#[test]
fn a_definition_with_millions_of_values_is_refused_before_parsing() {
    let text = format!("name = 'x'\n[designs]\ngap_over_t = [{}]", "1,".repeat(1_300_000));
    let error = Sweep::parse(&text, "x.toml", &[]).expect_err("too many").to_string();
    assert!(
        error.starts_with("x.toml:3: ") && error.contains("more than 1200000 values"),
        "{error}"
    );
    assert_eq!(error.lines().count(), 1);
}

/// The moduli lack a denominator, contradict a ratio, or give a ratio below 1.
#[test]
fn invalid_scale_moduli_are_refused() {
    let scales = "material.scale_modulus_MPa = 3000\n";
    let both = "material.substrate_modulus_MPa = 0.3\nmaterial.membrane_modulus_MPa = 4.5\n";
    let texts = [
        scales.to_owned(),
        format!("{scales}material.substrate_modulus_MPa = 0.3"),
        format!("{scales}{both}puncture.contact_modulus_over_substrate = 9677"),
        format!("{scales}{both}designs.contact_modulus_over_membrane = [600, 700]"),
        format!(
            "{scales}{both}variables.contact_modulus_over_membrane = {{ from = 600, to = 700 }}"
        ),
        format!("{scales}{}", both.replace("0.3", "4000")),
        format!("{both}designs.scale_modulus_MPa = [1, 3000]"),
    ];
    insta::assert_snapshot!(all(&texts.each_ref().map(String::as_str)));
}

/// The thickness is missing, a length is given twice, or a relative length is too small.
#[test]
fn invalid_lengths_in_mm_are_refused() {
    insta::assert_snapshot!(all(&[
        "designs.gap_mm = 0.4",
        "scale.width_mm = 0",
        "scale = { width_mm = 2, width_over_t = 1 }\nmaterial.thickness_mm = 2",
        "designs = { gap_mm = [0.2, 0.4], gap_over_t = 0.1, thickness_mm = 2 }",
        "designs = { gap_mm = 1, length_over_t = 1, pitch_mm = 3, thickness_mm = 2 }",
        "variables = { gap_over_t = { from = 0.1, to = 1 }, gap_mm = { from = 0.1, to = 1 } }\nmaterial.thickness_mm = 2",
        "variables = { pitch_mm = { from = 2, to = 3 } }\ndesigns = { gap_mm = 1, length_mm = 1, thickness_mm = 2 }",
        "flexure = { gaps = 42, membrane_length_mm = 50 }\nmaterial.thickness_mm = 2",
        "puncture = { load_position = 0.5, load_inset_mm = 0.5 }\nmaterial.thickness_mm = 2",
        "designs = { gap_mm = 0.4, thickness_mm = [1, 1e3] }",
        "designs = { pitch_mm = 3, length_mm = 2, thickness_mm = 2 }\nscale.base = '2L'",
        "designs = { pitch_mm = 0.1, gap_mm = 0.1, thickness_mm = 0.4 }",
        "variables = { pitch_mm = { from = 1.5, to = 3 }, length_mm = { from = 1, to = 2 } }\nmaterial.thickness_mm = 2",
        "tolerance.tissue_thickness_mm = { batch_sd = 0.1 }\nmaterial.thickness_mm = 2",
    ]));
}

#[test]
fn elastic_scales_need_a_free_needle_without_friction() {
    let elastic = "scale.bending = 'elastic'";
    for (other, needed) in [
        ("puncture.needle = 'guided'", r#"puncture.needle = "free""#),
        ("designs.needle = ['free', 'guided']", r#"puncture.needle = "free""#),
        ("contact.friction = 0.1", "contact.friction = 0"),
        ("designs.friction = [0, 0.1]", "contact.friction = 0"),
    ] {
        let message = refused(&format!("name = 'x'\n{other}\n{elastic}"), &[]);
        assert!(message.contains(&format!("scale.bending: needs {needed}")), "{message}");
    }
    let free = format!("name = 'x'\n{elastic}\ncontact.friction = 0");
    assert!(Sweep::parse(&free, "x.toml", &[]).is_ok());
}

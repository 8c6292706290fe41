//! `squama tolerance` and `squama sensitivity`: reproducible tables, output and errors.

use crate::Place;

const DESIGNS: &str = "name = 'skin'\nmeasures = ['coverage', 'puncture']\n[designs]\ngap_over_t = [0.1, 0.3]\nlength_over_t = 0.5\nslant_deg = 45\n\
                       [material]\nthickness_mm = 8\nsubstrate_modulus_MPa = 0.31\n[tolerance]\n\
                       gap_mm = { batch_sd = 0.1, scale_sd = 0.05 }\nslant_deg = { batch_within = 1 }\n";

const TABLES: [&str; 3] = ["tolerance.csv", "tolerance_sources.csv", "yield.csv"];

const BOX: &str = "name = 'box'\nmeasures = ['coverage', 'puncture']\n[puncture]\nscales = 5\n[variables]\n\
                   gap_over_t = { from = 0.1, to = 0.5 }\nlength_over_t = [0.5, 1]\nslant_deg = { from = 30, to = 60 }\n";

#[test]
fn tables_are_the_same_for_any_number_of_threads_and_after_an_interruption() {
    let place = Place::with(DESIGNS);
    let command = "tolerance x.toml --require critical_force_N>=0.5 --require coverage>=0.8";
    place.prints(&format!("{command} --samples 120 --threads 1 --out one"));
    place.prints(&format!("{command} --samples 120 --threads 2 --out two"));
    // Solve fewer samples first and then more, as after an interruption.
    place.prints(&format!("{command} --samples 30 --out three"));
    place.prints(&format!("{command} --samples 120 --out three"));
    let samples = place.list("one/samples");
    let second = samples.split(' ').find(|name| name.starts_with("0002") && name.contains(".csv"));
    let second = format!("samples/{}", second.expect("samples of the second design"));
    for table in TABLES.into_iter().chain([second.as_str()]) {
        let one = place.read(&format!("one/{table}"));
        assert!(one.lines().count() > 2, "{table}");
        for other in ["two", "three"] {
            assert_eq!(one, place.read(&format!("{other}/{table}")), "{table} {other}");
        }
    }
    let yields = place.read("one/yield.csv");
    let all = yields.lines().filter(|line| line.contains(",all,"));
    assert_eq!((yields.lines().count(), all.count()), (7, 2));
}

#[test]
fn a_single_design_is_reported_as_text_and_json() {
    let place = Place::with(DESIGNS);
    let command = "tolerance x.toml --design 2 --samples 50 --require critical_force_N>=0.1";
    let text = place.prints(command);
    for words in
        ["skin: design 0002 of 2, 50 samples", "gap_mm from scale to scale", "95 % interval"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&place.prints(&format!("{command} --json"))).expect("JSON");
    let yields = json["designs"][0]["yields"].as_array().expect("yields");
    assert_eq!(yields.len(), 2);
    assert_eq!(yields[0]["samples"], 50);
    let fraction = yields[0]["yield"].as_f64().expect("a fraction");
    let interval = &yields[0]["interval"];
    assert!(interval[0].as_f64() < Some(fraction) && interval[1].as_f64() >= Some(fraction));
    for figure in ["sources.svg", "histogram-critical-force-N.svg"] {
        let svg = place.read(&format!("results/skin/tolerance/{figure}"));
        assert!(svg.contains("<svg") && svg.contains("skin design 0002"), "{figure}");
    }
    // Without samples, the command computes only the linear prediction.
    let text = place.prints("tolerance x.toml --samples 0 --out linear");
    assert!(text.contains("2 designs of 2"), "{text}");
    assert_eq!(place.list("linear"), "derived tolerance.csv tolerance_sources.csv");
}

#[test]
fn global_sensitivity_is_the_same_for_any_number_of_threads() {
    let place = Place::with(BOX);
    let text = place.prints("sensitivity --global x.toml --samples 40 --threads 1 --out one");
    assert!(text.contains("box: 40 samples, 200 designs"), "{text}");
    place.prints("sensitivity --global x.toml --samples 40 --threads 2 --out two --json");
    assert_eq!(place.read("one/sobol.csv"), place.read("two/sobol.csv"));
    let table = place.read("one/sobol.csv");
    let of_force = table.lines().filter(|line| line.starts_with("critical_force,"));
    assert_eq!(of_force.count(), 3, "{table}");
}

/// The coverage of upright scales is 0 for any width and friction.
#[test]
fn constant_measures_are_named() {
    let constant = "name = 'constant'\nmeasures = ['coverage']\n[designs]\ngap_over_t = 0.1\n\
                    length_over_t = 0.5\nslant_deg = 0\n[variables]\n\
                    width_over_t = { from = 0.5, to = 2 }\nfriction = { from = 0, to = 0.5 }\n";
    let place = Place::with(constant);
    let text = place.prints("sensitivity --global x.toml --samples 8 --out all");
    let nothing = "Nothing varies: no measure depends on width_over_t, friction.";
    assert!(text.contains(nothing), "{text}");
    let json = place.prints("sensitivity --global x.toml --samples 8 --out all --json");
    let record: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(record["constant"], serde_json::json!(["coverage"]));
    let goal = format!("{constant}[goal]\nmaximize = ['coverage']\n");
    std::fs::write(place.path("goal.toml"), goal).expect("writable");
    let text = place.prints("optimise goal.toml --out found");
    assert!(text.contains("coverage is 0 in every evaluated design"), "{text}");
    let claims = ["limited by", "no better design", "The best design"];
    assert!(claims.iter().all(|claim| !text.contains(claim)), "{text}");
}

#[test]
fn bad_input_gives_a_one_line_error() {
    let place = Place::with(DESIGNS);
    std::fs::write(place.path("box.toml"), BOX).expect("writable");
    let bare = BOX.replace("length_over_t = [0.5, 1]\n", "");
    std::fs::write(place.path("several.toml"), bare).expect("writable");
    let messages: Vec<_> = [
        "tolerance x.toml --set tolerance.gap_mm=3",
        "tolerance x.toml --set tolerance.gap=3",
        "tolerance x.toml --require critical_forc_N>=1",
        "tolerance x.toml --require puncture_status>=1",
        "tolerance x.toml --require compliance>=1",
        "tolerance x.toml --require critical_force=>1",
        "tolerance x.toml --design 3",
        "tolerance x.toml --samples 1",
        "tolerance x.toml --samples -3",
        "tolerance box.toml",
        "tolerance missing.toml",
        "sensitivity --global x.toml",
        "sensitivity several.toml",
        "sensitivity --global box.toml --samples 1",
        "sensitivity --global box.toml --set variables.gap_over_t=[1]",
    ]
    .iter()
    .map(|arguments| place.refused(arguments))
    .collect();
    insta::assert_snapshot!(messages.concat());
    assert_eq!(place.list("."), "box.toml several.toml x.toml", "nothing is written");
}

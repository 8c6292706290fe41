//! Answers to the requests of pages.

use run::Evaluator;
use serde_json::{Value, json};
use sweep::Sweep;
use wasm::Solver;

/// A sweep of overlapping scales, in millimetres and newtons.
const DEFINITION: &str = "name = 'x'\n[designs]\ngap_over_t = [0.1, 0.2, 0.4]\nlength_over_t = 0.5\nslant_deg = [30, 60]\n[puncture]\nscales = 21\n\
                          [material]\nthickness_mm = 2\nsubstrate_modulus_MPa = 1";

fn answer_to(request: &Value) -> Value {
    let answer = Solver::default().answer(&request.to_string());
    serde_json::from_str(&answer).expect("the answer is JSON")
}

fn number(answer: &Value, column: &str) -> f64 {
    let values = answer["values"].as_array().expect("the answer has values");
    let value = values.iter().find(|value| value["name"] == column).expect(column);
    value["value"].as_f64().expect("the value is a number")
}

#[test]
fn invalid_requests_are_answered_with_the_reason() {
    let refused = |set: Value, require: &[&str]| {
        answer_to(&json!({ "id": 7, "definition": DEFINITION, "set": set, "require": require }))
    };
    let answers = [
        (refused(json!({ "gap": 1 }), &[]), "gap: no such parameter"),
        (refused(json!({ "slant_deg": 90 }), &[]), "slant_deg: 90"),
        (refused(json!({}), &["coverage"]), "coverage is not accepted"),
    ];
    for (answer, reason) in answers {
        assert_eq!(answer["id"], 7);
        let error = answer["error"].as_str().expect("the answer is an error");
        assert!(error.starts_with(reason), "{error}");
    }
    let answer = Solver::default().answer("{");
    assert!(answer.contains("the request: "), "{answer}");
}

#[test]
fn requirements_are_checked_and_the_tightest_one_is_marked() {
    let require = ["coverage >= 0.1", "penetration_mm <= 0.001", "critical_force_N >= 0.001"];
    let answer = answer_to(
        &json!({ "definition": DEFINITION, "set": { "slant_deg": 50 }, "require": require }),
    );
    let required = answer["requirements"].as_array().expect("the answer has requirements");
    let of = |key: &str| required.iter().map(|one| one[key] == true).collect::<Vec<_>>();
    assert_eq!(of("met"), [true, false, true]);
    assert_eq!(of("limits"), [false, true, false]);
}

#[test]
fn drawn_states_lie_on_the_path() {
    let answer = answer_to(&json!({ "definition": DEFINITION, "drawn": [0.5, 1.0] }));
    let row = &answer["puncture"];
    let punctured = row["scales"]
        .as_array()
        .expect("the answer has scales")
        .iter()
        .find(|scale| scale[0] == 0.0);
    let tilt = -punctured.expect("scale 0 is drawn")[3].as_f64().expect("the rotation is a number");
    assert!((tilt - 5.0).abs() < 1e-4, "half of 10°: {tilt}");
    let last = |load: &str| {
        answer[load]["path"]
            .as_array()
            .expect("the answer has a path")
            .last()
            .expect("the path has points")
            .clone()
    };
    let force = |point: &Value| point[1].as_f64().expect("the force is a number");
    assert!(force(&row["at"]) < force(&last("puncture")));
    assert!((force(&answer["flexure"]["at"]) - force(&last("flexure"))).abs() < 1e-9);
    assert_eq!(answer["flexure"]["scales"].as_array().map(Vec::len), Some(13));
}

const GUIDED: &str =
    "[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\nload_inset_over_t = 0.05";

/// The curve must end at the critical point, although finer steps change its last digits.
///
/// If the end were located by its value, the path could miss the end and continue to twice the
/// tilt.
#[test]
fn curves_of_guided_needles_end_at_the_critical_point() {
    let definition = DEFINITION.replace("[puncture]", GUIDED);
    for slant in [25.0, 30.0, 40.0, 46.5, 55.0] {
        let set = json!({ "slant_deg": slant, "length_over_t": 0.6 });
        let request =
            json!({ "definition": definition, "set": set, "drawn": [1.0, 0.0], "fine": true });
        let answer = answer_to(&request);
        let force = number(&answer, "critical_force");
        let path = answer["puncture"]["path"].as_array().expect("the answer has a path");
        let [_, end, fraction] = [0, 1, 2].map(|k| {
            path.last().expect("the path has points")[k]
                .as_f64()
                .expect("the coordinate is a number")
        });
        let drawn = answer["puncture"]["at"][1].as_f64().expect("the force is a number");
        assert!((end / force - 1.0).abs() < 1e-6, "{slant}: end {end}, measure {force}");
        assert!((drawn, fraction) == (end, 1.0), "{slant}: {drawn} drawn at {fraction}");
    }
}

/// A sharp tip leaves its face at the corner, which a warning reports.
///
/// A round tip also touches the next scale, so it stays in place without a warning.
#[test]
fn a_warning_reports_a_sharp_tip_at_the_end_of_its_face() {
    let set = json!({ "gap_over_t": 0.1, "length_over_t": 1, "slant_deg": 75 });
    let warned = |more: &str| {
        let guided = "[puncture]\nneedle = 'guided'\n";
        let definition = DEFINITION.replace("[puncture]", &format!("{guided}{more}"));
        let answer = answer_to(&json!({ "definition": definition, "set": set }));
        assert!(number(&answer, "passing_force") > 0.0);
        answer["warnings"].to_string().contains("end of the face on which it was set down")
    };
    assert!(warned("") && !warned("needle_radius_over_t = 0.5"));
}

/// A load inset places the needle inside the corner.
///
/// The drawing must show this position, and the critical force of the measures.
#[test]
fn a_needle_inside_the_corner_is_drawn_with_its_critical_force() {
    let definition = DEFINITION.replace(
        "[puncture]",
        "[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\nload_inset_over_t = 0.1\nneedle_radius_over_t = 0.3",
    );
    let answer = answer_to(&json!({ "definition": definition, "drawn": [1.0, 0.0], "fine": true }));
    let (row, force) = (&answer["puncture"], number(&answer, "critical_force"));
    let drawn = row["at"][1].as_f64().expect("the force is a number");
    assert!((drawn / force - 1.0).abs() < 1e-6, "drawn {drawn}, measure {force}");
    let [x, y, radius] =
        [0, 1, 2].map(|k| row["tip"][k].as_f64().expect("the coordinate is a number"));
    let depth = row["at"][0].as_f64().expect("the depth is a number");
    // An inset of 0.1 t is a fifth of the length 0.5 t of the top.
    assert!((row["load_position"].as_f64().expect("the position is a number") - 0.8).abs() < 1e-12);
    assert!(radius == 0.3 && y < 1.0 && depth > 0.0, "{x} {y} {depth}");
}

#[test]
fn designs_between_grid_points_have_a_closest_design_and_a_command() {
    let set = json!({ "gap_over_t": 0.17, "slant_deg": 50, "width_over_t": 2 });
    let answer = answer_to(&json!({ "definition": DEFINITION, "set": set }));
    assert_eq!(answer["closest"]["design"], "0004");
    let settings: Vec<_> =
        answer["settings"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    assert_eq!(
        settings,
        ["--gap 0.17", "--length 0.5", "--slant 50", "--set scale.width_over_t=2"]
    );
    let toml = answer["toml"].as_str().expect("the answer has a definition");
    let again = answer_to(&json!({ "definition": toml }));
    assert_eq!(number(&again, "critical_force"), number(&answer, "critical_force"));
}

/// The definition of a search has variables in mm and no grid of designs.
///
/// The copied definition must have the values in mm of the solved design.
#[test]
fn a_copied_definition_keeps_millimetres_and_requirements_under_a_new_name() {
    let goal = "name = 'pin'\n[variables]\ngap_mm = { from = 0.2, to = 2 }\nlength_mm = { from = 1, to = 4 }\n\
                thickness_mm = { from = 1, to = 2 }\n[designs]\nslant_deg = 60\n[material]\nsubstrate_modulus_MPa = 1";
    let set = json!({ "gap_mm": 0.5, "length_mm": 2, "thickness_mm": 1.6 });
    let require = ["critical_force_N >= 0.5", "coverage >= 0.3"];
    let answer = answer_to(&json!({ "definition": goal, "set": set, "require": require }));
    let toml = answer["toml"].as_str().expect("the answer has a definition");
    for line in ["gap_mm = [0.5]", "length_mm = [2]", "thickness_mm = [1.6]"] {
        assert!(toml.contains(line), "{toml}");
    }
    for requirement in require {
        assert!(toml.contains(&format!("#     --require '{requirement}'")), "{toml}");
    }
    let name =
        toml.lines().find(|line| line.starts_with("name")).expect("the definition has a name");
    assert!(name.starts_with("name = \"pin-") && name.len() == "name = \"pin-0000\"".len());
    let again = answer_to(&json!({ "definition": toml }));
    assert_eq!(number(&again, "critical_force"), number(&answer, "critical_force"));
    assert_eq!(number(&again, "gap_mm"), 0.5);
}

/// A search of the page requests bare answers, because it needs no drawings.
#[test]
fn bare_answers_have_the_same_measures_and_margins() {
    let solve = |bare: bool| {
        let require = ["coverage >= 0.5"];
        answer_to(&json!({ "definition": DEFINITION, "require": require, "bare": bare }))
    };
    let (bare, whole) = (solve(true), solve(false));
    for column in ["coverage", "critical_force", "contact_curvature"] {
        assert_eq!(number(&bare, column), number(&whole, column));
    }
    assert!(bare["puncture"].is_null() && whole["puncture"].is_object());
    let margin = bare["requirements"][0]["margin"].as_f64().expect("the margin is a number");
    assert!((margin - (number(&bare, "coverage") / 0.5 - 1.0)).abs() < 1e-12);
}

#[test]
fn following_a_parameter_stops_at_the_first_violated_requirement() {
    let follow = |to: f64, require: &[&str]| {
        let follow = json!({ "key": "gap_over_t", "to": to, "measure": "compliance" });
        answer_to(&json!({ "definition": DEFINITION, "require": require, "follow": follow }))["follow"]
            .clone()
    };
    // Wider gaps bend more easily and cover less: a gap of 0.32 has a coverage of 1 − 0.32/0.82.
    let covered = follow(0.4, &["coverage >= 0.61"]);
    assert_eq!(covered["reason"], "limited by coverage >= 0.61");
    let request = json!({ "definition": DEFINITION, "set": { "gap_over_t": covered["value"] } });
    let coverage = number(&answer_to(&request), "coverage");
    assert!((0.61..0.6105).contains(&coverage), "{coverage}");
    assert_eq!(follow(0.1001, &[])["value"].as_f64(), Some(0.1001));
}

#[test]
fn slopes_report_the_improving_direction() {
    let answer =
        answer_to(&json!({ "definition": DEFINITION, "set": { "slant_deg": 50 }, "fine": true }));
    let better = |measure: &str, parameter: &str| {
        let slopes = answer["slopes"].as_array().expect("the answer has slopes");
        let slope = slopes
            .iter()
            .find(|slope| slope["measure"] == measure && slope["parameter"] == parameter);
        slope.expect("the derivative exists")["better"].as_i64()
    };
    assert_eq!(better("coverage", "gap_over_t"), Some(-1));
    assert_eq!(better("contact_curvature", "gap_over_t"), Some(1));
}

/// Solves a design with the parameter `key`, and returns its critical force and last setting.
///
/// The design has a slant of 60° and a gap of 0.2.
fn on_body(definition: &str, key: &str, value: f64) -> (f64, String) {
    let mut set = json!({ "slant_deg": 60, "gap_over_t": 0.2 });
    set[key] = json!(value);
    let answer = answer_to(&json!({ "definition": definition, "set": set }));
    // The definition in the answer, which contains only this design, must have the same body.
    let again = answer_to(&json!({ "definition": answer["toml"] }));
    assert_eq!(number(&again, "critical_force"), number(&answer, "critical_force"));
    let settings = answer["settings"].as_array().expect("the answer has settings");
    let last = settings.last().and_then(Value::as_str).unwrap_or_default();
    (number(&answer, "critical_force"), last.to_owned())
}

/// A slider sets a radius, or a curvature of 0 for a flat body.
///
/// The result must not depend on the body in the definition.
#[test]
fn a_set_body_replaces_the_body_of_the_definition() {
    let (flat, _) = on_body(DEFINITION, "thickness_mm", 2.0);
    let (finger, _) =
        on_body(&format!("{DEFINITION}\n[body]\nradius_mm = 10"), "thickness_mm", 2.0);
    assert!(finger < 0.5 * flat, "{finger} {flat}");
    let bodies = ["radius_mm = 45", "radius_over_t = 16", "curvature_times_t = -0.01"];
    let mut definitions = bodies.map(|body| format!("{DEFINITION}\n[body]\n{body}")).to_vec();
    definitions.push(DEFINITION.replace("[designs]", "[designs]\nradius_mm = [20, 30]"));
    definitions.push(DEFINITION.to_owned());
    for definition in definitions {
        let (force, setting) = on_body(&definition, "radius_mm", 10.0);
        assert_eq!(force, finger, "{definition}");
        assert!(setting.contains("radius_mm=10"), "{definition}");
        let (force, setting) = on_body(&definition, "curvature_times_t", 0.0);
        assert_eq!(force, flat, "{definition}");
        let is_set = setting == "--set body.curvature_times_t=0";
        assert_eq!(is_set, definition != DEFINITION, "{definition}");
    }
    // A radius in mm does not change with the thickness.
    let in_mm = format!("{DEFINITION}\n[body]\nradius_mm = 10");
    let over_t = format!("{DEFINITION}\n[body]\nradius_over_t = 10");
    assert_eq!(on_body(&in_mm, "thickness_mm", 1.0).0, on_body(&over_t, "thickness_mm", 2.0).0);
}

/// A layer is solved with its boundary elements, as in a run.
///
/// With full coupling, derivatives would take seconds, so the answer has no slopes.
#[test]
fn a_layer_is_solved_as_in_a_run() {
    for (coupling, has_slopes) in [("nearest", true), ("full", false)] {
        let definition =
            format!("{DEFINITION}\n[body]\nname = 'finger'\n[substrate]\ncoupling = '{coupling}'");
        let sweep = Sweep::parse(&definition, "definition", &[]).expect("the definition is valid");
        let row =
            Evaluator::new(sweep.measures()).row(sweep.grid().number(1), &sweep.grid().case(1));
        let of_run = row.result.puncture.and_then(|puncture| puncture.measures.critical_force);
        let request = json!({ "definition": definition, "set": { "slant_deg": 60 }, "fine": true });
        let answer = answer_to(&request);
        assert_eq!(Some(number(&answer, "critical_force")), of_run, "{coupling}");
        let slopes = answer["slopes"].as_array().expect("the answer has slopes");
        assert_eq!(!slopes.is_empty(), has_slopes, "{coupling}");
    }
}

/// Returns the numbers of a list.
fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("the value is a list").iter().filter_map(Value::as_f64).collect()
}

/// Rotates the vector `[u, v]` counter-clockwise by `angle`, and adds it to the origin `[x, y]`.
fn placed([x, y]: [f64; 2], [u, v]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [x + u * cos - v * sin, y + u * sin + v * cos]
}

/// Each contact is drawn at a corner of a scale, which lies at its position on the body.
#[test]
fn contacts_on_a_body_are_drawn_at_corners_of_its_scales() {
    for curvature in [0.0, 0.1, -0.02] {
        let set = json!({ "slant_deg": 60, "gap_over_t": 0.1, "curvature_times_t": curvature });
        let answer =
            answer_to(&json!({ "definition": DEFINITION, "set": set, "drawn": [1.0, 0.0] }));
        let row = &answer["puncture"];
        let mut corners = Vec::new();
        for scale in row["scales"].as_array().expect("the answer has scales") {
            let [i, x, y, turn] = numbers(scale)[..] else { panic!("a scale has four numbers") };
            // Scales are half as long as they are thick.
            let (arc, shift) = (0.6 * i, 60.0_f64.to_radians().tan());
            let angle = arc * curvature;
            let node = if curvature == 0.0 {
                [arc, 0.0]
            } else {
                [angle.sin() / curvature, (angle.cos() - 1.0) / curvature]
            };
            for corner in [[-0.25, 0.0], [0.25, 0.0], [shift - 0.25, 1.0], [shift + 0.25, 1.0]] {
                let local = placed([x, y], corner, turn.to_radians());
                corners.push(placed(node, local, -angle));
            }
        }
        let contacts = row["contacts"].as_array().expect("the answer has contacts");
        assert!(!contacts.is_empty(), "{curvature}");
        for contact in contacts {
            let [x, y] = numbers(contact)[..2] else { panic!("a contact has two coordinates") };
            let distances = corners.iter().map(|[u, v]| (u - x).hypot(v - y));
            let nearest = distances.fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.02, "{curvature}: ({x}, {y}) is {nearest} from a corner");
        }
    }
}

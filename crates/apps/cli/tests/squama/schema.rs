//! The JSON schema of `squama schema` accepts the same definitions as the parser.

use std::fs;
use std::path::{Path, PathBuf};

use fit::FitDefinition;
use optimisation::DesignGoal;
use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use sweep::{PARAMETERS, Parameter, Role, Sweep};

use crate::json_schema::{mismatch, violated};
use crate::{Place, long_campaigns};

/// Parts of error messages about conditions that a schema cannot express.
///
/// These conditions concern several keys together, or the steps of a range.
const TOGETHER: [&str; 11] = [
    "cannot be combined",
    "needs ",
    "`from` must be below `to`",
    "`to` is below `from`",
    "is not reached in steps of",
    "choose a larger step",
    "has fractions",
    "must be at most solver.",
    "a radius of at least",
    "a load above 1, between two scales",
    "its arctangent is the critical tilt",
];

/// Returns the schema that `squama schema` prints.
fn schema() -> serde_json::Value {
    serde_json::from_str(&Place::new().prints("schema")).expect("JSON")
}

/// Converts TOML to JSON.
fn json(text: &str) -> serde_json::Value {
    let value: toml::Table = toml::from_str(text).expect("TOML");
    serde_json::to_value(value).expect("JSON")
}

/// Appends the paths of all TOML files below `folder` to `all`.
fn definitions(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            definitions(&path, all);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            all.push(path);
        }
    }
}

#[test]
fn all_sweeps_goals_and_fits_are_valid() {
    let (schema, mut all) = (schema(), Vec::new());
    definitions(Path::new("../../../sweeps"), &mut all);
    assert!(all.len() > 20, "{}", all.len());
    for path in all {
        let text = fs::read_to_string(&path).expect("readable");
        let value = json(&text);
        let error = mismatch(&schema, &value);
        assert!(error.is_none(), "{}: {error:?}", path.display());
    }
}

/// Returns a random TOML value for a parameter; many of the values are valid or almost valid.
fn value(rng: &mut ChaCha8Rng, parameter: &Parameter) -> String {
    let default = parameter.default().to_toml();
    let numbers = [
        "0", "-0.0", "1", "2", "3", "21", "21.0", "0.5", "1e-7", "1e-3", "-0.3", "45", "89.9",
        "90", "1e4", "1e12", "-1e12", "0.49", "1.5", "7.5", "1_000", "0x10",
    ];
    let words =
        ["'auto'", "'none'", "'L'", "'guided'", "'chain'", "true", "false", "'true'", "''", "'1'"];
    let single = |rng: &mut ChaCha8Rng| match rng.random_range(0..4) {
        0 => default.clone(),
        1 => (*words.choose(rng).expect("a word")).to_owned(),
        _ => (*numbers.choose(rng).expect("a number")).to_owned(),
    };
    match rng.random_range(0..7) {
        0..3 => single(rng),
        3 => {
            let count = rng.random_range(0..4);
            let items: Vec<String> = (0..count).map(|_| single(rng)).collect();
            format!("[{}]", items.join(", "))
        }
        4 => format!("{{ from = {}, to = {} }}", single(rng), single(rng)),
        5 => format!("{{ from = {}, to = {}, step = {} }}", single(rng), single(rng), single(rng)),
        _ => {
            let keys = ["batch_sd", "batch_within", "scale_sd", "from", "x"];
            let count = rng.random_range(0..3);
            let keys: Vec<_> = keys.sample(rng, count).collect();
            let keys: Vec<String> =
                keys.into_iter().map(|key| format!("{key} = {}", single(rng))).collect();
            format!("{{ {} }}", keys.join(", "))
        }
    }
}

/// Returns true for a list of numbers that are not in ascending order.
///
/// The parser rejects such a list, but a schema cannot express the order of numbers.
fn is_out_of_order(value: &serde_json::Value) -> bool {
    let numbers: Option<Vec<f64>> =
        value.as_array().and_then(|items| items.iter().map(serde_json::Value::as_f64).collect());
    numbers.is_some_and(|numbers| !numbers.is_sorted_by(|a, b| a < b))
}

/// The parser rejects every definition that the schema rejects.
///
/// The parser rejects other definitions only for conditions that a schema cannot express.
#[test]
fn schema_and_parser_agree_on_random_definitions() {
    let schema = schema();
    let mut rng = ChaCha8Rng::seed_from_u64(51);
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..if long_campaigns() { 100_000 } else { 4_000 } {
        let parameter = PARAMETERS.choose(&mut rng).expect("a parameter");
        let section = match rng.random_range(0..8) {
            0..3 => parameter.section,
            3 | 4 => "designs",
            5 => "variables",
            6 => "tolerance",
            _ => PARAMETERS.choose(&mut rng).expect("a parameter").section,
        };
        let mistyped = rng.random_range(0..40) == 0;
        let key = if mistyped { "lenght" } else { parameter.key };
        let value = value(&mut rng, parameter);
        let text = format!("name = 'x'\n[{section}]\n{key} = {value}\n");
        let value = json(&text);
        let parser = Sweep::parse(&text, "x.toml", &[]);
        // Use `violated` instead of `mismatch`: a message would be slow to format for each case.
        match (violated(&schema, &value), parser) {
            (None, Ok(_)) => accepted += 1,
            (Some(_), Err(_)) => refused += 1,
            (Some((keyword, expected)), Ok(_)) => {
                panic!("the parser accepts\n{text}{keyword} {expected}")
            }
            (None, Err(error)) => {
                let error = error.to_string();
                let is_together = TOGETHER.iter().any(|problem| error.contains(problem));
                let is_out_of_order = is_out_of_order(&value[section][key]);
                assert!(is_together || is_out_of_order, "the schema accepts\n{text}{error}");
            }
        }
    }
    assert!(accepted > 300 && refused > 300, "{accepted} {refused}");
}

/// Goals and fits have keys that sweeps do not have.
#[test]
fn schema_and_parser_agree_on_keys_of_goals_and_fits() {
    let schema = schema();
    let key = Parameter::with(Role::Toleranced).next().expect("a parameter").key;
    let goal = format!(
        "name = 'x'\n[designs]\nlength_over_t = 0.5\nslant_deg = 60\n[variables]\ngap_over_t = {{ from = 0.1, to = 1 }}\n[tolerance]\n{key} = {{ batch_sd = 0.01 }}\n[goal]\n"
    );
    let fit = "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 0.3\nslant_deg = 60\n\
        [variables]\nc1 = { from = 1, to = 2 }\n[[curve]]\n";
    let place = Place::new();
    let curve = "displacement,force\n0.01,0.1\n0.02,0.3\n";
    fs::write(place.path("c.csv"), curve).expect("writable");
    let objective = "maximize = 'critical_force'\n";
    for (keys, is_valid) in [
        ("", true),
        ("require = 'coverage >= 0.5'", true),
        ("require = ['coverage >= 0.5']\nseed = 3\nsound = false", true),
        ("seed = -1", false),
        ("seed = 0.5", false),
        ("sound = 'yes'", false),
        ("samples = 1", false),
        ("points = 1001", false),
        ("require = 5", false),
        ("weight = 1", false),
    ] {
        let text = format!("{goal}{objective}{keys}");
        let is_goal = DesignGoal::parse(&text, "x.toml", &[]).is_ok();
        assert_eq!(
            (is_goal, mismatch(&schema, &json(&text)).is_none()),
            (is_valid, is_valid),
            "{keys}"
        );
    }
    let file = "file = 'c.csv'\nkind = 'puncture'\n";
    for (keys, is_valid) in [
        (file.to_owned(), true),
        (format!("{file}from = 0.01\ngap_over_t = 0.2"), true),
        (format!("{file}branch = 'loading'"), true),
        (format!("{file}branch = 'all'"), false),
        (format!("{file}offsets = ['force']"), true),
        (format!("{file}offsets = {{ force = [-1, 1] }}"), true),
        (format!("{file}offsets = {{ forces = [-1, 1] }}"), false),
        (format!("{file}offsets = {{ force = [1] }}"), false),
        (format!("{file}from = '0'"), false),
        (format!("{file}columns = 'force'"), false),
        (format!("{file}gap_over_t = -1"), false),
        (format!("{file}colums = []"), false),
        ("file = 'c.csv'".to_owned(), false),
        ("file = 'c.csv'\nkind = 'bend'".to_owned(), false),
    ] {
        let text = format!("{fit}{keys}");
        fs::write(place.path("x.toml"), &text).expect("writable");
        let is_fit = FitDefinition::read(&place.path("x.toml"), &[]).is_ok();
        assert_eq!(
            (is_fit, mismatch(&schema, &json(&text)).is_none()),
            (is_valid, is_valid),
            "{keys}"
        );
    }
}

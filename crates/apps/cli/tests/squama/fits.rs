//! Overlays measured curves on solved curves, and fits parameters to measured curves.

use std::fmt::Write as _;
use std::fs;

use crate::Place;

/// A skin of printed scales on foam, in mm.
const SKIN: &str = "name = 'palm'\n[designs]\ngap_over_t = 0.2\nlength_over_t = 0.8\nslant_deg = 60\n[puncture]\nneedle = 'guided'\n\
                    needle_friction = 0.3\nload_inset_over_t = 0.05\n[material]\nthickness_mm = 2\nsubstrate_modulus_MPa = 0.5\n\
                    membrane_modulus_MPa = 4.5\n";

#[test]
fn measured_curves_are_overlaid_in_their_units() {
    let place = Place::with(SKIN);
    fs::write(place.path("a_1.csv"), "displacement_mm,force_N\n0,0\n0.2,0.4\n").expect("writable");
    place.prints("plot curves x.toml --design 1 --measured a_1.csv --out o");
    let name = "o/force-displacement-curves-of-0001.svg";
    let figure = place.read(name);
    assert!(figure.contains("mm</tspan>") && figure.contains(">a_1.csv</text>"), "{figure}");
    assert!(!figure.contains("dimensionless"), "{figure}");
    let measured = figure.split("class=\"measured\"").nth(1).expect("a curve");
    assert!(measured.split("/>").next().is_some_and(|line| line.contains("stroke=\"#000\"")));
    // A file with dimensionless columns makes the axes of its figure dimensionless.
    fs::write(place.path("c.csv"), "displacement,force\n0,0\n0.1,0.4\n").expect("writable");
    place.prints("plot curves x.toml --design 1 --measured c.csv --out o");
    assert!(place.read(name).contains("dimensionless"));
    assert!(!place.read("o/moment-curvature-curves-of-0001.svg").contains("dimensionless"));

    fs::write(place.path("b.csv"), "Kappa;M\n2,5;0,1\n").expect("writable");
    place.prints("plot curves x.toml --design 1 --measured b.csv --measured-columns curvature_per_m,moment_N_mm --out o");
    assert!(place.read("o/moment-curvature-curves-of-0001.svg").contains("b.csv"));
}

#[test]
fn incompatible_measured_curves_are_rejected() {
    let place = Place::with(
        "name = 'bare'\n[designs]\ngap_over_t = 0.2\nlength_over_t = 1\nslant_deg = 0\n",
    );
    for (file, text) in [
        ("a.csv", "displacement_mm,force_N\n0,0\n"),
        ("b.csv", "curvature,moment\n0,0\n"),
        ("c.csv", "displacement_mm,force\n0,0\n"),
    ] {
        fs::write(place.path(file), text).expect("writable");
    }
    let plot =
        |files: &str| place.refused(&format!("plot curves x.toml --design 1 {files} --out o"));
    insta::assert_snapshot!(plot("--measured a.csv"), @"error: x.toml: a.csv is in mm and N; to overlay it, the definition needs material.thickness_mm and material.substrate_modulus_MPa");
    insta::assert_snapshot!(plot("--measured a.csv --measured b.csv"), @"error: b.csv: differs from a.csv in its test or units; overlay curves of one test in the same units");
    insta::assert_snapshot!(plot("--measured b.csv --measured ./b.csv"), @"error: ./b.csv: given twice with --measured, expected each file once");
    insta::assert_snapshot!(plot("--measured c.csv"), @"error: c.csv:1: its columns are displacement_mm force: force has no known unit; expected displacement_mm (_um _cm _m _in) and force_N (_mN _cN _kN _gf _kgf _lbf), or curvature_per_mm (_per_m) and moment_N_mm (_mN_m _N_m); otherwise name the columns with columns = [...] in [[curve]], or --measured-columns");
    insta::assert_snapshot!(plot("--measured d.csv"), @"error: d.csv: cannot be read (No such file or directory), expected a CSV file");
    assert!(!place.path("o").exists());
}

/// Returns the path of the example definition of a fit.
fn example() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sweeps/fit/palm.toml")
}

#[test]
fn the_fit_of_the_example_writes_a_valid_definition() {
    let place = Place::new();
    let text = place.prints(&format!("fit {} --out f", example().display()));
    for word in ["palm-test: 4 unknowns from 120 points of 3 curves", "95 % interval", "noise"] {
        assert!(text.contains(word), "{text}");
    }
    // No warning: no estimate is at a bound or undetermined, and no residuals are correlated.
    assert!(!text.contains("(!)"), "{text}");
    assert_eq!(
        place.list("f"),
        "derived fit.csv fitted.toml mean_curves.csv residuals.csv residuals.svg"
    );
    let table = place.read("f/fit.csv");
    let truth = [0.5, 4.5, 0.3, 0.05];
    for (row, truth) in table.lines().skip(1).zip(truth) {
        let numbers: Vec<f64> = row.split(',').filter_map(|cell| cell.parse().ok()).collect();
        let [value, low, high] = [numbers[0], numbers[1], numbers[2]];
        // The curves contain random noise, so not every interval contains the true value.
        assert!((value - truth).abs() < 1.5 * (high - low), "{row}");
    }
    assert_eq!(place.read("f/residuals.csv").lines().count(), 121);
    place.prints("design f/fitted.toml --design 1 --out d");
    // A file that squama did not write is not replaced.
    fs::create_dir(place.path("g")).expect("a folder");
    fs::write(place.path("g/fit.csv"), "mine").expect("writable");
    let refused = place.refused(&format!("fit {} --out g", example().display()));
    assert!(refused.contains("g/fit.csv") && refused.contains("has not written"), "{refused}");
    assert_eq!(place.read("g/fit.csv"), "mine");
}

#[test]
fn undetermined_parameters_give_exit_code_1() {
    let place = Place::with(&SKIN.replace("membrane_modulus_MPa = 4.5\n", "[variables]\nmembrane_modulus_MPa = { from = 1, to = 9 }\n[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n"));
    fs::write(place.path("a.csv"), "displacement_mm,force_N\n0.1,0.01\n0.2,0.03\n0.3,0.05\n")
        .expect("writable");
    let assert = place.squama("fit x.toml").assert().code(1);
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    assert!(
        text.contains("undetermined") && text.contains("do not determine membrane_modulus_MPa"),
        "{text}"
    );
    assert!(place.path("results/palm/fit/fit.csv").exists());
}

/// Writes `file` to `a.csv`, runs `squama fit x.toml`, and returns its output.
///
/// `exit` is the expected exit code.
fn fitted(place: &Place, file: &str, exit: i32) -> String {
    fs::write(place.path("a.csv"), file).expect("writable");
    let assert = place.squama("fit x.toml").assert().code(exit);
    String::from_utf8_lossy(&assert.get_output().stdout).into_owned()
}

#[test]
fn doubtful_fits_are_reported() {
    let skin = SKIN.replace("substrate_modulus_MPa = 0.5\n", "");
    let place = Place::with(&format!(
        "{skin}[variables]\nsubstrate_modulus_MPa = {{ from = 0.1, to = 9 }}\n[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n"
    ));
    let pulled = (1..30).map(|k| format!("{k},-{}", 40 - k)).collect::<Vec<_>>().join("\n");
    let file = format!("Machine;7\nDisplacement (µm),Force [mN]\n{pulled}\n,\n40,-40\n");
    let text = fitted(&place, &file, 1);
    assert!(text.contains("(!) a.csv: no point has both displacement and force above 0"), "{text}");
    assert!(
        text.contains("a.csv: 2 lines outside the table of numbers left out: 1, 32\n"),
        "{text}"
    );
    let wave = (1..60).map(|k| format!("{k},{}", 2 * k + 20 * (k / 10 % 2)));
    let wave = wave.collect::<Vec<_>>().join("\n");
    // Exit code 1: so few of the correlated residuals are independent that the curve excludes no
    // modulus.
    let text = fitted(&place, &format!("displacement_um,force_mN\n{wave}"), 1);
    assert!(text.contains("(!) a.csv: neighbouring residuals are correlated (0."), "{text}");
    let text = fitted(&place, "displacement,force\n0.1,0.2\n0.2,0.4\n0.3,0.6\n", 1);
    assert!(text.contains("displacement and force have no units in the file"), "{text}");
}

/// The model needs a displacement that is zero at contact; otherwise `offsets` fits the zero.
#[test]
fn an_approach_before_contact_is_reported_with_its_last_line() {
    let skin = SKIN.replace("substrate_modulus_MPa = 0.5\n", "");
    let place = Place::with(&format!(
        "{skin}[variables]\nsubstrate_modulus_MPa = {{ from = 0.1, to = 9 }}\n[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n"
    ));
    let mut file = "displacement_mm,force_N\n".to_owned();
    for x in (0..40).map(|k| 0.005 * f64::from(k)) {
        writeln!(file, "{x},{}", SLOPE * (x - 0.1).max(0.0)).expect("writing to a String succeeds");
    }
    fs::write(place.path("a.csv"), file).expect("writable");
    let assert = place.squama("fit x.toml").assert();
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    let approach = "a.csv: the force does not rise up to line 22, at the displacement 0.1";
    assert!(text.contains(&format!("(!) {approach}")), "{text}");
    assert!(
        text.contains("offsets = [\"displacement\"] in [[curve]] fits the point of contact"),
        "{text}"
    );
    let offset = place.read("x.toml") + "offsets = ['displacement']\n";
    fs::write(place.path("x.toml"), offset).expect("writable");
    let text = place.prints("fit x.toml");
    assert!(text.contains(&format!("\n  {approach}")), "{text}");
    // A curve that begins at contact gives no message about an approach.
    let points = (1..40).map(|k| 0.005 * f64::from(k)).map(|x| format!("{x},{}\n", SLOPE * x));
    let file = format!("displacement_mm,force_N\n{}", points.collect::<String>());
    fs::write(place.path("a.csv"), file).expect("writable");
    let text = place.prints("fit x.toml");
    assert!(!text.contains("does not rise"), "{text}");
    // The command may replace its own files, so it can run again.
    let record = place.prints("fit x.toml --json");
    assert!(serde_json::from_str::<serde_json::Value>(&record).is_ok(), "{record}");
}

/// Stiffness before contact in N/mm, for a substrate modulus of 0.5 `MPa`.
const SLOPE: f64 = 0.0583;

#[test]
fn the_scatter_of_specimens_becomes_a_tolerance() {
    let skin = SKIN.replace("substrate_modulus_MPa = 0.5\n", "");
    let place = Place::with(&format!(
        "per_specimen = ['substrate_modulus_MPa']\n{skin}[variables]\n\
         substrate_modulus_MPa = {{ from = 0.1, to = 2 }}\n\
         [[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n"
    ));
    // Stiffnesses before contact in the ratio 5 : 6 : 7, for moduli of 0.5, 0.6 and 0.7 MPa.
    let header = "A;;B;;C;\n".to_owned() + &["Weg mm;Kraft N"; 3].join(";") + "\n";
    let rows = (1..=20).map(|k| {
        let x = 0.005 * f64::from(k);
        let cells = [5.0, 6.0, 7.0].map(|slope| {
            let noise = 1.0 + 0.01 * (7.0 * slope + 2.0 * f64::from(k)).sin();
            format!("{x:.4};{:.6}", SLOPE / 5.0 * slope * x * noise)
        });
        cells.join(";").replace('.', ",") + "\n"
    });
    let file = header + &rows.collect::<String>() + "\nEnd\n";
    fs::write(place.path("a.csv"), file).expect("writable");
    let text = place.prints("fit x.toml --out f");
    assert!(text.contains("substrate_modulus_MPa of 3 specimens: mean 0.6"), "{text}");
    assert!(
        text.contains("to use it in squama tolerance, set tolerance.substrate_modulus_MPa"),
        "{text}"
    );
    assert!(text.contains("mean of a.csv, specimen A, a.csv, specimen B"), "{text}");
    assert_eq!(place.read("f/mean_curves.csv").lines().count(), 61);
    place.prints("tolerance f/fitted.toml --design 1 --samples 4 --out t");
    // The figure shows the mean of the specimens, and a message names the omitted line.
    let mut assert = place.squama("plot curves f/fitted.toml --design 1 --measured a.csv --out o");
    let assert = assert.assert().success();
    let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(message.contains("1 line outside the table of numbers left out: 24"), "{message}");
    let figure = place.read("o/force-displacement-curves-of-0001.svg");
    assert!(figure.contains("mean of 3 specimens") && figure.contains("class=\"band\""));
}

#[test]
fn the_protocol_of_two_blocks_recovers_modulus_and_friction() {
    let place = Place::new();
    let folder = example().with_file_name("two-blocks.toml");
    let text = fs::read_to_string(folder).expect("a definition");
    fs::write(place.path("two-blocks.toml"), &text).expect("writable");
    let (single, _) = text.split_once("[variables]").expect("variables");
    let single = single.replace("[material]", "[material]\nsubstrate_modulus_MPa = 0.31");
    let single = format!("{single}\n[contact]\nfriction = 0.2\n");
    fs::write(place.path("x.toml"), single).expect("writable");
    place.prints("design x.toml --design 1 --set solver.max_step=0.02 --out d");
    // The unit of the dimensionless force is E_s L t/(1 - nu^2).
    let (length, force) = (10.0, 0.31 * 100.0 / 0.75);
    let mut curve = "displacement_mm,force_N\n".to_owned();
    for line in place.read("d/path.csv").lines().skip(1) {
        let numbers: Vec<f64> =
            line.split(',').take(2).map(|cell| cell.parse().expect("a number")).collect();
        let row = format!("{},{}\n", length * numbers[0], force * numbers[1]);
        curve.push_str(&row);
    }
    for specimen in 1..=3 {
        fs::write(place.path(format!("two-blocks-{specimen}.csv")), &curve).expect("writable");
    }
    place.prints("fit two-blocks.toml --quiet --out fit");
    let fitted = place.read("fit/fit.csv");
    for (key, expected, accuracy) in
        [("substrate_modulus_MPa", 0.31, 3e-3), ("friction", 0.2, 0.02)]
    {
        let row = fitted.lines().find(|line| line.contains(key)).expect("a row");
        let value = row.split(',').nth(2).expect("a value");
        let value: f64 = value.parse().expect("a number");
        assert!((value - expected).abs() < accuracy, "{fitted}");
    }
}

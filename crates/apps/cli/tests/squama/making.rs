//! `squama make` writes files for manufacturing.

use crate::Place;

/// A sweep of one design, 2 mm thick, with a deviation of the gap.
const SKIN: &str = "name = 'skin'\nmeasures = ['coverage']\n[designs]\ngap_over_t = 0.3\nlength_over_t = 0.8\nslant_deg = 60\n\
                    [material]\nthickness_mm = 2\nscale_density_kg_m3 = 1100\n[tolerance]\ngap_mm = { batch_sd = 0.1 }\n";

#[test]
fn each_format_has_its_file_and_a_list_of_parts() {
    let place = Place::with(SKIN);
    let beginnings: [(&str, &[u8]); 6] = [
        ("3mf", b"PK"),
        ("stl", b"squama"),
        ("step", b"ISO-10303-21;"),
        ("dxf", b"999\nsquama\n  0\nSECTION"),
        ("svg", b"<svg"),
        ("inp", b"** "),
    ];
    for (ending, beginning) in beginnings {
        place.prints(&format!("make x.toml --design 1 --scales 3x2 --out {ending}.{ending}"));
        let bytes = std::fs::read(place.path(format!("{ending}.{ending}"))).expect("a file");
        assert!(bytes.starts_with(beginning), "{ending}");
        assert!(place.path(format!("{ending}.parts.txt")).is_file(), "{ending}");
    }
}

#[test]
fn the_list_has_sizes_counts_masses_and_deviations() {
    let place = Place::with(SKIN);
    insta::assert_snapshot!(
        place.prints("make x.toml --design 1 --scales 3x2 --gap-across-mm 0.5")
    );
}

#[test]
fn a_patch_has_at_most_the_requested_size() {
    let place = Place::with(SKIN);
    let text = place.prints("make x.toml --design 1 --patch 30x20 --brick");
    // The first line that begins with "across" states the number of scales.
    let names = ["length along the rows", "pitch along", "across", "pitch across"];
    let [length, pitch, rows, row_pitch] = names.map(|name| -> f64 {
        let line = text.lines().find(|line| line.trim_start().starts_with(name)).expect("a line");
        let value = line.trim_start().trim_start_matches(name).split_whitespace().next();
        value.expect("a value").parse().expect("a number")
    });
    assert!(length <= 30.0 && length + pitch > 30.0, "{text}");
    assert!(rows * row_pitch <= 20.0, "{text}");
    let refusal = place.refused("make x.toml --design 1 --patch 1x1");
    assert!(refusal.contains("--patch: smaller than one scale"), "{refusal}");
}

/// Outlines for laser cutters, and solids with `--flat`, do not lie on the arc.
#[test]
fn a_patch_lies_on_the_arc_of_a_body() {
    let place = Place::with(&format!("{SKIN}[body]\nradius_mm = 10\n"));
    std::fs::write(place.path("flat.toml"), SKIN).expect("a file");
    let text = place.prints("make x.toml --design 1 --out arc.stl");
    let line = text.lines().find(|line| line.contains("on a body with the radius"));
    assert!(line.is_some_and(|line| line.contains(" 10 ")), "{text}");
    place.prints("make x.toml --design 1 --flat --out glued.stl");
    place.prints("make flat.toml --design 1 --out flat.stl");
    assert_eq!(
        std::fs::read(place.path("glued.stl")).ok(),
        std::fs::read(place.path("flat.stl")).ok()
    );
    // The ends of the arc are lower than its middle by at least R − R cos θ, with θ = 11.6 mm/2R.
    let bytes = std::fs::read(place.path("arc.stl")).expect("a file");
    let heights =
        bytes[84..].chunks(50).flat_map(|facet| [20, 32, 44].map(|at| &facet[at..at + 4]));
    let heights = heights.map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four bytes")));
    let highest = heights.fold(0.0, f32::max);
    assert!(highest > 2.25 + 10.0 * (1.0 - 0.58_f32.cos()), "{highest}");
    for flat in ["dxf", "svg"] {
        for (definition, name) in [("x", "of-body"), ("flat", "of-plane")] {
            place.prints(&format!("make {definition}.toml --design 1 --out {name}.{flat}"));
        }
        assert_eq!(place.read(&format!("of-body.{flat}")), place.read(&format!("of-plane.{flat}")));
    }
    // On a concave body, the faces of two neighbours are closer together than on a plane.
    let text = place.prints("make x.toml --design 1 --set body.radius_mm=-40 --out concave.stl");
    let line = text.lines().find(|line| line.contains("distance of the faces"));
    assert!(line.is_some_and(|line| line.contains(" 0.0944567 ")), "{text}");
    assert!(text.contains("The faces of two scales are 0.0945 mm apart"), "{text}");
    let refusal = place.refused("make x.toml --design 1 --scales 40x1 --out ring.stl");
    assert!(refusal.contains("a circumference of 62.8319 mm"), "{refusal}");
}

#[test]
fn make_uses_the_optimum_of_a_search() {
    let place = Place::with(SKIN);
    std::fs::create_dir(place.path("search")).expect("a folder");
    std::fs::rename(place.path("x.toml"), place.path("search/optimum.toml")).expect("moved");
    place.prints("make search --design 1");
    assert!(place.path("skin.3mf").is_file());
}

#[test]
fn impossible_patches_are_rejected() {
    let place = Place::with(SKIN);
    let refused = [
        "--out skin.obj",
        "--out nowhere/skin.3mf",
        "--kerf 0.1",
        "--out x.inp --kerf 0.1",
        "--out x.inp --scales 202x1",
        "--out x.dxf --kerf 1.8",
        "--out x.dxf --kerf=-1",
        "--gap-across-mm 0",
        "--scales 0x4",
        "--scales 5",
    ]
    .map(|options| place.refused(&format!("make x.toml --design 1 {options}")));
    let text = SKIN.replace("thickness_mm = 2\n", "").replace("gap_mm", "gap_over_t");
    std::fs::write(place.path("y.toml"), text).expect("a file");
    let unknown = ["--design 1", "--gap 0.2,0.3 --set material.thickness_mm=2"]
        .map(|options| place.refused(&format!("make y.toml {options}")));
    insta::assert_snapshot!([refused.concat(), unknown.concat()].concat());
    assert_eq!(place.list("."), "x.toml y.toml", "no file is written");
}

/// If such a name were converted to UTF-8 with losses, squama could overwrite an unrelated file.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_utf_8_are_refused() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;

    let place = Place::with(
        "name = 'x'\nmaterial.thickness_mm = 2\n\
         designs = { gap_over_t = 0.3, length_over_t = 0.5, slant_deg = 30 }\n",
    );
    place.squama("run x.toml -q --out r").assert().code(0);
    let commands = [
        ("make x.toml --out", "stl"),
        ("explore x.toml --no-open --out", "html"),
        ("report r --out", "html"),
        ("export r --xlsx", "xlsx"),
    ];
    for (command, kind) in commands {
        let name = [b"sk\xffin.", kind.as_bytes()].concat();
        let assert = place.squama(command).arg(OsStr::from_bytes(&name)).assert().code(2);
        let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(message.contains("expected a name in UTF-8"), "{command}: {message}");
    }
    assert_eq!(place.list("."), "r x.toml");
}

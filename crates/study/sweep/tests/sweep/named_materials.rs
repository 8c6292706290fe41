//! Tests of definitions that name materials, such as PLA.

use std::path::Path;

use sweep::{NamedValues, SCALE_MATERIALS, Setting, Sweep, TISSUE_MATERIALS};

const MODULI: &str = "substrate_modulus_MPa = 0.3\nmembrane_modulus_MPa = 4.5\n";

fn read(material: &str, settings: &[&str]) -> Result<Sweep, String> {
    let settings: Vec<_> = settings.iter().map(|s| Setting::parse(s).expect("valid")).collect();
    let text = format!("name = 'x'\n{material}");
    Sweep::parse(&text, "x.toml", &settings).map_err(|error| error.to_string())
}

fn materials(material: &str, settings: &[&str]) -> sweep::Material {
    read(material, settings).expect("valid").grid().case(0).material
}

#[test]
fn names_supply_values_and_explicit_keys_override_them() {
    let given = materials(&format!("[material]\n{MODULI}scale = 'PLA'"), &[]);
    assert_eq!(
        [given.scale_modulus_mpa, given.scale_strength_mpa, given.scale_density_kg_m3],
        [Some(3000.0), Some(50.0), Some(1250.0)]
    );
    let strength = format!("[material]\nscale = 'PLA'\nscale_strength_MPa = 30\n{MODULI}");
    assert_eq!(materials(&strength, &[]).scale_strength_mpa, Some(30.0));
    let tissue = "[material]\ntissue = 'Silicone'\nmembrane_modulus_MPa = 1";
    let tissue = materials(tissue, &["material=glass"]);
    assert_eq!(tissue.substrate_modulus_mpa, Some(0.3));
    assert_eq!(tissue.bond_strength_mpa, Some(0.1));
    assert_eq!(tissue.scale_modulus_mpa, Some(70_000.0));
}

#[test]
fn a_ratio_overrides_the_named_value() {
    let text = format!(
        "[material]\nscale = 'PLA'\n{MODULI}[puncture]\nscale_strength_over_substrate = 7\n\
         contact_modulus_over_substrate = 100"
    );
    let case = read(&text, &[]).expect("valid").grid().case(0);
    assert_eq!((case.strengths.scale, case.material.scale_strength_mpa), (Some(7.0), None));
    assert_eq!(case.puncture.contact_modulus_over_substrate, 100.0);
    assert_eq!(case.material.scale_density_kg_m3, Some(1250.0));
}

#[test]
fn the_value_of_the_section_material_may_be_a_scale_material() {
    let settings =
        ["material.substrate_modulus_MPa=0.3", "material.membrane_modulus_MPa=1", "material=abs"];
    assert_eq!(materials("", &settings).scale_strength_mpa, Some(33.0));
    insta::assert_snapshot!(read("material = 'ABS'", &[]).expect_err("no modulus"), @r"
    x.toml:2: material.scale_modulus_MPa: needs material.substrate_modulus_MPa to be set
    x.toml:2: material.scale_strength_MPa: needs material.substrate_modulus_MPa to be set
    ");
}

#[test]
fn a_complete_definition_states_the_values_of_a_named_material() {
    let text = format!("[material]\nscale = 'PLA'\n{MODULI}");
    let written = read(&text, &[]).expect("valid").to_toml();
    assert!(written.contains("scale_strength_MPa = 50\n") && !written.contains("PLA"), "{written}");
}

#[test]
fn unknown_materials_are_refused_with_the_known_ones() {
    insta::assert_snapshot!(read("[material]\nscale = 'steel'", &[]).expect_err("unknown"), @r#"x.toml:3: material.scale: "steel" is not accepted, expected "PLA" or "PETG" or "ABS" or "nylon" or "resin" or "TPU" or "alumina" or "glass" or "bone" or "fish scale""#);
    insta::assert_snapshot!(read("[material]\ntissue = 1", &[]).expect_err("no name"), @r#"x.toml:3: material.tissue: 1 is not accepted, expected "silicone" or "polyurethane" or "foam" or "skin" or "muscle""#);
    insta::assert_snapshot!(read("[material]\ntisue = 'skin'", &[]).expect_err("no key"), @r#"x.toml:3: material.tisue: unknown key (its value is "skin"), did you mean material.tissue?"#);
}

/// Checks that `docs/materials.md` has exactly the rows of the tables of materials.
#[test]
fn the_documented_materials_match_the_table() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/materials.md");
    let page = std::fs::read_to_string(page).expect("readable");
    let mut documented = page.lines().filter(|line| line.starts_with("| `"));
    let (scales, tissues) = (SCALE_MATERIALS.iter(), TISSUE_MATERIALS.iter());
    let columns = scales.map(|of| (of, 3)).chain(tissues.map(|of| (of, 2)));
    for (NamedValues { name, values }, count) in columns {
        let cells = (0..count).map(|k| match values.get(k) {
            Some((_, value)) => format!(" {value} |"),
            None => " none |".to_owned(),
        });
        let row = format!("| `{name}` |{}", cells.collect::<String>());
        let line = documented.next().expect("a row for each material");
        assert!(line.starts_with(&row), "{line} instead of {row}");
    }
    assert_eq!(documented.next(), None);
}

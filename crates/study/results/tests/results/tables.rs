//! Tests of the headers of the tables, on which other programs rely.

use results::columns::tables;

use crate::sweep;

fn headers(text: &str) -> String {
    let sweep = sweep(text);
    tables(&sweep)
        .into_iter()
        .map(|table| {
            let names: Vec<_> = table.columns.iter().map(|column| column.name.as_ref()).collect();
            format!("{}: {}", table.file, names.join(","))
        })
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn headers_of_the_paper_sweep_are_unchanged() {
    insta::assert_snapshot!(headers("name = 'x'"));
}

#[test]
fn headers_follow_the_axes_and_measures_of_a_sweep() {
    insta::assert_snapshot!(headers("name = 'x'\nmeasures = ['coverage']\ndesigns.c2 = [1, 1.5]"));
}

/// Returns a valid value of a parameter as an axis, in TOML.
fn axis_value(parameter: &sweep::Parameter) -> String {
    match parameter.section {
        // Material parameters have no default.
        "material" => "1".to_owned(),
        _ if !parameter.is_given(&sweep::Case::default()) => "1".to_owned(),
        _ => parameter.default().to_toml(),
    }
}

/// Returns true if a parameter cannot be given in a sweep with lengths in one unit.
///
/// The unit is mm (`in_mm`) or the thickness. Returns true for lengths in the other unit and for
/// the pitch. Returns true also for ratios of moduli, strengths or a force if the unit is mm, and
/// for the numerators of these ratios if the unit is the thickness.
fn is_in_other_unit(parameter: &sweep::Parameter, in_mm: bool) -> bool {
    let has_other_unit = parameter.is_in_mm() || parameter.in_mm().next().is_some();
    let numerators = ["scale_modulus_MPa", "scale_strength_MPa", "bond_strength_MPa", "force_N"];
    let ratios = ["modulus_over_", "strength_over_", "force_over_"];
    let is_ratio = ratios.iter().any(|ratio| parameter.key.contains(ratio));
    parameter.key == "pitch_mm"
        || (parameter.is_in_mm() != in_mm && has_other_unit)
        || if in_mm { is_ratio } else { numerators.contains(&parameter.key) }
}

/// Returns the columns of a sweep with an axis for every parameter except `excluded`.
///
/// Lengths are in mm if `in_mm` is true, otherwise divided by the thickness.
fn columns_without(needle: &str, excluded: [&str; 5], in_mm: bool) -> Vec<String> {
    let chosen = sweep::PARAMETERS
        .iter()
        .filter(|p| !is_in_other_unit(p, in_mm) && !excluded.contains(&p.key));
    let axes: Vec<_> = chosen.map(|p| format!("{} = {}\n", p.key, axis_value(p))).collect();
    let sweep = sweep(&format!("name = 'x'\n{needle}[designs]\n{}", axes.concat()));
    let columns = results::columns::design_columns(&sweep).into_iter();
    columns.map(|column| column.name.into_owned()).collect()
}

/// Three sweeps together have every parameter as an axis.
///
/// One sweep cannot have all axes, because some parameters exclude each other: length and number of
/// gaps, critical tilt and needle friction, radius and curvature, both units of a length. A round
/// tip needs a guided needle.
#[test]
fn every_parameter_may_be_an_axis_with_a_column_of_its_own() {
    let mut names = columns_without(
        "",
        ["gaps", "needle_friction", "load_inset_over_t", "needle_radius_over_t", "radius_over_t"],
        false,
    );
    assert!(names.iter().any(|name| name == "membrane_length_over_t"));
    let others = columns_without(
        "",
        [
            "membrane_length_mm",
            "critical_tilt_deg",
            "load_position",
            "needle_radius_mm",
            "curvature_times_t",
        ],
        true,
    );
    let guided = columns_without(
        "puncture.needle = 'guided'\n",
        ["gaps", "needle_friction", "load_inset_over_t", "needle", "curvature_times_t"],
        false,
    );
    assert!(guided.iter().any(|name| name == "needle_radius_over_t"));
    let expected =
        ["gaps_asked", "needle_friction", "gap_mm", "load_inset_mm", "scale_modulus_MPa"];
    assert!(expected.iter().all(|name| others.iter().any(|n| n == name)));
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

/// With a depth in either unit, `force_at_depth` is a column, and with a material also in newtons.
#[test]
fn a_given_depth_adds_the_column_of_the_force_at_this_depth() {
    assert!(!headers("name = 'x'").contains("force_at_depth"));
    assert!(headers("name = 'x'\n[puncture]\ndepth_over_t = 0.3").contains(",force_at_depth,"));
    let material = "name = 'x'\n[puncture]\ndepth_mm = 0.3\n[material]\nthickness_mm = 1\nsubstrate_modulus_MPa = 1";
    assert!(headers(material).contains(",force_at_depth_N,"));
    assert_eq!(results::measurement_conditions("force_at_depth").first(), Some(&"needle"));
    assert!(results::measurement_conditions("force_at_depth").contains(&"depth_over_t"));
    assert!(!results::measurement_conditions("critical_force").contains(&"depth_over_t"));
}

/// The weakest load position is a column if several positions are requested.
#[test]
fn several_load_positions_add_the_columns_of_the_weakest_position() {
    assert!(!headers("name = 'x'").contains("weakest"));
    let places = "name = 'x'\n[puncture]\nplaces = 11";
    assert!(headers(places).contains(",weakest_force,weakest_place,weakest_status,"));
    let material = "[material]\nthickness_mm = 1\nsubstrate_modulus_MPa = 1";
    assert!(headers(&format!("{places}\n{material}")).contains(",weakest_force_N,"));
    assert!(results::measurement_conditions("weakest_force").contains(&"places"));
}

/// The columns of the tilts or frictions follow all other columns.
#[test]
fn several_critical_tilts_add_a_column_for_each() {
    let added = |text: &str| {
        let (plain, with) = (headers("name = 'x'"), headers(&format!("name = 'x'\n{text}")));
        let added = plain
            .lines()
            .zip(with.lines())
            .map(|(plain, with)| with.strip_prefix(plain).expect("added at the end").to_owned());
        added.collect::<Vec<_>>()
    };
    let force = ",critical_force_at_5deg,critical_force_at_10.5deg";
    let displacement = ",critical_displacement_at_5deg,critical_displacement_at_10.5deg";
    let penetration = ",penetration_at_5deg,penetration_at_10.5deg";
    let expected = [
        format!("{force}{displacement}{penetration}"),
        String::new(),
        format!("{force}{displacement}"),
        format!("{displacement}{penetration}"),
        String::new(),
    ];
    assert_eq!(added("puncture.critical_tilt_deg = [5, 10.5]"), expected);
    let by_friction = added("puncture.needle_friction = [0.1, 0.2]").concat();
    assert!(
        by_friction.contains(",critical_force_at_friction_0.1,critical_force_at_friction_0.2,")
    );
    assert_eq!(added("puncture.needle_friction = 0.1").concat(), "");
}

/// If the thickness is given, each length in mm is a column once, also if the length is an axis.
///
/// The lengths in mm do not count as further parameters that distinguish designs.
#[test]
fn a_thickness_adds_the_columns_of_lengths_in_mm() {
    let designs = |text: &str| headers(text).lines().next().expect("designs.csv").to_owned();
    assert!(!designs("name = 'x'").contains("_mm"));
    let material = "name = 'x'\nmaterial.thickness_mm = 2\n";
    let first = "design,gap_mm,length_mm,width_mm,pitch_mm,gap_over_t,";
    let plain = designs(material);
    assert!(plain.starts_with(&format!("designs.csv: {first}")), "{plain}");
    for axis in ["gap_mm = 1", "pitch_mm = 9", "width_mm = [2, 3]", "width_over_t = 1"] {
        let with = designs(&format!("{material}[designs]\n{axis}"));
        let headers: Vec<String> = with.split([',', ' ']).map(str::to_owned).collect();
        for name in ["gap_mm", "length_mm", "width_mm", "pitch_mm", "width_over_t"] {
            assert_eq!(headers.iter().filter(|header| *header == name).count(), 1, "{with}");
        }
        let lengths = ["gap_over_t", "length_over_t", "width_over_t"];
        assert!(lengths.iter().all(|name| results::columns::distinguishes_designs(name, &headers)));
        assert!(!results::columns::distinguishes_designs("gap_mm", &headers));
    }
}

/// The smallest force on several bodies is a column if a range of radii is given in either unit.
#[test]
fn a_range_of_radii_adds_the_columns_of_the_worst_body() {
    assert!(!headers("name = 'x'").contains("between"));
    let columns = ",worst_force_between,worst_curvature,between_status,";
    assert!(headers("name = 'x'\n[body]\nradius_to_over_t = 5").contains(columns));
    let material = "name = 'x'\nbody.radius_to_mm = 10\nmaterial = { thickness_mm = 1, substrate_modulus_MPa = 1 }";
    assert!(headers(material).contains(",worst_force_between_N,"));
}

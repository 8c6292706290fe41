//! Tests of valid definitions.

use sweep::{Case, InvalidDefinition, Parameter, Setting, Sweep};

use crate::sweep;

/// Parses a definition with the name `x` and the other keys in `text`.
fn read(text: &str) -> Result<Sweep, InvalidDefinition> {
    Sweep::parse(&format!("name = 'x'\n{text}"), "x.toml", &[])
}

#[test]
fn a_name_alone_is_the_paper_sweep() {
    insta::assert_snapshot!(sweep("name = 'x'").to_toml());
}

#[test]
fn a_definition_reads_back_from_its_complete_form() {
    let texts = [
        "name = 'x'",
        "name = 'a b'\nmeasures = ['coverage']\n[scale]\nbase = '2L'\nwidth_over_t = 1e-3",
        "name = 'x'\n[designs]\nscales = ['auto', 3, 41]\nbase = ['L', '2L']\ngap_over_t = 0.3",
        "name = 'x'\n[designs]\nscales = { from = 1, to = 9, step = 2 }\nc1 = { from = 0.25, to = 1, step = 0.25 }",
        "name = 'x'\n[solver]\nmax_step = 0.005\n[puncture]\nscales = 7",
        "name = 'x'\n[designs]\nmethod = ['chain', 'unit-cell']\n[flexure]\nelements_per_gap = 3",
        "name = 'x'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\nc1 = [1, 2]\nbase = ['L', '2L']",
        "name = 'x'\nscale.width_mm = 3\nmaterial.thickness_mm = 2\n[designs]\ngap_mm = [0.2, 0.4]\nlength_mm = { from = 1, to = 3, step = 0.5 }",
        "name = 'x'\nscale.base = '2L'\n[designs]\npitch_mm = [3, 4]\nlength_mm = 1\nthickness_mm = [1, 2]",
        "name = 'x'\nmaterial.thickness_mm = 2\n[variables]\npitch_mm = { from = 1, to = 2 }\n[designs]\ngap_mm = 0.4\n[flexure]\nmembrane_length_mm = 100",
        "name = 'x'\n[material]\nthickness_mm = 8\n[tolerance]\ngap_mm = { batch_sd = 0.1, scale_sd = 0.05 }\nslant_deg = { batch_within = 2 }\nthickness_mm = { batch_sd = 0.05 }",
    ];
    for text in texts {
        let complete = sweep(text).to_toml();
        assert_eq!(sweep(&complete).to_toml(), complete);
        let grids = [text, &complete].map(|text| sweep(text).grid().clone());
        assert_eq!(grids[0].len(), grids[1].len());
        assert!((0..grids[0].len()).all(|i| grids[0].case(i) == grids[1].case(i)));
    }
}

#[test]
fn axes_vary_in_written_order_with_the_slant_fastest() {
    for (axes, keys) in [
        ("", "gap_over_t length_over_t slant_deg"),
        ("slant_deg = 0\nlength_over_t = 1\ngap_over_t = 1", "length_over_t gap_over_t slant_deg"),
        ("c2 = [0.23, 1.1]\nslant_deg = 0\nc1 = 1", "gap_over_t length_over_t c2 c1 slant_deg"),
    ] {
        let sweep = sweep(&format!("name = 'x'\n[designs]\n{axes}"));
        let found: Vec<_> = sweep.grid().axes().iter().map(|axis| axis.parameter().key).collect();
        assert_eq!(found.join(" "), keys);
    }
}

#[test]
fn a_range_gives_the_same_decimals_as_a_typed_list() {
    let sweep = sweep("name = 'x'\n[designs]\ngap_over_t = { from = 0.1, to = 1.0, step = 0.1 }");
    let axis = sweep.grid().axis("gap_over_t").expect("an axis");
    let values: Vec<_> = (0..axis.len()).map(|i| axis.value(i).to_string()).collect();
    assert_eq!(values.join(" "), "0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1");
}

#[test]
fn numbers_may_have_any_toml_notation() {
    let sweep = sweep(
        "name = 'x'\n[puncture]\nscales = 0x29\n[solver]\nmax_points = 1_000\n[contact]\nc1 = 2",
    );
    let case = sweep.grid().case(0);
    assert_eq!(case.puncture.scales, skin::puncture::RowLength::Scales(41));
    assert_eq!(case.common.solver.max_points, 1000);
    assert_eq!(case.common.law, contact::Law { c1: 2.0, c2: 0.23 });
}

#[test]
fn settings_replace_values_of_the_file() {
    let file = "name = 'x'\n[scale]\nbase = 'L'\n[designs]\nc1 = [1, 2]";
    let settings =
        ["name=y", "scale.base=2L", "contact.c1=3", "designs.c2=[1, 1.5]", "measures=coverage"];
    let settings: Vec<_> = settings.map(|text| Setting::parse(text).expect("valid")).to_vec();
    let sweep = Sweep::parse(file, "x.toml", &settings).expect("valid");
    let case = sweep.grid().case(0);
    assert_eq!((sweep.name(), case.design.base, case.common.law.c1), ("y", skin::Base::TwoL, 3.0));
    assert_eq!(sweep.grid().len(), 1440);
    assert_eq!(sweep.measures(), [sweep::Measure::Coverage]);
}

#[test]
fn the_record_of_a_run_can_be_read_as_a_definition() {
    let text = "[run]\nversion = '1'\n[definition]\nname = 'x'\n[definition.contact]\nc1 = 2";
    assert_eq!(sweep(text).grid().case(0).common.law.c1.to_bits(), 2.0_f64.to_bits());
}

/// The notations are an inset divided by the thickness, and a depth in mm.
#[test]
fn load_position_and_depth_are_written_back_in_their_notation() {
    let text = "puncture = { load_inset_over_t = 0.05, depth_mm = 1 }\nmaterial.thickness_mm = 2\n\
        designs.length_over_t = [0.08, 0.5]";
    let sweep = read(text).unwrap();
    let last = sweep.grid().len() - 1;
    let [first, final_case] = [0, last].map(|index| sweep.grid().case(index).punctured());
    assert_eq!((first.load_position, first.depth), (0.5, Some(0.5)));
    assert!((final_case.load_position - 0.9).abs() < 1e-15);
    let again = Sweep::parse(&sweep.to_toml(), "again.toml", &[]).unwrap();
    assert_eq!(again.grid().case(last), sweep.grid().case(last));
    let refused = |text: &str| read(text).unwrap_err().to_string();
    let text = refused("puncture.depth_mm = 1");
    assert!(text.contains("puncture.depth_mm") && text.contains("material.thickness_mm"), "{text}");
    let text = refused("puncture.force_N = 1\nmaterial.substrate_modulus_MPa = 1");
    assert!(text.contains("puncture.force_N") && text.contains("material.thickness_mm"), "{text}");
    let text = refused("puncture.force_N = 1\nmaterial.thickness_mm = 1");
    assert!(text.contains("material.substrate_modulus_MPa"), "{text}");
    let both = refused("puncture = { load_inset_over_t = 0.05, load_position = 0.5 }");
    assert!(both.contains("cannot be combined"), "{both}");
}

/// Over `E_s t²` the force depends on the thickness, and `F*` also on the length of a scale.
#[test]
fn a_force_in_newtons_does_not_change_with_the_thickness() {
    let text = "name = 'x'\npuncture.force_N = 6\n[material]\n\
        substrate_modulus_MPa = 0.5\n[designs]\nthickness_mm = [1, 2]\nlength_over_t = 0.5\ngap_over_t = 0.1\n\
        slant_deg = 0";
    let sweep = Sweep::parse(text, "x.toml", &[]).unwrap();
    let forces = [0, 1].map(|index| sweep.grid().case(index).needle_force);
    assert_eq!(forces, [Some(12.0), Some(3.0)]);
    // `F*` is the force over `E_s t²` times `(1 − ν²)/(L/t)`, here (1 − 0.5²)/0.5 = 1.5.
    assert_eq!(sweep.grid().case(0).punctured().force, Some(12.0 * 1.5));
    let thickness = Parameter::named("thickness_mm").unwrap();
    let moved = thickness.moved(&sweep.grid().case(0), 1.0).unwrap();
    assert_eq!((moved.needle_force, moved.needle_force_n), (Some(3.0), Some(6.0)));
    let again = Sweep::parse(&sweep.to_toml(), "again.toml", &[]).unwrap();
    assert_eq!(again.grid().case(1), sweep.grid().case(1));
}

#[test]
fn the_inset_of_the_load_may_deviate_in_either_unit() {
    let text = "name = 'x'\npuncture.load_inset_over_t = 0.05\nmaterial.thickness_mm = 2\n\
        tolerance = { load_inset_over_t = { batch_sd = 0.02 }, load_inset_mm = { batch_sd = 0.04 } }";
    let one = text.replace(", load_inset_mm = { batch_sd = 0.04 }", "");
    let other = text.replace("load_inset_over_t = { batch_sd = 0.02 }, ", "");
    let moved = [one, other].map(|text| {
        let sweep = Sweep::parse(&text, "x.toml", &[]).unwrap();
        let (case, deviation) = (sweep.grid().case(0), &sweep.deviations()[0]);
        // A negative inset is refused, because the load would be beyond the corner of the scale.
        assert_eq!(deviation.applied(&case, -0.2), None);
        deviation.applied(&case, 0.02).unwrap().load_inset.unwrap()
    });
    assert!((moved[0] - 0.07).abs() < 1e-15 && (moved[1] - 0.06).abs() < 1e-15, "{moved:?}");
}

/// Critical tilt and friction of a guided needle may both be given, in any order.
///
/// The friction of a guided needle may be 0. A free needle accepts only a positive friction.
#[test]
fn tilt_and_friction_of_a_guided_needle_are_independent() {
    use skin::puncture::Needle;
    let puncture = |text: &str, index| read(text).unwrap().grid().case(index).punctured();
    let guided = "puncture = { needle_friction = 0.3, critical_tilt_deg = 8, needle = 'guided' }";
    assert_eq!(puncture(guided, 0).needle, Needle::Guided { friction: 0.3 });
    assert_eq!(puncture(guided, 0).critical_tilt_deg, 8.0);
    let sweep = read(guided).unwrap();
    let again = Sweep::parse(&sweep.to_toml(), "again.toml", &[]).unwrap();
    assert_eq!(again.grid().case(0), sweep.grid().case(0));
    assert!(sweep.is_guided() && !read("").unwrap().is_guided());
    assert!(!read("designs.needle = ['free']").unwrap().is_guided());
    for frictionless in [
        "designs.needle_friction = [0, 0.1]",
        "puncture.needle_friction = 0\ndesigns.needle = ['free', 'guided']",
    ] {
        let refused = read(frictionless).unwrap_err().to_string();
        assert!(
            refused.contains("0 is not accepted, expected a number of at least 1e-10"),
            "{refused}"
        );
    }
    // The bounds of a variable are checked too, because a search also evaluates the bounds.
    let varied = "variables.needle_friction = { from = 0, to = 0.5 }";
    insta::assert_snapshot!(read(varied).unwrap_err(), @"x.toml:2: variables.needle_friction: 0 is not accepted, expected a number of at least 1e-10: its arctangent is the critical tilt of a free needle");
    for needle in ["puncture.needle = 'guided'", "variables.needle = ['free', 'guided']"] {
        let read = read(&format!("{varied}\n{needle}"));
        assert_eq!(read.is_ok(), needle.starts_with("puncture"), "{needle}");
    }
    let smooth = "puncture = { needle_friction = 0, needle = 'guided' }";
    assert_eq!(puncture(smooth, 0).needle, Needle::Guided { friction: 0.0 });
    assert_eq!(puncture(smooth, 0).critical_tilt_deg, 10.0);
    // In a sweep with both kinds of needle, the friction applies to the guided needle and
    // determines the critical tilt of the free needle.
    let both = "puncture.needle_friction = 0.2\ndesigns.needle = ['free', 'guided']";
    let last = read(both).unwrap().grid().len() - 1;
    assert_eq!(puncture(both, 0).critical_tilt_deg, 0.2_f64.atan().to_degrees());
    assert_eq!(puncture(both, last).critical_tilt_deg, 10.0);
    assert_eq!(puncture(both, last).needle, Needle::Guided { friction: 0.2 });
    let several = "puncture = { needle_friction = [0.1, 0.2], needle = 'guided' }";
    let refused = read(several).unwrap_err().to_string();
    assert!(refused.contains("as an axis in [designs]"), "{refused}");
    for friction in ["0", "1e-30", "[0, 0.1]"] {
        let refused = read(&format!("puncture.needle_friction = {friction}")).unwrap_err();
        assert!(refused.to_string().contains("a number of at least 1e-10"), "{refused}");
    }
    let refused = read("puncture.critical_tilt_deg = 1e-30").unwrap_err().to_string();
    assert!(refused.contains("an angle of at least 1e-9"), "{refused}");
    let setting = [Setting::parse("puncture.needle_friction=0.1").unwrap()];
    let set = Sweep::parse(&format!("name = 'x'\n{guided}"), "x.toml", &setting).unwrap();
    assert_eq!(set.grid().case(0).puncture.critical_tilt_deg, 8.0);
}

/// The needle radius may also be an axis, or be given in mm.
#[test]
fn a_needle_radius_requires_a_guided_needle() {
    for (text, radius) in [
        ("", None),
        ("puncture.needle_radius_over_t = 0.5", Some(0.5)),
        ("designs.needle_radius_over_t = [0.5, 1]", Some(0.5)),
        ("puncture.needle_radius_mm = 1\nmaterial.thickness_mm = 2", Some(0.5)),
        ("puncture.needle_friction = 0.3\npuncture.needle_radius_over_t = 0.5", Some(0.5)),
    ] {
        let sweep = read(&format!("puncture.needle = 'guided'\n{text}")).unwrap();
        assert_eq!(sweep.grid().case(0).puncture.needle_radius, radius);
    }
    for (text, needed) in [
        ("puncture.needle_radius_over_t = 0.5", "needs puncture.needle = \"guided\""),
        ("designs.needle_radius_over_t = [0.5, 1]", "needs puncture.needle = \"guided\""),
        (
            "puncture.needle_radius_over_t = 0.5\ndesigns.needle = ['free', 'guided']",
            "needs puncture.needle = \"guided\"",
        ),
    ] {
        let refused = read(text).unwrap_err().to_string();
        assert!(refused.contains(needed), "{refused}");
    }
}

/// Load positions above 1 are between two scales.
///
/// The largest position is the left corner of the next scale: `1 + gap/length`, here 1.1 for a gap
/// of 0.1.
#[test]
fn a_load_between_two_scales_requires_a_round_tip() {
    let grid = "designs = { gap_over_t = [0.1, 0.5], length_over_t = 1 }\n";
    let round = "puncture = { needle = 'guided', needle_radius_over_t = 0.5, load_position = 1.3 }";
    let sweep = read(&format!("{grid}{round}")).unwrap();
    let positions =
        [0, sweep.grid().len() - 1].map(|index| sweep.grid().case(index).punctured().load_position);
    assert_eq!(positions, [1.1, 1.3]);
    for sharp in [
        "puncture.load_position = 1.3",
        "puncture.needle = 'guided'\ndesigns.load_position = [0.5, 1.3]",
        "variables.load_position = { from = 0.5, to = 1.3 }",
    ] {
        let refused = read(sharp).unwrap_err().to_string();
        assert!(refused.contains("1.3 is out of range, expected a number of at least 0 and at most 1; a load above 1, between two scales, needs puncture.needle_radius_over_t"), "{refused}");
    }
}

/// The largest of several critical tilts ends the puncture.
///
/// A friction gives its arctangent as the critical tilt.
#[test]
fn critical_tilts_are_given_in_degrees_or_by_friction() {
    let puncture = |sweep: &Sweep, index| sweep.grid().case(index).punctured();
    let all = |sweep: &Sweep| puncture(sweep, 0).tilts_deg().collect::<Vec<_>>();
    let sweep = read("puncture.critical_tilt_deg = [5, 10, 15]").unwrap();
    assert_eq!(puncture(&sweep, 0).critical_tilt_deg, 15.0);
    assert_eq!(all(&sweep), [5.0, 10.0, 15.0]);
    assert!(
        sweep.to_toml().contains("\ncritical_tilt_deg = [5, 10, 15]\nneedle_friction = \"none\"\n")
    );
    let by_friction = read("puncture.needle_friction = [0.1, 0.2]").unwrap();
    let tilts = [0.1_f64, 0.2].map(|friction| friction.atan().to_degrees());
    assert_eq!(all(&by_friction), tilts);
    assert_eq!(puncture(&by_friction, 0).critical_tilt_deg, tilts[1]);
    assert!(!by_friction.to_toml().contains("critical_tilt_deg"));
    let alone = read("puncture.needle_friction = 0.2").unwrap();
    assert_eq!(puncture(&alone, 0).critical_tilt_deg, tilts[1]);
    assert!(all(&alone).is_empty());
    let axis = read("designs.needle_friction = [0.1, 0.2]").unwrap();
    let last = axis.grid().len() - 1;
    assert_eq!([0, last].map(|index| puncture(&axis, index).critical_tilt_deg), tilts);
    for sweep in [sweep, by_friction, alone, axis] {
        let again = Sweep::parse(&sweep.to_toml(), "again.toml", &[]).unwrap();
        assert_eq!(again.to_toml(), sweep.to_toml());
        assert_eq!(again.grid().case(0), sweep.grid().case(0));
    }
}

#[test]
fn deviations_change_a_case_in_the_unit_of_the_deviation() {
    let text = "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 1\nslant_deg = 45\n[material]\n\
                thickness_mm = 8\nsubstrate_modulus_MPa = 0.3\n[tolerance]\ngap_mm = { scale_sd = 0.4 }\n\
                slant_deg = { batch_within = 3 }\nthickness_mm = { batch_sd = 0.1 }\n\
                substrate_modulus_MPa = { batch_sd = 0.1 }";
    let sweep = sweep(text);
    let case = sweep.grid().case(0);
    let [gap, slant, thickness, modulus] = sweep.deviations() else { panic!("four deviations") };
    assert_eq!(
        (gap.key().as_str(), gap.batch(), gap.scale_sd(&case)),
        ("gap_mm", None, Some(0.05))
    );
    let gap = gap.moved(&case, 0.4).expect("a thickness").design.gap;
    assert!((gap - 0.15).abs() < 1e-15);
    assert_eq!(slant.moved(&case, -3.0).expect("an angle").design.slant_deg, 42.0);
    // A deviation of 8 mm doubles the thickness; all other lengths in mm stay constant.
    let thick = thickness.moved(&case, 8.0).expect("a thickness");
    assert_eq!((thick.material.thickness_mm, thick.design.gap), (Some(16.0), 0.05));
    assert_eq!((thick.design.length, thick.flexure.membrane_thickness), (0.5, 0.0625));
    // A deviation of 0.3 MPa doubles the modulus of the substrate; the scales stay unchanged.
    let stiff = modulus.moved(&case, 0.3).expect("a modulus");
    assert_eq!(stiff.puncture.contact_modulus_over_substrate, 9677.0 / 2.0);
}

/// Start of a definition with a modulus of the scales of 3000 `MPa` and of the membrane of 6 `MPa`.
///
/// Tests append the modulus of the substrate.
const SCALES: &str = "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 1\nslant_deg = 45\n[material]\n\
                      scale_modulus_MPa = 3000\nmembrane_modulus_MPa = 6\n";

#[test]
fn ratios_of_contact_follow_from_the_modulus_of_the_scales() {
    let ratios = |case: &Case| {
        let Case { puncture, flexure, .. } = case;
        [puncture.contact_modulus_over_substrate, flexure.contact_modulus_over_membrane]
    };
    let fixed = format!("{SCALES}substrate_modulus_MPa = 0.3");
    let axis = SCALES.replace("[designs]\n", "[designs]\nsubstrate_modulus_MPa = [0.3, 1.5]\n");
    let varied = format!("{SCALES}[variables]\nsubstrate_modulus_MPa = {{ from = 0.5, to = 1.5 }}");
    for (text, found) in [
        (fixed.as_str(), vec![10_000.0]),
        (axis.as_str(), vec![10_000.0, 2000.0]),
        (varied.as_str(), vec![3000.0]),
    ] {
        let sweep = sweep(text);
        let of = |index| ratios(&sweep.grid().case(index));
        assert_eq!((0..sweep.grid().len()).map(|k| of(k)[0]).collect::<Vec<_>>(), found, "{text}");
        assert_eq!(of(0)[1], 500.0);
        // The written definition contains the modulus and neither ratio.
        let again = sweep.to_toml();
        assert!(
            !again.contains("contact_modulus") && again.contains("scale_modulus_MPa"),
            "{again}"
        );
        let again = Sweep::parse(&again, "again.toml", &[]).expect("a sweep");
        assert_eq!(again.grid().case(0), sweep.grid().case(0));
    }
    let case = sweep(&fixed).grid().case(0);
    // A change of a modulus updates the ratios, and a change of a ratio updates the modulus of the
    // scales.
    let named = |key| Parameter::named(key).expect("a parameter");
    let softer = named("substrate_modulus_MPa").moved(&case, 0.3).expect("a modulus");
    assert_eq!(ratios(&softer), [5000.0, 500.0]);
    let stiffer = named("scale_modulus_MPa").moved(&case, 3000.0).expect("a modulus");
    assert_eq!(ratios(&stiffer), [20_000.0, 1000.0]);
    let ratio = named("contact_modulus_over_substrate").moved(&case, 1000.0).expect("a ratio");
    assert_eq!(ratio.material.scale_modulus_mpa, Some(3300.0));
    // A ratio in a setting replaces the modulus of the scales in the file.
    let setting = Setting::parse("puncture.contact_modulus_over_substrate=50").expect("a setting");
    let set = Sweep::parse(&fixed, "x.toml", &[setting]).expect("a sweep");
    assert_eq!(ratios(&set.grid().case(0)), [50.0, 667.0]);
}

#[test]
fn a_tissue_modulus_in_kpa_or_pa_raises_a_note() {
    let [soft, stiff, wrong] = ["0.31", "1000", "[0.31, 310000]"].map(|modulus| {
        sweep(&format!("name = 'x'\ndesigns.substrate_modulus_MPa = {modulus}")).notes().pop()
    });
    assert_eq!((soft, stiff, sweep("name = 'x'").notes().pop()), (None, None, None));
    insta::assert_snapshot!(wrong.expect("a note"), @"material.substrate_modulus_MPa is 310000 MPa, 310 GPa: soft tissue has 0.001 to 10 MPa; check that the unit is MPa, not kPa or Pa");
    let variable = "name = 'x'\nvariables.substrate_modulus_MPa = { from = 1, to = 2000 }";
    assert!(!sweep(variable).notes().is_empty());
}

/// The steps of finite differences are fractions of these sizes.
#[test]
fn the_size_of_a_parameter_that_may_be_zero_is_at_least_one() {
    let text = "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 0.5\nslant_deg = 0.25";
    let case = sweep(text).grid().case(0);
    let found = ["gap_over_t", "length_over_t", "membrane_thickness_over_t", "slant_deg"]
        .map(|key| sweep::Parameter::named(key).expect("a parameter").size(&case));
    assert_eq!(found[..2], [Some(0.1), Some(0.5)]);
    assert!(found[2].is_some_and(|size| size < 1.0) && found[3] == Some(1.0), "{found:?}");
}

/// Each length in mm is the relative length times the thickness of 2 mm.
///
/// The pitch is base plus gap: 3 mm + 0.5 mm.
#[test]
fn lengths_in_mm_and_over_the_thickness_give_the_same_case() {
    let case = |text: &str| read(text).unwrap().grid().case(0);
    let in_mm = "designs = { gap_mm = 0.5, length_mm = 3, thickness_mm = 2, width_mm = 4 }\n\
        substrate.tissue_thickness_mm = 8\n\
        flexure = { membrane_thickness_mm = 0.25, membrane_length_mm = 100, membrane_axis_offset_mm = -0.5 }\n\
        puncture = { depth_mm = 1, load_inset_mm = 0.5 }";
    let over_t = "designs = { gap_over_t = 0.25, length_over_t = 1.5 }\nscale.width_over_t = 2\n\
        substrate.tissue_thickness_over_t = 4\nmaterial.thickness_mm = 2\n\
        flexure = { membrane_thickness_over_t = 0.125, membrane_length_over_t = 50, membrane_axis_offset_over_t = -0.25 }\n\
        puncture = { depth_over_t = 0.5, load_inset_over_t = 0.25 }";
    let (one, other) = (case(in_mm), case(over_t));
    assert_eq!(
        (one.design, one.flexure, one.tissue_thickness),
        (other.design, other.flexure, other.tissue_thickness)
    );
    assert_eq!(
        (one.punctured(), one.footprint().unwrap()),
        (other.punctured(), other.footprint().unwrap())
    );
    let lengths = [("gap_mm", 0.5), ("length_mm", 3.0), ("width_mm", 4.0), ("pitch_mm", 3.5)];
    for (key, length) in lengths {
        let parameter = sweep::Parameter::named(key).unwrap();
        assert_eq!(
            [one, other].map(|case| parameter.millimetres(&case)),
            [Some(length); 2],
            "{key}"
        );
    }
    let pitched = "scale.base = '2L'\nmaterial.thickness_mm = 2\n[designs]\npitch_mm = 3.5\n";
    for (beside, key) in [("length_mm = 1.5", "gap_mm"), ("length_over_t = 0.75", "gap_mm")] {
        let gap =
            sweep::Parameter::named(key).unwrap().millimetres(&case(&format!("{pitched}{beside}")));
        assert_eq!(gap, Some(0.5), "{beside}");
    }
    for beside in ["gap_mm = 0.5", "gap_over_t = 0.25"] {
        assert_eq!(case(&format!("{pitched}{beside}")).design.length, 0.75, "{beside}");
    }
}

#[test]
fn relative_lengths_follow_changes_of_the_thickness_and_of_lengths_in_mm() {
    let text = "name = 'x'\n[designs]\ngap_mm = 0.5\npitch_mm = 3.5\nthickness_mm = 2\n";
    let case = Sweep::parse(text, "x.toml", &[]).unwrap().grid().case(0);
    let moved = |key: &str, by| sweep::Parameter::named(key).unwrap().moved(&case, by).unwrap();
    let thick = moved("thickness_mm", 2.0);
    assert_eq!((thick.design.gap, thick.design.length), (0.125, 0.75));
    assert_eq!(moved("pitch_mm", 0.5).design.length, 1.75);
    assert_eq!(moved("gap_mm", 0.5).design.length, 1.25);
    // A change of the relative gap updates the pitch in mm and keeps the length.
    let wide = moved("gap_over_t", 0.25);
    assert_eq!((wide.design.gap, wide.design.length, wide.in_mm.pitch), (0.5, 1.5, Some(4.0)));
    let length = sweep::Parameter::named("width_mm").unwrap().moved(&wide, 1.0).unwrap();
    assert_eq!((length.design.width, length.design.gap), (1.5, 0.5));
}

/// The relative gap, its deviation and the relative depth follow from mm and the middle thickness.
#[test]
fn lengths_in_mm_stay_constant_if_the_thickness_varies() {
    let text = "name = 'x'\npuncture.depth_mm = 1\n[designs]\ngap_mm = 0.5\n[variables]\n\
        thickness_mm = { from = 1, to = 3 }\n[tolerance]\ngap_mm = { batch_sd = 0.1, scale_sd = 0.1 }";
    let sweep = Sweep::parse(text, "x.toml", &[]).unwrap();
    let case = sweep.grid().case(0);
    assert_eq!((case.design.gap, case.punctured().depth), (0.25, Some(0.5)));
    let deviation = &sweep.deviations()[0];
    assert_eq!(deviation.scale_sd(&case), Some(0.05));
    assert_eq!(deviation.moved(&case, 0.1).unwrap().in_mm.gap, Some(0.6));
}

/// The file gives the width in `[scale]` and the gap in `[variables]`.
#[test]
fn a_setting_in_mm_replaces_the_length_over_the_thickness() {
    let settings = ["designs.gap_mm=0.4", "scale.width_mm=3", "material.thickness_mm=2"];
    let settings: Vec<_> = settings.map(|text| Setting::parse(text).expect("valid")).to_vec();
    let text =
        "name = 'x'\nscale.width_over_t = 2\n[variables]\ngap_over_t = { from = 0.1, to = 1 }";
    let case = Sweep::parse(text, "x.toml", &settings).expect("valid").grid().case(0);
    assert_eq!((case.design.gap, case.design.width), (0.2, 1.5));
}

#[test]
fn lengths_in_mm_give_short_decimals_as_relative_lengths() {
    let tenths = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
    for axis in [
        "gap_mm = { from = 0.3, to = 3, step = 0.3 }",
        // Base 3 mm plus the gap.
        "pitch_mm = { from = 3.3, to = 6, step = 0.3 }",
    ] {
        let designs = format!("[designs]\nslant_deg = 0\nlength_mm = 3\n{axis}");
        let sweep = read(&format!("material.thickness_mm = 3\n{designs}")).expect("valid");
        let grid = sweep.grid();
        assert!((0..grid.len()).map(|index| grid.case(index).design.gap).eq(tenths), "{axis}");
    }
}

#[test]
fn designs_are_found_by_values_equal_up_to_round_off() {
    let sweep = Sweep::parse("name = 'x'", "x.toml", &[]).expect("valid");
    let mut case = sweep.grid().case(417);
    case.design.gap *= 1.0 + 4.0 * f64::EPSILON;
    assert_eq!(sweep.grid().find(&case), Some(417));
    case.design.gap *= 1.0 + 1e-8;
    assert_eq!(sweep.grid().find(&case), None);
}

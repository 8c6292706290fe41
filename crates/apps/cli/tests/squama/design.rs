//! `squama design`: agreement of a design with the sweep, its files and its messages.

use crate::table::{cell, columns};
use crate::{FEW, Place};

/// Names of the files that `squama design` writes for a design with puncture and bending.
const PATH_FILES: &str = "derived design.toml events.csv flexure_events.csv flexure_path.csv \
                      flexure_scales.csv flexure_steps.csv measures.csv path.csv scales.csv steps.csv";

#[test]
fn design_prints_the_values_of_the_sweep() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q").assert().code(0);
    let text = place.prints("design x.toml --design 0006");
    assert!(text.starts_with("few: design 0006 of 8\n"), "{text}");
    let table = place.read("results/few/designs.csv");
    for name in columns(&table).skip(1) {
        let value = cell(&table, "0006", name);
        let printed = text.lines().find(|line| line.split_whitespace().next() == Some(name));
        let printed = printed.expect("every column is printed").trim_start_matches([' ']);
        let printed = printed.strip_prefix(name).expect("its name").trim_start();
        match (value.parse::<f64>(), printed.split("  ").next().map(str::parse::<f64>)) {
            (Ok(value), Some(Ok(printed))) => {
                assert!((value - printed).abs() <= 5e-6 * value.abs(), "{name}: {printed}");
            }
            _ if value.is_empty() => assert!(printed.starts_with("none"), "{name}: {printed}"),
            _ => assert!(printed.starts_with(value), "{name}: {printed}, expected {value}"),
        }
    }
    let longest = text.split_whitespace().filter(|word| word.parse::<f64>().is_ok()).map(str::len);
    assert!(longest.max() <= Some("-1.23457e-10".len()), "{text}");
    // `measures.csv` has all digits of the table of the sweep.
    let measures = place.read("results/few/designs/0006/measures.csv");
    assert_eq!(measures.lines().next(), Some("measure,value,unit,meaning"));
    let rows = measures.lines().skip(1).map(|line| line.split(',').take(2).collect::<Vec<_>>());
    let cells = columns(&table).map(|name| vec![name, cell(&table, "0006", name)]);
    assert!(rows.eq(cells), "{measures}");
}

#[test]
fn a_folded_design_is_marked() {
    let place = Place::with(FEW);
    let folded = place.prints("design x.toml --gap 0.1 --length 1 --slant 75");
    let line = "\n⚠ Beyond 23 % of the critical force, the modelled surface folds, which is physically impossible: results at larger forces are not valid.\n";
    assert!(folded.contains(line), "{folded}");
    let open = place.prints("design x.toml --gap 0.2 --length 0.5 --slant 60");
    assert!(!open.contains("surface folds"), "{open}");
}

#[test]
fn design_follows_unloading_paths() {
    let place = Place::with(FEW);
    let design = "design x.toml --gap 0.1 --length 1 --slant 45 --set puncture.unload=true --set flexure.unbend=true";
    let values = |friction: &str| {
        let text = place.prints(&format!("{design} --set contact.friction={friction}"));
        ["loop_work", "remaining_displacement", "flexure_loop_work"].map(|name| -> f64 {
            let line = text.lines().find(|line| line.split_whitespace().next() == Some(name));
            let value = line.and_then(|line| line.split_whitespace().nth(1));
            value.expect(name).parse().expect("a number")
        })
    };
    let [work, displacement, bending] = values("0.3");
    assert!(work > 1e-3 && displacement.abs() < 1.0 && bending >= 0.0, "{work} {displacement}");
    let back = place.read("results/few/designs/0004/way_back.csv");
    let forces = back.lines().skip(1).map(|line| line.split(',').nth(1).expect("a force"));
    let forces: Vec<f64> = forces.map(|force| force.parse().expect("a number")).collect();
    assert!(forces.first() > forces.last() && forces.last() < Some(&1e-9), "{forces:?}");
    assert!(!back.lines().next().expect("a header").contains("unstable"), "{back}");
    for value in values("0") {
        assert!(value.abs() < 1e-9, "{value}");
    }
    // The curves of puncture and bending contain loading and unloading.
    let curves = design.replace("design", "plot curves");
    place.prints(&format!("{curves} --set contact.friction=.3 --out c"));
    for figure in ["force-displacement", "moment-curvature"] {
        let svg = place.read(&format!("c/{figure}-curves-of-0004.svg"));
        assert!(svg.contains("thin dashes: unloading"), "{svg}");
    }
}

/// If unloading does not reach zero force, the status states the reason.
#[test]
fn incomplete_unloading_is_explained() {
    let place = Place::with("name = 'x'");
    let design = "design x.toml --design 0021 --set contact.friction=0.1 --set puncture.unload=true \
                  --set puncture.needle=guided --set puncture.needle_friction=0.3 --set puncture.load_inset_over_t=0.05";
    let output = place.squama(design).assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    let reported = ["puncture_status", "loop_work", "unload_status"].map(|name| {
        let line = text.lines().find(|line| line.trim_start().starts_with(name));
        line.and_then(|line| line.split_whitespace().nth(1)).expect("a line").to_owned()
    });
    assert_eq!(reported, ["complete", "none", "jumps"], "{text}");
}

/// A round tip between two scales presses on both scales.
///
/// Each contact force has a lateral component, so the sum of both forces exceeds the load.
#[test]
fn design_writes_the_forces_of_a_round_tip() {
    let place = Place::with(FEW);
    let design = "--gap 0.1 --length 1 --slant 45 --set puncture.needle=guided --set puncture.needle_radius_over_t=0.5 \
                  --set puncture.load_position=1.05";
    place.prints(&format!("design x.toml {design}"));
    let path = place.read("results/few/designs/0004/path.csv");
    let mut lines = path.lines();
    let header = lines.next().expect("a header");
    assert!(header.ends_with(",lateral_force,tip_force_0,tip_force_1"), "{header}");
    let last: Vec<f64> =
        lines.next_back().expect("a row").split(',').map(|x| x.parse().unwrap_or(0.0)).collect();
    let [force, ref forces @ ..] = [last[1], last[last.len() - 2], last[last.len() - 1]];
    assert!(forces.iter().all(|&of| of > 0.0) && forces[0] + forces[1] > force, "{path}");
}

#[test]
fn design_evaluates_load_positions() {
    let place = Place::with(FEW);
    let design = "--gap 0.1 --length 1 --slant 45 --set puncture.places=3";
    let text = place.prints(&format!("design x.toml {design}"));
    let weakest = text.lines().find(|line| line.trim_start().starts_with("weakest_status"));
    assert!(weakest.expect("a status").contains(" complete "), "{text}");
    let table = place.read("results/few/designs/0004/places.csv");
    insta::assert_snapshot!(table.lines().next().expect("a header"), @"place,critical_force,critical_displacement,tilt_deg,critical_event,largest_force,status");
    assert_eq!(
        [1, 2, 3].map(|row| table.lines().nth(row).and_then(|line| line.split(',').next_back())),
        [Some("complete"); 3]
    );
    place.prints(&format!("plot curves x.toml {design} --out c"));
    let figure = place.read("c/force-over-place-of-0004.svg");
    assert!(figure.contains("load position: 0 left corner of the top"), "{figure}");
}

#[test]
fn plot_shows_the_force_against_the_body_radius_for_several_designs() {
    let place = Place::with(FEW);
    let radii = "--set body.radius_over_t=-40 --set body.radius_to_over_t=4";
    place.prints(&format!("plot curves x.toml --gap 0.1 --length 1 {radii} --out c"));
    let files = std::fs::read_dir(place.path("c")).expect("a folder");
    let names = files.map(|file| file.expect("a file").file_name().to_string_lossy().into_owned());
    let name =
        names.into_iter().find(|name| name.starts_with("force-over-radius")).expect("figure");
    let figure = place.read(&format!("c/{name}"));
    assert!(figure.contains("below 0 concave") && figure.contains("the worst body"), "{figure}");
}

#[test]
fn design_states_the_radius_at_which_scales_touch() {
    let place = Place::with(FEW);
    let design = "design x.toml --gap 0.1 --length 1 --slant 45 --set material.thickness_mm=2";
    let output = place.squama(&format!("{design} --set body.radius_over_t=-4")).assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    let line = text.lines().find(|line| line.starts_with("The scales touch")).expect("a radius");
    let radius = line.split_whitespace().nth(9).and_then(|radius| radius.parse::<f64>().ok());
    let radius = radius.expect("a number");
    // With a slightly larger radius the scales do not overlap; with a smaller radius they overlap.
    place.squama(&format!("{design} --set body.radius_over_t={}", 1.001 * radius)).assert().code(0);
    let closer = format!("{design} --set body.radius_over_t={}", 0.999 * radius);
    place.squama(&closer).assert().code(1);
}

#[test]
fn design_writes_its_paths() {
    let place = Place::with(FEW);
    place.squama("design x.toml --gap 0.1 --length 1 --slant 45").assert().code(0);
    let folder = "results/few/designs/0004";
    assert_eq!(place.list(folder), PATH_FILES);
    let tables = PATH_FILES.split_whitespace().filter(|file| file.contains(".csv"));
    insta::assert_snapshot!(tables.map(|file| {
        let text = place.read(&format!("{folder}/{file}"));
        assert!(text.lines().count() > 1, "{file} is empty");
        format!("{file}: {}\n", text.lines().next().expect("a header"))
    }).collect::<Vec<_>>().concat(), @r"
    events.csv: displacement,force,tilt_deg,left_scale,right_scale,kind,change,drop
    flexure_events.csv: curvature,moment,end_rotation_deg,gap,kind,change
    flexure_path.csv: curvature,moment,stiffness,end_rotation_deg,bending_energy,axial_energy,contact_energy,contacts,membrane_strain
    flexure_scales.csv: scale,displacement_x,displacement_y,rotation_deg
    flexure_steps.csv: step,iteration,residual,end_rotation_deg
    measures.csv: measure,value,unit,meaning
    path.csv: displacement,force,tilt_deg,contacts,unstable_under_load,unstable_under_depth,unstable_under_tilt,gap_stretch_min,gap_stretch_max
    scales.csv: scale,displacement_x,displacement_y,rotation_deg,reaction
    steps.csv: step,iteration,residual,tilt_deg
    ");
    assert_eq!(place.read(&format!("{folder}/scales.csv")).lines().count(), 1 + 21);
}

#[test]
fn design_differentiates_its_measures() {
    let place = Place::with(FEW);
    let design = "design x.toml --gap 0.1 --length 1 --slant 45 --sensitivity";
    let text = place.prints(design);
    assert!(text.contains("Change for one per cent of a parameter"), "{text}");
    let folder = "results/few/designs/0004";
    assert!(place.list(folder).contains("sensitivity.csv"));
    let table = place.read(&format!("{folder}/sensitivity.csv"));
    let header = "design,measure,parameter,value,derivative,elasticity,left,right,kink";
    assert_eq!(table.lines().next(), Some(header));
    // A gap of 0.1 between bases of 1 gives a coverage of 0.9. A wider gap reduces the coverage by
    // the same amount, so the derivative is -1.
    let coverage = table.lines().find(|line| line.starts_with("0004,coverage,gap_over_t"));
    let cells: Vec<_> = coverage.expect("a line").split(',').collect();
    let [derivative, elasticity] = [4, 5].map(|cell| cells[cell].parse::<f64>().expect("a number"));
    assert!((derivative + 1.0).abs() < 1e-12 && (elasticity + 0.1 / 0.9).abs() < 1e-12);
    for measure in ["critical_force", "first_contact_displacement", "compliance", "max_moment"] {
        assert!(table.contains(&format!("0004,{measure},slant_deg,")), "{measure}");
    }
    place.squama(&design.replace(" --sensitivity", "")).assert().code(0);
    assert_eq!(place.list(folder), PATH_FILES);
}

#[test]
fn a_sweep_may_measure_sensitivities() {
    let place = Place::with(FEW);
    let measures = "--set measures=['coverage','puncture','sensitivity']";
    for (threads, out) in [(1, "one"), (2, "two")] {
        place
            .squama(&format!("run x.toml -q --threads {threads} --out {out} {measures}"))
            .assert()
            .code(0);
    }
    let table = place.read("one/sensitivity.csv");
    assert_eq!(table, place.read("two/sensitivity.csv"));
    assert!(table.lines().count() > 8 * 9 * 8, "{table}");
    let alone = place.refused("check x.toml --set measures=['sensitivity']");
    assert!(alone.contains("expected sensitivity together with a measure"), "{alone}");
}

#[test]
fn designs_off_the_grid_are_solved() {
    let place = Place::with(FEW);
    let text = place.prints("design x.toml --gap 0.15 --length 1 --slant 45");
    assert!(text.starts_with("few: a design off the grid, gap_over_t = 0.15, "), "{text}");
    assert_eq!(place.list("results/few/designs"), "gap_over_t_0.15-length_over_t_1-slant_deg_45");
}

#[test]
fn differences_from_the_sweep_are_listed() {
    let place = Place::with(FEW);
    let text = place.prints("design x.toml --design 4 --set puncture.scales=11 --out y");
    assert!(text.contains("  with puncture.scales = 11 instead of 21\n"), "{text}");
    assert_eq!(place.list("y"), PATH_FILES);
}

#[test]
fn set_adds_axes_to_a_definition() {
    let place = Place::with("name = 'wide'\n[designs]\nwidth_over_t = [1, 2, 4]\nslant_deg = 0");
    let design = "design x.toml --gap 0.2 --length 0.5 --slant 0";
    place.squama(design).assert().code(2);
    let text = place.prints(&format!("{design} --set designs.width_over_t=2"));
    // On the default axes, 0.2 is the 2nd of 10 gaps and 0.5 the 7th of 12 lengths; the width 2 is
    // the 2nd of 3.
    assert!(text.starts_with("wide: design 0056 of 360\n"), "{text}");
}

#[test]
fn a_path_that_stops_early_gives_exit_code_1() {
    let place = Place::with(FEW);
    let stopped =
        place.squama("design x.toml --design 1 --set solver.max_points=3").assert().code(1);
    let text = String::from_utf8(stopped.get_output().stdout.clone()).expect("text");
    assert!(text.contains("too many points"), "{text}");
}

/// If one load position has no force, the weakest of the other positions is reported.
#[test]
fn the_weakest_known_load_position_is_reported() {
    let place = Place::with(
        "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 1\nslant_deg = 75\n[puncture]\nneedle = 'guided'\nplaces = 11\n",
    );
    let text = place.squama("design x.toml --out o").assert().get_output().stdout.clone();
    let text = String::from_utf8_lossy(&text).into_owned();
    let places = place.read("o/places.csv");
    let forces = places.lines().skip(1).filter_map(|row| row.split(',').nth(1)?.parse().ok());
    let weakest = forces.reduce(f64::min).expect("a force");
    assert!(text.contains("the path ends early (off the edge) at 0."), "{text}");
    let (_, reported) = text.split_once("with a critical force of ").expect("a sentence");
    let reported: f64 = reported.lines().next().expect("a line").parse().expect("a number");
    assert!((reported / weakest - 1.0).abs() < 1e-5, "{text}");
}

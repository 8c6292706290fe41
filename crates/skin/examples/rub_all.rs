use rayon::prelude::*;
use skin::puncture::{self, PunctureParameters};
use skin::{Base, Common, Design};
#[path = "../tests/samples/mod.rs"]
mod samples;
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let friction: f64 = args[0].parse().unwrap();
    let designs = match args[1].as_str() {
        "L" => samples::reference_study(Base::L),
        "2L" => samples::reference_study(Base::TwoL),
        n => samples::random(n.parse().unwrap(), 7),
    };
    let common = Common { friction, ..Common::default() };
    let all: Vec<(Design, String, f64, f64, usize)> = designs
        .into_par_iter()
        .map(|design| {
            let start = std::time::Instant::now();
            let p = substrate::calibrate(&design.footprint(0.5).unwrap()).map(|springs| {
                puncture::solve(&design, &springs, &common, &PunctureParameters::default()).unwrap()
            });
            let Ok(p) = p else { return (design, "calibration".to_owned(), 0.0, 0.0, 0) };
            (
                design,
                format!("{:?}", p.status),
                p.path.last().map_or(0.0, |p| p.tilt_deg),
                start.elapsed().as_secs_f64(),
                p.path.len(),
            )
        })
        .collect();
    let mut counts = std::collections::BTreeMap::new();
    for (design, status, tilt, time, points) in &all {
        *counts.entry(status.clone()).or_insert(0) += 1;
        if status != "Complete" {
            println!(
                "{} {} {} {:?}: {status} at {tilt:.4} {time:.2}s {points}",
                design.gap, design.length, design.slant_deg, design.base
            );
        }
    }
    println!(
        "{counts:?} total {:.1}s slowest {:.2}",
        all.iter().map(|a| a.3).sum::<f64>(),
        all.iter().map(|a| a.3).fold(0.0, f64::max)
    );
}

use skin::puncture::{self, PunctureParameters, RowLength};
use skin::{Base, Common, Design, flexure};
fn main() {
    let args: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let [gap, length, slant_deg, friction, scales] = args[..] else { panic!() };
    let design = Design {
        gap,
        length,
        slant_deg,
        base: if std::env::var("B").is_ok() { Base::TwoL } else { Base::L },
        width: 1.0,
    };
    let common = Common { friction, ..Common::default() };
    if scales < 0.0 {
        let parameters = flexure::FlexureParameters {
            elements_per_gap: flexure::MembraneMesh::Elements(1),
            ..Default::default()
        };
        let f = flexure::solve(&design, &common, &parameters).unwrap();
        println!(
            "{:?} M {:?} points {} events {}",
            f.status,
            f.path.last().map(|p| p.moment),
            f.path.len(),
            f.events.len()
        );
        return;
    }
    let scales = if scales == 0.0 { RowLength::Auto } else { RowLength::Scales(scales as usize) };
    let parameters = PunctureParameters { scales, ..Default::default() };
    let springs = substrate::calibrate(&design.footprint(0.5).unwrap()).unwrap();
    let p = puncture::solve(&design, &springs, &common, &parameters).unwrap();
    println!(
        "{:?} F {:?} pen {:?} points {} events {} last {:?}",
        p.status,
        p.measures.critical_force,
        p.measures.penetration,
        p.path.len(),
        p.events.len(),
        p.path.last().map(|p| (p.force, p.tilt_deg))
    );
    if std::env::var("V").is_ok() {
        for e in &p.events {
            println!(
                "  {:8.4} F {:9.5} {:?} {:?} {:?}",
                e.point.tilt_deg, e.point.force, e.left_scale, e.corner_edge, e.change
            );
        }
    }
}

//! Mean curve of several specimens of one design.

/// Number of points of a mean curve.
const POINTS: usize = 60;

/// Mean of the loading branches of several specimens of one design.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanCurve {
    /// Names of the files of the averaged curves.
    pub files: Vec<String>,
    /// Displacement or curvature; mean and standard deviation of the force or moment.
    pub points: Vec<[f64; 3]>,
}

impl MeanCurve {
    /// Averages loading branches over their common range of displacement or curvature.
    ///
    /// `curves` has the name and the points of each branch. `None` for fewer than two curves, or
    /// without a common range.
    pub fn new(curves: &[(&str, Vec<[f64; 2]>)]) -> Option<Self> {
        let lines: Vec<_> = curves.iter().map(|(_, points)| increasing(points)).collect();
        let first = lines.iter().map(|line| line.first().map_or(f64::NAN, |point| point[0]));
        let last = lines.iter().map(|line| line.last().map_or(f64::NAN, |point| point[0]));
        let from = first.reduce(f64::max).filter(|_| lines.len() > 1)?;
        let to = last.reduce(f64::min).filter(|to| *to > from)?;
        let mut points = Vec::new();
        for k in 0..POINTS {
            let at = from + (to - from) * k as f64 / (POINTS - 1) as f64;
            let values: Vec<_> = lines.iter().map(|line| interpolated(line, at)).collect();
            let count = values.len() as f64;
            let mean = values.iter().sum::<f64>() / count;
            let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            points.push([at, mean, (squares / (count - 1.0)).sqrt()]);
        }
        Some(Self { files: curves.iter().map(|(file, _)| (*file).to_owned()).collect(), points })
    }
}

/// Returns the points at which the displacement exceeds all previous ones.
fn increasing(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = Vec::new();
    for point in points {
        if line.last().is_none_or(|last| point[0] > last[0]) {
            line.push(*point);
        }
    }
    line
}

/// Interpolates linearly at position `at` between points of increasing position.
fn interpolated(line: &[[f64; 2]], at: f64) -> f64 {
    let after = line.partition_point(|point| point[0] < at).clamp(1, line.len() - 1);
    let [[x, y], [next_x, next_y]] = [line[after - 1], line[after]];
    y + (next_y - y) * (at - x) / (next_x - x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(slope: f64) -> Vec<[f64; 2]> {
        (0..=10).map(|k| [f64::from(k), slope * f64::from(k)]).collect()
    }

    #[test]
    fn a_mean_curve_has_the_standard_deviation_of_its_specimens() {
        let curves = [("a", line(1.0)), ("b", line(2.0)), ("c", line(3.0))];
        let mean = MeanCurve::new(&curves).expect("a mean");
        assert_eq!((mean.files.len(), mean.points.len()), (3, POINTS));
        for [x, mean, deviation] in mean.points {
            assert!((mean - 2.0 * x).abs() < 1e-12 && (deviation - x).abs() < 1e-12);
        }
        assert_eq!(MeanCurve::new(&curves[..1]), None);
        assert_eq!(
            MeanCurve::new(&[("a", line(1.0)), ("d", vec![[20.0, 1.0], [21.0, 2.0]])]),
            None
        );
    }
}

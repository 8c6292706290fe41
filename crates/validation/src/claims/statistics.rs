//! Trends along the lines of a grid, and shares of variance.

use std::collections::BTreeMap;

use crate::study::MeasuredDesign;

/// A parameter of a design.
pub(crate) type DesignParameter = fn(&MeasuredDesign) -> f64;
/// A value of a design, if it has one.
pub(crate) type DesignValue = fn(&MeasuredDesign) -> Option<f64>;

/// Returns the values along each line of designs that differ in one parameter, ordered by it. Lines without a value
/// somewhere are left out.
pub(crate) fn lines<'d>(
    designs: impl Iterator<Item = &'d MeasuredDesign>,
    along: DesignParameter,
    fixed: [DesignParameter; 2],
    value: DesignValue,
) -> Vec<Vec<f64>> {
    let mut lines = BTreeMap::<[u64; 2], Vec<(f64, Option<f64>)>>::new();
    for design in designs {
        // Parameters are positive, so their bits are in their order.
        let key = fixed.map(|parameter| parameter(design).to_bits());
        lines.entry(key).or_default().push((along(design), value(design)));
    }
    let ordered = lines.into_values().map(|mut line| {
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        line.into_iter().map(|(_, value)| value).collect::<Option<Vec<_>>>()
    });
    ordered.flatten().collect()
}

/// Returns whether values fall from each to the next.
pub(crate) fn falls(line: &[f64]) -> bool {
    line.windows(2).all(|pair| pair[1] < pair[0])
}

/// Returns whether values rise from each to the next.
pub(crate) fn rises(line: &[f64]) -> bool {
    line.windows(2).all(|pair| pair[1] > pair[0])
}

/// Returns the part of the lines for which `holds` is true.
pub(crate) fn share(lines: &[Vec<f64>], holds: fn(&[f64]) -> bool) -> f64 {
    lines.iter().filter(|line| holds(line)).count() as f64 / lines.len() as f64
}

/// Returns the part of the variance of a value that a parameter alone explains: the variance of the means over
/// all designs that share a value of it (the first-order effect, Sobol 1993).
pub(crate) fn explained(designs: &[(&MeasuredDesign, f64)], parameter: DesignParameter) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let mut groups = BTreeMap::<u64, Vec<f64>>::new();
    for (design, value) in designs {
        groups.entry(parameter(design).to_bits()).or_default().push(*value);
    }
    let all: Vec<f64> = designs.iter().map(|(_, value)| *value).collect();
    let centre = mean(&all);
    let between: f64 = groups.values().map(|g| g.len() as f64 * (mean(g) - centre).powi(2)).sum();
    between / all.iter().map(|value| (value - centre).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::{falls, rises, share};

    #[test]
    fn trends() {
        assert!(falls(&[3.0, 2.0, 1.0]) && !falls(&[3.0, 3.0, 1.0]));
        assert!(rises(&[1.0, 2.0]) && !rises(&[1.0, 2.0, 1.5]));
        assert!((share(&[vec![2.0, 1.0], vec![1.0, 2.0]], falls) - 0.5).abs() < 1e-15);
    }
}

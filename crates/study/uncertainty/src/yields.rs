//! Computes the yield: the fraction of samples that meet requirements.

use ranking::{Relation, Requirement};
use statrs::distribution::{ContinuousCDF as _, Normal};

use crate::proportion::Proportion;

/// Yield of a requirement, or of all requirements together.
#[derive(Clone, Debug, PartialEq)]
pub struct RequirementYield {
    /// Requirement; `None` for all requirements together.
    pub requirement: Option<Requirement>,
    /// Fraction of samples that meet the requirement; `None` without samples.
    ///
    /// Failed samples do not meet the requirement.
    pub proportion: Option<Proportion>,
    /// Number of samples without a value.
    pub failed: usize,
    /// Yield that the linear spread predicts; `None` for all requirements together.
    pub linear: Option<f64>,
}

/// Returns the yield of each requirement, then the yield of all requirements together.
///
/// `values[k][n]` is the value of the column of requirement `k` in sample `n`. `nominal[k]` is the
/// nominal value of this column and its linear spread, if known.
pub(crate) fn yields(
    requirements: &[Requirement],
    values: &[Vec<Option<f64>>],
    nominal: &[Option<(f64, f64)>],
) -> Vec<RequirementYield> {
    let meets =
        |k: usize, n: usize| values[k][n].is_some_and(|value| requirements[k].is_met(value));
    let count = values.first().map_or(0, Vec::len);
    let of = |is_counted: &dyn Fn(usize) -> bool| {
        let met = (0..count).filter(|&n| is_counted(n)).count();
        (count > 0).then_some(Proportion { met, of: count })
    };
    let every = 0..requirements.len();
    let together = RequirementYield {
        requirement: None,
        proportion: of(&|n| every.clone().all(|k| meets(k, n))),
        failed: (0..count).filter(|&n| every.clone().any(|k| values[k][n].is_none())).count(),
        // The columns of a sample are correlated, so their spreads do not determine the joint
        // yield.
        linear: None,
    };
    every
        .clone()
        .map(|k| RequirementYield {
            requirement: Some(requirements[k].clone()),
            proportion: of(&|n| meets(k, n)),
            failed: values[k].iter().filter(|value| value.is_none()).count(),
            linear: nominal[k]
                .and_then(|(value, spread)| predicted(&requirements[k], value, spread)),
        })
        .chain((!requirements.is_empty()).then_some(together))
        .collect()
}

/// Returns the probability that a normally distributed value meets the requirement.
///
/// `value` and `spread` are mean and standard deviation. `None` for an equality, or if `spread` is
/// 0.
fn predicted(requirement: &Requirement, value: f64, spread: f64) -> Option<f64> {
    let normal = Normal::new(value, spread).ok()?;
    match requirement.relation {
        Relation::AtLeast | Relation::Above => Some(normal.sf(requirement.limit)),
        Relation::AtMost | Relation::Below => Some(normal.cdf(requirement.limit)),
        // A continuous value meets an equality with probability 0.
        Relation::Equal => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failed_samples_do_not_meet_requirements_and_are_counted() {
        let requirements = ["a >= 1", "b <= 2"].map(|text| text.parse().expect("a requirement"));
        let values = [
            vec![Some(1.0), None, Some(3.0), Some(0.5)],
            vec![Some(1.0), Some(1.0), None, Some(1.0)],
        ];
        let all = yields(&requirements, &values, &[Some((1.0, 0.5)), None]);
        let counts: Vec<_> =
            all.iter().map(|y| (y.proportion.map(|p| (p.met, p.of)), y.failed)).collect();
        assert_eq!(counts, [(Some((2, 4)), 1), (Some((3, 4)), 1), (Some((1, 4)), 2)]);
        assert_eq!(all[0].linear, Some(0.5));
        assert!(all[2].requirement.is_none());
        assert!(yields(&[], &[], &[]).is_empty());
    }
}

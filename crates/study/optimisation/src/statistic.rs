//! Statistics over the samples of a design, and their names.

use results::QUANTILES;

/// Statistic over the samples of a design.
#[derive(Clone, Debug, PartialEq)]
pub enum Statistic {
    /// Quantile: the value below which a column is in a fraction of the samples.
    Quantile {
        /// Column name.
        column: String,
        /// Fraction of samples below the quantile.
        share: f64,
    },
    /// Yield: the fraction of samples that meet all requirements on columns of `designs.csv`.
    ///
    /// The requirement of an unfolded surface also counts, if the goal has it.
    Yield,
}

impl Statistic {
    /// Name of the yield in a goal.
    pub const YIELD: &'static str = "yield";

    /// Name of the objective that replaces a yield for nominal designs: the smallest margin.
    pub const MARGIN: &'static str = "yield_margin";

    /// Parses the name of a statistic, e.g. `yield` or `critical_force_p05`.
    ///
    /// `None` for other names.
    pub fn named(name: &str) -> Option<Self> {
        let quantile =
            |(column, share): (&str, f64)| Self::Quantile { column: column.to_owned(), share };
        if name == Self::YIELD { Some(Self::Yield) } else { split(name).map(quantile) }
    }

    /// Returns the column of a quantile, e.g. `coverage` for `coverage_p50`.
    ///
    /// Other names are returned unchanged.
    pub fn base(name: &str) -> &str {
        split(name).map_or(name, |(column, _)| column)
    }

    /// Returns the description of a table column that contains the statistic.
    pub fn meaning(&self) -> &'static str {
        match self {
            Self::Quantile { .. } => {
                "quantile (_p05: 5 %, _p50: 50 %, _p95: 95 %) of a column over the samples of the design"
            }
            Self::Yield => "fraction of the samples of the design that meet the requirements",
        }
    }
}

/// Splits the name of a quantile into its column and its fraction, e.g. 0.05 for `_p05`.
fn split(name: &str) -> Option<(&str, f64)> {
    QUANTILES
        .into_iter()
        .find_map(|(ending, share)| Some((name.strip_suffix(ending)?.strip_suffix('_')?, share)))
}

#[cfg(test)]
mod tests {
    use super::Statistic;

    #[test]
    fn names_of_quantiles_end_with_their_percentage() {
        let quantile =
            |column: &str, share| Some(Statistic::Quantile { column: column.into(), share });
        assert_eq!(Statistic::named("critical_force_p05"), quantile("critical_force", 0.05));
        assert_eq!(Statistic::named("critical_force_N_p95"), quantile("critical_force_N", 0.95));
        assert_eq!(Statistic::named("yield"), Some(Statistic::Yield));
        for other in ["critical_force", "critical_force_p5", "p05", "yield_p"] {
            assert_eq!(Statistic::named(other), None, "{other}");
        }
        assert_eq!(Statistic::base("coverage_p50"), "coverage");
    }
}

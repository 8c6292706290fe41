//! Statistics over the samples of a design, and their names.

use results::QUANTILES;

/// Statistic over the samples of a design.
#[derive(Clone, Debug, PartialEq)]
pub enum Statistic {
    /// Quantile: the value of a column below which a fraction of the samples lies.
    Quantile {
        /// Column name.
        column: String,
        /// Fraction of samples below the quantile.
        share: f64,
    },
    /// Yield: the fraction of samples that meet all requirements.
    ///
    /// Only requirements on columns of `designs.csv` count, and an unfolded surface if required.
    Yield,
}

impl Statistic {
    /// Name of the yield.
    pub const YIELD: &'static str = "yield";

    /// Name of the nominal substitute for a yield: the least margin.
    pub const MARGIN: &'static str = "yield_margin";

    /// Parses a name, e.g. `yield` or `critical_force_p05`; `None` for other names.
    pub fn named(name: &str) -> Option<Self> {
        let quantile =
            |(column, share): (&str, f64)| Self::Quantile { column: column.to_owned(), share };
        if name == Self::YIELD { Some(Self::Yield) } else { split(name).map(quantile) }
    }

    /// Returns the column of a quantile; other names unchanged.
    pub fn base(name: &str) -> &str {
        split(name).map_or(name, |(column, _)| column)
    }

    /// Returns the description of the column of the statistic.
    pub fn meaning(&self) -> &'static str {
        match self {
            Self::Quantile { .. } => {
                "quantile over the samples of the design, of the column before _p05, _p50 or _p95 (5 %, 50 %, 95 %)"
            }
            Self::Yield => "fraction of the samples of the design that meet the requirements",
        }
    }
}

/// Splits the name of a quantile into column and fraction.
fn split(name: &str) -> Option<(&str, f64)> {
    QUANTILES
        .into_iter()
        .find_map(|(ending, share)| Some((name.strip_suffix(ending)?.strip_suffix('_')?, share)))
}

#[cfg(test)]
mod tests {
    use super::Statistic;

    #[test]
    fn names_end_with_the_quantile() {
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

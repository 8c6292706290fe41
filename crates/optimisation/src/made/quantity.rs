//! The quantities over skins that are made, by their names.

use results::QUANTILES;

/// A quantity over the skins that are made of a design.
#[derive(Clone, Debug, PartialEq)]
pub enum MadeQuantity {
    /// The value of a column below which this share of the skins lies.
    Quantile {
        /// The column.
        column: String,
        /// The share.
        share: f64,
    },
    /// The share of the skins that meets every requirement of a column of `designs.csv`, and whose surface has not folded if that
    /// is wanted.
    Yield,
}

impl MadeQuantity {
    /// The name of the yield.
    pub const YIELD: &'static str = "yield";

    /// The name of what takes the place of a yield of a design as it is drawn: how far the design is within its requirements.
    pub const MARGIN: &'static str = "yield_margin";

    /// The quantity that has this name, e.g. `yield` or `critical_force_p05`; `None` of other names.
    pub fn named(name: &str) -> Option<Self> {
        let quantile = |(ending, share): (&str, f64)| {
            let column = name.strip_suffix(ending)?.strip_suffix('_')?;
            Some(Self::Quantile { column: column.to_owned(), share })
        };
        let is_yield = name == Self::YIELD;
        is_yield.then_some(Self::Yield).or_else(|| QUANTILES.into_iter().find_map(quantile))
    }

    /// The column that a name is about: of a quantile that which it is of, of others the name.
    pub fn base(name: &str) -> &str {
        let column = |(ending, _): (&str, f64)| name.strip_suffix(ending)?.strip_suffix('_');
        QUANTILES.into_iter().find_map(column).unwrap_or(name)
    }

    /// The meaning of its column.
    pub fn meaning(&self) -> &'static str {
        match self {
            Self::Quantile { .. } => {
                "quantile over the skins that are made of the design, of the column before _p05, _p50 or _p95 (5 %, 50 %, 95 %)"
            }
            Self::Yield => {
                "share of the skins made of the design that meet the requirements of it as drawn"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::MadeQuantity;

    #[test]
    fn names_end_with_the_quantile() {
        let quantile =
            |column: &str, share| MadeQuantity::Quantile { column: column.into(), share };
        assert_eq!(
            MadeQuantity::named("critical_force_p05"),
            Some(quantile("critical_force", 0.05))
        );
        assert_eq!(
            MadeQuantity::named("critical_force_N_p95"),
            Some(quantile("critical_force_N", 0.95))
        );
        assert_eq!(MadeQuantity::named("yield"), Some(MadeQuantity::Yield));
        for other in ["critical_force", "critical_force_p5", "p05", "yield_p"] {
            assert_eq!(MadeQuantity::named(other), None, "{other}");
        }
        assert_eq!(MadeQuantity::base("coverage_p50"), "coverage");
    }
}

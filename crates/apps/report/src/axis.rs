//! Axes of charts: a range of values, linear or logarithmic, with ticks at round numbers.

/// The spacing of the values along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AxisScale {
    Linear,
    Log,
}

/// Ratio of largest to smallest value above which an axis is logarithmic: 1.5 decades.
// Beyond this ratio, small values on a linear axis cannot be distinguished from zero.
const SPANS_DECADES: f64 = 30.0;

/// A chart axis: a range of values with a label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ChartAxis {
    pub(crate) label: String,
    scale: AxisScale,
    low: f64,
    high: f64,
}

/// A tick of an axis. Only major ticks have a text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    /// The text at a major tick; `None` for a minor tick.
    pub(crate) label: Option<String>,
}

impl ChartAxis {
    /// Fits an axis to `values`.
    ///
    /// The axis is logarithmic if all values are positive and the largest exceeds 30 times the
    /// smallest. Otherwise it is linear. A linear axis of positive values starts at zero if the
    /// smallest value is less than half of the largest.
    pub(crate) fn fit(label: &str, values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ends(values);
        if low > 0.0 && high / low > SPANS_DECADES {
            Self::logarithmic(label, low, high)
        } else {
            // An axis from zero shows heights in proportion to the values. Less than half of this
            // axis is empty.
            Self::linear(label, if low > 0.0 && low < 0.5 * high { 0.0 } else { low }, high)
        }
    }

    /// Fits a linear axis to `values` and zero.
    pub(crate) fn spanning(label: &str, values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ends(values.chain(std::iter::once(0.0)));
        Self::linear(label, low, high)
    }

    /// Creates a linear axis from `low` to `high`, with a margin of 5 % of its length at each end.
    ///
    /// An end at zero gets no margin. If `low` and `high` are both zero, the axis ends at 0.05.
    pub(crate) fn linear(label: &str, low: f64, high: f64) -> Self {
        let size = low.abs().max(high.abs());
        // Values that differ only by round-off still need an axis of finite length.
        let margin = match high - low {
            span if span > 1e-9 * size => 0.05 * span,
            _ if size > 0.0 => 0.05 * size,
            _ => 0.05,
        };
        let below = if low == 0.0 { low } else { low - margin };
        let above = if high == 0.0 && low < 0.0 { high } else { high + margin };
        Self { label: label.to_owned(), scale: AxisScale::Linear, low: below, high: above }
    }

    /// Creates a linear axis from `low` to `high`, without margins.
    pub(crate) fn exact(label: &str, low: f64, high: f64) -> Self {
        Self { label: label.to_owned(), scale: AxisScale::Linear, low, high }
    }

    /// Creates a logarithmic axis, with a margin of 5 % of its length beyond `low` and `high`.
    pub(crate) fn logarithmic(label: &str, low: f64, high: f64) -> Self {
        let factor = (high / low).powf(0.05);
        let (low, high) = (low / factor, high * factor);
        Self { label: label.to_owned(), scale: AxisScale::Log, low, high }
    }

    /// Returns the position of `value` along the axis: 0 at the low end, 1 at the high end.
    ///
    /// `None` if the value lies outside the axis.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        let place = match self.scale {
            AxisScale::Linear => (value - self.low) / (self.high - self.low),
            AxisScale::Log => (value / self.low).ln() / (self.high / self.low).ln(),
        };
        // Values at the ends are inside, despite round-off.
        (-1e-9..=1.0 + 1e-9).contains(&place).then_some(place)
    }

    /// Returns the ticks of the axis; about `wanted` of them have a label.
    pub(crate) fn ticks(&self, wanted: usize) -> Vec<Tick> {
        match self.scale {
            AxisScale::Linear => self.linear_ticks(wanted),
            AxisScale::Log => self.log_ticks(wanted),
        }
    }

    fn linear_ticks(&self, wanted: usize) -> Vec<Tick> {
        let rough = (self.high - self.low) / wanted as f64;
        let unit = 10f64.powf(rough.log10().floor());
        // Accept a step up to 10 % too narrow: the next wider step may halve the number of ticks.
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * unit >= 0.9 * rough);
        let step = step.unwrap_or(10.0) * unit;
        // The casts cannot overflow: the length of an axis exceeds 1e-9 times the absolute value of
        // each end.
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        let ends = self.low.abs().max(self.high.abs());
        (first..=last)
            .map(|k| {
                let value = k as f64 * step;
                Tick { value, label: Some(linear_label(value, step, ends)) }
            })
            .collect()
    }

    fn log_ticks(&self, wanted: usize) -> Vec<Tick> {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let decades = self.high.log10() - self.low.log10();
        let every = ((decades / (1.4 * wanted as f64)).ceil() as i32).max(1);
        // On an axis of more than seven decades, ticks between powers of ten would overlap.
        let digits = if decades > 7.0 { 1 } else { 9 };
        // The notation is chosen once for the axis, so that all labels have the same notation.
        let decimal = first >= -2 && last <= 4;
        let all = (first..=last).flat_map(|decade| (1..=digits).map(move |digit| (decade, digit)));
        all.map(|(decade, digit)| {
            let value = f64::from(digit) * 10f64.powi(decade);
            let is_labelled = match digit {
                1 => decade.rem_euclid(every) == 0,
                // On a short axis, powers of ten alone would give only one or two labels.
                2 | 5 => decades < 2.2 && wanted > 3,
                _ => false,
            };
            let label = is_labelled.then(|| power(decade, digit, decimal));
            Tick { value, label }
        })
        .filter(|tick| self.place(tick.value).is_some())
        .collect()
    }
}

/// Formats the label of the tick at `value` on a linear axis with ticks at multiples of `step`.
///
/// `ends` is the larger absolute value of both ends of the axis. If it is below 0.001, or at least
/// 100 000, labels are multiples of its power of ten.
fn linear_label(value: f64, step: f64, ends: f64) -> String {
    let decade = ends.log10().floor();
    if (-3.0..5.0).contains(&decade) {
        let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        return minus(&format!("{value:.decimals$}"));
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let decimals = (decade - (step.log10() + 1e-9).floor()).max(0.0) as usize;
    minus(&format!("{:.decimals$}·10^{{{decade}}}", value / 10f64.powf(decade)))
}

/// Formats `digit · 10^decade`: as a decimal number if `decimal`, otherwise as a power of ten.
fn power(decade: i32, digit: i32, decimal: bool) -> String {
    let decimals = usize::try_from(-decade).unwrap_or(0);
    match digit {
        _ if decimal => format!("{:.decimals$}", f64::from(digit) * 10f64.powi(decade)),
        1 => format!("10^{{{}}}", minus(&decade.to_string())),
        _ => format!("{digit}·10^{{{}}}", minus(&decade.to_string())),
    }
}

/// Replaces hyphens by minus signs.
fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// Returns the smallest and the largest finite value; 0 and 1 if no value is finite.
pub(crate) fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let ends = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if ends.0 <= ends.1 { ends } else { (0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::ChartAxis;

    fn labels(axis: &ChartAxis) -> String {
        let labels: Vec<_> = axis.ticks(5).into_iter().filter_map(|tick| tick.label).collect();
        labels.join(" ")
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(labels(&ChartAxis::fit("", [0.1, 1.0].into_iter())), "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(labels(&ChartAxis::fit("", [-3.0, 4.0].into_iter())), "−2 0 2 4");
        let small = ChartAxis::fit("", [0.0, 6e-5].into_iter());
        assert_eq!(labels(&small), "0 2·10^{−5} 4·10^{−5} 6·10^{−5}");
    }

    #[test]
    fn equal_values_have_an_axis_with_ticks() {
        for value in [0.0, 1.0, -2.0, 1e-7, 3e12] {
            for other in [value, value * (1.0 + 1e-15)] {
                let axis = ChartAxis::fit("", [value, other].into_iter());
                assert!(axis.place(value).is_some(), "{value}");
                assert!((1..12).contains(&axis.ticks(5).len()), "{value}: {:?}", axis.ticks(5));
            }
        }
    }

    #[test]
    fn values_over_decades_get_a_logarithmic_axis() {
        assert_eq!(
            labels(&ChartAxis::fit("", [1e-6, 1e4].into_iter())),
            "10^{−6} 10^{−4} 10^{−2} 10^{0} 10^{2} 10^{4}"
        );
        assert_eq!(labels(&ChartAxis::fit("", [0.025, 1.0].into_iter())), "0.05 0.1 0.2 0.5 1");
    }
}

//! A scale bar of a round number of millimetres, for skins of known thickness.

use super::view::View;
use crate::colors::INK;
use crate::label::{Anchor, label};
use crate::svg::{Element, Spot, line};

/// Maximum length of the bar, px.
const LONGEST: f64 = 110.0;
/// Height of the ticks at both ends of the scale bar, px.
const TICK: f64 = 3.0;

/// Returns the scale bar with its right end at `[x, y]`; `None` without a thickness.
pub(super) fn scale_bar(view: &View, thickness_mm: Option<f64>, [x, y]: Spot) -> Option<Element> {
    let px_per_mm = view.scale / thickness_mm?;
    let length = round_below(LONGEST / px_per_mm);
    let left = x - length * px_per_mm;
    let [from, to] = [left, x].map(|x| line([x, y - TICK], [x, y + TICK], INK, 1.0));
    let text = format!("{} mm", text::number::text(length));
    let middle = [0.5 * (left + x), y - 6.0];
    Some(Element::group("scale-bar").containing([
        line([left, y], [x, y], INK, 1.0),
        from,
        to,
        label(&text, middle, 11.0, Anchor::Middle).with("fill", INK),
    ]))
}

/// Returns the largest of 1, 2, 5, 10, 20 … that is at most `length`.
fn round_below(length: f64) -> f64 {
    let exponent = length.log10().floor() as i32;
    let fits = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * 10_f64.powi(exponent) <= length);
    // A negative power is computed as an inverse, because positive powers of ten are exact.
    let power = 10_f64.powi(exponent.abs());
    let digit = fits.unwrap_or(1.0);
    if exponent < 0 { digit / power } else { digit * power }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_have_round_lengths_to_scale() {
        assert_eq!([7.3, 1.0, 0.04, 230.0, 0.5].map(round_below), [5.0, 1.0, 0.02, 200.0, 0.5]);
        // With 40 px for 2 mm, a bar of 5 mm is 100 px long.
        let view = View { scale: 40.0, origin: [0.0, 0.0] };
        let bar = scale_bar(&view, Some(2.0), [200.0, 10.0]).expect("a scale bar").to_text();
        assert!(bar.contains("5 mm") && bar.contains("x1=\"100\""), "{bar}");
        assert!(scale_bar(&view, None, [200.0, 10.0]).is_none());
    }
}

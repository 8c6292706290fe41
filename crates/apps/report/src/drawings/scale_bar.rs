//! A bar of a round number of millimetres, for drawings of skins whose thickness is known.

use super::view::View;
use crate::colors::INK;
use crate::label::{Anchor, label};
use crate::svg::{Element, Spot, line};

/// The longest bar, px.
const LONGEST: f64 = 110.0;
/// Height of the ticks at its ends, px.
const TICK: f64 = 3.0;

/// Returns the bar for a view of scales that are `thickness_mm` thick, its right end at a spot. None without a thickness.
pub(super) fn scale_bar(view: &View, thickness_mm: Option<f64>, [x, y]: Spot) -> Option<Element> {
    let px_per_mm = view.scale / thickness_mm?;
    let length = round_below(LONGEST / px_per_mm);
    let left = x - length * px_per_mm;
    let tick = |x: f64| line([x, y - TICK], [x, y + TICK], INK, 1.0);
    let text = format!("{} mm", text::number::text(length));
    let middle = [0.5 * (left + x), y - 6.0];
    Some(Element::group("scale-bar").containing([
        line([left, y], [x, y], INK, 1.0),
        tick(left),
        tick(x),
        label(&text, middle, 11.0, Anchor::Middle).with("fill", INK),
    ]))
}

/// The largest of 1, 2, 5, 10, 20 … that is at most `length`.
fn round_below(length: f64) -> f64 {
    let exponent = length.log10().floor() as i32;
    let fits = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * 10_f64.powi(exponent) <= length);
    // A power of ten below 1 is the inverse of one that is exact.
    let power = 10_f64.powi(exponent.abs());
    let digit = fits.unwrap_or(1.0);
    if exponent < 0 { digit / power } else { digit * power }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_is_round_and_as_long_as_it_says() {
        assert_eq!([7.3, 1.0, 0.04, 230.0, 0.5].map(round_below), [5.0, 1.0, 0.02, 200.0, 0.5]);
        // 40 px for 2 mm: 5 mm take 100 px.
        let view = View { scale: 40.0, origin: [0.0, 0.0] };
        let bar = scale_bar(&view, Some(2.0), [200.0, 10.0]).expect("a bar").to_text();
        assert!(bar.contains("5 mm") && bar.contains("x1=\"100\""), "{bar}");
        assert!(scale_bar(&view, None, [200.0, 10.0]).is_none());
    }
}

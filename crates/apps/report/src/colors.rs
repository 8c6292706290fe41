//! Colours of drawings, figures and maps.

/// Colour of axes and labels.
pub(crate) const INK: &str = "#222222";
/// Colour of secondary marks and notes.
pub(crate) const FAINT: &str = "#767676";
/// Colour of grid lines.
pub(crate) const GRID: &str = "#e6e6e6";
/// Colour of contacts, of bounds and of measured points.
pub(crate) const RED: &str = "#d0021b";

/// Steps of cividis, the sequential colour scale of maps: red, green and blue.
///
/// Cividis is safe for colour-blind readers.
const SEQUENCE: [[u8; 3]; 9] = [
    [0, 32, 77],
    [0, 51, 111],
    [57, 72, 107],
    [87, 93, 109],
    [112, 113, 115],
    [138, 134, 120],
    [166, 157, 117],
    [196, 182, 108],
    [255, 234, 70],
];

/// Returns the colour of a value from 0 to 1 in a map.
pub(crate) fn map_color(fraction: f64) -> String {
    mixed(&SEQUENCE, fraction)
}

/// Mixes `color` (`#rrggbb`) with white if `part` > 0, or with black if `part` < 0.
///
/// The absolute value of `part`, 0 to 1, is the fraction of white or black.
pub(crate) fn shaded(color: &str, part: f64) -> String {
    let [red, green, blue] = [1, 3, 5].map(|k| {
        let text = color.get(k..k + 2).unwrap_or_default();
        let own = f64::from(u8::from_str_radix(text, 16).unwrap_or_default());
        let other = if part > 0.0 { 255.0 } else { 0.0 };
        (own + part.abs() * (other - own)).round() as u8
    });
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Interpolates between the colours `steps`: `fraction` 0 is the first colour, 1 the last.
pub(crate) fn mixed(steps: &[[u8; 3]], fraction: f64) -> String {
    let last = steps.len() - 1;
    let place = fraction.clamp(0.0, 1.0) * last as f64;
    // `below` is at most the last but one step, so that `below + 1` is a valid index.
    let below = (place.floor() as usize).min(last - 1);
    let part = place - below as f64;
    let [r, g, b] = [0, 1, 2].map(|k| {
        let (from, to) = (f64::from(steps[below][k]), f64::from(steps[below + 1][k]));
        (from + part * (to - from)).round() as u8
    });
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Colours of failure modes, from the colour-blind safe palette of Okabe and Ito.
pub(crate) const FAILURES: [(&str, &str); 8] = [
    ("tilt", "#0072b2"),
    ("through", "#56b4e9"),
    ("fold", "#009e73"),
    ("break", "#d55e00"),
    ("bend", "#e69f00"),
    ("debond", "#cc79a7"),
    ("perforate", "#3c3c3c"),
    ("across", "#f0e442"),
];

/// Returns the colour of a failure mode.
pub(crate) fn failure_color(mode: &str) -> &'static str {
    FAILURES.iter().find(|(name, _)| *name == mode).map_or(FAINT, |(_, color)| color)
}

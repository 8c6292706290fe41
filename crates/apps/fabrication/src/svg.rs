//! SVG of outlines, in millimetres.

use std::fmt::Write as _;

use crate::Sheet;

/// Distance of the outlines from the edge of the page, mm.
const MARGIN: f64 = 5.0;

/// Colours of [`Sheet::LAYERS`]; laser cutters assign operations by colour.
const COLORS: [&str; 3] = ["#ff0000", "#0000ff", "#808080"];

pub(crate) fn write(sheet: &Sheet) -> String {
    let [low, high] = sheet.bounds();
    let size = [0, 1].map(|k| high[k] - low[k] + 2.0 * MARGIN);
    let [width, height] = size;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" \
         viewBox=\"0 0 {width} {height}\">\n"
    );
    for (layer, color) in Sheet::LAYERS.into_iter().zip(COLORS) {
        let _ = writeln!(
            text,
            "<g id=\"{layer}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"0.1\">"
        );
        for outline in sheet.outlines().iter().filter(|outline| outline.layer == layer) {
            // The y axis of SVG points down.
            let corner =
                |[x, y]: &[f64; 2]| format!("{},{}", x - low[0] + MARGIN, high[1] - y + MARGIN);
            let corners: Vec<_> = outline.corners.iter().map(corner).collect();
            let _ = writeln!(text, "<polygon points=\"{}\"/>", corners.join(" "));
        }
        text.push_str("</g>\n");
    }
    text + "</svg>\n<!-- squama -->\n"
}

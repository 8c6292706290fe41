//! Conversion from SVG to PNG, with embedded fonts for reproducible images.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Resolution at which one pixel of the image is one px of the drawing, dots per inch.
const PX_PER_INCH: f64 = 96.0;

static FONTS: LazyLock<Arc<fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    for font in [
        include_bytes!("../assets/fonts/LiberationSans-Regular.ttf").as_slice(),
        include_bytes!("../assets/fonts/LiberationSans-Italic.ttf"),
        include_bytes!("../assets/fonts/LiberationSans-Bold.ttf"),
    ] {
        fonts.load_font_data(font.to_vec());
    }
    Arc::new(fonts)
});

/// A drawing that cannot be converted to an image.
#[derive(Debug, thiserror::Error)]
#[error("drawing: cannot be converted to PNG ({0}), expected a drawing that fits in memory")]
pub struct ImageError(String);

/// Renders `svg` as a PNG with `dpi` dots per inch; a drawing has 96 px per inch.
///
/// # Errors
/// If the text is not SVG or the image does not fit in memory.
pub fn png(svg: &str, dpi: f64) -> Result<Vec<u8>, ImageError> {
    let options = Options {
        fontdb: FONTS.clone(),
        font_family: "Liberation Sans".into(),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options).map_err(|error| ImageError(error.to_string()))?;
    // The precision of `f32` suffices for pixels.
    let factor = (dpi / PX_PER_INCH) as f32;
    let size = tree.size().to_int_size().scale_by(factor);
    let size = size.ok_or_else(|| ImageError("the drawing has no size".to_owned()))?;
    let pixels = Pixmap::new(size.width(), size.height());
    let mut pixels = pixels.ok_or_else(|| ImageError("the image is too large".to_owned()))?;
    let transform = Transform::from_scale(factor, factor);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| ImageError(error.to_string()))
}

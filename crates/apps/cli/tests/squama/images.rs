//! The option `--png` writes images of drawings if squama is built with the feature `png`.

use crate::{FEW, Place};

const DRAW: &str = "draw x.toml --design 1 --png --out y";

#[cfg(feature = "png")]
#[test]
fn each_drawing_has_an_image() {
    let place = Place::with(FEW);
    let printed = place.prints(DRAW);
    let images: Vec<_> = printed.lines().filter(|line| line.ends_with(".png")).collect();
    assert!(!images.is_empty(), "{printed}");
    for image in images {
        let drawing = place.path(image.replace(".png", ".svg"));
        assert!(drawing.is_file(), "{}", drawing.display());
        let bytes = std::fs::read(place.path(image)).expect("an image");
        assert!(bytes.starts_with(b"\x89PNG"), "{image}");
    }
}

#[cfg(not(feature = "png"))]
#[test]
fn builds_without_images_explain_how_to_enable_them() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused(DRAW), @"error: --png: this squama was built without images; build it with them: cargo run --release --features png -- followed by the same arguments");
    assert_eq!(place.list("y"), "", "no file is written");
}

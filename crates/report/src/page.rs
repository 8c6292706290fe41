//! The page of a sweep: one self-contained HTML file.
//!
//! Its figures are those of the crate: the scripts of the page show and hide what they hold, and draw nothing but the row of the
//! chosen design. It ranks as the crate `ranking` does, which `scripts/check-page` holds together.

mod curves;
mod data;
mod figures;
mod front;
mod simplified;

use sweep::visible;

use crate::designs::Designs;
use crate::explore::{self, Explorer};
pub use front::PageFront;

const PAGE: &str =
    concat!(include_str!("../assets/page/head.html"), include_str!("../assets/page/page.html"));
/// The styles of the page.
const STYLES: [&str; 5] = [
    include_str!("../assets/page/styles/theme.css"),
    include_str!("../assets/page/styles/layout.css"),
    include_str!("../assets/page/styles/parts.css"),
    include_str!("../assets/page/styles/table.css"),
    include_str!("../assets/page/styles/media.css"),
];
/// The scripts of the page, in the order in which they run.
const SCRIPTS: [&str; 21] = [
    include_str!("../assets/page/scripts/designs.js"),
    include_str!("../assets/page/scripts/elements.js"),
    include_str!("../assets/page/scripts/ranking.js"),
    include_str!("../assets/page/scripts/weightings.js"),
    include_str!("../assets/page/scripts/state.js"),
    include_str!("../assets/page/scripts/address.js"),
    include_str!("../assets/page/scripts/view.js"),
    include_str!("../assets/page/scripts/comparable.js"),
    include_str!("../assets/page/scripts/figures.js"),
    include_str!("../assets/page/scripts/front.js"),
    include_str!("../assets/page/scripts/gap.js"),
    include_str!("../assets/page/scripts/tetrahedron.js"),
    include_str!("../assets/page/scripts/requirements.js"),
    include_str!("../assets/page/scripts/criteria.js"),
    include_str!("../assets/page/scripts/filters.js"),
    include_str!("../assets/page/scripts/table.js"),
    include_str!("../assets/page/scripts/drawing.js"),
    include_str!("../assets/page/scripts/detail.js"),
    include_str!("../assets/page/scripts/compare.js"),
    include_str!("../assets/page/scripts/summary.js"),
    include_str!("../assets/page/scripts/page.js"),
];

/// A name and its value.
pub type Fact = (String, String);

/// The content of a page.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// The solver, and what it starts from.
    pub explorer: Option<Explorer>,
    /// The name of the sweep.
    pub name: String,
    /// The version of the program.
    pub version: String,
    /// The folder of the results, as commands name it.
    pub folder: String,
    /// The designs of the table.
    pub designs: Designs,
    /// The keys of the axes of the grid.
    pub axes: Vec<String>,
    /// The unit and the meaning of each column.
    pub columns: Vec<(String, String)>,
    /// Facts about the run.
    pub run: Vec<Fact>,
    /// The key, the value and the meaning of each parameter that all designs share.
    pub shared: Vec<[String; 3]>,
    /// Whether the curves of punctures, and those of bending, are in newtons and millimetres.
    pub is_physical: [bool; 2],
    /// Designs that were solved again for the page.
    pub solved: Vec<PageDesign>,
    /// Designs that a search has found, if the page is to show them.
    pub front: Option<PageFront>,
    /// The state that the page opens with, as its address would have it: `require=coverage >= 0.6&weights=40,30,20,10`.
    pub opening: String,
}

/// The factors by which a column of a design changes where its gap is 10 % smaller and 10 % larger.
#[derive(Clone, Debug, PartialEq)]
pub struct GapFactors {
    /// The column.
    pub column: String,
    /// The factor for the smaller and for the larger gap; `None` where there is no value.
    pub factors: [Option<f64>; 2],
}

/// A design that was solved again: its drawing, its curves, and how it moves with its gap.
#[derive(Clone, Debug, Default)]
pub struct PageDesign {
    /// The number of the design.
    pub number: String,
    /// The drawing, as SVG; empty if there is no room for it.
    pub svg: String,
    /// Displacements and forces along the path of the puncture.
    pub puncture: Vec<[f64; 2]>,
    /// Curvatures and moments along the path of bending.
    pub flexure: Vec<[f64; 2]>,
    /// The columns that are known where the gap is 10 % smaller and larger.
    pub gap_factors: Vec<GapFactors>,
}

impl Page {
    /// Returns the page as HTML that needs no other file.
    pub fn html(&self) -> String {
        let (section, style, solving) =
            self.explorer.as_ref().map_or_else(Default::default, |explorer| {
                (explorer.section(), explore::STYLE, &explore::SCRIPTS[..])
            });
        let scripts =
            SCRIPTS.iter().chain(solving).map(|script| format!("<script>\n{script}</script>"));
        // Neither `</script` nor `<!--` may end or bend the script that holds the data.
        let data = data::of(self).to_string().replace('<', "\\u003c");
        let parts = [
            ("{{title}}", escaped(&visible(&self.name))),
            ("{{version}}", escaped(&self.version)),
            ("{{style}}", STYLES.concat() + style),
            ("{{explorer}}", section),
            ("{{scripts}}", scripts.collect::<Vec<_>>().join("\n")),
            ("{{data}}", data),
        ];
        filled(PAGE, &parts)
    }
}

/// Returns `template` with each place filled; text that is filled in is not searched again.
pub(crate) fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((start, place, text)) = first_place(rest, parts) {
        page.push_str(&rest[..start]);
        page.push_str(text);
        rest = &rest[start + place.len()..];
    }
    page.push_str(rest);
    page
}

fn first_place<'a>(
    text: &str,
    parts: &'a [(&'a str, String)],
) -> Option<(usize, &'a str, &'a String)> {
    let found = parts.iter().filter_map(|(place, part)| Some((text.find(place)?, *place, part)));
    found.min_by_key(|(start, ..)| *start)
}

pub(crate) fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    text.replace('"', "&quot;").replace('\'', "&#39;")
}

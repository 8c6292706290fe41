//! The page of a sweep: one self-contained HTML file.
//!
//! This crate draws the figures; the scripts of the page show and hide marks, and draw the row of
//! the selected design. The page ranks designs like the crate `ranking`; `scripts/check-page`
//! compares the two rankings.

mod curves;
mod data;
mod figures;
mod front;
mod simplified;

use std::io::{self, Write};

use ranking::Criterion;
use serde::Serialize;

use crate::designs::Designs;
use crate::explore::{self, Explorer};
use crate::template::{ELEMENTS, fill, fill_head, fill_json};
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
/// The script that unpacks the table.
const UNPACKING: &str = include_str!("../assets/page/scripts/table-data.js");
/// The scripts that need the table, in the order in which they run.
const SCRIPTS: [&str; 20] = [
    include_str!("../assets/page/scripts/designs.js"),
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

/// Name and value of a fact about a run.
pub type Fact = (String, String);

/// The content of a page.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// The interactive design with its solver; `None` for a page without interactive design.
    pub explorer: Option<Explorer>,
    /// The name of the sweep.
    pub name: String,
    /// The version of the program.
    pub version: String,
    /// The results folder, as given on the command line.
    pub folder: String,
    /// The designs of the table.
    pub designs: Designs,
    /// The default criteria of a ranking.
    pub criteria: Vec<Criterion>,
    /// The keys of the axes of the grid.
    pub axes: Vec<String>,
    /// The unit and the meaning of each column.
    pub columns: Vec<(String, String)>,
    /// Facts about the run.
    pub run: Vec<Fact>,
    /// Warnings about the sweep as a whole.
    pub notes: Vec<String>,
    /// Key, value and meaning of each parameter shared by all designs.
    pub shared: Vec<[String; 3]>,
    /// True if the curves (puncture, bending) are in physical units.
    pub is_physical: [bool; 2],
    /// Designs that were solved again for the page.
    pub solved: Vec<PageDesign>,
    /// Designs found by a search, if any are shown.
    pub front: Option<PageFront>,
    /// Initial state, in the form of the page's address: `require=coverage >= 0.6&weights=4,3,2,1`.
    pub opening: String,
}

/// Factors by which a column changes for a gap 10 % smaller and 10 % larger.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GapFactors {
    /// Name of the column.
    pub column: String,
    /// Factors for the smaller and for the larger gap; `None` if a value is missing.
    pub factors: [Option<f64>; 2],
}

/// A design solved again for the page: drawing, curves, and sensitivity to the gap.
#[derive(Clone, Debug, Default)]
pub struct PageDesign {
    /// The number of the design.
    pub number: String,
    /// The drawing as SVG; empty if the page would become too large.
    pub svg: String,
    /// Displacements and forces along the path of the puncture.
    pub puncture: Vec<[f64; 2]>,
    /// Curvatures and moments along the path of bending.
    pub flexure: Vec<[f64; 2]>,
    /// Changes of the columns for a gap 10 % smaller and 10 % larger.
    pub gap_factors: Vec<GapFactors>,
}

impl Page {
    /// Writes the page as a self-contained HTML file.
    ///
    /// Figures are drawn, compressed and written one by one, because all figures together need
    /// 100 MB of memory.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let solver = self.explorer.as_ref();
        let mut figures = Vec::new();
        fill(out, PAGE, |out, place| match place {
            "style" => {
                let style = solver.map_or("", |_| explore::STYLE);
                write!(out, "{}{style}", STYLES.concat())
            }
            "explorer" => solver.map_or(Ok(()), |explorer| explorer.write_section(out)),
            "packed" => {
                data::write_packed_cells(out, &self.designs)?;
                figures = figures::write(out, self)?;
                data::write_drawings(out, self)
            }
            "data" => fill_json(out, &data::of(self, &figures)),
            "scripts" => {
                let solving = solver.map_or_else(String::new, |_| explore::SCRIPTS.concat());
                let waiting = SCRIPTS.concat();
                write!(
                    out,
                    "{ELEMENTS}{UNPACKING}squama.unpack().then(() => {{\n{waiting}{solving}}});"
                )
            }
            _ => fill_head(out, place, &self.name, &self.version),
        })
    }
}

//! The page of a sweep: one self-contained HTML file.

use serde_json::{Value, json};

use crate::designs::Designs;
use crate::palette::{Mark, slant_color};

const PAGE: &str = include_str!("../assets/page/page.html");
const STYLE: &str = include_str!("../assets/page/style.css");
const PLOTLY: &str = include_str!("../assets/plotly/plotly-gl3d.min.js");
const LICENCE: &str = include_str!("../assets/plotly/LICENSE");
/// In the order in which they run.
const SCRIPTS: [&str; 8] = [
    include_str!("../assets/page/1-designs.js"),
    include_str!("../assets/page/2-ranking.js"),
    include_str!("../assets/page/3-charts.js"),
    include_str!("../assets/page/4-figures.js"),
    include_str!("../assets/page/5-tetrahedron.js"),
    include_str!("../assets/page/6-table.js"),
    include_str!("../assets/page/7-detail.js"),
    include_str!("../assets/page/8-page.js"),
];

/// A name and what belongs to it.
pub type Fact = (String, String);

/// What a page shows.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// Name of the sweep.
    pub name: String,
    /// Version of the program.
    pub version: String,
    /// Folder of the results, as commands name it.
    pub folder: String,
    /// The table.
    pub designs: Designs,
    /// Keys of the axes of the grid.
    pub axes: Vec<String>,
    /// Unit and meaning of each column.
    pub columns: Vec<(String, String)>,
    /// What the run was.
    pub run: Vec<Fact>,
    /// Key, value and meaning of the parameters that all designs share.
    pub shared: Vec<[String; 3]>,
    /// Drawings, by the number of their design.
    pub drawings: Vec<Fact>,
}

impl Page {
    /// The page as HTML, which needs nothing besides itself.
    pub fn html(&self) -> String {
        let scripts: Vec<_> =
            SCRIPTS.iter().map(|script| format!("<script>\n{script}</script>")).collect();
        // `</` would end the script that holds the data.
        let data = self.data().to_string().replace("</", "<\\/");
        let parts = [
            ("{{title}}", escaped(&self.name)),
            ("{{version}}", escaped(&self.version)),
            ("{{style}}", STYLE.to_owned()),
            ("{{licence}}", escaped(LICENCE)),
            ("{{plotly}}", PLOTLY.to_owned()),
            ("{{scripts}}", scripts.join("\n")),
            ("{{data}}", data),
        ];
        filled(PAGE, &parts)
    }

    fn data(&self) -> Value {
        let headers = self.designs.headers();
        let columns: Vec<_> = headers
            .iter()
            .zip(&self.columns)
            .map(|(name, (unit, meaning))| json!({"name": name, "unit": unit, "meaning": meaning}))
            .collect();
        let row = |row| headers.iter().map(|header| self.cell(header, row)).collect::<Vec<_>>();
        let fact = |(name, value): &Fact| json!({"name": name, "value": value});
        let shared = |[key, value, meaning]: &[String; 3]| json!({"key": key, "value": value, "meaning": meaning});
        let drawing = |(design, svg): &Fact| json!({"design": design, "svg": svg});
        json!({
            "name": self.name,
            "folder": self.folder,
            "axes": self.axes,
            "columns": columns,
            "rows": (0..self.designs.count()).map(row).collect::<Vec<_>>(),
            "slants": self.designs.values("slant_deg").into_iter().map(slant).collect::<Vec<_>>(),
            "run": self.run.iter().map(fact).collect::<Vec<_>>(),
            "shared": self.shared.iter().map(shared).collect::<Vec<_>>(),
            "drawings": self.drawings.iter().map(drawing).collect::<Vec<_>>(),
        })
    }

    /// A number where the cell is one; the number of a design keeps its zeros.
    fn cell(&self, header: &str, row: usize) -> Value {
        let text = self.designs.text(header, row);
        match self.designs.number(header, row) {
            _ if text.is_empty() => Value::Null,
            Some(number) if header != "design" => json!(number),
            _ => json!(text),
        }
    }
}

/// Colour, symbol and path of the mark of a slant.
fn slant(degrees: f64) -> Value {
    let mark = Mark::of(degrees);
    json!({
        "degrees": degrees,
        "color": slant_color(degrees),
        "symbol": mark.plotly_symbol(),
        "path": mark.path(),
    })
}

/// `template` with each place filled; what is filled in is not searched again.
fn filled(template: &str, parts: &[(&str, String)]) -> String {
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

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

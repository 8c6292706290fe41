//! The page of a sweep: one self-contained HTML file.
//!
//! The scripts of the page draw and rank, but the axes of its charts, the rescaled criteria and the Pareto front come from
//! here, so that the page cannot differ from figures and tables.

use ranking::{Ranking, Weights};
use serde_json::{Map, Value, json};

use crate::axis::ChartAxis;
use crate::designs::Designs;
use crate::palette::{Mark, slant_color};

const PAGE: &str = include_str!("../assets/page/page.html");
const STYLE: &str = include_str!("../assets/page/style.css");
const PLOTLY: &str = include_str!("../assets/plotly/plotly-gl3d.min.js");
const LICENCE: &str = include_str!("../assets/plotly/LICENSE");
/// The scripts of the page, in the order in which they run.
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

/// A name and its value.
pub type Fact = (String, String);

/// The content of a page.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// The name of the sweep.
    pub name: String,
    /// The version of the program.
    pub version: String,
    /// The folder of the results, as commands name it.
    pub folder: String,
    /// The designs of the table.
    pub designs: Designs,
    /// The designs that can be ranked.
    pub ranking: Vec<RankingEntry>,
    /// The keys of the axes of the grid.
    pub axes: Vec<String>,
    /// The unit and the meaning of each column.
    pub columns: Vec<(String, String)>,
    /// Facts about the run.
    pub run: Vec<Fact>,
    /// The key, the value and the meaning of each parameter that all designs share.
    pub shared: Vec<[String; 3]>,
    /// Drawings by the number of their design.
    pub drawings: Vec<Fact>,
}

/// A design that can be ranked, with all that its rank depends on besides the weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RankingEntry {
    /// The row of the design in the table, from 0.
    pub row: usize,
    /// The criteria, larger being better.
    pub criteria: [f64; 4],
    /// The criteria from 0, the worst of all designs, to 1, the best.
    pub rescaled: [f64; 4],
    /// Whether no other design is better in every criterion.
    pub on_front: bool,
}

impl RankingEntry {
    /// Returns the designs of a ranking, in the order of the table.
    pub fn all(ranking: &Ranking<'_>) -> Vec<Self> {
        let ranked = ranking.by_fitness(Weights::BALANCED);
        let entry = ranked.iter().map(|design| Self {
            row: design.row(),
            criteria: std::array::from_fn(|c| design.criteria()[c]),
            rescaled: std::array::from_fn(|c| design.rescaled()[c]),
            on_front: design.on_front(),
        });
        let mut entries: Vec<Self> = entry.collect();
        entries.sort_by_key(|entry| entry.row);
        entries
    }
}

/// The columns that charts of the page show along their axes.
const CHARTED: [&str; 7] = [
    "gap_over_t",
    "length_over_t",
    "critical_force",
    "penetration",
    "compliance",
    "max_stiffness",
    "secant_stiffness",
];

impl Page {
    /// Returns the page as HTML that needs no other file.
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
            "scales": self.scales(),
            "ranking": self.ranking(),
            "columns": columns,
            "rows": (0..self.designs.count()).map(row).collect::<Vec<_>>(),
            "slants": self.designs.values("slant_deg").into_iter().map(slant).collect::<Vec<_>>(),
            "run": self.run.iter().map(fact).collect::<Vec<_>>(),
            "shared": self.shared.iter().map(shared).collect::<Vec<_>>(),
            "drawings": self.drawings.iter().map(drawing).collect::<Vec<_>>(),
        })
    }

    /// Returns the axes of the charts: by column, and for each criterion those of the designs that are ranked.
    fn scales(&self) -> Value {
        let column = |name: &str| {
            (name.to_owned(), ChartAxis::fit(name, self.designs.numbers(name)).to_plotly())
        };
        let columns: Map<String, Value> = CHARTED.into_iter().map(column).collect();
        let criterion = |k: usize| {
            ChartAxis::fit("", self.ranking.iter().map(|entry| entry.criteria[k])).to_plotly()
        };
        let criteria = [0, 1, 2, 3].map(criterion);
        json!({"columns": columns, "criteria": criteria})
    }

    /// Returns the designs that can be ranked, list by list.
    fn ranking(&self) -> Value {
        let front = self.ranking.iter().filter(|entry| entry.on_front);
        json!({
            "rows": self.ranking.iter().map(|entry| entry.row).collect::<Vec<_>>(),
            "criteria": self.ranking.iter().map(|entry| entry.criteria).collect::<Vec<_>>(),
            "rescaled": self.ranking.iter().map(|entry| entry.rescaled).collect::<Vec<_>>(),
            "front": front.map(|entry| entry.row).collect::<Vec<_>>(),
        })
    }

    /// Returns a cell as a number where it is one; the number of a design keeps its zeros.
    fn cell(&self, header: &str, row: usize) -> Value {
        let text = self.designs.text(header, row);
        match self.designs.number(header, row) {
            _ if text.is_empty() => Value::Null,
            Some(number) if header != "design" => json!(number),
            _ => json!(text),
        }
    }
}

/// Returns the colour, the symbol and the path of the mark of a slant.
fn slant(degrees: f64) -> Value {
    let mark = Mark::of(degrees);
    json!({
        "degrees": degrees,
        "color": slant_color(degrees),
        "symbol": mark.plotly_symbol(),
        "path": mark.path(),
    })
}

/// Returns `template` with each place filled; text that is filled in is not searched again.
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

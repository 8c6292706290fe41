//! A folder of results, as figures and the page need it.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use report::{Designs, Fact, Tetrahedron};
use sweep::Sweep;
use sweep::written::{self, Entry, Value};

/// Steps of the tetrahedron of weights along an edge.
const RESOLUTION: usize = 20;

/// A folder of results.
pub struct ResultsFolder {
    /// Where it is.
    pub folder: PathBuf,
    /// The sweep that was run.
    pub sweep: Sweep,
    /// The table of its designs.
    pub designs: Designs,
    /// What the run was.
    pub run: Vec<Fact>,
}

impl ResultsFolder {
    /// Reads `run.toml` and `designs.csv`.
    pub fn read(folder: &Path) -> anyhow::Result<Self> {
        let sweep = Sweep::read(&folder.join("run.toml"), &[])?;
        let path = folder.join("designs.csv");
        let text = std::fs::read_to_string(&path).with_context(|| {
            format!("{}: cannot be read, expected the table of a run", path.display())
        })?;
        let designs =
            Designs::parse(&text).with_context(|| format!("{}: no table", path.display()))?;
        let run = std::fs::read_to_string(folder.join("run.toml")).unwrap_or_default();
        Ok(Self { folder: folder.to_owned(), sweep, designs, run: facts(&run) })
    }

    /// The best design for every weight of a grid; `None` if none can be ranked.
    pub fn tetrahedron(&self) -> Option<Tetrahedron> {
        Tetrahedron::of(&self.designs, RESOLUTION)
    }
}

/// What stands in the table `run` of `run.toml`.
fn facts(text: &str) -> Vec<Fact> {
    let table = written::parse(text, "run.toml").unwrap_or_default();
    let run = table.into_iter().find(|entry| entry.key == "run").map(|entry| entry.value);
    let Some(Value::Table(entries)) = run else { return Vec::new() };
    let fact = |entry: Entry| match entry.value {
        Value::Table(counts) => {
            let count = |entry: &Entry| format!("{} {}", entry.value, entry.key);
            let counts: Vec<_> = counts.iter().map(count).collect();
            (entry.key.replace('_', " "), counts.join(", "))
        }
        Value::Text(text) => (entry.key.replace('_', " "), text),
        value => (entry.key.replace('_', " "), value.to_string()),
    };
    entries.into_iter().map(fact).collect()
}

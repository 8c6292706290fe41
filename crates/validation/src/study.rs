//! A sweep that was run, design by design.

use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;
use std::time::Duration;

use results::{InvalidResults, Results};
use run::{Options, Program, Start};
use sweep::{Axis, Case, Parameter, Subset, Sweep};

use crate::Error;

/// Keys of the axes of the geometry.
const GEOMETRY: [&str; 3] = ["gap_over_t", "length_over_t", "slant_deg"];

/// What a design measures; `None` where a value does not exist.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Design {
    pub(crate) gap: f64,
    pub(crate) length: f64,
    pub(crate) slant: f64,
    pub(crate) coverage: Option<f64>,
    pub(crate) critical_force: Option<f64>,
    pub(crate) penetration: Option<f64>,
    pub(crate) compliance: Option<f64>,
    pub(crate) initial_compliance: Option<f64>,
    pub(crate) bends_to_contact: bool,
    pub(crate) first_contact: Option<f64>,
    pub(crate) initial_stiffness: Option<f64>,
    pub(crate) max_stiffness: Option<f64>,
}

/// A sweep with its results, or a part of it.
pub(crate) struct Study {
    sweep: Sweep,
    /// What its designs share.
    pub(crate) base: Case,
    pub(crate) results: Results,
    pub(crate) designs: Vec<Design>,
}

impl Study {
    /// Solves every design of a sweep.
    ///
    /// # Errors
    /// If the temporary folder does not take the tables.
    pub(crate) fn run(sweep: Sweep) -> Result<Self, Error> {
        let folder = tempfile::tempdir()?;
        let program = Program { version: env!("CARGO_PKG_VERSION"), revision: "" };
        let options = Options {
            threads: available_parallelism().map_or(1, usize::from),
            format: None,
            fail_fast: false,
            tables_every: Duration::MAX,
            stop: &AtomicBool::new(false),
        };
        run::run(&sweep, Subset::default(), folder.path(), Start::New, &options, &program, |_| {})?;
        let results = Results::read(folder.path())?;
        let designs = designs(&results)?;
        Ok(Self { base: *sweep.grid().base(), sweep, results, designs })
    }

    /// The study of each setting: of each combination of the values of the axes that are not those of the geometry.
    pub(crate) fn settings(&self) -> Vec<(String, Self)> {
        let mut settings = Vec::<(String, Vec<usize>)>::new();
        for row in 0..self.results.len() {
            let setting = self.setting(row);
            match settings.iter_mut().find(|(known, _)| *known == setting) {
                Some((_, rows)) => rows.push(row),
                None => settings.push((setting, vec![row])),
            }
        }
        settings.into_iter().map(|(setting, rows)| (setting, self.only(&rows))).collect()
    }

    fn setting(&self, row: usize) -> String {
        let open = |parameter: &&Parameter| !GEOMETRY.contains(&parameter.key);
        let axes = self.sweep.grid().axes().iter().map(Axis::parameter).filter(open);
        let value = |parameter: &'static Parameter| {
            format!("{} = {}", parameter.key, self.results.parameter(row, parameter))
        };
        axes.map(value).collect::<Vec<_>>().join(", ")
    }

    fn only(&self, rows: &[usize]) -> Self {
        let first = rows.first().map_or(0, |&row| row as u64);
        Self {
            sweep: self.sweep.clone(),
            base: self.sweep.grid().case(first),
            results: self.results.only(rows),
            designs: rows.iter().map(|&row| self.designs[row]).collect(),
        }
    }

    /// The design with these parameters, the first if there are several.
    pub(crate) fn design(&self, gap: f64, length: f64, slant: f64) -> Option<&Design> {
        self.designs.iter().find(|d| (d.gap, d.length, d.slant) == (gap, length, slant))
    }

    /// The design of which a value is largest, among those of which it exists.
    pub(crate) fn largest(
        &self,
        among: impl Fn(&Design) -> bool,
        value: impl Fn(&Design) -> Option<f64>,
    ) -> Option<(&Design, f64)> {
        let all = self.designs.iter().filter(|design| among(design));
        let valued = all.filter_map(|design| Some((design, value(design)?)));
        // The first of equal ones.
        valued.reduce(|best, other| if other.1 > best.1 { other } else { best })
    }
}

fn designs(results: &Results) -> Result<Vec<Design>, InvalidResults> {
    let number = |row, column| results.number(row, results.column(column)?);
    let design = |row| {
        let parameter = |column| Ok(number(row, column)?.unwrap_or(f64::NAN));
        Ok(Design {
            gap: parameter("gap_over_t")?,
            length: parameter("length_over_t")?,
            slant: parameter("slant_deg")?,
            coverage: number(row, "coverage")?,
            critical_force: number(row, "critical_force")?,
            penetration: number(row, "penetration")?,
            compliance: number(row, "compliance")?,
            initial_compliance: number(row, "initial_compliance")?,
            bends_to_contact: results.text(row, results.column("flexure_contact")?) == "yes",
            first_contact: number(row, "first_contact_displacement")?,
            initial_stiffness: number(row, "initial_stiffness")?,
            max_stiffness: number(row, "max_stiffness")?,
        })
    };
    (0..results.len()).map(design).collect()
}

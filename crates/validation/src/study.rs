//! A sweep that was run, design by design.

use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;
use std::time::Duration;

use sweep::{InvalidResults, Options, Part, Program, Results, Start, Sweep};

use crate::Error;

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

/// A sweep with its results.
pub(crate) struct Study {
    pub(crate) sweep: Sweep,
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
            dialect: None,
            fail_fast: false,
            tables_every: Duration::MAX,
            stop: &AtomicBool::new(false),
        };
        sweep::run(&sweep, Part::default(), folder.path(), Start::New, &options, &program, |_| {})?;
        let results = Results::read(folder.path())?;
        let designs = designs(&results)?;
        Ok(Self { sweep, results, designs })
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

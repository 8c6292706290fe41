//! A sweep with its results, design by design.

use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;
use std::time::Duration;

use anyhow::Context as _;
use results::columns::name;
use results::{InvalidResults, Results};
use run::{Options, Program, Start, WorkMeter};
use sweep::{Axis, Case, Parameter, Subset, Sweep};

/// Keys of the geometry, which every study varies.
const GEOMETRY: [&str; 3] = ["gap_over_t", "length_over_t", "slant_deg"];

/// Returns true for parameters of the geometry, which are not open choices.
pub(crate) fn is_geometry(parameter: &Parameter) -> bool {
    GEOMETRY.contains(&parameter.key)
}

/// The parameters and measures of a design; `None` for a missing value.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MeasuredDesign {
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
    pub(crate) gap_stretch_min: Option<f64>,
    pub(crate) gap_stretch_max: Option<f64>,
    pub(crate) fold_force: Option<f64>,
    pub(crate) sound_force: Option<f64>,
}

impl MeasuredDesign {
    /// Returns true if `L/t` is at least 0.1, as in sections 3 and 4 of the paper.
    pub(crate) fn is_in_figures(&self) -> bool {
        self.length >= 0.1
    }

    /// Returns true if the design covers the substrate, as section 5 of the paper requires.
    pub(crate) fn is_covered(&self) -> bool {
        // `None` is less than any value, so designs without a coverage are excluded, too.
        self.coverage > Some(0.0)
    }
}

/// A sweep with its results, or a part of it.
pub(crate) struct Study {
    sweep: Sweep,
    /// The first design. All designs have its parameters, except for the geometry.
    pub(crate) base: Case,
    pub(crate) results: Results,
    pub(crate) designs: Vec<MeasuredDesign>,
}

impl Study {
    /// Solves every design of a sweep.
    ///
    /// # Errors
    /// If the temporary folder cannot be written.
    pub(crate) fn run(sweep: Sweep) -> anyhow::Result<Self> {
        let folder = tempfile::tempdir().context("no temporary folder")?;
        // The revision is omitted because the folder is temporary.
        let program = Program { version: env!("CARGO_PKG_VERSION"), revision: "" };
        let options = Options {
            threads: available_parallelism().map_or(1, usize::from),
            format: None,
            fail_fast: false,
            // The tables are read only at the end.
            tables_every: Duration::MAX,
            stop: &AtomicBool::new(false),
            work: &WorkMeter::default(),
        };
        run::run(&sweep, Subset::default(), folder.path(), Start::New, &options, &program, |_| {})?;
        let results = Results::read(folder.path())?;
        let designs = designs(&results)?;
        Ok(Self { base: sweep.grid().case(0), sweep, results, designs })
    }

    /// Splits the study by the values of all axes except the geometry.
    ///
    /// Returns each setting as `key = value`, with its designs.
    pub(crate) fn settings(&self) -> Vec<(String, Self)> {
        // Unlike a map, a list keeps the order of the sweep.
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
        let axes = self.sweep.grid().axes().iter().map(Axis::parameter);
        let open = axes.filter(|parameter| !is_geometry(parameter));
        open.map(|parameter| {
            format!("{} = {}", parameter.key, self.results.parameter(row, parameter))
        })
        .collect::<Vec<_>>()
        .join(", ")
    }

    fn only(&self, rows: &[usize]) -> Self {
        // These rows differ only in geometry, so the first represents all of them.
        let first = rows.first().map_or(0, |&row| row as u64);
        Self {
            sweep: self.sweep.clone(),
            base: self.sweep.grid().case(first),
            results: self.results.only(rows),
            designs: rows.iter().map(|&row| self.designs[row]).collect(),
        }
    }

    /// Returns the part of this study with the designs of `sweep`.
    ///
    /// `None` if this study lacks any of these designs, or has other measures.
    pub(crate) fn part(&self, sweep: &Sweep) -> Option<Self> {
        let (ours, wanted) = (self.sweep.grid(), sweep.grid());
        // The row equals the index in the grid, because a study solves all designs.
        let rows: Vec<usize> = (0..wanted.len())
            .map(|index| {
                let case = wanted.case(index);
                let row = ours.find(&case)?;
                (ours.case(row) == case).then_some(row as usize)
            })
            .collect::<Option<_>>()?;
        (sweep.measures() == self.sweep.measures()).then(|| self.only(&rows))
    }

    /// Returns the first design with these parameters.
    pub(crate) fn design(&self, gap: f64, length: f64, slant: f64) -> Option<&MeasuredDesign> {
        self.designs.iter().find(|d| (d.gap, d.length, d.slant) == (gap, length, slant))
    }
}

fn designs(results: &Results) -> Result<Vec<MeasuredDesign>, InvalidResults> {
    (0..results.len())
        .map(|row| {
            Ok(MeasuredDesign {
                gap: number(results, row, "gap_over_t")?.unwrap_or(f64::NAN),
                length: number(results, row, "length_over_t")?.unwrap_or(f64::NAN),
                slant: number(results, row, "slant_deg")?.unwrap_or(f64::NAN),
                coverage: number(results, row, name::COVERAGE)?,
                critical_force: number(results, row, name::CRITICAL_FORCE)?,
                penetration: number(results, row, name::PENETRATION)?,
                compliance: number(results, row, name::COMPLIANCE)?,
                initial_compliance: number(results, row, name::INITIAL_COMPLIANCE)?,
                bends_to_contact: results.text(row, results.column(name::FLEXURE_CONTACT)?)
                    == "yes",
                first_contact: number(results, row, name::FIRST_CONTACT)?,
                initial_stiffness: number(results, row, name::INITIAL_STIFFNESS)?,
                max_stiffness: number(results, row, name::MAX_STIFFNESS)?,
                gap_stretch_min: number(results, row, name::GAP_STRETCH_MIN)?,
                gap_stretch_max: number(results, row, name::GAP_STRETCH_MAX)?,
                fold_force: number(results, row, name::FOLD_FORCE)?,
                sound_force: number(results, row, name::SOUND_FORCE)?,
            })
        })
        .collect()
}

fn number(results: &Results, row: usize, column: &str) -> Result<Option<f64>, InvalidResults> {
    results.number(row, results.column(column)?)
}

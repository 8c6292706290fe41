//! Many skins, on all cores.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use results::columns::design_columns;
use results::{Cell, Column, DesignRow};
use sweep::{Case, DesignNumber, PARAMETERS, Parameter, Role, Scalar};

use crate::skin::{Skin, evaluator, measures as measures_of};
use crate::value::{Array, array};
use crate::work::{Watch, threads as threads_of, watched};

/// Skins that a thread takes at a time: neighbours often share their springs.
const TAKEN: usize = 16;

/// Solves skins, and gives the columns of `designs.csv`, with those of the parameters in which they differ.
#[pyfunction]
#[pyo3(signature = (skins, measures=None, threads=None, progress=None))]
pub fn solve_many<'py>(
    py: Python<'py>,
    skins: Vec<Py<Skin>>,
    measures: Option<&Bound<'py, PyAny>>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Vec<Array<'py>>> {
    let evaluator = evaluator(&measures_of(measures)?);
    let task =
        |(k, skin): (usize, &Py<Skin>)| (skin.get().sweep.grid().number(k as u64), skin.get().case);
    let tasks: Vec<(DesignNumber, Case)> = skins.iter().enumerate().map(task).collect();
    let threads = threads_of(threads);
    let rows = watched(py, progress, move |watch| {
        solve(&tasks, threads, watch, |number, case| evaluator.solve(number, case).row)
    })?;
    let rows = rows.ok_or_else(|| PyKeyboardInterrupt::new_err(()))?;
    columns(py, &skins, &rows)
}

/// The rows of all tasks, in their order; `None` if the work was told to stop.
fn solve(
    tasks: &[(DesignNumber, Case)],
    threads: usize,
    watch: &Watch,
    solve: impl Fn(DesignNumber, &Case) -> DesignRow + Sync,
) -> Option<Vec<DesignRow>> {
    watch.all.store(tasks.len(), Ordering::Relaxed);
    let next = AtomicUsize::new(0);
    let rows: Vec<OnceLock<DesignRow>> = tasks.iter().map(|_| OnceLock::new()).collect();
    let work = || loop {
        let begin = next.fetch_add(TAKEN, Ordering::Relaxed);
        if begin >= tasks.len() {
            return;
        }
        for k in begin..tasks.len().min(begin + TAKEN) {
            if watch.stop.load(Ordering::Relaxed) {
                return;
            }
            let (number, case) = &tasks[k];
            let _ = rows[k].set(solve(*number, case));
            watch.done.fetch_add(1, Ordering::Relaxed);
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads.min(tasks.len()) {
            scope.spawn(work);
        }
        work();
    });
    rows.into_iter().map(OnceLock::into_inner).collect()
}

/// The columns of rows whose skins need not be alike.
fn columns<'py>(
    py: Python<'py>,
    skins: &[Py<Skin>],
    rows: &[DesignRow],
) -> PyResult<Vec<Array<'py>>> {
    // Skins of one kind have the same columns, which are made once.
    let mut kinds: Vec<(Kind, Vec<Column<DesignRow>>)> = Vec::new();
    let mut kind_of = Vec::with_capacity(skins.len());
    for skin in skins {
        let kind = Kind::of(skin.get());
        let known = kinds.iter().position(|(other, _)| *other == kind);
        kind_of.push(known.unwrap_or(kinds.len()));
        if known.is_none() {
            kinds.push((kind, design_columns(&skin.get().sweep)));
        }
    }
    let mut names: Vec<(&str, &'static str, &'static str)> = Vec::new();
    for column in kinds.iter().flat_map(|(_, columns)| columns) {
        if !names.iter().any(|(name, ..)| *name == column.name) {
            names.push((&column.name, column.unit, column.meaning));
        }
    }
    let mut all = Vec::new();
    for (name, unit, meaning) in &names {
        let of_kind: Vec<_> =
            kinds.iter().map(|(_, columns)| columns.iter().find(|c| c.name == *name)).collect();
        let cell =
            |(row, kind): (&DesignRow, &usize)| of_kind[*kind].map_or(Cell::Empty, |c| c.cell(row));
        let cells: Vec<Cell> = rows.iter().zip(&kind_of).map(cell).collect();
        all.push(((*name).to_owned(), *unit, *meaning, array(py, cells.into_iter())?));
    }
    for parameter in differing(rows) {
        let column =
            Column::parameter(parameter, |row: &DesignRow| parameter.get(&row.case).into());
        if !names.iter().any(|(name, ..)| *name == column.name) {
            let cells = array(py, rows.iter().map(|row| column.cell(row)))?;
            all.push((column.name.to_string(), column.unit, column.meaning, cells));
        }
    }
    Ok(all)
}

/// The parameters in which designs differ, but for the geometry, which every table has.
fn differing(rows: &[DesignRow]) -> impl Iterator<Item = &'static Parameter> {
    let differ = |p: &&Parameter| rows.iter().any(|row| p.get(&row.case) != p.get(&rows[0].case));
    PARAMETERS.iter().filter(|parameter| !parameter.has(Role::Geometry)).filter(differ)
}

/// What the columns of a skin depend on.
#[derive(PartialEq)]
struct Kind {
    is_imperfect: bool,
    is_guided: bool,
    material: [bool; 4],
    ends: Scalar,
    friction: Option<Scalar>,
}

impl Kind {
    fn of(skin: &Skin) -> Self {
        let Skin { sweep, case } = skin;
        let material = case.material;
        // Of a single tilt no column has the value in its name.
        let list =
            |scalar: Scalar| if let Scalar::List(_) = scalar { scalar } else { Scalar::Word("") };
        Self {
            is_imperfect: sweep.is_imperfect(),
            is_guided: sweep.is_guided(),
            material: [
                material.thickness_mm.is_some(),
                material.substrate_modulus_mpa.is_some(),
                material.membrane_modulus_mpa.is_some(),
                material.scale_density_kg_m3.is_some(),
            ],
            ends: list(case.critical_tilt),
            friction: case.needle_friction.map(list),
        }
    }
}

//! Solves many skins on all cores.

use std::slice;
use std::sync::atomic::Ordering;

use pyo3::prelude::*;
use rayon::prelude::*;
use results::columns::design_columns;
use results::{Cell, Column, DesignRow};
use run::Evaluator;
use sweep::{PARAMETERS, Parameter, Role, Scalar, key};

use crate::skin::{Skin, evaluator, parsed_measures};
use crate::value::{NamedCells, table};
use crate::work::{Watch, interrupted, pool, watched};

/// Number of skins with complete results in memory before their cells are extracted.
const BATCH: usize = 4096;

/// Solves skins, and returns the columns of `designs.csv` and of the differing parameters.
#[pyfunction]
#[pyo3(signature = (skins, measures=None, threads=None, progress=None))]
pub fn solve_many(
    py: Python<'_>,
    skins: Vec<Py<Skin>>,
    measures: Option<&Bound<'_, PyAny>>,
    threads: Option<Bound<'_, PyAny>>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Vec<NamedCells>> {
    let (evaluator, pool) = (evaluator(parsed_measures(measures)?), pool(threads.as_ref())?);
    let solved = watched(py, progress, move |watch| {
        watch.all.store(skins.len(), Ordering::Relaxed);
        columns(&skins, |first, skins| pool.install(|| solve(skins, first, &evaluator, watch)))
    })?;
    solved.ok_or_else(interrupted)
}

/// Solves skins, numbered from `first`, in their order; `None` if the work was stopped.
fn solve(
    skins: &[Py<Skin>],
    first: usize,
    evaluator: &Evaluator,
    watch: &Watch,
) -> Option<Vec<DesignRow>> {
    skins
        .par_iter()
        .enumerate()
        .map(|(k, skin)| {
            let skin = skin.get();
            let number = skin.sweep.grid().number((first + k) as u64);
            let go_on = !watch.stop.load(Ordering::Relaxed);
            let row = go_on.then(|| evaluator.row(number, &skin.case()));
            watch.done.fetch_add(1, Ordering::Relaxed);
            row
        })
        .collect()
}

/// Solves skins batch by batch, and returns the union of their columns.
///
/// `solve` solves the skins of a batch, which are numbered from its first argument.
fn columns(
    skins: &[Py<Skin>],
    mut solve: impl FnMut(usize, &[Py<Skin>]) -> Option<Vec<DesignRow>>,
) -> Option<Vec<NamedCells>> {
    // Skins of the same kind share their columns, which are created once.
    let mut kinds: Vec<(Kind, Vec<Column<DesignRow>>)> = Vec::new();
    let mut kind_of = Vec::with_capacity(skins.len());
    for skin in skins {
        let kind = kind(skin.get());
        let known = kinds.iter().position(|(other, _)| *other == kind);
        kind_of.push(known.unwrap_or(kinds.len()));
        if known.is_none() {
            kinds.push((kind, design_columns(&skin.get().sweep)));
        }
    }
    let mut all: Vec<NamedCells> = Vec::new();
    for column in kinds.iter().flat_map(|(_, columns)| columns) {
        if !all.iter().any(|(name, ..)| *name == column.name) {
            // Start with name, unit and meaning; cells are added batch by batch.
            all.extend(table(slice::from_ref(column), []));
        }
    }
    for (batch, skins) in skins.chunks(BATCH).enumerate() {
        let rows = solve(batch * BATCH, skins)?;
        for (name, .., cells) in &mut all {
            let positions: Vec<_> = kinds
                .iter()
                .map(|(_, columns)| columns.iter().position(|c| c.name == *name))
                .collect();
            let rows = rows.iter().zip(&kind_of[batch * BATCH..]);
            cells.extend(rows.map(|(row, &kind)| {
                positions[kind].map_or(Cell::Empty, |k| kinds[kind].1[k].cell(row))
            }));
        }
    }
    for parameter in differing(skins) {
        let column = Column::parameter(parameter, |skin: &&Py<Skin>| {
            parameter.get(&skin.get().case()).into()
        });
        if !all.iter().any(|(name, ..)| *name == column.name) {
            all.extend(table(&[column], skins));
        }
    }
    Some(all)
}

/// Returns the parameters that differ between skins, without geometry, which every table has.
fn differing(skins: &[Py<Skin>]) -> impl Iterator<Item = &'static Parameter> {
    let all = || PARAMETERS.iter().filter(|parameter| !parameter.has(Role::Geometry));
    let mut same: Vec<_> = all().collect();
    // A parameter is equal for all skins if it is equal for all neighbours.
    for pair in skins.windows(2) {
        let (one, next) = (pair[0].get().case(), pair[1].get().case());
        same.retain(|parameter| parameter.get(&one) == parameter.get(&next));
    }
    all().filter(move |parameter| !same.iter().any(|other| other.key == parameter.key))
}

/// The properties of a skin that determine its columns.
///
/// These are: whether the needle is guided and whether the row is imperfect; for each parameter,
/// whether it is given and whether it differs from its default; and the lists with values in
/// column names.
type Kind = ([bool; 2], Vec<[bool; 2]>, [Option<Scalar>; 2]);

fn kind(skin: &Skin) -> Kind {
    let (sweep, case) = (&skin.sweep, skin.case());
    // Only lists of critical tilts and of needle frictions have values in column names.
    let list = |scalar: Scalar| matches!(scalar, Scalar::List(_)).then_some(scalar);
    let lists = [key::CRITICAL_TILT, key::NEEDLE_FRICTION]
        .map(|key| list(Parameter::named(key)?.get(&case)));
    let set = PARAMETERS.iter().map(|p| [sweep.gives(p.key), sweep.sets(p.key)]);
    ([sweep.is_guided(), sweep.is_imperfect()], set.collect(), lists)
}

//! A skin and its parameters.

use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash as _, Hasher as _};
use std::path::Path;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict as _, PyDict, PyList, PyString, PyTuple};
use report::drawings::PunctureDrawing;
use results::columns::measure_of;
use run::Evaluator;
use skin::flexure::Method;
use skin::puncture::{Snapshots, snapshots};
use substrate::{Coupling, RowStiffness};
use sweep::{Axis, Case, Measure, PARAMETERS, Parameter, Role, Scalar, Sweep, key};
use text::nearest;
use text::toml_source::{KeyValue, Value};

use crate::error::{self, OrFailed as _};
use crate::names::NAMES;
use crate::solved::Solved;
use crate::value::{location, text, value};
use crate::work::watched;

/// Maximum number of skins in a list; each takes about a kilobyte.
const MAX_SKINS: u64 = 1_000_000;

/// The name of the sweep of a single skin.
const NAME: &str = "skin";

/// A skin. Its Python documentation is generated from the list of parameters on import.
#[pyclass(frozen, module = "squama")]
pub struct Skin {
    pub(crate) sweep: Sweep,
}

/// Creates the exception for an unknown key.
pub fn unknown(py: Python<'_>, key: &str) -> PyErr {
    let known = PARAMETERS.iter().map(|parameter| parameter.key);
    let known: Vec<_> = known.chain(NAMES.iter().map(|name| name.keyword)).collect();
    let near = nearest(key, &known).map(|near| format!("did you mean {near}?"));
    let near = near.unwrap_or_else(|| "help(squama.Skin) lists them".to_owned());
    let name = PyString::new(py, key).into_any();
    error::invalid_parameter(py, key, Some(name), &format!("the name of a parameter; {near}"))
}

/// Creates the sweep of one skin; parameters that are `None` keep their defaults.
fn sweep_of(given: &Bound<'_, PyDict>) -> PyResult<Sweep> {
    let py = given.py();
    let entry = |key: &str, value| KeyValue { key: key.to_owned(), value, location: location() };
    let mut sections = vec![entry("name", Value::Text(NAME.into()))];
    let mut keys = Vec::new();
    for (name, of) in given.iter().filter(|(_, of)| !of.is_none()) {
        let name = text(&name)?;
        let named = NAMES.iter().find(|key| key.keyword == name);
        let [in_section, key] = if let Some(of) = named {
            [of.section, of.key]
        } else {
            let parameter = Parameter::named(&name).ok_or_else(|| unknown(py, &name))?;
            // A pitch counts as a gap; it determines the gap or the length, whichever is missing.
            keys.extend([parameter.key, parameter.over_t().map_or("", |of| of.key)]);
            [parameter.section, parameter.key]
        };
        let of = entry(key, value(&of)?);
        // Geometry parameters are axes of a definition, each with one value.
        match sections.iter_mut().find(|section| section.key == in_section) {
            Some(KeyValue { value: Value::Table(entries), .. }) => entries.push(of),
            _ => sections.push(entry(in_section, Value::Table(vec![of]))),
        }
    }
    // If both gap and pitch are given, the pitch determines the length.
    let sets_length = keys.iter().filter(|key| **key == key::GAP).count() > 1;
    if let Some(missing) = Parameter::with(Role::Geometry).find(|p| {
        let follows = p.key == key::LENGTH && sets_length && keys.contains(&key::PITCH);
        !(keys.contains(&p.key) || follows)
    }) {
        return Err(error::invalid_parameter(py, missing.key, None, &missing.expected()));
    }
    let sweep = Sweep::of_entries(&sections, "squama.Skin");
    let sweep = sweep.map_err(|error| error::invalid_definition(py, &error, Some(given)))?;
    let several = sweep.grid().axes().iter().find(|axis| axis.len() > 1);
    let Some(several) = several.map(Axis::parameter) else { return Ok(sweep) };
    let expected = format!("one value, {}", several.expected());
    let found = given.get_item(several.key)?;
    Err(error::invalid_parameter(py, several.key, found, &expected))
}

/// Converts a value to Python.
fn python(py: Python<'_>, scalar: Scalar) -> PyResult<Bound<'_, PyAny>> {
    Ok(match scalar {
        Scalar::Number(number) => number.into_pyobject(py)?.into_any(),
        Scalar::Count(count) => count.into_pyobject(py)?.into_any(),
        // Boolean parameters are words in definitions.
        Scalar::Word(word) => match word.parse::<bool>() {
            Ok(whether) => whether.into_pyobject(py)?.to_owned().into_any(),
            Err(_) => word.into_pyobject(py)?.into_any(),
        },
        Scalar::List(list) => PyTuple::new(py, list.as_slice())?.into_any(),
    })
}

/// The measures that a call requests, and the columns if the call names only columns.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RequestedMeasures {
    pub measures: Vec<Measure>,
    pub columns: Vec<String>,
}

/// Parses measures: a name, a column, a list, or "all" (all without derivatives).
pub fn parsed_measures(of: Option<&Bound<'_, PyAny>>) -> PyResult<RequestedMeasures> {
    let whole = |measures: Vec<Measure>| RequestedMeasures { measures, columns: Vec::new() };
    let Some(of) = of.filter(|of| !of.is_none()) else {
        return Ok(whole(Measure::USUAL.to_vec()));
    };
    let names = of.extract().map(|name: String| vec![name]).or_else(|_| of.extract())?;
    let mut measures = names
        .iter()
        .map(|name| match Measure::named(name).or_else(|| measure_of(name)) {
            Some(measure) => Ok(vec![measure]),
            None if name == "all" => Ok(Measure::USUAL.to_vec()),
            None => {
                let expected =
                    "all, coverage, puncture, flexure, sensitivity, one of their columns, or a list";
                Err(error::invalid_parameter(of.py(), "measures", Some(of.clone()), expected))
            }
        })
        .collect::<PyResult<Vec<_>>>()?
        .concat();
    // Sorted and without duplicates, because evaluators are cached by this list.
    measures.sort();
    measures.dedup();
    let columns =
        if names.iter().all(|name| Measure::named(name).is_none() && measure_of(name).is_some()) {
            names
        } else {
            Vec::new()
        };
    Ok(RequestedMeasures { columns, ..whole(measures) })
}

/// Returns the cached evaluator for these measures, which keeps its springs.
pub fn evaluator(requested: RequestedMeasures) -> Arc<Evaluator> {
    static KNOWN: Mutex<BTreeMap<RequestedMeasures, Arc<Evaluator>>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let entry = known.entry(requested);
    Arc::clone(entry.or_insert_with_key(|RequestedMeasures { measures, columns }| {
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        Arc::new(if columns.is_empty() {
            Evaluator::new(measures)
        } else {
            Evaluator::only_columns(measures, &columns)
        })
    }))
}

impl Skin {
    /// Creates the skin of design `index` of a sweep.
    fn new(sweep: &Sweep, index: u64) -> Self {
        Self { sweep: sweep.only(index) }
    }

    /// Returns the case of the design.
    ///
    /// The case is not stored, which halves the memory of long lists.
    pub(crate) fn case(&self) -> Case {
        self.sweep.grid().case(0)
    }

    /// Returns true for skins that solve within milliseconds.
    ///
    /// Other skins are solved in a separate thread, which can be interrupted.
    fn is_quick(&self) -> bool {
        let Case { imperfection, coupling, flexure, common, puncture, .. } = self.case();
        imperfection.is_none()
            && puncture.places.is_none()
            && coupling == Coupling::Nearest
            && flexure.method == Method::UnitCell
            && common.solver == Case::default().common.solver
    }

    /// Returns the geometry and the parameters that are not at their defaults.
    fn given(&self) -> impl Iterator<Item = (&'static Parameter, Scalar)> {
        let case = self.case();
        let axes = self.sweep.grid().axes().iter();
        let axes = axes.map(|axis| (axis.parameter(), axis.value(0)));
        axes.chain(self.sweep.shared()).filter(move |(parameter, _)| {
            parameter.has(Role::Geometry) || parameter.get(&case) != parameter.default()
        })
    }

    /// Returns the sweep of a definition, given as TOML text or as a file name.
    pub(crate) fn definition(
        py: Python<'_>,
        definition: &Bound<'_, PyAny>,
        settings: &[sweep::Setting],
    ) -> PyResult<Sweep> {
        let text = match definition.cast::<Self>() {
            Ok(skin) => skin.get().sweep.to_toml(),
            Err(_) => text(definition)?,
        };
        // TOML text starts with a name and contains an equals sign, which no path does.
        let is_toml = text.trim_start().starts_with("name") && text.contains('=');
        let sweep = if is_toml || text.contains('\n') {
            Sweep::parse(&text, "definition", settings)
        } else {
            Sweep::read(Path::new(&text), settings)
        };
        sweep.map_err(|error| error::invalid_definition(py, &error, None))
    }
}

#[pymethods]
impl Skin {
    #[new]
    #[pyo3(signature = (**parameters))]
    fn of(py: Python<'_>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let given = parameters.cloned().unwrap_or_else(|| PyDict::new(py));
        Ok(Self::new(&sweep_of(&given)?, 0))
    }

    /// Returns the number of designs of a definition, and all skins or only the skin at an index.
    #[staticmethod]
    fn _designs<'py>(
        py: Python<'py>,
        definition: &Bound<'py, PyAny>,
        index: Option<u64>,
    ) -> PyResult<(u64, Bound<'py, PyList>)> {
        let sweep = Self::definition(py, definition, &[])?;
        let count = sweep.grid().len();
        if let Some(index) = index {
            let skin = (index < count).then(|| Self::new(&sweep, index));
            return Ok((count, list(py, skin.into_iter().collect())?));
        }
        if count > MAX_SKINS {
            let message = format!(
                "the definition has {count} designs, expected at most {MAX_SKINS} for a list of \
                 skins: squama.run solves larger grids"
            );
            return Err(error::refused_definition(py, &message));
        }
        let skins: Vec<Self> = watched(py, None, move |watch| {
            (0..count)
                .take_while(|_| !watch.stop.load(Ordering::Relaxed))
                .map(|index| Self::new(&sweep, index))
                .collect()
        })?;
        Ok((count, list(py, skins)?))
    }

    /// Returns a complete definition of the skin, for `squama run` and `Skin.from_toml`.
    fn to_toml(&self) -> String {
        self.sweep.to_toml()
    }

    /// Returns the geometry and the parameters that are not at their defaults.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let given = self.given().map(|(parameter, of)| Ok((parameter.key, python(py, of)?)));
        given.collect::<PyResult<Vec<_>>>()?.into_py_dict(py)
    }

    /// Returns the failure modes, each with the reason if it is not judged; `None` unless the first
    /// failure is computed.
    #[getter]
    fn failure_modes<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let modes = self.case().judged_modes();
        modes.map(|modes| modes.reasons().into_py_dict(py)).transpose()
    }

    fn __getattr__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let parameter = Parameter::named(name)
            .ok_or_else(|| PyAttributeError::new_err(format!("a Skin has no {name}")))?;
        let case = self.case();
        // A length has a value in millimetres even if it was given in another unit.
        if parameter.is_in_mm() {
            return Ok(parameter.millimetres(&case).into_pyobject(py)?.into_any());
        }
        if !parameter.is_given(&case) {
            return Ok(py.None().into_bound(py));
        }
        python(py, parameter.get(&case))
    }

    /// Solves the skin.
    #[pyo3(signature = (measures=None))]
    fn solve<'py>(
        slf: &Bound<'py, Self>,
        measures: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        static RESULT: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let (py, skin) = (slf.py(), slf.get());
        let evaluator = evaluator(parsed_measures(measures)?);
        let (number, case) = (skin.sweep.grid().number(0), skin.case());
        let solved = if skin.is_quick() {
            py.detach(|| evaluator.solve(number, &case))
        } else {
            watched(py, None, move |_| evaluator.solve(number, &case))?
        };
        let solved = Solved { sweep: skin.sweep.clone(), design: solved };
        RESULT.import(py, "squama._result", "Result")?.call1((slf, solved))
    }

    /// Draws the row at rest and, if the path reaches it, at the critical tilt.
    fn _repr_svg_(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| {
            let case = self.case();
            let footprint = case.footprint().or_failed("drawing")?;
            let substrate =
                RowStiffness::compute(&footprint, case.coupling).or_failed("drawing")?;
            let solved = snapshots(&case.design, &substrate, &case.common, &case.punctured(), &[]);
            let Snapshots { end, is_critical, .. } = solved.or_failed("drawing")?;
            let states = if is_critical { std::slice::from_ref(&end) } else { &[] };
            PunctureDrawing { name: NAME, case: &case, states }.svg().or_failed("drawing")
        })
    }

    fn __repr__(&self) -> String {
        let given = self.given().map(|(of, value)| format!("{}={}", of.key, value.to_toml()));
        format!("Skin({})", given.collect::<Vec<_>>().join(", "))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().case() == self.case())
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        // The map is sorted, because the parameters of equal skins may be given in any order.
        let given = self.given().map(|(of, value)| (of.key, value.to_toml()));
        given.collect::<BTreeMap<_, _>>().hash(&mut hasher);
        hasher.finish()
    }
}

/// Number of objects that are created, in milliseconds, before other threads may run.
const PORTION: usize = 1024;

/// Creates a list of skins, and lets other threads run and handles signals in between.
fn list(py: Python<'_>, skins: Vec<Skin>) -> PyResult<Bound<'_, PyList>> {
    let all = PyList::empty(py);
    for (k, skin) in skins.into_iter().enumerate() {
        all.append(Bound::new(py, skin)?)?;
        if (k + 1) % PORTION == 0 {
            py.detach(std::thread::yield_now);
            py.check_signals()?;
        }
    }
    Ok(all)
}

//! A skin with everything that it is solved with.

use std::collections::hash_map::DefaultHasher;
use std::fmt::Write as _;
use std::hash::{Hash as _, Hasher as _};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyList, PyTuple, PyType};
use report::drawings::PunctureDrawing;
use run::Evaluator;
use skin::flexure::Method;
use skin::puncture::{At, snapshots};
use substrate::{Coupling, RowStiffness};
use sweep::toml_source::{KeyValue, KeyValues, Value};
use sweep::{Case, Measure, PARAMETERS, Parameter, Role, Scalar, Sweep, key, nearest};

use crate::error;
use crate::gradient;
use crate::solved::Solved;
use crate::value::{place, text, value};
use crate::work::watched;

/// The name of the sweep of a single skin.
const NAME: &str = "skin";

/// A skin. Its documentation is made from the list of parameters when the package is imported.
#[pyclass(frozen, module = "squama")]
pub struct Skin {
    pub(crate) sweep: Sweep,
    pub(crate) case: Case,
}

/// A parameter by its key, or by that of the same length in mm.
#[derive(Clone, Copy)]
pub struct Named {
    pub parameter: &'static Parameter,
    pub in_mm: bool,
}

impl Named {
    /// The parameter of `key`.
    pub fn of(key: &str) -> Option<Self> {
        let plain = Parameter::named(key).map(|parameter| Self { parameter, in_mm: false });
        let stem = || key.strip_suffix("_mm");
        let in_mm = || Parameter::named(&format!("{}_over_t", stem()?));
        plain.or_else(|| Some(Self { parameter: in_mm()?, in_mm: true }))
    }

    /// One unit of the parameter in the unit of the key; `None` in mm without a thickness.
    pub fn unit(self, case: &Case) -> Option<f64> {
        if self.in_mm { case.material.thickness_mm } else { Some(1.0) }
    }
}

/// The exception for a key that no parameter has.
pub fn unknown(py: Python<'_>, key: &str) -> PyErr {
    let known: Vec<_> = PARAMETERS.iter().map(|parameter| parameter.key).collect();
    let expected = match nearest(key, &known) {
        Some(near) => format!("a parameter; did you mean {near}?"),
        None => "a parameter, of those in help(squama.Skin)".to_owned(),
    };
    error::invalid_parameter(py, key, None, &expected)
}

/// The sweep of one skin with these parameters; those that are `None` are left at their defaults.
fn sweep_of(given: &Bound<'_, PyDict>) -> PyResult<Sweep> {
    let py = given.py();
    let mut sections: KeyValues = Vec::new();
    for (name, of) in given.iter().filter(|(_, of)| !of.is_none()) {
        let name = text(&name)?;
        let Some(Named { parameter, in_mm }) = Named::of(&name) else {
            return Err(unknown(py, &name));
        };
        let of = if in_mm { over_t(given, &name, &of)? } else { of };
        let entry = KeyValue { key: parameter.key.to_owned(), value: value(&of)?, place: place() };
        // Geometry stands among the axes of a definition, each with one value.
        match sections.iter_mut().find(|section| section.key == parameter.section) {
            Some(KeyValue { value: Value::Table(entries), .. }) => entries.push(entry),
            _ => sections.push(section(parameter.section, vec![entry])),
        }
    }
    for parameter in Parameter::with(Role::Geometry) {
        let has = |section: &KeyValue| matches!(&section.value, Value::Table(entries) if entries.iter().any(|e| e.key == parameter.key));
        if !sections.iter().any(has) {
            return Err(error::invalid_parameter(py, parameter.key, None, &parameter.expected()));
        }
    }
    sections.push(KeyValue { key: "name".into(), value: Value::Text(NAME.into()), place: place() });
    let sweep = Sweep::of_entries(&sections, "squama.Skin");
    let sweep = sweep.map_err(|error| error::invalid_definition(py, &error, Some(given)))?;
    match sweep.grid().len() {
        1 => Ok(sweep),
        _ => Err(several(py, &sweep)),
    }
}

fn section(name: &str, entries: KeyValues) -> KeyValue {
    KeyValue { key: name.to_owned(), value: Value::Table(entries), place: place() }
}

/// The exception for a list where one value is wanted.
fn several(py: Python<'_>, sweep: &Sweep) -> PyErr {
    let axis = sweep.grid().axes().iter().find(|axis| axis.len() > 1);
    let (key, expected) = axis
        .map_or(("", String::new()), |axis| (axis.parameter().key, axis.parameter().expected()));
    error::invalid_parameter(py, key, None, &format!("one value, {expected}"))
}

/// A length in mm over the thickness, which has to be given.
fn over_t<'py>(
    given: &Bound<'py, PyDict>,
    name: &str,
    length: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = given.py();
    let thickness = given.get_item(key::THICKNESS)?.and_then(|of| of.extract::<f64>().ok());
    let (Ok(length), Some(thickness)) = (length.extract::<f64>(), thickness) else {
        let expected = format!("a number, together with {}", key::THICKNESS);
        return Err(error::invalid_parameter(py, name, Some(length.clone()), &expected));
    };
    Ok((length / thickness).into_pyobject(py)?.into_any())
}

/// A value as Python has it.
fn python(py: Python<'_>, scalar: Scalar) -> PyResult<Bound<'_, PyAny>> {
    Ok(match scalar {
        Scalar::Number(number) => number.into_pyobject(py)?.into_any(),
        Scalar::Count(count) => count.into_pyobject(py)?.into_any(),
        Scalar::Word(word) => word.into_pyobject(py)?.into_any(),
        Scalar::List(list) => PyTuple::new(py, list.as_slice())?.into_any(),
    })
}

/// The measures of that name, or of a list of names; "all" are those that need no derivatives.
pub fn measures(of: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Measure>> {
    let Some(of) = of.filter(|of| !of.is_none()) else { return Ok(Measure::USUAL.to_vec()) };
    let names: Vec<String> =
        of.extract::<String>().map(|name| vec![name]).or_else(|_| of.extract())?;
    let mut measures = Vec::new();
    for name in names {
        let known = Measure::ALL.into_iter().find(|measure| measure.key() == name);
        match known {
            Some(measure) => measures.push(measure),
            None if name == "all" => measures.extend(Measure::USUAL),
            None => {
                let expected =
                    "all, coverage, puncture, flexure or sensitivity, or a list of these";
                return Err(error::invalid_parameter(
                    of.py(),
                    "measures",
                    Some(of.clone()),
                    expected,
                ));
            }
        }
    }
    measures.sort();
    measures.dedup();
    Ok(measures)
}

/// The evaluator of such measures, which keeps the springs that it has found.
pub fn evaluator(measures: &[Measure]) -> Arc<Evaluator> {
    static KNOWN: Mutex<Vec<(Vec<Measure>, Arc<Evaluator>)>> = Mutex::new(Vec::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, evaluator)) = known.iter().find(|(of, _)| of == measures) {
        return Arc::clone(evaluator);
    }
    let evaluator = Arc::new(Evaluator::new(measures));
    known.push((measures.to_vec(), Arc::clone(&evaluator)));
    evaluator
}

impl Skin {
    /// The skins of a sweep.
    fn new(sweep: &Sweep, index: u64) -> Self {
        let case = sweep.grid().case(index);
        Self { sweep: sweep.only(index), case }
    }

    /// Whether it is solved in some milliseconds. Everything else is watched from outside, which costs a thread.
    fn is_quick(&self) -> bool {
        let Case { imperfection, coupling, flexure, common, .. } = &self.case;
        imperfection.is_none()
            && *coupling == Coupling::Nearest
            && flexure.method == Method::UnitCell
            && common.solver == Case::default().common.solver
    }

    /// The parameters that are not at their defaults, and the geometry.
    fn given(&self) -> impl Iterator<Item = (&'static Parameter, Scalar)> {
        let is_given = |p: &Parameter| p.has(Role::Geometry) || p.get(&self.case) != p.default();
        let axes = self.sweep.grid().axes().iter();
        let axes = axes.map(|axis| (axis.parameter(), axis.value(0)));
        axes.chain(self.sweep.shared()).filter(move |(parameter, _)| is_given(parameter))
    }

    /// The sweep that a text in TOML, or the file of that name, defines.
    pub(crate) fn definition(
        py: Python<'_>,
        definition: &Bound<'_, PyAny>,
        settings: &[sweep::Setting],
    ) -> PyResult<Sweep> {
        if let Ok(skin) = definition.cast::<Self>() {
            return Self::parsed(py, &skin.get().sweep.to_toml(), settings);
        }
        let text = text(definition)?;
        // Every definition has a name, and no path has an equals sign in a line of several.
        if text.contains('\n') || text.trim_start().starts_with("name") && text.contains('=') {
            return Self::parsed(py, &text, settings);
        }
        Sweep::read(Path::new(&text), settings).map_err(|e| error::invalid_definition(py, &e, None))
    }

    fn parsed(py: Python<'_>, text: &str, settings: &[sweep::Setting]) -> PyResult<Sweep> {
        Sweep::parse(text, "definition", settings)
            .map_err(|e| error::invalid_definition(py, &e, None))
    }
}

#[pymethods]
impl Skin {
    #[new]
    #[pyo3(signature = (**parameters))]
    fn of(py: Python<'_>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let empty = PyDict::new(py);
        Ok(Self::new(&sweep_of(parameters.unwrap_or(&empty))?, 0))
    }

    /// The skin of a definition: a text in TOML, or the path of a file. Of several designs `design` is the number, from 1.
    #[staticmethod]
    #[pyo3(signature = (definition, design=None))]
    fn from_toml(
        py: Python<'_>,
        definition: &Bound<'_, PyAny>,
        design: Option<u64>,
    ) -> PyResult<Self> {
        let sweep = Self::definition(py, definition, &[])?;
        let count = sweep.grid().len();
        match design {
            None if count == 1 => Ok(Self::new(&sweep, 0)),
            Some(number) if (1..=count).contains(&number) => Ok(Self::new(&sweep, number - 1)),
            number => {
                let number = number.map(|number| number.into_pyobject(py)).transpose()?;
                let number = number.map(Bound::into_any);
                let expected = format!("the number of one of its {count} designs");
                Err(error::invalid_parameter(py, "design", number, &expected))
            }
        }
    }

    /// All skins of a definition, in the order of their numbers: a text in TOML, or the path of a file.
    #[staticmethod]
    fn all_from_toml(py: Python<'_>, definition: &Bound<'_, PyAny>) -> PyResult<Vec<Self>> {
        let sweep = Self::definition(py, definition, &[])?;
        Ok((0..sweep.grid().len()).map(|index| Self::new(&sweep, index)).collect())
    }

    /// The skin as a complete definition, which `squama run` and `Skin.from_toml` read.
    fn to_toml(&self) -> String {
        self.sweep.to_toml()
    }

    /// The parameters that are not at their defaults, and the geometry.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (parameter, scalar) in self.given() {
            all.set_item(parameter.key, python(py, scalar)?)?;
        }
        Ok(all)
    }

    /// A skin with other values of some parameters; `None` is the default.
    #[pyo3(signature = (**parameters))]
    fn replace(&self, py: Python<'_>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let all = self.parameters(py)?;
        for (name, of) in parameters.into_iter().flatten() {
            // A length in mm takes the place of the same length over t.
            if let Some(Named { parameter, in_mm: true }) = Named::of(&text(&name)?)
                && all.contains(parameter.key)?
            {
                all.del_item(parameter.key)?;
            }
            all.set_item(name, of)?;
        }
        Ok(Self::new(&sweep_of(&all)?, 0))
    }

    fn __getattr__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let no_such = || PyAttributeError::new_err(format!("a Skin has no {name}"));
        let named = Named::of(name).ok_or_else(no_such)?;
        if !named.parameter.is_given(&self.case) {
            return Ok(py.None().into_bound(py));
        }
        match named.parameter.get(&self.case) {
            Scalar::Number(number) if named.in_mm => {
                let unit = named.unit(&self.case).ok_or_else(no_such)?;
                Ok((number * unit).into_pyobject(py)?.into_any())
            }
            scalar => python(py, scalar),
        }
    }

    /// Solves the skin.
    #[pyo3(signature = (measures=None))]
    fn solve<'py>(
        slf: &Bound<'py, Self>,
        measures: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        static RESULT: PyOnceLock<Py<PyType>> = PyOnceLock::new();
        let (py, skin) = (slf.py(), slf.get());
        let evaluator = evaluator(&self::measures(measures)?);
        let (number, case) = (skin.sweep.grid().number(0), skin.case);
        let solved = if skin.is_quick() {
            py.detach(|| evaluator.solve(number, &case))
        } else {
            watched(py, None, move |_| evaluator.solve(number, &case))?
        };
        let solved = Solved::new(slf.clone().unbind(), solved);
        error::class(py, &RESULT, "squama._result", "Result")?.call1((slf, solved))
    }

    /// Values of measures, and of each the derivatives by parameters: where they decrease, where they increase, what changes.
    fn _gradients<'py>(
        slf: &Bound<'py, Self>,
        measures: Vec<String>,
        keys: Vec<String>,
    ) -> PyResult<Bound<'py, PyList>> {
        gradient::gradients(slf, &measures, &keys)
    }

    fn _repr_svg_(&self, py: Python<'_>) -> PyResult<String> {
        let case = self.case;
        py.detach(|| drawing(&case)).map_err(|reason| error::failed(py, "drawing", &reason))
    }

    fn __repr__(&self) -> String {
        let mut text = String::new();
        for (parameter, scalar) in self.given() {
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "{}{}={}",
                if text.is_empty() { "" } else { ", " },
                parameter.key,
                scalar.to_toml()
            );
        }
        format!("Skin({text})")
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().case == self.case)
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        for parameter in PARAMETERS {
            parameter.get(&self.case).to_string().hash(&mut hasher);
        }
        hasher.finish()
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyDict>,))> {
        Ok((py.import("squama")?.getattr("_skin")?, (self.parameters(py)?,)))
    }
}

/// The row at rest and, if the path gets there, at the critical tilt.
fn drawing(case: &Case) -> Result<String, String> {
    let footprint = case.footprint().map_err(|error| error.to_string())?;
    let substrate =
        RowStiffness::of(&footprint, case.coupling).map_err(|error| error.to_string())?;
    let at = [At::Tilt(case.puncture.critical_tilt_deg)];
    let solved = snapshots(&case.design, &substrate, &case.common, &case.puncture, &at);
    let states: Vec<_> =
        solved.map_err(|error| error.to_string())?.at.into_iter().flatten().collect();
    let drawing = PunctureDrawing {
        name: NAME,
        design: &case.design,
        load_position: case.puncture.load_position,
        thickness_mm: case.material.thickness_mm,
        states: &states,
    };
    drawing.svg().map_err(|error| error.to_string())
}

//! The dependence of the main results on the choices that the paper leaves open.

use ranking::{Ranking, TetrahedralGrid, Weights};
use sweep::{Axis, Setting, Sweep};

use crate::ValidationError;
use crate::claims::{DesignValue, digits, named};
use crate::study::{Study, is_geometry};

/// Sweeps over one open choice each: the files of `sweeps/sensitivity/`.
const SWEEPS: [(&str, &str); 10] = [
    ("base", include_str!("../../../sweeps/sensitivity/base.toml")),
    ("width", include_str!("../../../sweeps/sensitivity/width.toml")),
    ("row-length", include_str!("../../../sweeps/sensitivity/row-length.toml")),
    (COUPLING, include_str!("../../../sweeps/sensitivity/coupling.toml")),
    ("contact-law", include_str!("../../../sweeps/sensitivity/contact-law.toml")),
    (
        "contact-modulus-puncture",
        include_str!("../../../sweeps/sensitivity/contact-modulus-puncture.toml"),
    ),
    (
        "contact-modulus-flexure",
        include_str!("../../../sweeps/sensitivity/contact-modulus-flexure.toml"),
    ),
    ("membrane-thickness", include_str!("../../../sweeps/sensitivity/membrane-thickness.toml")),
    ("strip-length", include_str!("../../../sweeps/sensitivity/strip-length.toml")),
    ("end-rotation", include_str!("../../../sweeps/sensitivity/end-rotation.toml")),
];

/// The sweep over the coupling of the substrate.
const COUPLING: &str = "coupling";

/// The main results with one setting of an open choice.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The name of the sweep.
    pub sweep: &'static str,
    /// The setting, as `key = value`.
    pub setting: String,
    /// The results.
    pub headlines: Headlines,
}

/// The results that a reader remembers, as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Headlines {
    /// `F_c*` at the paper's best design.
    pub force: String,
    /// The best design with equal weights.
    pub balanced: String,
    /// The best designs by coverage, critical force, penetration resistance and compliance alone.
    pub corners: [String; 4],
}

/// The change of a measure, design by design, when the whole substrate is coupled.
#[derive(Clone, Debug, PartialEq)]
pub struct CouplingEffect {
    /// The measure.
    pub measure: &'static str,
    /// The number of designs that have the measure with either coupling.
    pub designs: usize,
    /// The number of designs that lack the measure with full coupling alone.
    pub lost: usize,
    /// The smallest, the median and the largest relative change.
    pub changes: [f64; 3],
}

/// One setting of a sweep over open choices.
pub(crate) struct OpenSetting {
    sweep: &'static str,
    label: String,
    definition: Sweep,
}

/// Returns every setting of every sweep, as a sweep of its own over the geometry.
///
/// # Errors
/// If a definition is not valid.
pub(crate) fn settings() -> Result<Vec<OpenSetting>, ValidationError> {
    let mut all = Vec::new();
    for (name, text) in SWEEPS {
        let whole = Sweep::parse(text, name, &[])?;
        let open: Vec<&Axis> =
            whole.grid().axes().iter().filter(|axis| !is_geometry(axis.parameter())).collect();
        for values in combinations(&open) {
            let label: Vec<_> =
                values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            let fixed = values.iter().map(|(key, value)| {
                Setting::parse(&format!("designs.{key}=[{}]", value.to_toml()))
            });
            let fixed: Vec<_> = fixed.collect::<Result<_, _>>()?;
            let definition = Sweep::parse(text, name, &fixed)?;
            all.push(OpenSetting { sweep: name, label: label.join(", "), definition });
        }
    }
    Ok(all)
}

/// The value of each open parameter, by its key.
type OpenValues = Vec<(&'static str, sweep::Scalar)>;

/// Returns every combination of the values of the axes, the last axis fastest.
fn combinations(axes: &[&Axis]) -> Vec<OpenValues> {
    axes.iter().fold(vec![Vec::new()], |known, axis| {
        let longer = known.iter().flat_map(|values: &OpenValues| {
            (0..axis.len()).map(|index| {
                let mut longer = values.clone();
                longer.push((axis.parameter().key, axis.value(index)));
                longer
            })
        });
        longer.collect()
    })
}

/// Compares the main results of all settings, and the measures of both couplings of the substrate.
///
/// Settings that are part of the studies `known` are not solved again. `begin` is called with the name of each setting.
///
/// # Errors
/// If the temporary folder cannot be written.
pub(crate) fn sensitivity(
    settings: Vec<OpenSetting>,
    known: &[Study],
    mut begin: impl FnMut(&str),
) -> Result<(Vec<Sensitivity>, Vec<CouplingEffect>), ValidationError> {
    let (mut all, mut couplings) = (Vec::new(), Vec::new());
    for OpenSetting { sweep, label, definition } in settings {
        begin(&label);
        // The default setting is a part of the sweeps of the paper, and need not be solved again.
        let part = known.iter().find_map(|study| study.part(&definition));
        let study = part.map_or_else(|| Study::run(definition), Ok)?;
        all.push(Sensitivity { sweep, setting: label, headlines: Headlines::of(&study) });
        if sweep == COUPLING {
            couplings.push(study);
        }
    }
    let effects = match couplings.as_slice() {
        [nearest, full] => CouplingEffect::of(nearest, full),
        _ => Vec::new(),
    };
    Ok((all, effects))
}

impl CouplingEffect {
    fn of(nearest: &Study, full: &Study) -> Vec<Self> {
        let measures: [(&str, DesignValue); 4] = [
            ("coverage", |design| design.coverage.filter(|coverage| *coverage > 0.0)),
            ("critical force", |design| design.critical_force),
            ("penetration", |design| design.penetration),
            ("compliance", |design| design.compliance),
        ];
        let effect = |(measure, value): (&'static str, DesignValue)| {
            let pairs = nearest.designs.iter().zip(&full.designs);
            let pairs: Vec<_> = pairs.map(|(a, b)| (value(a), value(b))).collect();
            let change = |pair: &(Option<f64>, Option<f64>)| Some(pair.1? / pair.0? - 1.0);
            let mut changes: Vec<f64> = pairs.iter().filter_map(change).collect();
            changes.sort_by(f64::total_cmp);
            let lost = pairs.iter().filter(|(a, b)| a.is_some() && b.is_none()).count();
            let designs = changes.len();
            let at = |place: usize| changes.get(place).copied().unwrap_or(f64::NAN);
            let changes = [at(0), at(designs / 2), at(designs.saturating_sub(1))];
            Self { measure, designs, lost, changes }
        };
        measures.into_iter().map(effect).collect()
    }
}

impl Headlines {
    /// Returns the main results of a study.
    pub(crate) fn of(study: &Study) -> Self {
        let nothing = || "none".to_owned();
        let best = study.design(0.1, 0.1, 75.0);
        let force = best.and_then(|design| design.critical_force).map_or_else(nothing, digits);
        let Ok(ranking) = Ranking::new(&study.results, TetrahedralGrid::default()) else {
            return Self {
                force,
                balanced: nothing(),
                corners: std::array::from_fn(|_| nothing()),
            };
        };
        let winner = |weights| named(&study.designs[ranking.winner(weights).row()]);
        let mut alone = Weights::alone().map(winner);
        Self {
            force,
            balanced: winner(Weights::BALANCED),
            corners: std::array::from_fn(|_| alone.next().unwrap_or_default()),
        }
    }
}

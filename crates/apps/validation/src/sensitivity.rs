//! The dependence of the main results on the choices that the paper leaves open.

use ranking::{Ranking, TetrahedralGrid, Weights};
use results::columns::name;
use sweep::{Axis, Setting, Sweep};

use crate::claims::{self, CheckedClaim, DesignValue, digits, named};
use crate::study::{Study, is_geometry};

/// Name and definition of sweeps over one open choice each, from `sweeps/sensitivity/`.
const SWEEPS: [(&str, &str); 11] = [
    ("base", include_str!("../sensitivity/base.toml")),
    ("width", include_str!("../sensitivity/width.toml")),
    ("row-length", include_str!("../sensitivity/row-length.toml")),
    (COUPLING, include_str!("../sensitivity/coupling.toml")),
    (FRICTION, include_str!("../sensitivity/friction.toml")),
    ("contact-law", include_str!("../sensitivity/contact-law.toml")),
    ("contact-modulus-puncture", include_str!("../sensitivity/contact-modulus-puncture.toml")),
    ("contact-modulus-flexure", include_str!("../sensitivity/contact-modulus-flexure.toml")),
    ("membrane-thickness", include_str!("../sensitivity/membrane-thickness.toml")),
    ("strip-length", include_str!("../sensitivity/strip-length.toml")),
    ("end-rotation", include_str!("../sensitivity/end-rotation.toml")),
];

/// The sweep over the substrate coupling, compared design by design.
const COUPLING: &str = "coupling";
/// The sweep over the friction between scales, compared design by design.
const FRICTION: &str = "friction";

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

/// The main results of a study, as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Headlines {
    /// `F_c*` of the paper's strongest design, (0.1, 0.1, 75°).
    pub force: String,
    /// The best design with equal weights.
    pub balanced: String,
    /// The best design by each criterion alone.
    ///
    /// The criteria are coverage, critical force, penetration resistance and compliance.
    pub corners: [String; 4],
}

/// The change of a measure from the first setting of a choice to another setting, for all designs.
#[derive(Clone, Debug, PartialEq)]
pub struct ChoiceEffect {
    /// The other setting, as `key = value`.
    pub setting: String,
    /// The measure.
    pub measure: &'static str,
    /// The number of designs with the measure in both settings.
    pub designs: usize,
    /// The number of designs that have the measure only in the first setting.
    pub lost: usize,
    /// The smallest, median and largest relative change.
    pub changes: [f64; 3],
    /// Rank correlation (Spearman) of the designs between both settings.
    pub ranks: Option<f64>,
}

/// The effects of the choices that are compared design by design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChoiceEffects {
    /// Effects of full substrate coupling.
    pub coupling: Vec<ChoiceEffect>,
    /// Effects of friction between scales.
    pub friction: Vec<ChoiceEffect>,
}

/// One setting of a sweep over open choices.
pub(crate) struct OpenSetting {
    sweep: &'static str,
    label: String,
    definition: Sweep,
}

/// Returns every setting of every sweep as a separate sweep over the geometry.
///
/// # Errors
/// If a definition is invalid.
pub(crate) fn settings() -> anyhow::Result<Vec<OpenSetting>> {
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

/// The key and value of each open parameter.
type OpenValues = Vec<(&'static str, sweep::Scalar)>;

/// Returns all combinations of the axis values; the last axis varies fastest.
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

/// The checked claims for each coefficient of friction between scales.
type ClaimsByFriction = Vec<Vec<CheckedClaim>>;

/// Compares the main results for all settings of the open choices.
///
/// For substrate coupling and friction, it also compares the measures design by design. For each
/// friction, it checks the claims. Settings that the `known` studies contain are not solved again.
/// `begin` is called with the name of each setting.
///
/// # Errors
/// If the temporary folder cannot be written.
pub(crate) fn sensitivity(
    settings: Vec<OpenSetting>,
    known: &[Study],
    mut begin: impl FnMut(&str),
) -> anyhow::Result<(Vec<Sensitivity>, ChoiceEffects, ClaimsByFriction)> {
    let (mut all, mut couplings, mut frictions) = (Vec::new(), Vec::new(), Vec::new());
    for OpenSetting { sweep, label, definition } in settings {
        begin(&label);
        // The default setting of each choice is part of the paper sweeps.
        let part = known.iter().find_map(|study| study.part(&definition));
        let study = part.map_or_else(|| Study::run(definition), Ok)?;
        let setting = label.clone();
        all.push(Sensitivity { sweep, setting, headlines: Headlines::of(&study) });
        match sweep {
            COUPLING => couplings.push((label, study)),
            FRICTION => frictions.push((label, study)),
            _ => {}
        }
    }
    // The first setting has no friction, so its claims have already been checked.
    let with_friction = frictions.iter().skip(1).map(|(_, study)| claims::check([study; 2]));
    let with_friction = with_friction.collect::<Result<_, _>>()?;
    let [coupling, friction] = [couplings, frictions].map(|studies| {
        let others = studies.iter().skip(1);
        others.flat_map(|other| ChoiceEffect::of(&studies[0].1, other)).collect()
    });
    Ok((all, ChoiceEffects { coupling, friction }, with_friction))
}

impl ChoiceEffect {
    fn of(first: &Study, (setting, other): &(String, Study)) -> Vec<Self> {
        let measures: [(&str, DesignValue); 4] = [
            // A coverage of 0 has no relative change.
            (name::COVERAGE, |design| design.coverage.filter(|coverage| *coverage > 0.0)),
            ("critical force", |design| design.critical_force),
            (name::PENETRATION, |design| design.penetration),
            (name::COMPLIANCE, |design| design.compliance),
        ];
        measures
            .into_iter()
            .map(|(measure, value)| {
                // All settings of a sweep have the same designs in the same order.
                let pairs = first.designs.iter().zip(&other.designs);
                let pairs: Vec<_> = pairs.map(|(a, b)| (value(a), value(b))).collect();
                let mut changes: Vec<f64> =
                    pairs.iter().filter_map(|pair| Some(pair.1? / pair.0? - 1.0)).collect();
                changes.sort_by(f64::total_cmp);
                // Count only losses and not gains: the page reports failures that a choice causes.
                let lost = pairs.iter().filter(|(a, b)| a.is_some() && b.is_none()).count();
                let designs = changes.len();
                let changes = [0, designs / 2, designs.saturating_sub(1)]
                    .map(|index| changes.get(index).copied().unwrap_or(f64::NAN));
                let both: Vec<_> =
                    pairs.iter().filter_map(|pair| Some([pair.0?, pair.1?])).collect();
                let (setting, ranks) = (setting.clone(), ranking::rank_correlation(&both));
                Self { setting, measure, designs, lost, changes, ranks }
            })
            .collect()
    }
}

impl Headlines {
    /// Returns the main results of a study.
    pub(crate) fn of(study: &Study) -> Self {
        let best = study.design(0.1, 0.1, 75.0);
        let force = best.and_then(|design| design.critical_force);
        // A study that cannot be ranked has `none` instead of its best designs.
        let ranking = Ranking::new(&study.results, TetrahedralGrid::default()).ok();
        let weights = std::iter::once(Weights::BALANCED).chain(Weights::alone());
        let mut winners = weights.map(|weights| {
            let winner = ranking.as_ref().map(|ranking| ranking.winner(weights).row());
            winner.map_or_else(|| "none".to_owned(), |row| named(&study.designs[row]))
        });
        Self {
            force: force.map_or_else(|| "none".to_owned(), digits),
            balanced: winners.next().unwrap_or_default(),
            corners: std::array::from_fn(|_| winners.next().unwrap_or_default()),
        }
    }
}

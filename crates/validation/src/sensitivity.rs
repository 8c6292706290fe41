//! How far the headline results depend on what the paper leaves open.

use ranking::{Ranking, TetrahedralGrid, Weights};
use sweep::Sweep;

use crate::Error;
use crate::claims::{Value, digits, named};
use crate::study::Study;

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

/// What comes out with one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The sweep.
    pub sweep: &'static str,
    /// The setting.
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
    /// The best by coverage, critical force, penetration resistance and compliance alone.
    pub corners: [String; 4],
}

/// How much a measure changes, design by design, when the whole substrate is coupled.
#[derive(Clone, Debug, PartialEq)]
pub struct CouplingEffect {
    /// The measure.
    pub measure: &'static str,
    /// Designs that have it with either coupling.
    pub designs: usize,
    /// Designs that lack it with full coupling.
    pub lost: usize,
    /// Relative changes: the smallest, the median, and the largest.
    pub changes: [f64; 3],
}

/// Solves every sweep: what becomes of the headline results, and what full coupling does.
///
/// # Errors
/// If the temporary folder does not take the tables.
pub fn sensitivity() -> Result<(Vec<Sensitivity>, Vec<CouplingEffect>), Error> {
    let (mut all, mut effects) = (Vec::new(), Vec::new());
    for (name, text) in SWEEPS {
        let settings = Study::run(Sweep::parse(text, name, &[])?)?.settings();
        if let (COUPLING, [(_, nearest), (_, full)]) = (name, settings.as_slice()) {
            effects = CouplingEffect::of(nearest, full);
        }
        all.extend(settings.into_iter().map(|(setting, study)| {
            let headlines = Headlines::of(&study);
            Sensitivity { sweep: name, setting, headlines }
        }));
    }
    Ok((all, effects))
}

impl CouplingEffect {
    fn of(nearest: &Study, full: &Study) -> Vec<Self> {
        let measures: [(&str, Value); 4] = [
            ("coverage", |design| design.coverage.filter(|coverage| *coverage > 0.0)),
            ("critical force", |design| design.critical_force),
            ("penetration", |design| design.penetration),
            ("compliance", |design| design.compliance),
        ];
        let effect = |(measure, value): (&'static str, Value)| {
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

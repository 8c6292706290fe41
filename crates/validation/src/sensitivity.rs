//! How far the headline results depend on what the paper leaves open.

use sweep::{Ranking, Sweep, TetrahedralGrid, Weights};

use crate::Error;
use crate::claims::{digits, named};
use crate::study::Study;

/// Sweeps over one open choice each: the files of `sweeps/sensitivity/`.
const SWEEPS: [(&str, &str); 9] = [
    ("base", include_str!("../../../sweeps/sensitivity/base.toml")),
    ("width", include_str!("../../../sweeps/sensitivity/width.toml")),
    ("row-length", include_str!("../../../sweeps/sensitivity/row-length.toml")),
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

/// Solves every sweep.
///
/// # Errors
/// If the temporary folder does not take the tables.
pub fn sensitivity() -> Result<Vec<Sensitivity>, Error> {
    let mut all = Vec::new();
    for (name, text) in SWEEPS {
        let study = Study::run(Sweep::parse(text, name, &[])?)?;
        all.extend(study.settings().into_iter().map(|(setting, study)| {
            let headlines = Headlines::of(&study);
            Sensitivity { sweep: name, setting, headlines }
        }));
    }
    Ok(all)
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

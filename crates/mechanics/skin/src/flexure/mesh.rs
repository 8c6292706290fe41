//! Discretisation of the membrane in a gap.

use geometry::OutOfRange;
use membrane::{Elastica, GapMembrane, Membrane, Section, Span};

use crate::PathDetail;

/// Selects the discretisation of the membrane between two scales.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MembraneMesh {
    /// A spectral element for the extensible elastica, refined automatically.
    ///
    /// Its order increases until a further increase changes the measures by at most 1e-4.
    #[default]
    Auto,
    /// The given number of co-rotational beam elements of equal length.
    Elements(usize),
}

/// Discretisation of a membrane with its resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Resolution {
    /// The given number of co-rotational elements.
    Elements(usize),
    /// A spectral element of the given order for the elastica.
    Order(usize),
}

impl Resolution {
    pub(crate) fn membrane(self, section: Section, span: Span) -> Result<Membrane, OutOfRange> {
        Ok(match self {
            Self::Elements(count) => Membrane::Elements(GapMembrane::new(section, span, count)?),
            Self::Order(order) => Membrane::Elastica(Elastica::new(section, span, order)?),
        })
    }

    /// Returns the next finer resolution if the `error` is too large.
    ///
    /// `error` is the largest relative change of any measure between this resolution and the next
    /// finer one. Returns `None` if the error is acceptable or unknown, or if the order is already
    /// the largest.
    pub(crate) fn better(self, error: Option<f64>) -> Option<Self> {
        let tolerance = match self {
            Self::Order(order) if order < FIRST_ORDER => EARLY_TOLERANCE,
            _ => TOLERANCE,
        };
        let suffices = error.is_none_or(|error| error <= tolerance);
        self.finer().filter(|finer| {
            !suffices && !matches!(finer, Self::Order(order) if *order > LAST_ORDER)
        })
    }

    /// Returns true for a spectral element of lower order than `other`.
    pub(crate) fn is_coarser_than(self, other: Self) -> bool {
        matches!((self, other), (Self::Order(own), Self::Order(other)) if own < other)
    }

    /// Returns the next finer resolution; `None` for co-rotational elements.
    pub(crate) fn finer(self) -> Option<Self> {
        match self {
            Self::Elements(_) => None,
            Self::Order(order) if order < FIRST_ORDER => Some(Self::Order(FIRST_ORDER)),
            Self::Order(order) => Some(Self::Order(order + ORDER_STEP)),
        }
    }
}

/// Largest relative change of a measure by refinement at which the coarser resolution suffices.
const TOLERANCE: f64 = 1e-4;

/// Initial order of the spectral element for [`MembraneMesh::Auto`].
///
/// It resolves boundary layers with a thickness of a hundredth of the gap. For nearly all designs
/// of the reference study its error is below 1e-4.
const FIRST_ORDER: usize = 12;

/// Increment of the order of the spectral element.
const ORDER_STEP: usize = 6;

/// Largest order of the spectral element.
///
/// Only boundary layers thinner than a thousandth of the gap need a larger order, and beam theory
/// is not valid for these.
const LAST_ORDER: usize = 48;

/// Initial order for the stiffest state of an imperfect strip.
///
/// Its forces are much smaller than at the end of bending, so the boundary layers are wide.
const EARLY_ORDER: usize = 8;

/// Largest relative change of a measure by refinement at which [`EARLY_ORDER`] suffices.
///
/// Tables then hardly differ from tables with [`FIRST_ORDER`].
const EARLY_TOLERANCE: f64 = 1e-7;

impl MembraneMesh {
    /// Returns the initial resolution.
    ///
    /// Up to [`PathDetail::Critical`], only the stiffest state has to be resolved.
    pub(crate) fn coarsest(self, detail: PathDetail) -> Resolution {
        match self {
            Self::Auto if detail <= PathDetail::Critical => Resolution::Order(EARLY_ORDER),
            Self::Auto => Resolution::Order(FIRST_ORDER),
            Self::Elements(count) => Resolution::Elements(count),
        }
    }
}

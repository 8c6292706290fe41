//! Discretisation of the membrane of a gap.

use geometry::OutOfRange;
use membrane::{Elastica, GapMembrane, Membrane, Section, Span};

/// Resolution of the membrane between two scales.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MembraneMesh {
    /// As fine as the measures need, by a spectral element for the extensible elastica.
    ///
    /// Its order increases until the measures change by less than 1e-4.
    #[default]
    Auto,
    /// This many co-rotational beam elements of equal length.
    Elements(usize),
}

/// Resolution of a membrane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Resolution {
    /// This many co-rotational elements.
    Elements(usize),
    /// Spectral element of this order for the elastica.
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
    /// `error` is the largest relative change of any measure with that resolution. `None` also
    /// beyond the largest useful order.
    pub(crate) fn better(self, error: Option<f64>) -> Option<Self> {
        let suffices = error.is_none_or(|error| error <= TOLERANCE);
        self.finer().filter(|finer| {
            !suffices && !matches!(finer, Self::Order(order) if *order > LAST_ORDER)
        })
    }

    /// Returns the next finer order; `None` for elements.
    pub(crate) fn finer(self) -> Option<Self> {
        match self {
            Self::Elements(_) => None,
            Self::Order(order) => Some(Self::Order(order + ORDER_STEP)),
        }
    }
}

/// Largest relative change of any measure at which the coarser resolution suffices.
const TOLERANCE: f64 = 1e-4;

/// Initial order of [`MembraneMesh::Auto`].
///
/// It resolves boundary layers at the bases of a hundredth of the gap, and is within 1e-4 for
/// nearly all designs of the reference study.
const FIRST_ORDER: usize = 12;

/// Increment of the order.
const ORDER_STEP: usize = 6;

/// Largest order.
///
/// Beyond it, boundary layers are thinner than a thousandth of the gap and beam theory does not
/// apply.
const LAST_ORDER: usize = 48;

impl MembraneMesh {
    /// Returns the initial resolution.
    pub(crate) fn coarsest(self) -> Resolution {
        match self {
            Self::Auto => Resolution::Order(FIRST_ORDER),
            Self::Elements(count) => Resolution::Elements(count),
        }
    }
}

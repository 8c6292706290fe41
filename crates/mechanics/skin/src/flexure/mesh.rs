//! How the membrane of a gap is resolved.

use geometry::OutOfRange;
use membrane::{Elastica, GapMembrane, Membrane, Section, Span};

/// How finely the membrane between two scales is resolved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MembraneMesh {
    /// As finely as the measures need: the extensible elastica, by a spectral element whose order is raised until they
    /// change by less than a ten-thousandth.
    #[default]
    Auto,
    /// So many co-rotational beam elements of equal length.
    Elements(usize),
}

/// A resolution of the membrane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Resolution {
    /// Co-rotational elements, so many.
    Elements(usize),
    /// A spectral element of this order for the elastica.
    Order(usize),
}

impl Resolution {
    pub(crate) fn membrane(self, section: Section, span: Span) -> Result<Membrane, OutOfRange> {
        Ok(match self {
            Self::Elements(count) => Membrane::Elements(GapMembrane::new(section, span, count)?),
            Self::Order(order) => Membrane::Elastica(Elastica::new(section, span, order)?),
        })
    }

    /// The next finer one, if the largest relative change of any measure with it, the `error`, is too large, and none is used that is finer
    /// than a membrane can need.
    pub(crate) fn better(self, error: Option<f64>) -> Option<Self> {
        let suffices = error.is_none_or(|error| error <= TOLERANCE);
        let is_usual = |finer: &Self| !matches!(finer, Self::Order(order) if *order > LAST_ORDER);
        self.finer().filter(|finer| !suffices && is_usual(finer))
    }

    /// The next finer order; `None` for elements.
    pub(crate) fn finer(self) -> Option<Self> {
        match self {
            Self::Elements(_) => None,
            Self::Order(order) => Some(Self::Order(order + ORDER_STEP)),
        }
    }
}

/// Largest relative change of any measure between two resolutions at which the coarser one suffices.
const TOLERANCE: f64 = 1e-4;

/// Order with which [`MembraneMesh::Auto`] begins. It resolves layers at the bases of a hundredth of the gap, and is within 1e-4 for
/// nearly all designs of the reference study.
const FIRST_ORDER: usize = 12;

/// By how much the order is raised.
const ORDER_STEP: usize = 6;

/// Largest order. Beyond, layers are thinner than a thousandth of the gap, and the membrane is no beam.
const LAST_ORDER: usize = 48;

impl MembraneMesh {
    /// The resolution to begin with.
    pub(crate) fn coarsest(self) -> Resolution {
        match self {
            Self::Auto => Resolution::Order(FIRST_ORDER),
            Self::Elements(count) => Resolution::Elements(count),
        }
    }
}

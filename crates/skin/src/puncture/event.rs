//! Events of the path of a puncture: of contacts, and of the surface of the substrate.

use super::{Fold, Puncture, PuncturePoint};
use crate::record::ContactEvent;

/// An event of the path of a puncture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctureEvent {
    /// A contact changes its state.
    Contact(ContactEvent<PuncturePoint>),
    /// The surface folds over in a gap, or unfolds.
    Fold(Fold),
}

impl PunctureEvent {
    /// The point of the path at which it happens.
    pub fn point(&self) -> &PuncturePoint {
        match self {
            Self::Contact(event) => &event.point,
            Self::Fold(fold) => &fold.point,
        }
    }

    /// Left scale of the pair: 0 is the punctured one, positive to the right.
    pub fn left_scale(&self) -> Option<i64> {
        match self {
            Self::Contact(event) => event.left_scale,
            Self::Fold(fold) => Some(fold.left_scale),
        }
    }

    /// What it happens to: a corner and an edge, or the gap.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Contact(event) => event.corner_edge.name(),
            Self::Fold(_) => "gap",
        }
    }

    /// What happens.
    pub fn change(&self) -> &'static str {
        match self {
            Self::Contact(event) => event.change.name(),
            Self::Fold(fold) => fold.name(),
        }
    }
}

impl Puncture {
    /// The events of contacts and of the surface, in the order of the path.
    pub fn all_events(&self) -> Vec<PunctureEvent> {
        let mut folds = self.folds.iter().copied().peekable();
        let mut all = Vec::with_capacity(self.events.len() + self.folds.len());
        for (count, &event) in self.events.iter().enumerate() {
            while let Some(fold) = folds.next_if(|fold| fold.contact_events <= count) {
                all.push(PunctureEvent::Fold(fold));
            }
            all.push(PunctureEvent::Contact(event));
        }
        all.extend(folds.map(PunctureEvent::Fold));
        all
    }
}

//! Springs and row stiffnesses, solved once and shared.

use std::sync::Arc;

use crate::boundary_element::Unresolved;
use crate::cache::BoundedCache;
use crate::{Coupling, Footprint, RowStiffness, Springs, StiffnessSlopes};

/// Calibrations shared by every design and thread that needs them.
///
/// Designs that differ in slant alone share a footprint. The first thread to ask for one solves it;
/// others that ask meanwhile wait for that result, and others that ask for another footprint do
/// not wait. Springs depend on the footprint alone, so results depend neither on the threads
/// nor on the footprints that the cache forgets when it is full.
#[derive(Debug)]
pub struct Calibrations {
    rows: [BoundedCache<Arc<RowStiffness>>; COUPLINGS],
    slopes: [BoundedCache<Arc<StiffnessSlopes>>; COUPLINGS],
}

/// Kinds of [`Coupling`], which number the caches.
const COUPLINGS: usize = 2;

/// The default capacity, in footprints: some 10 MB, and more than any sweep needs at a time.
const CAPACITY: usize = 1 << 16;

impl Calibrations {
    /// Creates a cache of at most `capacity` footprints (at least two) for each coupling.
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            rows: [(); COUPLINGS].map(|()| BoundedCache::with_capacity(capacity)),
            slopes: [(); COUPLINGS].map(|()| BoundedCache::with_capacity(capacity)),
        }
    }

    /// Returns the springs of `footprint`, solved now if they are not known.
    ///
    /// # Errors
    /// As [`RowStiffness::solve`]; the error is remembered like a result.
    pub fn get(&self, footprint: &Footprint) -> Result<Springs, Unresolved> {
        // Springs are a row with its nearest neighbours: one cache serves both.
        self.row(footprint, Coupling::Nearest).map(|row| (&*row).into())
    }

    /// Returns the stiffness of a row of that `footprint` and `coupling`, solved now if it is not known.
    ///
    /// # Errors
    /// As [`RowStiffness::solve`]; the error is remembered like a result.
    pub fn row(
        &self,
        footprint: &Footprint,
        coupling: Coupling,
    ) -> Result<Arc<RowStiffness>, Unresolved> {
        let solve = || RowStiffness::compute(footprint, coupling).map(Arc::new);
        self.rows[coupling as usize].get_or_solve(footprint, solve)
    }

    /// Returns the stiffness of a row of that `footprint` and `coupling` with its derivatives, solved now if it is not known.
    ///
    /// # Errors
    /// As [`RowStiffness::solve`]; the error is remembered like a result.
    pub fn slopes(
        &self,
        footprint: &Footprint,
        coupling: Coupling,
    ) -> Result<Arc<StiffnessSlopes>, Unresolved> {
        let solve = || StiffnessSlopes::compute(footprint, coupling).map(Arc::new);
        self.slopes[coupling as usize].get_or_solve(footprint, solve)
    }
}

impl Default for Calibrations {
    fn default() -> Self {
        Self::with_capacity(CAPACITY)
    }
}

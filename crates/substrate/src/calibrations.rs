//! Springs and row stiffnesses, solved once and shared.

use std::sync::Arc;

use crate::boundary_element::Unresolved;
use crate::cache::BoundedCache;
use crate::{Coupling, Footprint, NEIGHBOURS, RowStiffness, Springs, StiffnessSlopes, calibrate};

/// Calibrations shared by every design and thread that needs them.
///
/// Designs that differ in slant alone share a footprint. The first thread to ask for one solves it;
/// others that ask meanwhile wait for that result, and others that ask for another footprint do
/// not wait. Springs depend on the footprint alone, so results depend neither on the threads
/// nor on the footprints that the cache forgets when it is full.
#[derive(Debug)]
pub struct Calibrations {
    springs: BoundedCache<Springs>,
    rows: BoundedCache<Arc<RowStiffness>>,
    slopes: BoundedCache<Arc<StiffnessSlopes>>,
    full_slopes: BoundedCache<Arc<StiffnessSlopes>>,
}

/// The default capacity, in footprints: some 10 MB, and more than any sweep needs at a time.
const CAPACITY: usize = 1 << 16;

impl Calibrations {
    /// Creates a cache of at most `capacity` footprints (at least two) for each coupling.
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            springs: BoundedCache::with_capacity(capacity),
            rows: BoundedCache::with_capacity(capacity),
            slopes: BoundedCache::with_capacity(capacity),
            full_slopes: BoundedCache::with_capacity(capacity),
        }
    }

    /// Returns the springs of `footprint`, solved now if they are not known.
    ///
    /// # Errors
    /// As [`calibrate`]; the error is remembered like a result.
    pub fn get(&self, footprint: &Footprint) -> Result<Springs, Unresolved> {
        self.springs.get_or_solve(footprint, || calibrate(footprint))
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
        match coupling {
            Coupling::Nearest => Ok(Arc::new((&self.get(footprint)?).into())),
            Coupling::Full => self.rows.get_or_solve(footprint, || {
                RowStiffness::solve(footprint, NEIGHBOURS).map(Arc::new)
            }),
        }
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
        let cache = match coupling {
            Coupling::Nearest => &self.slopes,
            Coupling::Full => &self.full_slopes,
        };
        cache.get_or_solve(footprint, || StiffnessSlopes::of(footprint, coupling).map(Arc::new))
    }
}

impl Default for Calibrations {
    fn default() -> Self {
        Self::with_capacity(CAPACITY)
    }
}

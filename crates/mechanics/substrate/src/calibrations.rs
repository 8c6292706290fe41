//! Springs and row stiffnesses, solved once and shared.

use std::sync::Arc;

use crate::boundary_element::Unresolved;
use crate::cache::BoundedCache;
use crate::{Coupling, Footprint, RowStiffness, Springs, StiffnessSlopes};

/// Calibrations shared by all designs and threads.
///
/// Designs that differ only in slant share a footprint. The first thread that requests a footprint
/// solves it; other requests for the same one wait for that result, and requests for another
/// footprint do not wait. Results depend on the footprint alone, hence neither on the threads nor
/// on the footprints that a full cache drops.
#[derive(Debug)]
pub struct Calibrations {
    rows: [BoundedCache<Arc<RowStiffness>>; COUPLINGS],
    slopes: [BoundedCache<Arc<StiffnessSlopes>>; COUPLINGS],
}

/// Number of variants of [`Coupling`], each with a cache.
const COUPLINGS: usize = 2;

/// Default capacity: about 10 MB, more footprints than a sweep needs at a time.
const CAPACITY: usize = 1 << 16;

impl Calibrations {
    /// Creates a cache of at most `capacity` footprints for each coupling.
    ///
    /// The capacity is at least two.
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            rows: [(); COUPLINGS].map(|()| BoundedCache::with_capacity(capacity)),
            slopes: [(); COUPLINGS].map(|()| BoundedCache::with_capacity(capacity)),
        }
    }

    /// Returns the springs of `footprint`, solving them if necessary.
    ///
    /// # Errors
    /// As [`RowStiffness::solve`]; errors are cached too.
    pub fn get(&self, footprint: &Footprint) -> Result<Springs, Unresolved> {
        // Springs are a row with nearest neighbours, so one cache serves both.
        self.row(footprint, Coupling::Nearest).map(|row| (&*row).into())
    }

    /// Returns the stiffness of a row, solving it if necessary.
    ///
    /// # Errors
    /// As [`RowStiffness::solve`]; errors are cached too.
    pub fn row(
        &self,
        footprint: &Footprint,
        coupling: Coupling,
    ) -> Result<Arc<RowStiffness>, Unresolved> {
        self.rows[coupling as usize]
            .get_or_solve(footprint, || RowStiffness::compute(footprint, coupling).map(Arc::new))
    }

    /// Returns the stiffness of a row with its derivatives, solving them if necessary.
    ///
    /// # Errors
    /// As [`RowStiffness::solve`]; errors are cached too.
    pub fn slopes(
        &self,
        footprint: &Footprint,
        coupling: Coupling,
    ) -> Result<Arc<StiffnessSlopes>, Unresolved> {
        self.slopes[coupling as usize]
            .get_or_solve(footprint, || StiffnessSlopes::compute(footprint, coupling).map(Arc::new))
    }
}

impl Default for Calibrations {
    fn default() -> Self {
        Self::with_capacity(CAPACITY)
    }
}

/// Returns the springs of a footprint.
///
/// From a table, accurate to 1e-5 of `α`, for `b/a` from 0.25 to 80 and `d/a` from 0.0125 to 100.
/// Otherwise from three meshes of `4`, `6` and `8` cells per side, extrapolated in the number of
/// cells:
///
/// ```text
/// c = c_n + (c_n − c_m) / ((n/m)³ − 1)                                (S7)
/// error = max over c of ( |c₆₈ − c₄₆| + 0.3 |c₆₈ − c₈| ) / α          (S8)
/// ```
///
/// where `c_mn` results from `m` and `n` cells per side. The error decreases as `n⁻³`. The second
/// term of (S8) covers extrapolations that agree by accident.
///
/// # Errors
/// If the gap vanishes by rounding (`d/a` below about 1e-15). Larger small gaps have a growing
/// `error`.
pub fn calibrate(footprint: &Footprint) -> Result<Springs, Unresolved> {
    RowStiffness::compute(footprint, Coupling::Nearest).map(|row| (&row).into())
}

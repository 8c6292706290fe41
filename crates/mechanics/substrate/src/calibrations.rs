//! Cache of springs and row stiffnesses, and the function that computes springs without it.

use std::sync::Arc;

use crate::boundary_element::Unresolved;
use crate::cache::BoundedCache;
use crate::{Coupling, Footprint, RowStiffness, Springs, StiffnessSlopes};

/// Cache of springs and row stiffnesses, shared by all designs and threads.
///
/// Designs that differ only in slant have the same footprint. The first thread that requests a
/// footprint solves it. Other threads that request this footprint meanwhile wait for the result;
/// requests for other footprints do not wait. A result depends only on the footprint, not on the
/// number of threads or on the footprints that a full cache has dropped.
#[derive(Debug)]
pub struct Calibrations {
    rows: [BoundedCache<Arc<RowStiffness>>; COUPLINGS],
    slopes: [BoundedCache<Arc<StiffnessSlopes>>; COUPLINGS],
}

/// Number of variants of [`Coupling`]; each variant has its own cache.
const COUPLINGS: usize = 2;

/// Default number of footprints per cache, about 10 MB. A sweep uses fewer at the same time.
const CAPACITY: usize = 1 << 16;

impl Calibrations {
    /// Creates caches of at most `capacity` footprints, one cache for each coupling.
    ///
    /// A capacity below two counts as two.
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            rows: [(); COUPLINGS].map(|()| BoundedCache::with_capacity(capacity)),
            slopes: [(); COUPLINGS].map(|()| BoundedCache::with_capacity(capacity)),
        }
    }

    /// Returns the springs of `footprint`, and computes them at the first request.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding. Errors are cached too.
    pub fn get(&self, footprint: &Footprint) -> Result<Springs, Unresolved> {
        // Springs are the stiffness of a row with nearest neighbours, which is cached already.
        self.row(footprint, Coupling::Nearest).map(|row| (&*row).into())
    }

    /// Returns the stiffness of a row, and computes it at the first request.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding. Errors are cached too.
    pub fn row(
        &self,
        footprint: &Footprint,
        coupling: Coupling,
    ) -> Result<Arc<RowStiffness>, Unresolved> {
        self.rows[coupling as usize]
            .get_or_solve(footprint, || RowStiffness::compute(footprint, coupling).map(Arc::new))
    }

    /// Returns the stiffness of a row with its derivatives, and computes it at the first request.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding. Errors are cached too.
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

/// Computes the springs of a footprint.
///
/// For `b/a` from 0.25 to 80 and `d/a` from 0.0125 to 100 the springs come from a table that is
/// accurate to 1e-5 of `α`. Beyond this range they are solved on three meshes of `4`, `6` and `8`
/// cells per side and extrapolated:
///
/// ```text
/// c = c_n + (c_n − c_m) / ((n/m)³ − 1)                                (S7)
/// error = max over c of ( |c₆₈ − c₄₆| + 0.3 |c₆₈ − c₈| ) / α          (S8)
/// ```
///
/// where `c_n` results from `n` cells per side and `c_mn` is extrapolated from `m` and `n` cells.
/// The error decreases as `n⁻³`. The second term of (S8) covers extrapolations that agree by
/// accident. On a layer the effect of the rigid base is added.
///
/// # Errors
/// If the gap vanishes by rounding (`d/a` below about 1e-15). For other small gaps
/// [`Springs::error`] grows as the gap decreases.
pub fn calibrate(footprint: &Footprint) -> Result<Springs, Unresolved> {
    RowStiffness::compute(footprint, Coupling::Nearest).map(|row| (&row).into())
}

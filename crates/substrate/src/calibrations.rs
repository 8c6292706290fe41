//! Springs solved once and shared.

use std::collections::HashMap;
use std::mem;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::boundary_element::Unresolved;
use crate::{Coupling, Footprint, NEIGHBOURS, RowStiffness, Springs, calibrate};

/// Calibrations shared by every design and thread that needs them.
///
/// Designs that differ in slant alone share a footprint. The first thread to ask for one solves it;
/// others that ask meanwhile wait for that result, and others that ask for another footprint do
/// not wait. Springs depend on the footprint alone, so results depend neither on the threads
/// nor on what the cache forgets.
///
/// Memory is bounded: two generations of at most half the capacity each. When the young one is
/// full the old one is forgotten and the young takes its place; what is used moves back to the
/// young. The default capacity of 65 536 footprints takes about 10 MB.
#[derive(Debug)]
pub struct Calibrations {
    springs: Mutex<Generations<Springs>>,
    rows: Mutex<Generations<Arc<RowStiffness>>>,
    solved: AtomicUsize,
}

/// Filled by the first who needs it; those who hold it while it is forgotten still share it.
type Slot<T> = Arc<OnceLock<Result<T, Unresolved>>>;

impl Calibrations {
    /// A cache that holds at most `capacity` footprints (at least two) for each coupling.
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            springs: Mutex::new(Generations::new(capacity)),
            rows: Mutex::new(Generations::new(capacity)),
            solved: AtomicUsize::new(0),
        }
    }

    /// The springs of `footprint`, solved now if they are not known.
    ///
    /// # Errors
    /// As [`calibrate`]; the error is remembered like a result.
    pub fn get(&self, footprint: &Footprint) -> Result<Springs, Unresolved> {
        self.shared(&self.springs, footprint, || calibrate(footprint))
    }

    /// The stiffness of a row of that `footprint` and `coupling`, solved now if it is not known.
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
            Coupling::Full => self.shared(&self.rows, footprint, || {
                RowStiffness::solve(footprint, NEIGHBOURS).map(Arc::new)
            }),
        }
    }

    fn shared<T: Clone>(
        &self,
        cache: &Mutex<Generations<T>>,
        footprint: &Footprint,
        solve: impl FnOnce() -> Result<T, Unresolved>,
    ) -> Result<T, Unresolved> {
        // Solving happens outside the lock. A panic elsewhere leaves the maps whole, so a poisoned
        // lock is as good as any.
        let slot = cache.lock().unwrap_or_else(PoisonError::into_inner).slot(footprint);
        let found = slot.get_or_init(|| {
            self.solved.fetch_add(1, Ordering::Relaxed);
            solve()
        });
        found.clone()
    }

    /// How many calibrations were solved so far.
    pub fn solved(&self) -> usize {
        self.solved.load(Ordering::Relaxed)
    }

    /// How many footprints are held now.
    pub fn held(&self) -> usize {
        let springs = self.springs.lock().unwrap_or_else(PoisonError::into_inner).held();
        springs + self.rows.lock().unwrap_or_else(PoisonError::into_inner).held()
    }
}

impl Default for Calibrations {
    fn default() -> Self {
        Self::with_capacity(1 << 16)
    }
}

#[derive(Debug)]
struct Generations<T> {
    limit: usize,
    young: HashMap<Footprint, Slot<T>>,
    old: HashMap<Footprint, Slot<T>>,
}

impl<T> Generations<T> {
    fn new(capacity: usize) -> Self {
        Self { limit: (capacity / 2).max(1), young: HashMap::new(), old: HashMap::new() }
    }

    fn held(&self) -> usize {
        self.young.len() + self.old.len()
    }

    fn slot(&mut self, footprint: &Footprint) -> Slot<T> {
        if let Some(slot) = self.young.get(footprint) {
            return Arc::clone(slot);
        }
        let slot = self.old.remove(footprint).unwrap_or_default();
        if self.young.len() >= self.limit {
            self.old = mem::take(&mut self.young);
        }
        self.young.insert(*footprint, Arc::clone(&slot));
        slot
    }
}

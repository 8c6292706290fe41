//! Springs solved once and shared.

use std::collections::HashMap;
use std::mem;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::boundary_element::Unresolved;
use crate::{Footprint, Springs, calibrate};

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
    generations: Mutex<Generations>,
    solved: AtomicUsize,
}

/// Filled by the first who needs it; those who hold it while it is forgotten still share it.
type Slot = Arc<OnceLock<Result<Springs, Unresolved>>>;

impl Calibrations {
    /// A cache that holds at most `capacity` footprints (at least two).
    pub fn with_capacity(capacity: usize) -> Self {
        let generations = Generations {
            limit: (capacity / 2).max(1),
            young: HashMap::new(),
            old: HashMap::new(),
        };
        Self { generations: Mutex::new(generations), solved: AtomicUsize::new(0) }
    }

    /// The springs of `footprint`, solved now if they are not known.
    ///
    /// # Errors
    /// As [`calibrate`]; the error is remembered like a result.
    pub fn get(&self, footprint: &Footprint) -> Result<Springs, Unresolved> {
        // Solving happens outside the lock. A panic elsewhere leaves the maps whole, so a poisoned
        // lock is as good as any.
        let slot = self.generations.lock().unwrap_or_else(PoisonError::into_inner).slot(footprint);
        *slot.get_or_init(|| {
            self.solved.fetch_add(1, Ordering::Relaxed);
            calibrate(footprint)
        })
    }

    /// How many calibrations were solved so far.
    pub fn solved(&self) -> usize {
        self.solved.load(Ordering::Relaxed)
    }

    /// How many footprints are held now.
    pub fn held(&self) -> usize {
        let generations = self.generations.lock().unwrap_or_else(PoisonError::into_inner);
        generations.young.len() + generations.old.len()
    }
}

impl Default for Calibrations {
    fn default() -> Self {
        Self::with_capacity(1 << 16)
    }
}

#[derive(Debug)]
struct Generations {
    limit: usize,
    young: HashMap<Footprint, Slot>,
    old: HashMap<Footprint, Slot>,
}

impl Generations {
    fn slot(&mut self, footprint: &Footprint) -> Slot {
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

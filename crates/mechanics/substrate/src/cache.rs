//! Bounded cache that solves each footprint once for all threads.

use std::collections::HashMap;
use std::mem;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::Footprint;
use crate::boundary_element::Unresolved;

/// Slot for the result of a footprint; the first thread that needs the result computes it.
///
/// A thread that holds a slot can still use the slot after the cache has dropped the footprint.
type Slot<T> = Arc<OnceLock<Result<T, Unresolved>>>;

/// Cache of results by footprint; the first thread that requests a footprint solves it.
///
/// The memory is bounded by two generations, `young` and `old`, each with at most half the
/// capacity. If `young` is full, it becomes `old`, and the previous `old` generation is dropped. An
/// entry of `old` that is requested again moves to `young`.
#[derive(Debug)]
pub(crate) struct BoundedCache<T>(Mutex<Generations<T>>);

#[derive(Debug)]
struct Generations<T> {
    limit: usize,
    young: HashMap<Footprint, Slot<T>>,
    old: HashMap<Footprint, Slot<T>>,
}

impl<T: Clone> BoundedCache<T> {
    /// Creates an empty cache for at most `capacity` footprints; a capacity below two counts as
    /// two.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        let limit = (capacity / 2).max(1);
        Self(Mutex::new(Generations { limit, young: HashMap::new(), old: HashMap::new() }))
    }

    /// Returns the cached result for `footprint`, or calls `solve` and caches its result.
    ///
    /// Errors are cached too.
    pub(crate) fn get_or_solve(
        &self,
        footprint: &Footprint,
        solve: impl FnOnce() -> Result<T, Unresolved>,
    ) -> Result<T, Unresolved> {
        // The lock is released before `solve` runs. A panic in another thread leaves the maps
        // consistent, so a poisoned lock can still be used.
        let slot = self.0.lock().unwrap_or_else(PoisonError::into_inner).slot(footprint);
        slot.get_or_init(solve).clone()
    }
}

impl<T> Generations<T> {
    fn slot(&mut self, footprint: &Footprint) -> Slot<T> {
        if let Some(slot) = self.young.get(footprint) {
            return Arc::clone(slot);
        }
        // The entry is removed from `old` before `old` is dropped, so that its result is kept.
        let slot = self.old.remove(footprint).unwrap_or_default();
        if self.young.len() >= self.limit {
            self.old = mem::take(&mut self.young);
        }
        self.young.insert(*footprint, Arc::clone(&slot));
        slot
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread;

    use super::BoundedCache;
    use crate::Footprint;
    use crate::boundary_element::Unresolved;

    fn footprints(count: u32) -> Vec<Footprint> {
        (1..=count).map(|k| Footprint::new(0.1 * f64::from(k), 2.0, 0.5).unwrap()).collect()
    }

    /// Cache that counts its solutions; the result of a footprint is its gap.
    struct Counted {
        cache: BoundedCache<f64>,
        solved: AtomicUsize,
    }

    impl Counted {
        fn with_capacity(capacity: usize) -> Self {
            Self { cache: BoundedCache::with_capacity(capacity), solved: AtomicUsize::new(0) }
        }

        fn get(&self, footprint: &Footprint) -> f64 {
            let gap = self.cache.get_or_solve(footprint, || {
                self.solved.fetch_add(1, Ordering::Relaxed);
                Ok(footprint.gap_over_a())
            });
            gap.unwrap()
        }

        fn solved(&self) -> usize {
            self.solved.load(Ordering::Relaxed)
        }

        fn stored(&self) -> usize {
            let generations = self.cache.0.lock().unwrap();
            generations.young.len() + generations.old.len()
        }
    }

    #[test]
    fn each_footprint_is_solved_once() {
        let (shared, requested) = (Counted::with_capacity(100), footprints(5));
        thread::scope(|scope| {
            for start in 0..8 {
                let count = requested.len();
                let (shared, requested) =
                    (&shared, requested.iter().cycle().skip(start).take(count));
                scope.spawn(move || {
                    for footprint in requested {
                        assert_eq!(shared.get(footprint), footprint.gap_over_a());
                    }
                });
            }
        });
        assert_eq!((shared.solved(), shared.stored()), (5, 5));
    }

    #[test]
    fn a_full_cache_drops_footprints_and_solves_them_again() {
        let (small, requested) = (Counted::with_capacity(4), footprints(9));
        for _ in 0..2 {
            for footprint in &requested {
                assert_eq!(small.get(footprint), footprint.gap_over_a());
                assert!(small.stored() <= 4, "{} footprints", small.stored());
            }
        }
        assert_eq!(small.solved(), 18);
    }

    #[test]
    fn a_recently_used_footprint_is_not_dropped() {
        let (small, requested) = (Counted::with_capacity(4), footprints(12));
        for footprint in &requested {
            small.get(footprint);
            small.get(&requested[0]);
        }
        assert_eq!(small.solved(), requested.len());
    }

    #[test]
    fn errors_are_cached() {
        let (cache, footprint) = (BoundedCache::<f64>::with_capacity(4), footprints(1)[0]);
        let unresolved = Unresolved { footprint, cells: 4 };
        assert_eq!(cache.get_or_solve(&footprint, || Err(unresolved)), Err(unresolved));
        assert_eq!(cache.get_or_solve(&footprint, || Ok(1.0)), Err(unresolved));
    }
}

//! Bounded cache that solves each footprint once for all threads.

use std::collections::HashMap;
use std::mem;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::Footprint;
use crate::boundary_element::Unresolved;

/// Result filled by the first thread that needs it.
///
/// Threads that hold it when the cache drops it still share it.
type Slot<T> = Arc<OnceLock<Result<T, Unresolved>>>;

/// Results by footprint, each solved by the first thread that requests it.
///
/// Two generations of at most half the capacity each bound the memory. When the young one is full,
/// it replaces the old one, which is dropped. An entry that is used again moves to the young one.
#[derive(Debug)]
pub(crate) struct BoundedCache<T>(Mutex<Generations<T>>);

#[derive(Debug)]
struct Generations<T> {
    limit: usize,
    young: HashMap<Footprint, Slot<T>>,
    old: HashMap<Footprint, Slot<T>>,
}

impl<T: Clone> BoundedCache<T> {
    /// Creates an empty cache for at most `capacity` footprints, at least two.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        let limit = (capacity / 2).max(1);
        Self(Mutex::new(Generations { limit, young: HashMap::new(), old: HashMap::new() }))
    }

    /// Returns the cached result for `footprint`, or calls `solve`.
    ///
    /// Errors are cached too.
    pub(crate) fn get_or_solve(
        &self,
        footprint: &Footprint,
        solve: impl FnOnce() -> Result<T, Unresolved>,
    ) -> Result<T, Unresolved> {
        // Solve outside the lock. A panic elsewhere leaves the maps intact, so a poisoned lock is
        // usable.
        let slot = self.0.lock().unwrap_or_else(PoisonError::into_inner).slot(footprint);
        slot.get_or_init(solve).clone()
    }
}

impl<T> Generations<T> {
    fn slot(&mut self, footprint: &Footprint) -> Slot<T> {
        if let Some(slot) = self.young.get(footprint) {
            return Arc::clone(slot);
        }
        // Move before dropping the old generation, so that an entry in use is not solved again.
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

    /// Cache that counts its solves; the cached result is the gap.
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

        fn held(&self) -> usize {
            let generations = self.cache.0.lock().unwrap();
            generations.young.len() + generations.old.len()
        }
    }

    #[test]
    fn each_footprint_is_solved_once() {
        let (shared, asked) = (Counted::with_capacity(100), footprints(5));
        thread::scope(|scope| {
            for start in 0..8 {
                let (shared, asked) = (&shared, asked.iter().cycle().skip(start).take(asked.len()));
                scope.spawn(move || {
                    for footprint in asked {
                        assert_eq!(shared.get(footprint), footprint.gap_over_a());
                    }
                });
            }
        });
        assert_eq!((shared.solved(), shared.held()), (5, 5));
    }

    #[test]
    fn memory_is_bounded_and_no_result_depends_on_it() {
        let (small, asked) = (Counted::with_capacity(4), footprints(9));
        for _ in 0..2 {
            for footprint in &asked {
                assert_eq!(small.get(footprint), footprint.gap_over_a());
                assert!(small.held() <= 4, "{} held", small.held());
            }
        }
        assert_eq!(small.solved(), 18);
    }

    #[test]
    fn an_entry_in_use_survives_any_number_of_others() {
        let (small, asked) = (Counted::with_capacity(4), footprints(12));
        for footprint in &asked {
            small.get(footprint);
            small.get(&asked[0]);
        }
        assert_eq!(small.solved(), asked.len());
    }

    #[test]
    fn errors_are_remembered() {
        let (cache, footprint) = (BoundedCache::<f64>::with_capacity(4), footprints(1)[0]);
        let unresolved = Unresolved { footprint, cells: 4 };
        assert_eq!(cache.get_or_solve(&footprint, || Err(unresolved)), Err(unresolved));
        assert_eq!(cache.get_or_solve(&footprint, || Ok(1.0)), Err(unresolved));
    }
}

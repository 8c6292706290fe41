//! A short copyable list of numbers.

use serde::{Serialize, Serializer};

/// Capacity of a [`NumberList`].
pub const MOST_NUMBERS: usize = 8;

/// Up to [`MOST_NUMBERS`] numbers in ascending order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NumberList {
    numbers: [f64; MOST_NUMBERS],
    count: usize,
}

impl Serialize for NumberList {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.as_slice().serialize(serializer)
    }
}

impl NumberList {
    /// Creates a list; `None` if it is too long or does not strictly ascend.
    ///
    /// ```
    /// use skin::puncture::NumberList;
    ///
    /// assert_eq!(NumberList::new(&[5.0, 10.0]).map(|list| list.len()), Some(2));
    /// assert_eq!(NumberList::new(&[10.0, 5.0]), None);
    /// ```
    pub fn new(numbers: &[f64]) -> Option<Self> {
        let mut list = Self { count: numbers.len(), ..Self::default() };
        list.numbers.get_mut(..numbers.len())?.copy_from_slice(numbers);
        numbers.is_sorted_by(|a, b| a < b).then_some(list)
    }

    /// Applies an increasing function to all numbers.
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut list = self;
        list.numbers[..list.count].iter_mut().for_each(|number| *number = f(*number));
        list
    }

    /// Returns the numbers as a slice.
    pub fn as_slice(&self) -> &[f64] {
        &self.numbers[..self.count]
    }

    /// Splits off the largest number; `None` for an empty list.
    pub fn split_last(self) -> Option<(f64, Self)> {
        let last = *self.as_slice().last()?;
        Some((last, Self { count: self.count - 1, ..self }))
    }

    /// Returns the number of entries.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns true if the list is empty.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

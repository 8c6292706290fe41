//! A short list of numbers that is copied as a value.

use serde::{Serialize, Serializer};

/// Numbers that a [`NumberList`] holds at most.
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
    /// The list of `numbers`; `None` if there are too many, or each is not larger than the one before.
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

    /// The list of what a rising function makes of the numbers.
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut list = self;
        list.numbers[..list.count].iter_mut().for_each(|number| *number = f(*number));
        list
    }

    /// The numbers.
    pub fn as_slice(&self) -> &[f64] {
        &self.numbers[..self.count]
    }

    /// The largest number, and the others; `None` of an empty list.
    pub fn split_last(self) -> Option<(f64, Self)> {
        let last = *self.as_slice().last()?;
        Some((last, Self { count: self.count - 1, ..self }))
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

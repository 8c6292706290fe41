//! Groups designs that share the springs of their substrate.

use std::iter::Peekable;

use substrate::{Coupling, Footprint};
use sweep::Grid;

/// Maximum number of designs in a group.
///
/// A thread solves one group at a time. In a sweep in which all designs share their springs, small
/// groups keep all threads busy until the end.
const LARGEST: usize = 64;

/// Iterator over groups of consecutive designs with the same footprint and coupling.
///
/// The slant is the fastest axis of a grid, so most neighbours have the same footprint.
pub(crate) struct Groups<'g, I: Iterator<Item = u64>> {
    grid: &'g Grid,
    designs: Peekable<I>,
}

impl<'g, I: Iterator<Item = u64>> Groups<'g, I> {
    /// Creates the groups of `designs`, which are indices of `grid`.
    pub fn new(grid: &'g Grid, designs: I) -> Self {
        Self { grid, designs: designs.peekable() }
    }

    fn springs(&self, index: u64) -> (Option<Footprint>, Coupling) {
        let case = self.grid.case(index);
        // Consecutive designs without a valid footprint form a group; their solutions report why.
        (case.footprint().ok(), case.coupling)
    }
}

impl<I: Iterator<Item = u64>> Iterator for Groups<'_, I> {
    type Item = Vec<u64>;

    fn next(&mut self) -> Option<Vec<u64>> {
        let first = self.designs.next()?;
        let springs = self.springs(first);
        let mut group = vec![first];
        while group.len() < LARGEST
            && let Some(&design) = self.designs.peek()
            && self.springs(design) == springs
        {
            group.extend(self.designs.next());
        }
        Some(group)
    }
}

#[cfg(test)]
mod tests {
    use sweep::Sweep;

    use super::*;

    #[test]
    fn designs_that_differ_in_slant_form_a_group() {
        let text = "name = 'x'\n[designs]\ngap_over_t = [0.1, 0.2]\nlength_over_t = 1\n\
                    slant_deg = { from = 0, to = 80, step = 1 }\ncoupling = ['nearest', 'full']";
        let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
        let groups: Vec<_> = Groups::new(sweep.grid(), 0..sweep.grid().len()).collect();
        assert_eq!(groups.iter().map(Vec::len).collect::<Vec<_>>(), [64, 17].repeat(4));
        assert!(groups.concat().into_iter().eq(0..sweep.grid().len()));
    }
}

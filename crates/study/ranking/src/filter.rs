//! Applies requirements to the rows of a table.

use results::{InvalidResults, Results};

use crate::requirement::Requirement;

/// Requirements with the indices of their columns in a table.
pub(crate) struct RequirementFilter<'a> {
    results: &'a Results,
    requirements: Vec<(&'a Requirement, usize)>,
}

impl<'a> RequirementFilter<'a> {
    /// Finds the columns of the requirements.
    ///
    /// # Errors
    ///
    /// If a column is missing.
    pub fn new(
        results: &'a Results,
        requirements: &'a [Requirement],
    ) -> Result<Self, InvalidResults> {
        // Look up the columns once, because every row needs them.
        let find =
            |requirement: &'a Requirement| Ok((requirement, results.column(&requirement.column)?));
        let requirements = requirements.iter().map(find).collect::<Result<_, _>>()?;
        Ok(Self { results, requirements })
    }

    /// Returns the index of the first requirement that is not met in `row`.
    ///
    /// A missing value meets no requirement.
    ///
    /// # Errors
    ///
    /// If a cell is not a number.
    pub fn first_unmet(&self, row: usize) -> Result<Option<usize>, InvalidResults> {
        for (index, (requirement, column)) in self.requirements.iter().enumerate() {
            let value = self.results.number(row, *column)?;
            if !value.is_some_and(|value| requirement.is_met(value)) {
                return Ok(Some(index));
            }
        }
        Ok(None)
    }

    /// Returns the value of the design in `row` for each requirement.
    ///
    /// # Errors
    ///
    /// If a cell is not a number.
    pub fn values(&self, row: usize) -> Result<Vec<Option<f64>>, InvalidResults> {
        self.requirements.iter().map(|(_, column)| self.results.number(row, *column)).collect()
    }
}

//! Requirements applied to the rows of a table.

use results::{InvalidResults, Results};

use crate::requirement::Requirement;

/// Requirements with the places of their columns in a table.
pub(crate) struct RequirementFilter<'a> {
    results: &'a Results,
    requirements: Vec<(&'a Requirement, usize)>,
}

impl<'a> RequirementFilter<'a> {
    /// Finds the columns of the requirements.
    ///
    /// # Errors
    /// If a column is missing.
    pub fn new(
        results: &'a Results,
        requirements: &'a [Requirement],
    ) -> Result<Self, InvalidResults> {
        // Found once for the table: every row is asked for them.
        let find =
            |requirement: &'a Requirement| Ok((requirement, results.column(&requirement.column)?));
        let requirements = requirements.iter().map(find).collect::<Result<_, _>>()?;
        Ok(Self { results, requirements })
    }

    /// The first requirement, by its place, that the design in a row does not meet. A value that does not exist meets none.
    ///
    /// # Errors
    /// If a cell is no number.
    pub fn first_unmet(&self, row: usize) -> Result<Option<usize>, InvalidResults> {
        for (place, (requirement, column)) in self.requirements.iter().enumerate() {
            let value = self.results.number(row, *column)?;
            if !value.is_some_and(|value| requirement.is_met(value)) {
                return Ok(Some(place));
            }
        }
        Ok(None)
    }

    /// The required values of the design in a row.
    ///
    /// # Errors
    /// If a cell is no number.
    pub fn values(&self, row: usize) -> Result<Vec<Option<f64>>, InvalidResults> {
        self.requirements.iter().map(|(_, column)| self.results.number(row, *column)).collect()
    }
}

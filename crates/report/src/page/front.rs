//! Designs that a search has found, beside those of the grid.

use ranking::{Criterion, Requirement};
use serde_json::{Map, Value, json};
use sweep::visible;

use super::data::cells;
use crate::axis::ChartAxis;
use crate::designs::Designs;

/// The designs that `squama optimise` has found, on a page whose designs are those of a grid.
#[derive(Clone, Debug)]
pub struct PageFront {
    /// The folder of the search, as commands name it.
    pub folder: String,
    /// The criteria of the search, at least one.
    pub objectives: Vec<Criterion>,
    /// The bounds that a design must keep.
    pub requirements: Vec<Requirement>,
    /// The quantities over what is made by which the search has judged, as columns of the designs that were found.
    pub made: Vec<String>,
    /// Whether designs whose surface folds over are left out.
    pub sound: bool,
    /// The parameters that vary, as their columns.
    pub variables: Vec<String>,
    /// What is fixed otherwise than in the grid, in words.
    pub differences: Vec<String>,
    /// The designs, with the columns of the grid, what binds, and what it costs.
    pub designs: Designs,
}

impl PageFront {
    /// Returns the columns that are axes: the objectives; beside a single one what is required first, or the first variable.
    fn axes(&self) -> Vec<&str> {
        let objectives = self.objectives.iter().map(|objective| objective.column.as_ref());
        let required = self.requirements.iter().map(|requirement| requirement.column.as_str());
        let others = required.chain(self.variables.iter().map(String::as_str));
        let mut axes: Vec<&str> = objectives.collect();
        if axes.len() == 1 {
            axes.extend(others.filter(|other| *other != axes[0]).take(1).collect::<Vec<_>>());
        }
        axes
    }

    /// Returns the data of the front, as the scripts of the page read them; its axes span the designs of `grid` too.
    pub(super) fn to_json(&self, grid: &Designs) -> Value {
        let axis = |column: &&str| {
            let values = grid.numbers(column).chain(self.designs.numbers(column));
            ((*column).to_owned(), ChartAxis::fit("", values).to_json())
        };
        let objective = |criterion: &Criterion| json!({"column": criterion.column, "goal": criterion.goal.key()});
        let requirement = |requirement: &Requirement| json!({"column": requirement.column, "sign": requirement.relation.sign(), "limit": requirement.limit});
        let headers = self.designs.headers().iter();
        let values = headers.map(|header| (header.clone(), cells(&self.designs, header).into()));
        json!({
            "folder": visible(&self.folder),
            "objectives": self.objectives.iter().map(objective).collect::<Vec<_>>(),
            "requirements": self.requirements.iter().map(requirement).collect::<Vec<_>>(),
            "sound": self.sound,
            "made": self.made,
            "variables": self.variables,
            "differences": self.differences,
            "axes": self.axes(),
            "axesOf": self.axes().iter().map(axis).collect::<Map<_, _>>(),
            "count": self.designs.count(),
            "values": values.collect::<Map<_, _>>(),
        })
    }
}

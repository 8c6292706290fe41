//! Rows of the tables of designs, failures and derivatives.

use std::borrow::Borrow;

use skin::flexure::Flexure;
use skin::puncture::Puncture;
use sweep::{Case, DesignNumber};

use super::design_result::{DesignResult, SEPARATOR};
use super::failure::Failure;
use super::parameter_derivative::ParameterDerivative;
use text::shell_word;

/// Row of `designs.csv`: a design and its result.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignRow {
    /// Position of the design in the grid.
    pub number: DesignNumber,
    /// Parameters of the design.
    pub case: Case,
    /// Measures of the design.
    pub result: DesignResult,
}

impl DesignRow {
    /// Returns the rows of `failures.csv` for this design.
    pub fn failures(&self) -> impl Iterator<Item = FailureRow> {
        self.result
            .failures
            .iter()
            .map(|failure| FailureRow { design: self.clone(), failure: *failure })
    }

    /// Returns the rows of `sensitivity.csv` for this design.
    pub fn derivatives(&self) -> impl Iterator<Item = DerivativeRow> {
        self.result
            .sensitivity
            .iter()
            .map(|derivative| DerivativeRow { design: self.number, derivative: derivative.clone() })
    }
}

/// Row of `sensitivity.csv`: a design and one of its derivatives.
#[derive(Clone, Debug)]
pub struct DerivativeRow {
    /// Position of the design in the grid.
    pub design: DesignNumber,
    /// Derivative of one measure with respect to one parameter.
    pub derivative: ParameterDerivative,
}

impl Borrow<DesignRow> for FailureRow {
    fn borrow(&self) -> &DesignRow {
        &self.design
    }
}

/// A solved design with its paths.
#[derive(Clone, Debug)]
pub struct SolvedDesign {
    /// Row of the design in the tables.
    pub row: DesignRow,
    /// Puncture, if it was requested and solved.
    pub puncture: Option<Puncture>,
    /// Bending, if it was requested and solved.
    pub flexure: Option<Flexure>,
}

/// Row of `failures.csv`: a design and the reason why one of its measures has no value.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureRow {
    /// Row of the design in `designs.csv`.
    pub design: DesignRow,
    /// Measure without a value, and the reason.
    pub failure: Failure,
}

impl FailureRow {
    /// Returns the command that solves this design alone.
    pub fn command(&self) -> String {
        let number = self.design.number;
        let mut command =
            // Use relative paths, so that the command works after the folder has moved.
            format!("squama design run.toml --design {number} --out designs/{number}");
        let settings = self.design.result.settings.split(SEPARATOR);
        for setting in settings.filter(|text| !text.is_empty()) {
            command.push_str(" --set ");
            command.push_str(&shell_word(setting));
        }
        command
    }
}

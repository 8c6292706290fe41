//! The rows of the tables of designs and of failures.

use std::borrow::Borrow;

use skin::flexure::Flexure;
use skin::puncture::Puncture;
use sweep::{Case, DesignNumber};

use super::design_result::{DesignResult, SEPARATOR};
use super::failure::Failure;
use super::parameter_derivative::ParameterDerivative;
use text::shell_word;

/// A row of `designs.csv`: a design and its result.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignRow {
    /// The position of the design in the grid.
    pub number: DesignNumber,
    /// The parameters of the design.
    pub case: Case,
    /// The result of the design.
    pub result: DesignResult,
}

impl DesignRow {
    /// The rows of `failures.csv` that the design has.
    pub fn failures(&self) -> impl Iterator<Item = FailureRow> {
        let row = |failure: &Failure| FailureRow { design: self.clone(), failure: *failure };
        self.result.failures.iter().map(row)
    }

    /// The rows of `sensitivity.csv` that the design has.
    pub fn derivatives(&self) -> impl Iterator<Item = DerivativeRow> {
        let row = |derivative: &ParameterDerivative| DerivativeRow {
            design: self.number,
            derivative: derivative.clone(),
        };
        self.result.sensitivity.iter().map(row)
    }
}

/// A row of `sensitivity.csv`: a design and one of its derivatives.
#[derive(Clone, Debug)]
pub struct DerivativeRow {
    /// The position of the design in the grid.
    pub design: DesignNumber,
    /// The derivative.
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
    /// The row of the design in the tables.
    pub row: DesignRow,
    /// The puncture, if it was asked for and ran.
    pub puncture: Option<Puncture>,
    /// The bending, if it was asked for and ran.
    pub flexure: Option<Flexure>,
}

/// A row of `failures.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureRow {
    /// The design.
    pub design: DesignRow,
    /// The failure.
    pub failure: Failure,
}

impl FailureRow {
    /// The command that solves the design alone.
    pub fn command(&self) -> String {
        let number = self.design.number;
        let mut command =
            // Relative paths, so that the command still holds where the folder has been moved.
            format!("squama design run.toml --design {number} --out designs/{number}");
        let settings = self.design.result.settings.split(SEPARATOR);
        for setting in settings.filter(|text| !text.is_empty()) {
            command.push_str(" --set ");
            command.push_str(&shell_word(setting));
        }
        command
    }
}

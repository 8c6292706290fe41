//! Values that changed when a design was solved again.

use std::borrow::Cow;

use sweep::DesignNumber;

use crate::columns::cell::Cell;

/// A row of `reruns.csv`: one value before and after a rerun.
#[derive(Clone, Debug)]
pub struct RerunChange {
    /// Number of the design.
    pub design: DesignNumber,
    /// Number of the rerun, from 1.
    pub rerun: u64,
    /// The settings before and after.
    pub settings: [String; 2],
    /// The column, empty if no value changed.
    pub column: Cow<'static, str>,
    /// The cell before and after.
    pub values: [Cell; 2],
}

//! The change of one value by a rerun of a design.

use std::borrow::Cow;

use sweep::DesignNumber;

use crate::columns::cell::Cell;

/// Row of `reruns.csv`: one value before and after a rerun.
#[derive(Clone, Debug)]
pub struct RerunChange {
    /// Number of the design.
    pub design: DesignNumber,
    /// Number of the rerun, from 1.
    pub rerun: u64,
    /// Settings of the design before and after the rerun.
    pub settings: [String; 2],
    /// Name of the column with the changed value. Empty if no value changed.
    pub column: Cow<'static, str>,
    /// Cell of the column before and after the rerun.
    pub values: [Cell; 2],
}

//! Values changed by a rerun.

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
    /// Settings before and after.
    pub settings: [String; 2],
    /// Name of the column. Empty if no value changed.
    pub column: Cow<'static, str>,
    /// Cell before and after.
    pub values: [Cell; 2],
}

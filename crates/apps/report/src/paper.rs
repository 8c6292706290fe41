//! Width of the printed paper, which limits the width of figures and their number of panels.

/// Pixels per printed millimetre.
///
/// At this scale, tick labels of 11 px are printed at 6.6 pt, and legends of 12 px at 7.2 pt.
const PX_PER_MM: f64 = 1.25 * 96.0 / 25.4;
/// Smallest width for which figures are laid out, px. For narrower paper, figures are shrunk.
const NARROWEST: f64 = 320.0;
/// Maximum number of rows of panels on narrow paper.
const ROWS: usize = 2;

/// The paper for which figures are laid out: as wide as each figure needs, or narrower.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paper {
    width: Option<f64>,
}

impl Paper {
    /// Paper as wide as each figure needs.
    pub const WIDE: Self = Self { width: None };

    /// Returns paper with the width `mm` in millimetres, such as the column of a journal.
    pub fn of_width(mm: f64) -> Self {
        Self { width: Some((mm * PX_PER_MM).max(NARROWEST)) }
    }

    /// Returns the width of a figure that needs `natural` px on wide paper.
    pub(crate) fn width(self, natural: f64) -> f64 {
        self.width.map_or(natural, |own| own.min(natural))
    }

    /// Returns true if the paper is narrower than the `natural` px that a figure needs.
    pub(crate) fn is_narrow(self, natural: f64) -> bool {
        self.width(natural) < natural
    }

    /// Returns the number of columns of panels that fit into `room` px; at most `wanted`.
    ///
    /// Each panel is at least `least` px wide, and panels are `between` px apart.
    pub(crate) fn columns(self, wanted: usize, room: f64, least: f64, between: f64) -> usize {
        if self.width.is_none() {
            return wanted;
        }
        let fitting = ((room + between) / (least + between)) as usize;
        wanted.min(fitting).max(1)
    }

    /// Returns the maximum number of panels of a figure with `columns` columns; at most `most`.
    ///
    /// The figure needs `natural` px on wide paper.
    pub(crate) fn panels(self, natural: f64, columns: usize, most: usize) -> usize {
        if self.is_narrow(natural) { most.min(ROWS * columns) } else { most }
    }
}

/// Selects at most `most` of `values`, evenly spaced, including the first and the last.
pub(crate) fn evenly_spaced<T: Clone>(values: Vec<T>, most: usize) -> Vec<T> {
    match most {
        _ if values.len() <= most => values,
        0 | 1 => values.into_iter().take(most).collect(),
        _ => (0..most).map(|k| values[k * (values.len() - 1) / (most - 1)].clone()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Paper, evenly_spaced};

    #[test]
    fn narrow_paper_has_fewer_columns_and_panels() {
        let wide = Paper::default();
        assert_eq!((wide.columns(5, 300.0, 120.0, 12.0), wide.panels(1000.0, 5, 15)), (5, 15));
        let column = Paper::of_width(85.0);
        assert!((column.width(1000.0) - 401.6).abs() < 0.1);
        assert_eq!((column.columns(5, 307.0, 120.0, 12.0), column.panels(1000.0, 2, 15)), (2, 4));
        assert_eq!(column.columns(5, 40.0, 120.0, 12.0), 1);
    }

    #[test]
    fn selected_values_include_both_ends() {
        let all: Vec<usize> = (1..=10).collect();
        assert_eq!(evenly_spaced(all.clone(), 4), [1, 4, 7, 10]);
        assert_eq!(evenly_spaced(all.clone(), 1), [1]);
        assert_eq!(evenly_spaced(all.clone(), 12), all);
    }
}

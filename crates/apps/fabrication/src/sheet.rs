//! Outlines for laser cutters: profiles of the scales, and a template for gluing them.

use crate::Patch;
use crate::patch::LENGTHS;

/// Distance between parts on a sheet, mm.
const SPACING: f64 = 2.0;

/// Width of the rim of the template around its holes, mm.
const RIM: f64 = 10.0;

/// Minimum width of the webs between the holes of a template, mm. Narrower webs burn away.
const LEAST_WEB: f64 = 0.2;

/// Side of the square for checking units after import, mm.
const CHECK: f64 = 100.0;

/// A closed outline on a layer; the last corner is joined to the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Name of the layer, which states its purpose.
    pub layer: &'static str,
    /// Corners, counter-clockwise, mm.
    pub corners: Vec<[f64; 2]>,
}

/// Outlines to cut, in millimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    outlines: Vec<Outline>,
    web: f64,
}

/// Errors of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SheetError {
    /// A length is out of range.
    #[error("{0} is {1} mm, expected a length from 0 to {high:e}", high = LENGTHS[1])]
    Length(&'static str, f64),
    /// The kerf is at least as wide as a hole.
    #[error("a kerf of {0} mm leaves no hole in the template, which needs holes of {1:.4} mm")]
    Kerf(f64, f64),
}

impl Sheet {
    /// Names of the layers, in the order of the outlines.
    pub const LAYERS: [&'static str; 3] = ["PROFILES", "GLUE_TEMPLATE", "CHECK_100_MM"];

    /// Creates the outlines of a patch.
    ///
    /// The laser removes a line of width `kerf`; `template` is the thickness of the template sheet.
    /// The kerf and the thickness are in mm.
    ///
    /// # Errors
    /// If a length is out of range, or the kerf is as wide as a hole.
    pub fn new(patch: &Patch, kerf: f64, template: f64) -> Result<Self, SheetError> {
        for (name, length) in [("the kerf", kerf), ("the thickness of the template", template)] {
            if !(0.0..=LENGTHS[1]).contains(&length) {
                return Err(SheetError::Length(name, length));
            }
        }
        // A slanted scale shifts along the row within the thickness of the template. A hole is
        // longer than the base by this shift.
        let lean = patch.shift() / patch.thickness() * template;
        let hole = [patch.base() + lean, patch.width()];
        let smallest = hole[0].min(hole[1]);
        if kerf >= smallest {
            return Err(SheetError::Kerf(kerf, smallest));
        }
        let [along, across] = patch.gaps();
        // Longer holes leave narrower webs along the row.
        let mut sheet = Self { outlines: Vec::new(), web: (along - lean).min(across) };
        let top = sheet.profiles(patch, kerf);
        let top = if sheet.has_template() { sheet.template(patch, hole, kerf, top) } else { top };
        // The outline of the square is not offset by the kerf, because the drawing itself is
        // measured.
        sheet.add(Self::LAYERS[2], rectangle([0.0, top + SPACING], [CHECK; 2], 0.0));
        Ok(sheet)
    }

    /// Returns the outlines.
    pub fn outlines(&self) -> &[Outline] {
        &self.outlines
    }

    /// Returns the width of the narrowest web of the template, mm; negative if holes overlap.
    pub fn web(&self) -> f64 {
        self.web
    }

    /// Returns true if the webs are wide enough, so that the sheet has a template.
    pub fn has_template(&self) -> bool {
        self.web >= LEAST_WEB
    }

    /// Returns the lowest and highest corner of the bounding box of all outlines.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let corners = self.outlines.iter().flat_map(|outline| &outline.corners);
        corners.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], at| {
            let lowest = std::array::from_fn(|k| low[k].min(at[k]));
            [lowest, std::array::from_fn(|k| high[k].max(at[k]))]
        })
    }

    fn add(&mut self, layer: &'static str, corners: [[f64; 2]; 4]) {
        self.outlines.push(Outline { layer, corners: corners.to_vec() });
    }

    /// Adds a profile for each scale, in rows as in the patch; returns a `y` above all profiles.
    fn profiles(&mut self, patch: &Patch, kerf: f64) -> f64 {
        // The laser removes half of the kerf from each side of the part, so the outline is larger.
        let profile = grown(patch.profile(), kerf / 2.0);
        // The facing sides of two parts are parallel and slanted. Their perpendicular distance is
        // the spacing.
        let slant = (patch.shift() / patch.thickness()).atan();
        let step = patch.base() + (SPACING + kerf) / slant.cos();
        let [nx, ny] = patch.scales();
        let row_step = patch.thickness() + kerf + SPACING;
        for (i, j) in (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))) {
            let offset = [i as f64 * step, j as f64 * row_step];
            self.add(Self::LAYERS[0], profile.map(|at| [at[0] + offset[0], at[1] + offset[1]]));
        }
        ny as f64 * row_step
    }

    /// Adds the template above y = `top`; returns a `y` above the template.
    ///
    /// `hole` contains length and width of a hole.
    fn template(&mut self, patch: &Patch, hole: [f64; 2], kerf: f64, top: f64) -> f64 {
        let [length, width, _] = patch.membrane_size();
        let size = [length + 2.0 * RIM, width + 2.0 * RIM];
        let origin = [0.0, top + SPACING];
        // Cut holes before the rim, because a part may shift once it is cut out.
        for [x, y] in patch.base_corners() {
            let corner = [origin[0] + RIM + x, origin[1] + RIM + y];
            self.add(Self::LAYERS[1], rectangle(corner, hole, -kerf / 2.0));
        }
        self.add(Self::LAYERS[1], rectangle(origin, size, kerf / 2.0));
        origin[1] + size[1] + kerf
    }
}

/// Returns a rectangle, given by lower left corner and size, with its sides moved outwards by `by`.
fn rectangle([x, y]: [f64; 2], [length, width]: [f64; 2], by: f64) -> [[f64; 2]; 4] {
    grown([[x, y], [x + length, y], [x + length, y + width], [x, y + width]], by)
}

/// Returns a parallelogram with its sides moved outwards by `by`.
fn grown(corners: [[f64; 2]; 4], by: f64) -> [[f64; 2]; 4] {
    let side = |from: usize| -> [f64; 2] {
        let (a, b) = (corners[from], corners[(from + 1) % 4]);
        let (u, v) = (b[0] - a[0], b[1] - a[1]);
        [u / u.hypot(v), v / u.hypot(v)]
    };
    std::array::from_fn(|k| {
        // Each new corner is at the distance `by` from both adjacent sides of the old corner.
        let (before, after) = (side((k + 3) % 4), side(k));
        let sine = before[0] * after[1] - before[1] * after[0];
        std::array::from_fn(|axis| corners[k][axis] + by * (before[axis] - after[axis]) / sine)
    })
}

#[cfg(test)]
mod tests {
    use geometry::{Parallelogram, Row};

    use super::*;
    use crate::patch::tests::patch;

    fn area(corners: &[[f64; 2]]) -> f64 {
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0).sum()
    }

    fn of(sheet: &Sheet, layer: usize) -> Vec<&Outline> {
        sheet.outlines.iter().filter(|outline| outline.layer == Sheet::LAYERS[layer]).collect()
    }

    #[test]
    fn cut_parts_and_holes_have_their_nominal_size() {
        let (patch, kerf) = (patch(), 0.15);
        let sheet = Sheet::new(&patch, kerf, 0.1).expect("a sheet");
        let [profiles, template] = [of(&sheet, 0), of(&sheet, 1)];
        assert_eq!((profiles.len(), template.len()), (20, 21));
        for profile in profiles {
            let corners: [_; 4] = profile.corners.clone().try_into().expect("4 corners");
            let part = grown(corners, -kerf / 2.0);
            assert!((area(&part) - patch.base() * patch.thickness()).abs() < 1e-12);
            assert!((part[1][0] - part[0][0] - patch.base()).abs() < 1e-12);
            let lean = (part[3][0] - part[0][0]) / (part[3][1] - part[0][1]);
            assert!((lean - 60.0_f64.to_radians().tan()).abs() < 1e-12);
        }
        let hole = &template[0].corners;
        let lean = 0.1 * 60.0_f64.to_radians().tan();
        assert!((hole[1][0] - hole[0][0] + kerf - patch.base() - lean).abs() < 1e-12);
        assert!((hole[2][1] - hole[1][1] + kerf - patch.width()).abs() < 1e-12);
        let pitch = template[1].corners[0][0] - hole[0][0];
        assert!((pitch - patch.pitches()[0]).abs() < 1e-12, "holes are at the pitch");
    }

    #[test]
    fn outlines_of_parts_are_separated_by_the_spacing() {
        let sheet = Sheet::new(&patch(), 0.15, 0.1).expect("a sheet");
        let profiles = of(&sheet, 0);
        let [first, second] = [profiles[0], profiles[1]].map(|outline| outline.corners.clone());
        let distance = (second[0][0] - first[1][0]) * 60.0_f64.to_radians().cos();
        assert!((distance - SPACING).abs() < 1e-12, "{distance}");
        let sixth = &profiles[5].corners;
        assert!((sixth[0][1] - first[2][1] - SPACING).abs() < 1e-12);
        let square = of(&sheet, 2);
        assert!((area(&square[0].corners) - 1e4).abs() < 1e-9);
        assert_eq!(square.len(), 1);
    }

    #[test]
    fn templates_with_too_narrow_webs_are_omitted() {
        let sheet = Sheet::new(&patch(), 0.15, 0.5).expect("a sheet");
        assert!(!sheet.has_template() && of(&sheet, 1).is_empty(), "{}", sheet.web());
        assert!((sheet.web() - (0.6 - 0.5 * 60.0_f64.to_radians().tan())).abs() < 1e-12);
    }

    #[test]
    fn negative_kerfs_and_kerfs_as_wide_as_a_hole_are_rejected() {
        let refused = |kerf| Sheet::new(&patch(), kerf, 0.0).unwrap_err();
        assert_eq!(refused(1.6), SheetError::Kerf(1.6, 1.6));
        assert_eq!(refused(-0.1), SheetError::Length("the kerf", -0.1));
        let row = Row::new(Parallelogram::new(0.4, 0.0).expect("a valid scale"), 0.3)
            .expect("a valid row");
        let upright = Patch::new(row, 2.0, [3.0, 0.25, 0.6], [1, 1]).expect("a valid patch");
        assert!(Sheet::new(&upright, 0.2, 5.0).expect("a sheet").has_template());
    }
}

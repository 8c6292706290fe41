//! Binary STL: one mesh of all solids.

use nalgebra::Vector3;

use crate::Patch;
use crate::mesh::triangles;

/// Length of the header, bytes.
///
/// The header must not begin with `solid`, because readers would treat the file as text.
const HEADER: usize = 80;

pub(crate) fn write(patch: &Patch) -> Vec<u8> {
    let mut header = b"squama skin, binary STL, lengths in mm".to_vec();
    header.resize(HEADER, b' ');
    let mut facets = Vec::new();
    let mut count: u32 = 0;
    for prism in patch.solids().all() {
        // Round the corners before computing normals, so that the normals fit the written corners.
        let corners = prism.corners().into_iter();
        let corners: Vec<_> =
            corners.map(|corner| Vector3::from(corner).map(|at| at as f32)).collect();
        for triangle in triangles(prism) {
            let [a, b, c] = triangle.map(|k| corners[k]);
            let [u, v] = [b, c].map(|to| (to - a).map(f64::from));
            // Rounding may reduce a facet to a line, which has no normal. The normal is then
            // written as zero, and readers compute it themselves.
            let normal = u.cross(&v).try_normalize(0.0).unwrap_or_default().map(|part| part as f32);
            for value in [normal, a, b, c].iter().flatten() {
                facets.extend(value.to_le_bytes());
            }
            // Each facet ends with two attribute bytes, which are unused.
            facets.extend([0, 0]);
            count += 1;
        }
    }
    [header, count.to_le_bytes().to_vec(), facets].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::tests::patch;

    #[test]
    fn each_solid_has_twelve_facets_of_fifty_bytes() {
        let file = write(&patch());
        assert_eq!(file.len(), 84 + 21 * 12 * 50);
        assert_eq!(file[80..84], (21_u32 * 12).to_le_bytes());
        let front: Vec<_> = file[84..96]
            .chunks(4)
            .map(|bytes| f32::from_le_bytes(bytes.try_into().expect("4 bytes")))
            .collect();
        assert_eq!(front, [0.0, -1.0, 0.0], "the first normal points towards negative y");
    }
}

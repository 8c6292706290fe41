//! Binary STL.

use crate::Patch;
use crate::mesh::triangles;

/// Bytes of the header, which must not begin with `solid`: readers would take the file for text.
const HEADER: usize = 80;

pub(crate) fn write(patch: &Patch) -> Vec<u8> {
    let mut header = b"squama skin, binary STL, lengths in mm".to_vec();
    header.resize(HEADER, b' ');
    let mut facets = Vec::new();
    let mut count: u32 = 0;
    for prism in patch.scale_prisms().chain([patch.membrane()]) {
        // Rounded before normals are taken: equal corners stay equal, so the mesh stays closed.
        let corners = prism.corners().map(|corner| corner.map(|length| length as f32));
        for triangle in triangles() {
            let [a, b, c] = triangle.map(|k| corners[k]);
            for value in [normal([a, b, c]), a, b, c].concat() {
                facets.extend(value.to_le_bytes());
            }
            // The format ends each facet with two bytes of attributes, of which none are defined.
            facets.extend([0, 0]);
            count += 1;
        }
    }
    [header, count.to_le_bytes().to_vec(), facets].concat()
}

/// The unit normal of a triangle, outwards.
fn normal([a, b, c]: [[f32; 3]; 3]) -> [f32; 3] {
    let edge = |to: [f32; 3]| -> [f64; 3] { std::array::from_fn(|k| f64::from(to[k] - a[k])) };
    let (u, v) = (edge(b), edge(c));
    let cross: [f64; 3] = std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        u[i] * v[j] - u[j] * v[i]
    });
    let size = cross.iter().map(|part| part * part).sum::<f64>().sqrt();
    cross.map(|part| (part / size) as f32)
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
            .map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four")))
            .collect();
        assert_eq!(front, [0.0, -1.0, 0.0], "the first face looks to the front");
    }
}

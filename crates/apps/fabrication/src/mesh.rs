//! Triangles of prisms.

use crate::Prism;

/// Returns the triangles of a prism as corner indices, counter-clockwise seen from outside.
pub(crate) fn triangles(prism: &Prism) -> impl Iterator<Item = [usize; 3]> {
    prism.faces().into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
}

/// Returns the volume that triangles enclose; each triangle is given by three indices of `corners`.
#[cfg(test)]
pub(crate) fn volume(corners: &[[f64; 3]], triangles: impl Iterator<Item = [usize; 3]>) -> f64 {
    let product = |[a, b, c]: [[f64; 3]; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    triangles.map(|triangle| product(triangle.map(|k| corners[k]))).sum::<f64>() / 6.0
}

#[cfg(test)]
mod tests {
    use geometry::Body;

    use super::*;
    use crate::patch::tests::patch;

    #[test]
    fn prisms_are_closed_and_oriented_outwards() {
        let curved = [10.0, -40.0].map(|radius| Body { curvature: 2.0 / radius });
        let curved = curved.map(|body| patch().brick_laid().on_body(body).expect("a valid patch"));
        for patch in [patch()].into_iter().chain(curved) {
            let solids = patch.solids();
            for prism in solids.all() {
                let edges: Vec<_> =
                    triangles(prism).flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
                for [from, to] in &edges {
                    // Each edge occurs once in each direction, so the surface is closed.
                    assert_eq!(edges.iter().filter(|edge| **edge == [*from, *to]).count(), 1);
                    assert_eq!(edges.iter().filter(|edge| **edge == [*to, *from]).count(), 1);
                }
            }
            for scale in &solids.scales {
                let enclosed = volume(&scale.corners(), triangles(scale));
                assert!((enclosed / patch.scale_volume() - 1.0).abs() < 1e-12, "{enclosed}");
            }
            // `length` is the length of the upper face. Below this face the membrane is shorter on
            // a convex body and longer on a concave body.
            let [length, width, h] = patch.membrane_size();
            let mean = patch.radius().map_or(1.0, |radius| 1.0 - 0.5 * h / radius);
            let enclosed: f64 =
                solids.membrane.iter().map(|part| volume(&part.corners(), triangles(part))).sum();
            let ratio = enclosed / (length * width * h * mean);
            assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
        }
    }
}

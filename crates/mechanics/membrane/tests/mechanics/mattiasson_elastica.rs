//! Comparison of a cantilever under a tip load with [`analytical::elastica`].

use analytical::elastica;
use geometry::OutOfRange;
use nalgebra::Vector3;

use crate::cantilever::{cantilever, equilibrium};

/// Thickness at which the axial strain changes the tip displacement by only about 1e-8.
const INEXTENSIBLE: f64 = 1e-4;

/// Computes deflection, shortening and rotation of the tip of a cantilever of beam elements.
fn computed(load: f64, elements: usize, thickness: f64) -> Result<Vector3<f64>, OutOfRange> {
    let gap = cantilever(elements, thickness)?;
    let u = equilibrium(&gap, Vector3::new(0.0, load, 0.0), 20);
    let tip = u.fixed_rows::<3>(3 * elements);
    Ok(Vector3::new(tip[1], -tip[0], tip[2]))
}

/// Compares two meshes with the closed form for ten loads.
///
/// If the length of the elements is halved, the error decreases by a factor of 4. Extrapolation
/// from both meshes leaves a far smaller error.
#[test]
fn tip_displacements_converge_quadratically_to_the_closed_form() -> Result<(), OutOfRange> {
    for load in (1..=10).map(f64::from) {
        let exact = Vector3::from(elastica::tip(load).values());
        let coarse = computed(load, 32, INEXTENSIBLE)? - exact;
        let fine = computed(load, 64, INEXTENSIBLE)? - exact;
        let order = (coarse.norm() / fine.norm()).log2();
        let extrapolated = (fine - (coarse - fine) / 3.0).amax();
        assert!((order - 2.0).abs() < 0.003, "PL²/EI = {load}: order {order}");
        assert!(fine.amax() < 4e-5, "PL²/EI = {load}: {fine}");
        assert!(extrapolated < 1e-7, "PL²/EI = {load}: {extrapolated:e}");
    }
    Ok(())
}

#[test]
fn the_effect_of_axial_strain_falls_with_the_square_of_the_thickness() -> Result<(), OutOfRange> {
    let limit = computed(5.0, 8, INEXTENSIBLE)?;
    let [thick, thin] = [computed(5.0, 8, 0.02)?, computed(5.0, 8, 0.01)?];
    for i in 0..3 {
        let order = ((thick[i] - limit[i]) / (thin[i] - limit[i])).log2();
        assert!((order - 2.0).abs() < 0.01, "quantity {i}: order {order}");
    }
    Ok(())
}

//! The tangents of the problems agree with differences of their residuals.

use approx::assert_relative_eq;
use solver::{BandMatrix, Residual, State, System};

use crate::problems::{
    Bratu, StringOverFloor, arch, arch_on_spring, bump, circle, corner, kink, parabola, root, step,
};

fn check(system: &impl System, z: &[f64]) {
    let active = vec![true; system.constraints().len()];
    let mut matrix = BandMatrix::new(system.size(), system.half_bandwidth());
    system.tangent(z, &active, &mut matrix);
    let h = 1e-6;
    for column in 0..system.size() {
        let at = |step: f64| {
            let mut z = z.to_vec();
            z[column] += step;
            let mut residual = Residual::new(system.size());
            system.residual(&z, &active, &mut residual);
            residual.value
        };
        let (high, low) = (at(h), at(-h));
        for row in (0..system.size()).filter(|&row| row != system.load()) {
            let difference = (high[row] - low[row]) / (2.0 * h);
            assert_relative_eq!(
                matrix.get(row, column),
                difference,
                epsilon = 1e-8,
                max_relative = 1e-7
            );
        }
        for (number, &index) in system.constraints().iter().enumerate() {
            let state = State { z: z.to_vec(), active: active.clone() };
            let mut direction = vec![0.0; system.size()];
            direction[column] = 1.0;
            let slope = system.slope(&state, number, &direction);
            assert_relative_eq!(
                matrix.get(index, column),
                slope,
                epsilon = 1e-8,
                max_relative = 1e-7
            );
        }
    }
}

#[test]
fn tangents_are_derivatives() {
    check(&arch(), &[0.3, 0.2]);
    check(&arch_on_spring(), &[0.3, 0.4, 0.2]);
    check(&circle(), &[0.3, 0.4]);
    check(&step(), &[0.5, 0.2]);
    check(&parabola(), &[0.5, 0.2]);
    check(&root(), &[0.2, 0.2]);
    check(&bump(), &[1.3, 0.4, 0.2]);
    check(&corner(), &[1.3, 0.4, 0.2]);
    check(&kink::<5>(), &[1.3, 0.4, 0.2]);
    check(&Bratu::new(6), &[0.1, 0.2, 0.3, 0.4, 0.5, 1.5]);
    let string = StringOverFloor::halved(6, 1.0);
    check(&string, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
}

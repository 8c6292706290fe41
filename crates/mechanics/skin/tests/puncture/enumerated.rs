//! Compares pairs of scales with friction with an enumeration of contact patterns.
//!
//! A pattern is a combination of open, sticking and slipping contacts. In each small step of the
//! tilt the reference solver tries all patterns until one of them satisfies all its conditions. If
//! slip starts or stops within a step, the stick position is wrong by a fraction of the step, so
//! forces converge with decreasing step size.

use nalgebra::{DMatrix, DVector, Vector2};
use skin::puncture::{At, PunctureParameters, snapshots};
use skin::{Base, Common, Design};
use substrate::{Calibrations, Springs};

use crate::samples::{design, on_row, springs};

type V = Vector2<f64>;

/// State of a contact in a pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ContactState {
    Open,
    Stick,
    /// Slips; the value is the sign of the slip rate.
    Slip(f64),
    /// Closed, but another contact, which sticks, carries the friction of both contacts.
    ///
    /// While two contacts on parallel edges stick, only the sum of their friction is determined.
    CarriedByOther,
}

const STATES: [ContactState; 5] = [
    ContactState::Open,
    ContactState::Stick,
    ContactState::Slip(1.0),
    ContactState::Slip(-1.0),
    ContactState::CarriedByOther,
];

/// A contact between a corner of one scale and an edge of the other scale.
struct CornerOnEdge {
    /// Scale with the corner, and position of the corner relative to its node.
    corner: (usize, V),
    /// Scale with the edge, and position of the lower end of the edge relative to its node.
    edge: (usize, V),
    /// Outward normal of the edge at rest.
    normal: V,
    /// Direction of the edge at rest, upward.
    tangent: V,
}

/// Two scales on springs; the left scale is loaded.
struct Pair {
    stiffness: DMatrix<f64>,
    /// Position of the loaded corner relative to the node.
    arm: V,
    pitch: f64,
    contacts: Vec<CornerOnEdge>,
    /// Constants `λ₀`, `L` and `C₂` of the contact law.
    law: [f64; 3],
    friction: f64,
}

/// Unknowns: displacements and rotations of both scales, load, `λ` and `T` of each contact.
type Unknowns = DVector<f64>;

/// Index of the load among the unknowns.
const LOAD: usize = 6;

fn turned(by: f64, v: V) -> V {
    let (sin, cos) = by.sin_cos();
    V::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

fn quarter(v: V) -> V {
    V::new(-v.y, v.x)
}

impl Pair {
    fn new(
        design: &Design,
        springs: &Springs,
        parameters: &PunctureParameters,
        common: &Common,
    ) -> Self {
        let (a, shift) = (design.half_base(), design.slant_deg.to_radians().tan());
        let mut stiffness = DMatrix::zeros(6, 6);
        for k in 0..3 {
            let length = if k == 2 { a.powi(3) } else { a };
            for scale in 0..2 {
                stiffness[(3 * scale + k, 3 * scale + k)] = length * springs.direct[k];
                stiffness[(3 * scale + k, 3 * (1 - scale) + k)] = -length * springs.coupling[k];
            }
        }
        let (bottom, top) =
            ([V::new(-a, 0.0), V::new(a, 0.0)], [V::new(shift - a, 1.0), V::new(shift + a, 1.0)]);
        let up = V::new(shift, 1.0).normalize();
        // Outward normals: the right edge of the left scale faces right, the left edge of the right
        // scale faces left.
        let (right, left) = (-quarter(up), quarter(up));
        let contacts = [
            ((0, top[1]), (1, bottom[0]), left),
            ((1, top[0]), (0, bottom[1]), right),
            ((1, bottom[0]), (0, bottom[1]), right),
            ((0, bottom[1]), (1, bottom[0]), left),
        ];
        let contacts = contacts
            .map(|(corner, edge, normal)| CornerOnEdge { corner, edge, normal, tangent: up })
            .into();
        let modulus =
            parameters.contact_modulus_over_substrate * (1.0 - parameters.poisson_ratio.powi(2));
        let law =
            [common.law.c1 * design.length * design.width * modulus, design.length, common.law.c2];
        let pitch = 2.0 * a + design.gap;
        Self { stiffness, arm: top[1], pitch, contacts, law, friction: common.friction }
    }

    fn position(&self, z: &Unknowns, (scale, arm): (usize, V)) -> V {
        V::new(scale as f64 * self.pitch + z[3 * scale], z[3 * scale + 1])
            + turned(z[3 * scale + 2], arm)
    }

    /// Computes `(P − E)·v` and its derivatives with respect to the displacements.
    ///
    /// `P` is the corner, `E` the end of the edge, and `v` the deformed `direction`: the normal of
    /// the edge gives the gap, its tangent the slip coordinate.
    fn along(&self, z: &Unknowns, contact: &CornerOnEdge, direction: V) -> (f64, DVector<f64>) {
        let (corner, edge) = (contact.corner, contact.edge);
        let v = turned(z[3 * edge.0 + 2], direction);
        let between = self.position(z, corner) - self.position(z, edge);
        let mut slopes = DVector::zeros(6);
        for ((scale, arm), sign) in [(corner, 1.0), (edge, -1.0)] {
            let turning = quarter(turned(z[3 * scale + 2], arm));
            slopes[3 * scale] += sign * v.x;
            slopes[3 * scale + 1] += sign * v.y;
            slopes[3 * scale + 2] += sign * turning.dot(&v);
        }
        slopes[3 * edge.0 + 2] += between.dot(&quarter(v));
        (between.dot(&v), slopes)
    }

    fn slip(&self, z: &Unknowns, contact: usize) -> f64 {
        let contact = &self.contacts[contact];
        self.along(z, contact, contact.tangent).0
    }

    fn approach(&self, force: f64) -> f64 {
        let [unit, length, exponent] = self.law;
        length * (force / unit).abs().powf(1.0 / exponent).copysign(force)
    }

    fn residual(
        &self,
        z: &Unknowns,
        tilt: f64,
        states: &[ContactState],
        anchors: &[f64],
    ) -> DVector<f64> {
        let mut r = DVector::zeros(z.len());
        let mut balance = &self.stiffness * z.rows(0, 6);
        let arm = turned(z[2], self.arm);
        balance[1] += z[LOAD];
        balance[2] += arm.x * z[LOAD];
        for (k, (contact, state)) in self.contacts.iter().zip(states).enumerate() {
            let (at, traction) = (LOAD + 1 + 2 * k, LOAD + 2 + 2 * k);
            let (gap, by_gap) = self.along(z, contact, contact.normal);
            let (slip, by_slip) = self.along(z, contact, contact.tangent);
            if *state == ContactState::Open {
                (r[at], r[traction]) = (z[at], z[traction]);
                continue;
            }
            balance -= by_gap * z[at] + by_slip * z[traction];
            r[at] = gap + self.approach(z[at]);
            r[traction] = match state {
                ContactState::Slip(sign) => z[traction] + sign * self.friction * z[at],
                ContactState::CarriedByOther => z[traction],
                _ => slip - anchors[k],
            };
        }
        r.rows_mut(0, 6).copy_from(&balance);
        r[LOAD] = z[2] + tilt;
        r
    }

    fn solve(
        &self,
        from: &Unknowns,
        tilt: f64,
        states: &[ContactState],
        anchors: &[f64],
    ) -> Option<Unknowns> {
        let mut z = from.clone();
        for _ in 0..30 {
            let r = self.residual(&z, tilt, states, anchors);
            if r.amax() < 1e-12 {
                return Some(z);
            }
            let columns: Vec<_> = (0..z.len())
                .map(|k| {
                    let [low, high] = [-1e-6, 1e-6].map(|by| {
                        let mut moved = z.clone();
                        moved[k] += by;
                        self.residual(&moved, tilt, states, anchors)
                    });
                    (high - low) / 2e-6
                })
                .collect();
            z -= DMatrix::from_columns(&columns).lu().solve(&r)?;
        }
        None
    }

    /// Returns true if the state `to`, solved for a pattern, satisfies all conditions of this
    /// pattern.
    ///
    /// `from` is the state at the previous tilt.
    fn satisfies(&self, from: &Unknowns, to: &Unknowns, states: &[ContactState]) -> bool {
        let shared_force =
            states.iter().enumerate().filter(|(_, state)| **state == ContactState::CarriedByOther);
        let shared_force: f64 = shared_force.map(|(k, _)| to[LOAD + 1 + 2 * k]).sum();
        states.iter().enumerate().all(|(k, state)| {
            let contact = &self.contacts[k];
            let (push, traction) = (to[LOAD + 1 + 2 * k], to[LOAD + 2 + 2 * k]);
            let (slip, before) = (self.slip(to, k), self.slip(from, k));
            let is_on_edge = slip > 0.0 && slip < contact.tangent.y.recip();
            match state {
                ContactState::Open => {
                    !is_on_edge || self.along(to, contact, contact.normal).0 >= 0.0
                }
                ContactState::Stick => {
                    let normal_force = push + shared_force;
                    push >= 0.0 && is_on_edge && traction.abs() <= self.friction * normal_force
                }
                ContactState::CarriedByOther => {
                    push >= 0.0 && is_on_edge && states.contains(&ContactState::Stick)
                }
                ContactState::Slip(sign) => {
                    push >= 0.0 && is_on_edge && sign * (slip - before) >= 0.0
                }
            }
        })
    }

    /// Computes the load at the given `tilts`, and the sequence of patterns.
    fn loads(&self, tilts: &[f64], steps: usize) -> (Vec<f64>, Vec<Vec<ContactState>>) {
        let count = self.contacts.len();
        let mut z = Unknowns::zeros(LOAD + 1 + 2 * count);
        let mut states = vec![ContactState::Open; count];
        let (mut loads, mut seen) = (Vec::new(), vec![states.clone()]);
        let end = *tilts.last().unwrap();
        for step in 1..=steps {
            let tilt = end * step as f64 / steps as f64;
            let anchors: Vec<_> = (0..count).map(|k| self.slip(&z, k)).collect();
            let patterns = (0..STATES.len().pow(count as u32)).map(|number| {
                let digits = (0..count).map(|k| number / STATES.len().pow(k as u32) % STATES.len());
                digits.map(|digit| STATES[digit]).collect()
            });
            let found = std::iter::once(states.clone()).chain(patterns).find_map(|pattern| {
                let to = self.solve(&z, tilt, &pattern, &anchors)?;
                self.satisfies(&z, &to, &pattern).then_some((to, pattern))
            });
            let (to, pattern) = found.unwrap_or_else(|| panic!("no pattern at {tilt}: {states:?}"));
            if pattern != states {
                seen.push(pattern.clone());
            }
            (z, states) = (to, pattern);
            if tilts.iter().any(|at| (at - tilt).abs() < 1e-9) {
                loads.push(z[LOAD]);
            }
        }
        (loads, seen)
    }
}

/// Compares the loads with the loads of the skin solver.
///
/// Returns the largest relative difference, and the sequence of patterns.
fn difference(design: &Design, friction: f64, steps: usize) -> (f64, Vec<Vec<ContactState>>) {
    let parameters = on_row(2);
    let common = Common { friction, ..Common::default() };
    let springs = springs(design, &parameters, &Calibrations::default());
    let tilts = [2.0, 4.0, 6.0, 8.0, 10.0];
    let ours = snapshots(design, &springs, &common, &parameters, &tilts.map(At::Tilt)).unwrap();
    let pair = Pair::new(design, &springs, &parameters, &common);
    let (loads, seen) = pair.loads(&tilts.map(f64::to_radians), steps);
    assert_eq!(loads.len(), tilts.len());
    let off =
        ours.at.iter().zip(&loads).map(|(state, load)| {
            (state.as_ref().unwrap().force * design.length / load - 1.0).abs()
        });
    let off = off.fold(0.0, f64::max);
    println!("{design:?} friction {friction}: {off:e}, {seen:?}");
    (off, seen)
}

fn closed(seen: &[Vec<ContactState>]) -> usize {
    seen.iter()
        .map(|pattern| pattern.iter().filter(|s| **s != ContactState::Open).count())
        .max()
        .unwrap()
}

fn sticks(seen: &[Vec<ContactState>]) -> bool {
    seen.iter().flatten().any(|state| *state == ContactState::Stick)
}

#[test]
fn slipping_contacts_match_enumerated_patterns() {
    for (gap, length, slant_deg, friction, contacts) in [
        (0.1, 1.0, 0.0, 0.0, 1),
        (0.1, 1.0, 0.0, 0.3, 1),
        (0.1, 1.0, 0.0, 1.5, 1),
        (0.2, 1.5, 30.0, 0.6, 1),
        (0.1, 1.0, 45.0, 0.1, 2),
        (0.1, 0.5, 60.0, 0.3, 2),
        (0.05, 0.7, 30.0, 0.4, 2),
    ] {
        let (off, seen) = difference(&design(gap, length, slant_deg, Base::L), friction, 500);
        assert!(off < 1e-10, "{off:e}");
        assert_eq!((closed(&seen), sticks(&seen)), (contacts, false));
    }
}

#[test]
fn sticking_contacts_match_enumerated_patterns() {
    for (gap, length, slant_deg, friction) in [
        (0.05, 1.0, 60.0, 0.5),
        (0.1, 1.0, 65.0, 0.4),
        (0.2, 2.0, 65.0, 0.5),
        (0.3, 1.0, 70.0, 0.4),
    ] {
        let (off, seen) = difference(&design(gap, length, slant_deg, Base::L), friction, 4000);
        assert!(off < 4e-5, "{off:e}");
        assert!(sticks(&seen));
    }
}

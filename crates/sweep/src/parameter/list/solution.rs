//! How a skin is solved, and of what it is made: scatter, the settings of the solver, the material.

use super::{FRACTION, POSITIVE, of};
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{Count, Number, OptionalNumber};
use crate::parameter::Role::Made;
use crate::parameter::{CountRange, Parameter, Range, key};

const IMPERFECTION: Parameter = of("imperfection");
const SOLVER: Parameter = of("solver");
const MATERIAL: Parameter = of("material");

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        key: "gap_cv",
        meaning: "coefficient of variation of the gaps of imperfect rows",
        kind: Number { range: Range::closed(0.0, 1.0), field: |c| &mut c.imperfection.gap_cv },
        ..IMPERFECTION
    },
    Parameter {
        key: "slant_sd_deg",
        unit: "deg",
        meaning: "standard deviation of the slants of imperfect rows",
        kind: Number {
            range: Range::closed(0.0, 30.0),
            field: |c| &mut c.imperfection.slant_sd_deg,
        },
        ..IMPERFECTION
    },
    Parameter {
        key: "samples",
        meaning: "imperfect rows that are solved, if gaps or slants scatter",
        kind: Count {
            range: CountRange { low: 1, high: 1_000_000 },
            field: |c| &mut c.samples.count,
        },
        ..IMPERFECTION
    },
    Parameter {
        key: "seed",
        meaning: "seed of the random gaps and slants",
        kind: Count {
            range: CountRange { low: 0, high: 1_000_000_000 },
            field: |c| &mut c.samples.seed,
        },
        ..IMPERFECTION
    },
    Parameter {
        key: "first_step",
        meaning: "first step, as a fraction of the whole path",
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.first_step },
        ..SOLVER
    },
    Parameter {
        key: "max_step",
        meaning: "largest step, as a fraction of the whole path",
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.max_step },
        ..SOLVER
    },
    Parameter {
        key: "min_step",
        meaning: "smallest step, as a fraction of the whole path, below which the path stops",
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.min_step },
        ..SOLVER
    },
    Parameter {
        key: "tolerance",
        meaning: "largest scaled residual of an equilibrium",
        kind: Number {
            range: Range { low: Excluded(0.0), high: Included(0.01) },
            field: |c| &mut c.common.solver.tolerance,
        },
        ..SOLVER
    },
    Parameter {
        key: "max_iterations",
        meaning: "Newton iterations after which a step is cut to a third",
        kind: Count {
            range: CountRange { low: 1, high: 1000 },
            field: |c| &mut c.common.solver.max_iterations,
        },
        ..SOLVER
    },
    Parameter {
        key: "max_points",
        meaning: "equilibria after which the path stops",
        kind: Count {
            range: CountRange { low: 2, high: 1_000_000_000 },
            field: |c| &mut c.common.solver.max_points,
        },
        ..SOLVER
    },
    Parameter {
        key: key::THICKNESS,
        unit: "mm",
        meaning: "thickness t of the scales",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.thickness_mm },
        ..MATERIAL
    },
    Parameter {
        key: key::SUBSTRATE_MODULUS,
        unit: "MPa",
        meaning: "modulus E_s of the substrate",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.substrate_modulus_mpa },
        ..MATERIAL
    },
    Parameter {
        key: key::MEMBRANE_MODULUS,
        unit: "MPa",
        meaning: "modulus E_m of the membrane",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.membrane_modulus_mpa },
        ..MATERIAL
    },
    Parameter {
        key: key::SCALE_MODULUS,
        unit: "MPa",
        meaning: "modulus E_ct of the scales in contact, in the place of its ratios to the other two",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.scale_modulus_mpa },
        ..MATERIAL
    },
    Parameter {
        key: key::DENSITY,
        unit: "kg/m^3",
        meaning: "density of the scales",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.scale_density_kg_m3 },
        ..MATERIAL
    },
];

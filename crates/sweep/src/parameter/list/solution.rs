//! How a skin is solved, and of what it is made: scatter, the settings of the solver, the material.

use super::{FRACTION, POSITIVE};
use crate::parameter::Bound::{Excluded, Included};
use crate::parameter::ParameterKind::{Count, Number, OptionalNumber};
use crate::parameter::Role::Made;
use crate::parameter::{CountRange, Parameter, Range, key};

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        key: "gap_cv",
        section: "imperfection",
        unit: "-",
        meaning: "coefficient of variation of the gaps of imperfect rows",
        roles: &[],
        kind: Number { range: Range::closed(0.0, 1.0), field: |c| &mut c.imperfection.gap_cv },
    },
    Parameter {
        key: "slant_sd_deg",
        section: "imperfection",
        unit: "deg",
        meaning: "standard deviation of the slants of imperfect rows",
        roles: &[],
        kind: Number {
            range: Range::closed(0.0, 30.0),
            field: |c| &mut c.imperfection.slant_sd_deg,
        },
    },
    Parameter {
        key: "samples",
        section: "imperfection",
        unit: "-",
        meaning: "imperfect rows that are solved, if gaps or slants scatter",
        roles: &[],
        kind: Count {
            range: CountRange { low: 1, high: 1_000_000 },
            field: |c| &mut c.samples.count,
        },
    },
    Parameter {
        key: "seed",
        section: "imperfection",
        unit: "-",
        meaning: "seed of the random gaps and slants",
        roles: &[],
        kind: Count {
            range: CountRange { low: 0, high: 1_000_000_000 },
            field: |c| &mut c.samples.seed,
        },
    },
    Parameter {
        key: "first_step",
        section: "solver",
        unit: "-",
        meaning: "first step, as a fraction of the whole path",
        roles: &[],
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.first_step },
    },
    Parameter {
        key: "max_step",
        section: "solver",
        unit: "-",
        meaning: "largest step, as a fraction of the whole path",
        roles: &[],
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.max_step },
    },
    Parameter {
        key: "min_step",
        section: "solver",
        unit: "-",
        meaning: "smallest step, as a fraction of the whole path, below which the path stops",
        roles: &[],
        kind: Number { range: FRACTION, field: |c| &mut c.common.solver.min_step },
    },
    Parameter {
        key: "tolerance",
        section: "solver",
        unit: "-",
        meaning: "largest scaled residual of an equilibrium",
        roles: &[],
        kind: Number {
            range: Range { low: Excluded(0.0), high: Included(0.01) },
            field: |c| &mut c.common.solver.tolerance,
        },
    },
    Parameter {
        key: "max_iterations",
        section: "solver",
        unit: "-",
        meaning: "Newton iterations after which a step is cut to a third",
        roles: &[],
        kind: Count {
            range: CountRange { low: 1, high: 1000 },
            field: |c| &mut c.common.solver.max_iterations,
        },
    },
    Parameter {
        key: "max_points",
        section: "solver",
        unit: "-",
        meaning: "equilibria after which the path stops",
        roles: &[],
        kind: Count {
            range: CountRange { low: 2, high: 1_000_000_000 },
            field: |c| &mut c.common.solver.max_points,
        },
    },
    Parameter {
        key: key::THICKNESS,
        section: "material",
        unit: "mm",
        meaning: "thickness t of the scales",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.thickness_mm },
    },
    Parameter {
        key: key::SUBSTRATE_MODULUS,
        section: "material",
        unit: "MPa",
        meaning: "modulus E_s of the substrate",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.substrate_modulus_mpa },
    },
    Parameter {
        key: key::MEMBRANE_MODULUS,
        section: "material",
        unit: "MPa",
        meaning: "modulus E_m of the membrane",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.membrane_modulus_mpa },
    },
    Parameter {
        key: key::SCALE_MODULUS,
        section: "material",
        unit: "MPa",
        meaning: "modulus E_ct of the scales in contact, in the place of its ratios to the other two",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.scale_modulus_mpa },
    },
    Parameter {
        key: key::DENSITY,
        section: "material",
        unit: "kg/m^3",
        meaning: "density of the scales",
        roles: &[Made],
        kind: OptionalNumber { range: POSITIVE, field: |c| &mut c.material.scale_density_kg_m3 },
    },
];

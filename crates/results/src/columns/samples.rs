//! What imperfect samples give: columns of the tables of a run that has imperfections.

use super::Value;

const FORCE: &[&str] = &["critical_force"];
const DEPTH: &[&str] = &["penetration"];
const BOTH: &[&str] = &["critical_force", "penetration"];
const COMPLIANCE: &[&str] = &["compliance"];

/// Every value, in the order of `designs.csv`.
pub(super) static SPREADS: &[Value] = &[
    Value {
        tables: FORCE,
        name: "critical_force_mean",
        unit: "E_s L t/(1-nu^2)",
        meaning: "mean of the critical force over the imperfect samples",
        cell: |r| r.spreads.critical_force.map(|s| s.mean).into(),
    },
    Value {
        tables: FORCE,
        name: "critical_force_p05",
        unit: "E_s L t/(1-nu^2)",
        meaning: "5 % quantile of the critical force over the imperfect samples",
        cell: |r| r.spreads.critical_force.map(|s| s.quantiles[0]).into(),
    },
    Value {
        tables: FORCE,
        name: "critical_force_p50",
        unit: "E_s L t/(1-nu^2)",
        meaning: "median of the critical force over the imperfect samples",
        cell: |r| r.spreads.critical_force.map(|s| s.quantiles[1]).into(),
    },
    Value {
        tables: FORCE,
        name: "critical_force_p95",
        unit: "E_s L t/(1-nu^2)",
        meaning: "95 % quantile of the critical force over the imperfect samples",
        cell: |r| r.spreads.critical_force.map(|s| s.quantiles[2]).into(),
    },
    Value {
        tables: DEPTH,
        name: "penetration_mean",
        unit: "t",
        meaning: "mean of the penetration over the imperfect samples",
        cell: |r| r.spreads.penetration.map(|s| s.mean).into(),
    },
    Value {
        tables: DEPTH,
        name: "penetration_p05",
        unit: "t",
        meaning: "5 % quantile of the penetration over the imperfect samples",
        cell: |r| r.spreads.penetration.map(|s| s.quantiles[0]).into(),
    },
    Value {
        tables: DEPTH,
        name: "penetration_p50",
        unit: "t",
        meaning: "median of the penetration over the imperfect samples",
        cell: |r| r.spreads.penetration.map(|s| s.quantiles[1]).into(),
    },
    Value {
        tables: DEPTH,
        name: "penetration_p95",
        unit: "t",
        meaning: "95 % quantile of the penetration over the imperfect samples",
        cell: |r| r.spreads.penetration.map(|s| s.quantiles[2]).into(),
    },
    Value {
        tables: BOTH,
        name: "puncture_samples_failed",
        unit: "-",
        meaning: "imperfect samples whose puncture has no values, left out of mean and quantiles",
        cell: |r| r.spreads.puncture_failed.into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "compliance_mean",
        unit: "1/(E_m I_m)",
        meaning: "mean of the flexural compliance over the imperfect samples",
        cell: |r| r.spreads.compliance.map(|s| s.mean).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "compliance_p05",
        unit: "1/(E_m I_m)",
        meaning: "5 % quantile of the flexural compliance over the imperfect samples",
        cell: |r| r.spreads.compliance.map(|s| s.quantiles[0]).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "compliance_p50",
        unit: "1/(E_m I_m)",
        meaning: "median of the flexural compliance over the imperfect samples",
        cell: |r| r.spreads.compliance.map(|s| s.quantiles[1]).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "compliance_p95",
        unit: "1/(E_m I_m)",
        meaning: "95 % quantile of the flexural compliance over the imperfect samples",
        cell: |r| r.spreads.compliance.map(|s| s.quantiles[2]).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "closing_range_mean",
        unit: "1/t",
        meaning: "mean of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.spreads.closing_range.map(|s| s.mean).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "closing_range_p05",
        unit: "1/t",
        meaning: "5 % quantile of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.spreads.closing_range.map(|s| s.quantiles[0]).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "closing_range_p50",
        unit: "1/t",
        meaning: "median of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.spreads.closing_range.map(|s| s.quantiles[1]).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "closing_range_p95",
        unit: "1/t",
        meaning: "95 % quantile of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.spreads.closing_range.map(|s| s.quantiles[2]).into(),
    },
    Value {
        tables: COMPLIANCE,
        name: "flexure_samples_failed",
        unit: "-",
        meaning: "imperfect samples whose bending has no values, left out of mean and quantiles",
        cell: |r| r.spreads.flexure_failed.into(),
    },
];

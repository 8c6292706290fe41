//! The columns of the statistics of imperfect samples, in runs that have imperfections.

use super::measured_value::MeasuredValue;

const FORCE: &[&str] = &["critical_force"];
const DEPTH: &[&str] = &["penetration"];
const BOTH: &[&str] = &["critical_force", "penetration"];
const COMPLIANCE: &[&str] = &["compliance"];

/// Every value, in the order of `designs.csv`.
pub(super) static SAMPLE_VALUES: &[MeasuredValue] = &[
    MeasuredValue {
        tables: FORCE,
        name: "critical_force_mean",
        unit: "E_s L t/(1-nu^2)",
        meaning: "mean of the critical force over the imperfect samples",
        cell: |r| r.result.samples.critical_force.map(|s| s.mean).into(),
    },
    MeasuredValue {
        tables: FORCE,
        name: "critical_force_p05",
        unit: "E_s L t/(1-nu^2)",
        meaning: "5 % quantile of the critical force over the imperfect samples",
        cell: |r| r.result.samples.critical_force.map(|s| s.quantiles[0]).into(),
    },
    MeasuredValue {
        tables: FORCE,
        name: "critical_force_p50",
        unit: "E_s L t/(1-nu^2)",
        meaning: "median of the critical force over the imperfect samples",
        cell: |r| r.result.samples.critical_force.map(|s| s.quantiles[1]).into(),
    },
    MeasuredValue {
        tables: FORCE,
        name: "critical_force_p95",
        unit: "E_s L t/(1-nu^2)",
        meaning: "95 % quantile of the critical force over the imperfect samples",
        cell: |r| r.result.samples.critical_force.map(|s| s.quantiles[2]).into(),
    },
    MeasuredValue {
        tables: DEPTH,
        name: "penetration_mean",
        unit: "t",
        meaning: "mean of the penetration over the imperfect samples",
        cell: |r| r.result.samples.penetration.map(|s| s.mean).into(),
    },
    MeasuredValue {
        tables: DEPTH,
        name: "penetration_p05",
        unit: "t",
        meaning: "5 % quantile of the penetration over the imperfect samples",
        cell: |r| r.result.samples.penetration.map(|s| s.quantiles[0]).into(),
    },
    MeasuredValue {
        tables: DEPTH,
        name: "penetration_p50",
        unit: "t",
        meaning: "median of the penetration over the imperfect samples",
        cell: |r| r.result.samples.penetration.map(|s| s.quantiles[1]).into(),
    },
    MeasuredValue {
        tables: DEPTH,
        name: "penetration_p95",
        unit: "t",
        meaning: "95 % quantile of the penetration over the imperfect samples",
        cell: |r| r.result.samples.penetration.map(|s| s.quantiles[2]).into(),
    },
    MeasuredValue {
        tables: BOTH,
        name: "puncture_samples_failed",
        unit: "-",
        meaning: "imperfect samples whose puncture has no values, left out of mean and quantiles",
        cell: |r| r.result.samples.puncture_failed.into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "compliance_mean",
        unit: "1/(E_m I_m)",
        meaning: "mean of the flexural compliance over the imperfect samples",
        cell: |r| r.result.samples.compliance.map(|s| s.mean).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "compliance_p05",
        unit: "1/(E_m I_m)",
        meaning: "5 % quantile of the flexural compliance over the imperfect samples",
        cell: |r| r.result.samples.compliance.map(|s| s.quantiles[0]).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "compliance_p50",
        unit: "1/(E_m I_m)",
        meaning: "median of the flexural compliance over the imperfect samples",
        cell: |r| r.result.samples.compliance.map(|s| s.quantiles[1]).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "compliance_p95",
        unit: "1/(E_m I_m)",
        meaning: "95 % quantile of the flexural compliance over the imperfect samples",
        cell: |r| r.result.samples.compliance.map(|s| s.quantiles[2]).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "closing_range_mean",
        unit: "1/t",
        meaning: "mean of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.result.samples.closing_range.map(|s| s.mean).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "closing_range_p05",
        unit: "1/t",
        meaning: "5 % quantile of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.result.samples.closing_range.map(|s| s.quantiles[0]).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "closing_range_p50",
        unit: "1/t",
        meaning: "median of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.result.samples.closing_range.map(|s| s.quantiles[1]).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "closing_range_p95",
        unit: "1/t",
        meaning: "95 % quantile of the curvature from the first contact to that in the last gap that closes, over the imperfect samples",
        cell: |r| r.result.samples.closing_range.map(|s| s.quantiles[2]).into(),
    },
    MeasuredValue {
        tables: COMPLIANCE,
        name: "flexure_samples_failed",
        unit: "-",
        meaning: "imperfect samples whose bending has no values, left out of mean and quantiles",
        cell: |r| r.result.samples.flexure_failed.into(),
    },
];

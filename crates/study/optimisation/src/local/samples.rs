//! Computes derivatives of statistics over samples from the derivatives of single samples.

use results::DesignRow;
use sweep::Parameter;

use crate::evaluated_row::{StatisticSlopes, StatisticUse};
use crate::evaluations::{Evaluations, Halt};
use crate::judge::Judge;
use crate::sample::{OrderStatistic, SampleJudge, Samples};
use crate::slopes::Slopes;
use crate::space::{DesignSpace, SpacePoint};

/// A point and its samples, for which derivatives are computed.
pub(super) struct SampledPoint<'a> {
    pub space: &'a DesignSpace,
    pub evaluations: &'a Evaluations<'a>,
    pub judge: &'a SampleJudge,
    pub point: &'a SpacePoint,
    pub samples: &'a Samples,
}

impl SampledPoint<'_> {
    /// Computes the derivatives of each statistic that `judge` uses, with respect to each variable.
    pub fn slopes(&self, judge: &Judge) -> Result<Vec<StatisticSlopes>, Halt> {
        let mut slopes = Vec::new();
        for (of, q) in judge.uses() {
            let requirement = match of {
                StatisticUse::Objective(_) => None,
                StatisticUse::Requirement(k) => judge.requirements().nth(k),
            };
            let mut rows = Vec::new();
            // A quantile is the value of one sample, or interpolates the values of two samples.
            // Only these samples need derivatives.
            for order in self.judge.order_statistics(q, requirement, self.samples) {
                rows.extend(self.row(order.sample)?.map(|row| (order, row)));
            }
            for interval in self.space.intervals() {
                let parameter = interval.parameter;
                let parts = rows.iter().map(|(order, row)| self.part(q, *order, row, parameter));
                let sum = parts.reduce(Slopes::plus).unwrap_or(Slopes::UNKNOWN);
                slopes.push(StatisticSlopes { of, parameter: parameter.key, slopes: sum });
            }
        }
        Ok(slopes)
    }

    /// Computes the gradient of the sort key of statistic `q` for each of these `samples`.
    ///
    /// The sort key is the column of a quantile, or the smallest margin for a yield. Gradients are
    /// with respect to the fractions of the intervals. Samples without deviations within the bounds
    /// of the parameters are omitted.
    pub fn gradients(&self, q: usize, samples: &[u64]) -> Result<Vec<Vec<f64>>, Halt> {
        let mut gradients = Vec::new();
        for &sample in samples {
            let Some(row) = self.row(sample)? else { continue };
            let order = OrderStatistic { sample, part: 1.0 };
            let intervals = self.space.intervals().iter();
            let slopes = intervals.map(|interval| {
                let slope = self.part(q, order, &row, interval.parameter).smooth();
                slope.unwrap_or_default() * interval.length()
            });
            gradients.push(slopes.collect());
        }
        Ok(gradients)
    }

    /// Solves a sample with derivatives, but without scatter between scales.
    ///
    /// `None` if no deviations within the bounds of the parameters are found.
    fn row(&self, sample: u64) -> Result<Option<DesignRow>, Halt> {
        let Some(result) = self.evaluations.even_sample(self.point, sample)? else {
            return Ok(None);
        };
        let nominal = self.evaluations.row(0, self.point, &result);
        let case = self.evaluations.even_case(&nominal.case, sample);
        Ok(case.map(|case| DesignRow { case, ..nominal }))
    }

    /// Computes the contribution of one sample to the derivatives of statistic `q`.
    ///
    /// `row` is the sample with derivatives. The deviations of the sample are constant while
    /// `parameter` of the nominal design changes.
    fn part(&self, q: usize, of: OrderStatistic, row: &DesignRow, parameter: &Parameter) -> Slopes {
        // Use the values with scatter between scales. Without scatter, the sample might have its
        // smallest margin to another requirement.
        let values = &self.samples.0[of.sample as usize - 1];
        let Some((column, factor)) = self.judge.moving(q, values) else { return Slopes::UNKNOWN };
        let nominal = self.space.case(self.point);
        let slopes = Slopes::between(parameter.size(&nominal), |by, side| {
            let moved = parameter.moved(&nominal, by)?;
            let sampled = self.evaluations.even_case(&moved, of.sample)?;
            column.value(&row.extrapolated(&sampled, side))
        });
        slopes.scaled(factor * of.part)
    }
}

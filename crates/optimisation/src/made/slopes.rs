//! Derivatives of quantities over skins: those of the skins that make them, with respect to what is drawn.

use std::sync::Arc;

use results::{DesignResult, DesignRow};
use sweep::Parameter;

use super::judge::{Carrier, MadeJudge, Skins, Stake};
use crate::evaluations::Halt;
use crate::local::Search;
use crate::number_column::slopes_of;
use crate::slopes::Slopes;
use crate::space::SpacePoint;

/// The derivatives of a quantity over skins with respect to a parameter of the design.
#[derive(Clone, Debug)]
pub(crate) struct MadeSlope {
    pub stake: Stake,
    pub parameter: &'static str,
    pub slopes: Slopes,
}

/// A point with its skins, of which derivatives are asked for.
struct MadePoint<'a> {
    search: &'a Search<'a>,
    judge: &'a MadeJudge,
    point: &'a SpacePoint,
    skins: &'a Skins,
}

/// A skin that makes a quantity, solved with derivatives.
struct CarrierRow {
    carrier: Carrier,
    row: DesignRow,
}

impl Search<'_> {
    /// The derivatives of everything in the goal that is over the skins of the design at `point`.
    pub(crate) fn made_slopes(
        &self,
        point: &SpacePoint,
        skins: &Skins,
    ) -> Result<Vec<MadeSlope>, Halt> {
        let Some(judge) = self.judge.made() else { return Ok(Vec::new()) };
        let made = MadePoint { search: self, judge, point, skins };
        let mut slopes = Vec::new();
        for (stake, q) in self.judge.stakes() {
            let rows = made.carriers(stake, q)?;
            for interval in self.space.intervals() {
                let parameter = interval.parameter;
                let slope = made.slopes(q, &rows, parameter);
                slopes.push(MadeSlope { stake, parameter: parameter.key, slopes: slope });
            }
        }
        Ok(slopes)
    }
}

impl MadePoint<'_> {
    /// The skins that make quantity `q`, solved with derivatives.
    fn carriers(&self, stake: Stake, q: usize) -> Result<Vec<CarrierRow>, Halt> {
        let requirement = match stake {
            Stake::Objective(_) => None,
            Stake::Requirement(k) => self.search.judge.requirements().nth(k),
        };
        let evaluations = self.search.evaluations;
        let mut rows = Vec::new();
        for carrier in self.judge.carriers(q, requirement, self.skins) {
            let Some(result) = evaluations.even_skin(self.point, carrier.skin)? else { continue };
            rows.extend(self.row(carrier, &result));
        }
        Ok(rows)
    }

    fn row(&self, carrier: Carrier, result: &Arc<DesignResult>) -> Option<CarrierRow> {
        let drawn = self.search.evaluations.row(0, self.point, result);
        let case = self.search.evaluations.even_case(&drawn.case, carrier.skin)?;
        Some(CarrierRow { carrier, row: DesignRow { case, ..drawn } })
    }

    /// The derivatives of quantity `q`; none if a skin that makes it has none.
    fn slopes(&self, q: usize, rows: &[CarrierRow], parameter: &Parameter) -> Slopes {
        let none = Slopes { left: None, right: None };
        let slopes = rows.iter().map(|row| self.carrier_slopes(q, row, parameter));
        slopes.reduce(Slopes::plus).unwrap_or(none)
    }

    /// The part of a skin in the derivatives of quantity `q`: the skin moves as the design does, with the same deviations.
    fn carrier_slopes(&self, q: usize, of: &CarrierRow, parameter: &Parameter) -> Slopes {
        let none = Slopes { left: None, right: None };
        let CarrierRow { carrier, row } = of;
        let values = &self.skins.0[carrier.skin as usize - 1];
        let Some((column, factor)) = self.judge.carried(q, values) else { return none };
        let drawn = self.search.space.case(self.point);
        let at = |by, side| {
            let moved = parameter.moved(&drawn, by)?;
            let made = self.search.evaluations.even_case(&moved, carrier.skin)?;
            column.value(&row.extrapolated(&made, side))
        };
        slopes_of(parameter.size(&drawn), at).scaled(factor * carrier.part)
    }
}

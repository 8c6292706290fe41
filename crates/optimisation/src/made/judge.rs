//! The judgement of skins: how far each is within its bounds, and the quantities over all of them.

use ranking::{Goal, Relation, Requirement};
use results::{DesignRow, QUANTILES, quantile_places};

use super::quantity::MadeQuantity;
use crate::judge::{
    DrawnWorth, Judgement, RequiredColumn, direction, excess, has_folded, margin_rate,
};
use crate::number_column::NumberColumn;

/// The values of skins of a design, skin by skin: those in the columns of the bounds, then in those of the quantiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Skins(pub Vec<Vec<Option<f64>>>);

/// A quantity over skins as a goal uses it.
pub(crate) struct UsedQuantity {
    pub name: String,
    pub quantity: MadeQuantity,
    /// Whether large values are good: a skin without a value counts as the worst.
    pub large: bool,
}

/// What a derivative of a quantity over skins is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stake {
    /// An objective, by its index.
    Objective(usize),
    /// A requirement, by its index.
    Requirement(usize),
}

/// Judges the skins that are made of designs.
pub(crate) struct MadeJudge {
    /// The bounds that skins are to keep.
    pub bounds: Vec<RequiredColumn<NumberColumn>>,
    /// The quantities, and the columns of the quantiles among them, in their order.
    pub quantities: Vec<UsedQuantity>,
    pub columns: Vec<NumberColumn>,
    /// Whether a skin whose surface has folded on the way counts as none.
    pub sound: bool,
    /// The number of skins of each design.
    pub skins: usize,
}

/// A skin that makes a quantity, and the part that it has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Carrier {
    /// Number of the skin, from 1.
    pub skin: u64,
    pub part: f64,
}

impl UsedQuantity {
    pub fn of_objective(name: &str, quantity: MadeQuantity, goal: Goal) -> Self {
        Self { name: name.to_owned(), quantity, large: goal == Goal::Maximize }
    }

    pub fn of_requirement(requirement: &Requirement, quantity: MadeQuantity) -> Self {
        let large = direction(requirement) > 0.0;
        Self { name: requirement.column.clone(), quantity, large }
    }

    /// That of every skin whose surface stays open, as many as the quantiles among `others` count on; `None` if there are none.
    pub fn of_soundness(column: &str, others: &[Self]) -> Option<Self> {
        let share = |used: &Self| match used.quantity {
            MadeQuantity::Quantile { share, .. } => Some(share.min(1.0 - share)),
            MadeQuantity::Yield => None,
        };
        let least = others.iter().filter_map(share).reduce(f64::min)?;
        let (ending, share) = QUANTILES.into_iter().find(|(_, share)| *share >= least - 1e-9)?;
        let quantity = MadeQuantity::Quantile { column: column.to_owned(), share };
        Some(Self { name: format!("{column}_{ending}"), quantity, large: true })
    }
}

impl MadeJudge {
    /// The values of a skin, or of a design as it is drawn.
    pub fn values(&self, row: &DesignRow) -> Vec<Option<f64>> {
        let bounds = self.bounds.iter().map(|bound| &bound.column);
        let columns = bounds.chain(&self.columns);
        let values: Vec<_> = columns.map(|column| column.value(row)).collect();
        // Soundness is the last of the bounds.
        let bounds = self.bounds.last().filter(|_| self.sound);
        let is_open = bounds.is_some_and(|open| open.margin(values[self.bounds.len() - 1]) >= 0.0);
        let is_open_again = is_open && has_folded(row);
        if is_open_again { vec![None; values.len()] } else { values }
    }

    /// The verdict on a design of which no skins are known, from what is drawn.
    pub fn as_drawn(&self, row: &DesignRow) -> Judgement {
        let value = |bound: &RequiredColumn<NumberColumn>| bound.column.value(row);
        let required: Vec<Option<f64>> = self.bounds.iter().map(value).collect();
        if let Some(missing) = required.iter().position(Option::is_none) {
            return Judgement::Missing(self.bounds[missing].column.name().to_owned());
        }
        let margin = self.margin(&required);
        if margin >= 0.0 && self.sound && has_folded(row) {
            return Judgement::Folded;
        }
        let required = required.into_iter().flatten().collect();
        Judgement::Drawn(DrawnWorth { shortfall: (-margin).max(0.0), required })
    }

    /// Whether a design as it is drawn keeps the bounds of skins, and is worth making some.
    pub fn admits(&self, row: &DesignRow) -> bool {
        row.result.failures.is_empty() && self.margin(&self.values(row)) >= 0.0
    }

    /// How far a skin is within its bounds, relative to their limits: the least over all of them, below 0 if it keeps one not, and
    /// minus infinity of a skin without a value.
    pub fn margin(&self, values: &[Option<f64>]) -> f64 {
        let bounds = self.bounds.iter().zip(values);
        bounds.map(|(bound, value)| bound.margin(*value)).fold(f64::INFINITY, f64::min)
    }

    /// The bound that a skin is least within.
    fn tightest(&self, values: &[Option<f64>]) -> Option<usize> {
        let margin = |k: usize| self.bounds[k].margin(values[k]);
        (0..self.bounds.len()).min_by(|&a, &b| margin(a).total_cmp(&margin(b)))
    }

    /// The index of the column of quantile `q` among the values of skins.
    fn place(&self, q: usize) -> usize {
        let is_quantile = |used: &&UsedQuantity| used.quantity != MadeQuantity::Yield;
        self.bounds.len() + self.quantities[..q].iter().filter(is_quantile).count()
    }

    /// The number that skins are put in order by for quantity `q`: their values, or their margins.
    fn key(&self, q: usize, values: &[Option<f64>]) -> f64 {
        let UsedQuantity { quantity, large, .. } = &self.quantities[q];
        let worst = if *large { f64::NEG_INFINITY } else { f64::INFINITY };
        match quantity {
            MadeQuantity::Yield => self.margin(values),
            MadeQuantity::Quantile { .. } => values[self.place(q)].unwrap_or(worst),
        }
    }

    /// The numbers of the skins for quantity `q`.
    pub fn keys(&self, q: usize, skins: &Skins) -> Vec<f64> {
        skins.0.iter().map(|values| self.key(q, values)).collect()
    }

    /// Those numbers in their order, each with the index of its skin.
    fn sorted(&self, q: usize, skins: &Skins) -> Vec<(f64, usize)> {
        let mut sorted: Vec<(f64, usize)> = self.keys(q, skins).into_iter().zip(0..).collect();
        sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
        sorted
    }

    /// The value of quantity `q`; `None` if it falls on a skin without one.
    pub fn value(&self, q: usize, skins: &Skins) -> Option<f64> {
        let sorted: Vec<f64> = self.sorted(q, skins).into_iter().map(|(key, _)| key).collect();
        match self.quantities[q].quantity {
            MadeQuantity::Yield => Some(met(&sorted) as f64 / sorted.len() as f64),
            MadeQuantity::Quantile { share, .. } => results::quantile(&sorted, share),
        }
    }

    /// The value of quantity `q` as designs are compared by it: of a yield with a part of a step more, the nearer the best of the
    /// skins that fall short is to its bounds (O7), or, where none falls short, the farther the worst is within.
    pub fn compared(&self, q: usize, skins: &Skins) -> Option<f64> {
        if self.quantities[q].quantity != MadeQuantity::Yield {
            return self.value(q, skins);
        }
        let sorted: Vec<f64> = self.sorted(q, skins).into_iter().map(|(key, _)| key).collect();
        let met = met(&sorted);
        let part = match (sorted.len() - met).checked_sub(1) {
            Some(next) => 1.0 / (1.0 - sorted[next]),
            None => 1.0 - 1.0 / (1.0 + sorted[0]),
        };
        Some((met as f64 + part) / sorted.len() as f64)
    }

    /// How far quantity `q` is beyond a requirement, relative to the limits; of a yield by the skin that is to meet (O6).
    pub fn excess(&self, q: usize, requirement: &Requirement, skins: &Skins) -> Option<f64> {
        if self.quantities[q].quantity != MadeQuantity::Yield {
            return Some(excess(requirement, self.value(q, skins)?));
        }
        let sorted = self.sorted(q, skins);
        Some(-sorted[needed(requirement, sorted.len())].0)
    }

    /// The skins that make quantity `q`, of a requirement that of a yield; none of a yield as an objective, which is a staircase.
    pub fn carriers(
        &self,
        q: usize,
        requirement: Option<&Requirement>,
        skins: &Skins,
    ) -> Vec<Carrier> {
        let sorted = self.sorted(q, skins);
        let carrier = |place: usize, part| Carrier { skin: sorted[place].1 as u64 + 1, part };
        match (&self.quantities[q].quantity, requirement) {
            (MadeQuantity::Yield, None) => Vec::new(),
            (MadeQuantity::Yield, Some(requirement)) => {
                vec![carrier(needed(requirement, sorted.len()), 1.0)]
            }
            (MadeQuantity::Quantile { share, .. }, _) => {
                let Some(([below, above], part)) = quantile_places(sorted.len(), *share) else {
                    return Vec::new();
                };
                let both = [carrier(below, 1.0 - part), carrier(above, part)];
                both.into_iter().filter(|carrier| carrier.part > 0.0).collect()
            }
        }
    }

    /// The column whose derivatives on a skin are those of quantity `q`, with the factor that makes them so.
    pub fn carried(&self, q: usize, values: &[Option<f64>]) -> Option<(&NumberColumn, f64)> {
        if self.quantities[q].quantity == MadeQuantity::Yield {
            let bound = &self.bounds[self.tightest(values)?];
            return Some((&bound.column, margin_rate(&bound.requirement)));
        }
        Some((&self.columns[self.place(q) - self.bounds.len()], 1.0))
    }
}

impl RequiredColumn<NumberColumn> {
    /// How far a value is within the bound, relative to the limit; below 0 if it does not keep it.
    fn margin(&self, value: Option<f64>) -> f64 {
        let Some(value) = value else { return f64::NEG_INFINITY };
        let margin = -excess(&self.requirement, value);
        // Round-off breaks no bound.
        if self.requirement.is_met(value) {
            margin.max(0.0)
        } else {
            margin.min(-f64::MIN_POSITIVE)
        }
    }
}

/// How many of these margins are not below 0.
fn met(margins: &[f64]) -> usize {
    margins.iter().filter(|margin| **margin >= 0.0).count()
}

/// The place, among `count` skins in the order of their margins, of the worst skin that has to meet for a yield to be as required.
fn needed(requirement: &Requirement, count: usize) -> usize {
    let wanted = requirement.limit * count as f64;
    let needed = match requirement.relation {
        Relation::Above => (wanted + 1e-9).floor() + 1.0,
        _ => (wanted - 1e-9).ceil(),
    };
    count - (needed as usize).clamp(1, count)
}

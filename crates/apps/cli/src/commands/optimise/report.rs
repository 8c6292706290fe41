//! The text output of `squama optimise`.

use std::fmt::Write as _;
use std::time::Duration;

use optimisation::{
    Agreement, Answer, BestDesign, BindingText, Candidate, DesignGoal, Found, Front, Judgement,
    Rounding, described,
};
use ranking::{Goal, Requirement, Unmet};
use results::columns::{Cell, design_columns, is_invalid_after_fold, mode_column};
use run::{CouplingChange, WeakestPlace};
use sweep::JudgedModes;
use text::number::same;

use super::super::couplings::couplings_report;
use super::super::rank::obstacle;
use super::samples;
use crate::commands::answer::DesignAnswer;
use crate::print::{FAILED, FOLDED, aligned, counted, digits, marked, rounded, time};

/// A goal and the result of its search, for the output.
pub struct SearchReport<'a> {
    pub goal: &'a DesignGoal,
    pub found: &'a Found,
}

impl SearchReport<'_> {
    /// Formats the result of the search, which took `duration` on `threads` threads.
    pub fn text(&self, duration: Duration, threads: usize) -> String {
        let mut text = format!(
            "{}: {} evaluated in {} on {}\n{}",
            self.goal.name(),
            counted(self.found.history.len() as u64, "design"),
            time(duration),
            counted(threads as u64, "thread"),
            self.unjudged()
        );
        let answer = match &self.found.answer {
            Answer::Optimum(best) => self.optimum(best),
            Answer::Front(front) => self.front(front),
            Answer::Infeasible(nearest) => self.infeasible(*nearest),
        };
        let _ = write!(text, "\n{answer}{}", self.rescaled());
        text
    }

    /// Formats the bounds of the rescaled criteria as a line for `[goal]`.
    ///
    /// The text is empty if no criteria were rescaled.
    fn rescaled(&self) -> String {
        let bounds = self.found.rescaled.iter();
        let bounds =
            bounds.map(|of| format!("{} = [{}, {}]", of.column, digits(of.worst), digits(of.best)));
        match bounds.collect::<Vec<_>>().join(", ") {
            bounds if bounds.is_empty() => bounds,
            bounds => format!(
                "\nThe criteria were rescaled between their worst and best values; to keep these bounds: rescale = {{ {bounds} }}\n"
            ),
        }
    }

    /// Lists the numbers of designs that the search left out, each with its reason.
    fn unjudged(&self) -> String {
        let unjudged = &self.found.unjudged;
        let failed =
            unjudged.failed.iter().map(|(why, n)| (*n, format!("{why}: {}", why.meaning())));
        let missing = unjudged.missing.iter();
        let missing = missing.map(|(column, n)| (*n, format!("no value of {column}")));
        let folded =
            (unjudged.folded > 0).then(|| (unjudged.folded, "the surface folds".to_owned()));
        let all = failed.chain(missing).chain(folded);
        let rows: Vec<_> = all.map(|(n, why)| [format!("{n} left out"), why]).collect();
        aligned(&rows)
    }

    /// Formats the best design, its active limits and the results of its checks.
    fn optimum(&self, best: &BestDesign) -> String {
        let texts = BindingText::new(self.goal);
        let rows = self.answer_rows(best);
        let constant = constant_objectives(self.goal, self.found);
        let title =
            if constant.is_empty() { "The best design" } else { "A design, as good as any other" };
        let mut text = format!("{title}\n{}", aligned(&rows));
        text += &self.answer(best).warnings_text(best.checks.gaps.as_ref());
        if !constant.is_empty() {
            return text + &constant_text(&constant);
        }
        text += &self.rounding();
        let covered = self.coverage_of_search();
        let _ = write!(text, "\nThe search found no better design{covered}{}.", agreement(best));
        if best.bindings.is_empty() {
            text.push('\n');
        } else {
            let bindings = best.bindings.iter();
            let rows: Vec<_> = bindings
                .map(|binding| {
                    let price = texts.price(binding, &best.target);
                    [texts.limit(&binding.limit, &best.target), price.unwrap_or_default()]
                })
                .collect();
            let is_rounded = self.found.rounding.as_ref().is_some_and(|of| of.rounded.is_some());
            let it = if is_rounded { "Before rounding, it" } else { "It" };
            let _ = write!(text, " {it} is limited by\n{}", aligned(&rows));
        }
        if let Some(reason) = &best.reason {
            let _ = writeln!(text, "\n{reason}");
        }
        // Omit the requested load position. At this position the check differs from the search only
        // by full coupling, which `couplings_report` describes.
        let requested = best.row.case.punctured().load_position;
        let places = best.checks.places.iter().filter(|of| of.load_position != requested);
        text += &places.filter_map(weakest_place).collect::<String>();
        let coupling = best.checks.coupling.clone();
        let named = coupling
            .map(|change| CouplingChange { design: "the best design".to_owned(), ..change });
        text += &couplings_report(named.as_slice(), &self.goal.requirements);
        if let Some(modes) = judged_modes(self.goal, &best.candidate) {
            let _ = write!(text, "\n{modes}");
        }
        text += &best.confirmation.as_ref().map(samples::text).unwrap_or_default();
        text + &self.tightened() + &self.contradicted(best)
    }

    /// States the change of the objective by rounding; empty if the goal requests no rounding.
    fn rounding(&self) -> String {
        let Some(Rounding { step, unit, exact, rounded }) = &self.found.rounding else {
            return String::new();
        };
        let step = text::number::text(*step);
        let Some(value) = rounded else {
            return format!(
                "\n{FAILED} No design near the best one with lengths in multiples of {step} {unit} meets all requirements: this design is not rounded.\n"
            );
        };
        let objective = &self.goal.objectives[0];
        let sign = if objective.goal == Goal::Maximize { 1.0 } else { -1.0 };
        let gain = sign * (value - exact) / exact.abs();
        let percent = text::number::rounded(100.0 * gain.abs(), 2);
        let change = if gain > 0.0 { "better" } else { "worse" };
        format!(
            "\nLengths are multiples of {step} {unit}, angles whole degrees: {} is {percent} % {change} than before rounding ({}).\n",
            objective.column,
            digits(*exact)
        )
    }

    /// Lists the limits that the search tightened so that the checks pass.
    ///
    /// The text is empty if the search tightened no limit.
    fn tightened(&self) -> String {
        let limits = self.goal.requirements.iter().zip(&self.found.searched);
        let limits = limits.filter(|(meant, searched)| meant != searched).map(|(_, searched)| {
            let Requirement { column, relation, limit } = searched;
            format!("{column} {} {}", relation.sign(), digits(*limit))
        });
        let limits: Vec<_> = limits.collect();
        if limits.is_empty() {
            return String::new();
        }
        format!(
            "\nThe search required {}, so that the checks meet the limits of the goal.\n",
            limits.join(" and ")
        )
    }

    /// Names the requirements that a check contradicts, and a remedy.
    ///
    /// The text is empty if all checks pass.
    fn contradicted(&self, best: &BestDesign) -> String {
        let contradictions = best.contradictions(self.goal);
        if contradictions.is_empty() {
            return String::new();
        }
        let sentences: Vec<String> = contradictions.iter().map(|of| format!("{of}.")).collect();
        let lines = marked(FAILED, &sentences);
        let remedy = if self.goal.confirm {
            "No design of the search passes the checks: relax a requirement or widen a variable."
        } else {
            "To search for a design that passes the checks: --set goal.confirm=true"
        };
        format!("\nThe best design fails a check\n{lines}{remedy}\n")
    }

    /// States the number of starts and regions of the search.
    fn coverage_of_search(&self) -> String {
        let Found { starts, regions, .. } = self.found;
        let [starts, regions] = [(*starts, "start"), (*regions, "region")]
            .map(|(count, name)| counted(count as u64, name));
        format!(" from {starts} in {regions} of the space")
    }

    /// Returns the keys and values of the variables of a design.
    fn variables(&self, candidate: &Candidate) -> Vec<[String; 2]> {
        let case = self.goal.space.case(&candidate.point);
        let values = self.goal.space.parameters().map(|parameter| {
            let value = match Cell::from(parameter.get(&case)) {
                Cell::Number(number) => rounded(number),
                cell => cell.to_string(),
            };
            [parameter.key.to_owned(), value]
        });
        values.collect()
    }

    /// Returns the values, margins and warnings of the design `best`.
    pub fn answer<'a>(&'a self, best: &'a BestDesign) -> DesignAnswer<'a> {
        DesignAnswer::new(self.goal.space.sweep(), &best.row, &self.goal.requirements)
    }

    /// Returns table rows of the variables, objectives and criteria of a design.
    ///
    /// After these rows follow rows of the required values, with limits and margins.
    fn answer_rows(&self, best: &BestDesign) -> Vec<Vec<String>> {
        let is_required =
            |column: &str| self.goal.requirements.iter().any(|of| of.column == column);
        let mut required = self.answer(best).rows();
        let mut rows: Vec<Vec<String>> = Vec::new();
        let known = self.variables(&best.candidate).into_iter().chain(self.values(best));
        for [name, value] in known {
            if !is_required(&name) && !required.iter().any(|row| row[0] == name) {
                rows.push(vec![name, value]);
            }
        }
        rows.append(&mut required);
        rows
    }

    /// Lists the objectives, required columns, criteria and failure mode, without duplicates.
    ///
    /// Omits variables and statistics over samples, which other functions list.
    fn values(&self, best: &BestDesign) -> Vec<[String; 2]> {
        let Judgement::Judged(worth) = &best.candidate.verdict else { return Vec::new() };
        let mut rows: Vec<[String; 2]> = Vec::new();
        for (column, value) in self.goal.values(worth) {
            let is_variable = self.goal.space.parameters().any(|p| p.key == column);
            let is_statistic = self.goal.statistic(column).is_some();
            if !is_variable && !is_statistic && !rows.iter().any(|[known, _]| *known == column) {
                rows.push([column.to_owned(), digits(value)]);
            }
        }
        self.add_criteria(best, &mut rows);
        self.add_mode(best, &mut rows);
        rows
    }

    /// Appends the first failure mode to `rows`, if the goal names a failure force.
    fn add_mode(&self, best: &BestDesign, rows: &mut Vec<[String; 2]>) {
        let Some(mode) = goal_columns(self.goal).find_map(mode_column) else { return };
        let columns = design_columns(self.goal.space.sweep());
        let column = columns.iter().find(|column| column.name == mode);
        rows.extend(column.map(|column| [mode.to_owned(), column.cell(&best.row).to_string()]));
    }

    /// Appends the criteria of the fitness to `rows`, unless they are already listed.
    fn add_criteria(&self, best: &BestDesign, rows: &mut Vec<[String; 2]>) {
        let columns = design_columns(self.goal.space.sweep());
        for criterion in self.goal.fitness.iter().flat_map(|fitness| &fitness.criteria) {
            let column = columns.iter().find(|column| column.name == criterion.column);
            let Some(Cell::Number(value)) = column.map(|column| column.cell(&best.row)) else {
                continue;
            };
            if !rows.iter().any(|[known, _]| *known == criterion.column) {
                rows.push([criterion.column.to_string(), digits(value)]);
            }
        }
    }

    /// States the number of designs on the front, and why it is smaller than requested.
    fn title(&self, front: &Front) -> String {
        let (found, requested) = (front.designs.len(), self.goal.points);
        let mut title = format!("Pareto front: {}\n", counted(found as u64, "design"));
        if found < requested {
            let reasons = [
                (front.same, "gave the same design as another point: the front has a step there"),
                (front.beaten, "gave a dominated design"),
                (front.empty, "gave no design"),
                (front.unsearched(requested), "left out: the front has no wide gap"),
            ];
            let reasons: Vec<String> = reasons
                .iter()
                .filter(|(count, _)| *count > 0)
                .map(|(count, why)| format!("{} {why}", counted(*count as u64, "point")))
                .collect();
            let _ = writeln!(title, "Fewer than the {requested} requested: {}", reasons.join("; "));
        }
        title
    }

    /// Returns the names and values of the variables, objectives and statistics of a design.
    fn named_values(&self, best: &BestDesign) -> Vec<[String; 2]> {
        let statistics = best.confirmation.as_ref().map(samples::row).unwrap_or_default();
        [self.variables(&best.candidate), self.values(best), statistics].concat()
    }

    /// Formats the designs of the front with the prices of their objectives.
    fn front(&self, front: &Front) -> String {
        let texts = BindingText::new(self.goal);
        let (title, designs) = (self.title(front), &front.designs);
        let Some(first) = designs.first() else { return title };
        let header = self.named_values(first).into_iter();
        let mut header: Vec<String> = header.map(|[name, _]| name).collect();
        header.push("price".to_owned());
        let mut rows = vec![header];
        rows.extend(designs.iter().map(|best| {
            let row = self.named_values(best).into_iter();
            let mut row: Vec<String> = row.map(|[_, value]| value).collect();
            // `Limit::ObjectiveBound` is a lower bound on another objective (ε-constraint). Its
            // price is the trade-off between both objectives.
            let bounds = best
                .bindings
                .iter()
                .filter(|binding| matches!(binding.limit, optimisation::Limit::ObjectiveBound(_)));
            let prices: Vec<_> = bounds.filter_map(|b| texts.price(b, &best.target)).collect();
            row.push(prices.join("; "));
            if fold_force(self.goal, best).is_some() {
                row[0].push(FOLDED);
            }
            row
        }));
        let is_unknown = rows[1..].iter().all(|row| row.last().is_some_and(String::is_empty));
        let unknown =
            "  Prices are unknown: at a kink no multipliers satisfy the optimality conditions\n";
        let prices = if is_unknown { unknown } else { "" };
        let is_folded = designs.iter().any(|best| fold_force(self.goal, best).is_some());
        let folded = if is_folded { FOLDED_MEANS } else { "" };
        let constant = constant_text(&constant_objectives(self.goal, self.found));
        title + &aligned(&rows) + folded + prices + &samples::of_all(designs) + &constant
    }

    /// Formats the distances from the requirements, and the nearest design.
    ///
    /// Used if no design meets all requirements; `nearest` is the index of the nearest design.
    fn infeasible(&self, nearest: Option<usize>) -> String {
        let texts = BindingText::new(self.goal);
        let requirements: Vec<Requirement> = texts.requirements().into_iter().cloned().collect();
        let unmet = unmet(self.goal, self.found, &requirements, nearest);
        // Do not count designs by requirement if the goal uses samples: designs that miss a
        // requirement on a column have no samples, so the counts would not be comparable.
        let obstacle = if has_samples(self.goal, self.found) {
            samples::shortfalls(&unmet, &self.found.missed)
        } else {
            obstacle(&unmet)
        };
        let tightened = self.tightened();
        let mut text = format!("No design meets all requirements\n{obstacle}{tightened}");
        if let Some(nearest) = nearest {
            let rows = self.variables(&self.found.history[nearest]);
            let _ = write!(text, "\nThe nearest design\n{}", aligned(&rows));
        }
        text
    }
}

/// Legend that explains the mark of designs with a folded surface.
const FOLDED_MEANS: &str =
    "  ⚠ the surface of the substrate folds: values at the critical tilt are not valid\n";

/// Fraction of the force at the requested position below which a weaker position is reported.
const WEAKER: f64 = 0.99;

/// Describes the weakest load position.
///
/// `None` if its force is at least [`WEAKER`] times the force at the requested position.
fn weakest_place(place: &WeakestPlace) -> Option<String> {
    let weakest = place.weakest.filter(|weakest| *weakest < WEAKER * place.requested)?;
    let failure = place.failure.as_ref().map(|mode| format!(" ({mode})")).unwrap_or_default();
    Some(format!(
        "\nWeakest load position, with full substrate coupling: {}\n  {} = {}{failure} there, {} at the position of the search\n",
        described(place.load_position),
        place.column,
        digits(weakest),
        digits(place.requested),
    ))
}

/// Returns the force at which the surface folds, if a fold invalidates a column of the goal.
fn fold_force(goal: &DesignGoal, best: &BestDesign) -> Option<f64> {
    goal_columns(goal).find(|column| is_invalid_after_fold(column))?;
    best.row.result.puncture?.measures.fold_force
}

/// Returns the columns of the objectives, the requirements and the criteria of the fitness.
fn goal_columns(goal: &DesignGoal) -> impl Iterator<Item = &str> {
    let objectives = goal.objectives.iter().map(|objective| &*objective.column);
    let required = goal.requirements.iter().map(|requirement| &*requirement.column);
    let fitness = goal.fitness.iter().flat_map(|fitness| &fitness.criteria);
    objectives.chain(required).chain(fitness.map(|criterion| &*criterion.column))
}

/// Returns the judged failure modes of a design, if the goal names a failure force.
pub fn judged_modes(goal: &DesignGoal, best: &Candidate) -> Option<JudgedModes> {
    goal_columns(goal).find_map(mode_column)?;
    goal.space.case(&best.point).judged_modes()
}

/// Returns each objective that has the same value in all evaluated designs, with this value.
pub fn constant_objectives<'a>(goal: &'a DesignGoal, found: &Found) -> Vec<(&'a str, f64)> {
    let mut constant = Vec::new();
    for objective in &goal.objectives {
        let column = &*objective.column;
        let mut values = found.history.iter().filter_map(|candidate| match &candidate.verdict {
            Judgement::Judged(worth) => {
                goal.values(worth).find(|(name, _)| *name == column).map(|(_, value)| value)
            }
            _ => None,
        });
        // At least two designs are necessary to show that an objective is constant.
        let (Some(first), Some(second)) = (values.next(), values.next()) else { continue };
        if same(first, second) && values.all(|value| same(first, value)) {
            constant.push((column, first));
        }
    }
    constant
}

fn constant_text(constant: &[(&str, f64)]) -> String {
    let lines = constant.iter().map(|(column, value)| {
        let value = digits(*value);
        format!(
            "\n{column} is {value} in every evaluated design: the variables do not change it.\n"
        )
    });
    lines.collect()
}

/// States how many local searches found the best design.
fn agreement(best: &BestDesign) -> String {
    let Some(Agreement { searches, agreeing, spread }) = best.agreement else {
        return String::new();
    };
    let agree = format!("; {agreeing} of {searches} local searches agree within 0.1 %");
    match (searches, spread) {
        (0, _) => String::new(),
        (1, _) => "; only one local search found it: other seeds may find a better one".to_owned(),
        (_, Some(spread)) if agreeing == 1 => {
            let percent = rounded(100.0 * spread);
            format!("{agree}, the next is {percent} % worse: other seeds may find a better one")
        }
        _ => agree,
    }
}

/// Returns true if the goal uses samples, and the samples of at least one design were solved.
fn has_samples(goal: &DesignGoal, found: &Found) -> bool {
    let mut judged = found.history.iter().map(|c| matches!(c.verdict, Judgement::Judged(_)));
    goal.is_about_samples() && judged.any(|is_judged| is_judged)
}

/// Counts how many evaluated designs meet each requirement.
///
/// `nearest` is the index of the nearest design. If no design has samples, requirements on
/// statistics are ignored.
pub fn unmet(
    goal: &DesignGoal,
    found: &Found,
    requirements: &[Requirement],
    nearest: Option<usize>,
) -> Unmet {
    let is_sampled = has_samples(goal, found);
    let requirements: Vec<Requirement> = requirements
        .iter()
        .filter(|r| is_sampled || goal.statistic(&r.column).is_none())
        .cloned()
        .collect();
    let values = found.history.iter();
    let values = values.map(|candidate| required_values(goal, &requirements, &candidate.verdict));
    Unmet::of_search(&values.collect::<Vec<_>>(), &requirements, nearest)
}

/// Returns the value of a design for each requirement; `None` if there is no value.
fn required_values(
    goal: &DesignGoal,
    requirements: &[Requirement],
    verdict: &Judgement,
) -> Vec<Option<f64>> {
    match verdict {
        Judgement::Judged(worth) => worth.required.iter().copied().map(Some).collect(),
        Judgement::Nominal(worth) => {
            // A design without samples has values only for requirements on nominal columns, in the
            // order of these requirements.
            let mut nominal = worth.required.iter().copied();
            let values = requirements.iter().map(|requirement| {
                let is_nominal = goal.statistic(&requirement.column).is_none();
                is_nominal.then(|| nominal.next()).flatten()
            });
            values.collect()
        }
        _ => vec![None; requirements.len()],
    }
}

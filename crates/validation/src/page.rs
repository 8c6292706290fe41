//! The validation page in Markdown.

use std::fmt::Write as _;

use crate::{
    Benchmark, BetweenPoints, CheckedClaim, CheckedStatement, Claim, CouplingEffect, GapCount,
    Headlines, Sensitivity, Validation, Verdict,
};

/// The rules by which claims are judged, as the page states them.
const RULES: &str = "\
- A claim is *reproduced* if all that it says is (rows a, b …), *not reproduced* if nothing of it is, not even in part, and *in part* \
otherwise. What the paper leaves undefined, such as the puncture stiffness of Fig. 8, is checked in every reading. What has no \
value is not reproduced.\n\
- A printed number is reproduced within 10 %, in part within 30 %. No significant effect is a ratio of at most 1.1 (in part 1.3), little effect of 1.5 (2), much or \
significantly of at least 2 (1.5).\n\
- A trend is reproduced if every step between neighbouring values of the sweep goes its way, in part if three of four do; if it holds \
*in general*, nine of ten. A step without a value does not go its way.\n\
- A best design is reproduced if it has the printed parameters and no other is as good (to 1e-6), in part if it is one among equals, or if all the best ones \
fit the printed words: small, intermediate and large are the lowest, middle and highest third of the values.\n\
- The designs of the figures have `L/t` from 0.1, which section 3 calls the smallest; section 5 has all 720, but for those with `λ = 0`.\n\
- Punctures are followed to `u/t = 0.7`, as in Fig. 6; the stiffness after contact is the mean slope of `F*` over `u*` from the first contact \
to there. C17 and C18 are checked on the design of Fig. 6a, under the largest force that 0° and 75° both bear on the way. C19 and C20 \
are checked on the strip of the sweep, halved until upright scales touch, and bent to its end.\n\
- Designs are `(d/t, L/t, slant)`.\n";

impl Validation {
    /// Returns the page: all tables in Markdown.
    pub fn page(&self) -> String {
        let mut page = String::from(
            "# Validation\n\n\
             Made by `squama validate`, which anyone can run again; this page is checked against it by a test.\n\n",
        );
        let sections = [
            self.benchmark_section(),
            self.claim_section(),
            self.soundness.section(),
            GapCount::section(&self.gap_counts),
            self.sensitivity_section(),
            self.coupling_section(),
        ];
        let between = self.between.iter().map(BetweenPoints::section);
        let sections: Vec<String> = sections.into_iter().chain(between).collect();
        page.push_str(&sections.join("\n"));
        page
    }

    fn benchmark_section(&self) -> String {
        let mut text = String::from(
            "## Benchmarks\n\n\
             Problems with known answers. *Order* is the observed order of convergence, where meshes are refined. A reference \
             that is itself an approximation has its known error as band. `squama validate` exits with 1 if a \
             difference leaves its band.\n\n\
             | Problem | Source | Reference | Ours | Difference | Band | Order |\n|---|---|--:|--:|--:|--:|--:|\n",
        );
        for benchmark in &self.benchmarks {
            let _ = writeln!(text, "{}", benchmark.row());
        }
        text
    }

    fn claim_section(&self) -> String {
        let count = |base: usize, verdict| {
            self.claims.iter().filter(|claim| claim.verdicts[base] == verdict).count()
        };
        let counts = |base| {
            let [yes, part, no] = [Verdict::Reproduced, Verdict::InPart, Verdict::NotReproduced]
                .map(|verdict| count(base, verdict));
            format!("{yes} reproduced, {part} in part, {no} not")
        };
        let mut text = format!(
            "## The paper's claims\n\n\
             Every checkable claim of Shafiei et al. (2021), on both readings of \"length\": with a base of `L` \
             (`sweeps/paper.toml`) {}; with a base of `2L` (`sweeps/paper-as-written.toml`) {}. Nothing is tuned: what is measured, and \
             the limits, follow from the paper's words alone.\n\n{RULES}\n\
             | | Where | Claim | Measured | Limits | Base L | Base 2L | Why |\n|---|---|---|---|---|---|---|---|\n",
            counts(0),
            counts(1)
        );
        for claim in &self.claims {
            text.push_str(&claim.rows());
        }
        text
    }

    fn sensitivity_section(&self) -> String {
        let mut text = String::from(
            "## Sensitivity\n\n\
             What the paper leaves open, one thing at a time, on 288 of its designs; the sweeps are in `sweeps/sensitivity/`. Designs are \
             `(d/t, L/t, slant)`: the one that is best with equal weights, and the four that are best in one criterion alone.\n\n\
             | Sweep | Setting | F_c* at (0.1, 0.1, 75°) | Balanced | Coverage | Critical force | Penetration | Compliance |\n\
             |---|---|--:|---|---|---|---|---|\n",
        );
        for setting in &self.sensitivity {
            let _ = writeln!(text, "{}", setting.row());
        }
        text
    }

    fn coupling_section(&self) -> String {
        let mut text = String::from(
            "## Coupling through the substrate\n\n\
             Eq. (1) lets a scale feel its two nearest neighbours, and no rotation move a force. With `substrate.coupling = \"full\"` the \
             stiffness of the row comes from the boundary elements themselves, eight neighbours on each side and cross terms included. Changes \
             from the one to the other, design by design, on the 288 designs of `sweeps/sensitivity/coupling.toml`; designs that fail with full \
             coupling have a scale that runs into its second neighbour, a contact that the model does not have.\n\n\
             | Measure | Designs | Smallest | Median | Largest | Fail with full coupling |\n|---|--:|--:|--:|--:|--:|\n",
        );
        for effect in &self.coupling {
            let _ = writeln!(text, "{}", effect.row());
        }
        text
    }
}

impl CouplingEffect {
    /// Returns the row of the table in Markdown.
    pub fn row(&self) -> String {
        let [low, median, high] = self.changes.map(|change| match 100.0 * change {
            percent if percent.abs() < 0.05 => "0 %".to_owned(),
            percent => format!("{percent:+.1} %"),
        });
        format!(
            "| {} | {} | {low} | {median} | {high} | {} |",
            self.measure, self.designs, self.lost
        )
    }
}

impl Sensitivity {
    /// Returns the row of the table in Markdown.
    pub fn row(&self) -> String {
        let Headlines { force, balanced, corners } = &self.headlines;
        format!(
            "| {} | {} | {force} | {balanced} | {} |",
            self.sweep,
            self.setting,
            corners.join(" | ")
        )
    }
}

impl Benchmark {
    /// Returns the row of the table in Markdown.
    pub fn row(&self) -> String {
        let order = self.order.map_or_else(String::new, |order| format!("{order:.2}"));
        // Differences at the level of round-off are not the same on every machine.
        let difference = match self.difference() {
            off if off.abs() < 1e-9 => "< 1e-9".to_owned(),
            off => format!("{off:+.1e}"),
        };
        format!(
            "| {} | {} | {:.5} | {:.5} | {difference} | {:.0e} | {order} |",
            self.name, self.source, self.reference, self.ours, self.band
        )
    }
}

impl CheckedClaim {
    /// Returns the rows of the table in Markdown: one for the claim, and one for each statement if there are several.
    pub(crate) fn rows(&self) -> String {
        let Claim { id, place, claim, reason, .. } = &self.claim;
        if let [only] = self.statements.as_slice() {
            return format!("| {id} | {place} | {claim} | {} | {reason} |\n", only.cells());
        }
        let [paper, as_written] = self.verdicts.map(marked);
        let mut rows =
            format!("| {id} | {place} | {claim} | | | {paper} | {as_written} | {reason} |\n");
        for (letter, statement) in ('a'..='z').zip(&self.statements) {
            let _ =
                writeln!(rows, "| {id}{letter} | | {} | {} | |", statement.says, statement.cells());
        }
        rows
    }
}

impl CheckedStatement {
    fn cells(&self) -> String {
        let [paper, as_written] = [0, 1]
            .map(|base| format!("{}: {}", marked(self.found[base].verdict), self.found[base].ours));
        format!("{} | {} | {paper} | {as_written}", self.measured, self.limits)
    }
}

fn marked(verdict: Verdict) -> String {
    match verdict {
        Verdict::Reproduced => format!("**{verdict}**"),
        _ => verdict.to_string(),
    }
}

//! The validation page in Markdown.

use std::fmt::Write as _;

use crate::{
    Benchmark, CheckedClaim, CouplingEffect, Finding, Headlines, Sensitivity, Validation, Verdict,
};

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
            self.sensitivity_section(),
            self.coupling_section(),
        ];
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
        let count = |sweep: usize, verdict| {
            self.claims.iter().filter(|claim| claim.found[sweep].verdict == verdict).count()
        };
        let counts = |sweep| {
            let [yes, part, no] = [Verdict::Reproduced, Verdict::InPart, Verdict::NotReproduced]
                .map(|verdict| count(sweep, verdict));
            format!("{yes} reproduced, {part} in part, {no} not")
        };
        let mut text = format!(
            "## The paper's claims\n\n\
             Every checkable statement of Shafiei et al. (2021), on both readings of \"length\": with a base of `L` \
             (`sweeps/paper.toml`) {}; with a base of `2L` (`sweeps/paper-as-written.toml`) {}. Nothing is tuned. A number counts \
             as reproduced within 10 % and in part within 30 %, a trend in part if it holds for what the figure shows. \
             Where the paper gives words instead of numbers, \"near 1\" (C08) is a ratio below 1.5, \"about eight\" (C18) 7 to 9 and in part 5 \
             to 11, \"three orders of magnitude\" (C21) a factor of 300 to 3,000 and in part of 30 to 30,000, \"a wide range\" (C29) a share of \
             20 %. C19 and C20 are solved on a strip of 10 t, on which the scales touch. Designs are `(d/t, L/t, slant)`.\n\n\
             | | Where | Claim | Paper | Base L | Base 2L | Why |\n|---|---|---|---|---|---|---|\n",
            counts(0),
            counts(1)
        );
        for claim in &self.claims {
            let _ = writeln!(text, "{}", claim.row());
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
    /// Returns the row of the table in Markdown.
    pub fn row(&self) -> String {
        let cell = |finding: &Finding| match finding.verdict {
            Verdict::Reproduced => format!("**{}**: {}", finding.verdict, finding.ours),
            verdict => format!("{verdict}: {}", finding.ours),
        };
        let [paper, as_written] = [cell(&self.found[0]), cell(&self.found[1])];
        let claim = &self.claim;
        format!(
            "| {} | {} | {} | {} | {paper} | {as_written} | {} |",
            claim.id, claim.place, claim.claim, claim.reported, self.reason
        )
    }
}

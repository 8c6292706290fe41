//! Reads the contents of a results folder that figures and the HTML report show.

use std::path::PathBuf;

use ranking::{
    Criterion, InvalidRanking, Preferences, Ranking, TetrahedralGrid, check_comparable,
    comparable_groups,
};
use report::{Designs, Fact, facts};
use results::{InvalidResults, Results, ResultsFolder, VerifiedFolder};
use sweep::Sweep;

use crate::print::note;

/// The contents of a results folder that figures and the HTML report show.
pub struct FolderContents {
    /// The path of the folder.
    pub folder: PathBuf,
    /// The sweep that was run.
    pub sweep: Sweep,
    /// Table of the designs; a selection of the designs if the table is large.
    pub designs: Designs,
    /// Facts about the run, from its record.
    pub run: Vec<Fact>,
    results: Results,
}

impl FolderContents {
    /// Returns the results folder with its verified files.
    pub fn verified(&self) -> &VerifiedFolder {
        self.results.verified_folder()
    }

    /// Returns the name of the sweep as a title.
    ///
    /// If the run is incomplete or the table thinned out, the title states the number of designs.
    pub fn title(&self) -> String {
        let name = self.sweep.name();
        let shortfall = self.verified().shortfall();
        let (shown, all) = (self.results.len(), self.results.in_table());
        let shown = (shown < all).then(|| format!("showing {shown} of {all} designs: evenly spaced ones, and the best by each criterion"));
        let remarks: Vec<_> = shortfall.into_iter().chain(shown).collect();
        if remarks.is_empty() {
            name.to_owned()
        } else {
            format!("{name} ({})", remarks.join("; "))
        }
    }
}

impl FolderContents {
    /// Reads `run.toml` and `designs.csv`; keeps about `most` designs of a larger table.
    pub fn read(verified: &VerifiedFolder, most: usize) -> anyhow::Result<Self> {
        let folder = verified.path();
        let run = verified.text(ResultsFolder::RUN_INFO)?;
        let record = folder.join(ResultsFolder::RUN_INFO).display().to_string();
        let sweep = Sweep::parse(&run, &record, &[])?;
        let results = Results::thinned(verified, most)?;
        let designs = Designs::of(&results);
        Ok(Self { folder: folder.to_owned(), sweep, designs, run: facts(&run), results })
    }

    /// Returns a ranking for each group of comparable designs.
    ///
    /// The list is empty if there is nothing to rank.
    pub fn rankings(&self) -> Result<Vec<Ranking<'_>>, InvalidRanking> {
        let groups = match comparable_groups(&self.results, &self.preferences()) {
            Err(InvalidResults::NoColumn { .. }) => return Ok(Vec::new()),
            groups => groups?,
        };
        let rankings = groups.into_iter().map(|preferences| self.ranking(preferences));
        rankings.filter_map(Result::transpose).collect()
    }

    /// Returns the ranking of all designs.
    ///
    /// If the designs are not comparable, prints a note and returns `None`.
    pub fn comparable_ranking(&self) -> Result<Option<Ranking<'_>>, InvalidRanking> {
        let preferences = self.preferences();
        match check_comparable(&self.results, &preferences) {
            Err(InvalidRanking::Incomparable(why)) => {
                note(&format!("the figure of the best designs is left out: {why}"));
                Ok(None)
            }
            // `ranking` handles all other errors, such as a missing column.
            Ok(()) | Err(_) => self.ranking(preferences),
        }
    }

    /// Returns preferences with the default criteria of the sweep, and equal weights.
    ///
    /// If the sweep has no valid default criteria, returns the preferences of the paper.
    fn preferences(&self) -> Preferences {
        let paper = Preferences::paper();
        let usual = Criterion::usual(Some(&self.sweep));
        Preferences::new(Vec::new(), usual, None, paper.scale).unwrap_or(paper)
    }

    /// Ranks the designs; returns `None` if there is nothing to rank.
    fn ranking(&self, preferences: Preferences) -> Result<Option<Ranking<'_>>, InvalidRanking> {
        match Ranking::by(&self.results, preferences, TetrahedralGrid::default()) {
            Ok(ranking) => Ok(Some(ranking)),
            // There is nothing to rank if the sweep has too few measures, or if no design has a
            // value for every criterion and meets the requirements.
            Err(
                InvalidRanking::Nothing { .. }
                | InvalidRanking::Unmet(_)
                | InvalidRanking::Results(InvalidResults::NoColumn { .. }),
            ) => Ok(None),
            Err(error) => Err(error),
        }
    }
}

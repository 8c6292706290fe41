//! The page of a search, which reloads itself while the search is running.

use std::io::{self, Write};

use crate::template::{escaped, fill, fill_head};

const PAGE: &str =
    concat!(include_str!("../assets/page/head.html"), include_str!("../assets/page/search.html"));
const STYLES: [&str; 2] =
    [include_str!("../assets/page/styles/theme.css"), include_str!("../assets/explore/page.css")];

/// The content of the page of a search.
#[derive(Clone, Debug, Default)]
pub struct SearchPage {
    /// The title.
    pub title: String,
    /// The version of the program.
    pub version: String,
    /// The status of the search, as printed on the command line.
    pub status: String,
    /// Warnings, such as checks that the optimum fails.
    pub notes: Vec<String>,
    /// The figures, as SVG.
    pub figures: Vec<String>,
    /// Seconds after which the page reloads itself; `None` for a search that has ended.
    pub reload_after: Option<u32>,
}

impl SearchPage {
    /// Writes the page as a self-contained HTML file.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        fill(out, PAGE, |out, place| match place {
            "style" => out.write_all(STYLES.concat().as_bytes()),
            "status" => out.write_all(escaped(&self.status).as_bytes()),
            "notes" => self
                .notes
                .iter()
                .try_for_each(|note| writeln!(out, "<p class=\"doubt\">⚠ {}</p>", escaped(note))),
            "figures" => self.figures.iter().try_for_each(|svg| out.write_all(svg.as_bytes())),
            "reload" => self.reload_after.map_or(Ok(()), |seconds| {
                let script = format!("setTimeout(() => location.reload(), {});", 1000 * seconds);
                writeln!(out, "<script>{script}</script>")
            }),
            _ => fill_head(out, place, &self.title, &self.version),
        })
    }
}

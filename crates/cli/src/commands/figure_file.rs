//! Files of drawings and figures.

use std::borrow::Cow;
use std::io::Write as _;
use std::ops::RangeInclusive;
use std::path::Path;

use anyhow::{Context as _, ensure};
use results::AtomicFile;

use crate::args::FigureOutput;

/// Dots per inch that an image may have.
const DPI: RangeInclusive<f64> = 24.0..=2400.0;

/// Names of the files that were written.
#[derive(Debug, Default)]
pub struct Written(Vec<String>);

impl Written {
    /// The names of the files.
    pub fn names(&self) -> &[String] {
        &self.0
    }

    /// A line for each file that was written, for people.
    pub fn report(&self, folder: &Path) -> String {
        let line = |file: &String| format!("{}\n", folder.join(file).display());
        self.0.iter().map(line).collect()
    }
}

/// The longest list of names in the name of a file.
const LONGEST: usize = 100;

/// `names` with hyphens between, for the name of a file; the first and the last with their number if there are too many
/// `things` for one.
pub fn joined(names: &[String], things: &str) -> String {
    let all = names.join("-");
    match names {
        [first, .., last] if all.len() > LONGEST => {
            let ends = format!("{first}-to-{last}-");
            let ends = if ends.len() > LONGEST { String::new() } else { ends };
            format!("{ends}{}-{things}", names.len())
        }
        _ => all,
    }
}

/// Refuses a density of images that no image has.
pub fn check_dpi(output: &FigureOutput) -> anyhow::Result<()> {
    let dpi = output.dpi;
    ensure!(
        DPI.contains(&dpi),
        "--dpi {dpi}: out of range, expected {} to {}",
        DPI.start(),
        DPI.end()
    );
    Ok(())
}

/// Writes a drawing as `output` asks for, with its image if there is to be one.
pub fn write_svg(
    folder: &Path,
    name: &str,
    svg: &str,
    output: &FigureOutput,
    files: &mut Written,
) -> anyhow::Result<()> {
    let svg = if output.no_title { Cow::Owned(report::untitled(svg)) } else { Cow::Borrowed(svg) };
    let image = output.png.then(|| image(&svg, output.dpi)).transpose()?;
    write(folder, format!("{name}.svg"), svg.as_bytes(), files)?;
    match image {
        Some(image) => write(folder, format!("{name}.png"), &image, files),
        None => Ok(()),
    }
}

#[cfg(feature = "png")]
fn image(svg: &str, dpi: f64) -> anyhow::Result<Vec<u8>> {
    Ok(report::png(svg, dpi)?)
}

#[cfg(not(feature = "png"))]
fn image(_: &str, _: f64) -> anyhow::Result<Vec<u8>> {
    anyhow::bail!(
        "--png: this squama was built without images, expected one that is built with them: \
         cargo run --release --features png -- followed by the same arguments"
    )
}

/// Writes a page.
pub fn write_html(
    folder: &Path,
    name: &str,
    page: &str,
    files: &mut Written,
) -> anyhow::Result<()> {
    // A page of some megabytes that a kill has left half-written goes with the next one.
    results::make_folder(folder)?;
    write(folder, format!("{name}.html"), page.as_bytes(), files)
}

fn write(folder: &Path, name: String, bytes: &[u8], files: &mut Written) -> anyhow::Result<()> {
    let mut file = AtomicFile::create(folder, &name)?;
    let written = file.write_all(bytes);
    written.with_context(|| format!("{}: cannot be written", file.path().display()))?;
    file.finish()?;
    files.0.push(name);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_names_are_cut_short() {
        let numbers = |count: u32| (1..=count).map(|n| format!("{n:04}")).collect::<Vec<_>>();
        assert_eq!(joined(&numbers(3), "designs"), "0001-0002-0003");
        assert_eq!(joined(&numbers(45), "designs"), "0001-to-0045-45-designs");
        assert_eq!(joined(&["x".repeat(90), "y".repeat(90)], "designs"), "2-designs");
    }
}

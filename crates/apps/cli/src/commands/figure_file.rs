//! Files of drawings and figures.

use std::borrow::Cow;
use std::io::{self, BufWriter, Write as _};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use clap::Args;
use report::{resized, smallest_letters, untitled};
use results::{AtomicFile, VerifiedFolder};

use super::derivation;
use super::options::decimal;
use crate::print::{note, print};

/// Where figures go, and as what.
#[derive(Debug, Args)]
pub struct FigureOutput {
    /// Also write each figure as a PNG image, if squama is built with --features png
    #[arg(long)]
    pub png: bool,

    /// Resolution of images in dots per inch; 96 gives the size of the figure in pixels
    #[arg(long, value_name = "DPI", default_value = "192", allow_hyphen_values = true, value_parser = decimal)]
    pub dpi: f64,

    /// Omit the titles, for captions of your own
    #[arg(long)]
    pub no_title: bool,

    /// Width of the figures on paper in mm, e.g. 85 for a column; text shrinks in proportion [default: 1 px for 1/96 inch]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = decimal)]
    pub width: Option<f64>,

    /// Size of the smallest letters on paper in pt, e.g. 7; each figure becomes as wide as that takes
    #[arg(long, value_name = "PT", allow_hyphen_values = true, value_parser = decimal, conflicts_with = "width")]
    pub font_size: Option<f64>,

    /// Folder for the figures [default: a folder in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The smallest letters that journals print, pt.
const READABLE: f64 = 6.0;

/// Dots per inch that an image may have.
const DPI: RangeInclusive<f64> = 24.0..=2400.0;

/// Figures on their way into a folder.
pub struct FigureFiles<'a> {
    folder: PathBuf,
    output: &'a FigureOutput,
    names: Vec<String>,
}

impl<'a> FigureFiles<'a> {
    /// Makes the folder: that of `output`, or the default.
    pub fn new(
        output: &'a FigureOutput,
        default: impl FnOnce() -> PathBuf,
    ) -> anyhow::Result<Self> {
        let folder = output.out.clone().unwrap_or_else(default);
        results::make_folder(&folder)?;
        Ok(Self { folder, output, names: Vec::new() })
    }

    /// Writes a drawing, with its image if there is to be one.
    pub fn svg(&mut self, name: &str, svg: &str) -> anyhow::Result<()> {
        let output = self.output;
        let svg = if output.no_title { Cow::Owned(untitled(svg)) } else { Cow::Borrowed(svg) };
        if let Some(width) = output.width {
            question_letters(name, &svg, width);
        }
        // The size of letters is in proportion to the width.
        let by_letters = || Some(output.font_size? / smallest_letters(&svg, 1.0)?);
        let svg = match output.width.or_else(by_letters) {
            Some(width) => Cow::Owned(resized(&svg, width)),
            None => svg,
        };
        // An image that cannot be made leaves no drawing without it.
        let image = output.png.then(|| image(&svg, output.dpi)).transpose()?;
        self.write(format!("{name}.svg"), svg.as_bytes())?;
        image.map_or(Ok(()), |image| self.write(format!("{name}.png"), &image))
    }

    /// Writes a page.
    pub fn html(&mut self, name: &str, page: &str) -> anyhow::Result<()> {
        self.write(format!("{name}.html"), page.as_bytes())
    }

    fn write(&mut self, name: String, bytes: &[u8]) -> anyhow::Result<()> {
        write(&self.folder, &name, |file| file.write_all(bytes))?;
        self.names.push(name);
        Ok(())
    }

    /// Notes in a folder of results that the figures are made from its tables.
    pub fn note(&self, results: &VerifiedFolder) -> anyhow::Result<()> {
        derivation::record(results, "figures", &self.folder, &self.names)
    }

    /// Prints a line for each file.
    pub fn print(&self) -> io::Result<()> {
        let line = |name: &String| format!("{}\n", self.folder.join(name).display());
        print(&self.names.iter().map(line).collect::<String>())
    }
}

/// Says which letters nobody can read on paper.
fn question_letters(name: &str, svg: &str, width: f64) {
    let smallest = smallest_letters(svg, width).filter(|points| *points < READABLE);
    if let Some(points) = smallest {
        let wide = (width * READABLE / points).ceil();
        note(&format!(
            "{name}.svg: letters of {points:.1} pt on paper; of {READABLE} pt if it is {wide} mm wide"
        ));
    }
}

/// The longest list of names in the name of a file.
// File systems take 255 bytes, of which kind and place of the figure need some, too.
const LONGEST: usize = 100;

/// `names` with hyphens between, for the name of a file; the first and the last with their number if there are too many
/// `things` for one.
pub fn joined(names: &[String], things: &str) -> String {
    let all = names.join("-");
    match names {
        [first, .., last] if all.len() > LONGEST => {
            let ends = format!("{first}-to-{last}-");
            // Designs off the grid are named by all their values, and two of them may be too long.
            let ends = if ends.len() > LONGEST { String::new() } else { ends };
            format!("{ends}{}-{things}", names.len())
        }
        _ => all,
    }
}

/// Widths that a figure may have on paper, mm.
const WIDTHS: RangeInclusive<f64> = 10.0..=2000.0;

/// Sizes that letters may have on paper, pt.
const FONT_SIZES: RangeInclusive<f64> = 1.0..=72.0;

/// Refuses a density of images that no image has, and sizes that no paper has.
pub fn check_sizes(output: &FigureOutput) -> anyhow::Result<()> {
    let given = [
        ("--dpi", Some(output.dpi), DPI),
        ("--width", output.width, WIDTHS),
        ("--font-size", output.font_size, FONT_SIZES),
    ];
    for (option, value, range) in given {
        let Some(value) = value else { continue };
        let (low, high) = (range.start(), range.end());
        ensure!(range.contains(&value), "{option} {value}: out of range, expected {low} to {high}");
    }
    Ok(())
}

#[cfg(feature = "png")]
fn image(svg: &str, dpi: f64) -> anyhow::Result<Vec<u8>> {
    Ok(report::png(svg, dpi)?)
}

#[cfg(not(feature = "png"))]
fn image(_: &str, _: f64) -> anyhow::Result<Vec<u8>> {
    anyhow::bail!(
        "--png: this squama was built without images; build it with them: \
         cargo run --release --features png -- followed by the same arguments"
    )
}

/// Writes a file, whole or not at all.
pub fn write(
    folder: &Path,
    name: &str,
    written: impl FnOnce(&mut BufWriter<AtomicFile>) -> io::Result<()>,
) -> anyhow::Result<()> {
    let mut file = BufWriter::new(AtomicFile::create(folder, name)?);
    let written = written(&mut file).and_then(|()| file.flush());
    written.with_context(|| format!("{}: cannot be written", file.get_ref().path().display()))?;
    file.into_inner()?.finish()?;
    Ok(())
}

/// As [`write()`], by the path of the file, whose folder is rid of what killed processes have left half-written there.
pub fn write_file(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let folder = file.parent().unwrap_or(Path::new(""));
    results::make_folder(folder)?;
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    write(folder, &name, |file| file.write_all(bytes))
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

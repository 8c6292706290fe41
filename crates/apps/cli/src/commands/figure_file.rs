//! Writes drawings, figures and pages to files.

use std::borrow::Cow;
use std::io::{self, BufWriter, Write as _};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use clap::Args;
use report::{Figure, Paper, resized, smallest_letters, untitled};
use results::{AtomicFile, VerifiedFolder};

use super::derivation;
use super::options::decimal;
use super::own_files::require_own;
use crate::print::{note, print};

/// Options for the format and folder of figures.
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

    /// Width of the figures on paper in mm, e.g. 85 for a column of a page; narrow figures have
    /// fewer panels, and drawings shrink [default: 1 px for 1/96 inch]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = decimal)]
    pub width: Option<f64>,

    /// Size of the smallest letters on paper in pt, e.g. 7; each figure becomes as wide as this
    /// size requires
    #[arg(long, value_name = "PT", allow_hyphen_values = true, value_parser = decimal, conflicts_with = "width")]
    pub font_size: Option<f64>,

    /// Folder for the figures [default: a folder in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl FigureOutput {
    /// Returns the paper width for which figures are laid out.
    pub fn paper(&self) -> Paper {
        self.width.map_or(Paper::WIDE, Paper::of_width)
    }
}

/// Smallest font size accepted by journals, pt.
const READABLE: f64 = 6.0;

/// Accepted resolutions of images, dots per inch.
const DPI: RangeInclusive<f64> = 24.0..=2400.0;

/// Folder to which figures are written, with the names of the written files.
pub struct FigureFiles<'a> {
    folder: PathBuf,
    output: &'a FigureOutput,
    names: Vec<String>,
}

impl<'a> FigureFiles<'a> {
    /// Creates the folder for the figures: the folder of `--out`, or otherwise `default`.
    pub fn new(
        output: &'a FigureOutput,
        default: impl FnOnce() -> PathBuf,
    ) -> anyhow::Result<Self> {
        let folder = output.out.clone().unwrap_or_else(default);
        results::make_folder(&folder)?;
        Ok(Self { folder, output, names: Vec::new() })
    }

    /// Writes a drawing as SVG, and as PNG if requested.
    pub fn svg(&mut self, name: &str, svg: &str) -> anyhow::Result<()> {
        let output = self.output;
        let svg = if output.no_title { Cow::Owned(untitled(svg)) } else { Cow::Borrowed(svg) };
        if let Some(width) = output.width {
            note_small_letters(name, &svg, width);
        }
        // Compute the width from the font size, which is proportional to the width.
        let width = output.width.or_else(|| Some(output.font_size? / smallest_letters(&svg, 1.0)?));
        let svg = match width {
            Some(width) => Cow::Owned(resized(&svg, width)),
            None => svg,
        };
        // Render the image first, so that no file is written if rendering fails.
        let image = output.png.then(|| image(&svg, output.dpi)).transpose()?;
        // The comment marks the file as written by squama, so that a later command may replace it.
        let marked = format!("{svg}<!-- squama -->\n");
        self.write(format!("{name}.svg"), marked.as_bytes())?;
        image.map_or(Ok(()), |image| self.write(format!("{name}.png"), &image))
    }

    /// Writes a figure, and prints a note about panels that do not fit on the paper.
    pub fn figure(&mut self, figure: &Figure) -> anyhow::Result<()> {
        if let Some(omitted) = &figure.omitted {
            note(&format!("{}.svg: {omitted}", figure.name));
        }
        self.svg(&figure.name, &figure.svg)
    }

    /// Writes an HTML page.
    pub fn html(&mut self, name: &str, page: &str) -> anyhow::Result<()> {
        self.write(format!("{name}.html"), page.as_bytes())
    }

    fn write(&mut self, name: String, bytes: &[u8]) -> anyhow::Result<()> {
        write(&self.folder, &name, |file| file.write_all(bytes))?;
        self.names.push(name);
        Ok(())
    }

    /// Records in the results folder that the figures were made from its tables.
    pub fn record(&self, results: &VerifiedFolder) -> anyhow::Result<()> {
        derivation::record(results, "figures", &self.folder, &self.names)
    }

    /// Prints the path of each written file on a line.
    pub fn print(&self) -> io::Result<()> {
        let lines = self.names.iter().map(|name| format!("{}\n", self.folder.join(name).display()));
        print(&lines.collect::<String>())
    }
}

/// Prints a note if the smallest letters of a figure `width` mm wide are too small to read.
fn note_small_letters(name: &str, svg: &str, width: f64) {
    let smallest = smallest_letters(svg, width).filter(|points| *points < READABLE);
    if let Some(points) = smallest {
        let wide = (width * READABLE / points).ceil();
        note(&format!(
            "{name}.svg: the smallest letters are {points:.1} pt on paper; a width of at least {wide} mm gives {READABLE} pt"
        ));
    }
}

/// Maximum length, in bytes, of a list of names within a file name.
// A file name has at most 255 bytes, including the kind of figure and the points on the path.
const LONGEST: usize = 100;

/// Joins `names` with hyphens for a file name.
///
/// A long list is abbreviated to `FIRST-to-LAST-COUNT-THINGS` or `COUNT-THINGS`, where `things` is
/// the plural noun for the names, such as `designs`.
pub fn joined(names: &[String], things: &str) -> String {
    let all = names.join("-");
    match names {
        [first, .., last] if all.len() > LONGEST => {
            let ends = format!("{first}-to-{last}-");
            // The name of a design off the grid contains all its values, so even two names may be
            // too long.
            let ends = if ends.len() > LONGEST { String::new() } else { ends };
            format!("{ends}{}-{things}", names.len())
        }
        _ => all,
    }
}

/// Accepted widths of figures on paper, mm.
const WIDTHS: RangeInclusive<f64> = 10.0..=2000.0;

/// Accepted font sizes on paper, pt.
const FONT_SIZES: RangeInclusive<f64> = 1.0..=72.0;

/// Rejects resolutions, widths and font sizes out of range.
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

/// Writes the file `name` in `folder` atomically; `content` writes the content of the file.
///
/// Returns an error instead of replacing a file that squama did not write.
pub fn write(
    folder: &Path,
    name: &str,
    content: impl FnOnce(&mut BufWriter<AtomicFile>) -> io::Result<()>,
) -> anyhow::Result<()> {
    require_own(&folder.join(name))?;
    let mut file = BufWriter::new(AtomicFile::create(folder, name)?);
    let written = content(&mut file).and_then(|()| file.flush());
    written.with_context(|| format!("{}: cannot be written", file.get_ref().path().display()))?;
    file.into_inner()?.finish()?;
    Ok(())
}

/// Writes `bytes` atomically to the path `file`; see [`write()`].
///
/// Creates the folder if necessary, and removes partial files of killed processes from it.
pub fn write_file(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let folder = file.parent().unwrap_or(Path::new(""));
    results::make_folder(folder)?;
    write(folder, utf8_name(file)?, |file| file.write_all(bytes))
}

/// Returns the name of an output file; a name that is not UTF-8 is an error.
pub fn utf8_name(file: &Path) -> anyhow::Result<&str> {
    let name = file.file_name().unwrap_or_default().to_str();
    name.with_context(|| format!("{}: cannot be written, expected a name in UTF-8", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_of_names_are_abbreviated() {
        let numbers: Vec<String> = (1..=45).map(|n| format!("{n:04}")).collect();
        assert_eq!(joined(&numbers[..3], "designs"), "0001-0002-0003");
        assert_eq!(joined(&numbers, "designs"), "0001-to-0045-45-designs");
        assert_eq!(joined(&["x".repeat(90), "y".repeat(90)], "designs"), "2-designs");
    }
}

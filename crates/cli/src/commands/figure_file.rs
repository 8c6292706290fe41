//! Files of drawings and figures.

use std::io::Write as _;
use std::path::Path;

use anyhow::Context as _;
use results::AtomicFile;

/// Names of the files that were written.
#[derive(Debug, Default)]
pub struct Written(Vec<String>);

impl Written {
    /// A line for each file that was written, for people.
    pub fn report(&self, folder: &Path) -> String {
        let line = |file: &String| format!("{}\n", folder.join(file).display());
        self.0.iter().map(line).collect()
    }
}

/// Writes a drawing, and its image if `png`.
pub fn write_svg(
    folder: &Path,
    name: &str,
    svg: &str,
    png: bool,
    files: &mut Written,
) -> anyhow::Result<()> {
    let image = png.then(|| image(svg)).transpose()?;
    write(folder, format!("{name}.svg"), svg.as_bytes(), files)?;
    match image {
        Some(image) => write(folder, format!("{name}.png"), &image, files),
        None => Ok(()),
    }
}

#[cfg(feature = "png")]
fn image(svg: &str) -> anyhow::Result<Vec<u8>> {
    Ok(report::png(svg)?)
}

#[cfg(not(feature = "png"))]
fn image(_: &str) -> anyhow::Result<Vec<u8>> {
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

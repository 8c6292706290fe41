//! The command `squama init`, which writes a definition from a template.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, Args, Command};
use sweep::{Sweep, entries};

use super::DONE;
use super::figure_file::write_file;
use super::schema::{SCHEMA_FILE, schema_text};
use super::source::{Defined, defined_by, require_folder_of};
use crate::print::{counted, print};

/// Names and texts of the templates; each name is also the default name of its sweep.
// The first template is the default.
const TEMPLATES: [(&str, &str); 10] = [
    ("paper", include_str!("../../sweeps/paper.toml")),
    ("smoke", include_str!("../../sweeps/smoke.toml")),
    ("glove", include_str!("../../sweeps/glove.toml")),
    ("goal", include_str!("../../sweeps/goals/strong-and-covered.toml")),
    ("pin", include_str!("../../sweeps/goals/pin.toml")),
    ("fit", include_str!("../../sweeps/fit/palm.toml")),
    ("gaps", include_str!("../../sweeps/gaps.toml")),
    ("imperfection", include_str!("../../sweeps/imperfection.toml")),
    ("paper-as-written", include_str!("../../sweeps/paper-as-written.toml")),
    ("paper-neo-hookean", include_str!("../../sweeps/paper-neo-hookean.toml")),
];

/// File names and texts of the measured curves that the template `fit` refers to.
const CURVES: [(&str, &str); 3] = [
    ("puncture-a.csv", include_str!("../../sweeps/fit/puncture-a.csv")),
    ("puncture-b.csv", include_str!("../../sweeps/fit/puncture-b.csv")),
    ("bending.csv", include_str!("../../sweeps/fit/bending.csv")),
];

/// Arguments of `squama init`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama init                       write the sweep of the paper to paper.toml
  squama init mine.toml             write the sweep of the paper, with the name mine
  squama init smoke mine.toml       write a sweep of a dozen designs
  squama init pin mine.toml         a goal in millimetres and newtons for squama optimise
  squama init fit mine.toml         a fit to test data, with example curves

The template paper explains every key. An existing file is never overwritten.
The file names its JSON schema, squama.schema.json, which editors with Taplo or Even Better TOML
use; it is written beside the file if there is none.
Exit code: 0 done, 2 bad input or a disk error.")]
pub struct Arguments {
    /// Template to start from [default if only FILE is given: paper]
    #[arg(value_name = "TEMPLATE", default_value = "paper", value_parser = TemplateOrFile)]
    pub template: String,

    /// File to write; the sweep is named after it [default: TEMPLATE.toml]
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
}

/// Writes a commented definition.
pub fn init(arguments: &Arguments) -> anyhow::Result<u8> {
    let (template, file) = template_and_file(arguments);
    let shown = file.display().to_string();
    ensure!(
        // `symlink_metadata` also finds a dangling link, which must not be overwritten.
        file.symlink_metadata().is_err(),
        "{shown}: exists already; give the name of a new file, e.g. squama init {template} mine.toml"
    );
    require_folder_of("FILE", &file)?;
    let name = file.file_stem().context("expected the name of a new file")?.to_string_lossy();
    let text = definition(&template, &name, &shown).context("there is no such template")?;
    // Parse the definition before writing it, to reject an invalid name.
    let (content, command) = if template == "fit" {
        let entries = entries(&text, &shown, &[])?;
        let definition = entries.into_iter().filter(|entry| entry.key != "curve").collect();
        let sweep = Sweep::of_entries(&definition, &shown)?;
        let variables = sweep.variables().len() as u64;
        (format!("a fit of {}", counted(variables, "parameter")), "fit")
    } else {
        match defined_by(&text, &file, &[])? {
            Defined::Goal(goal) => {
                let variables = goal.space.parameters().count() as u64;
                (format!("a goal with {}", counted(variables, "variable")), "optimise")
            }
            Defined::Sweep(sweep) => (counted(sweep.grid().len(), "design"), "run"),
        }
    };
    let curves = CURVES.iter().filter(|_| template == "fit");
    let curves: Vec<_> = curves.map(|(name, text)| (file.with_file_name(name), *text)).collect();
    for (curve, _) in &curves {
        ensure!(curve.symlink_metadata().is_err(), "{}: exists already", curve.display());
    }
    write_file(&file, text.as_bytes())?;
    for (curve, text) in curves {
        write_file(&curve, text.as_bytes())?;
    }
    let schema = file.with_file_name(SCHEMA_FILE);
    if schema.symlink_metadata().is_err() {
        write_file(&schema, schema_text().as_bytes())?;
    }
    let solve = if command == "run" { "solve them" } else { "solve it" };
    print(&format!("{shown}: {content}; to {solve}: squama {command} {shown}\n"))?;
    Ok(DONE)
}

/// Returns the names of the template and of the file.
///
/// If only a file is given, the template is the first entry of [`TEMPLATES`].
fn template_and_file(arguments: &Arguments) -> (String, PathBuf) {
    let template = &arguments.template;
    match &arguments.file {
        Some(file) => (template.clone(), file.clone()),
        None if is_file(template) => (TEMPLATES[0].0.to_owned(), PathBuf::from(template)),
        None => (template.clone(), PathBuf::from(format!("{template}.toml"))),
    }
}

/// Returns true if `argument` is a file name, not the name of a template.
fn is_file(argument: &str) -> bool {
    Path::new(argument).extension().is_some_and(|extension| extension == "toml")
        || argument.contains(['/', '\\'])
}

/// Parser of an argument that is the name of a template or of a file.
#[derive(Clone)]
struct TemplateOrFile;

impl TypedValueParser for TemplateOrFile {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        let templates = PossibleValuesParser::new(TEMPLATES.map(|(name, _)| name));
        match value.to_str().filter(|value| is_file(value)) {
            Some(file) => Ok(file.to_owned()),
            None => templates.parse_ref(command, argument, value),
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        // Help and completions list only templates.
        Some(Box::new(TEMPLATES.into_iter().map(|(name, _)| PossibleValue::new(name))))
    }
}

/// Returns the text of `template` for a definition called `name` in `file`.
///
/// `None` if there is no such template.
fn definition(template: &str, name: &str, file: &str) -> Option<String> {
    let (known, text) = TEMPLATES.iter().find(|(known, _)| *known == template)?;
    // The name in the definition of a goal or a fit differs from the name of the template.
    let name_in_text =
        text.lines().find_map(|line| line.strip_prefix("name = \"")?.split('"').next());
    let known = name_in_text.unwrap_or(known);
    let text = text.replace(&format!("name = \"{known}\""), &format!("name = \"{name}\""));
    // Replace the paths in the commands that the comments of the template show.
    let text = text.replace(&format!("results/{known}/"), &format!("results/{name}/"));
    let text = text.replace("sweeps/fit/palm.toml", file);
    let text = text.replace(&format!("sweeps/goals/{known}.toml"), file);
    let text = text.replace(&format!("sweeps/{known}.toml"), file);
    Some(format!("#:schema ./{SCHEMA_FILE}\n{text}"))
}

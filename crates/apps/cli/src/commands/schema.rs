//! The command `squama schema`, which prints the JSON schema of definitions.

use clap::Args;
use fit::{PER_SPECIMEN, curves_schema};
use optimisation::goal_schema;
use serde_json::json;
use sweep::definition_schema;

use super::DONE;
use crate::print::print;

/// Name of the schema file that `squama init` writes beside a definition.
pub const SCHEMA_FILE: &str = "squama.schema.json";

/// Arguments of `squama schema`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama schema > squama.schema.json

A definition that begins with the line

  #:schema ./squama.schema.json

is then completed and checked by editors with Taplo or Even Better TOML. squama init writes both.
squama check also finds contradictions between keys, which a schema cannot express.
Exit code: 0 done, 2 a disk error.")]
pub struct Arguments {}

/// Prints the JSON schema of definitions, goals and fits.
pub fn schema(_: &Arguments) -> anyhow::Result<u8> {
    print(&schema_text())?;
    Ok(DONE)
}

/// Returns the JSON schema of definitions, goals and fits.
pub fn schema_text() -> String {
    let mut keys = definition_schema();
    keys.insert("goal".to_owned(), goal_schema());
    keys.insert("curve".to_owned(), curves_schema());
    let per_specimen = json!({
        "type": "array", "items": { "type": "string" }, "minItems": 1,
        "description": "variables of a fit that differ from specimen to specimen",
    });
    keys.insert(PER_SPECIMEN.to_owned(), per_specimen);
    let schema = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "squama definition",
        "description": "Sweep of squama; [goal] makes it a search, [[curve]] a fit",
        "type": "object",
        "properties": keys,
        "required": ["name"],
        "additionalProperties": false,
    });
    format!("{schema:#}\n")
}

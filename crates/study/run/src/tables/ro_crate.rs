//! Metadata of a results folder, `ro-crate-metadata.json`.
//!
//! The metadata make the folder an RO-Crate (<https://w3id.org/ro/crate/1.1>). Repositories of
//! research data read from them the files, the program and the meaning of each column of
//! `designs.csv`.

use journal::OutputError;
use results::ResultsFolder;
use results::columns::TableLayout;
use serde_json::{Value, json};

use crate::run_journal::Archive;

/// Identifier of the article that describes the model.
const ARTICLE: &str = "https://doi.org/10.1016/j.jmps.2020.104176";

/// Writes the metadata of a run with the files `tables`.
///
/// The metadata have no date, so that they are identical for any number of sessions, threads and
/// shards. Authors, licence and date are added when a folder is published.
pub(super) fn write(
    archive: &Archive,
    folder: &ResultsFolder,
    program: &str,
    layouts: &[TableLayout],
    tables: &[String],
) -> Result<(), OutputError> {
    let name = archive.sweep().name();
    let others = [ResultsFolder::RUN_INFO, ResultsFolder::CONTENTS, ResultsFolder::JOURNAL];
    let files: Vec<_> = tables.iter().map(String::as_str).chain(others).collect();
    let columns = columns(layouts);
    let mut graph = vec![
        json!({
            "@id": ResultsFolder::METADATA,
            "@type": "CreativeWork",
            "conformsTo": reference("https://w3id.org/ro/crate/1.1"),
            "about": reference("./"),
        }),
        json!({
            "@id": "./",
            "@type": "Dataset",
            "name": name,
            "description": format!("{} designs of flexible armour of the sweep {name}, solved by squama", archive.designs().len()),
            "hasPart": files.iter().map(|file| reference(file)).collect::<Value>(),
            "mentions": reference("#run"),
            "variableMeasured": columns.iter().map(|column| json!({ "@id": column["@id"] })).collect::<Value>(),
        }),
        json!({
            "@id": "#run",
            "@type": "CreateAction",
            "name": format!("squama run of {name}"),
            "instrument": reference("#squama"),
            "object": reference(ResultsFolder::RUN_INFO),
            "result": tables.iter().map(|table| reference(table)).collect::<Value>(),
        }),
        json!({
            "@id": "#squama",
            "@type": "SoftwareApplication",
            "name": "squama",
            "version": program,
            "citation": reference(ARTICLE),
        }),
        json!({
            "@id": ARTICLE,
            "@type": "ScholarlyArticle",
            "name": "The very hard and the very soft: Modeling bio-inspired scaled skins using the discrete element method",
        }),
    ];
    graph.extend(files.iter().map(|file| entity(file)));
    graph.extend(columns);
    let crate_ = json!({ "@context": "https://w3id.org/ro/crate/1.1/context", "@graph": graph });
    folder.write_text(ResultsFolder::METADATA, &format!("{crate_:#}\n")).map(|_| ())
}

fn reference(id: &str) -> Value {
    json!({ "@id": id })
}

/// Returns the metadata of a file: name, description and format.
fn entity(file: &str) -> Value {
    let (_, extension) = file.rsplit_once('.').unwrap_or_default();
    let format = match extension {
        "csv" => "text/csv",
        "toml" => "application/toml",
        _ => "application/x-ndjson",
    };
    let description = match file {
        ResultsFolder::DESIGNS => "one row per design, with all its values".to_owned(),
        ResultsFolder::FAILURES => {
            "one row per measure without a value, with the reason".to_owned()
        }
        ResultsFolder::SENSITIVITY => {
            "derivatives of the measures with respect to the parameters".to_owned()
        }
        ResultsFolder::RERUNS => "values that reruns changed, with the settings".to_owned(),
        ResultsFolder::RUN_INFO => "record of the run, with the complete definition".to_owned(),
        ResultsFolder::CONTENTS => "length of the journal and SHA-256 of every table".to_owned(),
        ResultsFolder::JOURNAL => "one line per solved design, with a checksum".to_owned(),
        table => format!("one row per design, with its {}", table.trim_end_matches(".csv")),
    };
    json!({
        "@id": file,
        "@type": "File",
        "name": file,
        "description": description,
        "encodingFormat": format,
    })
}

/// Returns the metadata of each column of `designs.csv`: its name, unit and meaning.
fn columns(layouts: &[TableLayout]) -> Vec<Value> {
    let designs = layouts.iter().find(|layout| layout.file == ResultsFolder::DESIGNS);
    let columns = designs.map(|layout| layout.columns.as_slice()).unwrap_or_default();
    columns
        .iter()
        .map(|column| {
            json!({
                "@id": format!("#{}", column.name),
                "@type": "PropertyValue",
                "name": column.name,
                "unitText": column.unit,
                "description": column.meaning,
            })
        })
        .collect()
}

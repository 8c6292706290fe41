//! Workbooks hold the values of the tables exactly.

use std::fs;
use std::path::Path;

use calamine::{Data, Reader as _, Xlsx, open_workbook};
use results::{Completeness, VerifiedFolder};

use crate::samples::{Criteria, write_results};

/// Returns the cells of a sheet, the header first.
fn sheet(file: &Path, name: &str) -> Vec<Vec<Data>> {
    let mut workbook: Xlsx<_> = open_workbook(file).expect("a workbook");
    let range = workbook.worksheet_range(name).expect("a sheet");
    range.rows().map(<[Data]>::to_vec).collect()
}

fn names(file: &Path) -> String {
    let workbook: Xlsx<_> = open_workbook(file).expect("a workbook");
    workbook.sheet_names().join(" ")
}

/// Returns the expected cells of a sheet: numbers as numbers, everything else as text.
fn expected(table: &str, separator: char) -> Vec<Vec<Data>> {
    let table = table.trim_start_matches('\u{feff}');
    table
        .lines()
        .map(|line| {
            line.split(separator)
                .map(|text| {
                    let number =
                        text.replace(',', ".").parse::<f64>().ok().filter(|n| n.is_finite());
                    match number {
                        _ if text.is_empty() => Data::Empty,
                        Some(number) => Data::Float(number),
                        None => Data::String(text.to_owned()),
                    }
                })
                .collect()
        })
        .collect()
}

/// Opens complete results, verified against `contents.toml` if the file exists.
fn opened(results: &Path) -> VerifiedFolder {
    VerifiedFolder::open(results, Completeness::Whole).expect("results")
}

fn exported(results: &Path) -> std::path::PathBuf {
    let file = results.join("x.xlsx");
    report::export(&opened(results), &[], &file).expect("a workbook");
    file
}

#[test]
fn workbooks_hold_numbers_exactly() {
    let place = tempfile::tempdir().expect("a folder");
    write_results(place.path(), 1, Criteria::Independent, 7);
    let file = exported(place.path());
    let table = fs::read_to_string(place.path().join("designs.csv")).expect("a table");
    assert_eq!(sheet(&file, "designs"), expected(&table, ','));
    assert_eq!(names(&file), "summary designs columns");
}

#[test]
fn extreme_numbers_failures_and_texts_are_preserved() {
    let place = tempfile::tempdir().expect("a folder");
    let designs = "design,gap_over_t,critical_force,puncture_status,base,settings\r\n\
                   0001,0.1,0.30000000000000004,complete,L,\r\n\
                   0002,1e-7,,no convergence,2L,solver.max_step=0.01 <&>\r\n\
                   0003,5e-324,1.7976931348623157e308,complete,nan,inf\r\n";
    let failures = "design,measure,reason,command\r\n\
                    0002,puncture,no convergence,squama design run.toml --design 0002\r\n";
    fs::write(place.path().join("designs.csv"), designs).expect("the file is writable");
    fs::write(place.path().join("failures.csv"), failures).expect("the file is writable");
    let file = exported(place.path());
    assert_eq!(sheet(&file, "designs"), expected(designs, ','));
    assert_eq!(sheet(&file, "failures"), expected(failures, ','));
    assert_eq!(names(&file), "summary designs failures columns");
    let guide = sheet(&file, "columns");
    let columns = ["sheet", "column", "unit", "meaning"].map(text_cell);
    assert_eq!(guide[0], columns);
    assert_eq!(guide.len(), 1 + 6 + 4, "a line for every column");
    let slope = ["designs", "critical_force", "E_s L t/(1-nu^2)"].map(text_cell);
    assert_eq!(guide[3][..3], slope);
    assert!(guide.iter().flatten().all(|cell| *cell != Data::Empty));
}

fn text_cell(text: &str) -> Data {
    Data::String(text.to_owned())
}

#[test]
fn tables_with_decimal_commas_give_the_same_workbook() {
    let place = tempfile::tempdir().expect("a folder");
    let plain = "design,gap_over_t,coverage\r\n0001,0.1,0.25\r\n0002,0.2,1e-7\r\n";
    let comma = "\u{feff}design;gap_over_t;coverage\r\n0001;0,1;0,25\r\n0002;0,2;1e-7\r\n";
    let [one, other] = [("plain", plain), ("comma", comma)].map(|(folder, table)| {
        let folder = place.path().join(folder);
        fs::create_dir(&folder).expect("the file is writable");
        fs::write(folder.join("designs.csv"), table).expect("the file is writable");
        fs::read(exported(&folder)).expect("a workbook")
    });
    assert!(one == other, "the same bytes");
}

#[test]
fn workbooks_are_reproducible() {
    let place = tempfile::tempdir().expect("a folder");
    write_results(place.path(), 1, Criteria::Conflicting, 1);
    let file = exported(place.path());
    let one = fs::read(&file).expect("a workbook");
    let other = fs::read(exported(place.path())).expect("a workbook");
    assert!(one == other, "the same bytes");
    // Neither the archive nor the document contains the time of the export.
    let mut archive =
        zip::ZipArchive::new(fs::File::open(&file).expect("a workbook")).expect("an archive");
    for part in 0..archive.len() {
        let date = archive.by_index(part).expect("a part").last_modified().expect("a date");
        assert_eq!(date.to_string(), "1980-01-01 00:00:00");
    }
    let properties = zip_text(&file, "docProps/core.xml");
    for date in properties.split("W3CDTF\">").skip(1) {
        assert!(date.starts_with("2000-01-01T00:00:00Z"), "{properties}");
    }
    assert_eq!(properties.matches("W3CDTF\">").count(), 2, "dates of creation and modification");
}

#[test]
fn failures_are_red_and_measures_have_a_colour_scale() {
    let place = tempfile::tempdir().expect("a folder");
    let designs = "design,coverage,puncture_status\r\n0001,0.1,complete\r\n0002,0.2,row limit\r\n";
    fs::write(place.path().join("designs.csv"), designs).expect("the file is writable");
    let file = exported(place.path());
    let archive = zip_text(&file, "xl/worksheets/sheet2.xml");
    assert!(archive.contains("<cfRule type=\"colorScale\""));
    assert_eq!(archive.matches("<color rgb=").count(), 3);
    assert!(archive.contains("<conditionalFormatting sqref=\"B2:B3\">"));
    assert!(archive.contains("<autoFilter ref=\"A1:C3\"/>"));
    assert!(archive.contains("state=\"frozen\""));
    let styles = zip_text(&file, "xl/styles.xml");
    let formats = styles.split("<cellXfs").nth(1).expect("formats");
    let [complete, missing, status] = ["A2", "A3", "C3"].map(|cell| {
        let cell = archive.split(&format!("<c r=\"{cell}\" s=\"")).nth(1).expect("a cell");
        let style = cell.split('"').next().expect("a style");
        let style: usize = style.parse().expect("a number");
        let format = formats.split("<xf ").nth(style + 1).expect("a format");
        format.split("fillId=\"").nth(1).expect("a fill").split('"').next().expect("a number")
    });
    assert_eq!(complete, "0", "a design with every value is not red");
    assert_ne!(missing, "0");
    assert_eq!(missing, status);
    assert!(styles.contains("FFFFC7CE"));
}

#[test]
fn the_first_sheet_describes_the_run() {
    let place = tempfile::tempdir().expect("a folder");
    let table = "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,compliance,fold_force\r\n\
                 0001,0.1,1,45,0.5,2,0.1,0.2,1\r\n0002,0.2,1,45,0.7,1,0.1,0.3,\r\n0003,0.2,1,45,0.7,1,0.2,0.1,\r\n";
    fs::write(place.path().join("designs.csv"), table).expect("the file is writable");
    let run = "[run]\nversion = '1'\nstatus = { complete = 3 }\n[definition]\nname = 'x'\n";
    fs::write(place.path().join("run.toml"), run).expect("the file is writable");
    let results = results::Results::read(place.path()).expect("results");
    let preferences = "requirements = ['coverage >= 0.5']\nweights = [1, 3, 0, 0]";
    let preferences = ranking::Preferences::parse(preferences, "x").expect("preferences");
    let ranking = ranking::Ranking::by(&results, preferences, ranking::TetrahedralGrid::default())
        .expect("a ranking");
    ranking::write_ranking(place.path(), &ranking).expect("the file is writable");
    let cells = sheet(&exported(place.path()), "summary");
    let lines = cells.iter().map(|row| {
        let cells = row.iter().filter(|cell| **cell != Data::Empty);
        cells.map(ToString::to_string).collect::<Vec<_>>().join(" | ")
    });
    let lines: Vec<String> = lines.collect();
    let first = lines.iter().take_while(|line| !line.starts_with("Definition"));
    insta::assert_snapshot!(first.cloned().collect::<Vec<_>>().join("\n"));
    let definition = lines.iter().find(|line| line.starts_with("contact.c2"));
    assert_eq!(
        definition.map(String::as_str),
        Some("contact.c2 | 0.23 | - | exponent C2 of the contact law")
    );
}

#[test]
fn round_off_is_hidden_and_measures_have_a_chart() {
    let place = tempfile::tempdir().expect("a folder");
    let table = "design,gap_over_t,length_over_t,slant_deg,compliance\r\n\
                 0001,0.1,1,0,0.7999999996252686\r\n0002,0.1,1,45,0.3\r\n0003,0.2,1,0,0.5\r\n";
    for file in ["designs.csv", "compliance.csv"] {
        fs::write(place.path().join(file), table).expect("the file is writable");
    }
    let file = exported(place.path());
    assert_eq!(names(&file), "summary designs compliance columns");
    let styles = zip_text(&file, "xl/styles.xml");
    assert!(styles.contains("formatCode=\"0.000\""), "{styles}");
    assert_eq!(sheet(&file, "compliance")[1][4], Data::Float(0.799_999_999_625_268_6));
    let chart = zip_text(&file, "xl/charts/chart1.xml");
    assert!(chart.contains("<c:scatterChart>"));
    let ranges = ["compliance!$E$2:$E$3", "compliance!$E$4<", "compliance!$D$2:$D$3"];
    assert!(ranges.iter().all(|range| chart.contains(range)), "{chart}");
    // Headers are plain column names, for programs that read workbooks. The last sheet has units.
    assert_eq!(sheet(&file, "compliance")[0][4], Data::String("compliance".to_owned()));
    let guide = sheet(&file, "columns");
    assert!(guide.iter().any(|row| row[1] == "compliance" && row[2] == "1/(E_m I_m)"));
}

/// Returns the text of a file inside a workbook.
fn zip_text(workbook: &Path, name: &str) -> String {
    let file = fs::File::open(workbook).expect("a workbook");
    let mut archive = zip::ZipArchive::new(file).expect("an archive");
    let file = archive.by_name(name).expect("a file");
    std::io::read_to_string(file).expect("UTF-8 text")
}

#[test]
fn invalid_workbook_names_and_missing_tables_are_rejected() {
    let place = tempfile::tempdir().expect("a folder");
    insta::assert_snapshot!(refused(place.path(), "x.xlsx"), @"R: contains no designs.csv, expected the folder of a run, a search, a tolerance analysis or a fit");
    fs::write(place.path().join("designs.csv"), "design,coverage\r\n0001,1,2\r\n")
        .expect("the file is writable");
    insta::assert_snapshot!(refused(place.path(), "x.xlsx"), @"R/designs.csv: cannot be read (line 2 has 3 cells, the first one 2), expected a table that squama writes");
    fs::write(place.path().join("designs.csv"), b"design,\xff\r\n").expect("the file is writable");
    insta::assert_snapshot!(refused(place.path(), "x.xlsx"), @"R/designs.csv: cannot be read (it is not UTF-8 text), expected a table that squama writes");
    insta::assert_snapshot!(refused(place.path(), "designs.csv"), @"R/designs.csv: a workbook needs a name that ends in .xlsx");
    insta::assert_snapshot!(refused(place.path(), "designs.csv/x.xlsx"), @"R/designs.csv: cannot be written (File exists), expected a folder that can be written, e.g. with --out DIR");
    assert_eq!(fs::read_dir(place.path()).expect("a folder").count(), 1, "no new file");
}

/// Returns the error of an export of `folder`, which the message names `R`.
fn refused(folder: &Path, name: &str) -> String {
    let error = report::export(&opened(folder), &[], &folder.join(name))
        .expect_err("the export is refused");
    error.to_string().replace(&folder.display().to_string(), "R")
}

#[test]
fn tables_longer_than_a_sheet_are_rejected() {
    let place = tempfile::tempdir().expect("a folder");
    let mut longest = "design\r\n1\r\n".to_owned();
    fs::write(place.path().join("designs.csv"), &longest).expect("the file is writable");
    let file = exported(place.path());
    let before = fs::read(&file).expect("a workbook");
    longest += &"1\r\n".repeat(1_048_574);
    fs::write(place.path().join("designs.csv"), longest + "1\r\n").expect("the file is writable");
    let error = report::export(&opened(place.path()), &[], &file)
        .expect_err("the export is refused")
        .to_string();
    let error = error.replace(&place.path().display().to_string(), "R");
    insta::assert_snapshot!(error, @"R/designs.csv: has more than 1048575 rows, the maximum of a sheet of Excel; export a smaller run, e.g. one with --sample 1048575");
    assert!(fs::read(&file).expect("a workbook") == before, "the old file is kept");
}

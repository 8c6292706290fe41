//! DXF of outlines: closed polylines in millimetres, in format version 2000 (`AC1015`).

use std::fmt::Write as _;

use crate::Sheet;

/// Colour numbers of [`Sheet::LAYERS`]: red, blue, grey.
const COLORS: [u8; 3] = [1, 5, 8];

/// Text of a DXF file: lines in pairs of a group code and a value.
struct Groups {
    text: String,
    /// The last assigned handle.
    handle: u32,
}

/// Fixed handle of the block record of model space.
const MODEL: &str = "1F";
/// Fixed handle of the block record of paper space.
const PAPER: &str = "1B";

pub(crate) fn write(sheet: &Sheet) -> String {
    // Smaller handles are reserved for the fixed handles of tables, blocks and dictionaries.
    let mut groups = Groups { text: String::new(), handle: 0xFF };
    groups.tables();
    groups.section("BLOCKS", |groups| {
        groups.block("*Model_Space", MODEL, ["20", "21"]);
        groups.block("*Paper_Space", PAPER, ["1C", "1D"]);
    });
    groups.section("ENTITIES", |groups| {
        for outline in sheet.outlines() {
            groups.entity("LWPOLYLINE", MODEL);
            groups.add(&[(100, "AcDbEntity"), (8, outline.layer), (100, "AcDbPolyline")]);
            // Group code 90 is the number of corners; code 70 with value 1 closes the polyline.
            groups.add(&[(90, &outline.corners.len().to_string()), (70, "1")]);
            for [x, y] in &outline.corners {
                groups.add(&[(10, &x.to_string()), (20, &y.to_string())]);
            }
        }
    });
    groups.section("OBJECTS", |groups| {
        groups.add(&[(0, "DICTIONARY"), (5, "C"), (330, "0"), (100, "AcDbDictionary")]);
        groups.add(&[(281, "1"), (3, "ACAD_GROUP"), (350, "D")]);
        groups.add(&[(0, "DICTIONARY"), (5, "D"), (330, "C"), (100, "AcDbDictionary"), (281, "1")]);
    });
    // The header is created last, because it contains the next free handle. In the file it is
    // first.
    let mut header = Groups { text: String::new(), handle: 0 };
    // Group code 999 is a comment.
    header.add(&[(999, "squama")]);
    let [low, high] = sheet.bounds().map(|at| at.map(|length| length.to_string()));
    header.section("HEADER", |header| {
        header.add(&[(9, "$ACADVER"), (1, "AC1015")]);
        header.add(&[(9, "$HANDSEED"), (5, &format!("{:X}", groups.handle + 1))]);
        // The unit 4 is the millimetre, and the measurement 1 is metric.
        header.add(&[(9, "$INSUNITS"), (70, "4"), (9, "$MEASUREMENT"), (70, "1")]);
        header.add(&[(9, "$EXTMIN"), (10, &low[0]), (20, &low[1]), (30, "0")]);
        header.add(&[(9, "$EXTMAX"), (10, &high[0]), (20, &high[1]), (30, "0")]);
    });
    header.text + &groups.text + "  0\nEOF\n"
}

impl Groups {
    fn add(&mut self, groups: &[(u16, &str)]) {
        for (code, value) in groups {
            let _ = writeln!(self.text, "{code:>3}\n{value}");
        }
    }

    fn section(&mut self, name: &str, contents: impl FnOnce(&mut Self)) {
        self.add(&[(0, "SECTION"), (2, name)]);
        contents(self);
        self.add(&[(0, "ENDSEC")]);
    }

    /// Begins an entity with the next handle; `owner` is the handle of its owner.
    fn entity(&mut self, kind: &str, owner: &str) {
        self.handle += 1;
        let handle = format!("{:X}", self.handle);
        self.add(&[(0, kind), (5, &handle), (330, owner)]);
    }

    /// Writes the tables that `AutoCAD` requires, most of them empty.
    fn tables(&mut self) {
        self.section("TABLES", |groups| {
            groups.table("VPORT", "8", |_, _| {});
            groups.table("LTYPE", "5", |groups, owner| {
                for name in ["ByBlock", "ByLayer", "Continuous"] {
                    groups.record("LTYPE", owner, "AcDbLinetypeTableRecord", name);
                    groups.add(&[(3, ""), (72, "65"), (73, "0"), (40, "0")]);
                }
            });
            groups.table("LAYER", "2", |groups, owner| {
                let colors = COLORS.map(|color| color.to_string());
                let layers = Sheet::LAYERS.into_iter().zip(colors.iter().map(String::as_str));
                for (name, color) in [("0", "7")].into_iter().chain(layers) {
                    groups.record("LAYER", owner, "AcDbLayerTableRecord", name);
                    groups.add(&[(62, color), (6, "Continuous")]);
                }
            });
            groups.table("STYLE", "3", |groups, owner| {
                groups.record("STYLE", owner, "AcDbTextStyleTableRecord", "Standard");
                groups.add(&[
                    (40, "0"),
                    (41, "1"),
                    (50, "0"),
                    (71, "0"),
                    (42, "2.5"),
                    (3, "txt"),
                    (4, ""),
                ]);
            });
            groups.table("VIEW", "6", |_, _| {});
            groups.table("UCS", "7", |_, _| {});
            groups.table("APPID", "9", |groups, owner| {
                groups.record("APPID", owner, "AcDbRegAppTableRecord", "ACAD");
            });
            groups.table("DIMSTYLE", "A", |_, _| {});
            groups.table("BLOCK_RECORD", "1", |groups, owner| {
                for (name, handle) in [("*Model_Space", MODEL), ("*Paper_Space", PAPER)] {
                    groups.add(&[(0, "BLOCK_RECORD"), (5, handle), (330, owner)]);
                    groups.add(&[
                        (100, "AcDbSymbolTableRecord"),
                        (100, "AcDbBlockTableRecord"),
                        (2, name),
                    ]);
                }
            });
        });
    }

    fn table(&mut self, name: &str, handle: &str, records: impl FnOnce(&mut Self, &str)) {
        self.add(&[(0, "TABLE"), (2, name), (5, handle), (330, "0"), (100, "AcDbSymbolTable")]);
        self.add(&[(70, "4")]);
        if name == "DIMSTYLE" {
            self.add(&[(100, "AcDbDimStyleTable")]);
        }
        records(self, handle);
        self.add(&[(0, "ENDTAB")]);
    }

    fn record(&mut self, kind: &str, owner: &str, class: &str, name: &str) {
        self.entity(kind, owner);
        self.add(&[(100, "AcDbSymbolTableRecord"), (100, class), (2, name), (70, "0")]);
    }

    /// Writes an empty block, because its entities are in the section `ENTITIES`.
    ///
    /// `record` is the handle of the block record; `begin` and `end` are handles of the block.
    fn block(&mut self, name: &str, record: &str, [begin, end]: [&str; 2]) {
        self.add(&[(0, "BLOCK"), (5, begin), (330, record), (100, "AcDbEntity"), (8, "0")]);
        self.add(&[(100, "AcDbBlockBegin"), (2, name), (70, "0")]);
        self.add(&[(10, "0"), (20, "0"), (30, "0"), (3, name), (1, "")]);
        self.add(&[(0, "ENDBLK"), (5, end), (330, record), (100, "AcDbEntity"), (8, "0")]);
        self.add(&[(100, "AcDbBlockEnd")]);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::patch::tests::patch;

    #[test]
    fn outlines_are_closed_and_handles_are_used_once() {
        let text = write(&Sheet::new(&patch(), 0.1, 0.1).expect("a valid sheet"));
        let lines: Vec<_> = text.lines().map(str::trim).collect();
        let pairs: Vec<_> = lines.chunks(2).map(|pair| (pair[0], pair[1])).collect();
        assert_eq!(pairs.iter().filter(|pair| **pair == ("0", "LWPOLYLINE")).count(), 42);
        assert_eq!(pairs.last(), Some(&("0", "EOF")));
        let units = pairs.iter().position(|pair| pair.1 == "$INSUNITS").expect("units");
        assert_eq!(pairs[units + 1], ("70", "4"));
        let handles: Vec<_> = pairs.iter().skip(6).filter(|pair| pair.0 == "5").collect();
        assert_eq!(handles.iter().collect::<HashSet<_>>().len(), handles.len());
    }
}

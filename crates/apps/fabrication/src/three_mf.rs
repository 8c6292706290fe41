//! 3MF: zipped XML with a unit of length, so that slicers need not guess the size.

use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

use zip::write::SimpleFileOptions;
use zip::{DateTime, ZipWriter};

use crate::mesh::triangles;
use crate::{Patch, Prism};

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;

const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

pub(crate) fn write(patch: &Patch) -> Vec<u8> {
    // No time stamp, so that equal designs give equal files.
    let options = SimpleFileOptions::default().last_modified_time(DateTime::default());
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let model = model(patch);
    let files = [
        ("[Content_Types].xml", TYPES),
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/3dmodel.model", &model),
    ];
    for (name, text) in files {
        zip.start_file(name, options).expect("a name is used once");
        zip.write_all(text.as_bytes()).expect("writing to memory succeeds");
    }
    zip.finish().expect("writing to memory succeeds").into_inner()
}

/// Writes scales and membrane as two parts of one object.
///
/// Slicers can assign a material to each part, and keep the relative position of the parts.
fn model(patch: &Patch) -> String {
    let solids = patch.solids();
    let scales = object(1, "scales", &solids.scales);
    let membrane = object(2, "membrane", &solids.membrane);
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
 <metadata name="Application">squama</metadata>
 <resources>
{scales}{membrane}  <object id="3" type="model" name="skin">
   <components><component objectid="1"/><component objectid="2"/></components>
  </object>
 </resources>
 <build><item objectid="3"/></build>
</model>
"#
    )
}

fn object(id: u32, name: &str, prisms: &[Prism]) -> String {
    let (mut vertices, mut faces) = (String::new(), String::new());
    let mut first = 0;
    for prism in prisms {
        let corners = prism.corners();
        for [x, y, z] in &corners {
            let _ = writeln!(vertices, r#"    <vertex x="{x}" y="{y}" z="{z}"/>"#);
        }
        // Prisms do not share corners, so the mesh of each prism is closed.
        for [a, b, c] in triangles(prism).map(|triangle| triangle.map(|k| first + k)) {
            let _ = writeln!(faces, r#"    <triangle v1="{a}" v2="{b}" v3="{c}"/>"#);
        }
        first += corners.len();
    }
    format!(
        "  <object id=\"{id}\" type=\"model\" name=\"{name}\"><mesh>\n   <vertices>\n{vertices}   </vertices>\n   \
         <triangles>\n{faces}   </triangles>\n  </mesh></object>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::tests::patch;

    #[test]
    fn the_model_states_millimetres_and_has_two_parts() {
        let model = model(&patch());
        assert!(model.contains(r#"unit="millimeter""#));
        assert_eq!(model.matches("<vertex ").count(), 21 * 8);
        assert_eq!(model.matches("<triangle ").count(), 21 * 12);
        assert_eq!(model.matches("<mesh>").count(), 2);
    }

    #[test]
    fn three_mf_files_are_reproducible() {
        assert_eq!(write(&patch()), write(&patch()));
    }
}

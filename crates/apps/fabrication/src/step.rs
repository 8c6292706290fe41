//! STEP (ISO 10303-21, AP214): each prism as a solid of plane faces.

use std::collections::HashMap;
use std::fmt::Write as _;

use nalgebra::Vector3;

use crate::{Patch, Prism, Solids};

/// Header and first entities of a file: a product in millimetres with an accuracy of 1e-7 mm.
///
/// Entity 20, the representation of the product, lists the solids and is written after them.
// The date is fixed, so that equal designs give equal files.
const PRODUCT: &str = "ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('skin of scales on a membrane'),'2;1');
FILE_NAME('skin','1970-01-01T00:00:00',(''),(''),'squama','squama','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));
ENDSEC;
DATA;
#1=APPLICATION_CONTEXT('automotive design');
#2=APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2001,#1);
#3=PRODUCT_CONTEXT('',#1,'mechanical');
#4=PRODUCT('skin','skin','',(#3));
#5=PRODUCT_DEFINITION_FORMATION('','',#4);
#6=PRODUCT_DEFINITION_CONTEXT('part definition',#1,'design');
#7=PRODUCT_DEFINITION('','',#5,#6);
#8=PRODUCT_DEFINITION_SHAPE('','',#7);
#9=SHAPE_DEFINITION_REPRESENTATION(#8,#20);
#10=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#11=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#12=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());
#13=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),#10,'distance_accuracy_value','');
#14=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#13))GLOBAL_UNIT_ASSIGNED_CONTEXT((#10,#11,#12))REPRESENTATION_CONTEXT('',''));
#15=CARTESIAN_POINT('',(0.,0.,0.));
#16=DIRECTION('',(0.,0.,1.));
#17=DIRECTION('',(1.,0.,0.));
#18=AXIS2_PLACEMENT_3D('',#15,#16,#17);
#19=PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#4));
";

/// Number of the entity that lists the solids.
const REPRESENTATION: usize = 20;

pub(crate) fn write(patch: &Patch) -> String {
    let mut entities = Entities { text: PRODUCT.to_owned(), last: REPRESENTATION };
    let Solids { membrane, scales } = patch.solids();
    let mut solids: Vec<usize> =
        membrane.iter().map(|strip| entities.solid("membrane", strip)).collect();
    for (n, scale) in scales.iter().enumerate() {
        solids.push(entities.solid(&format!("scale {}", n + 1), scale));
    }
    let solids = references(&solids);
    let representation = format!(
        "#{REPRESENTATION}=ADVANCED_BREP_SHAPE_REPRESENTATION('skin',(#18,{solids}),#14);\n"
    );
    entities.text + &representation + "ENDSEC;\nEND-ISO-10303-21;\n"
}

/// The entities of the file, numbered in order.
struct Entities {
    text: String,
    /// Number of the last entity.
    last: usize,
}

impl Entities {
    fn add(&mut self, entity: &str) -> usize {
        self.last += 1;
        let _ = writeln!(self.text, "#{}={entity};", self.last);
        self.last
    }

    fn point(&mut self, at: Vector3<f64>) -> usize {
        self.add(&format!("CARTESIAN_POINT('',{})", triple(at)))
    }

    fn direction(&mut self, to: Vector3<f64>) -> usize {
        // Adding zero replaces −0 by 0.
        self.add(&format!("DIRECTION('',{})", triple(to.add_scalar(0.0))))
    }

    fn solid(&mut self, name: &str, prism: &Prism) -> usize {
        let corners: Vec<_> = prism.corners().into_iter().map(Vector3::from).collect();
        let points: Vec<usize> = corners.iter().map(|corner| self.point(*corner)).collect();
        let vertices = points.iter().map(|point| self.add(&format!("VERTEX_POINT('',#{point})")));
        let vertices: Vec<usize> = vertices.collect();
        // Two faces share each edge and traverse the edge in opposite directions.
        let mut edges: HashMap<[usize; 2], usize> = HashMap::new();
        let mut faces = Vec::new();
        for face in prism.faces() {
            let sides = [0, 1, 2, 3].map(|k| [face[k], face[(k + 1) % 4]]);
            let sides = sides.map(|[from, to]| {
                let (edge, sense) = if let Some(edge) = edges.get(&[to, from]) {
                    (*edge, ".F.")
                } else {
                    let edge = self.edge([from, to], &corners, &points, &vertices);
                    edges.insert([from, to], edge);
                    (edge, ".T.")
                };
                self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{sense})"))
            });
            faces.push(self.face(face, &corners, points[face[0]], &sides));
        }
        let shell = self.add(&format!("CLOSED_SHELL('',({}))", references(&faces)));
        self.add(&format!("MANIFOLD_SOLID_BREP('{name}',#{shell})"))
    }

    fn edge(
        &mut self,
        [from, to]: [usize; 2],
        corners: &[Vector3<f64>],
        points: &[usize],
        vertices: &[usize],
    ) -> usize {
        let direction = self.direction((corners[to] - corners[from]).normalize());
        let vector = self.add(&format!("VECTOR('',#{direction},1.)"));
        let line = self.add(&format!("LINE('',#{},#{vector})", points[from]));
        let ends = references(&[vertices[from], vertices[to]]);
        self.add(&format!("EDGE_CURVE('',{ends},#{line},.T.)"))
    }

    fn face(
        &mut self,
        [a, b, _, d]: [usize; 4],
        corners: &[Vector3<f64>],
        origin: usize,
        sides: &[usize; 4],
    ) -> usize {
        let along = (corners[b] - corners[a]).normalize();
        let normal = along.cross(&(corners[d] - corners[a])).normalize();
        let (normal, along) = (self.direction(normal), self.direction(along));
        let axes = self.add(&format!("AXIS2_PLACEMENT_3D('',#{origin},#{normal},#{along})"));
        let plane = self.add(&format!("PLANE('',#{axes})"));
        let edge_loop = self.add(&format!("EDGE_LOOP('',({}))", references(sides)));
        let bound = self.add(&format!("FACE_OUTER_BOUND('',#{edge_loop},.T.)"));
        self.add(&format!("ADVANCED_FACE('',(#{bound}),#{plane},.T.)"))
    }
}

fn references(entities: &[usize]) -> String {
    entities.iter().map(|entity| format!("#{entity}")).collect::<Vec<_>>().join(",")
}

fn triple(values: Vector3<f64>) -> String {
    format!("({})", <[f64; 3]>::from(values).map(real).join(","))
}

/// Formats a number for STEP: always with a decimal point, and with `E` before an exponent.
fn real(value: f64) -> String {
    // The debug format keeps the point of whole numbers, unlike the display format.
    let text = format!("{value:?}");
    match text.split_once('e') {
        Some((digits, exponent)) if digits.contains('.') => format!("{digits}E{exponent}"),
        Some((digits, exponent)) => format!("{digits}.E{exponent}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::tests::patch;

    #[test]
    fn each_solid_has_six_faces_and_twelve_edges() {
        let text = write(&patch());
        assert_eq!(text.matches("MANIFOLD_SOLID_BREP").count(), 21);
        assert_eq!(text.matches("ADVANCED_FACE(").count(), 21 * 6);
        assert_eq!(text.matches("EDGE_CURVE(").count(), 21 * 12);
        assert_eq!(text.matches("ORIENTED_EDGE(").count(), 21 * 24);
    }

    #[test]
    fn step_numbers_have_a_decimal_point() {
        assert_eq!([2.0, 1e-7, 1.5e20, -0.25].map(real), ["2.0", "1.E-7", "1.5E20", "-0.25"]);
    }
}

//! Finite-element deck of a punctured row, for `CalculiX` and Abaqus.
//!
//! The deck contains a row of scales on a block of substrate. The middle scale is pushed down along
//! a line across its top. The row is symmetric in `y`, and the deck models one half with quadratic
//! hexahedra. Bases and substrate share nodes; neighbouring scales have contact. Lengths are in mm,
//! forces in N, stresses in `MPa`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;

use crate::Patch;

/// Maximum number of scales of the row.
const MOST_SCALES: usize = 201;
/// Number of elements along the base of a scale.
const ALONG: usize = 4;
/// Number of elements over half the width of a scale.
const ACROSS: usize = 3;
/// Number of elements over the height of a scale.
const HEIGHT: usize = 3;
/// Number of elements along a gap.
const GAP: usize = 2;
/// Distance of the outer faces of the block from the scales, in units of the larger of base and
/// width of a scale.
// With a distance of 10 a single base is 4 % stiffer than on an infinite half-space.
const MARGIN: f64 = 10.0;
/// Ratio of the lengths of successive elements towards the outer faces.
const GROWTH: f64 = 1.8;
/// Displacement of the load, divided by the thickness of a scale.
const DEPTH: f64 = 0.1;
/// Largest Poisson's ratio of a deck: larger ratios need elements with the pressure as an unknown.
const MOST_POISSON: f64 = 0.49;

/// Materials and load of a deck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Puncture {
    /// Modulus of the substrate, `MPa`.
    pub substrate: f64,
    /// Poisson's ratio of the substrate.
    pub poisson_ratio: f64,
    /// Modulus of the scales, `MPa`.
    pub scale: f64,
    /// Thickness of the substrate on a rigid base, mm. `None` for a half-space.
    pub tissue: Option<f64>,
    /// Coefficient of friction between scales.
    pub friction: f64,
    /// Position of the load on the top: 0 the left corner, 1 the right corner.
    pub load_position: f64,
}

/// Error of a row that is too long for a deck.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0} scales along the row: too many for a finite-element deck, expected at most {MOST_SCALES}"
)]
pub struct DeckError(usize);

/// Block of a node, and its indices along, across and upwards in the grid of half elements.
///
/// Block 0 is the substrate, and block `k + 1` is scale `k`.
type NodeIndex = [usize; 4];

/// Nodes and elements of a deck. Node numbers start at 1.
#[derive(Default)]
struct Mesh {
    nodes: BTreeMap<NodeIndex, usize>,
    coordinates: Vec<[f64; 3]>,
    elements: Vec<[usize; 20]>,
}

/// Offsets of the nodes of a quadratic hexahedron, in half elements, in the order of Abaqus.
const NODES: [[usize; 3]; 20] = [
    [0, 0, 0],
    [2, 0, 0],
    [2, 2, 0],
    [0, 2, 0],
    [0, 0, 2],
    [2, 0, 2],
    [2, 2, 2],
    [0, 2, 2],
    [1, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 1, 0],
    [1, 0, 2],
    [2, 1, 2],
    [1, 2, 2],
    [0, 1, 2],
    [0, 0, 1],
    [2, 0, 1],
    [2, 2, 1],
    [0, 2, 1],
];

/// Returns the coordinate at the index `i`, counted in half elements.
///
/// `lines` contains the coordinates of the boundaries between elements.
fn at(lines: &[f64], i: usize) -> f64 {
    f64::midpoint(lines[i / 2], lines[i.div_ceil(2)])
}

/// Returns the lengths of elements that fill the length `total`.
///
/// The first element is at most `first` long, and each other element is longer than the previous
/// one by the factor [`GROWTH`].
fn growing(first: f64, total: f64) -> Vec<f64> {
    let mut lengths = Vec::new();
    let (mut sum, mut next) = (0.0, first.min(total));
    while sum < total * (1.0 - 1e-9) {
        lengths.push(next);
        sum += next;
        next *= GROWTH;
    }
    lengths.iter().map(|length| length * total / sum).collect()
}

/// Coordinates of the grid lines along the row, across the row and upwards, mm.
struct Grid {
    xs: Vec<f64>,
    ys: Vec<f64>,
    zs: Vec<f64>,
    /// Positions of the grid lines along a base, from 0 at its left end to 1 at its right end.
    base: [f64; ALONG + 1],
    /// Number of elements to the left of the first base.
    before: usize,
}

impl Grid {
    /// Creates the grid of the first row of `patch`; `tissue` is the depth of the substrate, mm.
    fn new(patch: &Patch, load_position: f64, tissue: Option<f64>) -> Self {
        let (base, width, gap, count) =
            (patch.base(), patch.width(), patch.gaps()[0], patch.scales()[0]);
        let margin = MARGIN * base.max(width);
        let depth = tissue.unwrap_or(margin);
        let lines = base_lines(load_position);
        let first = base * (lines[1] - lines[0]);
        let xs = lines_along(&lines, base, gap, count, &growing(first, margin));
        let half = width / 2.0;
        let mut ys: Vec<f64> = (0..=ACROSS).map(|j| half * edge_spaced(j)).collect();
        let last = half - ys[ACROSS - 1];
        ys.extend(running(half, &growing(last, margin)));
        let downwards = running(0.0, &growing(first.min(last), depth));
        let zs = downwards.iter().rev().map(|z| -z).chain([0.0]).collect();
        let before = (xs.len() - 1 - (count * ALONG + (count - 1) * GAP)) / 2;
        Self { xs, ys, zs, base: lines, before }
    }

    /// Returns the numbers of elements of the substrate along, across and in depth.
    fn sizes(&self) -> [usize; 3] {
        [&self.xs, &self.ys, &self.zs].map(|lines| lines.len() - 1)
    }

    /// Returns the index along the row of the left end of a base, in half elements.
    fn start(&self, scale: usize) -> usize {
        2 * (self.before + scale * (ALONG + GAP))
    }
}

impl Mesh {
    /// Returns the number of a node, which is created at its first use.
    fn node(&mut self, index: NodeIndex, coordinates: [f64; 3]) -> usize {
        let next = self.nodes.len() + 1;
        let number = *self.nodes.entry(index).or_insert(next);
        if number == next {
            self.coordinates.push(coordinates);
        }
        number
    }

    /// Adds a block of elements, and returns their indices, which increase along the first axis.
    ///
    /// The array contains the numbers of elements. `node` receives a position in the block, counted
    /// in half elements, and returns index and coordinates of the node at this position.
    fn block(
        &mut self,
        [along, across, height]: [usize; 3],
        node: impl Fn([usize; 3]) -> (NodeIndex, [f64; 3]),
    ) -> Range<usize> {
        let first = self.elements.len();
        for element in 0..along * across * height {
            let (i, j, k) = (element % along, element / along % across, element / (along * across));
            let nodes = NODES.map(|[di, dj, dk]| {
                let (index, coordinates) = node([2 * i + di, 2 * j + dj, 2 * k + dk]);
                self.node(index, coordinates)
            });
            self.elements.push(nodes);
        }
        first..self.elements.len()
    }

    /// Adds the block of substrate, and returns the range of its elements.
    fn add_substrate(&mut self, Grid { xs, ys, zs, .. }: &Grid) -> Range<usize> {
        let sizes = [xs, ys, zs].map(|lines| lines.len() - 1);
        self.block(sizes, |[i, j, k]| ([0, i, j, k], [at(xs, i), at(ys, j), at(zs, k)]))
    }

    /// Adds the scales, and returns the numbers of the elements at their left and right sides.
    ///
    /// Each of the two lists contains one list of element numbers per scale.
    fn add_scales(&mut self, grid: &Grid, patch: &Patch) -> [Vec<Vec<usize>>; 2] {
        let (t, shift) = (patch.thickness(), patch.shift());
        let up: Vec<f64> = (0..=HEIGHT).map(|k| t * k as f64 / HEIGHT as f64).collect();
        let surface = 2 * grid.sizes()[2];
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for scale in 0..patch.scales()[0] {
            let start = grid.start(scale);
            let elements = self.block([ALONG, ACROSS, HEIGHT], |[i, j, k]| {
                let (i, z) = (start + i, at(&up, k));
                // The base shares its nodes with the substrate.
                let index = if k == 0 { [0, i, j, surface] } else { [scale + 1, i, j, k] };
                (index, [at(&grid.xs, i) + shift * z / t, at(&grid.ys, j), z])
            });
            let numbers: Vec<usize> = elements.map(|element| element + 1).collect();
            left.push(numbers.iter().copied().step_by(ALONG).collect());
            right.push(numbers.iter().copied().skip(ALONG - 1).step_by(ALONG).collect());
        }
        [left, right]
    }

    /// Returns the nodes on the loaded line across the top of a scale.
    fn loaded(&self, grid: &Grid, scale: usize, load_position: f64) -> Vec<usize> {
        let column = grid.start(scale) + 2 * load_column(&grid.base, load_position);
        let line = (0..=2 * ACROSS).map(|j| [scale + 1, column, j, 2 * HEIGHT]);
        line.filter_map(|index| self.nodes.get(&index).copied()).collect()
    }

    /// Returns the nodes on the outer faces of the substrate, except its surface.
    fn outer(&self, grid: &Grid) -> Vec<usize> {
        let [nx, ny, _] = grid.sizes();
        let outer = self.nodes.iter().filter(|([block, i, j, k], _)| {
            *block == 0 && (*k == 0 || *j == 2 * ny || *i == 0 || *i == 2 * nx)
        });
        outer.map(|(_, number)| *number).collect()
    }

    /// Returns the nodes in the plane of symmetry, `y = 0`.
    fn in_symmetry_plane(&self) -> Vec<usize> {
        let plane = self.nodes.iter().filter(|([_, _, j, _], _)| *j == 0);
        plane.map(|(_, number)| *number).collect()
    }
}

/// Returns the deck of the first row of `patch`, with a load on the middle scale.
///
/// # Errors
///
/// If the row is too long.
pub fn deck(patch: &Patch, puncture: &Puncture, title: &str) -> Result<String, DeckError> {
    let count = patch.scales()[0];
    if count > MOST_SCALES {
        return Err(DeckError(count));
    }
    let grid = Grid::new(patch, puncture.load_position, puncture.tissue);
    let mut mesh = Mesh::default();
    let substrate = mesh.add_substrate(&grid);
    let [left, right] = mesh.add_scales(&grid, patch);
    let sets = [
        ("LOADED", mesh.loaded(&grid, count / 2, puncture.load_position)),
        ("OUTER", mesh.outer(&grid)),
        ("SYMMETRY", mesh.in_symmetry_plane()),
    ];

    let t = patch.thickness();
    let mut text = heading(title, puncture, t);
    text.push_str("*NODE, NSET=ALL\n");
    for (number, [x, y, z]) in mesh.coordinates.iter().enumerate() {
        let _ = writeln!(text, "{}, {x:.9}, {y:.9}, {z:.9}", number + 1);
    }
    let scales = substrate.end..mesh.elements.len();
    elements(&mut text, "SUBSTRATE", &mesh.elements, substrate);
    elements(&mut text, "SCALES", &mesh.elements, scales);
    for (name, nodes) in &sets {
        let _ = writeln!(text, "*NSET, NSET={name}");
        list(&mut text, nodes);
    }
    materials(&mut text, puncture);
    contacts(&mut text, puncture, t, &left, &right);
    step(&mut text, -DEPTH * t);
    Ok(text)
}

/// Returns the comment lines at the top of a deck.
fn heading(title: &str, puncture: &Puncture, t: f64) -> String {
    let ratio = puncture.poisson_ratio.min(MOST_POISSON);
    let mut text = format!(
        "** {title}\n\
         ** Puncture of a row of scales, for CalculiX (ccx) and Abaqus, written by squama.\n\
         ** Lengths in mm, forces in N, stresses in MPa. The deck is one half by symmetry in y:\n\
         ** the force is twice the sum of the reactions RF3 of LOADED.\n\
         ** Compare the force with path.csv of squama design at a displacement of {} mm,\n\
         ** with puncture.scales equal to the number of scales in this deck.\n",
        DEPTH * t
    );
    if ratio < puncture.poisson_ratio {
        let _ = writeln!(
            text,
            "** Poisson's ratio is {ratio} instead of {}; a block replaces an infinite half-space.",
            puncture.poisson_ratio
        );
    }
    text.push_str("*HEADING\nsquama: puncture of a row of scales\n");
    text
}

/// Returns the position of line `j` across half a scale, from 0 in the middle to 1 at the edge.
///
/// Lines are closer near the edge.
fn edge_spaced(j: usize) -> f64 {
    let angle = std::f64::consts::FRAC_PI_2 * j as f64 / ACROSS as f64;
    angle.sin()
}

/// Returns the positions of the grid lines along a base, from 0 at its left end to 1.
///
/// Lines are closer near the ends of the base. The line nearest to the load is moved to the load,
/// unless this line is an end of the base.
fn base_lines(load: f64) -> [f64; ALONG + 1] {
    let mut lines = std::array::from_fn(|i| {
        let angle = std::f64::consts::PI * i as f64 / ALONG as f64;
        f64::midpoint(1.0, -angle.cos())
    });
    let column = load_column(&lines, load);
    if (1..ALONG).contains(&column) {
        lines[column] = load;
    }
    lines
}

/// Returns the index of the grid line of a base that is nearest to the load.
fn load_column(lines: &[f64; ALONG + 1], load: f64) -> usize {
    let distances = lines.map(|line| (line - load).abs());
    (0..=ALONG).min_by(|&a, &b| distances[a].total_cmp(&distances[b])).unwrap_or(ALONG)
}

/// Returns the cumulative sums of `lengths`, each increased by `start`.
fn running(start: f64, lengths: &[f64]) -> Vec<f64> {
    let mut sum = start;
    lengths
        .iter()
        .map(|length| {
            sum += length;
            sum
        })
        .collect()
}

/// Returns the coordinates of all grid lines along the row; the first base begins at 0.
///
/// `lines` contains the positions of the lines along a base, from 0 to 1, and `margin` the lengths
/// of the elements beyond the first and the last base.
fn lines_along(lines: &[f64], base: f64, gap: f64, count: usize, margin: &[f64]) -> Vec<f64> {
    let mut xs: Vec<f64> = running(0.0, margin).iter().rev().map(|x| -x).collect();
    for scale in 0..count {
        let start = scale as f64 * (base + gap);
        xs.extend(lines.iter().map(|x| start + base * x));
        if scale + 1 < count {
            xs.extend((1..GAP).map(|i| start + base + gap * i as f64 / GAP as f64));
        }
    }
    let end = xs.last().copied().unwrap_or_default();
    xs.extend(running(end, margin));
    xs
}

fn elements(text: &mut String, set: &str, all: &[[usize; 20]], range: Range<usize>) {
    let _ = writeln!(text, "*ELEMENT, TYPE=C3D20R, ELSET={set}");
    for number in range {
        let nodes = all[number].map(|node| node.to_string());
        let _ = writeln!(
            text,
            "{}, {},\n{}",
            number + 1,
            nodes[..10].join(", "),
            nodes[10..].join(", ")
        );
    }
}

/// Writes numbers, at most eight on each line.
fn list(text: &mut String, numbers: &[usize]) {
    for some in numbers.chunks(8) {
        let some: Vec<_> = some.iter().map(usize::to_string).collect();
        let _ = writeln!(text, "{}", some.join(", "));
    }
}

fn materials(text: &mut String, puncture: &Puncture) {
    let Puncture { substrate, poisson_ratio, scale, .. } = *puncture;
    let ratio = poisson_ratio.min(MOST_POISSON);
    let _ = write!(
        text,
        "*MATERIAL, NAME=TISSUE\n*ELASTIC\n{substrate}, {ratio}\n\
         *MATERIAL, NAME=HARD\n*ELASTIC\n{scale}, 0.3\n\
         *SOLID SECTION, ELSET=SUBSTRATE, MATERIAL=TISSUE\n\
         *SOLID SECTION, ELSET=SCALES, MATERIAL=HARD\n"
    );
}

/// Writes the contact between the facing sides of neighbouring scales.
fn contacts(
    text: &mut String,
    puncture: &Puncture,
    t: f64,
    left: &[Vec<usize>],
    right: &[Vec<usize>],
) {
    if left.len() < 2 {
        return;
    }
    for scale in 0..left.len() - 1 {
        for (name, numbers, face) in
            [("RIGHT", &right[scale], "S4"), ("LEFT", &left[scale + 1], "S6")]
        {
            let _ = writeln!(text, "*SURFACE, NAME={name}{}, TYPE=ELEMENT", scale + 1);
            for number in numbers {
                let _ = writeln!(text, "{number}, {face}");
            }
        }
    }
    // Under a pressure of E_s, surfaces overlap by a thousandth of the thickness of a scale.
    let stiffness = 1e3 * puncture.substrate / t;
    let _ = write!(
        text,
        "*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness}\n"
    );
    if puncture.friction > 0.0 {
        let _ = write!(text, "*FRICTION\n{}, {stiffness}\n", puncture.friction);
    }
    for scale in 1..left.len() {
        let _ = write!(
            text,
            "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE\nLEFT{scale}, RIGHT{scale}\n"
        );
    }
}

/// Writes the supports, the prescribed displacement of the loaded nodes, and the output.
fn step(text: &mut String, displacement: f64) {
    let _ = write!(
        text,
        "*BOUNDARY\nOUTER, 1, 3\nSYMMETRY, 2, 2\n\
         *STEP, NLGEOM, INC=200\n*STATIC\n0.1, 1., 1e-6, 0.1\n\
         *BOUNDARY\nLOADED, 3, 3, {displacement}\n\
         *NODE PRINT, NSET=LOADED, TOTALS=YES\nRF\n\
         *NODE PRINT, NSET=LOADED\nU\n\
         *NODE FILE\nU, RF\n*EL FILE\nS\n*END STEP\n"
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::tests::patch;

    const PUNCTURE: Puncture = Puncture {
        substrate: 0.5,
        poisson_ratio: 0.5,
        scale: 3000.0,
        tissue: None,
        friction: 0.0,
        load_position: 1.0,
    };

    fn numbers(text: &str, keyword: &str) -> Vec<Vec<f64>> {
        let (_, rest) = text.split_once(keyword).expect("the keyword");
        let (_, rest) = rest.split_once('\n').expect("a line");
        let lines = rest.lines().take_while(|line| !line.starts_with('*'));
        lines
            .map(|line| {
                let words = line.split(',').map(str::trim).filter(|word| !word.is_empty());
                words.map(|word| word.parse().expect("a number")).collect()
            })
            .collect()
    }

    #[test]
    fn elements_have_positive_volume_and_fill_the_scales() {
        let patch = patch();
        let text = deck(&patch, &PUNCTURE, "x").expect("a valid deck");
        let nodes: BTreeMap<usize, [f64; 3]> = numbers(&text, "*NODE, NSET=ALL")
            .into_iter()
            .map(|row| (row[0] as usize, [row[1], row[2], row[3]]))
            .collect();
        let mut volume = 0.0;
        for set in ["SUBSTRATE", "SCALES"] {
            let rows = numbers(&text, &format!("ELSET={set}"));
            for element in rows.chunks(2) {
                let [o, x, y, z] = [1, 2, 4, 5].map(|k| nodes[&(element[0][k] as usize)]);
                let [[a, b, c], [d, e, f], [g, h, i]] =
                    [x, y, z].map(|to| [to[0] - o[0], to[1] - o[1], to[2] - o[2]]);
                // Elements are parallelepipeds, so the triple product is their volume.
                let size = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
                assert!(size > 0.0, "{element:?}");
                if set == "SCALES" {
                    volume += size;
                }
            }
        }
        let expected = 5.0 * patch.scale_volume() / 2.0;
        assert!((volume / expected - 1.0).abs() < 1e-6, "{volume}, expected {expected}");
    }

    #[test]
    fn loaded_nodes_are_on_top_of_the_middle_scale_at_the_load_position() {
        let patch = patch();
        let nodes = |text: &str| -> BTreeMap<usize, Vec<f64>> {
            let rows = numbers(text, "*NODE, NSET=ALL").into_iter();
            rows.map(|row| (row[0] as usize, row[1..].to_vec())).collect()
        };
        for load_position in [0.0, 0.3, 0.5, 0.96, 1.0] {
            let text =
                deck(&patch, &Puncture { load_position, ..PUNCTURE }, "x").expect("a valid deck");
            let nodes = nodes(&text);
            let loaded = numbers(&text, "*NSET, NSET=LOADED").concat();
            assert_eq!(loaded.len(), 2 * ACROSS + 1);
            let expected = 2.0 * patch.pitches()[0] + patch.shift() + load_position * patch.base();
            for number in loaded {
                let place = &nodes[&(number as usize)];
                assert!((place[2] - patch.thickness()).abs() < 1e-9);
                let off = (place[0] - expected).abs() / patch.base();
                let most = if (0.15..=0.85).contains(&load_position) { 1e-9 } else { 0.05 };
                assert!(off < most, "{load_position}: {off}");
            }
        }
    }
}

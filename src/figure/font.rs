//! Letters of lines, drawn for figures: a PNG needs no font of the system, and looks the same everywhere.
//!
//! A letter is strokes separated by `/`; a stroke is points of two hexadecimal digits, x and y up, the
//! baseline at y = 3, lower-case letters up to 9 and capitals to 12. A stroke that begins with `~` is the
//! quadratic B-spline of its points (Chaikin 1974), closed where its first point is its last.

use super::{Point, letters::composed};

/// Of one unit of the grid, in em.
const UNIT: f64 = 0.078;
/// Between two letters, in units.
const GAP: f64 = 2.4;
/// The width of a blank, in units.
const BLANK: f64 = 3.0;
/// The baseline, in units.
const BASELINE: f64 = 3.0;

/// Letter, width in units, strokes.
const LETTERS: &[(char, f64, &str)] = &[
    ('0', 6., "~0c03636c0c"),
    ('1', 3., "0a2c23"),
    ('2', 6., "~0a0c6c6703/0363"),
    ('3', 6., "~0a0c6c6828/~2868630305"),
    ('4', 6., "434c0666"),
    ('5', 6., "5c0c08/~0869630305"),
    ('6', 6., "~0903636909/~5c0c06"),
    ('7', 6., "0c6c23"),
    ('8', 6., "~080c6c6808/~0803636808"),
    ('9', 6., "~060c6c6606/~696313"),
    ('A', 6., "033c63/1656"),
    ('B', 6., "030c/0c3c/~3c6c6838/0838/~38686333/0333"),
    ('C', 6., "~6a6c0c036365"),
    ('D', 6., "23030c2c/~2c6c6323"),
    ('E', 5., "5c0c0353/0848"),
    ('F', 5., "5c0c03/0848"),
    ('G', 6., "~6a6c0c036367/6747"),
    ('H', 6., "030c/636c/0868"),
    ('I', 0., "0c03"),
    ('J', 4., "~4c430305"),
    ('K', 6., "030c/6c06/2863"),
    ('L', 5., "0c0353"),
    ('M', 8., "030c468c83"),
    ('N', 6., "030c636c"),
    ('O', 7., "~0c03737c0c"),
    ('P', 6., "030c3c/~3c6c6737/3707"),
    ('Q', 7., "~0c03737c0c/4572"),
    ('R', 6., "030c3c/~3c6c6737/3707/3763"),
    ('S', 6., "~6a6c0c0867630305"),
    ('T', 6., "0c6c/3c33"),
    ('U', 6., "~0c03636c"),
    ('V', 6., "0c336c"),
    ('W', 8., "0c234a638c"),
    ('X', 6., "0c63/036c"),
    ('Y', 6., "0c376c/3733"),
    ('Z', 6., "0c6c0363"),
    ('a', 5., "~0903535909/5953"),
    ('b', 5., "0c03/~0903535909"),
    ('c', 5., "~585909035354"),
    ('d', 5., "5c53/~0903535909"),
    ('e', 5., "0656/~565909035354"),
    ('f', 3., "~3c1c18/1813/0939"),
    ('g', 5., "~0903535909/~59500001"),
    ('h', 5., "0c03/~06095953"),
    ('i', 0., "0903/0c0c"),
    ('j', 2., "~292000/2c2c"),
    ('k', 5., "0c03/5905/1653"),
    ('l', 1., "~0c0313"),
    ('m', 8., "0903/~06094943/~46498983"),
    ('n', 5., "0903/~06095953"),
    ('o', 5., "~0903535909"),
    ('p', 5., "0900/~0903535909"),
    ('q', 5., "5950/~0903535909"),
    ('r', 3., "0903/~060939"),
    ('s', 4., "~4849090646430304"),
    ('t', 3., "~1c1333/0939"),
    ('u', 5., "~09035356/5953"),
    ('v', 6., "093369"),
    ('w', 8., "0923486389"),
    ('x', 5., "0953/0359"),
    ('y', 6., "0933/6910"),
    ('z', 5., "09590353"),
    ('.', 0., "0303"),
    (',', 1., "1301"),
    (':', 0., "0303/0808"),
    (';', 1., "1301/1818"),
    ('-', 4., "0747"),
    ('−', 6., "0767"),
    ('–', 6., "0767"),
    ('+', 6., "0767/343a"),
    ('=', 6., "0666/0969"),
    ('_', 6., "0262"),
    ('/', 5., "025c"),
    ('\\', 5., "0c52"),
    ('(', 2., "~2d0a0522"),
    (')', 2., "~0d2a2502"),
    ('[', 2., "2d0d0222"),
    (']', 2., "0d2d2202"),
    ('{', 3., "3d2d2907252131"),
    ('}', 3., "0d1d1937151101"),
    ('|', 0., "0d02"),
    ('<', 5., "5a0754"),
    ('>', 5., "0a5704"),
    ('%', 8., "8c03/~0c09393c0c/~5653838656"),
    ('#', 6., "2c13/5c43/0969/0666"),
    ('&', 7., "~731b3d5b07034377"),
    ('*', 4., "282c/094b/0b49"),
    ('\'', 0., "0c0a"),
    ('"', 2., "0c0a/2c2a"),
    ('!', 0., "0c06/0303"),
    ('?', 5., "~0a0c5c582826/2323"),
    ('@', 8., "~0c03838c0c/~2a26565a2a"),
    ('^', 4., "0a2c4a"),
    ('~', 6., "~062a4468"),
    ('`', 1., "0c1a"),
    ('$', 6., "~6a6c0c0867630305/3d32"),
    ('°', 3., "~0c09393c0c"),
    ('¹', 1., "0c1d18"),
    ('²', 3., "~0b0d3d3b08/0838"),
    ('³', 3., "~0c0d3d3a1a/~1a3a3808"),
    ('⁻', 3., "0a3a"),
    ('µ', 5., "0900/~04035356/5953"),
    ('μ', 5., "0900/~04035356/5953"),
    ('×', 5., "0954/0459"),
    ('·', 0., "0707"),
    ('…', 4., "0303/2323/4343"),
];

/// What stands for a letter that is not here.
const UNKNOWN: (char, f64, &str) = ('\u{fffd}', 5., "0c03535c0c");

/// The first letter of a text that no strokes are known of.
pub fn letter_lacking(text: &str) -> Option<char> {
    text.chars()
        .find(|&c| !c.is_whitespace() && glyph(c).is_none())
}

/// Width in units and strokes of a letter.
fn glyph(c: char) -> Option<Glyph> {
    letter(c).or_else(|| composed(c))
}

/// Of one that stands in the table.
pub(super) fn letter(c: char) -> Option<Glyph> {
    let found = LETTERS.iter().find(|&&(letter, ..)| letter == c);
    found.copied().map(drawn)
}

fn drawn((_, width, strokes): (char, f64, &str)) -> Glyph {
    (width, strokes.split('/').map(points).collect())
}

/// Width and strokes, in units.
pub(super) type Glyph = (f64, Vec<Vec<Point>>);

/// The lines of a text that begins at the origin, y down, and how wide it is.
pub fn strokes(text: &str, size: f64) -> (Vec<Vec<Point>>, f64) {
    let unit = UNIT * size;
    let mut lines = Vec::new();
    let mut x = 0.0;
    for c in text.chars() {
        if c.is_whitespace() {
            x += BLANK + GAP;
            continue;
        }
        let (width, strokes) = glyph(c).unwrap_or_else(|| drawn(UNKNOWN));
        for stroke in strokes {
            let place = |[px, py]: Point| [unit * (x + px), unit * (BASELINE - py)];
            lines.push(stroke.into_iter().map(place).collect());
        }
        x += width + GAP;
    }
    (lines, unit * (x - GAP).max(0.0))
}

pub(super) fn points(stroke: &str) -> Vec<Point> {
    let digits = stroke.trim_start_matches('~').chars();
    let digits: Vec<f64> = digits
        .filter_map(|c| c.to_digit(16).map(f64::from))
        .collect();
    let points = digits.as_chunks::<2>().0.to_vec();
    if stroke.starts_with('~') {
        (0..3).fold(points, |points, _| rounded(&points))
    } else {
        points
    }
}

/// Every corner cut at a quarter of its two sides.
fn rounded(points: &[Point]) -> Vec<Point> {
    let (first, last) = (points[0], points[points.len() - 1]);
    let mut cut = Vec::new();
    for pair in points.windows(2) {
        let at = |t: f64| std::array::from_fn(|k| pair[0][k] + t * (pair[1][k] - pair[0][k]));
        cut.extend([at(0.25), at(0.75)]);
    }
    if first == last {
        cut.push(cut[0]);
    } else {
        cut.insert(0, first);
        cut.push(last);
    }
    cut
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_of_ascii_is_drawn_and_stays_inside_its_width() {
        for c in (' '..='~').filter(|&c| c != ' ') {
            let found = LETTERS.iter().find(|&&(letter, ..)| letter == c);
            let &(_, width, strokes) = found.unwrap_or_else(|| panic!("no {c:?}"));
            for stroke in strokes.split('/') {
                let digits = stroke.trim_start_matches('~');
                assert!(
                    digits.len() >= 4 && digits.len() % 2 == 0,
                    "{c:?}: {stroke}"
                );
                for [x, y] in points(stroke) {
                    assert!((0.0..=width).contains(&x) && y <= 13.0, "{c:?}: {x} {y}");
                }
            }
        }
    }

    #[test]
    fn a_word_is_as_wide_as_its_letters_and_their_gaps() {
        let (lines, width) = strokes("II", 1.0);
        assert_eq!(lines.len(), 2);
        assert!((width - GAP * UNIT).abs() < 1e-12, "{width}");
        assert_eq!(strokes("", 5.0), (vec![], 0.0));
        // A capital stands on the baseline.
        assert_eq!(lines[0], [[0.0, -9.0 * UNIT], [0.0, 0.0]]);
    }

    #[test]
    fn a_letter_without_strokes_is_a_box_and_not_nothing() {
        assert_eq!(strokes("語", 1.0).0.len(), 1);
    }
}

//! Letters that are made of others: Latin letters with a mark of Latin-1 and Latin Extended-A, raised digits, and
//! letters of Greek and signs beside those of [`super::font`].

use super::Point;
use super::font::{Glyph, letter, points};

/// A mark, the letters that it makes, and those that it is put on. Points as in [`super::font`], x from the middle of
/// the letter, 4 being there, y above 9.
const MARKS: &[(&str, &str, &str)] = &[
    ("2c5a", "ÀÈÌÒÙàèìòù", "AEIOUaeıou"),
    (
        "2a5c",
        "ÁÉÍÓÚÝáéíóúýĆćĹĺŃńŔŕŚśŹź",
        "AEIOUYaeıouyCcLlNnRrSsZz",
    ),
    (
        "2a4c6a",
        "ÂÊÎÔÛâêîôûĈĉĜĝĤĥĴĵŜŝŴŵŶŷ",
        "AEIOUaeıouCcGgHhJȷSsWwYy",
    ),
    ("~1a2c3c5a6a7c", "ÃÑÕãñõĨĩŨũ", "ANOanoIıUu"),
    ("2b2b/6b6b", "ÄËÏÖÜŸäëïöüÿ", "AEIOUYaeıouy"),
    ("~4a2a2d6d6a4a", "ÅåŮů", "AaUu"),
    ("1b7b", "ĀāĒēĪīŌōŪū", "AaEeIıOoUu"),
    ("~2c2a6a6c", "ĂăĔĕĞğĬĭŎŏŬŭ", "AaEeGgIıOoUu"),
    ("4b4b", "ĊċĖėĠġİŻż", "CcEeGgIZz"),
    ("2c4a6c", "ČčĎĚěŇňŘřŠšŤŽž", "CcDEeNnRrSsTZz"),
    ("3a4d/6a7d", "ŐőŰű", "OoUu"),
    ("4c3a", "ģ", "g"),
    // Below the line.
    ("~43427160204030", "ÇçŞşŢţ", "CcSsTt"),
    ("4230", "ĢĶķĻļŅņŖŗ", "GKkLlNnRr"),
    ("~4333304050", "ĄąĘęĮįŲų", "AaEeIıUu"),
];

/// Letters with a stroke through them, or a comma beside them.
const STRUCK: &[(char, char, &str)] = &[
    ('Đ', 'D', "0838"),
    ('Ð', 'D', "0838"),
    ('đ', 'd', "2b6b"),
    ('Ħ', 'H', "0a6a"),
    ('ħ', 'h', "0b3b"),
    ('Ł', 'L', "0539"),
    ('ł', 'l', "0527"),
    ('Ø', 'O', "037c"),
    ('ø', 'o', "0359"),
    ('Ŧ', 'T', "1858"),
    ('ŧ', 't', "0636"),
    ('ď', 'd', "7c6a"),
    ('ť', 't', "4c3a"),
    ('ľ', 'l', "3c2a"),
    ('Ľ', 'L', "4c3a"),
    ('Ŀ', 'L', "3737"),
    ('ŀ', 'l', "3737"),
    ('ŉ', 'n', "0d0b"),
];

/// Width in units and strokes of further letters.
const OTHERS: &[(char, f64, &str)] = &[
    ('ı', 0., "0903"),
    ('ȷ', 2., "~292000"),
    ('Æ', 9., "035c9c/5c5393/5898/1656"),
    ('æ', 9., "~0903535909/5953/56969799/~979959575353/~53535393"),
    ('Œ', 9., "~5c0c03535c/5c5393/5c9c/5888"),
    ('œ', 9., "~0903535909/5696/~969959535393"),
    ('ß', 5., "~030c4c4838/~3858530313"),
    ('þ', 5., "0c00/~0903535909"),
    ('Þ', 6., "030c/0a3a/~3a6a6535/3505"),
    ('ð', 5., "~0803535808/~583b1c/1a4c"),
    ('ĸ', 5., "0903/5903/1653"),
    ('Ŋ', 6., "030c/0c63/~6c605121"),
    ('ŋ', 5., "0903/~060959524131"),
    ('ſ', 3., "~3c1c13/0919"),
    ('α', 6., "~580903535869/~58565363"),
    ('β', 5., "~000c4c4838/~1858530313"),
    ('γ', 6., "~0919333069/3333"),
    ('δ', 5., "~0803535808/~58382c4c5b"),
    ('ε', 4., "~4829090727/~4323030727/0727"),
    ('ζ', 5., "0c5c/~5c08034321"),
    ('η', 5., "0903/~06095950"),
    ('θ', 5., "~0c03535c0c/0757"),
    ('ι', 1., "~090313"),
    ('κ', 5., "0903/5903/1653"),
    ('λ', 6., "~0c1c2b63/3803"),
    ('ν', 6., "093369"),
    ('ξ', 5., "0c4c/~4c08084737/~4707034321"),
    ('ο', 5., "~0903535909"),
    ('π', 6., "0969/1913/4943"),
    ('ρ', 5., "~000953590703/~0353590906"),
    ('σ', 6., "~0903535909/0969"),
    ('ς', 4., "~4909034321"),
    ('τ', 5., "0959/~292343"),
    ('υ', 5., "~0903535909"),
    ('φ', 6., "~0903636909/3c30"),
    ('χ', 6., "0960/0069"),
    ('ψ', 6., "~09036369/3c30"),
    ('ω', 8., "~0903434746/~46438389"),
    ('Γ', 5., "5c0c03"),
    ('Δ', 6., "03633c03"),
    ('Σ', 6., "6c0c38036363"),
    ('Φ', 7., "~0b05757b0b/3d33"),
    ('Ω', 7., "0323/~230c5c43/4363"),
    ('→', 8., "0787/5a8754"),
    ('≤', 5., "5b0855/0353"),
    ('≥', 5., "0b5805/0353"),
    ('±', 6., "0868/3b35/0363"),
    ('÷', 6., "0767/3a3a/3434"),
    ('Å', 6., "033c63/1656"),
];

/// Raised digits that are the low ones made smaller.
const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/// Width in units and strokes of a letter that is not in the table of [`super::font`].
pub fn composed(c: char) -> Option<Glyph> {
    if let Some(digit) = RAISED.chars().position(|raised| raised == c) {
        return raised(char::from_digit(digit as u32, 10)?);
    }
    marked(c)
        .or_else(|| {
            let &(_, base, stroke) = STRUCK.iter().find(|&&(made, ..)| made == c)?;
            let (width, mut strokes) = letter(base)?;
            strokes.push(points(stroke));
            Some((width, strokes))
        })
        .or_else(|| other(c))
}

fn other(c: char) -> Option<Glyph> {
    let &(_, width, strokes) = OTHERS.iter().find(|&&(letter, ..)| letter == c)?;
    Some((width, strokes.split('/').map(points).collect()))
}

fn raised(digit: char) -> Option<Glyph> {
    const SIZE: f64 = 0.58;
    let (width, strokes) = letter(digit)?;
    let up = |[x, y]: Point| [SIZE * x, SIZE * (y - 3.0) + 7.2];
    let strokes = strokes.into_iter();
    let strokes = strokes.map(|stroke| stroke.into_iter().map(up).collect());
    Some((SIZE * width, strokes.collect()))
}

/// A letter and a mark over or below its middle.
fn marked(c: char) -> Option<Glyph> {
    let (mark, base) = MARKS.iter().find_map(|&(mark, made, bases)| {
        let at = made.chars().position(|letter| letter == c)?;
        Some((mark, bases.chars().nth(at)?))
    })?;
    let (width, mut strokes) = letter(base).or_else(|| other(base))?;
    let top = strokes.iter().flatten().map(|p| p[1]).fold(0.0, f64::max);
    let strokes_of_mark: Vec<Vec<Point>> = mark.split('/').map(points).collect();
    let is_below = strokes_of_mark.iter().flatten().all(|p| p[1] < 9.0);
    let lift = if is_below { 0.0 } else { top - 8.4 };
    // Accents reach no further than a narrow letter and its gaps have room for.
    let slim = if width < 3.0 { 0.55 } else { 0.75 };
    let place = |[x, y]: Point| [0.5 * width + slim * (x - 4.0), y + lift];
    strokes.extend(
        strokes_of_mark
            .into_iter()
            .map(|stroke| stroke.into_iter().map(place).collect()),
    );
    Some((width, strokes))
}

#[cfg(test)]
mod tests {
    use super::super::font::letter_lacking;
    use super::*;

    #[test]
    fn every_letter_of_latin_and_of_greek_is_drawn() {
        let latin_1 = ('\u{c0}'..='\u{ff}').filter(|c| c.is_alphabetic());
        let extended = ('\u{100}'..='\u{17f}').filter(|c| !"Ĳĳ".contains(*c));
        let text: String = latin_1.chain(extended).chain('α'..='ω').collect();
        assert_eq!(letter_lacking(&text), None);
        assert_eq!(letter_lacking("→ ≤ ≥ ⁻⁰¹²³⁴⁵⁶⁷⁸⁹ °C µm"), None);
        assert_eq!(letter_lacking("kЖ"), Some('Ж'));
    }

    #[test]
    fn a_mark_lies_over_its_letter_and_a_raised_digit_above_the_line() {
        for (made, base) in [('č', 'c'), ('Ž', 'Z'), ('é', 'e'), ('ü', 'u')] {
            let height = |glyph: Glyph| {
                glyph
                    .1
                    .into_iter()
                    .flatten()
                    .map(|p| p[1])
                    .fold(0.0, f64::max)
            };
            let [over, under] =
                [composed(made), letter(base)].map(|glyph| height(glyph.expect("a letter")));
            assert!(over > under + 1.0, "{made}: {over} over {under}");
        }
        let (_, strokes) = composed('⁶').expect("a digit");
        assert!(strokes.into_iter().flatten().all(|p| p[1] > 7.0));
    }

    #[test]
    fn every_letter_that_is_made_has_one_to_be_made_of() {
        for (_, made, bases) in MARKS {
            assert_eq!(made.chars().count(), bases.chars().count(), "{made}");
        }
    }
}

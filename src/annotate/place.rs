//! How the volume lies: bars of length, letters of a patient's sides, three arrows along the axes of the world.

use super::{facts::Facts, projector::Projector, sheet::Sheet, units};
use crate::figure::{Anchor, Point};
use crate::volume::Heights;
use glam::DVec3;

/// A scale bar is no longer than this share of the picture's width. It is longer than half of that, where one of 1, 2 and
/// 5 times a power of ten is; between 2 and 5 there is none, and two fifths are the least.
const WIDEST: f64 = 0.3;
/// A second letter stands where a side is so many degrees away from the first.
const OBLIQUE_DEGREES: f64 = 20.0;

/// A bar of a round length in the lower left, and one of heights where they are exaggerated. Gives the pixel above it.
pub fn scale(sheet: &mut Sheet, projector: &Projector, facts: &Facts, height_factor: f64) -> f64 {
    let [width, height] = sheet.size();
    let (em, pixel) = (sheet.em, projector.pixel_at_target());
    let metres = facts.length_metres;
    let (length, mut text) = units::round_length(WIDEST * width * pixel, metres);
    if projector.is_perspective() {
        text += " at the middle";
    }
    let [left, y] = [em, height - 1.2 * em];
    let right = left + length / pixel;
    let ink = sheet.ink([left, y - 1.6 * em], [right, y + 0.3 * em]);
    let foot = 0.35 * em;
    let bracket = vec![[left, y - foot], [left, y], [right, y], [right, y - foot]];
    sheet.line(bracket, 1.5 * sheet.thin(), ink);
    sheet.text([left, y - 0.7 * em], &text, 1.0, Anchor::Start, ink);
    let mut top = y - 1.8 * em;
    // How long a unit of height is in the picture.
    let upright = projector.frame.up.z;
    // Levels whose heights are not known have no lengths.
    let has_heights = facts.heights != Heights::Levels;
    if height_factor > 1.0 && upright > 0.1 && has_heights {
        let unit = height_factor * upright / pixel;
        let (length, text) = units::round_length(0.15 * height / unit, metres);
        let foot_y = top - 0.5 * em;
        let head = foot_y - length * unit;
        let ink = sheet.ink([left, head], [left + 3.0 * em, foot_y]);
        let end = left + foot;
        let bracket = vec![[end, foot_y], [left, foot_y], [left, head], [end, head]];
        sheet.line(bracket, 1.5 * sheet.thin(), ink);
        let text = format!("{text}, ×{height_factor}");
        let middle = 0.5 * (foot_y + head) + 0.35 * em;
        sheet.text([left + 0.8 * em, middle], &text, 1.0, Anchor::Start, ink);
        top = head - 0.8 * em;
    }
    top
}

/// The letters of a patient's side in a direction of the world, two where it is oblique.
pub fn letters(direction: DVec3) -> String {
    const SIDES: [[char; 2]; 3] = [['R', 'L'], ['A', 'P'], ['S', 'I']];
    let unit = direction.normalize_or_zero();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| unit[b].abs().total_cmp(&unit[a].abs()));
    let letter = |k: usize| SIDES[k][usize::from(unit[k] < 0.0)];
    let mut text = letter(axes[0]).to_string();
    if unit[axes[0]].abs() < OBLIQUE_DEGREES.to_radians().cos() {
        text.push(letter(axes[1]));
    }
    text
}

/// Letters at the four edges of a picture that ends at `right` for them.
pub fn sides(sheet: &mut Sheet, projector: &Projector, right: f64) {
    let [width, height] = sheet.size();
    let em = 1.2 * sheet.em;
    let frame = projector.frame;
    let middle = 0.5 * height + 0.35 * em;
    let marks: [(DVec3, Point, Anchor); 4] = [
        (frame.right, [right - 0.7 * em, middle], Anchor::End),
        (-frame.right, [0.8 * em, middle], Anchor::Start),
        (frame.up, [0.5 * width, 1.5 * em], Anchor::Middle),
        (-frame.up, [0.5 * width, height - 0.8 * em], Anchor::Middle),
    ];
    for (direction, at, anchor) in marks {
        sheet.text_on_ground(at, &letters(direction), 1.2, anchor);
    }
}

/// Arrows along x, y and z, the foot of their box at `bottom` and left; the farthest first.
pub fn triad(sheet: &mut Sheet, projector: &Projector, names: [&str; 3], bottom: f64) {
    let em = sheet.em;
    let length = 2.6 * em;
    let origin = [em + length, bottom - length - 0.3 * em];
    let ink = sheet.ink(
        [origin[0] - length, origin[1] - length],
        [origin[0] + length, origin[1] + length],
    );
    let frame = projector.frame;
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| {
        let [a, b] = [a, b].map(|k| DVec3::AXES[k].dot(frame.forward));
        b.total_cmp(&a)
    });
    for k in axes {
        let axis = DVec3::AXES[k];
        let along = [axis.dot(frame.right), -axis.dot(frame.up)];
        let seen = along[0].hypot(along[1]);
        let tip = [origin[0] + length * along[0], origin[1] + length * along[1]];
        let mut stroke = vec![origin, tip];
        if seen > 0.15 {
            let unit = along.map(|x| x / seen);
            let head = 0.45 * em * seen.max(0.5);
            let wing = |side: f64| {
                let across = [-unit[1] * side, unit[0] * side];
                let at = |i: usize| tip[i] - head * (unit[i] - 0.5 * across[i]);
                [at(0), at(1)]
            };
            stroke.extend([wing(1.0), tip, wing(-1.0)]);
        }
        sheet.line(stroke, 1.2 * sheet.thin(), ink);
        // An axis along the line of sight has its letter beside the origin.
        let away = if seen > 0.15 {
            along.map(|x| x / seen)
        } else {
            [-0.7, 0.7]
        };
        let at = [
            tip[0] + 0.8 * em * away[0],
            tip[1] + 0.8 * em * away[1] + 0.35 * em,
        ];
        sheet.text(at, names[k], 1.0, Anchor::Middle, ink);
    }
}

/// What the axes of the world are called.
pub fn axis_names(facts: &Facts) -> [&'static str; 3] {
    match (facts.is_earth, facts.is_patient) {
        (true, _) => ["E", "N", "up"],
        (_, true) => ["R", "A", "S"],
        _ => ["x", "y", "z"],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_has_a_letter_and_two_beyond_20_degrees() {
        let turned = |degrees: f64| {
            let angle = degrees.to_radians();
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        assert_eq!(letters(DVec3::NEG_X), "L");
        assert_eq!(letters(DVec3::NEG_Z), "I");
        assert_eq!(letters(turned(19.0)), "R");
        assert_eq!(letters(turned(21.0)), "RA");
        assert_eq!(letters(turned(-71.0)), "P");
        assert_eq!(letters(turned(-69.0)), "PR");
    }
}

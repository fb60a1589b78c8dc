//! The box of the volume, and numbers along three of its edges.
//!
//! An edge of which both faces look away from the eye lies behind the volume, all others lie before it: a box is
//! convex. Numbers stand at edges of the outline, of those along an axis at the lowest, along the most upright one at
//! the leftmost: what is chosen depends on the camera alone.

use super::{facts::Facts, projector::Projector, sheet::Sheet, units};
use crate::{
    figure::Anchor,
    volume::{Grid, Heights},
};
use glam::DVec3;

/// An edge of the box.
struct Edge {
    axis: usize,
    ends: [DVec3; 2],
    /// How many of its two faces look at the eye.
    facing: usize,
}

fn edges(grid: &Grid, projector: &Projector) -> Vec<Edge> {
    let far = grid.far_corner();
    let corner = |sides: [f64; 3]| {
        grid.world_from_voxel
            .transform_point3(DVec3::from(sides) * far)
    };
    let middle = grid.center();
    // Whether the face at one end of an axis looks at the eye.
    let is_facing = |axis: usize, side: f64| {
        let mut sides = [0.5; 3];
        sides[axis] = side;
        let face = corner(sides);
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3].map(|k| grid.world_from_voxel.matrix3.col(k));
        let normal = a.cross(b);
        let outward = normal * normal.dot(face - middle).signum();
        outward.dot(projector.towards(face)) < 0.0
    };
    let mut edges = Vec::new();
    for axis in 0..3 {
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
        for [at_a, at_b] in [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]] {
            let end = |along: f64| {
                let mut sides = [along; 3];
                (sides[a], sides[b]) = (at_a, at_b);
                corner(sides)
            };
            edges.push(Edge {
                axis,
                ends: [end(0.0), end(1.0)],
                facing: usize::from(is_facing(a, at_a)) + usize::from(is_facing(b, at_b)),
            });
        }
    }
    edges
}

/// Draws the edges that lie behind the volume, or the others.
pub fn draw(sheet: &mut Sheet, projector: &Projector, grid: &Grid, is_behind: bool) {
    let [width, height] = sheet.size();
    let ink = sheet.ink([0.0, 0.0], [width, height]);
    for edge in edges(grid, projector) {
        if (edge.facing == 0) == is_behind
            && let Some(line) = projector.line(edge.ends)
        {
            sheet.line(line.to_vec(), sheet.thin(), ink);
        }
    }
}

/// Draws numbers and units along three edges.
pub fn ticks(
    sheet: &mut Sheet,
    projector: &Projector,
    grid: &Grid,
    facts: &Facts,
    height_factor: f64,
) {
    let em = sheet.em;
    let center = projector.point(grid.center());
    let edges = edges(grid, projector);
    let upright = |axis: usize| {
        let column = grid.world_from_voxel.matrix3.col(axis).normalize();
        column.dot(projector.frame.up).abs()
    };
    let most_upright = (0..3).max_by(|&a, &b| upright(a).total_cmp(&upright(b)));
    for axis in 0..3 {
        let seen = edges
            .iter()
            .filter(|edge| edge.axis == axis && edge.facing == 1);
        let seen = seen.filter_map(|edge| Some((edge, projector.line(edge.ends)?)));
        let order = |line: &[[f64; 2]; 2]| match most_upright == Some(axis) {
            true => line[0][0] + line[1][0],
            false => -(line[0][1] + line[1][1]),
        };
        let Some((edge, line)) = seen.min_by(|(_, a), (_, b)| order(a).total_cmp(&order(b))) else {
            continue;
        };
        let pixels = (line[1][0] - line[0][0]).hypot(line[1][1] - line[0][1]);
        if pixels < 4.0 * em {
            continue;
        }
        let along = edge.ends[1] - edge.ends[0];
        // Coordinates where the edge goes along an axis of the world, else lengths from its first end.
        let world = (0..3).find(|&k| along.normalize()[k].abs() > 1.0 - 1e-6);
        let level = grid.world_from_voxel.matrix3.z_axis.z.abs();
        let measure = Measure::of(world, facts, height_factor, level);
        let range = match world {
            Some(k) => [0, 1].map(|end| edge.ends[end][k] / measure.length),
            None => [0.0, along.length()],
        };
        let most = (pixels / (4.0 * em)) as usize;
        let found = units::ticks([range[0].min(range[1]), range[0].max(range[1])], most);
        // Away from the middle of the box.
        let across = [
            (line[1][1] - line[0][1]) / pixels,
            (line[0][0] - line[1][0]) / pixels,
        ];
        let middle = [
            0.5 * (line[0][0] + line[1][0]),
            0.5 * (line[0][1] + line[1][1]),
        ];
        let side = (0..2)
            .map(|i| across[i] * (middle[i] - center[i]))
            .sum::<f64>();
        let away = across.map(|x| x * if side < 0.0 { -1.0 } else { 1.0 });
        let anchor = match away[0] {
            x if x > 0.4 => Anchor::Start,
            x if x < -0.4 => Anchor::End,
            _ => Anchor::Middle,
        };
        let mut widest = 0.0_f64;
        for (value, text) in &found.at {
            let t = (value - range[0]) / (range[1] - range[0]);
            let [x, y] = projector.point(edge.ends[0] + t * along);
            let at = |length: f64| [x + length * em * away[0], y + length * em * away[1]];
            let [under_x, under_y] = at(1.4);
            let ink = sheet.ink([under_x - em, under_y - em], [under_x + em, under_y + em]);
            sheet.line(vec![[x, y], at(0.4)], sheet.thin(), ink);
            let text = units::signed(text);
            widest = widest.max(sheet.width(&text, 0.9) / em);
            let [x, y] = at(0.9);
            sheet.text([x, y + 0.3 * em], &text, 0.9, anchor, ink);
        }
        let unit = measure.unit.map(str::to_owned);
        let parts: Vec<String> = units::power(found.exponent)
            .into_iter()
            .chain(unit)
            .collect();
        let words = match parts.is_empty() {
            true => measure.name.to_owned(),
            false => format!("{} ({})", measure.name, parts.join(" ")),
        };
        let off = 1.9 + widest * away[0].abs();
        // Inside the picture, whatever the edge.
        let width = sheet.width(words.trim(), 0.9) + 0.5 * em;
        let [left, right] = match anchor {
            Anchor::Start => [0.5 * em, width],
            Anchor::Middle => [0.5 * width, 0.5 * width],
            Anchor::End => [width, 0.5 * em],
        };
        let end = (sheet.size()[0] - right).max(left);
        let at = [
            (middle[0] + off * em * away[0]).clamp(left, end),
            middle[1] + (off * away[1] + 0.3) * em,
        ];
        sheet.text_on_ground(at, words.trim(), 0.9, anchor);
    }
}

/// What coordinates along an edge are.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Measure {
    name: &'static str,
    unit: Option<&'static str>,
    /// The unit's length in the world as it is drawn.
    length: f64,
}

impl Measure {
    /// Along an axis of the world, or none. On the Earth degrees where points are given by them, and levels, so far apart as
    /// they are drawn, where their heights are not known.
    fn of(world: Option<usize>, facts: &Facts, height_factor: f64, level: f64) -> Self {
        let lengths = |name, length| Self {
            name,
            unit: length_unit(facts),
            length,
        };
        let Some(k) = world else {
            return lengths("", 1.0);
        };
        if let (true, Some(Some(length))) = (facts.is_earth, facts.degree_lengths.get(k)) {
            return Self {
                name: ["longitude", "latitude"][k],
                unit: Some("°"),
                length: *length,
            };
        }
        if k == 2 && facts.heights == Heights::Levels {
            return Self {
                name: "level",
                unit: None,
                length: level,
            };
        }
        let names = match facts.is_earth {
            true => ["east on the map", "north on the map", "height"],
            false => ["x", "y", "z"],
        };
        lengths(names[k], if k == 2 { height_factor } else { 1.0 })
    }
}

/// Of the world.
fn length_unit(facts: &Facts) -> Option<&'static str> {
    let metres = facts.length_metres?;
    [
        (1e3, "km"),
        (1.0, "m"),
        (1e-3, "mm"),
        (1e-6, "µm"),
        (1e-9, "nm"),
    ]
    .into_iter()
    .find(|(unit, _)| (metres / unit - 1.0).abs() < 1e-9)
    .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_degrees_where_the_file_gives_them_and_heights_as_they_are() {
        let mut facts = Facts {
            is_earth: true,
            length_metres: Some(1e3),
            degree_lengths: [Some(70.0), Some(111.2)],
            ..Facts::default()
        };
        let of = |facts: &Facts, world| {
            let Measure { name, unit, length } = Measure::of(world, facts, 20.0, 7.0);
            (name, unit.unwrap_or_default(), length)
        };
        assert_eq!(of(&facts, Some(0)), ("longitude", "°", 70.0));
        assert_eq!(of(&facts, Some(1)), ("latitude", "°", 111.2));
        assert_eq!(of(&facts, Some(2)), ("height", "km", 20.0));
        assert_eq!(of(&facts, None), ("", "km", 1.0));
        facts.heights = Heights::Levels;
        assert_eq!(of(&facts, Some(2)), ("level", "", 7.0));
        facts.heights = Heights::Lengths;
        // The map of a weather model.
        facts.degree_lengths = [None; 2];
        assert_eq!(of(&facts, Some(0)), ("east on the map", "km", 1.0));
        facts.is_earth = false;
        assert_eq!(of(&facts, Some(1)), ("y", "km", 1.0));
    }
}

//! The symbol of a wind, as station models have it (WMO-No. 485, attachment II-4).
//!
//! ```text
//! speed     to the nearest 5 knots: a flag for 50, a full feather for 10, a half one for 5; calm under 2.5: a circle
//! staff     from the place to where the wind comes from
//! side      feathers and flags lie to the left of one who goes with the wind, in the southern hemisphere to the right
//! ```
//!
//! Lengths are parts of a staff. The first coordinate goes along it from the place, the second to the left.

use std::f64::consts::TAU;

/// m/s of a knot: 1852 metres an hour.
pub const KNOT: f64 = 1852.0 / 3600.0;

/// What stands at the staff.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Feathers {
    /// Of 50 knots.
    pub flags: u32,
    /// Of 10 knots.
    pub full: u32,
    /// Of 5 knots: none or one.
    pub half: u32,
}

/// Lines and filled triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Symbol {
    pub lines: Vec<Vec<[f64; 2]>>,
    pub flags: Vec<[[f64; 2]; 3]>,
}

/// How far a full feather and a flag reach from the staff.
const REACH: f64 = 0.4;
/// Along the staff: from feather to feather, the foot of a flag, between flags and feathers.
const STEP: f64 = 0.13;
const FOOT: f64 = 0.2;
const GAP: f64 = 0.07;
/// What is left bare at the place.
const BARE: f64 = 0.2;
/// Feathers stand so to the staff, leaning to where the wind comes from.
const LEAN_DEGREES: f64 = 60.0;
/// The circle of calm.
const CALM: f64 = 0.13;
const CALM_CORNERS: u32 = 20;

impl Feathers {
    /// Of a speed in knots.
    pub fn of_knots(knots: f64) -> Self {
        // A wind of a thousand flags is none of the Earth.
        let fives = (knots / 5.0).round().clamp(0.0, 10_000.0) as u32;
        Self {
            flags: fives / 10,
            full: fives % 10 / 2,
            half: fives % 2,
        }
    }

    /// True where there is nothing but a circle.
    pub fn is_calm(self) -> bool {
        self == Self::default()
    }

    /// What is drawn.
    pub fn symbol(self) -> Symbol {
        let mut symbol = Symbol::default();
        if self.is_calm() {
            let corner = |i: u32| {
                let turn = TAU * f64::from(i) / f64::from(CALM_CORNERS);
                [CALM * turn.cos(), CALM * turn.sin()]
            };
            symbol.lines.push((0..=CALM_CORNERS).map(corner).collect());
            return symbol;
        }
        // A half feather alone stands a step from the end, where a full one would.
        let is_alone = self.flags + self.full == 0;
        let steps = f64::from(self.full + self.half + u32::from(is_alone));
        let gap = if self.flags > 0 { GAP } else { 0.0 };
        let taken = f64::from(self.flags) * FOOT + gap + steps * STEP;
        let length = (taken + BARE).max(1.0);
        symbol.lines.push(vec![[0.0, 0.0], [length, 0.0]]);
        let mut at = length;
        for _ in 0..self.flags {
            symbol
                .flags
                .push([[at, 0.0], [at, REACH], [at - FOOT, 0.0]]);
            at -= FOOT;
        }
        at -= gap;
        let (sine, cosine) = LEAN_DEGREES.to_radians().sin_cos();
        let feather = |at: f64, reach: f64| vec![[at, 0.0], [at + reach * cosine, reach * sine]];
        for _ in 0..self.full {
            symbol.lines.push(feather(at, REACH));
            at -= STEP;
        }
        if is_alone {
            at -= STEP;
        }
        if self.half > 0 {
            symbol.lines.push(feather(at, 0.5 * REACH));
        }
        symbol
    }
}

/// Where the wind comes from, and the side of feathers: unit vectors east and north; to the east where there is no wind.
pub fn axes([east, north]: [f64; 2], is_southern: bool) -> [[f64; 2]; 2] {
    let speed = east.hypot(north);
    let from = match speed > 0.0 {
        true => [-east / speed, -north / speed],
        false => [1.0, 0.0],
    };
    let side = if is_southern { -1.0 } else { 1.0 };
    [from, [side * from[1], -side * from[0]]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn feathers(knots: f64) -> [u32; 3] {
        let Feathers { flags, full, half } = Feathers::of_knots(knots);
        [flags, full, half]
    }

    #[test]
    fn speeds_are_rounded_to_5_knots() {
        for (knots, wanted) in [
            (0.0, [0, 0, 0]),
            (2.49, [0, 0, 0]),
            (2.5, [0, 0, 1]),
            (7.49, [0, 0, 1]),
            (7.5, [0, 1, 0]),
            (15.0, [0, 1, 1]),
            (47.49, [0, 4, 1]),
            (47.5, [1, 0, 0]),
            (65.0, [1, 1, 1]),
            (102.6, [2, 0, 1]),
            (f64::NAN, [0, 0, 0]),
        ] {
            assert_eq!(feathers(knots), wanted, "{knots} knots");
        }
        // Every sum is its own speed.
        for fives in 0..60 {
            let [flags, full, half] = feathers(5.0 * f64::from(fives));
            assert_eq!(50 * flags + 10 * full + 5 * half, 5 * fives);
            assert!(full < 5 && half < 2);
        }
        assert!((36.0 / KNOT - 69.978).abs() < 1e-3);
    }

    #[test]
    fn the_staff_goes_to_where_the_wind_comes_from_and_feathers_to_the_side_of_low_pressure() {
        // A west wind: the staff to the west; in the north feathers to the north, in the south to the south.
        assert_eq!(axes([10.0, 0.0], false), [[-1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(axes([10.0, 0.0], true), [[-1.0, 0.0], [0.0, -1.0]]);
        // A south wind: to the south; to the west, to the east.
        assert_eq!(axes([0.0, 3.0], false), [[0.0, -1.0], [-1.0, 0.0]]);
        assert_eq!(axes([0.0, 3.0], true), [[0.0, -1.0], [1.0, 0.0]]);
        let [from, side] = axes([3.0, -4.0], false);
        assert!((from[0] + 0.6).abs() < 1e-15 && (from[1] - 0.8).abs() < 1e-15);
        assert!((from[0] * side[0] + from[1] * side[1]).abs() < 1e-15);
    }

    #[test]
    fn calm_is_a_circle_and_nothing_else() {
        let symbol = Feathers::of_knots(2.0).symbol();
        assert!(symbol.flags.is_empty() && symbol.lines.len() == 1);
        for [x, y] in &symbol.lines[0] {
            assert!((x.hypot(*y) - CALM).abs() < 1e-15);
        }
        let ends = [symbol.lines[0][0], symbol.lines[0][20]];
        assert!((ends[0][1] - ends[1][1]).abs() < 1e-15 && ends[0][0] > 0.0);
    }

    #[test]
    fn feathers_stand_apart_from_the_end_of_the_staff_inward() {
        for knots in (5..300).step_by(5) {
            let feathers = Feathers::of_knots(f64::from(knots));
            let symbol = feathers.symbol();
            assert_eq!(symbol.flags.len(), feathers.flags as usize);
            let count = 1 + feathers.full + feathers.half;
            assert_eq!(symbol.lines.len(), count as usize, "{knots}");
            let [end, _] = symbol.lines[0][1];
            let mut last = end + STEP;
            for [[at, foot], [tip, reach], [next, _]] in &symbol.flags {
                assert!(*foot == 0.0 && tip == at && *reach == REACH && next < at);
                last = *next;
            }
            for (i, line) in symbol.lines[1..].iter().enumerate() {
                let [[at, foot], [tip, side]] = [line[0], line[1]];
                assert!(foot == 0.0 && at > 0.15 && last - at > 0.05, "{knots}");
                // Outward, and leaning to where the wind comes from.
                let length = (tip - at).hypot(side);
                let wanted = if i < feathers.full as usize { 1.0 } else { 0.5 };
                assert!((length - wanted * REACH).abs() < 1e-12 && tip > at && side > 0.0);
                last = at;
            }
            // A half feather is never at the end.
            let first = symbol.lines.get(1).and_then(|line| line.first());
            assert!(knots != 5 || first.is_some_and(|[at, _]| end - at > 0.9 * STEP));
        }
    }
}

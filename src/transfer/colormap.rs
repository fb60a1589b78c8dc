//! Colour maps by name: 256 colours each, from the lowest value to the highest.
//!
//! The tables are `colormaps/NAME.rgb`, 256 times three bytes of sRGB:
//!
//! - viridis, magma, inferno, plasma (Smith & van der Walt 2015) and cividis (Nuñez, Anderton & Renslow 2018): CC0,
//!   the numbers of Matplotlib 3.11;
//! - turbo (Mikhailov 2019, Google): Apache-2.0, the numbers of Matplotlib 3.11;
//! - batlow, roma, vik: Crameri, *Scientific colour maps*, MIT (cmcrameri 1.8);
//! - coolwarm: computed by Moreland, *Diverging Color Maps for Scientific Visualization*, ISVC 2009, between (59, 76,
//!   192) and (180, 4, 38);
//! - hot-iron, pet: DICOM PS3.6, B.1.1 and B.1.2;
//! - grey: equal steps of sRGB numbers; wind: ours, dark blue over green and sand to white, its CIE lightness a
//!   straight line.

use super::{ColorPoint, Interpolation, TransferFunction, Window};
use std::{fmt, str::FromStr};

/// How many colours a map has.
pub const COLORMAP_COLORS: usize = 256;

/// A colour map, perhaps from its last colour to its first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colormap {
    known: &'static Known,
    /// True where the lowest value has the last colour.
    pub reversed: bool,
}

#[derive(Debug, PartialEq, Eq)]
struct Known {
    name: &'static str,
    description: &'static str,
    table: &'static [u8; 3 * COLORMAP_COLORS],
}

macro_rules! known {
    ($($name:literal $description:literal)*) => {
        static KNOWN: &[Known] = &[$(Known {
            name: $name,
            description: $description,
            table: include_bytes!(concat!("colormaps/", $name, ".rgb")),
        }),*];
    };
}

known! {
    "viridis"  "dark violet, green, yellow: equal steps look equal"
    "magma"    "black, magenta, pale yellow: equal steps look equal"
    "inferno"  "black, red, pale yellow: equal steps look equal"
    "plasma"   "blue, magenta, yellow: equal steps look equal"
    "cividis"  "blue to yellow, the same to colour-blind eyes"
    "turbo"    "a rainbow of many hues; lightness rises and falls"
    "batlow"   "dark blue, green, orange, pale rose: equal steps look equal"
    "roma"     "brown, yellow, blue: about a middle; reversed for temperature"
    "vik"      "blue, white, brown: about a middle"
    "coolwarm" "blue, grey, red: about a middle"
    "grey"     "black to white"
    "wind"     "dark blue, green, sand, white: for speed"
    "hot-iron" "black, red, orange, white: DICOM's palette for nuclear medicine"
    "pet"      "black, green, blue, red, yellow, white: DICOM's palette for PET"
}

impl Colormap {
    /// Every map, from its first colour to its last.
    pub fn all() -> impl Iterator<Item = Self> {
        KNOWN.iter().map(|known| Self {
            known,
            reversed: false,
        })
    }

    /// The map of this name.
    ///
    /// ```
    /// # use stratavox::transfer::Colormap;
    /// let viridis = Colormap::from_name("viridis").unwrap();
    /// assert_eq!(viridis.colors()[255], [253, 231, 37]);
    /// assert!(Colormap::from_name("jet").is_none());
    /// ```
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|map| map.known.name == name)
    }

    /// From the last colour to the first.
    pub fn reverse(self) -> Self {
        Self {
            reversed: !self.reversed,
            ..self
        }
    }

    /// The word of `--colormap`.
    pub fn name(self) -> &'static str {
        self.known.name
    }

    /// What it looks like and what it is for, a line.
    pub fn description(self) -> &'static str {
        self.known.description
    }

    /// The colours from the lowest value to the highest, sRGB bytes.
    pub fn colors(self) -> [[u8; 3]; COLORMAP_COLORS] {
        std::array::from_fn(|i| {
            let i = if self.reversed {
                COLORMAP_COLORS - 1 - i
            } else {
                i
            };
            std::array::from_fn(|c| self.known.table[3 * i + c])
        })
    }

    /// The colour at a fraction of the map: 0 its first, 1 its last, straight lines of sRGB numbers between.
    pub fn srgb(self, t: f64) -> [f64; 3] {
        let colors = self.colors();
        let last = COLORMAP_COLORS - 1;
        let at = t.clamp(0.0, 1.0) * last as f64;
        let left = (at as usize).min(last - 1);
        let share = at - left as f64;
        std::array::from_fn(|c| {
            let [a, b] = [left, left + 1].map(|i| f64::from(colors[i][c]));
            (a + share * (b - a)) / 255.0
        })
    }

    /// Control points of colour over `window`, the first colour at its low end.
    pub fn points(self, window: Window) -> Vec<ColorPoint> {
        let last = (COLORMAP_COLORS - 1) as f64;
        let point = |(i, rgb): (usize, [u8; 3])| ColorPoint {
            value: window.at(i as f64 / last),
            srgb: rgb.map(|c| f64::from(c) / 255.0),
        };
        self.colors().into_iter().enumerate().map(point).collect()
    }
}

/// `NAME` or `NAME,reverse`.
impl FromStr for Colormap {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, reversed) = match text.split_once(',') {
            None => (text, false),
            Some((name, "reverse")) => (name, true),
            Some((_, other)) => {
                return Err(format!("wanted NAME or NAME,reverse, found {other:?}"));
            }
        };
        let map = Self::from_name(name).ok_or_else(|| {
            let names: Vec<_> = Self::all().map(Self::name).collect();
            format!("no colour map {name:?}; there are {}", names.join(", "))
        })?;
        Ok(if reversed { map.reverse() } else { map })
    }
}

impl fmt::Display for Colormap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.known.name)?;
        f.write_str(if self.reversed { ",reverse" } else { "" })
    }
}

impl TransferFunction {
    /// This function in the colours of `map`: over `window`, else over the values from its first point of colour to
    /// its last. Where the function is one of steps, each step takes the colour at its value. Opacity, and widgets
    /// with colours of their own, stay.
    pub fn with_colormap(&self, map: Colormap, window: Option<Window>) -> Self {
        let ends =
            [self.color.first(), self.color.last()].map(|point| point.map_or(0.0, |p| p.value));
        let window = window.unwrap_or(Window::of_range(ends));
        let color = match self.interpolation {
            Interpolation::Linear => map.points(window),
            Interpolation::Step => {
                let at = |point: &ColorPoint| ColorPoint {
                    srgb: map.srgb((point.value - window.low()) / (window.high() - window.low())),
                    ..*point
                };
                self.color.iter().map(at).collect()
            }
        };
        Self {
            color,
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE L* of sRGB bytes (IEC 61966-2-1 and CIE 15, D65).
    fn lightness(rgb: [u8; 3]) -> f64 {
        let linear = rgb.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        });
        let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        if y > 216.0 / 24389.0 {
            116.0 * y.cbrt() - 16.0
        } else {
            y * 24389.0 / 27.0
        }
    }

    #[test]
    fn lightness_rises_but_in_maps_about_a_middle_and_of_many_hues() {
        // A byte of blue more or less changes L* by less than a tenth.
        const ROUNDING: f64 = 0.1;
        let mut falling = Vec::new();
        for map in Colormap::all() {
            let lightness = map.colors().map(lightness);
            if lightness
                .windows(2)
                .any(|pair| pair[1] < pair[0] - ROUNDING)
            {
                falling.push(map.name());
            }
            assert!(
                lightness[255] > lightness[0] || falling.contains(&map.name()),
                "{map}"
            );
        }
        assert_eq!(falling, ["turbo", "roma", "vik", "coolwarm", "pet"]);
    }

    #[test]
    fn maps_about_a_middle_are_lightest_there() {
        for name in ["roma", "vik", "coolwarm"] {
            let colors = Colormap::from_name(name).expect(name).colors();
            let lightness = colors.map(lightness);
            let lightest = (0..256).max_by(|&a, &b| lightness[a].total_cmp(&lightness[b]));
            assert!(
                (100..=156).contains(&lightest.expect("a colour")),
                "{name} {lightest:?}"
            );
        }
    }

    #[test]
    fn the_tables_are_those_of_their_sources() {
        // FNV-1a, 64 bits, of the tables that the sources gave.
        let sums = Colormap::all().map(|map| {
            let add = |sum: u64, &byte: &u8| (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            let sum = map.known.table.iter().fold(0xcbf2_9ce4_8422_2325, add);
            format!("{map} {sum:016x}")
        });
        let wanted = [
            "viridis 1b8e5490518c939b",
            "magma 18a2c8df7018d2be",
            "inferno 0c171f8959472839",
            "plasma b80f5cf20e4372dc",
            "cividis 7a7f3ae563911aa6",
            "turbo cf9a52c7e29b2626",
            "batlow 18ad1e62ec607887",
            "roma 0220683426cfe34f",
            "vik 79abbce757cb27cc",
            "coolwarm 2b522f6124ee925d",
            "grey 3ac8574c48f9b025",
            "wind 2279f5f588156bd6",
            "hot-iron d61fd8c596882351",
            "pet ebdb81b4234cfee6",
        ];
        assert_eq!(sums.collect::<Vec<_>>(), wanted);
    }

    #[test]
    fn a_map_comes_back_from_its_word() {
        for map in Colormap::all().flat_map(|map| [map, map.reverse()]) {
            assert_eq!(map.to_string().parse(), Ok(map));
            assert_eq!(map.srgb(0.0), map.reverse().srgb(1.0));
        }
        for (text, wanted) in [
            ("jet", "viridis"),
            ("roma,back", "reverse"),
            ("Viridis", "viridis"),
        ] {
            let problem = text.parse::<Colormap>().expect_err(text);
            assert!(problem.contains(wanted), "{problem}");
        }
    }

    #[test]
    fn only_colours_change() {
        let window = Window::of_range([-5.0, 5.0]);
        let grey = window.grey(super::super::Classified::Samples);
        let vik = Colormap::from_name("vik").expect("vik");
        let colored = grey.with_colormap(vik, None);
        assert_eq!(colored.opacity, grey.opacity);
        assert_eq!(
            [colored.color[0].value, colored.color[255].value],
            [-5.0, 5.0]
        );
        let other = grey.with_colormap(vik, Some(Window::of_range([0.0, 1.0])));
        assert_eq!([other.color[0].value, other.color[255].value], [0.0, 1.0]);
        let steps = TransferFunction {
            interpolation: Interpolation::Step,
            ..grey
        };
        let colored = steps.with_colormap(vik, None);
        assert_eq!(colored.color.len(), 2);
        assert_eq!(colored.color[1].srgb, vik.srgb(1.0));
    }

    #[cfg(feature = "json")]
    #[test]
    fn a_map_comes_back_from_a_file() {
        use super::super::{transfer_function_from_json, transfer_function_to_json};
        for map in Colormap::all() {
            let grey = Window::of_range([-0.1, 3e7]).grey(super::super::Classified::Samples);
            let function = grey.with_colormap(map, None);
            let text = transfer_function_to_json(&function);
            let found = transfer_function_from_json(text.as_bytes()).expect("a function");
            assert_eq!(found, function, "{map}");
        }
    }
}

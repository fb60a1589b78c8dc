//! Units of length as microscopes write them.

/// Metres of a unit, and its short word; `None` where it is no length.
pub(super) fn unit(word: &str) -> Option<(f64, &'static str)> {
    let lower = word.trim().to_lowercase();
    // U+00B5 (micro sign) lowers to itself, U+03BC (Greek mu) is another character.
    Some(match lower.as_str() {
        "pm" | "picometer" | "picometre" => (1e-12, "pm"),
        "å" | "\u{212b}" | "angstrom" => (1e-10, "angstrom"),
        "nm" | "nanometer" | "nanometre" | "nanometers" => (1e-9, "nm"),
        "\u{b5}m" | "\u{3bc}m" | "um" | "micron" | "microns" | "micrometer" | "micrometre"
        | "micrometers" => (1e-6, "um"),
        "mm" | "millimeter" | "millimetre" | "millimeters" => (1e-3, "mm"),
        "cm" | "centimeter" | "centimetre" | "centimeters" => (1e-2, "cm"),
        "dm" => (1e-1, "dm"),
        "in" | "inch" | "inches" => (0.0254, "in"),
        "m" | "meter" | "metre" | "meters" => (1.0, "m"),
        "km" => (1e3, "km"),
        _ => return None,
    })
}

/// What a file says about the size of a voxel.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Spacing {
    /// Along x, y, z in `unit`; `None` where the file is silent.
    pub steps: [Option<f64>; 3],
    /// The word for the unit.
    pub unit: Option<&'static str>,
}

impl Spacing {
    /// The steps with what is missing filled in, and sentences that say so.
    pub(super) fn filled(&self, depth: u32, notes: &mut Vec<String>) -> [f64; 3] {
        let good = |step: &Option<f64>| step.filter(|step| step.is_finite() && *step > 0.0);
        let [x, y, z] = self.steps.each_ref().map(good);
        let (Some(x), Some(y)) = (x.or(y), y.or(x)) else {
            notes.push(match z {
                None => "the file gives no spacing: 1 is taken".to_owned(),
                Some(_) => {
                    "the file gives no spacing along x and y: that along z is taken".to_owned()
                }
            });
            return [z.unwrap_or(1.0); 3];
        };
        if let Some(unit) = self.unit {
            notes.push(format!("lengths are in {unit}"));
        }
        let shortest = x.min(y);
        if z.is_none() && depth > 1 {
            notes.push(
                "the file gives no spacing between pages: the smaller one between pixels is taken"
                    .to_owned(),
            );
        }
        [x, y, z.unwrap_or(shortest)]
    }
}

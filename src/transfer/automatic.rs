//! The transfer function of a volume of which nothing is said: what kind of data it looks like, and what
//! shows that kind well.

use super::preset::{Stop, ramp, reference_length, sparse, spread, tissue, uptake};
use super::{
    Classified, ColorPoint, Interpolation, OpacityPoint, TransferFunction, ValueSummary, Window,
};

use super::Quantity;

/// What the values of a volume look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Few whole numbers, the same over many neighbours.
    Labels,
    /// Hounsfield units.
    Ct,
    /// A dark background and an object of many voxels, as in MRI.
    Tissue,
    /// A dark background and little signal, as in microscopy.
    Sparse,
    /// Radioactivity that a body took up, as in PET: by its unit.
    Uptake,
    /// Values on both sides of zero, as wind or seismic amplitudes.
    Signed,
    /// Values everywhere, as simulations have.
    Field,
}

impl Kind {
    /// The kind that values like these are of.
    pub fn of(summary: &ValueSummary) -> Self {
        let [low, high] = summary.range;
        if summary.labels.is_some() {
            return Self::Labels;
        }
        if summary.hounsfield || looks_like_hounsfield(summary) {
            return Self::Ct;
        }
        if summary.quantity == Quantity::Uptake {
            return Self::Uptake;
        }
        if low < 0.0 && high > 0.0 && -low > 0.2 * high && high > 0.2 * -low {
            return Self::Signed;
        }
        // Outliers do not count: the background is dark against most of the values.
        let (dark, bright) = (summary.quantile(0.001), summary.quantile(0.999));
        let threshold = summary.threshold(dark, summary.quantile(0.9995));
        let mode = summary.mode_below(threshold);
        let near = 0.02 * (bright - dark);
        let background = summary.share_below(mode + near) - summary.share_below(mode - near);
        // Measured numbers have noise in the background; computed ones have no background but by a mask.
        let enough = if summary.integers { 0.1 } else { 0.3 };
        if mode > dark + 0.25 * (bright - dark) || background < enough {
            return Self::Field;
        }
        if 1.0 - summary.share_below(threshold) < 0.03 {
            Self::Sparse
        } else if summary.quantity == Quantity::Field {
            // Moist air below dry air looks like tissue below air, and is none.
            Self::Field
        } else {
            Self::Tissue
        }
    }

    /// What was taken for what, for a note to the user.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Labels => "the values look like labels: each has a colour of its own",
            Self::Ct => "the values are Hounsfield units: bone, and faint skin",
            Self::Tissue => "the values look like tissue on a dark background",
            Self::Sparse => "the values look like little bright signal on a dark background",
            Self::Uptake => "the values are radioactivity: hot spots glow in a faint body",
            Self::Signed => "the values lie on both sides of zero: blue below, red above",
            Self::Field => "the values look like a field without background",
        }
    }
}

/// The transfer function where neither a file nor a preset is given.
///
/// Where one value a ray is classified: the grey ramp over `window`, or over the volume's range. Else what
/// suits the [`Kind`] of the volume, spread over `window` if one is given.
pub fn automatic(
    summary: &ValueSummary,
    classified: Classified,
    window: Option<Window>,
) -> TransferFunction {
    if classified == Classified::Projection {
        let window = window.unwrap_or(Window::of_range(summary.range));
        return window.grey(classified);
    }
    let function = match Kind::of(summary) {
        Kind::Labels => categorical(summary),
        Kind::Ct => ramp(summary, CT),
        Kind::Tissue => tissue(summary),
        Kind::Sparse => sparse(summary),
        Kind::Uptake => uptake(summary),
        Kind::Signed => signed(summary),
        Kind::Field => field(summary),
    };
    match window {
        Some(window) => function.spread_over(window),
        None => function,
    }
}

/// Air is there, and what is not air reaches bone. Paddings of -2000, -2048 and -3024 are in use.
fn looks_like_hounsfield(summary: &ValueSummary) -> bool {
    let [low, high] = summary.range;
    let air = summary.share_below(-800.0);
    let gap = summary.share_below(-500.0) - air;
    summary.integers && (-3100.0..=-900.0).contains(&low) && high > 200.0 && air > 0.05 && gap < air
}

/// Skin is where air turns to tissue, -500 to -200 HU; then bone as `ct-bone` has it.
const CT: &[Stop] = &[
    (-650.0, [110, 66, 48], 0.0),
    (-420.0, [176, 118, 94], 0.022),
    (-250.0, [226, 172, 146], 0.03),
    (-120.0, [214, 150, 120], 0.002),
    (110.0, [60, 12, 8], 0.002),
    (200.0, [92, 26, 16], 0.05),
    (330.0, [150, 78, 48], 0.14),
    (560.0, [212, 168, 124], 0.3),
    (1000.0, [244, 226, 196], 0.6),
    (1800.0, [255, 255, 250], 0.9),
];

/// Five colours of viridis (Smith & van der Walt 2015, public domain): equal steps look equal.
const FIELD: &[Stop] = &[
    (0.0, [68, 1, 84], 0.0),
    (0.25, [59, 82, 139], 0.002),
    (0.5, [33, 145, 140], 0.008),
    (0.75, [94, 201, 98], 0.03),
    (1.0, [253, 231, 37], 0.1),
];

/// -1 to 1, what is near zero gone.
const SIGNED: &[Stop] = &[
    (-1.0, [20, 60, 190], 0.25),
    (-0.5, [90, 150, 235], 0.06),
    (-0.15, [190, 205, 225], 0.0),
    (0.15, [225, 205, 190], 0.0),
    (0.5, [240, 130, 90], 0.06),
    (1.0, [180, 20, 20], 0.25),
];

/// Between the values that one voxel in a hundred lies below and above.
fn field(summary: &ValueSummary) -> TransferFunction {
    let window = Window::new(summary.quantile(0.01), summary.quantile(0.99))
        .unwrap_or(Window::of_range(summary.range));
    spread(summary, FIELD, |t| window.at(t))
}

/// What CT is, where `offset` is added to Hounsfield units.
pub(super) fn offset_ct(summary: &ValueSummary, offset: f64) -> TransferFunction {
    spread(summary, CT, |value| value + offset)
}

/// The same length on both sides of zero, so that colours can be compared.
pub(super) fn signed(summary: &ValueSummary) -> TransferFunction {
    let reach = summary
        .quantile(0.005)
        .abs()
        .max(summary.quantile(0.995).abs());
    let reach = if reach > 0.0 { reach } else { summary.range[1] };
    spread(summary, SIGNED, |t| t * reach)
}

/// One colour a label; the background, 0 or else the label of most voxels, is transparent.
pub(super) fn categorical(summary: &ValueSummary) -> TransferFunction {
    let labels = summary.labels.as_deref().unwrap_or_default();
    let most = labels.iter().max_by_key(|&&(_, count)| count);
    let background = if labels.iter().any(|&(label, _)| label == 0) {
        Some(0)
    } else {
        most.map(|&(label, _)| label)
    };
    // A label rules the values that round to it.
    let value = |label: i64| label as f64 - 0.5;
    let color = labels.iter().map(|&(label, _)| ColorPoint {
        value: value(label),
        srgb: label_color(label),
    });
    let opacity = labels.iter().map(|&(label, _)| OpacityPoint {
        value: value(label),
        opacity: if Some(label) == background { 0.0 } else { 0.05 },
    });
    TransferFunction {
        color: color.collect(),
        opacity: opacity.collect(),
        reference_length: reference_length(summary),
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    }
}

/// The golden angle apart, so that neighbours differ and no two of many labels are alike.
pub(super) fn label_color(label: i64) -> [f64; 3] {
    let hue = (label as f64 * 0.618_033_988_749_895).rem_euclid(1.0) * 6.0;
    let lightness = [0.95, 0.75, 0.85][label.rem_euclid(3) as usize];
    let saturation = [0.75, 0.6][label.rem_euclid(2) as usize];
    // HSV (Smith 1978): each primary is at its full within 60 degrees of its hue.
    [0.0, 4.0, 2.0].map(|offset| {
        let distance = ((hue + offset).rem_euclid(6.0) - 3.0).abs() - 1.0;
        lightness * (1.0 - saturation * (1.0 - distance.clamp(0.0, 1.0)))
    })
}

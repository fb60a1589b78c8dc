//! Named transfer functions.
//!
//! There is no light in emission and absorption, so shape comes from colour: the outermost, lowest values of
//! a surface are dark and not quite transparent. A ray that meets the surface head-on is through them at
//! once; one that grazes it gathers them, and the rim darkens as if it were lit.

use super::{
    Classified, ColorPoint, GradientTransfer, Interpolation, OpacityPoint, TransferFunction,
    ValueSummary, Window,
};

/// A transfer function with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Preset {
    /// Bone in ivory, contrast vessels reddish, all else gone. Hounsfield units.
    CtBone,
    /// Muscle and organs in flesh tones, fat faint, bone light. Hounsfield units.
    CtSoftTissue,
    /// Airways and lung tissue; the body around faint. Hounsfield units.
    CtLung,
    /// Tissue in warm tones, background noise gone. Fits itself to the values.
    Mri,
    /// Bright signal on a dark background. Fits itself to the values.
    Microscopy,
    /// Hot spots of uptake in a faint body. Fits itself to the values.
    Pet,
    /// The boundaries between substances, the lowest faint. Fits itself to values and gradients
    /// (`super::boundaries`).
    Boundaries,
    /// A grey ramp over the window, as `cli.md` has it.
    Grey,
}

impl Preset {
    /// All of them, in the order of `preset list`.
    pub const ALL: [Self; 8] = [
        Self::CtBone,
        Self::CtSoftTissue,
        Self::CtLung,
        Self::Mri,
        Self::Microscopy,
        Self::Pet,
        Self::Boundaries,
        Self::Grey,
    ];

    /// The word of `--preset`.
    pub fn name(self) -> &'static str {
        match self {
            Self::CtBone => "ct-bone",
            Self::CtSoftTissue => "ct-soft-tissue",
            Self::CtLung => "ct-lung",
            Self::Mri => "mri",
            Self::Microscopy => "microscopy",
            Self::Pet => "pet",
            Self::Boundaries => "boundaries",
            Self::Grey => "grey",
        }
    }

    /// The preset of a word of `--preset`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// One line for `preset list`.
    pub fn description(self) -> &'static str {
        match self {
            Self::CtBone => "bone, and vessels full of contrast medium (Hounsfield units)",
            Self::CtSoftTissue => "muscle and organs, faint fat, light bone (Hounsfield units)",
            Self::CtLung => "lung tissue and airways in a faint body (Hounsfield units)",
            Self::Mri => "soft tissue without the noise around it (fits the volume)",
            Self::Microscopy => "bright signal on a dark background (fits the volume)",
            Self::Pet => "hot spots of uptake in a faint body (fits the volume)",
            Self::Boundaries => {
                "surfaces between substances, by value and gradient (fits the volume)"
            }
            Self::Grey => "a grey ramp over the window or the volume's range",
        }
    }

    /// True where the preset fits itself to the values; else it stands at values of its own.
    pub fn fits_the_volume(self) -> bool {
        match self {
            Self::CtBone | Self::CtSoftTissue | Self::CtLung => false,
            Self::Mri | Self::Microscopy | Self::Pet | Self::Boundaries | Self::Grey => true,
        }
    }

    /// The preset for values like those of `summary`, spread over `window` if one is given.
    ///
    /// Opacities are for 1/512 of the diagonal of the grid, so that volumes of few and of many voxels look
    /// alike; those of `grey` are for the smallest voxel spacing. `boundaries` is here what is known of it without
    /// gradients: what is steep of the bright class.
    pub fn function(
        self,
        summary: &ValueSummary,
        classified: Classified,
        window: Option<Window>,
    ) -> TransferFunction {
        let function = match self {
            Self::Grey => {
                let window = window.unwrap_or(Window::of_range(summary.range));
                return window.grey(classified);
            }
            Self::CtBone => ramp(summary, CT_BONE),
            Self::CtSoftTissue => ramp(summary, CT_SOFT_TISSUE),
            Self::CtLung => ramp(summary, CT_LUNG),
            Self::Mri => tissue(summary),
            Self::Microscopy => sparse(summary),
            Self::Pet => uptake(summary),
            Self::Boundaries => steep(summary),
        };
        match window {
            Some(window) => function.spread_over(window),
            None => function,
        }
    }
}

/// (value, sRGB in 0 to 255, opacity per 1/512 of the diagonal).
pub(super) type Stop = (f64, [u8; 3], f64);

/// Cortical bone is above 300 HU, spongy bone and contrast medium from 150.
const CT_BONE: &[Stop] = &[
    (120.0, [40, 6, 4], 0.0),
    (200.0, [92, 26, 16], 0.05),
    (330.0, [150, 78, 48], 0.14),
    (560.0, [212, 168, 124], 0.3),
    (1000.0, [244, 226, 196], 0.6),
    (1800.0, [255, 255, 250], 0.9),
];

/// Fat is near -100 HU, water 0, muscle and organs 20 to 80, bone above 200.
const CT_SOFT_TISSUE: &[Stop] = &[
    (-160.0, [60, 34, 10], 0.0),
    (-90.0, [150, 110, 60], 0.003),
    (-30.0, [110, 40, 26], 0.008),
    (20.0, [128, 36, 28], 0.05),
    (70.0, [206, 104, 84], 0.16),
    (140.0, [236, 170, 140], 0.2),
    (260.0, [244, 222, 190], 0.4),
    (700.0, [255, 250, 238], 0.8),
];

/// Air is -1000 HU, lung -900 to -500; its walls and vessels stand out against it.
const CT_LUNG: &[Stop] = &[
    (-960.0, [20, 24, 60], 0.0),
    (-880.0, [34, 52, 110], 0.006),
    (-700.0, [74, 128, 176], 0.025),
    (-520.0, [170, 200, 210], 0.04),
    (-400.0, [230, 200, 180], 0.02),
    (-250.0, [180, 110, 90], 0.004),
    (60.0, [190, 110, 90], 0.01),
    (250.0, [240, 220, 190], 0.06),
    (800.0, [255, 250, 238], 0.2),
];

/// Value as a fraction: 0 where tissue begins, 1 at its brightest.
const MRI: &[Stop] = &[
    (0.0, [26, 8, 6], 0.0),
    (0.18, [84, 32, 24], 0.03),
    (0.4, [160, 92, 66], 0.09),
    (0.65, [214, 168, 132], 0.2),
    (0.85, [244, 222, 196], 0.4),
    (1.0, [255, 252, 244], 0.6),
];

/// Value as a fraction: 0 where signal begins, 1 at its brightest.
const MICROSCOPY: &[Stop] = &[
    (0.0, [0, 24, 40], 0.0),
    (0.2, [0, 88, 110], 0.04),
    (0.5, [20, 180, 150], 0.15),
    (0.8, [150, 240, 180], 0.35),
    (1.0, [250, 255, 240], 0.6),
];

/// Share of the brightest uptake: the body a bluish haze, then a glowing iron.
const PET: &[Stop] = &[
    (0.03, [40, 46, 60], 0.0),
    (0.06, [70, 80, 104], 0.006),
    (0.14, [96, 60, 90], 0.01),
    (0.25, [120, 16, 40], 0.03),
    (0.45, [200, 60, 10], 0.12),
    (0.7, [250, 160, 20], 0.35),
    (1.0, [255, 250, 210], 0.7),
];

/// Stops as they stand.
pub(super) fn ramp(summary: &ValueSummary, stops: &[Stop]) -> TransferFunction {
    spread(summary, stops, |value| value)
}

/// What `mri` is, over the bright class of the values and a third of the way down to the background.
pub(super) fn tissue(summary: &ValueSummary) -> TransferFunction {
    fitted(summary, MRI, 0.35)
}

/// As much of tissue as it is steep.
fn steep(summary: &ValueSummary) -> TransferFunction {
    let share = [(0.05, 0.0), (0.4, 1.0)];
    let share = share.map(|(value, opacity)| OpacityPoint { value, opacity });
    TransferFunction {
        medium: None,
        gradient_transfer: Some(GradientTransfer {
            share: share.into(),
            ..GradientTransfer::default()
        }),
        ..tissue(summary)
    }
}

/// What `microscopy` is, over the bright class of the values and most of the way down to the background.
pub(super) fn sparse(summary: &ValueSummary) -> TransferFunction {
    fitted(summary, MICROSCOPY, 0.6)
}

/// What `pet` is, from no uptake to what one voxel in a thousand exceeds.
pub(super) fn uptake(summary: &ValueSummary) -> TransferFunction {
    let window = Window::new(0.0, summary.quantile(0.999));
    let window = window.unwrap_or(Window::of_range(summary.range));
    spread(summary, PET, |t| window.at(t))
}

/// Stops over the bright class of the values: 0 lies where a share `early` of the way from the background
/// to the threshold is left, 1 at the value that one voxel in two hundred of the bright class exceeds.
fn fitted(summary: &ValueSummary, stops: &[Stop], early: f64) -> TransferFunction {
    let window = signal(summary, early);
    spread(summary, stops, |t| window.at(t))
}

/// Where the bright class of the values lies.
pub(super) fn signal(summary: &ValueSummary, early: f64) -> Window {
    let [low, high] = [summary.quantile(0.001), summary.quantile(0.9995)];
    let threshold = summary.threshold(low, high);
    let background = summary.mode_below(threshold);
    let start = threshold - early * (threshold - background);
    let bright = 1.0 - summary.share_below(threshold);
    let end = summary.quantile(1.0 - bright / 200.0);
    Window::new(start, end).unwrap_or(Window::of_range(summary.range))
}

pub(super) fn spread(
    summary: &ValueSummary,
    stops: &[Stop],
    value_at: impl Fn(f64) -> f64,
) -> TransferFunction {
    let color = stops.iter().map(|&(at, rgb, _)| ColorPoint {
        value: value_at(at),
        srgb: rgb.map(|c| f64::from(c) / 255.0),
    });
    let opacity = stops.iter().map(|&(at, _, opacity)| OpacityPoint {
        value: value_at(at),
        opacity,
    });
    TransferFunction {
        color: color.collect(),
        opacity: opacity.collect(),
        reference_length: reference_length(summary),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// 1/512 of the diagonal of the grid.
pub(super) fn reference_length(summary: &ValueSummary) -> Option<f64> {
    let length = summary.diagonal / 512.0;
    (length > 0.0 && length.is_finite()).then_some(length)
}

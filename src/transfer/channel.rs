//! Transfer functions of things that are seen together: each in one colour, of which little is opaque.

use super::preset::{reference_length, signal};
use super::{
    Classified, ColorPoint, Interpolation, OpacityPoint, TransferFunction, ValueSummary, Window,
};

/// Colours of channels of which nothing is said: cyan, orange, violet and yellow are far apart for eyes without red or
/// green cones too, and two of them together give a third that neither is.
pub const CHANNEL_COLORS: [[f64; 3]; 4] = [
    [0.0, 0.85, 1.0],
    [1.0, 0.4, 0.1],
    [0.5, 0.3, 1.0],
    [1.0, 1.0, 0.3],
];

/// Fraction of the window, share of the colour, opacity per 1/512 of the diagonal.
const STOPS: [(f64, f64, f64); 4] = [
    (0.0, 0.3, 0.0),
    (0.3, 0.6, 0.004),
    (0.7, 1.0, 0.03),
    (1.0, 1.0, 0.1),
];

/// The function of one channel: from nothing at the low end of the window to the colour at its high end. Without a
/// window, one that fits the signal of the values.
pub fn of_channel(
    summary: &ValueSummary,
    srgb: [f64; 3],
    classified: Classified,
    window: Option<Window>,
) -> TransferFunction {
    let window = window.unwrap_or_else(|| window_of_channel(summary));
    if classified == Classified::Projection {
        let mut function = window.grey(classified);
        function.color[1].srgb = srgb;
        return function;
    }
    TransferFunction {
        color: STOPS
            .map(|(t, share, _)| ColorPoint {
                value: window.at(t),
                srgb: srgb.map(|c| share * c),
            })
            .into(),
        opacity: STOPS
            .map(|(t, _, opacity)| OpacityPoint {
                value: window.at(t),
                opacity,
            })
            .into(),
        reference_length: reference_length(summary),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// The window of a channel that neither a person nor its file gives one: its signal without the background.
pub(crate) fn window_of_channel(summary: &ValueSummary) -> Window {
    signal(summary, 0.6)
}

/// The opacity of a volume of colours, over luma or alpha from 0 to 1. Its own colours are not used.
pub fn of_colors(diagonal: f64, by_alpha: bool, window: Option<Window>) -> TransferFunction {
    // Alpha says what is opaque; a table's cell at its very zero is not opaque either. Luma does not: black is nothing,
    // and light matter is hardly more than dark.
    let stops: &[(f64, f64)] = if by_alpha {
        &[(0.002, 0.0), (1.0, 0.5)]
    } else {
        &[(0.04, 0.0), (0.2, 0.06), (1.0, 0.2)]
    };
    let length = diagonal / 512.0;
    let opacity = stops
        .iter()
        .map(|&(value, opacity)| OpacityPoint { value, opacity });
    let function = TransferFunction {
        color: Vec::new(),
        opacity: opacity.collect(),
        reference_length: (length > 0.0 && length.is_finite()).then_some(length),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    match window {
        Some(window) => function.spread_over(window),
        None => function,
    }
}

//! The transfer function of a volume of which its file says something: the kind by what values are, before what they
//! look like.

use super::automatic::{Kind, categorical, offset_ct, signed};
use super::meaning::{Meaning, Scale};
use super::preset::{reference_length, sparse, tissue, uptake};
use super::{
    Classified, ColorPoint, Colormap, Interpolation, OpacityPoint, TransferFunction, ValueSummary,
    Window, automatic,
};

/// What a file says of its values, beside the values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Context {
    /// The unit, as the file words it.
    pub unit: Option<String>,
    /// The CF standard name.
    pub standard_name: Option<String>,
    /// How the picture was taken, by the codes of DICOM PS3.3 C.7.3.1.1.1: `CT`, `MR`, `PT`, `GM` (microscopy).
    pub modality: Option<String>,
    /// The axes are those of a patient.
    pub is_patient: bool,
    /// Stored numbers are whole.
    pub is_integer: bool,
    /// Water and ice of clouds, in a picture of light that scatters: white, whatever the unit says.
    pub is_cloud: bool,
}

/// What a context and values together are taken for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The kind of values.
    pub kind: Kind,
    /// What is added to Hounsfield units in the values.
    pub offset: f64,
    /// The colours, where they are not those of the kind.
    pub colormap: Option<Colormap>,
}

/// Hounsfield units plus this are never negative, and in wide use.
const CT_OFFSET: f64 = 1024.0;
/// Levels of a field that are drawn as sheets.
const SHEETS: usize = 8;
/// Half the width of a sheet, as a part of the window.
const SHEET: f64 = 0.015;
/// The optical depth of all sheets along half of the diagonal, in the mean.
const FIELD_DEPTH: f64 = 4.0;
/// The most that a sheet hides of what lies 1/512 of the diagonal behind it.
const MOST_OPACITY: f64 = 0.6;
/// Opacities of matter of no known kind at the stops of tissue: its dark hull is transparent enough to show bright parts
/// inside.
const MATTER: [f64; 6] = [0.0, 0.01, 0.03, 0.1, 0.3, 0.6];
/// Opacity of a label per 1/512 of the diagonal, where light shows its surface: a label close behind it is seen faintly.
pub const LIT_LABEL_OPACITY: f64 = 0.15;
/// Share of the voxels of a signed field that are transparent at most.
const QUIET: f64 = 0.8;
/// Where a signed field begins to be opaque at the least, as a share of its reach.
const LEAST_QUIET: f64 = 0.02;
/// Kelvins that nothing in the air or the sea is colder than.
const COLDEST: f64 = 100.0;
/// The optical depth of the densest cloud along the diagonal.
const CLOUD_DEPTH: f64 = 800.0;
const CLOUD_POINTS: usize = 8;
/// Less than this part of the densest is clear air.
const CLEAR: f64 = 0.01;
/// Control points of a field's colours.
const FIELD_POINTS: usize = 64;

impl Context {
    /// What values like these are taken for.
    pub fn choice(&self, summary: &ValueSummary) -> Choice {
        let of = |kind| Choice {
            kind,
            offset: 0.0,
            colormap: None,
        };
        let by_values = Kind::of(summary);
        if matches!(by_values, Kind::Labels | Kind::Uptake) {
            return of(by_values);
        }
        let modality = self.modality.as_deref();
        // Hounsfield units have air at -1000; the same numbers without negative ones are stored with an offset.
        let is_ct = modality == Some("CT");
        if (is_ct || self.is_integer) && has_ct_offset(summary, is_ct) {
            return Choice {
                offset: CT_OFFSET,
                ..of(Kind::Ct)
            };
        }
        if by_values == Kind::Ct || modality == Some("CT") && summary.range[0] < -500.0 {
            return of(Kind::Ct);
        }
        if modality == Some("GM") {
            return of(Kind::Sparse);
        }
        let meaning = Meaning::of(self.standard_name.as_deref(), self.unit.as_deref());
        // Numbers in kelvins that are near 0 are differences, such as WRF's T, and no temperatures.
        let is_difference = |word: &str| word == "K" && summary.range[0] < COLDEST;
        if let Some(meaning) = meaning.filter(|meaning| !is_difference(meaning.word)) {
            let both_sides = summary.range[0] < 0.0 && summary.range[1] > 0.0;
            return match meaning.scale {
                Scale::AboutZero if both_sides => of(Kind::Signed),
                _ => Choice {
                    colormap: Some(meaning.colormap()),
                    ..of(Kind::Field)
                },
            };
        }
        let is_tissue = match modality {
            Some("MR") => true,
            None => self.is_patient && self.is_integer,
            Some(_) => false,
        };
        let colormap = match by_values {
            Kind::Field => Some("viridis"),
            Kind::Tissue if !is_tissue => Some("cividis"),
            _ => None,
        };
        Choice {
            colormap: colormap.and_then(Colormap::from_name),
            ..of(by_values)
        }
    }
}

/// [`automatic`] for values of which `context` says something: fields as sheets of equal value, matter that is
/// nobody's tissue in colours of no meaning.
pub fn automatic_in(
    context: &Context,
    summary: &ValueSummary,
    classified: Classified,
    window: Option<Window>,
) -> TransferFunction {
    if classified == Classified::Projection {
        return automatic(summary, classified, window);
    }
    let choice = context.choice(summary);
    if context.is_cloud {
        let function = cloud(summary);
        return match window {
            Some(window) => function.spread_over(window),
            None => function,
        };
    }
    let function = match choice.kind {
        Kind::Labels => labels(summary),
        Kind::Ct => offset_ct(summary, choice.offset),
        Kind::Tissue if choice.colormap.is_some() => matter(summary),
        Kind::Tissue => tissue(summary),
        Kind::Sparse => sparse(summary),
        Kind::Uptake => uptake(summary),
        Kind::Signed => departures(summary),
        Kind::Field => field(summary),
    };
    let function = match choice.colormap {
        Some(map) => function.with_colormap(map, None),
        None => function,
    };
    match window {
        Some(window) => function.spread_over(window),
        None => function,
    }
}

/// Air at 0 and tissue at 1000 to 1100, as Hounsfield units plus 1024 have them. Where the file says that it is CT, no
/// negative value is enough.
fn has_ct_offset(summary: &ValueSummary, is_ct: bool) -> bool {
    let [low, high] = summary.range;
    if !summary.integers || low < -100.0 || !(1500.0..=4096.0).contains(&high) {
        return false;
    }
    let share = |from: f64, to: f64| summary.share_below(to) - summary.share_below(from);
    let (air, gap, tissue) = (
        share(-100.0, 200.0),
        share(450.0, 750.0),
        share(920.0, 1180.0),
    );
    // Each of the peaks is twice what lies between them, and together they are most of the volume.
    is_ct || air > 0.05 && tissue > 0.05 && air.min(tissue) > 2.0 * gap && air + tissue > 0.5
}

/// What [`categorical`] is, with the opacity [`LIT_LABEL_OPACITY`].
fn labels(summary: &ValueSummary) -> TransferFunction {
    let mut function = categorical(summary);
    for point in &mut function.opacity {
        if point.opacity > 0.0 {
            point.opacity = LIT_LABEL_OPACITY;
        }
    }
    function
}

/// What tissue is, with the opacities of [`MATTER`].
fn matter(summary: &ValueSummary) -> TransferFunction {
    let mut function = tissue(summary);
    for (point, opacity) in function.opacity.iter_mut().zip(MATTER) {
        point.opacity = opacity;
    }
    function
}

/// What [`signed`] is, but opaque from the magnitude on that a share [`QUIET`] of the voxels lies below, where that is
/// less: a few strong values leave weak ones visible.
fn departures(summary: &ValueSummary) -> TransferFunction {
    let mut function = signed(summary);
    let reach = function.opacity.last().map_or(0.0, |point| point.value);
    let quiet = magnitude_quantile(summary, QUIET).max(LEAST_QUIET * reach);
    let nearer = |value: &mut f64| {
        if value.abs() < 0.5 * reach {
            *value = value.clamp(-quiet, quiet);
        }
    };
    function.color.iter_mut().for_each(|p| nearer(&mut p.value));
    function
        .opacity
        .iter_mut()
        .for_each(|p| nearer(&mut p.value));
    function
}

/// The magnitude that a share `q` of the voxels lies below.
fn magnitude_quantile(summary: &ValueSummary, q: f64) -> f64 {
    let [low, high] = summary.range;
    let (mut under, mut over) = (0.0, low.abs().max(high.abs()));
    // Each step halves the interval: 64 are more than a double has bits.
    for _ in 0..64 {
        let middle = 0.5 * (under + over);
        let share = summary.share_below(middle) - summary.share_below(-middle);
        if share < q {
            under = middle;
        } else {
            over = middle;
        }
    }
    over
}

/// Thin sheets of eight values, so that neither the faces of the box nor what most of it is made of hide the inside. Each
/// sheet has the same share of the mean optical depth [`FIELD_DEPTH`]: values that are rare are the more opaque, up to
/// [`MOST_OPACITY`].
fn field(summary: &ValueSummary) -> TransferFunction {
    let window = Window::new(summary.quantile(0.005), summary.quantile(0.995))
        .unwrap_or(Window::of_range(summary.range));
    let half_width = SHEET * (window.high() - window.low());
    let sheet = |k: usize| {
        let value = window.at((k as f64 + 0.5) / SHEETS as f64);
        let mean = mean_of_tent(summary, value, half_width);
        // Opacities are for 1/512 of the diagonal; half of it is 256 such lengths.
        let depth = FIELD_DEPTH / SHEETS as f64 / 256.0 / mean.max(f64::MIN_POSITIVE);
        let opacity = (1.0 - (-depth).exp()).min(MOST_OPACITY);
        [
            (value - half_width, 0.0),
            (value, opacity),
            (value + half_width, 0.0),
        ]
    };
    let points = (0..FIELD_POINTS).map(|i| window.at(i as f64 / (FIELD_POINTS - 1) as f64));
    TransferFunction {
        color: points
            .map(|value| ColorPoint {
                value,
                srgb: [0.0; 3],
            })
            .collect(),
        opacity: (0..SHEETS)
            .flat_map(sheet)
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .collect(),
        reference_length: reference_length(summary),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// White matter whose extinction grows in proportion to the value, as that of droplets of one size does; none where there is next to
/// none of it, so that haze, and the first entry of a table, are clear air.
fn cloud(summary: &ValueSummary) -> TransferFunction {
    let most = summary.range[1].max(f64::MIN_POSITIVE);
    // Opacities between points are less than those of the proportion by 1 % of it at most.
    let opacity = (0..=CLOUD_POINTS).map(|i| {
        let part = (i as f64 / CLOUD_POINTS as f64).max(CLEAR);
        let depth = CLOUD_DEPTH / 512.0 * if i == 0 { 0.0 } else { part };
        OpacityPoint {
            value: part * most,
            opacity: -(-depth).exp_m1(),
        }
    });
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: opacity.collect(),
        reference_length: reference_length(summary),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// The mean over all voxels of a tent of height 1, where the values of a bin are spread evenly over it.
fn mean_of_tent(summary: &ValueSummary, center: f64, half_width: f64) -> f64 {
    // The integral of the tent up to `value`, in half widths.
    let integral = |value: f64| match ((value - center) / half_width).clamp(-1.0, 1.0) {
        u if u < 0.0 => 0.5 * (1.0 + u).powi(2),
        u => 1.0 - 0.5 * (1.0 - u).powi(2),
    };
    let [first, end] = summary.edges;
    let bin_width = (end - first) / summary.histogram.len() as f64;
    let (mut total, mut count) = (0.0, 0.0);
    for (bin, &voxels) in summary.histogram.iter().enumerate() {
        let low = first + bin as f64 * bin_width;
        let inside = integral(low + bin_width) - integral(low);
        total += voxels as f64 * inside * half_width / bin_width;
        count += voxels as f64;
    }
    total / f64::max(count, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(values: &[f64]) -> ValueSummary {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        ValueSummary::of(values.len(), [low, high], 1.0, false, |i| Some(values[i]))
    }

    /// Air, tissue and bone in Hounsfield units plus `offset`, every value another one.
    fn ct(offset: f64) -> ValueSummary {
        let near = |center: f64, i: usize| center + offset + (i % 41) as f64 - 20.0;
        let values: Vec<_> = (0..2000)
            .map(|i| match i % 20 {
                0..10 => near(-1000.0, 7 * i),
                10..19 => near(40.0, 7 * i),
                _ => near(900.0, 7 * i),
            })
            .collect();
        summary(&values)
    }

    #[test]
    fn hounsfield_units_are_known_with_and_without_an_offset() {
        let context = Context {
            is_integer: true,
            ..Context::default()
        };
        for offset in [0.0, 1024.0] {
            let choice = context.choice(&ct(offset));
            assert_eq!((choice.kind, choice.offset), (Kind::Ct, offset));
        }
        let function = |offset| {
            let summary = ct(offset);
            automatic_in(&context, &summary, Classified::Samples, None)
        };
        let [plain, moved] = [0.0, 1024.0].map(function);
        for (a, b) in plain.opacity.iter().zip(&moved.opacity) {
            assert_eq!((a.value + 1024.0, a.opacity), (b.value, b.opacity));
        }
    }

    #[test]
    fn what_the_file_says_wins_over_what_values_look_like() {
        // Three parts dark, one part bright: an object before a background.
        let values: Vec<_> = (0..4000)
            .map(|i| f64::from(i % 4 / 3 * (100 + i / 4 % 97)))
            .collect();
        let object = summary(&values);
        let of = |context: Context| {
            let choice = context.choice(&object);
            (choice.kind, choice.colormap.map(Colormap::name))
        };
        let patient = Context {
            is_patient: true,
            is_integer: true,
            ..Context::default()
        };
        assert_eq!(of(patient.clone()), (Kind::Tissue, None));
        assert_eq!(
            of(Context {
                is_integer: false,
                ..patient
            }),
            (Kind::Tissue, Some("cividis"))
        );
        let modality = |word: &str| Context {
            modality: Some(word.to_owned()),
            ..Context::default()
        };
        assert_eq!(of(modality("MR")), (Kind::Tissue, None));
        assert_eq!(of(modality("GM")), (Kind::Sparse, None));
        let unit = |word: &str| Context {
            unit: Some(word.to_owned()),
            ..Context::default()
        };
        assert_eq!(of(unit("kg kg-1")), (Kind::Field, Some("viridis")));
        assert_eq!(of(unit("m s-1")), (Kind::Field, Some("wind")));
        // No air is at 0 K.
        assert_eq!(of(unit("K")), (Kind::Tissue, Some("cividis")));
    }

    #[test]
    fn labels_that_are_lit_are_more_opaque_and_the_background_stays_transparent() {
        let values: Vec<_> = (0..4000).map(|i| f64::from(i / 1334)).collect();
        let summary = summary(&values);
        let context = Context::default();
        assert_eq!(context.choice(&summary).kind, Kind::Labels);
        let function = automatic_in(&context, &summary, Classified::Samples, None);
        assert_eq!(function.opacity(0.0), 0.0);
        for label in [1.0, 2.0] {
            assert_eq!(function.opacity(label), LIT_LABEL_OPACITY);
            assert!(categorical(&summary).opacity(label) < LIT_LABEL_OPACITY);
        }
    }

    #[test]
    fn matter_of_no_known_kind_shows_what_is_inside() {
        // A dark background, a hull of 110 and a core of 200.
        let values: Vec<_> = (0..4000)
            .map(|i| match i % 20 {
                0..12 => f64::from(i % 7),
                12..18 => 99.0 + f64::from(i % 23),
                _ => 190.0 + f64::from(i % 21),
            })
            .collect();
        let summary = summary(&values);
        let function = |is_patient| {
            let context = Context {
                is_patient,
                is_integer: true,
                ..Context::default()
            };
            assert_eq!(context.choice(&summary).kind, Kind::Tissue);
            automatic_in(&context, &summary, Classified::Samples, None)
        };
        let [tissue, matter] = [true, false].map(function);
        let at = |value: f64| [&tissue, &matter].map(|function| function.opacity(value));
        let ([hull_of_tissue, hull], [core_of_tissue, core]) = (at(110.0), at(200.0));
        assert!(
            0.0 < hull && hull < 0.5 * hull_of_tissue,
            "{hull} {hull_of_tissue}"
        );
        assert!(core > 0.7 * core_of_tissue, "{core} {core_of_tissue}");
    }

    #[test]
    fn a_few_strong_values_of_a_signed_field_leave_weak_ones_visible() {
        // Nineteen voxels in twenty have up to a tenth of the magnitude of the twentieth.
        let values: Vec<_> = (0..4000)
            .map(|i: i32| {
                let weak = f64::from(i % 201 - 100) / 100.0;
                if i % 20 == 0 { 10.0 * weak } else { weak }
            })
            .collect();
        let summary = summary(&values);
        let function = departures(&summary);
        let quiet = magnitude_quantile(&summary, QUIET);
        let below = values.iter().filter(|value| value.abs() < quiet).count();
        assert!((below as f64 / 4000.0 - QUIET).abs() < 0.01);
        assert_eq!(signed(&summary).opacity(1.2 * quiet), 0.0);
        for sign in [-1.0, 1.0] {
            assert_eq!(function.opacity(sign * 0.9 * quiet), 0.0);
            assert!(function.opacity(sign * 1.2 * quiet) > 0.0);
            assert_eq!(
                function.opacity(sign * 9.0),
                signed(&summary).opacity(sign * 9.0)
            );
        }
        // Values that are spread evenly keep their quiet part.
        let even: Vec<_> = (-1000..=1000).map(f64::from).collect();
        let even = super::tests::summary(&even);
        assert_eq!(departures(&even), signed(&even));
    }

    #[test]
    fn a_field_is_sheets_that_together_are_as_deep_as_it_says() {
        let values: Vec<_> = (0..1 << 16).map(|i| f64::from(i).sqrt()).collect();
        let summary = summary(&values);
        let function = field(&summary);
        let [low, high] = [0.005, 0.995].map(|share| summary.quantile(share));
        let at = |t: f64| function.opacity(low + t * (high - low));
        // The lower of two values is the rarer one.
        for k in 0..SHEETS {
            let middle = (k as f64 + 0.5) / SHEETS as f64;
            assert!(at(middle) > 0.0);
            assert!(at(middle + 0.5 / SHEETS as f64) == 0.0);
            assert!(k == 0 || at(middle) < at(middle - 1.0 / SHEETS as f64));
        }
        // Opacity is linear between points, and so is depth nearly where it is small.
        let depth = |&value: &f64| -256.0 * (1.0 - function.opacity(value)).ln();
        let mean = values.iter().map(depth).sum::<f64>() / values.len() as f64;
        assert!((mean - FIELD_DEPTH).abs() < 0.05 * FIELD_DEPTH, "{mean}");
    }
}

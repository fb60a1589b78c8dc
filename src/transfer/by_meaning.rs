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
/// The optical depth of a field along half of the diagonal, in the mean.
const FIELD_DEPTH: f64 = 1.5;
/// How steeply opacity grows with the distance to the median.
const FIELD_POWER: f64 = 3.0;
/// Kelvins that nothing in the air or the sea is colder than.
const COLDEST: f64 = 100.0;
/// Control points of a field's opacity.
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

/// [`automatic`] for values of which `context` says something: fields by the distance to the median, matter that is
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
    let function = match choice.kind {
        Kind::Labels => categorical(summary),
        Kind::Ct => offset_ct(summary, choice.offset),
        Kind::Tissue => tissue(summary),
        Kind::Sparse => sparse(summary),
        Kind::Uptake => uptake(summary),
        Kind::Signed => signed(summary),
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

/// Opacity grows with the distance to the median, the third power of it, so that what most of the box is made of does
/// not hide what is rare; the mean optical depth over half the diagonal is [`FIELD_DEPTH`].
fn field(summary: &ValueSummary) -> TransferFunction {
    let window = Window::new(summary.quantile(0.01), summary.quantile(0.99))
        .unwrap_or(Window::of_range(summary.range));
    let middle = summary.quantile(0.5).clamp(window.low(), window.high());
    let reach = (window.high() - middle).max(middle - window.low());
    let weight = |value: f64| ((value - middle).abs() / reach).min(1.0).powf(FIELD_POWER);
    let bins = summary.histogram.len() as f64;
    let [first, end] = summary.edges;
    let (total, count) =
        summary
            .histogram
            .iter()
            .enumerate()
            .fold((0.0, 0.0), |(total, count), (bin, &voxels)| {
                let value = first + (bin as f64 + 0.5) / bins * (end - first);
                let voxels = voxels as f64;
                (total + voxels * weight(value), count + voxels)
            });
    // Opacities are for 1/512 of the diagonal; half of it is 256 such lengths.
    let depth = if total > 0.0 {
        FIELD_DEPTH / 256.0 * count / total
    } else {
        0.0
    };
    let points = || (0..FIELD_POINTS).map(|i| window.at(i as f64 / (FIELD_POINTS - 1) as f64));
    TransferFunction {
        color: points()
            .map(|value| ColorPoint {
                value,
                srgb: [0.0; 3],
            })
            .collect(),
        opacity: points()
            .map(|value| OpacityPoint {
                value,
                opacity: 1.0 - (-depth * weight(value)).exp(),
            })
            .collect(),
        reference_length: reference_length(summary),
        interpolation: Interpolation::Linear,
        graded: None,
    }
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
    fn a_field_is_transparent_at_its_median_and_as_deep_as_it_says() {
        let values: Vec<_> = (0..4096).map(|i| f64::from(i).sqrt()).collect();
        let summary = summary(&values);
        let function = field(&summary);
        let middle = summary.quantile(0.5);
        assert!(
            function.opacity(middle) < 1e-6,
            "{}",
            function.opacity(middle)
        );
        // The mean over the voxels of the depth of 256 lengths.
        let depth = |&value: &f64| -256.0 * (1.0 - function.opacity(value)).ln();
        let mean = values.iter().map(depth).sum::<f64>() / values.len() as f64;
        assert!((mean - FIELD_DEPTH).abs() < 0.05 * FIELD_DEPTH, "{mean}");
    }
}

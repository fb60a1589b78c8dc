//! What the numbers of a picture measure, by DICOM PS3.3 sections C.11.1 (rescale), C.8.9.1 (PET) and C.8.8.3 (dose).

use super::DICOM;
use super::fields::DataSet;
use super::layout::{Color, Layout};
use super::tags::*;
use crate::format::problem::{escape, unsupported};
use crate::volume::{Problem, Rescale};

/// The same for all pictures of a series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Quantity {
    /// As the file words it: `HU`, `BQML`, `GY`.
    pub unit: Option<String>,
    pub hounsfield: bool,
    /// How the picture was taken: `CT`, `MR`, `PT`.
    pub modality: Option<String>,
    /// A segmentation: numbers are names.
    pub is_labels: bool,
}

impl Quantity {
    pub(super) fn of(set: &DataSet, layout: &Layout) -> Result<Self, Problem> {
        let class = set.text(SOP_CLASS_UID).unwrap_or_default();
        let is_labels = class == "1.2.840.10008.5.1.4.1.1.66.4";
        if is_labels && set.text(SEGMENTATION_TYPE).as_deref() == Some("FRACTIONAL") {
            return Err(unsupported(DICOM, "a fractional segmentation"));
        }
        if !set.items(MODALITY_LUT).is_empty() {
            return Err(unsupported(
                DICOM,
                "a table from stored numbers to values (Modality LUT Sequence)",
            ));
        }
        let shared = set.item(SHARED_FUNCTIONAL_GROUPS);
        let own = set.item(PER_FRAME_FUNCTIONAL_GROUPS);
        let transformation = [own, shared]
            .into_iter()
            .flatten()
            .find_map(|groups| groups.item(PIXEL_VALUE_TRANSFORMATION));
        let place = transformation.unwrap_or(set);
        let kind = place.text(RESCALE_TYPE);
        let is_ct = set.text(MODALITY).as_deref() == Some("CT");
        let is_rescaled = place.has(RESCALE_INTERCEPT);
        // A CT without a word about it is in Hounsfield units; `US` says that the unit is not specified.
        let hounsfield = is_ct
            && layout.bits_allocated > 8
            && (kind.as_deref() == Some("HU") || kind.is_none() && is_rescaled);
        let unit = if hounsfield {
            Some("HU".to_owned())
        } else {
            let words = [set.text(UNITS), kind, set.text(DOSE_UNITS)];
            words
                .into_iter()
                .flatten()
                .find(|word| word != "US")
                .map(|word| escape(&word))
        };
        Ok(Self {
            unit,
            hounsfield,
            modality: set.text(MODALITY).map(|word| escape(&word)),
            is_labels,
        })
    }

    /// Turns a rescale round where the smallest number is the brightest. Values that measure something stay.
    pub(super) fn turned(&self, rescale: Rescale, layout: &Layout) -> Rescale {
        if !self.is_turned(layout) {
            return rescale;
        }
        let range = f64::from(layout.bits_stored).exp2();
        // The least and the largest stored number together.
        let sum = if layout.is_signed { -1.0 } else { range - 1.0 };
        Rescale {
            slope: -rescale.slope,
            intercept: rescale.slope.mul_add(sum, rescale.intercept),
        }
    }

    pub(super) fn is_turned(&self, layout: &Layout) -> bool {
        layout.color == Color::Inverted && self.unit.is_none()
    }
}

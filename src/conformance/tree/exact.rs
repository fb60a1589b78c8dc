//! Pictures of fields whose answer is known in closed form (A1, A2, A5 and their like): every placement, mode, filter,
//! type and projection.

use super::drawn::{DERIVATION_F16, WIDEST, errors};
use super::ground::{self, FILTERS, MODES, PLACEMENTS, PROJECTIONS, Placement, TYPES};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::{Answer, Classes, Kind, PictureCase, SamplerPrecision, answer};
use crate::conformance::test_bed::TestBed;
use crate::picture::{LayerKind, Picture};
use crate::technique::{Filter, Mode};
use crate::volume::VoxelType;

/// The product.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for placement in PLACEMENTS {
        for mode in MODES {
            let mode_word = ground::word_of(mode);
            let Some(word) = placement.word_in(mode) else {
                continue;
            };
            for kind in [Kind::Homogeneous, Kind::Ramp] {
                for filter in FILTERS {
                    for stored in TYPES {
                        for projection in PROJECTIONS {
                            let name = format!(
                                "{word}.{mode_word}.{}.{}.{}.{}",
                                kind.word(),
                                filter.0,
                                stored.0,
                                projection.0
                            );
                            let of = Of {
                                placement,
                                mode,
                                kind,
                                filter: (filter.1, filter.2),
                                stored: stored.1,
                                is_perspective: projection.1,
                            };
                            if let Some(profile) = of.profile() {
                                cases.push(of.case(name).of(profile));
                            }
                        }
                    }
                }
            }
        }
    }
    cases
}

#[derive(Clone, Copy)]
struct Of {
    placement: Placement,
    mode: Mode,
    kind: Kind,
    filter: (Filter, bool),
    stored: VoxelType,
    is_perspective: bool,
}

impl Of {
    /// The baseline has each pair of words somewhere, not each combination of all.
    fn profile(&self) -> Option<Profile> {
        let is_wide = self.filter.0.kernel().is_some();
        let is_common = matches!(self.stored, VoxelType::U8 | VoxelType::U16 | VoxelType::F32);
        match self.kind {
            // Of one value filters and types say little.
            Kind::Homogeneous if is_wide || self.filter.0 == Filter::Nearest => None,
            Kind::Homogeneous if !is_common => Some(Profile::Full),
            Kind::Homogeneous => Some(Profile::Baseline),
            Kind::Ramp if is_wide && self.stored != VoxelType::I16 => Some(Profile::Full),
            // The eye of one projection knows what a type is.
            Kind::Ramp if !is_common && self.is_perspective => Some(Profile::Full),
            Kind::Ramp => Some(Profile::Baseline),
        }
    }

    fn case(self, name: String) -> Case {
        let mut case = Case::new(name, move |bed| self.measure(bed));
        case.needs = ground::needs(self.placement, self.mode, self.stored, self.filter.1);
        case
    }

    fn measure(self, bed: &mut TestBed) -> Result<Measurement, Stop> {
        let mut shot = ground::shot(self.placement, self.mode, self.filter, self.is_perspective);
        let is_merged = bed.is_merged(&shot.settings)?;
        if is_merged && self.kind == Kind::Homogeneous && !shot.settings.technique.draws_stacks() {
            // More slices than a batch has.
            shot.settings.samples_per_voxel = 3.0;
        }
        let field = self.kind.field();
        let volume = field.volume(&shot, self.stored);
        let classes = Classes::RAMP;
        let function = classes.function();
        let scene = shot.scene(&volume, Some(&function));
        let layers: &[LayerKind] = match self.mode.is_projection() {
            true => &[LayerKind::Value],
            false => &[],
        };
        let bits = bed.subtexel_bits()?;
        let sampler = SamplerPrecision {
            bits,
            keeps_halves: self.stored == VoxelType::F16,
        };
        let found = bed.render(&scene, layers)?;
        // By points and fetches: the answer is allowed what a table and a sampler may be off by.
        let exact = shot.with(|settings| settings.conformance = true);
        let of_blending = match is_merged {
            true => Some(errors::<true>(bed, &exact.scene(&volume, Some(&function)))?),
            false => None,
        };
        Ok(compare(&shot, &found, of_blending, bits, |chord| {
            answer(&shot, chord, &field, &classes, sampler)
        }))
    }
}

/// What 16-bit floats add to the bounds.
const BLENDED: &str = "The running error of the picture is added: each operation of the shaders as Vulkan's precision rules let it be, \
and the blends. To its parts in 16-bit floats belong numbers that are off by the bound below; what that changes in up to 256 blends \
of four roundings of 2^-10 each is no more than the bound itself, which therefore counts twice. ";

fn compare(
    shot: &PictureCase,
    found: &Picture,
    of_blending: Option<Picture>,
    bits: u32,
    of: impl Fn(&crate::conformance::oracle::Chord) -> Option<Answer>,
) -> Measurement {
    let values = found.layers.first().map(|layer| layer.values.as_slice());
    let pixels = &found.pixels;
    let derivation = crate::conformance::oracle::DERIVATION;
    let bound = match &of_blending {
        Some(_) => Bound::new(
            "f16-slices",
            format!("{DERIVATION_F16}{BLENDED}{derivation}"),
        ),
        None => Bound::new("f32-ray", derivation),
    };
    let bound = bound.with("subTexelPrecisionBits", bits.into());
    let mut measurement = Measurement::new(bound, 1000);
    let mut expected = Vec::new();
    let mut widest = 0.0f64;
    for (i, pixel) in shot.pixels().enumerate() {
        let at = |what: &str| format!("{what} of pixel {pixel:?}");
        let wanted = match shot.chord(pixel) {
            Some(chord) => of(&chord),
            None => Some(Answer::NOTHING),
        };
        let allowed = |wanted: &Answer| match &of_blending {
            Some(errors) => {
                errors.pixels[i].map(|error| f64::from(error) + 2.0 * wanted.pixel_allowed)
            }
            None => [wanted.pixel_allowed; 4],
        };
        let says_something = |wanted: &Answer| {
            of_blending.is_none() || allowed(wanted).iter().all(|&error| error < WIDEST.into())
        };
        let Some(wanted) = wanted.filter(says_something) else {
            measurement.leave_out(4 + usize::from(values.is_some()));
            expected.push(pixels[i]);
            continue;
        };
        expected.push(wanted.pixel.map(|n| n as f32));
        if let Some(values) = values {
            let found = values[i].into();
            measurement.take(|| at("value"), wanted.value, found, wanted.value_allowed);
        }
        for c in 0..4 {
            let found = pixels[i][c].into();
            let channel = ["red", "green", "blue", "alpha"][c];
            let allowed = allowed(&wanted)[c];
            widest = widest.max(allowed);
            measurement.take(|| at(channel), wanted.pixel[c], found, allowed);
        }
    }
    if of_blending.is_some() {
        measurement.bound.inputs.insert("widest".into(), widest);
    }
    measurement.pictures = Some(Pictures {
        width: shot.extent[0],
        expected,
        found: pixels.clone(),
    });
    measurement
}

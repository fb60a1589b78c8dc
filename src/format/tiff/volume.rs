//! Pages to a volume: all have to look alike, and their look says what a voxel holds.

use super::TIFF;
use super::ifd::Reader;
use super::length::Spacing;
use super::page::{Color, Extra, Look, Page};
use super::palette::Palette;
use super::source::{PageAt, PageSource};
use super::{clean, is_indexed};
use crate::format::geometry::world_from_voxel;
use crate::format::problem::{at, invalid, unsupported};
use crate::volume::{
    Channel, ComponentKind, Format, Header, Limits, Problem, ReadError, Rescale, VoxelType,
};
use glam::{DAffine3, DVec3};
use std::path::{Path, PathBuf};

/// What a file, or a folder, says about its pages.
#[derive(Debug)]
pub(super) struct Parts {
    pub files: Vec<PathBuf>,
    /// z fastest, then channels, then times.
    pub pages: Vec<PageAt>,
    /// Channels that are pages of their own.
    pub channels: u32,
    pub depth: u32,
    pub times: u32,
    pub spacing: Spacing,
    /// Overrules what the pages' look says.
    pub meaning: Option<ComponentKind>,
    pub time_names: Vec<String>,
    pub variables: Vec<String>,
    pub notes: Vec<String>,
    /// True where numbers stay what they are, whatever colors or inversion the page asks for.
    pub keeps_numbers: bool,
}

impl Parts {
    /// One layer, one channel, one time.
    pub(super) fn new(files: Vec<PathBuf>, pages: Vec<PageAt>) -> Self {
        Self {
            files,
            pages,
            channels: 1,
            depth: 1,
            times: 1,
            spacing: Spacing::default(),
            meaning: None,
            time_names: Vec::new(),
            variables: Vec::new(),
            notes: Vec::new(),
            keeps_numbers: false,
        }
    }

    /// Looks at every page and makes a source of them.
    pub(super) fn source(self, path: &Path, limits: &Limits) -> Result<PageSource, ReadError> {
        let (look, color_map) = self.common_look(path, limits)?;
        let header = self.header(look, color_map).map_err(at(path))?;
        Ok(PageSource {
            path: path.to_owned(),
            header,
            files: self.files,
            pages: self.pages,
            channels: self.channels,
            look,
            keeps_numbers: self.keeps_numbers,
            limits: *limits,
        })
    }

    /// The look of the first page, if all others share it; and the type of its color map's numbers.
    fn common_look(&self, path: &Path, limits: &Limits) -> Result<(Look, VoxelType), ReadError> {
        let mut common: Option<(Look, VoxelType)> = None;
        let mut open: Option<(usize, Reader)> = None;
        for place in &self.pages {
            let file = self.files.get(place.file).map_or(path, PathBuf::as_path);
            let mut reader = match open.take() {
                Some((index, reader)) if index == place.file => reader,
                _ => Reader::open(file).map_err(at(file))?,
            };
            let look = self
                .look_at(&mut reader, *place, limits)
                .map_err(at(file))?;
            match &common {
                None => common = Some(look),
                Some((first, _)) if *first == look.0 => {}
                Some((first, _)) => {
                    let field = match self.files.len() {
                        1 => format!("page {}", place.number),
                        _ => "page".to_owned(),
                    };
                    let wanted = format!("{}, as the first page has", in_words(*first));
                    let found = in_words(look.0);
                    return Err(at(file)(invalid(TIFF, &field, wanted, &found)));
                }
            }
            open = Some((place.file, reader));
        }
        common.ok_or_else(|| at(path)(invalid(TIFF, "pages", "a page", "none")))
    }

    fn look_at(
        &self,
        reader: &mut Reader,
        place: PageAt,
        limits: &Limits,
    ) -> Result<(Look, VoxelType), Problem> {
        let directory = reader.directory(place.ifd)?;
        let look = Page::read(reader, &directory, limits)?.look;
        let stored = if is_indexed(look) && !self.keeps_numbers {
            Palette::read(reader, &directory, look.bits)?.stored()
        } else {
            look.stored
        };
        Ok((look, stored))
    }

    /// What such pages make. `stored` is the type of the numbers that come out of a color map, if there is one.
    pub(super) fn header(&self, look: Look, stored: VoxelType) -> Result<Header, Problem> {
        let mut notes: Vec<String> = self.notes.iter().map(|note| clean(note)).collect();
        let samples = match (self.keeps_numbers, look.color) {
            (true, Color::Palette) => 1,
            _ => components(look),
        };
        if samples > 1 && self.channels > 1 {
            let what = format!("{} channels of {samples} samples each", self.channels);
            return Err(unsupported(TIFF, what));
        }
        let meaning = match (look.color, samples) {
            (Color::Rgb | Color::YCbCr | Color::Palette, 3) => ComponentKind::Rgb,
            (Color::Rgb, 4) => ComponentKind::Rgba,
            _ if self.channels > 1 => {
                let unnamed = vec![Channel::default(); super::to_usize(self.channels)];
                ComponentKind::Channels(unnamed)
            }
            _ => ComponentKind::Numbers,
        };
        self.say(look, samples, &mut notes);
        let world_from_voxel = self.affine(&mut notes)?;
        if !stored.is_kept_exactly() {
            let name = stored.name();
            notes.push(format!("voxels are stored as {name} and kept as f32"));
        }
        let mut meaning = self.meaning.clone().unwrap_or(meaning);
        if let ComponentKind::Channels(channels) = &mut meaning {
            for channel in channels {
                channel.name = clean(&channel.name);
            }
        }
        Ok(Header {
            components: samples.saturating_mul(self.channels),
            times: self.times,
            rescale: self.rescale(look),
            meaning,
            length_metres: self
                .spacing
                .unit
                .and_then(super::length::unit)
                .map(|(metres, _)| metres),
            time_names: self.time_names.clone(),
            variables: self.variables.iter().map(|name| clean(name)).collect(),
            notes,
            ..Header::new(
                Format::Tiff,
                [look.width, look.height, self.depth],
                stored,
                world_from_voxel,
            )
        })
    }

    /// Sentences about what the look of the pages became.
    fn say(&self, look: Look, samples: u32, notes: &mut Vec<String>) {
        let mut say = |sentence: &str| notes.push(sentence.to_owned());
        match look.color {
            Color::Palette if self.keeps_numbers => {
                say("the color map is left aside: the numbers count");
            }
            Color::Palette => {
                say("the numbers stand for the colors of a map, and are read as them")
            }
            Color::WhiteIsZero if self.keeps_numbers || !is_unsigned(look.stored) => {
                say("white is said to be 0: the numbers stay as they are");
            }
            Color::WhiteIsZero => say("white is 0 in the file: values are turned round"),
            _ => {}
        }
        if matches!(look.color, Color::Rgb | Color::YCbCr) && samples < look.samples {
            say(match look.extra {
                Some(Extra::Associated) => {
                    "colors are multiplied with an opacity, which is left out: they are seen as over black"
                }
                _ => "samples beyond red, green and blue are left out",
            });
        }
    }

    fn rescale(&self, look: Look) -> Rescale {
        if look.color != Color::WhiteIsZero || self.keeps_numbers || !is_unsigned(look.stored) {
            return Rescale::default();
        }
        let exponent = i32::try_from(look.bits).unwrap_or(0);
        #[allow(clippy::arithmetic_side_effects, reason = "floats")]
        let largest = 2_f64.powi(exponent) - 1.0;
        Rescale {
            slope: -1.0,
            intercept: largest,
        }
    }

    #[allow(clippy::arithmetic_side_effects, reason = "vectors of f64")]
    fn affine(&self, notes: &mut Vec<String>) -> Result<DAffine3, Problem> {
        let steps = DVec3::from_array(self.spacing.filled(self.depth, notes));
        let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * steps);
        world_from_voxel(columns, steps * 0.5).ok_or_else(|| {
            let wanted = "steps that span a volume";
            invalid(TIFF, "resolution", wanted, &steps.to_string())
        })
    }
}

fn is_unsigned(stored: VoxelType) -> bool {
    use VoxelType::{U8, U16, U32, U64};
    matches!(stored, U8 | U16 | U32 | U64)
}

/// Numbers that a pixel of such a page gives to a voxel.
pub(super) fn components(look: Look) -> u32 {
    match (look.color, look.extra) {
        (Color::Palette | Color::YCbCr, _) => 3,
        (Color::Rgb, Some(Extra::Opacity)) => 4,
        (Color::Rgb, _) => 3,
        (Color::Gray | Color::WhiteIsZero, _) => look.samples,
    }
}

fn in_words(look: Look) -> String {
    let color = match look.color {
        Color::Gray => "gray",
        Color::WhiteIsZero => "gray with white as 0",
        Color::Rgb => "RGB",
        Color::Palette => "a color map",
        Color::YCbCr => "YCbCr",
    };
    format!(
        "{} x {} pixels of {} x {} ({}, {color})",
        look.width,
        look.height,
        look.samples,
        look.stored.name(),
        look.bits
    )
}

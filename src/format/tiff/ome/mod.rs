//! OME-TIFF: XML in the first page's description that says which page is which Z, channel and time.
//!
//! docs.openmicroscopy.org/ome-model, "OME-TIFF specification": a `TiffData` without `IFD` begins at the first
//! page; without `PlaneCount` it means one page where it has an `IFD`, and all pages where it has none.

mod xml;

use super::TIFF;
use super::length::Spacing;
use crate::format::problem::{escape, invalid, unsupported};
use crate::volume::{Channel, Problem};
use xml::{Image, Ome, TiffData};

/// A page by its file and its number in there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PageName {
    /// `None` for the file with the XML.
    pub file: Option<String>,
    pub number: u64,
}

/// One image of the document, as a volume.
#[derive(Debug)]
pub(super) struct Volume {
    /// X and Y, to compare with the pages.
    pub page_size: [u32; 2],
    pub depth: u32,
    /// SizeC, and how many of them are pages of their own.
    pub channel_count: u32,
    pub times: u32,
    pub spacing: Spacing,
    pub channels: Vec<Channel>,
    pub time_names: Vec<String>,
    /// Names of all images, this one first.
    pub names: Vec<String>,
    pub notes: Vec<String>,
    order: String,
    blocks: Vec<TiffData>,
    uuid: String,
}

/// True for a description that is OME-XML.
pub(super) fn is_ome(description: &str) -> bool {
    let head = description.get(..4096).unwrap_or(description);
    head.trim_start().starts_with('<') && head.contains("<OME")
}

/// Takes one image, the first or the one that is named.
pub(super) fn read(text: &str, wanted: Option<&str>) -> Result<Volume, Problem> {
    let ome = xml::parse(text)?;
    if let Some(file) = &ome.metadata_file {
        let what = format!("OME-XML in another file (`{}`)", escape(file));
        return Err(unsupported(TIFF, what));
    }
    let images: Vec<&Image> = ome.images.iter().filter(|image| image.has_pixels).collect();
    let mut names = names(&images);
    let index = match wanted {
        None => 0,
        Some(name) => names
            .iter()
            .position(|other| other == name)
            .ok_or_else(|| {
                let wanted = format!("one of {}", escape(&names.join(", ")));
                invalid(TIFF, "image", wanted, name)
            })?,
    };
    let Some(image) = images.get(index) else {
        return Err(invalid(TIFF, "OME-XML", "an Image with Pixels", "none"));
    };
    names.get_mut(..=index).unwrap_or_default().rotate_right(1);
    volume(image, names, &ome)
}

/// A name for each image, no two alike.
fn names(images: &[&Image]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (index, image) in images.iter().enumerate() {
        let candidates = [
            image.name.clone(),
            image.id.clone(),
            format!("Image:{index}"),
        ];
        let name = candidates
            .into_iter()
            .find(|name| !name.is_empty() && !names.contains(name));
        names.push(name.unwrap_or_else(|| format!("{}#{index}", image.name)));
    }
    names
}

fn volume(image: &Image, names: Vec<String>, ome: &Ome) -> Result<Volume, Problem> {
    if image.has_bin_data {
        return Err(unsupported(TIFF, "OME pixels inside the XML (BinData)"));
    }
    let order = image.order.strip_prefix("XY").unwrap_or("");
    if !matches!(order, "ZCT" | "ZTC" | "CZT" | "CTZ" | "TCZ" | "TZC") {
        let wanted = "X, Y and then Z, C and T in some order";
        return Err(invalid(TIFF, "DimensionOrder", wanted, &image.order));
    }
    let [x, y, depth, channel_count, times] = image.sizes;
    let (metres, unit) = image.unit.unzip();
    let spacing = Spacing {
        steps: image.physical.map(|size| Some(in_units(size?, metres?))),
        unit,
    };
    let channel = |channel: &xml::OmeChannel| Channel {
        name: channel.name.clone(),
        srgb: channel.srgb,
        window: None,
    };
    let mut channels: Vec<Channel> = image.channels.iter().map(channel).collect();
    if channel_count <= MOST_CHANNELS {
        channels.resize_with(
            usize::try_from(channel_count).unwrap_or(0),
            Channel::default,
        );
    }
    let time_names = match &image.interval {
        Some((interval, unit)) if (2..=MOST_CHANNELS).contains(&times) => (0..times)
            .map(|time| moment(f64::from(time), *interval, unit))
            .collect(),
        _ => Vec::new(),
    };
    Ok(Volume {
        page_size: [x, y],
        depth,
        channel_count,
        times,
        spacing,
        channels,
        time_names,
        names,
        notes: Vec::new(),
        order: order.to_owned(),
        blocks: image
            .blocks
            .iter()
            .map(|block| TiffData {
                file_name: block.file_name.clone(),
                uuid: block.uuid.clone(),
                ..*block
            })
            .collect(),
        uuid: ome.uuid.clone(),
    })
}

/// Entries that are made before the pages were counted.
const MOST_CHANNELS: u32 = 65_536;

#[allow(clippy::arithmetic_side_effects, reason = "floats")]
fn in_units(metres: f64, unit: f64) -> f64 {
    // 0.1 um is 0.1 again, not 0.09999...: the quotient is rounded to 15 digits.
    let quotient = metres / unit;
    format!("{quotient:.14e}").parse().unwrap_or(quotient)
}

#[allow(clippy::arithmetic_side_effects, reason = "floats")]
fn moment(time: f64, interval: f64, unit: &str) -> String {
    format!("{} {}", time * interval, escape(unit))
}

impl Volume {
    /// The names of other files that hold pages. One foreign name for all pages is this file before it was renamed.
    pub(super) fn other_files(&mut self, own_name: &str) -> Vec<String> {
        let mut others: Vec<String> = Vec::new();
        let mut has_own = false;
        for block in &mut self.blocks {
            let is_own = !block.uuid.is_empty() && block.uuid == self.uuid;
            match &block.file_name {
                Some(name) if !is_own && name != own_name => {
                    if !others.contains(name) {
                        others.push(name.clone());
                    }
                }
                _ => {
                    has_own = true;
                    block.file_name = None;
                }
            }
        }
        if let ([name], false) = (others.as_slice(), has_own) {
            self.notes.push(format!(
                "the pages were in `{}` when this was written: it is taken for this file under an older name",
                escape(name)
            ));
            for block in &mut self.blocks {
                block.file_name = None;
            }
            others.clear();
        }
        others
    }

    /// The file and the number of a page of this image.
    pub(super) fn first_page(&self) -> (Option<&str>, u64) {
        let first = self.blocks.first();
        let file = first.and_then(|block| block.file_name.as_deref());
        (file, first.and_then(|block| block.ifd).unwrap_or(0))
    }

    /// The page of each z, channel page and time, z fastest. `channel_pages` is how many pages the channels take.
    pub(super) fn pages(
        &self,
        channel_pages: u32,
        most: usize,
        pages_of: impl Fn(Option<&str>) -> u64,
    ) -> Result<Vec<PageName>, Problem> {
        let count = u64::from(self.depth)
            .checked_mul(channel_pages.into())
            .and_then(|count| count.checked_mul(self.times.into()))
            .filter(|&count| usize::try_from(count).is_ok_and(|count| count <= most))
            .ok_or_else(|| {
                let found = format!("{} x {channel_pages} x {}", self.depth, self.times);
                let wanted = format!("at most {most} pages");
                invalid(TIFF, "SizeZ x SizeC x SizeT", wanted, &found)
            })?;
        let mut pages: Vec<Option<PageName>> = Vec::new();
        pages.resize_with(usize::try_from(count).unwrap_or(0), || None);
        let all = [TiffData::default()];
        let blocks = match self.blocks.as_slice() {
            [] => &all,
            blocks => blocks,
        };
        for block in blocks {
            let [z, c, t] = block.first;
            let first_page = block.ifd.unwrap_or(0);
            let present = pages_of(block.file_name.as_deref());
            let pages_there = block.count.unwrap_or(match block.ifd {
                Some(_) => 1,
                None => present.min(count),
            });
            let last_page = first_page.checked_add(pages_there);
            if last_page.is_none_or(|last| last > present) {
                let found = format!("{pages_there} pages from {first_page}");
                let wanted = format!("pages of the {present} that the file has");
                return Err(invalid(TIFF, "TiffData", wanted, &found));
            }
            let start = self.linear([z, c, t], channel_pages);
            for k in 0..pages_there {
                let place = start
                    .and_then(|start| start.checked_add(k))
                    .and_then(|linear| self.index_of(linear, channel_pages))
                    .and_then(|index| pages.get_mut(index));
                let Some(place) = place else {
                    let found = format!("{pages_there} pages from Z {z}, C {c}, T {t}");
                    let wanted = "pages inside SizeZ, SizeC and SizeT";
                    return Err(invalid(TIFF, "TiffData", wanted, &found));
                };
                *place = Some(PageName {
                    file: block.file_name.clone(),
                    number: first_page.saturating_add(k),
                });
            }
        }
        let missing = pages.iter().filter(|page| page.is_none()).count();
        let pages: Option<Vec<PageName>> = pages.into_iter().collect();
        pages.ok_or_else(|| {
            let found = format!("none for {missing} of {count}");
            let wanted = "a page for each Z, C and T";
            invalid(TIFF, "TiffData", wanted, &found)
        })
    }

    /// Sizes of Z, C, T in the order in which planes run, fastest first, each with its place in `[z, c, t]`.
    fn run(&self, channel_pages: u32) -> impl Iterator<Item = (usize, u64)> + '_ {
        self.order.chars().map(move |axis| match axis {
            'Z' => (0, self.depth.into()),
            'C' => (1, channel_pages.into()),
            _ => (2, self.times.into()),
        })
    }

    /// The number of a plane in the file's order; `None` outside.
    fn linear(&self, place: [u32; 3], channel_pages: u32) -> Option<u64> {
        let mut linear = 0_u64;
        let mut stride = 1_u64;
        for (axis, size) in self.run(channel_pages) {
            let here = u64::from(*place.get(axis)?);
            if here >= size {
                return None;
            }
            linear = linear.checked_add(here.checked_mul(stride)?)?;
            stride = stride.checked_mul(size)?;
        }
        Some(linear)
    }

    /// The index of a plane in our order: z, then channel, then time.
    fn index_of(&self, linear: u64, channel_pages: u32) -> Option<usize> {
        let mut rest = linear;
        let mut place = [0_u64; 3];
        for (axis, size) in self.run(channel_pages) {
            *place.get_mut(axis)? = rest.checked_rem(size)?;
            rest = rest.checked_div(size)?;
        }
        if rest > 0 {
            return None;
        }
        let [z, c, t] = place;
        let index = t
            .checked_mul(channel_pages.into())?
            .checked_add(c)?
            .checked_mul(self.depth.into())?
            .checked_add(z)?;
        usize::try_from(index).ok()
    }
}

//! OME-XML in the description of the first page, taken apart: the part of it that places pages.
//!
//! docs.openmicroscopy.org/ome-model, "OME-TIFF specification" and the schema of 2016-06. Documents with a DTD are
//! refused.

use super::super::TIFF;
use super::super::length::unit;
use crate::format::problem::{invalid, unsupported};
use crate::volume::Problem;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// Elements inside one another.
const DEEPEST: usize = 32;
/// Attributes of one element.
const MOST_ATTRIBUTES: usize = 256;

/// A document.
#[derive(Debug, Default)]
pub(super) struct Ome {
    /// The name by which `TiffData` mean this file.
    pub uuid: String,
    pub images: Vec<Image>,
    /// The file that the rest of the document is in.
    pub metadata_file: Option<String>,
}

/// One image of up to five dimensions.
#[derive(Debug, Default)]
pub(super) struct Image {
    pub id: String,
    pub name: String,
    pub has_pixels: bool,
    /// `XYCZT`.
    pub order: String,
    /// X, Y, Z, C, T.
    pub sizes: [u32; 5],
    /// The size of a voxel along x, y, z in metres, or in what is no length.
    pub physical: [Option<f64>; 3],
    /// The unit of x, in metres and as a word.
    pub unit: Option<(f64, &'static str)>,
    /// Time between two steps, with its unit.
    pub interval: Option<(f64, String)>,
    pub channels: Vec<OmeChannel>,
    pub blocks: Vec<TiffData>,
    /// Pixels inside the XML.
    pub has_bin_data: bool,
}

#[derive(Debug, Default)]
pub(super) struct OmeChannel {
    pub name: String,
    pub srgb: Option<[f32; 3]>,
}

/// Planes that lie one after the other in one file.
#[derive(Debug, Default)]
pub(super) struct TiffData {
    pub ifd: Option<u64>,
    /// The first plane's Z, C and T.
    pub first: [u32; 3],
    pub count: Option<u64>,
    pub file_name: Option<String>,
    pub uuid: String,
}

type Attributes = BTreeMap<String, String>;

pub(super) fn parse(text: &str) -> Result<Ome, Problem> {
    let wrong = |cause: String| invalid(TIFF, "OME-XML", "a well-formed document", &cause);
    let mut reader = Reader::from_str(text);
    let mut ome = Ome::default();
    let mut path: Vec<String> = Vec::new();
    loop {
        match reader
            .read_event()
            .map_err(|cause| wrong(cause.to_string()))?
        {
            Event::Eof => break,
            Event::DocType(_) => return Err(unsupported(TIFF, "OME-XML with a DTD")),
            Event::Start(element) => {
                open(&mut ome, &path, &element)?;
                if path.len() >= DEEPEST {
                    return Err(wrong("elements more than 32 deep".to_owned()));
                }
                path.push(element.local_name().as_ref().to_owned());
            }
            Event::Empty(element) => open(&mut ome, &path, &element)?,
            Event::End(_) => {
                path.pop();
            }
            Event::Text(text) if path.last().is_some_and(|name| name == "UUID") => {
                let block = ome
                    .images
                    .last_mut()
                    .and_then(|image| image.blocks.last_mut());
                if let Some(block) = block {
                    block.uuid = text.into_inner().trim().to_owned();
                }
            }
            _ => {}
        }
    }
    if !path.is_empty() {
        return Err(wrong("the document ends early".to_owned()));
    }
    Ok(ome)
}

fn attributes(element: &BytesStart) -> Result<Attributes, Problem> {
    let mut all = Attributes::new();
    for (index, attribute) in element.attributes().enumerate() {
        let wrong = |cause: String| invalid(TIFF, "OME-XML", "attributes", &cause);
        if index >= MOST_ATTRIBUTES {
            return Err(wrong("more than 256".to_owned()));
        }
        let attribute = attribute.map_err(|cause| wrong(cause.to_string()))?;
        let value = attribute
            .normalized_value(quick_xml::XmlVersion::Implicit1_0)
            .map_err(|cause| wrong(cause.to_string()))?;
        let name = attribute.key.local_name().as_ref().to_owned();
        all.entry(name).or_insert(value.into_owned());
    }
    Ok(all)
}

fn open(ome: &mut Ome, path: &[String], element: &BytesStart) -> Result<(), Problem> {
    let name = element.local_name();
    let is_inside = |parent: &str| path.last().is_some_and(|name| name == parent);
    match name.as_ref() {
        "OME" if path.is_empty() => {
            ome.uuid = attributes(element)?.remove("UUID").unwrap_or_default();
        }
        "BinaryOnly" => {
            let mut all = attributes(element)?;
            ome.metadata_file = Some(all.remove("MetadataFile").unwrap_or_default());
        }
        "Image" if is_inside("OME") => {
            let mut all = attributes(element)?;
            ome.images.push(Image {
                id: all.remove("ID").unwrap_or_default(),
                name: all.remove("Name").unwrap_or_default(),
                ..Image::default()
            });
        }
        "Pixels" if is_inside("Image") => {
            if let Some(image) = ome.images.last_mut() {
                pixels(image, &attributes(element)?)?;
            }
        }
        "Channel" if is_inside("Pixels") => {
            if let Some(image) = ome.images.last_mut() {
                image.channels.push(channel(attributes(element)?));
            }
        }
        "TiffData" if is_inside("Pixels") => {
            if let Some(image) = ome.images.last_mut() {
                image.blocks.push(tiff_data(&attributes(element)?)?);
            }
        }
        "BinData" if is_inside("Pixels") => {
            if let Some(image) = ome.images.last_mut() {
                image.has_bin_data = true;
            }
        }
        "UUID" if is_inside("TiffData") => {
            let block = ome
                .images
                .last_mut()
                .and_then(|image| image.blocks.last_mut());
            if let Some(block) = block {
                block.file_name = attributes(element)?.remove("FileName");
            }
        }
        _ => {}
    }
    Ok(())
}

fn pixels(image: &mut Image, all: &Attributes) -> Result<(), Problem> {
    image.has_pixels = true;
    image.order = all.get("DimensionOrder").cloned().unwrap_or_default();
    for (size, name) in image
        .sizes
        .iter_mut()
        .zip(["SizeX", "SizeY", "SizeZ", "SizeC", "SizeT"])
    {
        let text = all.get(name).map_or("", String::as_str);
        let number = text.parse().ok().filter(|&n| n > 0);
        *size =
            number.ok_or_else(|| invalid(TIFF, name, "a whole number from 1 to 2^32 - 1", text))?;
    }
    let names = ["PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"];
    let units = names.map(|name| {
        let word = all.get(&format!("{name}Unit"));
        // The schema's default.
        unit(word.map_or("um", String::as_str))
    });
    for ((physical, name), unit) in image.physical.iter_mut().zip(names).zip(units) {
        let number = all
            .get(name)
            .and_then(|text| text.trim().parse::<f64>().ok());
        let number = number.filter(|number| number.is_finite() && *number > 0.0);
        // What is not a length, such as `pixel`, cannot be compared with one.
        *physical = number
            .zip(unit)
            .map(|(number, (metres, _))| metres_of(number, metres));
    }
    image.unit = units
        .into_iter()
        .zip(image.physical)
        .find_map(|(unit, size)| size.and(unit));
    let interval = all
        .get("TimeIncrement")
        .and_then(|text| text.parse::<f64>().ok());
    let unit = all.get("TimeIncrementUnit").map_or("s", String::as_str);
    image.interval = interval
        .filter(|interval| interval.is_finite() && *interval > 0.0)
        .map(|interval| (interval, unit.to_owned()));
    Ok(())
}

#[allow(clippy::arithmetic_side_effects, reason = "floats")]
fn metres_of(number: f64, metres: f64) -> f64 {
    number * metres
}

fn channel(mut all: Attributes) -> OmeChannel {
    let color = all
        .get("Color")
        .and_then(|text| text.trim().parse::<i64>().ok());
    OmeChannel {
        name: all.remove("Name").unwrap_or_default(),
        // A signed number of 32 bits: red, green, blue and opacity, red on top. All bits are "not chosen" to some.
        srgb: color.and_then(|color| {
            let color = u32::try_from(color & 0xffff_ffff).ok()?;
            let [red, green, blue, _] = color.to_be_bytes();
            Some([red, green, blue].map(unit_interval))
        }),
    }
}

#[allow(clippy::arithmetic_side_effects, reason = "floats")]
fn unit_interval(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}

fn tiff_data(all: &Attributes) -> Result<TiffData, Problem> {
    fn number<N: std::str::FromStr>(all: &Attributes, name: &str) -> Result<Option<N>, Problem> {
        let Some(text) = all.get(name) else {
            return Ok(None);
        };
        let number = text.trim().parse().ok();
        let wrong = || invalid(TIFF, name, "a whole number", text);
        number.map(Some).ok_or_else(wrong)
    }
    let mut first = [0; 3];
    for (first, name) in first.iter_mut().zip(["FirstZ", "FirstC", "FirstT"]) {
        *first = number(all, name)?.unwrap_or(0);
    }
    Ok(TiffData {
        ifd: number(all, "IFD")?,
        first,
        count: number(all, "PlaneCount")?,
        file_name: None,
        uuid: String::new(),
    })
}

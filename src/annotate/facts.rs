//! What is known of a volume and may be written on its picture. Nothing of a DICOM file but units and times.

use crate::{
    figure::letter_lacking,
    volume::{ComponentKind, Format, Header, Heights},
};

/// Of the volume that is drawn, or of what colours it.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// What the values are; empty where the file does not say.
    pub caption: String,
    /// Of the values, as the file has it.
    pub unit: Option<String>,
    /// How many times there are.
    pub times: u32,
    /// The moment of each, or none.
    pub time_names: Vec<String>,
    /// x right, y anterior, z superior.
    pub is_patient: bool,
    /// x east, y north, z up.
    pub is_earth: bool,
    /// World units of a degree of longitude along x and of latitude along y.
    pub degree_lengths: [Option<f64>; 2],
    /// Metres of a unit of the world.
    pub length_metres: Option<f64>,
    /// What places along z stand for, on the Earth.
    pub heights: Heights,
    /// Names of channels; empty where there are none.
    pub channels: Vec<String>,
    /// A voxel is a colour.
    pub is_color: bool,
    /// File and variable.
    pub source: String,
    /// Of the variable that colours surfaces: what it is, and its unit.
    pub paint: Option<(String, Option<String>)>,
}

impl Facts {
    /// Of a header, and of the name of its file; nothing colours surfaces.
    pub fn of(header: &Header, name: &str) -> Self {
        let channels = match &header.meaning {
            ComponentKind::Channels(channels) if header.format != Format::Dicom => {
                channels.iter().map(|c| c.name.clone()).collect()
            }
            _ => Vec::new(),
        };
        Self {
            caption: caption(header),
            unit: unit(header),
            times: header.times,
            time_names: header.time_names.clone(),
            is_patient: header.is_patient,
            is_earth: header.is_earth,
            degree_lengths: header.earth_degree_lengths(),
            length_metres: header.length_metres,
            heights: header.heights,
            channels,
            is_color: matches!(header.meaning, ComponentKind::Rgb | ComponentKind::Rgba),
            source: source(name, header),
            paint: None,
        }
    }

    /// Words of the file that have letters which are drawn as boxes.
    pub fn letters_lacking(&self) -> Option<char> {
        let words = [&self.caption, &self.source];
        let words = words
            .into_iter()
            .chain(&self.time_names)
            .chain(&self.channels);
        words.into_iter().find_map(|text| letter_lacking(text))
    }
}

/// The unit of values, Hounsfield's where the header knows it otherwise.
pub fn unit(header: &Header) -> Option<String> {
    let hounsfield = header.hounsfield.then(|| "HU".to_owned());
    header.unit.clone().or(hounsfield)
}

/// What the values are; of a DICOM file nothing.
pub fn caption(header: &Header) -> String {
    if header.format == Format::Dicom {
        return String::new();
    }
    let name = header.long_name.as_ref().or(header.variables.first());
    name.map_or(String::new(), |name| name.trim().to_owned())
}

fn source(name: &str, header: &Header) -> String {
    // The name of a file may be that of a patient.
    if header.format == Format::Dicom {
        return "DICOM".to_owned();
    }
    match header.variables.first() {
        Some(variable) => format!("{name}, {variable}"),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Channel, Series, VoxelType};
    use glam::DAffine3;

    #[test]
    fn nothing_private_of_a_dicom_file_is_known() {
        let private = || "DOE^JOHN 1970-01-01".to_owned();
        let header = Header {
            unit: Some("HU".to_owned()),
            long_name: Some(private()),
            variables: vec![private()],
            notes: vec![private()],
            meaning: ComponentKind::Channels(vec![Channel {
                name: private(),
                ..Channel::default()
            }]),
            series: vec![Series {
                uid: private(),
                description: private(),
                pictures: 1,
            }],
            ..Header::new(Format::Dicom, [2; 3], VoxelType::I16, DAffine3::IDENTITY)
        };
        let facts = Facts::of(&header, "DOE^JOHN.dcm");
        let known = format!("{facts:?}");
        assert!(!known.contains("DOE") && !known.contains("1970"), "{known}");
        assert_eq!(
            (facts.unit.as_deref(), facts.source.as_str()),
            (Some("HU"), "DICOM")
        );
        // The same words of another format are written.
        let header = Header {
            format: Format::Nrrd,
            ..header
        };
        let facts = Facts::of(&header, "DOE^JOHN.nrrd");
        assert!(
            facts.caption.contains("DOE") && facts.source.contains("DOE"),
            "{facts:?}"
        );
    }
}

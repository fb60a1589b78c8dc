//! Volumes of single variables of the input.

use super::super::{Error, flags::InputFlags};
use crate::volume::{Limits, Source, TimeComponent, Volume, sample::nearest};

/// Opens variables of one input.
#[derive(Clone, Copy, Debug)]
pub struct Variables<'a> {
    pub input: &'a InputFlags,
    pub limits: Limits,
}

impl Variables<'_> {
    /// The variable of that name, with its grid as it is drawn.
    pub fn open(&self, name: &str) -> Result<Box<dyn Source>, Error> {
        self.named(name).open(&self.limits)
    }

    /// The same with the voxels of the file.
    pub fn open_as_stored(&self, name: &str) -> Result<Box<dyn Source>, Error> {
        self.named(name).open_as_stored(&self.limits)
    }

    fn named(&self, name: &str) -> InputFlags {
        InputFlags {
            variable: Some(name.to_owned()),
            component: None,
            ..self.input.clone()
        }
    }

    /// One time of a component.
    pub fn read(&self, source: &dyn Source, time: u32, component: u32) -> Result<Volume, Error> {
        let header = source.header();
        let pick = TimeComponent { time, component };
        Ok(Volume::read(source, pick, header.whole(), &self.limits)?)
    }
}

/// The numbers of all voxels times a factor, x fastest; NaN where there is no data.
pub fn numbers(volume: &Volume, factor: f64) -> Vec<f32> {
    let [nx, ny, nz] = volume.dims;
    let at = |voxel: [u32; 3]| {
        let center = voxel.map(|i| f64::from(i) + 0.5);
        nearest::<f64>(volume, center).map_or(f32::NAN, |value| (value * factor) as f32)
    };
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    all.map(at).collect()
}

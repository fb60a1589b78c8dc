//! `stratavox sheet`: many volumes as small pictures in one, each drawn as `render` draws it without a flag.

use super::{
    Error,
    error::visible,
    flags::{Depth, InputFlags, SceneFlags, Size},
    load::load,
    output::{self, say},
    progress::{Progress, ProgressWord},
    renderer::{Device, Job, Renderer},
    signals::Gate,
};
use crate::{
    camera::BoundingSphere,
    picture::{ColorSpace, Picture, WriteOptions, write_picture},
    technique::Filter,
};
use clap::Args;
use std::path::PathBuf;

/// Draw many volumes into one picture, a small one each
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox sheet phantom:head phantom:shells phantom:fog -o sheet.png\n  \
    stratavox sheet phantom:head phantom:storm,variable=cloud --columns 2 --tile 160x120 -o two.png\n\n\
    An INPUT may end in ,variable=NAME and ,time=N and ,component=N, where it holds several volumes.")]
pub struct Sheet {
    /// Volumes, as `render` takes them
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<String>,
    /// The picture, a .png
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Pixels of one small picture
    #[arg(long, value_name = "WxH", default_value = "256x192")]
    tile: Size,
    /// Small pictures in a row [default: as many as make the sheet about as wide as it is high]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    columns: Option<u32>,
    /// A Vulkan device, as for `render`
    #[arg(long, value_name = "DEVICE")]
    device: Option<String>,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t)]
    progress: ProgressWord,
    /// Replace a file that exists
    #[arg(long)]
    force: bool,
}

/// Behind and between the small pictures, sRGB and alpha.
const BACKGROUND: [f64; 4] = [0.09, 0.09, 0.11, 1.0];

/// Pixels between small pictures.
const GAP: u32 = 4;

impl Sheet {
    /// Draws one after the other and writes the sheet. An input that cannot be drawn leaves its place empty,
    /// and the first such error is that of the whole.
    pub fn run(self, gate: &Gate) -> Result<(), Error> {
        let scenes: Vec<SceneFlags> = self.inputs.iter().map(|words| scene_of(words)).collect();
        let files: Vec<PathBuf> = scenes
            .iter()
            .filter_map(|scene| scene.input.file().map(PathBuf::from))
            .collect();
        output::check(std::slice::from_ref(&self.output), &files, self.force)?;
        let mut sheet = Tiles::new(scenes.len() as u32, self.columns, self.tile.0)?;
        let progress = Progress::new(self.progress);
        let mut device = Device::find(self.device.as_deref())?;
        progress.device(&device.name());
        let mut places = String::new();
        let mut first_error = None;
        for (at, scene) in scenes.iter().enumerate() {
            progress.stage("draw", at, scenes.len());
            let words = &self.inputs[at];
            match draw(scene, self.tile.0, &mut device, &self.device, &progress) {
                Ok(picture) => sheet.put(at as u32, &picture),
                Err(error) => {
                    progress.note(&format!("{words} is left out: {error}"));
                    first_error.get_or_insert(error);
                }
            }
            let [row, column] = sheet.place(at as u32).map(|n| n + 1);
            places += &format!("{row} {column} {}\n", visible(words));
        }
        progress.stage("write", 0, 1);
        let options = WriteOptions {
            force: self.force,
            ..WriteOptions::default()
        };
        gate.whole(|| write_picture(&sheet.picture, &self.output, options))?;
        say(&places)?;
        first_error.map_or(Ok(()), Err)
    }
}

/// `PATH[,variable=NAME][,time=N][,component=N]`.
fn scene_of(words: &str) -> SceneFlags {
    let mut input = InputFlags::default();
    let mut path = words;
    while let Some((rest, last)) = path.rsplit_once(',') {
        match last.split_once('=') {
            Some(("variable", name)) => input.variable = Some(name.to_owned()),
            Some(("time", time)) => input.time = Some(time.to_owned()),
            Some(("component", n)) if n.parse::<u32>().is_ok() => input.component = n.parse().ok(),
            // The words of a phantom, or part of a file's name.
            _ => break,
        }
        path = rest;
    }
    input.path = Some(path.to_owned());
    SceneFlags {
        input,
        ..SceneFlags::default()
    }
}

fn draw(
    scene: &SceneFlags,
    extent_pixels: [u32; 2],
    device: &mut Device,
    device_word: &Option<String>,
    progress: &Progress,
) -> Result<Picture, Error> {
    let volume = load(scene, device, progress)?;
    let mut settings = scene.sampling.settings(Depth::Eight)?;
    let bounds = BoundingSphere::of_grid(&volume.world_from_voxel, volume.dims);
    let camera = scene.camera.camera(&bounds, extent_pixels)?;
    let classification = scene
        .classification
        .classification(&volume, settings.mode)?;
    if scene.classification.found_labels(&classification) {
        settings.filter = Filter::Nearest;
    }
    let job = Job {
        volume: &volume,
        classification: &classification,
        beside: Default::default(),
        settings: &settings,
        extent_pixels,
        layers: &[],
    };
    // A device that a picture failed on is not used for the next.
    let here = std::mem::replace(device, Device::find(Some("reference"))?);
    let drawn = Renderer::new(job, &camera, here).and_then(|mut renderer| {
        let whole = renderer.draw(&camera)?.picture;
        let mut closer = scene.camera.clone();
        closer.zoom = Some(zoom_to(&whole));
        let camera = closer.camera(&bounds, extent_pixels)?;
        let mut picture = renderer.draw(&camera)?.picture;
        picture.over_background(BACKGROUND);
        Ok((picture, renderer.into_device()))
    });
    match drawn {
        Ok((picture, free)) => {
            *device = free;
            Ok(picture)
        }
        Err(error) => {
            *device = Device::find(device_word.as_deref())?;
            Err(error)
        }
    }
}

/// The zoom at which what is seen just fills the picture: bounding spheres are mostly empty.
fn zoom_to(picture: &Picture) -> f64 {
    const VISIBLE: f32 = 1.0 / 64.0;
    const FILLED: f64 = 0.94;
    let [width, height] = [picture.width, picture.height].map(f64::from);
    let mut reach = 0.0_f64;
    for (at, pixel) in (0_u32..).zip(&picture.pixels) {
        if pixel[3] < VISIBLE {
            continue;
        }
        let [x, y] = [at % picture.width, at / picture.width].map(|n| f64::from(n) + 0.5);
        let [x, y] = [x / width, y / height].map(|part| (2.0 * part - 1.0).abs());
        reach = reach.max(x).max(y);
    }
    if reach == 0.0 {
        1.0
    } else {
        (FILLED / reach).max(1.0)
    }
}

/// Small pictures in rows.
struct Tiles {
    columns: u32,
    tile: [u32; 2],
    picture: Picture,
}

impl Tiles {
    fn new(count: u32, columns: Option<u32>, tile: [u32; 2]) -> Result<Self, Error> {
        let [width, height] = tile.map(|side| u64::from(side) + u64::from(GAP));
        let square = (f64::from(count) * height as f64 / width as f64).sqrt();
        let columns = columns.unwrap_or(square.round() as u32).clamp(1, count);
        let rows = count.div_ceil(columns);
        let sides = [
            u64::from(columns) * width + u64::from(GAP),
            u64::from(rows) * height + u64::from(GAP),
        ];
        let [Ok(width), Ok(height)] = sides.map(|side| {
            u32::try_from(side)
                .ok()
                .filter(|&side| side <= MAX_SIDE_PIXELS)
                .ok_or(())
        }) else {
            return Err(Error::Limit(format!(
                "a sheet of {}x{} pixels: a side has at most {MAX_SIDE_PIXELS}",
                sides[0], sides[1]
            )));
        };
        let mut picture = Picture {
            width,
            height,
            pixels: vec![[0.0; 4]; width as usize * height as usize],
            color_space: ColorSpace::Linear,
            layers: Vec::new(),
        };
        picture.over_background(BACKGROUND);
        Ok(Self {
            columns,
            tile,
            picture,
        })
    }

    /// Row and column, counted from 0.
    fn place(&self, at: u32) -> [u32; 2] {
        [at / self.columns, at % self.columns]
    }

    fn put(&mut self, at: u32, picture: &Picture) {
        let [row, column] = self.place(at);
        let left = GAP + column * (self.tile[0] + GAP);
        let top = GAP + row * (self.tile[1] + GAP);
        for y in 0..picture.height {
            let to = ((top + y) * self.picture.width + left) as usize;
            let from = (y * picture.width) as usize;
            let width = picture.width as usize;
            self.picture.pixels[to..to + width]
                .copy_from_slice(&picture.pixels[from..from + width]);
        }
    }
}

/// Pixels on one side: what image formats agree on.
const MAX_SIDE_PIXELS: u32 = 32_768;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_behind_a_path_choose_and_others_are_part_of_it() {
        let scene = scene_of("a,b.nc,variable=T,time=3");
        assert_eq!(scene.input.path.as_deref(), Some("a,b.nc"));
        assert_eq!(scene.input.variable.as_deref(), Some("T"));
        assert_eq!(scene.input.time.as_deref(), Some("3"));
        let scene = scene_of("phantom:head,n=32");
        assert_eq!(scene.input.path.as_deref(), Some("phantom:head,n=32"));
    }

    #[test]
    fn small_pictures_stand_side_by_side_with_gaps() {
        let mut sheet = Tiles::new(3, Some(2), [2, 1]).expect("a sheet");
        assert_eq!([sheet.picture.width, sheet.picture.height], [16, 14]);
        let white = Picture {
            width: 2,
            height: 1,
            pixels: vec![[1.0; 4]; 2],
            color_space: ColorSpace::Linear,
            layers: Vec::new(),
        };
        sheet.put(2, &white);
        let lit: Vec<usize> = (0..16 * 14)
            .filter(|&i| sheet.picture.pixels[i] == [1.0; 4])
            .collect();
        assert_eq!(lit, [9 * 16 + 4, 9 * 16 + 5]);
        assert!(Tiles::new(1 << 20, Some(1), [512, 512]).is_err());
    }
}

//! `stratavox sheet`: many volumes as small pictures in one, each drawn as `render` draws it without a flag.

use super::{
    Error,
    annotation::{annotation, finish},
    error::visible,
    flags::{AnnotateFlags, Depth, InputFlags, Look, SceneFlags, Size},
    inputs::Inputs,
    look::{Framing, Use, Views, prepared},
    output::{self, say},
    progress::{Progress, ProgressWord},
    renderer::Device,
    scene_inputs::SceneInputs,
    signals::Gate,
};
use crate::annotate::Annotation;
use crate::figure::{Anchor, Color, Figure, Mark, SCALE, png};
use crate::look::BACKGROUND;
use crate::picture::{Picture, PictureFormat};
use clap::Args;
use std::path::{Path, PathBuf};

/// Draw many volumes into one picture, a small one each
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox sheet phantom:head phantom:shells phantom:fog -o sheet.png\n  \
    stratavox sheet phantom:head phantom:storm,variable=cloud --columns 2 --tile 160x120 -o two.png\n  \
    stratavox sheet FOLDER --recursive -o scans.png\n\n\
    Of a folder that is no volume itself the volumes inside are drawn, in the order of their names; each is drawn once.\n\
    An INPUT may end in ,variable=NAME and ,time=N and ,component=N, where it holds several volumes.")]
pub struct Sheet {
    /// Volumes, as `render` takes them, and folders of volumes
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
    /// Look into folders inside folders too
    #[arg(long)]
    recursive: bool,
    /// As for `render`: auto fits, lights and classifies by what each volume is; plain does not [default: auto]
    #[arg(long)]
    look: Option<Look>,
    /// Draw thin components of CT that touch faces of the box, such as a table, as for `render`
    #[arg(long)]
    keep_all: bool,
    #[command(flatten)]
    annotate: AnnotateFlags,
    /// A Vulkan device, as for `render`
    #[arg(long, value_name = "DEVICE")]
    device: Option<String>,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t)]
    progress: ProgressWord,
    /// As for `render`
    #[arg(long)]
    untrusted: bool,
    /// Replace a file that exists
    #[arg(long)]
    force: bool,
}

impl Sheet {
    /// Draws one after the other and writes the sheet. An input that cannot be drawn leaves its place empty,
    /// and the first such error is that of the whole. Where none can be drawn there is no sheet.
    pub fn run(self, gate: &Gate) -> Result<(), Error> {
        check_name(&self.output)?;
        self.annotate.check()?;
        let flags = InputFlags {
            untrusted: self.untrusted,
            ..InputFlags::default()
        };
        let inputs = Inputs::find(&self.inputs, &flags, self.recursive)?;
        let volumes = &inputs.volumes;
        let scene = |words: &String| SceneFlags {
            look: self.look,
            annotate: self.annotate.clone(),
            ..scene_of(words)
        };
        let mut scenes: Vec<SceneFlags> = volumes.iter().map(scene).collect();
        for scene in &mut scenes {
            scene.input.untrusted = self.untrusted;
            scene.input.keep_all = self.keep_all.then_some(true);
            scene.default_to_auto();
        }
        let files: Vec<PathBuf> = scenes
            .iter()
            .filter_map(|scene| scene.input.file().map(PathBuf::from))
            .collect();
        output::check(std::slice::from_ref(&self.output), &files, self.force)?;
        let mut sheet = Tiles::new(scenes.len() as u32, self.columns, self.tile.0)?;
        let progress = Progress::new(self.progress);
        let mut device = Device::find(self.device.as_deref())?;
        progress.device(&device.name()?);
        for note in inputs.notes() {
            progress.note(&note);
        }
        let mut places = String::new();
        let mut first_error = inputs.failures.into_iter().next();
        for (at, scene) in scenes.iter().enumerate() {
            progress.stage("draw", at, scenes.len());
            let words = &volumes[at];
            sheet.name(at as u32, short_name(words));
            let of_one = Progress::of_part();
            let drawn = draw(scene, self.tile.0, &mut device, &self.device, &of_one);
            // Of many volumes a note says which it is of.
            for note in of_one.into_notes() {
                progress.note(&format!("{words}: {note}"));
            }
            match drawn {
                Ok(picture) => {
                    sheet.put(at as u32, &picture);
                    let [row, column] = sheet.place(at as u32).map(|n| n + 1);
                    places += &format!("{row} {column} {}\n", visible(words));
                }
                Err(error) => {
                    progress.note(&format!("{words} is left out: {error}"));
                    first_error.get_or_insert(error);
                }
            }
        }
        if places.is_empty() {
            return first_error.map_or(Ok(()), Err);
        }
        progress.stage("write", 0, 1);
        output::write_whole(&self.output, &png(&sheet.figure), self.force, gate)?;
        say(&places)?;
        first_error.map_or(Ok(()), Err)
    }
}

/// A sheet is written as PNG: another ending would be no name for it.
fn check_name(path: &Path) -> Result<(), Error> {
    let problem = match PictureFormat::of_path(path) {
        Some(PictureFormat::Png) => return Ok(()),
        Some(_) => "a sheet is a PNG",
        None => "the ending says no kind of picture",
    };
    Err(Error::usage(
        format!("-o {}: {problem}", path.display()),
        "end the name in .png",
    ))
}

/// The last part of a path, with the words behind it.
fn short_name(words: &str) -> &str {
    words
        .trim_end_matches('/')
        .rsplit('/')
        .next()
        .unwrap_or(words)
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
    let settings = scene.settings(Depth::Eight)?;
    let scene = &mut scene.clone();
    let shown = SceneInputs::read(scene, &settings, device, progress)?;
    let made_for = Use {
        is_film: false,
        is_opaque: true,
        depth: Depth::Eight,
    };
    let framing = Framing::new(scene, &shown, made_for, extent_pixels, true);
    let (parts, views) = (shown.parts(), Views::default());
    // A device that a picture failed on is not used for the next.
    let here = std::mem::replace(device, Device::find(Some("reference"))?);
    let drawn = prepared(&framing, &parts, &[], here, &views).and_then(|(mut renderer, view)| {
        let mut picture = renderer.draw(&view.camera)?.picture;
        let annotation = annotation(scene, &shown.header, settings.mode)?;
        if let Some(note) = annotation.as_ref().and_then(Annotation::note) {
            progress.note(&note);
        }
        // A sheet has no transparency: what plain pictures leave open shows what lies between them.
        let background = Some(view.scene.picture.background().unwrap_or(BACKGROUND));
        let annotation = annotation.as_ref();
        let format = PictureFormat::Png;
        finish(
            &mut picture,
            annotation,
            &shown,
            view,
            &mut renderer,
            background,
            format,
        )?;
        view.notes.iter().for_each(|note| progress.note(note));
        Ok((picture, renderer.into_device()))
    });
    match drawn {
        Ok((drawn, free)) => {
            *device = free;
            Ok(drawn)
        }
        Err(error) => {
            *device = Device::find(device_word.as_deref())?;
            Err(error)
        }
    }
}

/// Small pictures in rows, each over its name.
struct Tiles {
    columns: u32,
    tile: [u32; 2],
    figure: Figure,
}

impl Tiles {
    fn new(count: u32, columns: Option<u32>, tile: [u32; 2]) -> Result<Self, Error> {
        let [width, height] = [tile[0] + GAP, tile[1] + GAP + NAME].map(f64::from);
        let square = (f64::from(count) * height / width).sqrt();
        let columns = columns.unwrap_or(square.round() as u32).clamp(1, count);
        let gap = f64::from(GAP);
        let pixels = [
            f64::from(columns) * width + gap,
            f64::from(count.div_ceil(columns)) * height + gap,
        ];
        if pixels.iter().any(|&side| side > MAX_SIDE_PIXELS) {
            return Err(Error::TooMany {
                message: format!(
                    "a sheet of {}x{} pixels: a side has at most {MAX_SIDE_PIXELS}",
                    pixels[0], pixels[1]
                ),
                hint: "a smaller --size, or fewer volumes",
            });
        }
        let [right, bottom] = pixels.map(|side| side / SCALE);
        let mut figure = Figure::new([right, bottom], "volumes".to_owned());
        figure.marks.push(Mark::Area {
            points: vec![[0.0, 0.0], [right, 0.0], [right, bottom], [0.0, bottom]],
            fill: background(),
        });
        Ok(Self {
            columns,
            tile,
            figure,
        })
    }

    /// Row and column, counted from 0.
    fn place(&self, at: u32) -> [u32; 2] {
        [at / self.columns, at % self.columns]
    }

    /// Pixels from the upper left corner of the sheet to that of a small picture.
    fn corner(&self, at: u32) -> [f64; 2] {
        let [row, column] = self.place(at);
        [
            GAP + column * (self.tile[0] + GAP),
            GAP + row * (self.tile[1] + GAP + NAME),
        ]
        .map(f64::from)
    }

    fn put(&mut self, at: u32, picture: &Picture) {
        let opaque = |[r, g, b, _]: [u16; 4]| [r, g, b].map(|code| code as u8);
        self.figure.marks.push(Mark::Cells {
            at: self.corner(at).map(|pixels| pixels / SCALE),
            size: self.tile.map(|pixels| f64::from(pixels) / SCALE),
            columns: picture.width as usize,
            colors: picture.codes(255).into_iter().map(opaque).collect(),
        });
    }

    fn name(&mut self, at: u32, name: &str) {
        let [left, top] = self.corner(at);
        let [width, height] = self.tile.map(f64::from);
        // The end of a name says more than its beginning.
        let most = ((width / (0.62 * LETTERS_PIXELS)) as usize).max(1);
        let skipped = name.chars().count().saturating_sub(most);
        let shown: String = name.chars().skip(skipped).collect();
        let middle = [left + width / 2.0, top + height + 0.75 * f64::from(NAME)];
        let size = LETTERS_PIXELS / SCALE;
        let middle = middle.map(|pixels| pixels / SCALE);
        self.figure
            .words(middle, shown, size, Anchor::Middle, NAMES);
    }
}

/// Between the small pictures lies what is behind them.
fn background() -> Color {
    BACKGROUND.map(|share| (share * 255.0).round() as u8)
}

/// Words on it.
const NAMES: Color = [196, 200, 208, 255];

/// Pixels between small pictures.
const GAP: u32 = 6;

/// Pixels below each for its name.
const NAME: u32 = 18;

/// Pixels of an em of a name.
const LETTERS_PIXELS: f64 = 13.5;

/// Pixels on one side: what image formats agree on.
const MAX_SIDE_PIXELS: f64 = 32_768.0;

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
    fn small_pictures_stand_side_by_side_over_their_names() {
        let mut sheet = Tiles::new(3, Some(2), [30, 20]).expect("a sheet");
        let white = Picture {
            width: 30,
            height: 20,
            pixels: vec![[1.0; 4]; 600],
            color_space: crate::picture::ColorSpace::Linear,
            layers: Vec::new(),
        };
        sheet.put(2, &white);
        let bytes = png(&sheet.figure);
        let found = image::load_from_memory(&bytes)
            .expect("a picture")
            .to_rgb8();
        assert_eq!(found.dimensions(), (78, 94));
        let lit = |(x, y): (u32, u32)| found.get_pixel(x, y).0 == [255; 3];
        let all = (0..94).flat_map(|y| (0..78).map(move |x| (x, y)));
        let lit: Vec<_> = all.filter(|&at| lit(at)).collect();
        assert_eq!((lit.len(), lit[0], lit[599]), (600, (6, 50), (35, 69)));
        assert!(Tiles::new(1 << 20, Some(1), [512, 512]).is_err());
    }

    #[test]
    fn a_name_is_the_last_part_of_a_path() {
        assert_eq!(short_name("a/b.nc,variable=T"), "b.nc,variable=T");
        assert_eq!(short_name("a/folder.zarr/"), "folder.zarr");
        assert_eq!(short_name("phantom:head"), "phantom:head");
    }
}

//! `stratavox thumbnails`: many volumes, a small picture each.
//!
//! ```text
//! words -> volumes -> names of pictures -> read | draw all views | encode | write, all at once -> index, summary
//! ```

mod batch;
mod index;
mod item;
mod names;
mod parts;
mod room;

use super::{
    Error,
    flags::{Depth, SceneFlags, Size, ViewWord},
    inputs::Inputs,
    memory::available_bytes,
    output::{self, say_aside, write_whole},
    progress::{Progress, ProgressWord},
    scene_file, scene_inputs,
    signals::Gate,
};
use crate::picture::{BitDepth, WriteOptions};
use batch::Batch;
use clap::Args;
use index::{Became, Index, Row};
use item::{Item, WantedPicture};
use parts::{Part, Variables};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Draw many volumes, a small picture of each into a folder
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox thumbnails phantom:head,n=64 phantom:shells,n=64 -o pictures\n  \
    stratavox thumbnails FOLDER -o pictures --recursive --index index.json\n  \
    stratavox thumbnails FOLDER --mode mip --view anterior --size 128x128 -o pictures --resume\n  \
    stratavox thumbnails FOLDER --views anterior,left,superior -o pictures\n\n\
    A folder that is one volume (DICOM, slices of TIFF, Zarr) is one; of another the volumes inside are drawn.\n\
    Of a folder of several series each is drawn; of a file of several variables the first that is no coordinate, by\n\
    --variable all and under --look plain each.\n\
    A volume that cannot be drawn is named, and the others are drawn: the exit code is that of the first failure.\n\
    A volume too large for the memory is drawn with fewer voxels, as by --fit of `render`.")]
// The volumes are INPUT... here; the one INPUT of other verbs makes room for them.
#[command(mut_arg("path", |path| path.long("path").hide(true)))]
pub struct Thumbnails {
    /// Volumes, as `render` takes them, and folders of volumes
    #[arg(value_name = "INPUT", required = true)]
    inputs: Vec<String>,
    /// The folder of the pictures; it is made where there is none
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Draw every volume from each of these sides, as --view has them, into NAME-SIDE.png; it is read and brought to
    /// the device once
    #[arg(long, value_name = "SIDE,SIDE...", value_delimiter = ',', help_heading = "Camera",
          conflicts_with_all = ["view", "azimuth", "elevation", "eye", "section"])]
    views: Vec<ViewWord>,
    /// Look into folders inside folders too
    #[arg(long, help_heading = "Batch")]
    recursive: bool,
    /// Keep the pictures that are there and draw the others
    #[arg(long, conflicts_with = "force", help_heading = "Batch")]
    resume: bool,
    /// Write what became of each volume into a file
    #[arg(long, value_name = "FILE.json", help_heading = "Batch")]
    index: Option<PathBuf>,
    #[command(flatten)]
    scene: SceneFlags,
    /// Flags from a file; those of the command line win
    #[arg(long = "scene", value_name = "FILE.json", help_heading = "Run")]
    scene_file: Option<PathBuf>,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t, help_heading = "Run")]
    progress: ProgressWord,
    /// Replace files that exist
    #[arg(long, help_heading = "Run")]
    force: bool,
    /// No empty-space skipping: the pictures are the same without
    #[arg(long, conflicts_with = "empty_space")]
    no_skip: bool,
}

/// The word of `--variable` for each of them.
const ALL: &str = "all";

/// Which of several variables are drawn: what `--variable all` says, else the look. Such a word names none.
fn variables_of(scene: &mut SceneFlags) -> Variables {
    let is_all = scene.input.variable.as_deref() == Some(ALL);
    if is_all {
        scene.input.variable = None;
    }
    match is_all || !scene.is_auto() {
        true => Variables::All,
        false => Variables::First,
    }
}

/// Pixels where no word says how many.
const SIZE: Size = Size([256, 256]);

impl Thumbnails {
    /// Draws and writes.
    pub fn run(mut self, gate: &Gate) -> Result<(), Error> {
        let mut scene = self.whole_scene()?;
        let variables = variables_of(&mut scene);
        let depth = match scene.picture.bit_depth() {
            BitDepth::Eight => Depth::Eight,
            BitDepth::Sixteen => Depth::More,
        };
        let mut settings = scene.settings(depth)?;
        settings.skip &= !self.no_skip;
        scene.classification.check()?;
        scene.annotate.check()?;
        scene_inputs::check(&scene, &settings)?;
        let inputs = Inputs::find(&self.inputs, &scene.input, self.recursive)?;
        let passed_over = inputs.notes();
        let unnamed = inputs.failures.into_iter().next();
        let volumes = inputs.volumes.into_iter().flat_map(|input| {
            let parts = parts::of_input(&input, &scene.input, variables).into_iter();
            parts.map(move |part| (input.clone(), part))
        });
        let volumes: Vec<(String, Part)> = volumes.collect();
        let views = self.views();
        let pictures = names::pictures_of(&names::with_views(&volumes, &views))?;
        let paths = pictures.iter().map(|name| self.output.join(name)).collect();
        let kept = self.check(paths, &volumes, &scene)?;
        let of_view = |((picture, is_kept), &view)| WantedPicture {
            view,
            picture,
            is_kept,
        };
        let pictures = pictures.into_iter().zip(kept);
        let wanted = pictures.zip(views.iter().cycle()).map(of_view);
        let wanted: Vec<WantedPicture> = wanted.collect();

        let progress = Progress::new(self.progress);
        for note in passed_over {
            progress.note(&note);
        }
        let items: Vec<Item> = volumes
            .into_iter()
            .zip(wanted.chunks(views.len()))
            .map(|((input, part), pictures)| Item {
                input,
                part,
                pictures: pictures.to_vec(),
            })
            .collect();
        if !self.output.is_dir() {
            fs::create_dir(&self.output).map_err(|cause| Error::output(&self.output, &cause))?;
        }
        let batch = Batch {
            scene: &scene,
            settings: &settings,
            depth,
            extent_pixels: scene.picture.extent_pixels()?,
            items: &items,
            folder: &self.output,
            options: WriteOptions {
                bit_depth: scene.picture.bit_depth(),
                force: self.force,
            },
            gate,
            progress: &progress,
        };
        let (rows, first_error) = batch.draw()?;
        for note in index::notes_of(&rows) {
            progress.note(&note);
        }
        // What comes last stays last.
        drop(progress);
        let mut index = Index::new();
        rows.into_iter().for_each(|row| index.add(row));
        if let Some(path) = &self.index {
            write_whole(path, index.json().as_bytes(), self.force, gate)?;
        }
        if self.progress != ProgressWord::None {
            say_aside(&index.summary());
        }
        unnamed.or(first_error).map_or(Ok(()), Err)
    }

    /// Every side to stand on; one that no word of --views names where none does.
    fn views(&self) -> Vec<Option<ViewWord>> {
        match &self.views[..] {
            [] => vec![None],
            views => views.iter().copied().map(Some).collect(),
        }
    }

    /// The flags laid over those of `--scene`, with what thumbnails are without a word.
    fn whole_scene(&mut self) -> Result<SceneFlags, Error> {
        if self.scene.input.path.is_some() {
            return Err(Error::usage(
                "--path is not for thumbnails",
                "name volumes and folders: thumbnails scans -o pictures",
            ));
        }
        self.scene.inline_files()?;
        let mut scene = match &self.scene_file {
            Some(path) => scene_file::overlay(scene_file::read(path)?, &self.scene),
            None => self.scene.clone(),
        };
        if !scene.picture.layers().is_empty() {
            return Err(Error::usage(
                "a .png has no room for the layers of --aov",
                "`render` writes a .exr or a .npy",
            ));
        }
        if scene.input.stream {
            return Err(Error::usage(
                "--stream is for one volume: many are drawn from memory, large ones with fewer voxels",
                "`render --stream` draws every voxel of one",
            ));
        }
        let is_again = |(at, view): (usize, &ViewWord)| self.views[..at].contains(view);
        if let Some((_, twice)) = self.views.iter().enumerate().find(|&view| is_again(view)) {
            return Err(Error::usage(
                format!("--views names {} twice", twice.name()),
                "a picture is of one view: name each once",
            ));
        }
        if !self.views.is_empty() {
            if scene.section.section.is_some() {
                return Err(Error::usage(
                    "--views places the camera, and the --section of the --scene looks straight at its plane",
                    "leave out --views, or take a scene without a section",
                ));
            }
            scene.camera.leave_the_side();
        }
        scene.default_to_auto();
        scene.picture.size.get_or_insert(SIZE);
        scene.input.fit = true;
        // Asked for once: what is free while other volumes are there says nothing of how far one must shrink.
        scene.input.max_memory = scene.input.max_memory.or_else(available_bytes);
        Ok(scene)
    }

    /// Which pictures are there and stay. Refuses what cannot be written before any volume is read.
    fn check(
        &self,
        pictures: Vec<PathBuf>,
        inputs: &[(String, Part)],
        scene: &SceneFlags,
    ) -> Result<Vec<bool>, Error> {
        let mut files = scene_file::inputs(scene, self.scene_file.as_deref());
        files.extend(
            inputs
                .iter()
                .map(|(input, _)| PathBuf::from(input))
                .filter(|path| path.is_file()),
        );
        let is_made_later =
            |file: &Path| !self.output.is_dir() && file.parent() == Some(&self.output);
        if let Some(index) = self.index.as_ref().filter(|index| !is_made_later(index)) {
            output::check(
                std::slice::from_ref(index),
                &files,
                self.force || self.resume,
            )?;
        }
        if self.output.is_file() {
            return Err(Error::Output {
                path: self.output.clone(),
                problem: "it is a file, and pictures are written into a folder".to_owned(),
                hint: Some("name a folder: -o pictures"),
            });
        }
        if !self.output.is_dir() {
            output::check(std::slice::from_ref(&self.output), &[], false)?;
            return Ok(vec![false; pictures.len()]);
        }
        let is_there = |path: &Path| path.symlink_metadata().is_ok();
        let there = pictures.iter().filter(|path| is_there(path)).count();
        if there > 0 && !self.force && !self.resume {
            return Err(Error::Output {
                path: self.output.clone(),
                problem: format!("{there} of {} pictures are there", pictures.len()),
                hint: Some("--resume keeps them and draws the others, --force draws all anew"),
            });
        }
        let kept = pictures.iter().map(|path| self.resume && path.is_file());
        let kept: Vec<bool> = kept.collect();
        let drawn = pictures.into_iter().zip(&kept);
        let drawn = drawn.filter(|(_, kept)| !**kept).map(|(path, _)| path);
        // Hundreds of pictures: the first sees the folder, and only what is there needs a closer look.
        for (at, path) in drawn.enumerate() {
            if at == 0 || is_there(&path) {
                output::check(std::slice::from_ref(&path), &files, self.force)?;
            }
        }
        Ok(kept)
    }
}

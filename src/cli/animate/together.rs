//! Several numbers a voxel, volumes or lines beside the first, one time after another: each time is read as `render` reads
//! it, with the colours, windows and seeds of the first; between two times voxels are mixed.

use super::volumes::blend;
use crate::cli::{
    Error,
    flags::{Numbers, SceneFlags},
    flow::{DrawnLines, FilmSeed, FilmTime, Ways},
    load::open_first,
    memory::{DeviceMemory, DeviceRoom},
    progress::Progress,
    scene_inputs::{SceneInputs, limits},
};
use crate::technique::Settings;
use std::path::Path;
use std::sync::Arc;

/// What reading each time takes.
#[derive(Debug)]
pub struct Together {
    scene: SceneFlags,
    settings: Settings,
    memory: Option<DeviceMemory>,
    /// Of the lines of the first time.
    seeds: Vec<FilmSeed>,
    ways: Option<Arc<Ways>>,
    /// Seconds between spheres along them.
    sphere_step: Option<f64>,
}

impl Together {
    /// Of a film whose first time is `first`.
    pub fn new(
        scene: &SceneFlags,
        first: &SceneInputs,
        settings: &Settings,
        memory: Option<DeviceMemory>,
    ) -> Self {
        let mut scene = scene.clone();
        if !first.channels().is_empty() {
            scene.channels.channel = first.channels().to_vec();
            scene.channels.channels.clear();
            scene.input.component = None;
        }
        if let Some(lines) = first.lines().filter(|_| scene.flow.flow.is_some()) {
            scene
                .flow_style
                .flow_range
                .get_or_insert(Numbers(lines.range()));
        }
        Self {
            ways: first.lines().and_then(DrawnLines::ways).cloned(),
            seeds: first
                .lines()
                .map_or(Vec::new(), |lines| lines.seeds().to_vec()),
            sphere_step: first.lines().and_then(DrawnLines::sphere_step),
            scene,
            settings: settings.clone(),
            memory,
        }
    }

    /// All volumes at a time, and the lines of it.
    pub fn at(&self, time: f64) -> Result<SceneInputs, Error> {
        let quiet = Progress::of_part();
        let [before, after] = [time.floor(), time.ceil()].map(|time| time as u32);
        let mut shown = self.whole(before)?;
        if after > before {
            shown = shown.between(self.whole(after)?, time.fract(), |a, b, share| {
                blend(a, b, share).map_err(|problem| Error::Input {
                    path: self
                        .scene
                        .input
                        .file()
                        .map(Path::to_owned)
                        .unwrap_or_default(),
                    problem: problem.to_string(),
                })
            })?;
        }
        let seeds = &self.seeds;
        let ways = self.ways.as_deref();
        let of_film = Some(FilmTime {
            time,
            seeds,
            ways,
            sphere_step: self.sphere_step,
        });
        let mut scene = self.scene.clone();
        scene.input.time = Some(before.to_string());
        shown.with_lines(&scene, of_film, &quiet)
    }

    /// All volumes of a time. What there is to say was said of the first.
    fn whole(&self, time: u32) -> Result<SceneInputs, Error> {
        let quiet = Progress::of_part();
        let mut scene = self.scene.clone();
        scene.input.time = Some(time.to_string());
        let limits = limits(&scene);
        let source = open_first(&mut scene, &limits, &quiet)?;
        let shown = SceneInputs::of(source, &scene, &self.settings, self, &quiet)?;
        Ok(shown.at_level(&scene))
    }
}

impl DeviceRoom for Together {
    fn memory(&self) -> Result<Option<DeviceMemory>, Error> {
        Ok(self.memory)
    }
}

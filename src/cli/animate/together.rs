//! Several numbers a voxel, or volumes beside the first, one time after another: each time is read as `render` reads it,
//! with the colours and windows of the first.

use crate::cli::{
    Error,
    flags::SceneFlags,
    load::open_first,
    memory::{DeviceMemory, DeviceRoom},
    progress::Progress,
    scene_inputs::{SceneInputs, limits},
};
use crate::technique::Settings;

/// What reading each time takes.
#[derive(Debug)]
pub struct Together {
    scene: SceneFlags,
    settings: Settings,
    memory: Option<DeviceMemory>,
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
        Self {
            scene,
            settings: settings.clone(),
            memory,
        }
    }

    /// All volumes of a time. What there is to say was said of the first.
    pub fn at(&self, time: u32) -> Result<SceneInputs, Error> {
        let quiet = Progress::of_part();
        let mut scene = self.scene.clone();
        scene.input.time = Some(time.to_string());
        let limits = limits(&scene);
        let source = open_first(&mut scene, &limits, &quiet)?;
        let shown = SceneInputs::of_source(source, &scene, &self.settings, self, &quiet)?;
        Ok(shown.at_level(&scene))
    }
}

impl DeviceRoom for Together {
    fn memory(&self) -> Result<Option<DeviceMemory>, Error> {
        Ok(self.memory)
    }
}

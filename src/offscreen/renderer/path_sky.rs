//! The picture of the sky on the device, kept from pass to pass.

use crate::gpu::{Buffer, Gpu};
use crate::offscreen::Error;
use crate::offscreen::keyed::Keyed;
use crate::scene::Scene;
use crate::technique::pathtrace::SkyPicture;
use std::sync::Arc;

/// The buffer of the last picture that was asked for.
#[derive(Debug, Default)]
pub struct PathSky(Keyed<SkyPicture, Buffer>);

impl PathSky {
    /// That of the scene; `None` where its sky is even or no paths are traced.
    pub fn of(&mut self, gpu: &Arc<Gpu>, scene: &Scene) -> Result<Option<&Buffer>, Error> {
        let settings = scene.settings;
        let picture = settings.path.sky_picture.as_ref();
        let Some(picture) = picture.filter(|_| settings.technique.traces_paths()) else {
            return Ok(None);
        };
        let made = self.0.of(picture.clone(), |picture| picture.on_device(gpu));
        Ok(made.map(Some)?)
    }
}

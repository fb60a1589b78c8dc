//! The field of scattered points that rays are cast through, sorted and on the device: kept from picture to picture.

use super::Renderer;
use crate::offscreen::Error;
use crate::points::PointField;
use crate::scene::{Beside, Scene};
use crate::technique::field::GpuField;
use crate::technique::{Recording, View};
use std::sync::Arc;

/// Both sides of it.
#[derive(Debug)]
pub(super) struct Field {
    sorted: PointField,
    pub(super) on_device: GpuField,
}

impl Renderer<'_> {
    /// Makes the field of a scene that has one, and says in how many parts its rays are recorded.
    pub(super) fn prepare_field(&mut self, scene: &Scene) -> Result<usize, Error> {
        let gpu = Arc::clone(self.device.gpu());
        if let (Beside::Points(points), Some(kernel)) = (scene.beside, scene.settings.field) {
            let made = |_: &_| -> Result<_, Error> {
                let sorted = PointField::new(points, kernel);
                let on_device = GpuField::new(&gpu, &sorted)?;
                Ok(Field { sorted, on_device })
            };
            self.field.of((points.clone(), kernel), made)?;
        }
        let grid = scene.volume.grid();
        let view = scene.view(&grid, [0.0; 2]);
        Ok(view.field_parts(self.field_samples_at_once(scene, &view)?))
    }

    /// `whole` as it is recorded.
    pub(super) fn field_recordings(
        &self,
        scene: &Scene,
        view: &View,
        mut whole: Recording,
    ) -> Result<Vec<Recording>, Error> {
        let at_once = self.field_samples_at_once(scene, view)?;
        view.tell_field(&self.made().sorted, &mut whole.frame);
        Ok(whole.in_parts(view.field_parts(at_once), at_once))
    }

    fn field_samples_at_once(&self, scene: &Scene, view: &View) -> Result<u32, Error> {
        let functions = scene.transfers().into_iter().flatten();
        let searched = functions.map(|f| f.color.len() + f.opacity.len()).max();
        let most = self.device.gpu().limits().max_loop_turns;
        let sorted = &self.made().sorted;
        Ok(view.field_samples_at_once(sorted, searched.unwrap_or(0), most)?)
    }

    fn made(&self) -> &Field {
        self.field.get().expect("made before anything is recorded")
    }
}

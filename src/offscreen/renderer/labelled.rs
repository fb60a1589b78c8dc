//! Labels over a picture.

use super::{Rendered, Renderer};
use crate::offscreen::Error;
use crate::offscreen::layer_rules::Clock;
use crate::picture::LayerKind;
use crate::scene::{LabelsOver, Scene};

impl Renderer<'_> {
    /// The picture with layers of the volume alone.
    pub(super) fn render_volume(
        &mut self,
        scene: &Scene,
        layers: &[LayerKind],
    ) -> Result<Rendered, Error> {
        scene.check()?;
        let labels = scene.labels_over();
        if labels.is_empty() {
            return self.render_unlabeled(scene, layers);
        }
        let under = scene.under_labels();
        let first = under.volumes().len();
        let mut rendered = self.render_unlabeled(&under, layers)?;
        // Labels lie over the geometry too.
        let behind = self.behind.take();
        let laid = self.lay_labels(scene, first, &mut rendered);
        self.behind = behind;
        laid?;
        Ok(rendered)
    }

    fn lay_labels(
        &mut self,
        scene: &Scene,
        first: usize,
        rendered: &mut Rendered,
    ) -> Result<(), Error> {
        let labels = scene.labels_over();
        let mut clock = Clock(rendered.gpu_ms);
        for (shown, map) in (first..).zip(labels) {
            let Some(over) = LabelsOver::new(scene, map) else {
                continue;
            };
            self.shown = shown;
            let laid = over.lay(scene, map, &mut rendered.picture, |labels| {
                self.upload(labels)?;
                self.picture(labels, &[], &mut clock)
            });
            self.shown = 0;
            laid?;
        }
        rendered.gpu_ms = clock.0;
        Ok(())
    }
}

//! What is visible in any frame of a film: small frames of each, those that look alike drawn once.
//!
//! ```text
//! frames -> distinct (time, function, settings but for camera, light and grain) -> small frames -> one box of pixels
//! ```
//!
//! A frame between two times counts as both: a blend costs as much as the frame itself, and shows what they show.

use super::{draw::Content, ready::Ready, volumes::Volumes};
use crate::{
    camera::{Camera, PixelBox},
    cli::{
        Error,
        flags::SceneFlags,
        flow::DrawnLines,
        progress::Progress,
        renderer::{Device, Job, Renderer},
        scene_inputs::Parts,
    },
    look::{box_of, visible_in},
    volume::Volume,
};
use std::collections::BTreeMap;

/// The frames of a film that differ in more than the camera.
pub struct Union<'a> {
    scene: &'a SceneFlags,
    content: &'a Content,
    /// Frames by the whole time that they show.
    frames: BTreeMap<u32, Vec<&'a Ready>>,
}

impl<'a> Union<'a> {
    /// Of these frames of `content`.
    pub fn new(scene: &'a SceneFlags, content: &'a Content, ready: &'a [Ready]) -> Self {
        let mut frames: BTreeMap<u32, Vec<&Ready>> = BTreeMap::new();
        for ready in ready {
            for time in [ready.time.floor(), ready.time.ceil()] {
                let of_time = frames.entry(time as u32).or_default();
                // What comes back later is drawn again: a film has many frames, and looking for one is no less work.
                if of_time.last().is_none_or(|last| !looks_like(last, ready)) {
                    of_time.push(ready);
                }
            }
        }
        Self {
            scene,
            content,
            frames,
        }
    }

    /// The pixels that each camera sees something in, in any frame; `None` where it sees nothing in all of them.
    pub fn seen(
        &self,
        cameras: &[Camera],
        extent_pixels: [u32; 2],
        devices: &mut Vec<Device>,
        progress: &Progress,
    ) -> Result<Vec<Option<PixelBox>>, Error> {
        let mut seen = vec![None; cameras.len()];
        type Beside<'s> = (&'s Parts<'s>, Option<&'s DrawnLines>);
        let mut draw =
            |volume: &Volume, (parts, lines): Beside, frames: &[&Ready]| -> Result<(), Error> {
                let job = Job {
                    volume,
                    classification: &frames[0].classification,
                    stream: None,
                    beside: parts.beside(),
                    lines,
                    settings: &frames[0].settings,
                    extent_pixels,
                    layers: &[],
                };
                let mut renderer = Renderer::new(job, &cameras[0], devices.remove(0))?;
                for ready in frames {
                    renderer.change(&ready.classification, &ready.settings);
                    for (camera, seen) in cameras.iter().zip(&mut seen) {
                        let found = visible_in(&renderer.draw(camera)?.picture);
                        let found = box_of(&found, extent_pixels[0]);
                        *seen = match (*seen, found) {
                            (Some(a), Some(b)) => Some(PixelBox::union(a, b)),
                            (a, b) => a.or(b),
                        };
                    }
                }
                devices.insert(0, renderer.into_device());
                Ok(())
            };
        match self.content {
            Content::Still(shown) => {
                for frames in self.frames.values() {
                    draw(shown.looked_at(), (&shown.parts(), shown.lines()), frames)?;
                }
            }
            Content::Together(_, together) => {
                for (done, (&time, frames)) in self.frames.iter().enumerate() {
                    progress.stage("prepare", done, self.frames.len());
                    let shown = together.at(time.into())?;
                    draw(shown.looked_at(), (&shown.parts(), shown.lines()), frames)?;
                }
            }
            Content::Times(source, bricks) => {
                let quiet = Progress::of_part();
                let unseen = |_, _: &[&Volume]| Ok(());
                let mut volumes = Volumes::new(source, *bricks, self.scene, &quiet, &unseen);
                let alone = Parts::Channels(Vec::new());
                for (done, (&time, frames)) in self.frames.iter().enumerate() {
                    progress.stage("prepare", done, self.frames.len());
                    let moment = volumes.at(time.into())?;
                    draw(moment.looked_at(), (&alone, None), frames)?;
                }
            }
        }
        Ok(seen)
    }
}

/// True of frames that are opaque in the same places.
fn looks_like(a: &Ready, b: &Ready) -> bool {
    a.classification == b.classification && a.settings == b.settings
}

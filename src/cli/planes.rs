//! Several planes of `--section` in one picture.
//!
//! ```text
//! c columns, r rows      panel = ((W - (c - 1) g) / c, (H - (r - 1) g) / r)      g pixels between two
//! ```
//!
//! All panels have one scale, so that what is as long is as long in each; of the ways to lay them out that is taken which
//! has the largest.

use super::{Error, flags::SceneFlags, scene_inputs::SceneInputs};
use crate::camera::Projection;
use crate::picture::{Layer, Picture};

/// Pixels between two panels.
const GAP: u32 = 4;
/// A panel that is smaller shows nothing.
const LEAST_PIXELS: u32 = 16;

/// The panels of a picture: one, unless its section has several planes.
#[derive(Clone, Debug)]
pub struct Panels {
    /// The flags of each.
    scenes: Vec<SceneFlags>,
    columns: u32,
    /// Pixels of each, and of the picture.
    extent: [u32; 2],
    whole: [u32; 2],
}

impl Panels {
    /// Those of `scene` in a picture of so many pixels.
    pub fn of(scene: &SceneFlags, shown: &SceneInputs, whole: [u32; 2]) -> Result<Self, Error> {
        let sections = scene.section.each();
        let alone = |section| SceneFlags {
            section,
            ..scene.clone()
        };
        if sections.len() < 2 {
            return Ok(Self {
                scenes: vec![scene.clone()],
                columns: 1,
                extent: whole,
                whole,
            });
        }
        let mut scenes: Vec<_> = sections.into_iter().map(alone).collect();
        let count = scenes.len() as u32;
        let layouts = (1..=count).map(|columns| {
            let rows = count.div_ceil(columns);
            let room = |pixels: u32, n: u32| pixels.saturating_sub((n - 1) * GAP) / n;
            (columns, [room(whole[0], columns), room(whole[1], rows)])
        });
        let mut best = None;
        for (columns, extent) in
            layouts.filter(|(_, extent)| extent.iter().all(|&n| n >= LEAST_PIXELS))
        {
            let mut height: f64 = 0.0;
            for scene in &scenes {
                height = height.max(fitted_height(scene, shown, extent)?);
            }
            // World length of a pixel.
            let scale = height / f64::from(extent[1]);
            if best.is_none_or(|(_, _, _, least)| scale < least) {
                best = Some((columns, extent, height, scale));
            }
        }
        let Some((columns, extent, height, _)) = best else {
            return Err(Error::usage(
                format!(
                    "--section of {count} planes: a picture of {} x {} pixels has no room for them",
                    whole[0], whole[1]
                ),
                "--size 1024x768",
            ));
        };
        for scene in &mut scenes {
            scene.camera.view_height.get_or_insert(height);
        }
        Ok(Self {
            scenes,
            columns,
            extent,
            whole,
        })
    }

    /// True where there is more than one.
    pub fn are_several(&self) -> bool {
        self.scenes.len() > 1
    }

    /// The flags of each.
    pub fn scenes(&self) -> &[SceneFlags] {
        &self.scenes
    }

    /// Pixels of each.
    pub fn extent(&self) -> [u32; 2] {
        self.extent
    }

    /// Their pictures in one, row by row, over `background`. One alone stays as it is.
    pub fn together(&self, mut pictures: Vec<Picture>, background: Option<[f64; 4]>) -> Picture {
        if pictures.len() == 1 {
            return pictures.remove(0);
        }
        let [width, height] = self.whole;
        let mut whole = Picture {
            width,
            height,
            pixels: vec![[0.0; 4]; width as usize * height as usize],
            color_space: pictures[0].color_space,
            layers: self.layers(&pictures),
        };
        if let Some(background) = background {
            whole.over_background(background);
        }
        for (i, picture) in pictures.iter().enumerate() {
            self.put(i, &picture.pixels, &mut whole.pixels);
        }
        whole
    }

    /// The layers of all in one; what lies between two is 0.
    fn layers(&self, pictures: &[Picture]) -> Vec<Layer> {
        let pixels = (self.whole[0] * self.whole[1]) as usize;
        let together = |(nth, layer): (usize, &Layer)| {
            let size = layer.values.len() / pictures[0].pixels.len();
            let mut values = vec![0.0; pixels * size];
            for (i, picture) in pictures.iter().enumerate() {
                self.put(i, &picture.layers[nth].values, &mut values);
            }
            Layer {
                kind: layer.kind,
                values,
            }
        };
        pictures[0]
            .layers
            .iter()
            .enumerate()
            .map(together)
            .collect()
    }

    /// Puts the rows of the panel of this number in their place, of a pixel as many numbers as there are.
    fn put<T: Copy>(&self, panel: usize, from: &[T], to: &mut [T]) {
        let ([width, height], i) = (self.extent, panel as u32);
        let left = i % self.columns * (width + GAP);
        let top = i / self.columns * (height + GAP);
        let size = from.len() / (width * height) as usize;
        for (y, row) in (top..).zip(from.chunks(width as usize * size)) {
            let first = (y * self.whole[0] + left) as usize * size;
            to[first..first + row.len()].copy_from_slice(row);
        }
    }
}

/// World height of the view that shows all of a plane.
fn fitted_height(scene: &SceneFlags, shown: &SceneInputs, extent: [u32; 2]) -> Result<f64, Error> {
    let mut settings = Default::default();
    match shown.camera(scene, extent, &mut settings)?.projection {
        Projection::Orthographic { view_height } => Ok(view_height),
        other => unreachable!("a section is seen by parallel rays, not by {other:?}"),
    }
}

//! The passes of shear-warp, in steps, so that no submission takes long.
//!
//! ```text
//! for each band of the intermediate image:
//!     rays      from front to back through all bricks      fill it
//! for each band of the picture:
//!     warp      four base pixels to one                    fills the picture, and what lies beside it
//! ```

use crate::gpu::{Bindings, ComputePipeline, Error, Gpu, Image, Resource, Tile, Use};
use crate::shaders::shader;
use crate::technique::gather::{
    Bound, BrickPass, Canvas, CanvasDesc, Gather, GatherDesc, LAYERS, PICTURE, Part, Player,
    RayPass,
};
use crate::technique::{Inputs, RayBindings, RayTiles, accumulation};
use std::ops::Range;
use std::sync::Arc;

/// What base rays leave, in place of [`PICTURE`] and of [`LAYERS`].
const BASE: usize = 2;
const BASE_LAYERS: usize = 3;

/// The passes of shear-warp.
///
/// # Errors
/// Where the device refuses.
pub(in crate::technique) fn shear_warp(desc: &GatherDesc) -> Result<Box<dyn Gather>, Error> {
    let mode = desc.settings.mode;
    let warp = |name| ComputePipeline::new(desc.gpu, shader(name)).map(Warp);
    Ok(Box::new(ShearWarp(Arc::new(Passes {
        gpu: Arc::clone(desc.gpu),
        rays: RayPass::new(desc.gpu, desc.settings, desc.variant)?,
        picture: match mode.projects_one_place() {
            true => warp("warp.value")?,
            false => warp("warp.mean")?,
        },
        has_layers: !mode.is_projection(),
        layers: warp("warp.mean")?,
    }))))
}

/// From an intermediate image to one of the picture.
#[derive(Debug)]
struct Warp(ComputePipeline);

#[derive(Debug)]
struct Passes {
    gpu: Arc<Gpu>,
    rays: RayPass,
    picture: Warp,
    /// Of what lies beside the picture of rays that composite.
    layers: Warp,
    has_layers: bool,
}

#[derive(Debug)]
struct ShearWarp(Arc<Passes>);

#[derive(Debug)]
struct BoundShearWarp {
    passes: Arc<Passes>,
    bricks: Vec<RayBindings>,
    /// By the image that they fill.
    warps: Vec<(usize, Bindings)>,
}

impl Warp {
    fn bind(
        &self,
        gpu: &Arc<Gpu>,
        ring: Resource,
        base: &Image,
        to: &Image,
    ) -> Result<Bindings, Error> {
        let given = [
            ("frame", ring),
            ("base", Resource::sampled(base)),
            ("picture", Resource::written(to)),
        ];
        Bindings::new(gpu, self.0.layout(), &given)
    }
}

impl Gather for ShearWarp {
    fn canvas(&self, desc: &CanvasDesc) -> Result<Canvas, Error> {
        let (gpu, base) = (&self.0.gpu, desc.intermediate_room);
        let is_kept = self.0.has_layers && desc.keeps_layers;
        // Texels outside of an image are not written: one that nobody reads needs no more than one.
        let kept = |extent| if is_kept { extent } else { [1; 2] };
        let images = [
            accumulation(gpu, desc.extent, "warped")?,
            accumulation(gpu, kept(desc.extent), "beside what is warped")?,
            accumulation(gpu, base, "base rays")?,
            accumulation(gpu, kept(base), "beside base rays")?,
        ];
        let mut canvas = Canvas::new(desc.extent, images);
        let beside = desc.beside.and_then(|canvas| canvas.tiles.clone());
        canvas.tiles = Some(match beside {
            Some(tiles) => tiles,
            None => RayTiles::new(gpu, base)?,
        });
        Ok(canvas)
    }

    fn bind(
        &self,
        canvas: &Canvas,
        bricks: &[Inputs],
        _: Option<Resource>,
    ) -> Result<Box<dyn Bound>, Error> {
        let Passes { gpu, rays, .. } = &*self.0;
        let tiles = canvas.tiles.as_ref().expect("made with the canvas");
        let images = [canvas.image(BASE), canvas.image(BASE_LAYERS)];
        let bind = |inputs| rays.bind(inputs, &images, tiles, None);
        let ring = Resource::Uniform(bricks[0].ring);
        let warp = |warp: &Warp, from, to| {
            let bound = warp.bind(gpu, ring, canvas.image(from), canvas.image(to))?;
            Ok::<_, Error>((to, bound))
        };
        let mut warps = vec![warp(&self.0.picture, BASE, PICTURE)?];
        if self.0.has_layers && canvas.image(LAYERS).extent() == canvas.image(PICTURE).extent() {
            warps.push(warp(&self.0.layers, BASE_LAYERS, LAYERS)?);
        }
        Ok(Box::new(BoundShearWarp {
            bricks: bricks.iter().map(bind).collect::<Result<_, _>>()?,
            warps,
            passes: Arc::clone(&self.0),
        }))
    }
}

/// Rows of a band at most.
const BAND_ROWS: u32 = 32;

/// An image from top to bottom in so many parts, or more where they are high.
#[derive(Clone, Copy)]
struct Bands {
    extent: [u32; 2],
    rows: u32,
}

impl Bands {
    fn new(image: &Image, count: u32) -> Self {
        let extent = extent_of(image);
        let rows = extent[1].div_ceil(count.max(1)).min(BAND_ROWS);
        let rows = rows.next_multiple_of(Tile::STEP);
        Self { extent, rows }
    }

    fn count(&self) -> u64 {
        self.extent[1].div_ceil(self.rows).into()
    }

    /// Those of a range that begins at `first`; `None` where it has none of them.
    fn tile(&self, steps: &Range<u64>, first: u64) -> Option<Tile> {
        let number = |step: u64| step.saturating_sub(first).min(self.count()) as u32;
        let top = number(steps.start) * self.rows;
        let bottom = (number(steps.end) * self.rows).min(self.extent[1]);
        (top < bottom).then(|| Tile {
            origin: [0, top],
            extent: [self.extent[0], bottom - top],
        })
    }
}

fn extent_of(image: &Image) -> [u32; 2] {
    let [width, height, _] = image.extent();
    [width, height]
}

impl Bound for BoundShearWarp {
    fn steps(&self, canvas: &Canvas, _: &[BrickPass], count: u32) -> Option<u64> {
        let of = |image| Bands::new(canvas.image(image), count).count();
        Some(of(BASE) + of(PICTURE))
    }

    unsafe fn record(
        &self,
        player: &mut Player,
        bricks: &[BrickPass],
        part: &Part,
    ) -> Result<(), Error> {
        let [base, picture] =
            [BASE, PICTURE].map(|image| Bands::new(player.image(image), part.bands));
        let cast = base.tile(&part.steps, 0);
        let warped = picture.tile(&part.steps, base.count());
        // SAFETY: the caller's promises.
        unsafe {
            if let Some(tile) = cast {
                player.bring([BASE, BASE_LAYERS].map(|image| (image, Use::ComputeWrite)));
                for brick in bricks {
                    let (bound, offset) = (&self.bricks[brick.number], brick.offset);
                    let rays = &self.passes.rays;
                    rays.record_tiles(player.cmd, bound, offset, base.extent, [tile])?;
                }
            }
            if let Some(tile) = warped {
                let read = [BASE, BASE_LAYERS].map(|image| (image, Use::ComputeSampled));
                let written = [PICTURE, LAYERS].map(|image| (image, Use::ComputeWrite));
                player.bring(read.into_iter().chain(written));
                self.warp(player, bricks[0].offset, tile)?;
            }
            if part.is_last {
                player.bring([PICTURE, LAYERS].map(|image| (image, Use::FragmentSampled)));
            }
        }
        Ok(())
    }
}

impl BoundShearWarp {
    /// # Safety
    /// As [`Bound::record`]; base rays are in [`Use::ComputeSampled`], the picture in [`Use::ComputeWrite`].
    unsafe fn warp(&self, player: &Player, offset: u32, tile: Tile) -> Result<(), Error> {
        for (to, bound) in &self.warps {
            let Warp(pipeline) = match *to {
                PICTURE => &self.passes.picture,
                _ => &self.passes.layers,
            };
            let extent = extent_of(player.image(*to));
            let boxes = [pipeline.groups_of(extent, tile)?];
            // SAFETY: the caller's promises; the bindings were made for this pipeline.
            unsafe { pipeline.dispatch_boxes(player.cmd, bound, &[offset], boxes) };
        }
        Ok(())
    }
}

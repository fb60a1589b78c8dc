//! The passes of rays, whatever their mode.
//!
//! ```text
//! for each brick, from front to back:
//!     search     tiles in which rays may meet something     writes the lists
//!     rays       those tiles                                goes on in picture and layers
//! ```

use super::super::accumulation::accumulations;
use super::super::field;
use super::super::pathtrace::PATH_IMAGES;
use super::super::projection::Projection;
use super::super::raycast::Raycast;
use super::super::{
    Inputs, RayBindings, RayTiles, SampleInputs, Settings, ShaderVariant, accumulation,
};
use super::{Bound, BrickPass, Canvas, CanvasDesc, Gather, GatherDesc, PICTURE, Part, Player};
use crate::gpu::{Error, Gpu, Image, Resource, Tile, Use};
use crate::shaders::Shader;
use ash::vk;
use std::sync::Arc;

/// What compositing rays leave beside the picture: (what the mode keeps, depth or -1, transmittance, samples).
pub(crate) const LAYERS: usize = 1;

/// What paths leave beside theirs, an array of images ([`super::super::pathtrace::images_of`]).
pub(crate) const PATH_LAYERS: usize = 2;

/// The passes of a ray caster.
///
/// # Errors
/// Where the device refuses.
pub(in crate::technique) fn rays(desc: &GatherDesc) -> Result<Box<dyn Gather>, Error> {
    let pass = match desc.settings.field {
        Some(_) => field::pass(desc)?,
        None => RayPass::new(desc.gpu, desc.settings, desc.variant)?,
    };
    Ok(Box::new(Rays::new(desc.gpu, pass)))
}

/// Rays of such a pass.
pub(in crate::technique) fn rays_of(gpu: &Arc<Gpu>, pass: RayPass) -> Box<dyn Gather> {
    Box::new(Rays::new(gpu, pass))
}

/// Rays that find the depth of slices: they take the samples of the slices one after the other
/// ([`super::super::View::each_depth_recording`]). The variant is that of the picture; what lights it has no say.
///
/// # Errors
/// Where the device refuses.
pub(crate) fn depth_of_slices(
    desc: &GatherDesc,
    mix: SampleInputs,
) -> Result<Box<dyn Gather>, Error> {
    let pass = RayPass::along_slices(desc.gpu, desc.settings, desc.variant, mix)?;
    Ok(Box::new(Rays::new(desc.gpu, pass)))
}

#[derive(Debug)]
struct Rays {
    gpu: Arc<Gpu>,
    pass: Arc<RayPass>,
}

#[derive(Debug)]
struct BoundRays {
    pass: Arc<RayPass>,
    bricks: Vec<RayBindings>,
}

impl Rays {
    fn new(gpu: &Arc<Gpu>, pass: RayPass) -> Self {
        Self {
            gpu: Arc::clone(gpu),
            pass: Arc::new(pass),
        }
    }
}

impl Gather for Rays {
    fn canvas(&self, desc: &CanvasDesc) -> Result<Canvas, Error> {
        let picture = accumulation(&self.gpu, desc.extent, "rays")?;
        // Texels outside of an image are not written: one that nobody reads needs no more than one.
        let kept = if desc.keeps_layers {
            desc.extent
        } else {
            [1; 2]
        };
        let mut images = vec![picture];
        match *self.pass {
            RayPass::Raycast(_) => images.push(accumulation(&self.gpu, kept, "beside rays")?),
            RayPass::Projection(_) => {}
            RayPass::Paths(_) => {
                let count = PATH_IMAGES as u32;
                // The search for tiles fills what other rays leave.
                images.push(accumulation(&self.gpu, [1; 2], "beside rays")?);
                images.push(accumulations(&self.gpu, kept, count, "layers of paths")?);
            }
        }
        let mut canvas = Canvas::new(desc.extent, images);
        // What one picture reads of them comes before what the next one writes.
        let beside = desc.beside.and_then(|canvas| canvas.tiles.clone());
        canvas.tiles = Some(match beside {
            Some(tiles) => tiles,
            None => RayTiles::new(&self.gpu, desc.extent)?,
        });
        Ok(canvas)
    }

    fn bind(
        &self,
        canvas: &Canvas,
        bricks: &[Inputs],
        host_depth: Option<Resource>,
    ) -> Result<Box<dyn Bound>, Error> {
        let tiles = canvas.tiles.as_ref().expect("made with the canvas");
        let images: Vec<_> = canvas.images().collect();
        let bind = |inputs| self.pass.bind(inputs, &images, tiles, host_depth);
        Ok(Box::new(BoundRays {
            pass: Arc::clone(&self.pass),
            bricks: bricks.iter().map(bind).collect::<Result<_, _>>()?,
        }))
    }
}

impl Bound for BoundRays {
    unsafe fn record(
        &self,
        player: &mut Player,
        bricks: &[BrickPass],
        part: &Part,
    ) -> Result<(), Error> {
        let (cmd, extent) = (player.cmd, player.canvas.extent());
        let images = PICTURE..=match *self.pass {
            RayPass::Raycast(_) => LAYERS,
            RayPass::Projection(_) => PICTURE,
            RayPass::Paths(_) => PATH_LAYERS,
        };
        // SAFETY: the caller's promises.
        unsafe {
            // The search of each brick waits for all that rays before it have written.
            player.bring(images.clone().map(|image| (image, Use::ComputeWrite)));
            for brick in bricks {
                let seen = |tile: &Tile| match brick.seen {
                    Some(seen) => tile.and(seen),
                    None => Some(*tile),
                };
                let (bound, tiles) = (&self.bricks[brick.number], part.tiles.iter());
                let tiles = tiles.filter_map(seen);
                self.pass
                    .record_tiles(cmd, bound, brick.offset, extent, tiles)?;
            }
            if part.is_last {
                player.bring(images.map(|image| (image, Use::FragmentSampled)));
            }
        }
        Ok(())
    }
}

/// Rays that composite, that project, or that begin paths.
#[derive(Debug)]
pub(in crate::technique) enum RayPass {
    /// Colours, and what lies beside them.
    Raycast(Raycast),
    /// One number a ray, which the resolve classifies.
    Projection(Projection),
    /// Colours, and the layers of paths.
    Paths(Raycast),
}

impl RayPass {
    /// A pass that projects, by a shader that another technique has of its own.
    pub(in crate::technique) fn projection_of(gpu: &Arc<Gpu>, shader: &str) -> Result<Self, Error> {
        Ok(Self::Projection(Projection::of_shader(gpu, shader)?))
    }

    /// The same for one that composites.
    pub(in crate::technique) fn picture_of(gpu: &Arc<Gpu>, shader: &str) -> Result<Self, Error> {
        Ok(Self::Raycast(Raycast::of_shader(gpu, shader)?))
    }

    /// Paths.
    pub(in crate::technique) fn paths(gpu: &Arc<Gpu>, shader: &Shader) -> Result<Self, Error> {
        Ok(Self::Paths(Raycast::of_rays(gpu, shader)?))
    }

    /// Both of what may be seen outside of the box of the volume too.
    pub(in crate::technique) fn projection_everywhere(
        gpu: &Arc<Gpu>,
        shader: &str,
    ) -> Result<Self, Error> {
        Ok(Self::Projection(Projection::everywhere(gpu, shader)?))
    }

    /// See above.
    pub(in crate::technique) fn picture_everywhere(
        gpu: &Arc<Gpu>,
        shader: &str,
    ) -> Result<Self, Error> {
        Ok(Self::Raycast(Raycast::everywhere(gpu, shader)?))
    }

    /// Compiles the variant for the settings.
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        variant: &ShaderVariant,
    ) -> Result<Self, Error> {
        let mode = settings.mode;
        Ok(match mode.is_projection() {
            _ if settings.per_mode.exact_maximum => {
                Self::Projection(Projection::exact(gpu, mode, variant)?)
            }
            true => Self::Projection(Projection::new(gpu, mode, variant)?),
            false => Self::Raycast(Raycast::of_mode(gpu, mode, variant)?),
        })
    }

    fn along_slices(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        variant: &ShaderVariant,
        mix: SampleInputs,
    ) -> Result<Self, Error> {
        let variant = ShaderVariant {
            mix,
            writes_layers: true,
            ..*variant
        };
        let variant = match settings.technique.draws_stacks() {
            true => ShaderVariant {
                lattice: "stack",
                transfer: "table",
                ..variant
            },
            false => ShaderVariant {
                lattice: "planes",
                ..variant
            },
        };
        Self::new(gpu, settings, &variant)
    }

    /// Binds inputs and the images that the rays fill, in the order of the canvas.
    pub fn bind(
        &self,
        inputs: &Inputs,
        images: &[&Image],
        tiles: &RayTiles,
        host_depth: Option<Resource>,
    ) -> Result<RayBindings, Error> {
        // In place of a depth that is not looked at.
        let stand_in = |image: &Image| host_depth.unwrap_or(Resource::sampled_or_read(image));
        let picture = images[PICTURE];
        match self {
            Self::Raycast(pass) => {
                let layers = images[LAYERS];
                pass.bind_behind(inputs, picture, layers, tiles, stand_in(layers))
            }
            Self::Projection(pass) => pass.bind_behind(inputs, picture, tiles, stand_in(picture)),
            Self::Paths(pass) => {
                let layers = images[LAYERS];
                let images = [picture, layers, images[PATH_LAYERS]];
                pass.bind_paths(inputs, images, tiles, stand_in(layers))
            }
        }
    }

    /// # Safety
    /// As [`Raycast::record_tiles`].
    pub unsafe fn record_tiles(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &RayBindings,
        offset: u32,
        extent: [u32; 2],
        tiles: impl IntoIterator<Item = Tile>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe {
            match self {
                Self::Raycast(pass) | Self::Paths(pass) => {
                    pass.record_tiles(cmd, bindings, offset, extent, tiles)
                }
                Self::Projection(pass) => pass.record_tiles(cmd, bindings, offset, extent, tiles),
            }
        }
    }
}

//! The pipelines of one kind of picture.

use super::submission::Submission;
use super::targets::Output;
use crate::gpu::{
    Bindings, Blend, Buffer, Error, Gpu, Image, Load, ParameterRing, Region, Tile, Use,
    begin_rendering_of, end_rendering, image_barrier, image_to_buffer,
};
use crate::resident::GpuTransfer;
use crate::resolve::Resolve;
use crate::technique::blend::Drawn;
use crate::technique::gather::{Gather, GatherDesc};
use crate::technique::splat::Sheets;
use crate::technique::{
    ACCUMULATION_FORMAT, DepthAccess, Mode, Order, Settings, ShaderVariant, Technique,
};
use ash::vk;
use std::cell::OnceCell;
use std::sync::Arc;

/// What pipelines depend on.
pub type Key = (
    Technique,
    Mode,
    Order,
    [bool; 5],
    (Sheets, bool),
    DepthAccess,
    ShaderVariant,
);

/// The key of such pictures; `is_patched`: slicers draw patches of their slices.
pub fn key_of(
    settings: &Settings,
    variant: &ShaderVariant,
    is_patched: bool,
    depth_access: DepthAccess,
) -> Key {
    let Settings {
        technique,
        mode,
        order,
        ..
    } = *settings;
    let per_mode = &settings.per_mode;
    let is_cued = per_mode.depth_cue != 0.0;
    let is_half = settings.is_half_angle();
    let is_field = settings.field.is_some();
    let marks = [
        is_cued,
        per_mode.exact_maximum,
        is_half,
        is_patched,
        is_field,
    ];
    (
        technique,
        mode,
        order,
        marks,
        (settings.splat.sheets, settings.splat.of_points),
        depth_access,
        *variant,
    )
}

/// The pipelines of one kind of picture.
#[derive(Debug)]
pub struct Passes {
    key: Key,
    picture: Box<dyn Gather>,
    /// Counts the samples of a slicer, once that is wanted; the ray caster counts its own.
    count: OnceCell<Box<dyn Gather>>,
    settings: Settings,
    /// Of modes that leave a value; others leave the picture itself.
    resolve: Option<Resolve>,
}

impl Passes {
    /// Whether rays leave what lies beside the picture.
    pub fn writes_layers(&self) -> bool {
        let (.., variant) = &self.key;
        variant.writes_layers
    }

    /// Compiles for such pictures.
    pub fn new(gpu: &Arc<Gpu>, settings: &Settings, key: Key) -> Result<Self, Error> {
        let mode = settings.mode;
        Ok(Self {
            picture: gather(gpu, settings, &key, Drawn::Picture(mode))?,
            count: OnceCell::new(),
            key,
            settings: settings.clone(),
            resolve: match mode.is_projection() {
                false => None,
                true => Some(Resolve::of_settings(
                    gpu,
                    settings,
                    Blend::Replace,
                    ACCUMULATION_FORMAT,
                )?),
            },
        })
    }

    /// What these pipelines were made for.
    pub fn key(&self) -> &Key {
        &self.key
    }

    /// What makes the picture.
    pub fn picture(&self) -> &dyn Gather {
        &*self.picture
    }

    /// What counts the samples of a slicer.
    pub fn count(&self, gpu: &Arc<Gpu>) -> Result<&dyn Gather, Error> {
        if self.count.get().is_none() {
            let made = gather(gpu, &self.settings, &self.key, Drawn::Count)?;
            let _ = self.count.set(made);
        }
        Ok(&**self.count.get().expect("set above"))
    }

    /// Whether a resolve makes the colours of what was gathered.
    pub fn has_resolve(&self) -> bool {
        self.resolve.is_some()
    }

    /// What makes colours of what is gathered in an image, by the parameters at `offset` of the ring, and brings them
    /// back.
    pub fn finish<'a>(
        &'a self,
        gathered: &Image,
        output: &'a Output,
        (ring, offset): (&ParameterRing, u32),
        transfer: Option<&GpuTransfer>,
    ) -> Result<Finish<'a>, Error> {
        let resolve = match (&self.resolve, &output.resolved) {
            (Some(resolve), Some(picture)) => {
                let bindings = resolve.bind(ring, gathered, transfer)?;
                Some((resolve, bindings, picture))
            }
            _ => None,
        };
        Ok(Finish {
            resolve,
            readback: &output.readback,
            offset,
            extent: output.extent,
        })
    }
}

/// From what a technique has gathered to what the host reads.
#[derive(Debug)]
pub struct Finish<'a> {
    /// Of modes that leave a value, with the image of the colours.
    resolve: Option<(&'a Resolve, Bindings, &'a Image)>,
    readback: &'a Buffer,
    offset: u32,
    extent: [u32; 2],
}

impl Finish<'_> {
    /// Records all of it at once.
    ///
    /// # Errors
    /// None but a mistake of ours.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering; what was gathered is in [`Use::FragmentSampled`], in which it is left; all
    /// that is bound lives until it has run.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        gpu: &Gpu,
        gathered: &Image,
    ) -> Result<(), Error> {
        let (image, used) = self.image(gathered);
        let [width, height] = self.extent;
        let region = Region {
            origin: [0; 3],
            extent: [width, height, 1],
        };
        // SAFETY: the caller's promises.
        unsafe {
            self.resolve_tiles(cmd, gpu, &[Tile::whole(self.extent)], true);
            image_barrier(gpu, cmd, image, used, Use::TransferRead);
            image_to_buffer(gpu, cmd, image, region, self.readback, 0)?;
            image_barrier(gpu, cmd, image, Use::TransferRead, used);
        }
        Ok(())
    }

    /// Records the colours of some tiles.
    ///
    /// # Safety
    /// As [`Self::record`].
    unsafe fn resolve_tiles(
        &self,
        cmd: vk::CommandBuffer,
        gpu: &Gpu,
        tiles: &[Tile],
        is_first: bool,
    ) {
        let Some((resolve, bindings, picture)) = &self.resolve else {
            return;
        };
        let target = [(picture.view(), Load::Clear([0.0; 4]))];
        // SAFETY: the caller's promises.
        unsafe {
            if is_first {
                image_barrier(gpu, cmd, picture, Use::Nothing, Use::ColorTarget);
            }
            for &tile in tiles {
                begin_rendering_of(gpu, cmd, &target, tile);
                resolve.record_tile(cmd, bindings, self.offset, self.extent, tile);
                end_rendering(gpu, cmd);
            }
        }
    }

    /// The image of the colours of what was gathered, and the use that it is left in.
    pub fn image<'i>(&'i self, gathered: &'i Image) -> (&'i Image, Use) {
        match &self.resolve {
            Some((.., picture)) => (picture, Use::ColorTarget),
            None => (gathered, Use::FragmentSampled),
        }
    }

    /// Makes the colours in submissions of their own.
    ///
    /// # Errors
    /// A lost device.
    pub fn resolve(&self, submission: Submission) -> Result<(), Error> {
        if self.resolve.is_none() {
            return Ok(());
        }
        let resolved = submission.in_tiles(self.extent, |cmd, gpu, part| {
            // SAFETY: recorded in order; `run` waits, and all that is bound lives meanwhile.
            unsafe { self.resolve_tiles(cmd, gpu, part.tiles, part.is_first) };
            Ok(())
        });
        resolved.map(drop)
    }
}

fn gather(
    gpu: &Arc<Gpu>,
    settings: &Settings,
    key: &Key,
    drawn: Drawn,
) -> Result<Box<dyn Gather>, Error> {
    let (.., [_, _, _, is_patched, _], _, depth_access, variant) = key;
    (settings.technique.desc().gather)(&GatherDesc {
        gpu,
        settings,
        variant,
        drawn,
        depth_access: *depth_access,
        is_patched: *is_patched,
    })
}

//! The passes of half-angle slices, in steps, so that no submission takes long: of each slice first what the eye sees,
//! then what the light sees, each in bands.
//!
//! ```text
//! picture = light buffer = 0
//! for each slice:
//!     eye      reads the light buffer, blends into the picture
//!     light    blends into the light buffer
//! ```

use super::{HalfAngleBindings, HalfAngleSlicer, HalfAngleSlices, light_buffer, light_extent};
use crate::gpu::{Error, Gpu, Load, Resource, Tile, Use};
use crate::technique::gather::{
    Bound, BrickPass, Canvas, CanvasDesc, Gather, GatherDesc, PICTURE, Part, Player,
};
use crate::technique::{Inputs, accumulation};
use std::sync::Arc;

/// What the light sees.
const LIGHT: usize = 1;

/// The passes of half-angle slices.
///
/// # Errors
/// Where the device does not blend R32G32B32A32_SFLOAT, by its name.
pub(in crate::technique) fn half_angle_slices(desc: &GatherDesc) -> Result<Box<dyn Gather>, Error> {
    Ok(Box::new(HalfAngleGather {
        gpu: Arc::clone(desc.gpu),
        slicer: Arc::new(HalfAngleSlicer::new(desc.gpu, desc.variant)?),
    }))
}

#[derive(Debug)]
struct HalfAngleGather {
    gpu: Arc<Gpu>,
    slicer: Arc<HalfAngleSlicer>,
}

#[derive(Debug)]
struct BoundHalfAngle {
    slicer: Arc<HalfAngleSlicer>,
    sets: HalfAngleBindings,
}

impl Gather for HalfAngleGather {
    fn canvas(&self, desc: &CanvasDesc) -> Result<Canvas, Error> {
        let picture = accumulation(&self.gpu, desc.extent, "slices")?;
        let light = light_buffer(&self.gpu, light_extent(desc.dims, desc.extent))?;
        Ok(Canvas::new(desc.extent, [picture, light]))
    }

    fn bind(
        &self,
        canvas: &Canvas,
        bricks: &[Inputs],
        _: Option<Resource>,
    ) -> Result<Box<dyn Bound>, Error> {
        Ok(Box::new(BoundHalfAngle {
            slicer: Arc::clone(&self.slicer),
            sets: self.slicer.bind(&bricks[0], canvas.image(LIGHT))?,
        }))
    }
}

/// A picture from top to bottom in bands.
#[derive(Clone, Copy, Debug)]
struct Bands {
    extent: [u32; 2],
    rows: u32,
}

impl Bands {
    /// So many, as far as the rows of an image go.
    fn new(canvas: &Canvas, image: usize, count: u32) -> Self {
        let [width, height, _] = canvas.image(image).extent();
        Self {
            extent: [width, height],
            rows: height.div_ceil(count.max(1)).max(1),
        }
    }

    fn count(&self) -> u64 {
        self.extent[1].div_ceil(self.rows).into()
    }

    fn tile(&self, number: u64) -> Tile {
        let first = number as u32 * self.rows;
        Tile {
            origin: [0, first],
            extent: [self.extent[0], self.rows.min(self.extent[1] - first)],
        }
    }
}

impl Bound for BoundHalfAngle {
    /// At least one, which clears.
    fn steps(&self, canvas: &Canvas, bricks: &[BrickPass], bands: u32) -> Option<u64> {
        let a_slice = [PICTURE, LIGHT].map(|image| Bands::new(canvas, image, bands).count());
        let steps = a_slice.iter().sum::<u64>() * u64::from(bricks[0].slices);
        Some(steps.max(1))
    }

    unsafe fn record(
        &self,
        player: &mut Player,
        bricks: &[BrickPass],
        part: &Part,
    ) -> Result<(), Error> {
        let [eye, light] = bricks else {
            unreachable!("the eye's recording and the light's");
        };
        let slices = HalfAngleSlices {
            offsets: [eye.offset, light.offset],
            count: eye.slices,
            order: eye.order,
        };
        let [of_eye, of_light] =
            [PICTURE, LIGHT].map(|image| Bands::new(player.canvas, image, part.bands));
        let a_slice = of_eye.count() + of_light.count();
        // SAFETY: the caller's promises.
        unsafe {
            if part.is_first {
                player.bring([PICTURE, LIGHT].map(|image| (image, Use::ColorTarget)));
                for (image, bands) in [(PICTURE, of_eye), (LIGHT, of_light)] {
                    let whole = Tile::whole(bands.extent);
                    player.render((image, Load::Clear([0.0; 4])), None, whole, |_| ());
                }
            }
            for step in part.steps.clone() {
                let (slice, step) = ((step / a_slice) as u32, step % a_slice);
                if slice >= slices.count {
                    break;
                }
                match step.checked_sub(of_eye.count()) {
                    None => {
                        player.bring([(LIGHT, Use::FragmentSampled), (PICTURE, Use::ColorTarget)]);
                        let tile = of_eye.tile(step);
                        player.render((PICTURE, Load::Keep), None, tile, |cmd| {
                            let extent = of_eye.extent;
                            self.slicer
                                .draw_eye(cmd, &self.sets, slices, extent, (slice, tile));
                        });
                    }
                    Some(step) => {
                        player.bring([(LIGHT, Use::ColorTarget)]);
                        let tile = of_light.tile(step);
                        player.render((LIGHT, Load::Keep), None, tile, |cmd| {
                            let extent = of_light.extent;
                            self.slicer
                                .draw_light(cmd, &self.sets, slices, extent, (slice, tile));
                        });
                    }
                }
            }
            if part.is_last {
                player.bring([PICTURE, LIGHT].map(|image| (image, Use::FragmentSampled)));
            }
        }
        Ok(())
    }
}

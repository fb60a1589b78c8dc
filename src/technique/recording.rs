//! From a view to what is recorded for it: one recording a brick, in order.
//!
//! ```text
//! view.recordings(volume, transfer)        pure, once a frame
//!     recording.write(ring, slot)          parameters into the ring; gives the offset to record with
//!     a technique's record(cmd, ...)       with the bindings of recording.brick
//! ```

use super::mixture::{GpuChannel, Role, set_channels};
use super::{Error, Order, View};
use crate::camera::{DepthConvention, HostDepth};
use crate::gpu::{self, Gpu, ParameterRing};
use crate::resident::{
    Cell, Coding, GpuTransfer, GpuVolume, TextureLayout, TransferLayout, sort_front_to_back,
};
use crate::shaders::{Frame, FrameFields};
use glam::DVec3;
use std::sync::Arc;

/// What one recording of a technique shows.
#[derive(Clone, Copy, Debug)]
pub struct Recording {
    /// The brick that the bindings must be of, as an index into [`GpuVolume::bricks`].
    pub brick: usize,
    /// Slices to draw; 0 for compute passes.
    pub slices: u32,
    /// How slices are blended: as the settings say, or for half-angle slices as the light asks for.
    pub order: Order,
    /// The parameters.
    pub frame: Frame,
}

impl Recording {
    /// All of each ray in `count` parts, one after the other, of so many samples, sheets or points each: a part goes on with what
    /// those before have left.
    pub(crate) fn in_parts(self, count: usize, at_once: u32) -> Vec<Self> {
        let part = |number: usize| {
            let mut part = self;
            let first = (number as u32).saturating_mul(at_once);
            part.frame.is_first_brick = u32::from(number == 0);
            part.frame.part_first = first;
            part.frame.part_end = first.saturating_add(at_once).min(i32::MAX as u32);
            part
        };
        (0..count).map(part).collect()
    }
}

/// What bricks are recorded for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// The picture, in the order of its technique.
    Picture,
    /// The depth of slices, from front to back.
    Depth,
}

impl View<'_> {
    /// How the volume must lie in textures for the technique seen from here: 2D slicing changes stacks.
    pub fn texture_layout(&self) -> TextureLayout {
        (self.settings.technique.desc().layout_of)(self)
    }

    /// What is recorded for one picture of `volume`, in the order in which it is recorded: compute passes go
    /// from front to back, slicers as they blend. Of half-angle slices there are two, what the eye sees and what
    /// the light sees.
    ///
    /// # Errors
    /// [`Error::WrongLayout`], [`Error::WrongCoefficients`], [`Error::TooManySamples`],
    /// [`Error::TooManyClipPlanes`], [`Error::NotFor`], [`Error::SlabsTooLong`], [`Error::ShadowsNeedOneBrick`] and
    /// those of [`View::half_angle`].
    pub fn recordings(
        &self,
        volume: &GpuVolume,
        transfer: Option<&GpuTransfer>,
    ) -> Result<Vec<Recording>, Error> {
        self.recordings_of(&[GpuChannel::numbers(volume)], transfer)
    }

    /// The same for several volumes that are put together sample by sample; `transfer` holds a function for each.
    ///
    /// # Errors
    /// Those of [`View::recordings`], [`Error::OtherGrid`], [`Error::FilterAlone`] and [`Error::TooManyChannels`].
    pub fn recordings_of(
        &self,
        parts: &[GpuChannel],
        transfer: Option<&GpuTransfer>,
    ) -> Result<Vec<Recording>, Error> {
        let mut all = Vec::new();
        self.each_brick(parts, transfer, Purpose::Picture, &mut Vec::new(), |one| {
            all.push(one);
            Ok::<_, Error>(())
        })?;
        Ok(all)
    }

    /// The same handed to `each` one after the other. `order` is room to sort bricks in: where it has been given before
    /// for as many, nothing is allocated.
    ///
    /// # Errors
    /// Those of [`View::recordings`] and of `each`.
    pub fn each_recording<E: From<Error>>(
        &self,
        volume: &GpuVolume,
        transfer: Option<&GpuTransfer>,
        order: &mut Vec<usize>,
        each: impl FnMut(Recording) -> Result<(), E>,
    ) -> Result<(), E> {
        let parts = [GpuChannel::numbers(volume)];
        self.each_brick(&parts, transfer, Purpose::Picture, order, each)
    }

    /// What is recorded for the depth of slices (`technique/gather/rays.rs`), which rays find that walk along the
    /// slices from front to back, and end where a composite has become half opaque.
    ///
    /// # Errors
    /// As [`View::each_recording`].
    pub fn each_depth_recording<E: From<Error>>(
        &self,
        volume: &GpuVolume,
        transfer: Option<&GpuTransfer>,
        order: &mut Vec<usize>,
        each: impl FnMut(Recording) -> Result<(), E>,
    ) -> Result<(), E> {
        let parts = [GpuChannel::numbers(volume)];
        self.each_brick(&parts, transfer, Purpose::Depth, order, each)
    }

    fn each_brick<E: From<Error>>(
        &self,
        parts: &[GpuChannel],
        transfer: Option<&GpuTransfer>,
        purpose: Purpose,
        order: &mut Vec<usize>,
        mut each: impl FnMut(Recording) -> Result<(), E>,
    ) -> Result<(), E> {
        let volume = parts.first().ok_or(Error::NoColor { found: 0 })?.volume;
        let mut fields = self.fields_of(volume, parts, transfer)?;
        let bricks = volume.bricks();
        self.check_slabs(bricks.len())?;
        self.settings.check_bricks(bricks.len())?;
        self.settings.check_path_volume(true, bricks.len())?;
        self.settings.check_scattering_volume(true, bricks.len())?;
        if self.settings.is_half_angle() {
            if parts.len() > 1 {
                return Err(Error::NotShadedTogether.into());
            }
            return match bricks.len() {
                1 => self
                    .half_angle_recordings(&fields)?
                    .into_iter()
                    .try_for_each(each),
                bricks => Err(Error::ShadowsNeedOneBrick { bricks }.into()),
            };
        }
        order.clear();
        order.extend(0..bricks.len());
        let eye_cell = self.eye_cell(bricks[0].cell.own.dims());
        sort_front_to_back(order, |i| &bricks[i].cell, eye_cell);
        let settings = self.settings;
        let is_sliced = !settings.technique.casts_rays() && purpose == Purpose::Picture;
        if is_sliced && settings.order == Order::BackToFront {
            order.reverse();
        }
        if purpose == Purpose::Depth {
            fields.termination = 0.5;
        }
        for (nth, &brick) in order.iter().enumerate() {
            let cell = &bricks[brick].cell;
            let mut fields = fields;
            if bricks.len() > 1 {
                self.set_brick(cell, nth == 0, &mut fields);
                fields.is_last_brick = (nth + 1 == bricks.len()).into();
            }
            each(self.recording(brick, Some(cell), fields))?;
        }
        Ok(())
    }

    /// What is recorded for the one brick of `volume`, which is a part of what the picture shows
    /// ([`GpuVolume::brick_of`]): bricks come one after the other, from front to back, and slices as they blend.
    /// `is_first` and `is_last` of those that are drawn.
    ///
    /// # Errors
    /// As [`View::recordings`].
    pub fn recording_of_brick(
        &self,
        volume: &GpuVolume,
        transfer: Option<&GpuTransfer>,
        [is_first, is_last]: [bool; 2],
    ) -> Result<Recording, Error> {
        self.check_slabs(2)?;
        self.settings.check_bricks(2)?;
        self.settings.check_scattering_volume(true, 2)?;
        let mut fields = self.fields_of(volume, &[GpuChannel::numbers(volume)], transfer)?;
        let cell = &volume.bricks()[0].cell;
        self.set_brick(cell, is_first, &mut fields);
        fields.is_last_brick = is_last.into();
        Ok(self.recording(0, Some(cell), fields))
    }

    /// What all bricks have in common.
    fn fields_of(
        &self,
        volume: &GpuVolume,
        parts: &[GpuChannel],
        transfer: Option<&GpuTransfer>,
    ) -> Result<FrameFields, Error> {
        let (wanted, found) = (self.texture_layout(), volume.layout());
        if wanted != found {
            return Err(Error::WrongLayout { wanted, found });
        }
        self.check_coefficients(parts)?;
        let layout = transfer.map_or_else(TransferLayout::default, |t| *t.layout());
        let mut fields = self.fields(&volume.texel().coding, &layout)?;
        set_channels(parts, transfer, &mut fields)?;
        if parts.len() > 1 {
            self.settings.check_mixed()?;
            let ranges = parts
                .iter()
                .map(|part| (part.volume.value_range(), part.role));
            fields.channel_gradient_scale = self.gradient_scales(ranges);
        }
        let is_classified = parts.iter().any(|part| part.role == Role::Material);
        self.settings
            .check_splatted(parts.len() > 1, is_classified)?;
        fields.flat_gradient = self.flat_gradient(volume.value_range());
        self.set_gradients(volume, transfer, &mut fields)?;
        Ok(fields)
    }

    /// The filter reads what the volumes hold.
    fn check_coefficients(&self, parts: &[GpuChannel]) -> Result<(), Error> {
        let filter = self.settings.filter;
        if filter.kernel().is_some() && parts.len() > 1 {
            return Err(Error::FilterAlone { filter });
        }
        let held = parts.iter().map(|part| part.volume.spline());
        match held.into_iter().find(|&found| found != filter.spline()) {
            Some(found) => Err(Error::WrongCoefficients { filter, found }),
            None => Ok(()),
        }
    }

    /// What the CPU references compute: the whole grid at once, values as they are. `flat_gradient` is 0, the range of
    /// the volume is not known here.
    ///
    /// # Errors
    /// As [`View::recordings`].
    pub fn on_cpu(&self) -> Result<Recording, Error> {
        let fields = self.fields(&Coding::PLAIN, &TransferLayout::default())?;
        if self.settings.is_half_angle() {
            return Ok(self.half_angle_recordings(&fields)?[0]);
        }
        Ok(self.recording(0, None, fields))
    }

    /// The same for half-angle slices: what the eye sees and what the light sees.
    ///
    /// # Errors
    /// As [`View::recordings`].
    pub fn half_angle_on_cpu(&self) -> Result<[Recording; 2], Error> {
        let fields = self.fields(&Coding::PLAIN, &TransferLayout::default())?;
        self.half_angle_recordings(&fields)
    }

    fn half_angle_recordings(&self, fields: &FrameFields) -> Result<[Recording; 2], Error> {
        let half = self.half_angle()?;
        let (passes, slices) = half.fields(self, fields);
        Ok(passes.map(|fields| Recording {
            brick: 0,
            slices,
            order: half.order,
            frame: fields.into(),
        }))
    }

    fn recording(&self, brick: usize, cell: Option<&Cell>, mut fields: FrameFields) -> Recording {
        let part = self.part(cell);
        let slices = (self.settings.technique.desc().set_slices)(self, part, &mut fields);
        fields.slice_count = slices;
        Recording {
            brick,
            slices,
            order: self.settings.order,
            frame: fields.into(),
        }
    }
}

impl Recording {
    /// Puts what is recorded behind what a host has drawn, which it reads from an image: rays, and slices with
    /// [`DepthAccess::Sampled`](super::DepthAccess::Sampled), end where that says, and begin at the host's near plane. `center` is that
    /// of the [grid](crate::volume::Grid::center), and the view's camera the one that came with `depth`
    /// ([`Camera::from_matrices`](crate::camera::Camera::from_matrices)).
    pub fn behind(&mut self, depth: &HostDepth, center: DVec3) {
        self.in_depths_of(depth, center);
        self.frame.has_host_depth = 1;
    }

    /// Draws slices in the depths of a host's clip space, for its depth attachment to be tested
    /// ([`DepthAccess::Tested`](super::DepthAccess::Tested)).
    pub fn tested_in(&mut self, depth: &HostDepth, center: DVec3) {
        self.in_depths_of(depth, center);
        self.frame.clip_from_world[2] = self.frame.host_z;
        self.frame.clip_from_world[3] = self.frame.host_w;
    }

    /// The same for a copy of the host's depth, in which the larger depth is the nearer one
    /// (`host_depth_copy.rs`).
    pub(crate) fn tested_in_copy(&mut self, depth: &HostDepth, center: DVec3) {
        let HostDepth { z, w, nearer } = *depth;
        let is_flipped = nearer == DepthConvention::Standard;
        let copied = HostDepth {
            z: if is_flipped { w - z } else { z },
            w,
            nearer: DepthConvention::Reversed,
        };
        self.tested_in(&copied, center);
        self.frame.flips_host_depth = is_flipped.into();
    }

    /// Tells what is recorded the depths of a host's clip space, in which a resolve writes depth.
    pub fn in_depths_of(&mut self, depth: &HostDepth, center: DVec3) {
        let HostDepth { z, w, nearer } = depth.centered(center);
        let [z, w] = [z, w].map(|row| row.as_vec4().to_array());
        self.frame.host_z = z;
        self.frame.host_w = w;
        self.frame.host_near = nearer.near() as f32;
    }

    /// Writes the parameters into a slot that no unfinished recording reads, and gives its offset.
    ///
    /// # Errors
    /// Where the ring has no such slot.
    pub fn write(&self, ring: &ParameterRing, slot: u32) -> Result<u32, gpu::Error> {
        ring.write(slot, bytemuck::bytes_of(&self.frame))?;
        ring.offset(slot)
    }
}

/// A ring for the parameters of `slots` recordings: bricks times views times frames in flight.
///
/// # Errors
/// Where the device gives no memory.
pub fn parameter_ring(gpu: &Arc<Gpu>, slots: u32) -> Result<ParameterRing, gpu::Error> {
    ParameterRing::new(gpu, size_of::<Frame>() as u32, slots, "frame parameters")
}

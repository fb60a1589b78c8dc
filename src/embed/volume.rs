//! A volume on a host's device, as the technique of a class reads it.

use super::Error;
use super::renderer_desc::what;
use super::updates::Updates;
use super::upload::Upload;
use crate::gpu::Gpu;
use crate::resident::{
    FootprintTexels, GpuVolume, Halo, MacroCells, Texels, TextureLayout, VolumePlan,
};
use crate::shaders::CELL_VOXELS;
use crate::technique::{FilterBy, GradientSource, GradientStorage, SampleInputs, Settings, View};
use crate::volume::{self, Coefficients, Grid, Rescale, VoxelType};
use std::sync::Arc;

/// A volume's textures, what is known of its empty space, and its voxels on their way there. Several renderers may
/// share it.
#[derive(Debug)]
pub struct Volume {
    grid: Grid,
    value_range: [f64; 2],
    pub(super) stored: VoxelType,
    pub(super) rescale: Rescale,
    /// One, or a stack along each axis.
    copies: Vec<GpuVolume>,
    /// Of the copy that rays read, and how far around a cell was looked.
    cells: Option<(MacroCells, Halo)>,
    pub(super) upload: Upload,
    pub(super) updates: Arc<Updates>,
}

impl Volume {
    /// Textures for `voxels`, and a staging buffer that holds them: one texture, or the three stacks of 2D slicing.
    ///
    /// # Errors
    /// Where the device gives no memory; [`Error::NotEmbedded`] for gradients that are to be kept; a
    /// [`Limit`](crate::gpu::Error::Limit) where what [`Volume::plan`] says is more than is left of the host's budget
    /// ([`Gpu::set_memory_budget`]), before anything is made.
    pub fn new(
        gpu: &Arc<Gpu>,
        voxels: &volume::Volume,
        settings: &Settings,
    ) -> Result<Self, Error> {
        if settings.gradient_storage == GradientStorage::Precomputed {
            return Err(Error::NotEmbedded {
                what: "a volume with kept gradients",
                hint: "take `GradientStorage::OnTheFly`, or `resident::KeptGradients` and record them",
            });
        }
        let stored = voxels.voxels.voxel_type();
        let has_holes = voxels.validity.is_some();
        let plan = Self::plan(gpu, voxels.dims, stored, has_holes, settings)?;
        let bytes = plan.device_bytes.saturating_add(plan.staging_bytes);
        gpu.check_budget(
            || format!("make a volume of {:?} voxels", voxels.dims),
            bytes,
        )?;
        let (mut copies, mut upload) = (Vec::new(), Upload::default());
        for &layout in settings.technique.desc().layouts {
            let copy = copy(gpu, voxels, settings, layout, &mut upload)?;
            copies.push(copy);
        }
        let mut made = Self {
            grid: voxels.grid(),
            value_range: voxels.value_range,
            stored,
            rescale: voxels.rescale,
            copies,
            cells: None,
            upload,
            updates: Arc::default(),
        };
        made.keep_corners(gpu, voxels, settings)?;
        if settings.technique.casts_rays() && settings.skip {
            made.know_empty_space(gpu, voxels, settings)?;
        }
        Ok(made)
    }

    /// What such a volume will take, told before its voxels are read: textures, what is known of empty space, and the
    /// buffer that it is staged in until its upload has run; without what the driver pads each of them by.
    ///
    /// # Errors
    /// Where not even a voxel fits the limits of the device.
    pub fn plan(
        gpu: &Gpu,
        dims: [u32; 3],
        stored: VoxelType,
        has_holes: bool,
        settings: &Settings,
    ) -> Result<VolumePlan, Error> {
        let mut all = VolumePlan {
            device_bytes: 0,
            staging_bytes: 0,
            bricks: 0,
        };
        for &layout in settings.technique.desc().layouts {
            let spline = settings.filter.spline();
            let values = spline.map_or(stored, |_| VoxelType::F32);
            let beside = settings.gradient_source_beside(layout);
            let beside = beside.filter(|_| settings.shading.is_some());
            let beside = beside.map(|source| source.spline().map_or(stored, |_| VoxelType::F32));
            for stored in [Some(values), beside].into_iter().flatten() {
                let one = VolumePlan::of(gpu, dims, stored, has_holes, layout)?;
                all.device_bytes += one.device_bytes;
                all.staging_bytes += one.staging_bytes;
                all.bricks = all.bricks.max(one.bricks);
            }
        }
        let is_raycast = settings.technique.casts_rays();
        let is_one = all.bricks == 1;
        if is_one && wants_corners(gpu, stored, dims, settings) {
            all.device_bytes += FootprintTexels::bytes_of(stored, dims).unwrap_or_default();
        }
        if is_raycast && settings.skip {
            let side = u64::from(CELL_VOXELS);
            let cells = dims
                .map(|n| u64::from(n).div_ceil(side))
                .iter()
                .product::<u64>();
            all.device_bytes += MacroCells::BYTES_PER_CELL * cells;
        }
        Ok(all)
    }

    /// Footprint texels, for pictures that read them.
    fn keep_corners(
        &mut self,
        gpu: &Arc<Gpu>,
        voxels: &volume::Volume,
        settings: &Settings,
    ) -> Result<(), Error> {
        let copy = &mut self.copies[0];
        let stored = voxels.voxels.voxel_type();
        if copy.bricks().len() == 1
            && wants_corners(gpu, stored, voxels.dims, settings)
            && let Some(corners) = FootprintTexels::new(gpu, voxels)?
        {
            copy.keep_corners(corners);
        }
        Ok(())
    }

    /// Macro cells, for pictures that leave out what cannot be seen.
    fn know_empty_space(
        &mut self,
        gpu: &Arc<Gpu>,
        voxels: &volume::Volume,
        settings: &Settings,
    ) -> Result<(), Error> {
        let copy = &self.copies[0];
        let halo = cells_halo(settings);
        let cells = match gpu.is_cpu() && copy.spline().is_none() {
            true => MacroCells::of_voxels(gpu, copy, halo, voxels)?,
            false => MacroCells::new(gpu, copy, halo)?,
        };
        self.cells = Some((cells, halo));
        Ok(())
    }

    /// Where its voxels lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Smallest and largest valid value.
    pub fn value_range(&self) -> [f64; 2] {
        self.value_range
    }

    /// The copy that lies so; `None` where there is none.
    pub fn copy(&self, layout: TextureLayout) -> Option<&GpuVolume> {
        self.copies.iter().find(|copy| copy.layout() == layout)
    }

    pub(super) fn copies(&self) -> &[GpuVolume] {
        &self.copies
    }

    /// All that is staged by itself: copies, and what their gradients are made of.
    pub(super) fn textures(&self) -> impl Iterator<Item = &GpuVolume> {
        let copies = self.copies.iter();
        copies.flat_map(|copy| [Some(copy), copy.gradient_source()].into_iter().flatten())
    }

    pub(super) fn cells(&self) -> Option<&MacroCells> {
        self.cells.as_ref().map(|(cells, _)| cells)
    }

    /// Whether the cells know of all voxels that samples of `view` touch.
    pub(super) fn knows_enough_for(&self, view: &View) -> bool {
        let cells = self.cells.as_ref().zip(view.halo());
        cells.is_some_and(|((_, known), wanted)| known.covers(wanted))
    }

    /// As on devices that do not compute on the CPU, before the upload.
    #[cfg(test)]
    pub(super) fn find_cells_on_device(&mut self, gpu: &Arc<Gpu>) -> Result<(), Error> {
        if let Some((cells, halo)) = &mut self.cells {
            *cells = MacroCells::new(gpu, &self.copies[0], *halo)?;
        }
        Ok(())
    }

    /// Whether it lies on that device, and its cells know what such a filter looks at.
    pub(super) fn check(&self, gpu: &Arc<Gpu>, settings: &Settings) -> Result<(), Error> {
        if !self.copies.iter().all(|copy| Arc::ptr_eq(copy.gpu(), gpu)) {
            return Err(Error::OtherDescription {
                made: "one device".into(),
                wanted: "a volume on another".into(),
            });
        }
        match &self.cells {
            Some((_, halo)) if *halo != cells_halo(settings) => Err(Error::OtherDescription {
                made: "a volume for another filter".into(),
                wanted: what(settings),
            }),
            _ => Ok(()),
        }
    }
}

/// What cells are to know of. Slabs reach farther than the filter, and how far depends on the camera too: where a voxel
/// is not enough, nothing is left out of the picture.
fn cells_halo(settings: &Settings) -> Halo {
    let halo = settings.halo();
    Halo {
        voxels: halo.voxels + u32::from(settings.preintegrated),
        ..halo
    }
}

/// Whether corners pay for such a volume, where it is one brick.
fn wants_corners(gpu: &Gpu, stored: VoxelType, dims: [u32; 3], settings: &Settings) -> bool {
    let is_wanted = settings.filter_by == FilterBy::Fetch || gpu.has_slow_sampler();
    is_wanted
        && settings.filter.spline().is_none()
        && settings.reads_footprint_texels(SampleInputs::Scalar)
        && FootprintTexels::are_for_such(gpu, stored, dims)
}

/// One copy of the volume, with what fills it: voxels or coefficients, and what gradients are made of beside.
fn copy(
    gpu: &Arc<Gpu>,
    voxels: &volume::Volume,
    settings: &Settings,
    layout: TextureLayout,
    upload: &mut Upload,
) -> Result<GpuVolume, Error> {
    let spline = settings.filter.spline();
    let values = spline.map(|spline| Coefficients::new(voxels, spline, layout.filtered_axes()));
    let values = values.as_ref().map(Texels::Coefficients);
    let values = values.unwrap_or(Texels::Voxels(voxels));
    let source = settings.gradient_source_beside(layout);
    let source = source.filter(|_| settings.shading.is_some());
    let of_spline = source.and_then(GradientSource::spline);
    let beside = of_spline.map(|spline| Coefficients::new(voxels, spline, [true; 3]));
    let beside = beside.as_ref().map(Texels::Coefficients);
    let beside = beside.unwrap_or(Texels::Voxels(voxels));
    let made = match (source, values) {
        (Some(_), _) => GpuVolume::with_gradient_source(gpu, values, beside, layout)?,
        (None, Texels::Voxels(voxels)) => GpuVolume::new(gpu, voxels, layout)?,
        (None, Texels::Coefficients(values)) => GpuVolume::of_coefficients(gpu, values, layout)?,
    };
    upload.stage(&made, values.volume())?;
    if let Some(source) = made.gradient_source() {
        upload.stage(source, beside.volume())?;
    }
    Ok(made)
}

//! A volume on the device: bricks of 3D textures, or of stacks of 2D textures along one axis.
//!
//! The classic 2D way keeps three copies, one a stack: layer s is slice s of axis k, axis (k + 1) mod 3 runs
//! across and axis (k + 2) mod 3 down.

use super::TexelFormat;
use super::blue_noise::BlueNoiseTexture;
use super::bricks::Cell;
use super::classified_runs::ClassifiedRuns;
use super::footprint_texels::FootprintTexels;
use super::gradients::KeptGradients;
use super::plan::Plan;
use crate::gpu::{Error, Gpu, Image, ImageKind, Sampler};
use crate::volume::{Coefficients, Grid, Spline, Volume, VoxelBox};
use std::sync::Arc;

/// How voxels lie in textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureLayout {
    /// For ray casting, projection and view-aligned slices.
    Texture3d,
    /// For 2D texture slicing along this axis.
    Stack(usize),
}

impl TextureLayout {
    /// The grid axes that run across, down and in depth (or through the layers) of the textures.
    pub(super) fn axes(self) -> [usize; 3] {
        match self {
            Self::Texture3d => [0, 1, 2],
            Self::Stack(axis) => [(axis + 1) % 3, (axis + 2) % 3, axis],
        }
    }

    pub(super) fn kind(self) -> ImageKind {
        match self {
            Self::Texture3d => ImageKind::D3,
            Self::Stack(_) => ImageKind::D2Array,
        }
    }

    /// The axes along which filters mix voxels: in a stack not from slice to slice.
    pub fn filtered_axes(self) -> [bool; 3] {
        std::array::from_fn(|k| self != Self::Stack(k))
    }

    /// Voxels on either side that a sample of a brick may need: two for the widest filter, the cubic, one more for
    /// the differences that make its gradient. Across the slices of a stack two do: a sample between two slices, and its
    /// gradient one slice on.
    pub(super) fn halo(self) -> [u32; 3] {
        self.filtered_axes()
            .map(|is_filtered| if is_filtered { 3 } else { 2 })
    }
}

/// A part of a volume that fits the device.
#[derive(Debug)]
pub struct Brick {
    /// Where it lies.
    pub cell: Cell,
    /// The texels of all stored voxels, in [`crate::gpu::Use::Sampled`] after an upload.
    pub values: Image,
    /// 1 = valid; `None` where all voxels of the volume are.
    pub validity: Option<Image>,
}

/// A volume. Its textures are made empty; [`GpuVolume::record_upload`] fills them.
#[derive(Debug)]
pub struct GpuVolume {
    gpu: Arc<Gpu>,
    grid: Grid,
    layout: TextureLayout,
    texel: TexelFormat,
    value_range: [f64; 2],
    /// The voxels that uploads bring: those of the whole grid, or of a part of it.
    pub(super) held: VoxelBox,
    bricks: Vec<Brick>,
    sampler: Sampler,
    spline: Option<Spline>,
    gradient_source: Option<Box<GpuVolume>>,
    kept_gradients: Option<KeptGradients>,
    pub(super) corners: Option<FootprintTexels>,
    runs: Option<ClassifiedRuns>,
    /// Bound in the place of a mask where every voxel has a value, and of a host's depth buffer where there is none. Nobody
    /// looks at their texels.
    pub(super) no_mask: Image,
    pub(super) no_depth: Image,
    pub(super) blue_noise: BlueNoiseTexture,
    /// Whether the values lie in the textures, and not in corners or runs alone.
    pub(super) has_texels: bool,
}

/// What a texture holds.
#[derive(Clone, Copy, Debug)]
pub enum Texels<'a> {
    /// The voxels of a volume.
    Voxels(&'a Volume),
    /// The coefficients of a spline in their place.
    Coefficients(&'a Coefficients),
}

impl<'a> Texels<'a> {
    /// What uploads take.
    pub fn volume(self) -> &'a Volume {
        match self {
            Self::Voxels(volume) => volume,
            Self::Coefficients(coefficients) => coefficients.volume(),
        }
    }

    fn spline(self) -> Option<Spline> {
        match self {
            Self::Voxels(_) => None,
            Self::Coefficients(coefficients) => Some(coefficients.spline()),
        }
    }
}

/// What a volume is of which one brick is there at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whole {
    /// Where all of its voxels lie.
    pub grid: Grid,
    /// Smallest and largest valid value of all.
    pub value_range: [f64; 2],
    /// True where some voxel of some brick has no value.
    pub has_holes: bool,
}

impl Plan {
    fn make(self, gpu: &Arc<Gpu>, volume: &Volume, cells: &[Cell]) -> Result<GpuVolume, Error> {
        self.make_with(gpu, volume, cells, true)
    }

    /// Without texels the texture is a single one, which nobody looks at.
    fn make_with(
        self,
        gpu: &Arc<Gpu>,
        volume: &Volume,
        cells: &[Cell],
        has_texels: bool,
    ) -> Result<GpuVolume, Error> {
        let brick = |&cell: &Cell| {
            let stored = cell.stored.dims();
            let mask = || Image::new(gpu, &self.validity(stored));
            let texels = if has_texels { stored } else { [1; 3] };
            Ok(Brick {
                cell,
                values: Image::new(gpu, &self.values(texels))?,
                validity: self.has_holes.then(mask).transpose()?,
            })
        };
        let grid = volume.grid();
        Ok(GpuVolume {
            gpu: Arc::clone(gpu),
            no_mask: Image::new(gpu, &self.validity([1; 3]))?,
            no_depth: Image::new(gpu, &self.no_depth())?,
            blue_noise: BlueNoiseTexture::new(gpu)?,
            layout: self.layout,
            texel: self.texel,
            value_range: volume.value_range,
            held: VoxelBox {
                min: [0; 3],
                max: grid.dims,
            },
            grid,
            bricks: cells.iter().map(brick).collect::<Result<_, Error>>()?,
            sampler: Sampler::linear_clamp(gpu)?,
            spline: None,
            gradient_source: None,
            kept_gradients: None,
            corners: None,
            runs: None,
            has_texels,
        })
    }
}

impl GpuVolume {
    /// Objects for a volume like this one: one brick where the device's limits allow it.
    ///
    /// # Errors
    /// Where the device gives no memory, or not even a voxel fits.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume, layout: TextureLayout) -> Result<Self, Error> {
        let mut made = Self::several(gpu, &[volume], layout)?;
        Ok(made.swap_remove(0))
    }

    /// Objects for the coefficients of a volume's spline, which `Filter::Quadratic` and `Filter::Cubic` read in place
    /// of its voxels. Uploads then take [`Coefficients::volume`].
    ///
    /// ```rust,no_run
    /// # use std::sync::Arc;
    /// # use stratavox::{gpu::{Error, Gpu}, resident::{GpuVolume, TextureLayout}};
    /// # use stratavox::volume::{Coefficients, Spline, Volume};
    /// # fn made(gpu: &Arc<Gpu>, volume: &Volume) -> Result<GpuVolume, Error> {
    /// let layout = TextureLayout::Texture3d;
    /// let coefficients = Coefficients::new(volume, Spline::Cubic, layout.filtered_axes());
    /// let made = GpuVolume::of_coefficients(gpu, &coefficients, layout)?;
    /// let staging = made.stage(coefficients.volume())?;
    /// # Ok(made)
    /// # }
    /// ```
    ///
    /// # Errors
    /// As [`GpuVolume::new`].
    ///
    /// # Panics
    /// Where they are not coefficients along [`TextureLayout::filtered_axes`].
    pub fn of_coefficients(
        gpu: &Arc<Gpu>,
        coefficients: &Coefficients,
        layout: TextureLayout,
    ) -> Result<Self, Error> {
        assert_eq!(
            coefficients.axes(),
            layout.filtered_axes(),
            "axes of {layout:?}"
        );
        let made = Self::new(gpu, coefficients.volume(), layout)?;
        Ok(Self {
            spline: Some(coefficients.spline()),
            ..made
        })
    }

    /// Objects for `values` and, beside them and cut into the same bricks, for what gradients are made of
    /// ([`Settings::gradient_source_beside`](crate::technique::Settings::gradient_source_beside)). It has uploads of
    /// its own: [`GpuVolume::gradient_source`].
    ///
    /// # Errors
    /// As [`GpuVolume::new`].
    ///
    /// # Panics
    /// Where coefficients are not those along [`TextureLayout::filtered_axes`], or for gradients those along all axes.
    pub fn with_gradient_source(
        gpu: &Arc<Gpu>,
        values: Texels,
        source: Texels,
        layout: TextureLayout,
    ) -> Result<Self, Error> {
        for (texels, axes) in [(values, layout.filtered_axes()), (source, [true; 3])] {
            if let Texels::Coefficients(coefficients) = texels {
                assert_eq!(coefficients.axes(), axes, "axes in {layout:?}");
            }
        }
        let plan = Plan::of(gpu, values.volume(), layout);
        // The mask beside the values is that of both.
        let beside = Plan {
            has_holes: false,
            ..Plan::of(gpu, source.volume(), layout)
        };
        let cells = Plan::cut(gpu, &[&plan, &beside], values.volume().dims)?;
        let source = Self {
            spline: source.spline(),
            ..beside.make(gpu, source.volume(), &cells)?
        };
        Ok(Self {
            spline: values.spline(),
            gradient_source: Some(Box::new(source)),
            ..plan.make(gpu, values.volume(), &cells)?
        })
    }

    /// Objects for volumes of the same dims, all cut into the same bricks, so that they can be put together
    /// sample by sample.
    ///
    /// # Errors
    /// As [`GpuVolume::new`].
    pub fn several(
        gpu: &Arc<Gpu>,
        volumes: &[&Volume],
        layout: TextureLayout,
    ) -> Result<Vec<Self>, Error> {
        let plans: Vec<_> = volumes.iter().map(|v| Plan::of(gpu, v, layout)).collect();
        let dims = volumes.first().map_or([1; 3], |volume| volume.dims);
        let cells = Plan::cut(gpu, &plans.iter().collect::<Vec<_>>(), dims)?;
        let made = volumes.iter().zip(plans);
        made.map(|(volume, plan)| plan.make(gpu, volume, &cells))
            .collect()
    }

    /// Objects for a volume whose values lie in its corners alone. Only what reads nothing else may be drawn of it
    /// ([`Settings::reads_footprint_texels_alone`](crate::technique::Settings::reads_footprint_texels_alone)).
    ///
    /// # Errors
    /// As [`GpuVolume::new`].
    pub(crate) fn of_corners(
        gpu: &Arc<Gpu>,
        volume: &Volume,
        corners: FootprintTexels,
    ) -> Result<Self, Error> {
        let plan = Plan::of(gpu, volume, TextureLayout::Texture3d);
        Ok(Self {
            corners: Some(corners),
            ..plan.make_with(gpu, volume, &[Cell::whole(volume.dims)], false)?
        })
    }

    /// Objects for classified voxels (red, green and blue times depth, and depth) whose values lie in the runs of the first
    /// alone, with where they have data. Only pictures whose shaders read runs may be drawn of them.
    ///
    /// # Errors
    /// As [`GpuVolume::new`].
    pub(crate) fn of_runs(
        gpu: &Arc<Gpu>,
        volumes: [&Volume; 4],
        runs: ClassifiedRuns,
    ) -> Result<Vec<Self>, Error> {
        let made = |(number, volume): (usize, &Volume)| {
            let all = Plan::of(gpu, volume, TextureLayout::Texture3d);
            // They all have data where the first one has.
            let plan = Plan {
                has_holes: all.has_holes && number == 0,
                ..all
            };
            plan.make_with(gpu, volume, &[Cell::whole(volume.dims)], false)
        };
        let made = volumes.into_iter().enumerate().map(made);
        let mut made = made.collect::<Result<Vec<_>, _>>()?;
        made[0].runs = Some(runs);
        Ok(made)
    }

    /// Objects for one brick of a volume that is not all there: `voxels` are those of `cell.stored`. Uploads take them
    /// too.
    ///
    /// # Errors
    /// Where the device gives no memory, or the brick is over a limit.
    ///
    /// # Panics
    /// Where there are not as many voxels as the brick stores.
    pub fn brick_of(
        gpu: &Arc<Gpu>,
        whole: &Whole,
        cell: Cell,
        voxels: &Volume,
    ) -> Result<Self, Error> {
        assert_eq!(voxels.dims, cell.stored.dims(), "voxels of a brick");
        let plan = Plan {
            has_holes: whole.has_holes,
            ..Plan::of(gpu, voxels, TextureLayout::Texture3d)
        };
        plan.check(gpu, cell.stored.dims())?;
        Ok(Self {
            grid: whole.grid,
            value_range: whole.value_range,
            held: cell.stored,
            ..plan.make(gpu, voxels, &[cell])?
        })
    }

    /// Where the voxels lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The spline that it holds the coefficients of; `None` for voxels.
    pub fn spline(&self) -> Option<Spline> {
        self.spline
    }

    /// Puts gradients that were made of it, and recorded, in the place of what they were made of beside it.
    pub fn keep_gradients(&mut self, kept: KeptGradients) {
        self.gradient_source = None;
        self.kept_gradients = Some(kept);
    }

    /// Gradients that are read in place of being made.
    pub fn kept_gradients(&self) -> Option<&KeptGradients> {
        self.kept_gradients.as_ref()
    }

    /// What gradients are made of, where that is something else than the values.
    pub fn gradient_source(&self) -> Option<&Self> {
        self.gradient_source.as_deref()
    }

    /// How they lie in the textures.
    pub fn layout(&self) -> TextureLayout {
        self.layout
    }

    /// What texels mean.
    pub fn texel(&self) -> &TexelFormat {
        &self.texel
    }

    /// Smallest and largest valid value.
    pub fn value_range(&self) -> [f64; 2] {
        self.value_range
    }

    /// At least one.
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    /// The runs of this volume and the three beside it, where they lie in runs.
    pub fn runs(&self) -> Option<&ClassifiedRuns> {
        self.runs.as_ref()
    }

    /// Whether there are textures to read its values from.
    pub(crate) fn has_texels(&self) -> bool {
        self.has_texels
    }

    /// True where some voxels have no value.
    pub fn has_holes(&self) -> bool {
        self.bricks.iter().any(|brick| brick.validity.is_some())
    }

    /// What is bound in the place of a mask where every voxel has a value.
    pub(crate) fn no_mask(&self) -> &Image {
        &self.no_mask
    }

    /// What is bound in the place of a host's depth buffer where there is none.
    pub(crate) fn no_depth(&self) -> &Image {
        &self.no_depth
    }

    /// Where the steps of jittered rays begin.
    pub(crate) fn blue_noise(&self) -> &Image {
        self.blue_noise.image()
    }

    /// How textures are read between texels.
    pub fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    pub(crate) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }
}

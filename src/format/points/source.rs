//! A file of points, and the volume that stands for them where one is asked for.

use super::gathered::{Finished, Gathered};
use super::quantity::without_unit;
use crate::format::problem::{at, escape, invalid};
use crate::format::request::wanted_count;
use crate::points::Points;
use crate::points::interpolate::Interpolation;
use crate::volume::{
    Format, Grid, Header, Limits, Piece, Problem, ReadError, Source, TimeComponent, VoxelBox,
    VoxelType, Voxels,
};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Scattered points out of a file. As a [`Source`] it is the volume of means of [`Points::binned`], whose voxels without
/// a point are NaN, or that of [`Self::interpolated`].
#[derive(Debug)]
pub struct PointFile {
    path: PathBuf,
    pub(super) header: Header,
    pub(super) notes: Vec<String>,
    pub(super) points: Arc<Points>,
    pub(super) voxels: OnceLock<Vec<f32>>,
    /// What these are made of when they are first wanted; `None`: they are there.
    pub(super) on_grid: Option<(Interpolation, Grid)>,
    max_bytes: u64,
}

/// What a person should know of the volume.
const OF_VOLUME: &str =
    "this is the volume of their means: a voxel has the mean of the points in it, or no data";

/// What the numbers of points are called.
#[derive(Debug)]
pub(super) struct Names {
    /// Of the value.
    pub value: String,
    /// Of others that could be it.
    pub others: Vec<String>,
    /// What a person should know of the file.
    pub notes: Vec<String>,
}

impl PointFile {
    pub(super) fn new(
        path: &Path,
        format: Format,
        gathered: Gathered,
        names: Names,
        limits: &Limits,
    ) -> Result<Self, ReadError> {
        let Finished {
            points,
            world,
            notes,
        } = gathered.finish().map_err(at(path))?;
        let volume = points.binned();
        let mut voxels = match volume.voxels {
            Voxels::F32(voxels) => voxels,
            _ => Vec::new(),
        };
        for (voxel, valid) in voxels.iter_mut().zip(volume.validity.iter().flatten()) {
            if *valid == 0 {
                *voxel = f32::NAN;
            }
        }
        let mut header = Header::new(format, volume.dims, VoxelType::F32, volume.world_from_voxel);
        check_volume(&header, voxels.len()).map_err(at(path))?;
        let (name, unit) = without_unit(&names.value);
        header.long_name = (!name.is_empty()).then(|| name.to_owned());
        header.unit = unit.map(|unit| unit.word().to_owned());
        header.is_earth = world.is_earth;
        header.degree_lengths = world.degree_lengths;
        header.length_metres = world.length_metres;
        if !names.value.is_empty() {
            let value = format!("the value of a point is {}", escape(&names.value));
            header.notes.push(value);
            header.variables.push(names.value);
            header.variables.extend(names.others);
        }
        let all = [names.notes, notes, world.notes];
        header.notes.extend(all.into_iter().flatten());
        let notes = header.notes.clone();
        header.notes.push(OF_VOLUME.to_owned());
        Ok(Self {
            path: path.to_owned(),
            header,
            notes,
            points: Arc::new(points),
            voxels: OnceLock::from(voxels),
            on_grid: None,
            max_bytes: limits.max_bytes,
        })
    }

    /// What a person should know of the points; [`Header::notes`] has also what that volume is.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    fn voxels(&self, watch: &(dyn Fn(f64) + Sync)) -> &[f32] {
        self.voxels.get_or_init(|| match &self.on_grid {
            Some((field, grid)) => field.values_watched(grid, watch),
            None => Vec::new(),
        })
    }

    /// The points.
    pub fn points(&self) -> &Arc<Points> {
        &self.points
    }
}

/// The volume is ours: should it be none all the same, that is an error and no wrong volume.
fn check_volume(header: &Header, found: usize) -> Result<(), Problem> {
    let affine = header.world_from_voxel;
    let determinant = affine.matrix3.determinant();
    let is_volume = u64::try_from(found) == Ok(header.voxel_count())
        && found > 0
        && affine.is_finite()
        && determinant.is_normal()
        && affine.inverse().is_finite();
    if is_volume {
        return Ok(());
    }
    let wanted = "points that span a volume";
    let found = format!("{:?} voxels", header.dims);
    Err(invalid(header.format.name(), "points", wanted, &found))
}

impl Source for PointFile {
    fn path(&self) -> &Path {
        &self.path
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn prepare(&self, watch: &(dyn Fn(f64) + Sync)) {
        self.voxels(watch);
    }

    fn reads_whole_rows(&self) -> bool {
        true
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let format = self.header.format.name();
        let count = wanted_count(format, &self.header, pick, region, self.max_bytes)
            .map_err(at(&self.path))?;
        let size = |n: u32| usize::try_from(n).unwrap_or(usize::MAX);
        let [nx, ny, _] = self.header.dims.map(size);
        let ([x0, y0, z0], [x1, y1, z1]) = (region.min.map(size), region.max.map(size));
        let all = self.voxels(&|_| {});
        let mut voxels = Vec::with_capacity(count);
        for z in z0..z1 {
            for y in y0..y1 {
                let row = z.saturating_mul(ny).saturating_add(y).saturating_mul(nx);
                let wanted = row.saturating_add(x0)..row.saturating_add(x1);
                voxels.extend_from_slice(all.get(wanted).unwrap_or_default());
            }
        }
        Ok(Piece::from(Voxels::F32(voxels)))
    }
}

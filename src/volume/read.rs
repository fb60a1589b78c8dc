//! From a source to memory: sizes checked first, holes filled, the value range found.

use super::voxels::{Stored, with_numbers};
use super::{
    Header, Limits, Piece, PrecisionLoss, Problem, ReadError, Rescale, Source, TimeComponent,
    Volume, VoxelBox, Voxels, holes,
};
use glam::{DAffine3, DVec3};

impl Volume {
    /// One box of one time and component of `source`.
    ///
    /// # Errors
    /// Where `pick` or `region` lie outside the header, where the voxels (or the filling of their holes)
    /// need more than `limits.max_bytes`, and whatever the source itself meets.
    pub fn read(
        source: &dyn Source,
        pick: TimeComponent,
        region: VoxelBox,
        limits: &Limits,
    ) -> Result<Self, ReadError> {
        let header = source.header();
        let failed = |problem| ReadError {
            path: source.path().to_owned(),
            problem,
        };
        check_inside(header, pick, region).map_err(failed)?;
        check_memory(header, region, limits).map_err(failed)?;
        let Piece { voxels, loss } = source.read(pick, region)?;
        let corner = DVec3::from_array(region.min.map(f64::from));
        let grid = Grid {
            dims: region.dims(),
            world_from_voxel: header.world_from_voxel * DAffine3::from_translation(corner),
            rescale: header.rescale,
            fill: header.fill,
            hounsfield: header.hounsfield,
            unit: header.unit.clone(),
            loss,
        };
        let format = header.format.name();
        finish(grid, voxels, format, limits).map_err(failed)
    }

    /// A volume of voxels that are in memory already.
    ///
    /// # Errors
    /// Where there are not as many voxels as `dims` say, an axis has none, or the affine cannot be inverted.
    pub fn from_voxels(
        dims: [u32; 3],
        world_from_voxel: DAffine3,
        voxels: Voxels,
        rescale: Rescale,
        fill: Option<f64>,
    ) -> Result<Self, Problem> {
        let determinant = world_from_voxel.matrix3.determinant();
        if !world_from_voxel.is_finite() || !determinant.is_normal() {
            return Err(invalid(
                "memory",
                "world_from_voxel",
                "an invertible transform",
                determinant,
            ));
        }
        if !(rescale.slope.is_normal() && rescale.intercept.is_finite()) {
            return Err(invalid(
                "memory",
                "rescale",
                "a finite slope that is not zero",
                rescale.slope,
            ));
        }
        let grid = Grid {
            dims,
            world_from_voxel,
            rescale,
            fill,
            hounsfield: false,
            unit: None,
            loss: PrecisionLoss::default(),
        };
        let limits = Limits {
            max_bytes: u64::MAX,
            ..Limits::default()
        };
        finish(grid, voxels, "memory", &limits)
    }
}

/// All of a volume but its voxels.
struct Grid {
    dims: [u32; 3],
    world_from_voxel: DAffine3,
    rescale: Rescale,
    fill: Option<f64>,
    hounsfield: bool,
    unit: Option<String>,
    loss: PrecisionLoss,
}

fn finish(
    grid: Grid,
    mut voxels: Voxels,
    format: &'static str,
    limits: &Limits,
) -> Result<Volume, Problem> {
    let bytes_each = voxels.voxel_type().bytes() as u64;
    let wanted = voxel_count(grid.dims);
    if wanted != voxels.len() as u64 || voxels.is_empty() {
        return Err(Problem::Size {
            format,
            wanted_bytes: wanted.saturating_mul(bytes_each),
            found_bytes: voxels.len() as u64 * bytes_each,
        });
    }
    let validity = holes::validity(&voxels, grid.fill);
    if let Some(validity) = &validity {
        let bytes = wanted.saturating_mul(bytes_each + holes::BYTES_PER_VOXEL);
        within(limits, "the volume with its voxels without data", bytes)?;
        holes::fill(&mut voxels, validity, grid.dims);
    }
    let any_valid = validity.as_ref().is_none_or(|mask| mask.contains(&1));
    Ok(Volume {
        dims: grid.dims,
        world_from_voxel: grid.world_from_voxel,
        // Holes hold numbers of valid voxels, so the range of all is the range of the valid.
        value_range: if any_valid {
            value_range(&voxels, grid.rescale)
        } else {
            [0.0; 2]
        },
        voxels,
        rescale: grid.rescale,
        validity,
        hounsfield: grid.hounsfield,
        unit: grid.unit,
        loss: grid.loss,
    })
}

fn value_range(voxels: &Voxels, rescale: Rescale) -> [f64; 2] {
    let [low, high] = with_numbers!(voxels, numbers => stored_range(numbers))
        .map(|stored| f64::from(stored) * rescale.slope + rescale.intercept);
    [low.min(high), low.max(high)]
}

/// Of finite numbers, at least one. Lanes side by side: the compiler makes vectors of them.
fn stored_range<T: Stored>(numbers: &[T]) -> [f32; 2] {
    const LANES: usize = 64;
    let (blocks, rest) = numbers.as_chunks::<LANES>();
    let (mut low, mut high) = ([numbers[0]; LANES], [numbers[0]; LANES]);
    for block in blocks {
        for lane in 0..LANES {
            let x = block[lane];
            low[lane] = if x < low[lane] { x } else { low[lane] };
            high[lane] = if x > high[lane] { x } else { high[lane] };
        }
    }
    let ends = low.iter().chain(&high).chain(rest);
    ends.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| {
        [low.min(x.to_f32()), high.max(x.to_f32())]
    })
}

/// An error where the voxels of `region` take more memory than allowed.
pub(super) fn check_memory(
    header: &Header,
    region: VoxelBox,
    limits: &Limits,
) -> Result<(), Problem> {
    // What is not kept exactly has become f32.
    let bytes_each = if header.stored.is_kept_exactly() {
        header.stored.bytes()
    } else {
        4
    };
    let bytes = voxel_count(region.dims()).saturating_mul(bytes_each as u64);
    within(limits, "the volume", bytes)
}

fn within(limits: &Limits, what: &str, wanted_bytes: u64) -> Result<(), Problem> {
    if wanted_bytes <= limits.max_bytes {
        return Ok(());
    }
    Err(Problem::Limit {
        what: what.into(),
        wanted_bytes,
        limit_bytes: limits.max_bytes,
    })
}

fn check_inside(header: &Header, pick: TimeComponent, region: VoxelBox) -> Result<(), Problem> {
    let format = header.format.name();
    let under = |field, found: u32, count: u32| {
        if found < count {
            return Ok(());
        }
        Err(invalid(format, field, format!("0 to {}", count - 1), found))
    };
    under("time", pick.time, header.times)?;
    under("component", pick.component, header.components)?;
    let inside = (0..3).all(|k| region.min[k] < region.max[k] && region.max[k] <= header.dims[k]);
    if inside {
        return Ok(());
    }
    let wanted = format!("a box inside {:?}", header.dims);
    let found = format!("{:?} to {:?}", region.min, region.max);
    Err(invalid(format, "region", wanted, found))
}

fn invalid(
    format: &'static str,
    field: &str,
    wanted: impl ToString,
    found: impl ToString,
) -> Problem {
    Problem::Invalid {
        format,
        field: field.into(),
        wanted: wanted.to_string(),
        found: found.to_string(),
    }
}

/// Stops at the largest u64, which no limit allows.
fn voxel_count(dims: [u32; 3]) -> u64 {
    dims.iter()
        .fold(1, |count: u64, &n| count.saturating_mul(n.into()))
}

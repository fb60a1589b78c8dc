//! A [`Source`] over an array whose dimensions stand in any order.

use super::missing::Missing;
use super::model::{Arrays, Variable};
use crate::format::convert::{bytes_in_memory, to_u64};
use crate::format::problem::at;
use crate::volume::{
    Header, Piece, PrecisionLoss, Problem, ReadError, Source, TimeComponent, VoxelBox, VoxelType,
    Voxels,
};
use std::path::Path;
use std::sync::Arc;

/// What a dimension of the array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// 0, 1, 2 for x, y, z.
    Space(usize),
    Time,
    Component,
    /// Always this index.
    Fixed(u64),
}

/// The voxels as they are stored.
pub(crate) struct Grid {
    pub arrays: Arc<dyn Arrays>,
    pub variable: Variable,
    /// One for each dimension of the variable.
    pub roles: Vec<Role>,
    pub header: Header,
    /// The type that numbers are read as.
    pub read_as: VoxelType,
    pub missing: Missing,
    pub max_bytes: u64,
}

/// Bytes that are read, and put in order, at once: what a read takes beside the voxels it gives.
pub(super) const SLAB_BYTES: u64 = 32 << 20;

/// An error where a pick or a box lies outside the header, or a box needs more memory than allowed.
pub(super) fn check(
    header: &Header,
    pick: TimeComponent,
    region: VoxelBox,
    max_bytes: u64,
) -> Result<(), Problem> {
    let inside = region
        .min
        .iter()
        .zip(&region.max)
        .zip(&header.dims)
        .all(|((min, max), size)| min < max && max <= size);
    if !inside || pick.time >= header.times || pick.component >= header.components {
        return Err(Problem::Invalid {
            format: header.format.name(),
            field: "box".to_owned(),
            wanted: format!(
                "a box inside {:?}, a time below {}, a component below {}",
                header.dims, header.times, header.components
            ),
            found: format!("{:?} to {:?}, {pick:?}", region.min, region.max),
        });
    }
    let sides = region.min.iter().zip(&region.max);
    let bytes = sides
        .map(|(min, max)| u64::from(max.saturating_sub(*min)))
        .fold(to_u64(bytes_in_memory(header.stored)), u64::saturating_mul);
    if bytes > max_bytes {
        return Err(Problem::Limit {
            what: "the volume".to_owned(),
            wanted_bytes: bytes,
            limit_bytes: max_bytes,
        });
    }
    Ok(())
}

impl Grid {
    /// An error where no file of so many bytes can hold so many numbers.
    pub(crate) fn new_checked(self, file_bytes: u64) -> Result<Self, Problem> {
        /// Deflate makes at most 1032 bytes of one.
        const MOST_EXPANSION: u64 = 1100;
        let number_bytes = to_u64(self.read_as.bytes());
        let wanted_bytes = self.variable.count().saturating_mul(number_bytes);
        if wanted_bytes > file_bytes.saturating_mul(MOST_EXPANSION) {
            return Err(Problem::TooFewEncoded {
                format: self.arrays.format(),
                encoding: "array",
                wanted_bytes,
                encoded_bytes: file_bytes,
            });
        }
        Ok(self)
    }

    /// Where a slab begins and how many numbers it has, for each dimension.
    fn slab(&self, pick: TimeComponent, slab: VoxelBox) -> (Vec<u64>, Vec<u64>) {
        let place = |role: &Role| match *role {
            Role::Space(k) => {
                let min = slab.min.get(k).copied().unwrap_or(0);
                let max = slab.max.get(k).copied().unwrap_or(1);
                (u64::from(min), u64::from(max.saturating_sub(min)))
            }
            Role::Time => (pick.time.into(), 1),
            Role::Component => (pick.component.into(), 1),
            Role::Fixed(index) => (index, 1),
        };
        self.roles.iter().map(place).unzip()
    }

    /// How many numbers lie between neighbours along x, y, z in a slab with so many numbers for each dimension.
    fn strides(&self, counts: &[u64]) -> [u64; 3] {
        let mut strides = [0; 3];
        let mut stride = 1_u64;
        for (role, count) in self.roles.iter().zip(counts).rev() {
            if let Role::Space(k) = *role
                && let Some(place) = strides.get_mut(k)
            {
                *place = stride;
            }
            stride = stride.saturating_mul(*count);
        }
        strides
    }

    fn read_checked(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, Problem> {
        let [nx, ny, nz] = region.dims();
        let layer_bytes = u64::from(nx)
            .saturating_mul(ny.into())
            .saturating_mul(to_u64(self.read_as.bytes()));
        let layers = SLAB_BYTES.checked_div(layer_bytes).unwrap_or(1).max(1);
        let layers = u32::try_from(layers).unwrap_or(u32::MAX).min(nz);
        let mut whole: Option<Voxels> = None;
        let mut loss = PrecisionLoss::default();
        let mut z = region.min[2];
        while z < region.max[2] {
            let end = z.saturating_add(layers).min(region.max[2]);
            let slab = VoxelBox {
                min: [region.min[0], region.min[1], z],
                max: [region.max[0], region.max[1], end],
            };
            let (start, count) = self.slab(pick, slab);
            let mut piece = self
                .arrays
                .read(&self.variable, &start, &count, self.read_as)?;
            let wanted = count.iter().copied().fold(1, u64::saturating_mul);
            if to_u64(piece.voxels.len()) != wanted {
                let bytes = to_u64(self.read_as.bytes());
                return Err(Problem::Size {
                    format: self.arrays.format(),
                    wanted_bytes: wanted.saturating_mul(bytes),
                    found_bytes: to_u64(piece.voxels.len()).saturating_mul(bytes),
                });
            }
            self.missing.unify(&mut piece.voxels);
            loss = loss.and(piece.loss);
            let dims = slab.dims();
            let strides = self.strides(&count);
            let row = u64::from(dims[0]);
            let in_order = [1, row, row.saturating_mul(dims[1].into())];
            let is_in_order =
                (0..3).all(|k| dims.get(k) == Some(&1) || strides.get(k) == in_order.get(k));
            match &mut whole {
                None if is_in_order && layers == nz => whole = Some(piece.voxels),
                _ => append(&mut whole, &piece.voxels, dims, strides, region.dims())?,
            }
            z = end;
        }
        let voxels = whole.unwrap_or(Voxels::U8(Vec::new()));
        Ok(Piece { voxels, loss })
    }
}

/// Appends a slab, x fastest, to voxels that will be a box of `whole_dims`.
fn append(
    whole: &mut Option<Voxels>,
    slab: &Voxels,
    dims: [u32; 3],
    strides: [u64; 3],
    whole_dims: [u32; 3],
) -> Result<(), Problem> {
    let wanted = whole_dims.iter().map(|&n| u64::from(n));
    let wanted = usize::try_from(wanted.fold(1, u64::saturating_mul)).unwrap_or(usize::MAX);
    let no_room = |_| Problem::Limit {
        what: "the voxels".to_owned(),
        wanted_bytes: to_u64(wanted).saturating_mul(to_u64(slab.voxel_type().bytes())),
        limit_bytes: 0,
    };
    macro_rules! append {
        ($kind:ident, $numbers:expr) => {{
            if whole.is_none() {
                let mut room = Vec::new();
                room.try_reserve_exact(wanted).map_err(no_room)?;
                *whole = Some(Voxels::$kind(room));
            }
            if let Some(Voxels::$kind(out)) = whole {
                for z in 0..u64::from(dims[2]) {
                    for y in 0..u64::from(dims[1]) {
                        let row = z
                            .saturating_mul(strides[2])
                            .saturating_add(y.saturating_mul(strides[1]));
                        let row = usize::try_from(row).unwrap_or(usize::MAX);
                        let step = usize::try_from(strides[0]).unwrap_or(usize::MAX).max(1);
                        let count = usize::try_from(dims[0]).unwrap_or(0);
                        let rest = $numbers.get(row..).unwrap_or(&[]);
                        out.extend(rest.iter().step_by(step).take(count).copied());
                    }
                }
            }
        }};
    }
    match slab {
        Voxels::U8(numbers) => append!(U8, numbers),
        Voxels::I8(numbers) => append!(I8, numbers),
        Voxels::U16(numbers) => append!(U16, numbers),
        Voxels::I16(numbers) => append!(I16, numbers),
        Voxels::F16(numbers) => append!(F16, numbers),
        Voxels::F32(numbers) => append!(F32, numbers),
    }
    Ok(())
}

impl Source for Grid {
    fn path(&self) -> &Path {
        self.arrays.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        check(&self.header, pick, region, self.max_bytes).map_err(at(self.path()))?;
        self.read_checked(pick, region).map_err(at(self.path()))
    }
}

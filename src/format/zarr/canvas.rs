//! Voxels that chunks are put into, in any order: byte order, and rounding to f32 where a type has no room.

use super::ZARR;
use crate::format::convert::{Endian, round, round_float};
use crate::volume::{Piece, PrecisionLoss, Problem, VoxelType, Voxels};
use half::f16;

/// Voxels, all of them the fill value at first.
pub(super) struct Canvas {
    stored: VoxelType,
    endian: Endian,
    voxels: Voxels,
    loss: PrecisionLoss,
    /// What rounding cost the fill value, and how many voxels still hold it.
    fill_loss: PrecisionLoss,
    unset: u64,
}

/// A box of numbers to be moved: along each axis how many, and how far apart here and there.
#[derive(Clone, Debug, Default)]
pub(super) struct Move {
    pub axes: Vec<MoveAxis>,
    /// Index of the first number in the chunk and in the voxels.
    pub from: usize,
    pub to: usize,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct MoveAxis {
    pub count: usize,
    pub from_stride: usize,
    pub to_stride: usize,
}

impl Canvas {
    /// `count` voxels that hold the one number of `fill`.
    pub(super) fn new(
        stored: VoxelType,
        endian: Endian,
        fill: &Piece,
        count: usize,
    ) -> Result<Self, Problem> {
        macro_rules! filled {
            ($kind:ident, $fill:expr) => {{
                let mut all = Vec::new();
                let number = $fill.first().copied().unwrap_or_default();
                all.try_reserve_exact(count).map_err(|_| Problem::Limit {
                    what: "the voxels".to_owned(),
                    wanted_bytes: crate::format::convert::to_u64(count),
                    limit_bytes: 0,
                })?;
                all.resize(count, number);
                Voxels::$kind(all)
            }};
        }
        let voxels = match &fill.voxels {
            Voxels::U8(fill) => filled!(U8, fill),
            Voxels::I8(fill) => filled!(I8, fill),
            Voxels::U16(fill) => filled!(U16, fill),
            Voxels::I16(fill) => filled!(I16, fill),
            Voxels::F16(fill) => filled!(F16, fill),
            Voxels::F32(fill) => filled!(F32, fill),
        };
        Ok(Self {
            stored,
            endian,
            voxels,
            loss: PrecisionLoss::default(),
            fill_loss: fill.loss,
            unset: crate::format::convert::to_u64(count),
        })
    }

    /// Puts numbers of a chunk where they belong. No voxel is put twice.
    pub(super) fn put(&mut self, chunk: &[u8], wanted: &Move) -> Result<(), Problem> {
        let mut axes: Vec<MoveAxis> = wanted.axes.clone();
        axes.sort_by_key(|axis| axis.to_stride);
        axes.retain(|axis| axis.count != 1);
        let row = match axes.is_empty() {
            true => MoveAxis {
                count: 1,
                from_stride: 1,
                to_stride: 1,
            },
            false => axes.remove(0),
        };
        let mut here: Vec<usize> = vec![0; axes.len()];
        loop {
            let (mut from, mut to) = (wanted.from, wanted.to);
            for (axis, here) in axes.iter().zip(&here) {
                from = from.saturating_add(here.saturating_mul(axis.from_stride));
                to = to.saturating_add(here.saturating_mul(axis.to_stride));
            }
            let put = self.put_row(chunk, from, to, row);
            if put != row.count {
                return Err(Problem::Size {
                    format: ZARR,
                    wanted_bytes: crate::format::convert::to_u64(row.count),
                    found_bytes: crate::format::convert::to_u64(put),
                });
            }
            let put = crate::format::convert::to_u64(put);
            self.unset = self.unset.saturating_sub(put);
            let mut is_done = true;
            for (axis, here) in axes.iter().zip(&mut here) {
                *here = here.saturating_add(1);
                if *here < axis.count {
                    is_done = false;
                    break;
                }
                *here = 0;
            }
            if is_done {
                return Ok(());
            }
        }
    }

    /// Numbers that lie in a row; gives how many there were.
    fn put_row(&mut self, chunk: &[u8], from: usize, to: usize, row: MoveAxis) -> usize {
        let big = self.endian == Endian::Big;
        let loss = &mut self.loss;
        // One arm a type: the compiler makes each a tight loop.
        macro_rules! put {
            ($out:expr, $number:ty, $keep:expr) => {{
                const BYTES: usize = size_of::<$number>();
                let read = |bytes: &[u8; BYTES]| {
                    if big {
                        <$number>::from_be_bytes(*bytes)
                    } else {
                        <$number>::from_le_bytes(*bytes)
                    }
                };
                let numbers = chunk.as_chunks::<BYTES>().0.get(from..).unwrap_or(&[]);
                let places = $out.get_mut(to..).unwrap_or(&mut []);
                let mut put = 0_usize;
                if row.from_stride == 1 && row.to_stride == 1 {
                    for (to, from) in places.iter_mut().zip(numbers).take(row.count) {
                        *to = $keep(read(from));
                        put = put.saturating_add(1);
                    }
                } else {
                    let places = places.iter_mut().step_by(row.to_stride.max(1));
                    let numbers = numbers.iter().step_by(row.from_stride.max(1));
                    for (to, from) in places.zip(numbers).take(row.count) {
                        *to = $keep(read(from));
                        put = put.saturating_add(1);
                    }
                }
                put
            }};
        }
        match (&mut self.voxels, self.stored) {
            (Voxels::U8(out), _) => put!(out, u8, |x| x),
            (Voxels::I8(out), _) => put!(out, i8, |x| x),
            (Voxels::U16(out), _) => put!(out, u16, |x| x),
            (Voxels::I16(out), _) => put!(out, i16, |x| x),
            (Voxels::F16(out), _) => put!(out, f16, |x| x),
            (Voxels::F32(out), VoxelType::U32) => {
                put!(out, u32, |x: u32| round_float(x.into(), loss))
            }
            (Voxels::F32(out), VoxelType::I32) => {
                put!(out, i32, |x: i32| round_float(x.into(), loss))
            }
            (Voxels::F32(out), VoxelType::U64) => put!(out, u64, |x: u64| round(x.into(), loss)),
            (Voxels::F32(out), VoxelType::I64) => put!(out, i64, |x: i64| round(x.into(), loss)),
            (Voxels::F32(out), VoxelType::F64) => put!(out, f64, |x| round_float(x, loss)),
            (Voxels::F32(out), _) => put!(out, f32, |x| x),
        }
    }

    pub(super) fn finish(self) -> Piece {
        let filled = PrecisionLoss {
            changed: self.fill_loss.changed.saturating_mul(self.unset),
            worst: match self.unset {
                0 => 0.0,
                _ => self.fill_loss.worst,
            },
        };
        Piece {
            voxels: self.voxels,
            loss: self.loss.and(filled),
        }
    }
}

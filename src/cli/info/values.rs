//! What the values of a volume look like, from slabs of it: no more than the voxels that are looked at stay.

use crate::{
    look::context,
    transfer::{Choice, Quantity, ValueSummary},
    volume::{Header, Limits, ReadError, Source, TimeComponent, Voxels, slices_of_slab},
};
use glam::DVec3;
use std::ops::ControlFlow;

/// What the values of one time and component are taken for under `--look auto`; `None` where there are none.
pub fn choice(
    source: &dyn Source,
    pick: TimeComponent,
    limits: &Limits,
) -> Result<Option<Choice>, ReadError> {
    let header = source.header();
    let count = header.voxel_count() as usize;
    let mut seen = Seen::new(header, count);
    let slices = slices_of_slab(header, limits.max_bytes);
    source.read_slabs(pick, header.whole(), slices, &mut |_, piece| {
        seen.add(&piece.voxels);
        ControlFlow::Continue(())
    })?;
    let range = seen.range;
    if range[0] > range[1] {
        return Ok(None);
    }
    let [x, y, z] = header.dims.map(f64::from);
    let diagonal = header
        .world_from_voxel
        .transform_vector3(DVec3::new(x, y, z));
    let summary = ValueSummary::of(count, range, diagonal.length(), header.hounsfield, |i| {
        seen.value(i)
    })
    .measuring(Quantity::of_unit(header.unit.as_deref()));
    Ok(Some(context(header).choice(&summary)))
}

/// The range of all values, and those that a summary looks at.
struct Seen<'a> {
    header: &'a Header,
    /// As numbers were rounded on their way here, so is the fill.
    fill: Option<f32>,
    stride: usize,
    /// Stored numbers of each voxel that is looked at and of the one behind it; NaN for no data.
    stored: Vec<f32>,
    /// Voxels that were added.
    count: usize,
    range: [f64; 2],
}

impl<'a> Seen<'a> {
    fn new(header: &'a Header, count: usize) -> Self {
        Self {
            header,
            fill: header.fill.map(|fill| fill as f32),
            stride: ValueSummary::stride(count),
            stored: Vec::new(),
            count: 0,
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    fn add(&mut self, voxels: &Voxels) {
        for i in 0..voxels.len() {
            let stored = voxels.stored(i);
            let is_valid = stored.is_finite() && Some(stored) != self.fill;
            if is_valid {
                let value = self.value_of(stored);
                self.range = [self.range[0].min(value), self.range[1].max(value)];
            }
            if self.stride == 1 || (self.count + i) % self.stride <= 1 {
                self.stored.push(if is_valid { stored } else { f32::NAN });
            }
        }
        self.count += voxels.len();
    }

    fn value_of(&self, stored: f32) -> f64 {
        f64::from(stored) * self.header.rescale.slope + self.header.rescale.intercept
    }

    /// Of a voxel that is looked at, or the one behind it.
    fn value(&self, i: usize) -> Option<f64> {
        let at = match self.stride {
            1 => i,
            stride => 2 * (i / stride) + i % stride,
        };
        let stored = self.stored[at];
        (!stored.is_nan()).then(|| self.value_of(stored))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Format, VoxelType};
    use glam::DAffine3;

    #[test]
    fn what_is_looked_at_of_many_voxels_is_what_they_are() {
        let header = Header {
            fill: Some(7.0),
            ..Header::new(Format::Raw, [1; 3], VoxelType::U16, DAffine3::IDENTITY)
        };
        let count = 9 << 20;
        let stored = |i: usize| (i % 1009) as u16;
        let mut seen = Seen::new(&header, count);
        for first in (0..count).step_by(1 << 20) {
            seen.add(&Voxels::U16(
                (first..first + (1 << 20)).map(stored).collect(),
            ));
        }
        let stride = ValueSummary::stride(count);
        assert!(stride > 2, "{stride}");
        assert_eq!(seen.range, [0.0, 1008.0]);
        for i in (0..count).step_by(stride) {
            for i in [i, i + 1].into_iter().filter(|&i| i < count) {
                let wanted = Some(stored(i)).filter(|&stored| stored != 7).map(f64::from);
                assert_eq!(seen.value(i), wanted, "{i}");
            }
        }
    }
}

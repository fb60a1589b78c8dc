//! The surface that shows a quantity of the air which falls with height: water vapour, temperature, pressure.
//!
//! ```text
//! level = mean of v(x, y, h, t) over all columns and times,   h = a third of the height of the box from its lower face
//! ```
//!
//! Linear between the two layers of voxel centres around h; a column without data there does not count. The number is of
//! the whole series: a surface of it moves from time to time with the air.

use crate::volume::{Header, ReadError, Source, TimeComponent, VoxelBox};

/// CF standard names of what falls with height.
const FALLING: [&str; 4] = [
    "air_pressure",
    "air_temperature",
    "humidity_mixing_ratio",
    "specific_humidity",
];
/// Where the mean is taken, as a part of the height of the box.
const PART: f64 = 1.0 / 3.0;
/// Voxels that are read at once.
const MOST_VOXELS: u64 = 1 << 22;

/// True for a quantity of the air over a piece of the Earth that falls with height, of layers one above the other.
pub fn falls_with_height(header: &Header) -> bool {
    let is_falling = |name: &str| FALLING.contains(&name);
    header.is_earth
        && header.dims[2] > 2
        && header.components == 1
        && header.standard_name.as_deref().is_some_and(is_falling)
}

/// The mean over all columns and times at a third of the height, in the unit of the values; `None` where no column has
/// data there. `seen` is told how many of how many times are done.
///
/// # Errors
/// What reading meets.
pub fn mean_at_a_third(
    source: &dyn Source,
    seen: &mut dyn FnMut(u32, u32),
) -> Result<Option<f64>, ReadError> {
    let header = source.header();
    let [nx, ny, nz] = header.dims;
    let upward = header.world_from_voxel.matrix3.z_axis.z >= 0.0;
    let part = if upward { PART } else { 1.0 - PART };
    // Centres lie half a voxel above the lower face.
    let place = (part * f64::from(nz) - 0.5).clamp(0.0, f64::from(nz.saturating_sub(1)));
    let below = (place.floor() as u32).min(nz.saturating_sub(2));
    let weight = place - f64::from(below);
    // Readers of levels that follow the ground look at whole columns.
    let rows = MOST_VOXELS / (u64::from(nx) * u64::from(nz)).max(1);
    let rows = u32::try_from(rows.max(1)).unwrap_or(u32::MAX);
    let (mut sum, mut count) = (0.0, 0_u64);
    for time in 0..header.times {
        seen(time, header.times);
        for y in (0..ny).step_by(rows as usize) {
            let region = VoxelBox {
                min: [0, y, below],
                max: [
                    nx,
                    y.saturating_add(rows).min(ny),
                    below.saturating_add(2).min(nz),
                ],
            };
            let pick = TimeComponent { time, component: 0 };
            let voxels = source.read(pick, region)?.voxels;
            let value = |i: usize| {
                let stored = voxels.stored(i);
                let is_fill = header.fill.map(|fill| fill as f32) == Some(stored);
                let value = f64::from(stored) * header.rescale.slope + header.rescale.intercept;
                (stored.is_finite() && !is_fill).then_some(value)
            };
            let layer = voxels.len() / 2;
            for column in 0..layer {
                if let (Some(a), Some(b)) = (value(column), value(layer + column)) {
                    sum += a + weight * (b - a);
                    count += 1;
                }
            }
        }
    }
    Ok((count > 0).then(|| sum / count as f64))
}

#[cfg(all(test, feature = "phantoms"))]
mod tests {
    use super::*;
    use crate::volume::{Format, Limits, Piece, Rescale, VoxelType, Voxels, phantom};
    use glam::{DAffine3, dvec3};
    use std::path::Path;

    fn storm(words: &str) -> Box<dyn Source> {
        phantom::open(&format!("phantom:storm,{words}"), &Limits::default()).expect("a storm")
    }

    /// Layer k has the value 10 k + 1 by its header; one column has a hole.
    struct Layers(Header);

    impl Source for Layers {
        fn path(&self) -> &Path {
            Path::new("layers")
        }

        fn header(&self) -> &Header {
            &self.0
        }

        fn read(&self, _: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
            let [nx, ny, _] = region.dims();
            let layer = |z: u32| {
                let hole = (z == 3).then_some(-99.0);
                let rest = vec![5.0 * z as f32; (nx * ny) as usize];
                hole.into_iter().chain(rest).take((nx * ny) as usize)
            };
            let voxels = (region.min[2]..region.max[2]).flat_map(layer).collect();
            Ok(Voxels::F32(voxels).into())
        }
    }

    #[test]
    fn the_third_is_counted_from_the_lower_face_whichever_way_layers_run() {
        for (step, wanted) in [(2.0, 16.0), (-2.0, 36.0)] {
            let affine = DAffine3::from_scale(dvec3(1.0, 1.0, step));
            let header = Header {
                rescale: Rescale {
                    slope: 2.0,
                    intercept: 1.0,
                },
                fill: Some(-99.0),
                ..Header::new(Format::NetCdf, [3, 2, 6], VoxelType::F32, affine)
            };
            // Between layers 1 and 2, or 3 and 4 from the top.
            let found = mean_at_a_third(&Layers(header), &mut |_, _| {});
            assert_eq!(found.expect("read"), Some(wanted));
        }
    }

    #[test]
    fn vapour_of_the_storm_is_taken_at_six_kilometres() {
        // Still air has 16 exp(-6 / 2.5) = 1.4515 g/kg. The updraft adds at most 16 (exp(-6 / 5) - exp(-6 / 2.5)) = 3.368
        // on its axis, times exp(-r^2 / 36 km^2): 36 pi km^2 of the 48^2 km^2, 0.165 in the mean. Noise of both signs
        // changes a voxel by 6 % at most, and its mean by less than 2 %.
        let source = storm("n=48,variable=vapor,times=3");
        assert!(falls_with_height(source.header()));
        let mut told = Vec::new();
        let mut seen = |time, times| told.push((time, times));
        let level = mean_at_a_third(source.as_ref(), &mut seen)
            .expect("read")
            .expect("a mean");
        assert!((0.98 * 1.4515..1.02 * 1.617).contains(&level), "{level}");
        assert_eq!(told, [(0, 3), (1, 3), (2, 3)]);
        for variable in ["cloud", "u", "v", "w"] {
            let source = storm(&format!("n=8,variable={variable}"));
            assert!(!falls_with_height(source.header()), "{variable}");
        }
    }

    #[test]
    fn temperature_of_the_storm_is_that_of_still_air_at_six_kilometres_but_for_the_updraft() {
        // 300 - 6.5 * 6 = 261 K, to 7 K more in the updraft of 3 km radius: pi 3^2 of 48^2 km^2, 1.2 %.
        let source = storm("n=96,variable=temperature,times=2");
        let level = mean_at_a_third(source.as_ref(), &mut |_, _| {});
        let level = level.expect("read").expect("a mean");
        assert!((261.0..261.3).contains(&level), "{level}");
    }
}

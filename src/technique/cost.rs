//! What work will take, guessed before anything like it was measured: rather too much than too little.

use super::{MAX_SAMPLES_PER_RAY, Mode, SingleScattering, View};
use crate::gpu::{Gpu, TARGET_MS};
use crate::resident::Cell;
use glam::DVec3;

/// What a look-up of a voxel takes on the processor, with all that is done with it: a driver on two cores took 10 to
/// 20 ns (`docs/log/performance.md`).
const MS_PER_FETCH_ON_PROCESSOR: f64 = 25e-6;

/// The same on the slowest device that is provided for: none was measured, 1 ns is taken for a usual one and 20 times as
/// much for this one.
const MS_PER_FETCH_ON_SLOWEST: f64 = 20e-6;

/// No submission shall last longer.
const LONGEST_MS: f64 = 250.0;

/// What a look is expected to take on a device of which nothing is known, g. A first submission is cut so that it lasts
/// `TARGET_MS` if g is right, or a quarter more where that is all (`Pace::next`): at most `1.25 * TARGET_MS / g` looks.
/// On the slowest device these last `1.25 * TARGET_MS * slowest / g`, which is `LONGEST_MS` for this g, 10 ns. What
/// follows is cut by measurement: a device of 1 ns a look has a first submission of 10 ms, and comes to 100 ms with
/// the fifth.
const MS_PER_LOOK_UNKNOWN: f64 = 1.25 * MS_PER_FETCH_ON_SLOWEST * TARGET_MS / LONGEST_MS;

/// What so many looks are expected to take.
pub fn ms_of_fetches(gpu: &Gpu, fetches: f64) -> f64 {
    fetches
        * match gpu.is_cpu() {
            true => MS_PER_FETCH_ON_PROCESSOR,
            false => MS_PER_LOOK_UNKNOWN,
        }
}

/// Rays across and down that are looked at for a whole picture.
const RAYS: u32 = 16;

/// Looks that one picture takes where nothing is skipped. `slices`: of a slicer, those of all bricks.
pub fn fetches_of_picture(view: &View, slices: u32, volumes: usize) -> f64 {
    let [width, height] = view.extent_pixels.map(f64::from);
    let mean = fetches_of_pixels(view, slices).sum::<f64>() / f64::from(RAYS * RAYS);
    mean * width * height * volumes as f64
}

/// The same of the pixel of one volume that takes most.
pub fn fetches_of_costliest_pixel(view: &View, slices: u32) -> f64 {
    fetches_of_pixels(view, slices).fold(0.0, f64::max)
}

/// Those of some pixels, which lie evenly over the picture.
fn fetches_of_pixels(view: &View, slices: u32) -> impl Iterator<Item = f64> {
    let settings = view.settings;
    let [width, height] = view.extent_pixels.map(f64::from);
    let rays = view.rays();
    let voxel_from_world = view.world_from_voxel().inverse();
    (0..RAYS * RAYS).map(move |at| {
        let x = (f64::from(at % RAYS) + 0.5) * width / f64::from(RAYS);
        let y = (f64::from(at / RAYS) + 0.5) * height / f64::from(RAYS);
        let origin = rays.origin + x * rays.origin_dx + y * rays.origin_dy;
        let direction = rays.direction + x * rays.direction_dx + y * rays.direction_dy;
        let length = length_inside(
            view.domain(),
            voxel_from_world.transform_point3(origin),
            voxel_from_world.transform_vector3(direction),
        ) * direction.length();
        let samples = match settings.technique.casts_rays() {
            true => (length / view.step_world()).min(MAX_SAMPLES_PER_RAY.into()),
            false if length > 0.0 => slices.into(),
            false => 0.0,
        };
        samples * fetches_of_sample(view)
    })
}

/// In units of t: how much of a ray lies in a box.
fn length_inside([low, high]: [DVec3; 2], origin: DVec3, direction: DVec3) -> f64 {
    let [mut near, mut far] = [0.0_f64, f64::INFINITY];
    for k in 0..3 {
        let ends = [low[k], high[k]].map(|side| (side - origin[k]) / direction[k]);
        // A ray along the side of a box makes 0 / 0, which neither max nor min takes.
        near = near.max(ends[0].min(ends[1]));
        far = far.min(ends[0].max(ends[1]));
    }
    match far.is_finite() {
        true => (far - near).max(0.0),
        false => 0.0,
    }
}

/// Some twenty voxels of a slice, each with its part in some five sheets.
const FETCHES_OF_SHEET: f64 = 60.0;

/// Some thirty points in the cells around a sample of their field.
const FETCHES_OF_FIELD: f64 = 60.0;

/// Of a path, for each voxel that its ray would meet: it goes there and back some times.
const FETCHES_OF_PATH: f64 = 4.0;

/// Of a light whose light volume is asked: eight numbers of a buffer.
const FETCHES_OF_LIGHT: f64 = 2.0;

/// Parts of the longest ray that light is followed along from a sample to a light.
const PART_OF_LIGHT_RAY: f64 = 0.5;

fn fetches_of_scattering(view: &View, scattering: SingleScattering) -> f64 {
    let path = &view.settings.path;
    let lights = (path.lights.len() + path.lamps.len()) as f64;
    1.0 + lights
        * match scattering {
            SingleScattering::Open => 0.0,
            SingleScattering::Volume => FETCHES_OF_LIGHT,
            SingleScattering::March => PART_OF_LIGHT_RAY * view.longest_sample_count(),
        }
}

fn fetches_of_sample(view: &View) -> f64 {
    let settings = view.settings;
    if let Some(scattering) = settings.single_scattering {
        return fetches_of_scattering(view, scattering);
    }
    if settings.technique.traces_paths() {
        return FETCHES_OF_PATH * f64::from(settings.path.samples);
    }
    if settings.technique.splats() {
        return FETCHES_OF_SHEET;
    }
    if settings.field.is_some() {
        return FETCHES_OF_FIELD;
    }
    let of_value = match settings.filter.kernel() {
        Some(_) => 8.0,
        None => 1.0,
    };
    // Light asks for a gradient, and so do functions of gradients; cells of trilinear fields solve for extremes.
    let is_lit = settings.shading.is_some() || settings.mode == Mode::Iso;
    match is_lit || settings.per_mode.exact_maximum {
        true => of_value * 7.0,
        false => of_value,
    }
}

/// Voxels of some cells, each looked at so often.
pub fn fetches_of_cells<'a>(cells: impl IntoIterator<Item = &'a Cell>, each: f64) -> f64 {
    let voxels = |cell: &Cell| cell.stored.dims().map(f64::from).iter().product::<f64>();
    each * cells.into_iter().map(voxels).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Pace;
    use glam::dvec3;

    /// The times of the submissions of so many looks on a device of which nothing is known.
    fn submissions(fetches: f64, ms_per_look: f64) -> Vec<f64> {
        const UNITS: u64 = 1 << 16;
        let mut pace = Pace::new(UNITS, fetches * MS_PER_LOOK_UNKNOWN, TARGET_MS);
        let mut times = Vec::new();
        while let Some(units) = pace.next() {
            let ms = fetches / UNITS as f64 * (units.end - units.start) as f64 * ms_per_look;
            times.push(ms);
            pace.took(units, ms);
        }
        times
    }

    #[test]
    fn no_submission_of_the_slowest_device_lasts_too_long_from_the_first_on() {
        for fetches in [1e3, 1e6, 1e7, 1.24e7, 1.26e7, 1e8, 1e9, 1e10, 1e11] {
            for times_slower in [0.1, 1.0, 5.0, 10.0, 20.0] {
                let times = submissions(fetches, times_slower * 1e-6);
                let longest = times.iter().copied().fold(0.0, f64::max);
                assert!(
                    longest <= LONGEST_MS,
                    "{fetches}, {times_slower}: {times:?}"
                );
            }
        }
    }

    #[test]
    fn a_usual_device_has_three_submissions_more_at_most() {
        for fetches in [1e6, 1e8, 1e9, 1e10] {
            let times = submissions(fetches, 1e-6);
            let fewest = (fetches * 1e-6 / TARGET_MS).ceil() as usize;
            assert!(times.len() <= fewest + 3, "{fetches}: {times:?}");
        }
    }

    #[test]
    fn a_ray_is_as_long_in_a_box_as_it_lies_in_it() {
        let unit = [DVec3::ZERO, DVec3::ONE];
        let half = dvec3(0.5, 0.5, -1.0);
        assert_eq!(length_inside(unit, half, DVec3::Z), 1.0);
        assert_eq!(length_inside(unit, half, 0.5 * DVec3::Z), 2.0);
        assert_eq!(length_inside(unit, half, -DVec3::Z), 0.0);
        assert_eq!(length_inside(unit, dvec3(2.0, 0.5, -1.0), DVec3::Z), 0.0);
        assert_eq!(length_inside(unit, DVec3::splat(0.5), DVec3::Z), 0.5);
        assert!(length_inside(unit, DVec3::ZERO, DVec3::Z) >= 0.0);
    }
}

//! The camera of a film fitted to what is visible in its frames, as `--target` and `--zoom`.
//!
//! ```text
//! camera stands still    the union of what is visible at up to 16 times fills the frame
//! camera moves           the sphere around what is visible, seen along x and along y, fills it
//! ```

use super::{Plan, draw::Content, keeps_transparency, ready, shots::Shot, volumes::Volumes};
use crate::{
    camera::{BoundingSphere, Camera, PixelBox, Projection},
    cli::{
        Error,
        flags::{Classification, Depth, FrameWord, Numbers, SceneFlags},
        look::{Seen, Use, with_light, with_side},
        progress::Progress,
        renderer::{Device, Job, Renderer},
    },
    look::{SHARE, box_of, corners, frames_the_box, small_of, visible_in},
    picture::PictureFormat,
    scene::Beside,
    technique::Settings,
    volume::{Grid, Volume},
};
use glam::DVec3;

/// Times that are looked at, evenly spread.
const MAX_TIMES: usize = 16;
/// Pixels of the longer side of small frames.
const SMALL_PIXELS: u32 = 128;

/// What a small frame is made with.
struct Look<'a> {
    classification: &'a Classification,
    beside: Beside<'a>,
    settings: &'a Settings,
    cameras: &'a [Camera],
    extent_pixels: [u32; 2],
}

/// The scene of a film with the light, the background and the camera of its look.
pub fn framed(
    plan: &Plan,
    content: &Content,
    grid: &Grid,
    devices: &mut Vec<Device>,
    progress: &Progress,
) -> Result<SceneFlags, Error> {
    let scene = &plan.scene;
    let Some(mut word) = scene.camera.framed(scene.is_auto()) else {
        return choose(plan, content, grid, progress).map(|(scene, _)| scene);
    };
    let (mut scene, classification) = choose(plan, content, grid, progress)?;
    if scene.section.section.is_some() {
        return Ok(scene);
    }
    scene.camera.zoom = None;
    let shots = plan.film.shots(&scene, plan.depth, &plan.header, grid)?;
    let first = &shots[0];
    if frames_the_box(first.settings.mode, first.settings.crop.is_some()) {
        word = FrameWord::Box;
    }
    let moves = shots.iter().any(|shot| shot.camera != first.camera);
    let corners = corners(grid, first.settings.crop);
    let extent_pixels = scene.picture.extent_pixels()?;
    let small = match moves {
        true => [SMALL_PIXELS; 2],
        false => small_of(extent_pixels, SMALL_PIXELS),
    };
    let bounds = BoundingSphere::of_grid(&grid.world_from_voxel, grid.dims);
    let cameras = match moves {
        true => along_axes(&bounds).to_vec(),
        false => vec![first.camera.fitted_to_points(&corners, small, SHARE)],
    };
    let settings = match content {
        Content::Still(shown) => Settings {
            per_mode: shown.per_mode.clone(),
            filter: match scene.sampling.filter {
                Some(_) => first.settings.filter,
                None => shown.filter.unwrap_or(first.settings.filter),
            },
            ..first.settings.clone()
        },
        Content::Times(..) => first.settings.clone(),
    };
    let parts = match content {
        Content::Still(shown) => Some(shown.parts()),
        Content::Times(..) => None,
    };
    let look = Look {
        classification: &classification,
        beside: parts
            .as_ref()
            .map_or(Beside::Nothing, |parts| parts.beside()),
        settings: &settings,
        cameras: &cameras,
        extent_pixels: small,
    };
    let seen = match word {
        FrameWord::Box => vec![None; cameras.len()],
        FrameWord::Visible => visible(plan, content, &shots, &look, devices, progress)?,
    };
    let fitted = match (
        moves,
        seen.iter().copied().collect::<Option<Vec<PixelBox>>>(),
    ) {
        (false, Some(parts)) => cameras[0].fitted(&parts[0], small, SHARE),
        (false, None) => cameras[0],
        (true, Some(parts)) => {
            let sphere = sphere_of(&cameras, [parts[0], parts[1]], small);
            around(&first.camera, &sphere, extent_pixels)
        }
        (true, None) => around(&first.camera, &bounds, extent_pixels),
    };
    let nearer = plan.scene.camera.zoom.unwrap_or(1.0);
    scene.camera.frame = None;
    scene.camera.target = Some(Numbers(fitted.target.to_array()));
    scene.camera.zoom = Some(fitted.zoom * nearer);
    progress.note(&format!(
        "framed to {} of all frames",
        match word {
            FrameWord::Visible => "what is visible",
            FrameWord::Box => "the box",
        }
    ));
    Ok(scene)
}

/// The scene with light and background, and how values are seen in its first frame.
fn choose(
    plan: &Plan,
    content: &Content,
    grid: &Grid,
    progress: &Progress,
) -> Result<(SceneFlags, Classification), Error> {
    let made_for = Use {
        is_film: true,
        is_opaque: match &plan.target {
            super::Target::Frames(frames) => frames.format == PictureFormat::Png,
            target => !keeps_transparency(target) || plan.depth == Depth::Eight,
        },
        depth: plan.depth,
    };
    let header = &plan.header;
    let scene = with_side(
        &plan.scene,
        grid,
        header.is_earth,
        header.is_patient || header.is_earth,
    );
    Ok(match content {
        Content::Still(shown) => (
            with_light(&scene, shown.seen(), made_for),
            shown.classification.clone(),
        ),
        Content::Times(source, bricks) => {
            if !scene.is_auto() {
                return Ok((scene, Classification::RangeOfPicture));
            }
            let shots = plan.film.shots(&scene, plan.depth, header, grid)?;
            let quiet = Progress::of_part();
            let unseen = |_, _: &Volume| Ok(());
            let mut volumes = Volumes::new(source, *bricks, &scene, &quiet, &unseen);
            let labels = source.header().is_labels;
            let ready = ready::of_times(&shots[..], &scene, labels, &mut volumes, &quiet)?;
            let moment = volumes.at(ready[0].time)?;
            progress.stage("prepare", 0, 1);
            let seen = Seen {
                volume: moment.looked_at(),
                context: scene.classification.context.as_ref(),
                classification: &ready[0].classification,
                is_alone: true,
            };
            let lit = with_light(&scene, seen, made_for);
            (lit, ready[0].classification.clone())
        }
    })
}

/// What each camera sees at all times together.
fn visible(
    plan: &Plan,
    content: &Content,
    shots: &[Shot],
    look: &Look,
    devices: &mut Vec<Device>,
    progress: &Progress,
) -> Result<Vec<Option<PixelBox>>, Error> {
    let mut seen = vec![None; look.cameras.len()];
    let mut draw = |volume: &Volume| -> Result<(), Error> {
        let job = Job {
            volume,
            classification: look.classification,
            stream: None,
            beside: look.beside,
            settings: look.settings,
            extent_pixels: look.extent_pixels,
            layers: &[],
        };
        let mut renderer = Renderer::new(job, &look.cameras[0], devices.remove(0))?;
        for (camera, seen) in look.cameras.iter().zip(&mut seen) {
            let found = visible_in(&renderer.draw(camera)?.picture);
            let found = box_of(&found, look.extent_pixels[0]);
            *seen = match (*seen, found) {
                (Some(a), Some(b)) => Some(PixelBox::union(a, b)),
                (a, b) => a.or(b),
            };
        }
        devices.insert(0, renderer.into_device());
        Ok(())
    };
    match content {
        Content::Still(shown) => draw(shown.looked_at())?,
        Content::Times(source, bricks) => {
            let quiet = Progress::of_part();
            let unseen = |_, _: &Volume| Ok(());
            let mut volumes = Volumes::new(source, *bricks, &plan.scene, &quiet, &unseen);
            let mut times: Vec<u32> = shots.iter().map(|shot| shot.time as u32).collect();
            times.dedup();
            let count = times.len().min(MAX_TIMES);
            for k in 0..count {
                progress.stage("prepare", k, count);
                let at = k * (times.len() - 1) / (count.max(2) - 1);
                let moment = volumes.at(f64::from(times[at]))?;
                draw(moment.looked_at())?;
            }
        }
    }
    Ok(seen)
}

/// Orthographic cameras that see all of a sphere along -x and along -y.
fn along_axes(bounds: &BoundingSphere) -> [Camera; 2] {
    [DVec3::X, DVec3::Y].map(|side| Camera {
        eye: bounds.center + 2.0 * bounds.radius * side,
        target: bounds.center,
        up: DVec3::Z,
        projection: Projection::Orthographic {
            view_height: 2.0 * bounds.radius,
        },
        zoom: 1.0,
    })
}

/// The sphere around the box of what two such cameras see.
fn sphere_of(cameras: &[Camera], parts: [PixelBox; 2], extent_pixels: [u32; 2]) -> BoundingSphere {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (k, (camera, part)) in cameras.iter().zip(parts).enumerate() {
        let rays = camera.rays(extent_pixels);
        for [x, y] in [part.min, part.max] {
            let (point, _) = rays.at(x, y);
            // A camera along x says nothing of x.
            let across = 1 - k;
            low[across] = low[across].min(point[across]);
            high[across] = high[across].max(point[across]);
            low.z = low.z.min(point.z);
            high.z = high.z.max(point.z);
        }
    }
    BoundingSphere {
        center: 0.5 * (low + high),
        radius: 0.5 * low.distance(high),
    }
}

/// The camera turned to the middle of a sphere that just fits its picture.
fn around(camera: &Camera, sphere: &BoundingSphere, extent_pixels: [u32; 2]) -> Camera {
    let shift = sphere.center - camera.target;
    let moved = Camera {
        eye: camera.eye + shift,
        target: sphere.center,
        ..*camera
    };
    let frame = moved.frame();
    let distance = moved.eye.distance(moved.target);
    // Rays graze the sphere nearer than its middle.
    let radius = match moved.projection.is_perspective() {
        true => sphere.radius / (1.0 - (sphere.radius / distance).powi(2)).max(1e-6).sqrt(),
        false => sphere.radius,
    };
    let ends = [frame.right, -frame.right, frame.up, -frame.up];
    let points = ends.map(|end| sphere.center + radius * end);
    let fitted = moved.fitted_to_points(&points, extent_pixels, 1.0);
    Camera {
        zoom: fitted.zoom,
        ..moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_views_of_a_box_give_the_sphere_around_it() {
        let bounds = BoundingSphere {
            center: DVec3::new(1.0, 2.0, 3.0),
            radius: 16.0,
        };
        let cameras = along_axes(&bounds);
        let (low, high) = (DVec3::new(-4.0, 0.0, 1.0), DVec3::new(2.0, 8.0, 7.0));
        let extent = [320, 320];
        let part = |camera: &Camera| {
            let points = [low, high].map(|p| camera.project(p, extent).expect("in front"));
            PixelBox::around(points).expect("points")
        };
        let sphere = sphere_of(&cameras, [part(&cameras[0]), part(&cameras[1])], extent);
        assert!(
            (sphere.center - 0.5 * (low + high)).length() < 1e-9,
            "{sphere:?}"
        );
        assert!(
            (sphere.radius - 0.5 * low.distance(high)).abs() < 1e-9,
            "{sphere:?}"
        );
    }
}

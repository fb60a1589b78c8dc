//! The depth that slices give back is that of the sample which makes them half opaque, or which is the largest, found
//! here from slice to slice by the CPU references: behind a host's spheres, from all its eyes, and from inside the volume.

use crate::embed_shared::{Eye, Host, Stage, depths, draw, eyes};
use glam::dcamera::rh::proj::vulkan;
use glam::dcamera::rh::view::look_at_mat4;
use stratavox::camera::{Camera, DepthConvention, HostDepth};
use stratavox::embed::Volume;
use stratavox::gpu::Caps;
use stratavox::lattice::{Slab, plane_slab};
use stratavox::ray::{domain_interval, pixel_ray, plane_t, voxel_ray};
use stratavox::shaders::Frame;
use stratavox::technique::slices_2d::{between, reference as stack};
use stratavox::technique::slices_3d::reference as planes;
use stratavox::technique::{ClipPlane, Filter, Mode, Settings, Technique};
use stratavox::transfer::{
    Absorption, Points, SlabTable, classify_by_points, classify_slab, opacity_over,
};
use stratavox::volume::sample::{linear, linear_in_slice};

/// A sample, or a slab, of a pixel's ray.
struct Sample {
    /// Its middle.
    t: f64,
    value: f64,
    opacity: f64,
}

/// What classifies.
struct Law {
    points: Points,
    slabs: SlabTable,
}

impl Law {
    fn of(stage: &Stage) -> Self {
        let reference_length = stage.grid.smallest_spacing();
        let absorption = Absorption::Extinction { reference_length };
        let space = stage.settings.color_space;
        Self {
            points: Points::new(&stage.transfer, absorption, space),
            slabs: SlabTable::new(&stage.transfer, absorption, space),
        }
    }
}

/// All samples of a pixel's ray between `ends`, from front to back.
fn samples(stage: &Stage, law: &Law, camera: &Camera, at: [f64; 2], ends: [f64; 2]) -> Vec<Sample> {
    let (origin, direction) = camera.rays(stage.extent).at(at[0], at[1]);
    let mut settings = stage.settings.clone();
    for (t, normal) in [(ends[0], direction), (ends[1], -direction)] {
        if t.is_finite() {
            let offset = normal.dot(origin + t * direction);
            settings.clip_planes.push(ClipPlane { normal, offset });
        }
    }
    let view = stratavox::technique::View {
        camera,
        settings: &settings,
        ..stage.view()
    };
    let recording = view.on_cpu().unwrap();
    let frame = &recording.frame;
    let found = (0..recording.slices).rev();
    found
        .filter_map(|i| sample(stage, law, frame, at, i))
        .collect()
}

fn sample(stage: &Stage, law: &Law, frame: &Frame, at: [f64; 2], i: u32) -> Option<Sample> {
    let (world, volume) = (pixel_ray::<f64>(frame, at), &stage.volume);
    let voxel = voxel_ray(frame, &world);
    let interval = domain_interval(frame, &world, &voxel);
    let point = |value: f64, length: f64, t: f64| {
        let extinction = classify_by_points(&law.points, value)[3];
        let opacity = opacity_over(extinction, length);
        Sample { t, value, opacity }
    };
    let slab = |[front, back]: [f64; 2], length: f64, ends: [f64; 2]| {
        let extinction = classify_slab(&law.slabs, front, back)[3];
        Sample {
            t: 0.5 * (ends[0] + ends[1]),
            value: front,
            opacity: opacity_over(extinction, length),
        }
    };
    let axis = frame.slice_axis as usize;
    let crossing = |height: f64| (height - voxel.origin[axis]) / voxel.direction[axis];
    match (stage.settings.technique, stage.settings.preintegrated) {
        (Technique::Slices3d, false) => {
            let k = frame.slice_first + i as i32 * frame.slice_direction;
            let found = planes::fragment(frame, at, k, |p| linear(volume, p))??;
            Some(point(found.value, found.length, plane_t(frame, &world, k)))
        }
        (Technique::Slices3d, true) => {
            let k = frame.slice_first + i as i32 * frame.slice_direction;
            let found = planes::slab(frame, at, k, |p| linear(volume, p))??;
            let ends = plane_slab(frame, &world, interval, k).ends;
            Some(slab(found.value.ends, found.length, ends))
        }
        (_, false) => {
            let k = stack::slice_of(frame, i);
            let value_at = |p| linear_in_slice(volume, axis, k as u32, p);
            let found = stack::fragment(frame, at, k, value_at)??;
            Some(point(
                found.value,
                found.length,
                crossing(f64::from(k) + 0.5),
            ))
        }
        (_, true) => {
            let k = stack::slice_of(frame, i);
            let count = volume.dims[axis];
            let found = between::slab(frame, at, k, |level, p| {
                level.linear(count, |slice| linear_in_slice(volume, axis, slice, p))
            })??;
            let mut whole = [0.5, 1.5].map(|above| crossing(f64::from(k) + above));
            whole.sort_by(f64::total_cmp);
            let ends = Slab::cut(whole, interval, found.length).ends;
            Some(slab(found.value.ends, found.length, ends))
        }
    }
}

/// The samples that may be meant, and whether it may be that none is: where rounding, or the 1/4096 of a table, decides
/// whether a composite is half opaque, or which of two values is the larger, both are right.
fn meant(stage: &Stage, samples: &[Sample]) -> (Vec<usize>, bool) {
    if stage.settings.mode == Mode::Mip {
        let largest = samples.iter().map(|s| s.value).fold(-1.0, f64::max);
        let is_largest = |&i: &usize| samples[i].value >= largest - 1e-5;
        return (
            (0..samples.len()).filter(is_largest).collect(),
            samples.is_empty(),
        );
    }
    const IN_DOUBT: f64 = 2e-3;
    let (mut transmittance, mut found) = (1.0, Vec::new());
    for (i, sample) in samples.iter().enumerate() {
        transmittance *= 1.0 - sample.opacity;
        if transmittance <= 0.5 + IN_DOUBT {
            found.push(i);
        }
        if transmittance <= 0.5 - IN_DOUBT {
            return (found, false);
        }
    }
    (found, true)
}

fn stages() -> Vec<Stage> {
    let slices = [Technique::Slices3d, Technique::Slices2d];
    let ways = [
        (Mode::Composite, false),
        (Mode::Composite, true),
        (Mode::Mip, false),
    ];
    let all = slices
        .into_iter()
        .flat_map(|technique| ways.map(|way| (technique, way)));
    all.map(|(technique, (mode, preintegrated))| {
        Stage::new(Settings {
            technique,
            mode,
            preintegrated,
            filter: Filter::Linear,
            ..Settings::default()
        })
    })
    .collect()
}

/// Depths are those of the samples that are meant: f32 of some 60 mm over the slope of the depth.
const ALLOWED: f64 = 1e-5;

/// Compares all depths; how many the volume gave.
fn check(host: &Host, stage: &Stage, camera: &Camera, depth: &HostDepth, what: &str) -> [u32; 2] {
    let drawn = depths(stage, camera, depth);
    let law = Law::of(stage);
    let found = draw(host, stage, camera, depth, &drawn, None);
    let (mut surfaces, mut doubtful) = (0, 0);
    for i in (0..drawn.len()).step_by(3) {
        let at = [i as u32 % stage.extent[0], i as u32 / stage.extent[0]];
        let at = at.map(|n| f64::from(n) + 0.5);
        let (origin, direction) = camera.rays(stage.extent).at(at[0], at[1]);
        let near = depth.distance(origin, direction, depth.nearer.near());
        let end = depth.distance(origin, direction, f64::from(drawn[i]));
        let mut wanted = Vec::new();
        for moved in [0.0, -1e-5, 1e-5] {
            let samples = samples(stage, &law, camera, at, [near, end * (1.0 + moved)]);
            let (meant, may_be_none) = meant(stage, &samples);
            wanted.extend(
                meant
                    .iter()
                    .map(|&m| depth.of(origin + samples[m].t * direction)),
            );
            wanted.extend(may_be_none.then_some(f64::from(drawn[i])));
        }
        let off = |wanted: &f64| (wanted - f64::from(found.depths[i])).abs();
        let off = wanted.iter().map(off).fold(f64::INFINITY, f64::min);
        assert!(off < ALLOWED, "{what}: pixel {at:?} is off by {off}");
        surfaces += u32::from(found.depths[i] != drawn[i]);
        let spread = wanted
            .iter()
            .map(|w| (w - wanted[0]).abs())
            .fold(0.0, f64::max);
        doubtful += u32::from(spread > ALLOWED);
    }
    println!("{what}: {surfaces} depths, {doubtful} in doubt");
    [surfaces, doubtful]
}

fn name(stage: &Stage) -> String {
    let settings = &stage.settings;
    let slabs = if settings.preintegrated {
        ", slabs"
    } else {
        ""
    };
    format!("{} {}{slabs}", settings.technique, settings.mode)
}

#[test]
fn slices_give_the_depth_of_the_sample_that_counts() {
    let host = Host::new();
    for stage in stages() {
        for eye in eyes(&stage) {
            let what = format!("{}, {}", name(&stage), eye.name);
            let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
            let [surfaces, doubtful] = check(&host, &stage, &camera, &depth, &what);
            assert!(surfaces > 30, "{what}: {surfaces} depths");
            assert!(doubtful < surfaces / 2, "{what}: {doubtful} in doubt");
        }
    }
}

#[test]
fn of_a_volume_in_bricks_it_is_the_same() {
    let host = Host::with_caps(Caps {
        max_image_dimension_3d: 16,
        max_image_array_layers: 9,
        ..Caps::UNLIMITED
    });
    // Slabs reach out of bricks that are so small.
    let stages = stages();
    for stage in stages.iter().filter(|stage| !stage.settings.preintegrated) {
        let what = format!("{}, in bricks", name(stage));
        let [eye, ..] = eyes(stage);
        let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
        let [surfaces, _] = check(&host, stage, &camera, &depth, &what);
        assert!(surfaces > 30, "{what}: {surfaces} depths");
        let volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
        let bricks = volume.copy(stage.view().texture_layout()).unwrap().bricks();
        assert!(bricks.len() > 1, "{what}: {} bricks", bricks.len());
    }
}

/// A host's eye in the middle of the volume.
fn inside(stage: &Stage) -> Eye {
    let Camera {
        eye, target, up, ..
    } = stage.camera;
    let to_eye = (eye - target).normalize();
    Eye {
        name: "inside",
        view: look_at_mat4(target + 1.5 * to_eye, target - 9.0 * to_eye, up),
        clip: vulkan::perspective(1.2, 1.2, 0.3, 90.0),
        nearer: DepthConvention::Standard,
    }
}

#[test]
fn an_eye_inside_the_volume_finds_the_depth_before_it() {
    let host = Host::new();
    for stage in stages() {
        let what = format!("{}, inside", name(&stage));
        let eye = inside(&stage);
        let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
        let [surfaces, _] = check(&host, &stage, &camera, &depth, &what);
        assert!(surfaces > 30, "{what}: {surfaces} depths");
    }
}

#[test]
fn a_pixel_picked_from_slices_says_where_it_is_and_what_is_there() {
    let host = Host::new();
    for stage in stages() {
        let [eye, ..] = eyes(&stage);
        let what = name(&stage);
        let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
        let open = vec![1.0; (stage.extent[0] * stage.extent[1]) as usize];
        let law = Law::of(&stage);
        let mut hits = 0;
        for pixel in [[22, 18], [19, 20], [0, 0]] {
            let found = draw(&host, &stage, &camera, &depth, &open, Some(pixel));
            let at = pixel.map(|n| f64::from(n) + 0.5);
            let samples = samples(&stage, &law, &camera, at, [0.0, f64::INFINITY]);
            let (meant, may_be_none) = meant(&stage, &samples);
            let Some(pick) = found.pick else {
                assert!(may_be_none, "{what}: nothing at {pixel:?}");
                continue;
            };
            hits += 1;
            let off = |&m: &usize| (samples[m].t - pick.distance).abs();
            let nearest = meant.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
            let nearest = *nearest.expect("something is there");
            assert!(off(&nearest) < 1e-4, "{what}: off by {}", off(&nearest));
            let (origin, direction) = camera.rays(stage.extent).at(at[0], at[1]);
            let place = origin + pick.distance * direction;
            assert!(pick.position.distance(place) < 1e-9, "{what}");
            match (stage.settings.preintegrated, pick.value) {
                (true, None) => {}
                (false, Some(value)) => {
                    let off = (value - samples[nearest].value).abs();
                    assert!(off < 1e-5, "{what}: value off by {off}");
                }
                (_, found) => panic!("{what}: {found:?}"),
            }
        }
        assert!(hits >= 1, "{what}: {hits} hits");
    }
}

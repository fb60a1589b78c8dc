//! Under the least that Vulkan allows the same pictures are drawn, by all techniques and in all modes; what cannot be
//! is refused by the name of what lacks.

use crate::cells::{FEATURES, Feature, MODES, Matter, TECHNIQUES, settings};
use crate::shared::{device, device_with};
use std::collections::BTreeMap;
use stratavox::gpu::{self, Caps};
use stratavox::offscreen::{Error, Renderer};
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Mode, Settings, Technique};

/// The least of every limit. Blending 32-bit floats is no feature that every device has.
const MINIMUM: Caps = Caps::VULKAN_MINIMUM;

/// The same, under which the volumes of the cells take several bricks along two axes, and along each in a stack.
const IN_BRICKS: Caps = Caps {
    max_image_dimension_3d: 10,
    max_image_array_layers: 7,
    ..MINIMUM
};

type Pixels = Vec<[f32; 4]>;

/// Draws cells of `docs/matrix.md` on a device without limits of ours and on one with each of `caps`, and hands both
/// pictures to `compare`. How many came out in which way.
fn each_cell(
    technique: Technique,
    (features, modes): (&[&str], &[Mode]),
    caps: &[Caps],
    dress: impl Fn(&mut Settings),
    compare: impl Fn(&Scene, Pixels, Result<Pixels, Error>) -> &'static str,
) -> BTreeMap<&'static str, usize> {
    let matter = Matter::new(|volume| volume.clone());
    let mut ways = BTreeMap::new();
    let is_wanted = |feature: &&Feature| features.contains(&feature.name);
    let wanted: Vec<_> = FEATURES.iter().filter(is_wanted).collect();
    assert_eq!(wanted.len(), features.len(), "features by their names");
    for feature in wanted {
        let (channels, parts) = (matter.channels(feature.seen), matter.parts(feature.seen));
        let any = settings(technique, Mode::Composite, Filter::Linear, feature);
        let shown = matter.scene(0, feature.seen, &any, &channels, &parts);
        let mut free = Renderer::several(device(), shown.volumes()).unwrap();
        let bound = |&caps| Renderer::several(device_with(caps), shown.volumes()).unwrap();
        let mut bound: Vec<_> = caps.iter().map(bound).collect();
        for (nth, &mode) in modes.iter().enumerate() {
            let mut settings = settings(technique, mode, Filter::Linear, feature);
            dress(&mut settings);
            let scene = matter.scene(nth, feature.seen, &settings, &channels, &parts);
            if scene.check().is_err() {
                continue;
            }
            println!("{technique:?}, {mode:?}, {}", feature.name);
            let wanted = free.render(&scene, &[]).unwrap().picture.pixels;
            let covered = wanted.iter().filter(|pixel| pixel[3] > 0.01).count();
            assert!(covered > 80, "only {covered} pixels are drawn");
            for bound in &mut bound {
                let found = bound.render(&scene, &[]);
                let found = found.map(|found| found.picture.pixels);
                *ways
                    .entry(compare(&scene, wanted.clone(), found))
                    .or_default() += 1;
            }
        }
    }
    println!("{technique:?}: {ways:?}");
    ways
}

const SAME: &str = "the same bytes";
const NO_BLENDING: &str = "no blending of 32-bit floats";
const BY_HALVES: &str = "blended in 16-bit floats";

/// The same bytes.
fn same(_: &Scene, wanted: Pixels, found: Result<Pixels, Error>) -> &'static str {
    match found {
        Ok(found) => {
            let off = wanted.iter().zip(&found).filter(|(a, b)| a != b).count();
            assert_eq!(off, 0, "pixels that differ");
            SAME
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn every_technique_and_mode_draws_the_same_bytes_under_the_least_limits_and_in_bricks() {
    for (technique, word) in TECHNIQUES {
        let caps = [MINIMUM, IN_BRICKS].map(|caps| Caps {
            float32_blend: technique != Technique::Raycast,
            ..caps
        });
        // Which samples are left out depends on the bricks.
        let dress = |settings: &mut Settings| {
            settings.skip = false;
            settings.conformance = true;
        };
        let cells = (&["one volume"][..], &MODES.map(|(mode, _)| mode)[..]);
        // Splats of a volume lie in one texture.
        let caps = match technique {
            Technique::Splat => &caps[..1],
            _ => &caps[..],
        };
        let ways = each_cell(technique, cells, caps, dress, same);
        let modes = if technique == Technique::Raycast {
            9
        } else {
            5
        };
        assert_eq!(ways, BTreeMap::from([(SAME, caps.len() * modes)]), "{word}");
    }
}

#[test]
fn what_is_beside_a_volume_is_drawn_the_same() {
    let features = [
        "light",
        "value and gradient",
        "voxels without data",
        "several channels",
    ];
    let cells = (&features[..], &[Mode::Composite, Mode::Mida][..]);
    let ways = each_cell(Technique::Raycast, cells, &[MINIMUM], |_| {}, same);
    // MIDA shows one volume.
    assert_eq!(ways, BTreeMap::from([(SAME, 7)]));
}

/// Slices composite in batches of 16-bit floats: each of n blends rounds a premultiplied number below 1 to 11 bits, up
/// or down as the driver likes, and what lies behind it is only made fainter.
#[test]
fn slices_composite_or_say_what_lacks_where_floats_are_not_blended() {
    let cells = (&["one volume"][..], &MODES.map(|(mode, _)| mode)[..]);
    for (technique, word) in &TECHNIQUES[1..3] {
        let ways = each_cell(*technique, cells, &[MINIMUM], |_| {}, halves_or_refused);
        assert_eq!(
            ways,
            BTreeMap::from([(BY_HALVES, 1), (NO_BLENDING, 4)]),
            "{word}"
        );
    }
}

fn halves_or_refused(scene: &Scene, wanted: Pixels, found: Result<Pixels, Error>) -> &'static str {
    let grid = scene.volume.grid();
    let slices = scene.view(&grid, [0.0; 2]).on_cpu().unwrap().slices;
    match found {
        Ok(found) => {
            let pairs = wanted.as_flattened().iter().zip(found.as_flattened());
            let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            let allowed = slices as f32 / 1024.0;
            println!("{slices} slices: {worst} of {allowed}");
            assert!(worst > 0.0, "the targets were not of 16 bits");
            assert!(worst <= allowed, "{worst} of {allowed}");
            BY_HALVES
        }
        Err(Error::Gpu(refused @ gpu::Error::Format { .. })) => {
            let text = refused.to_string();
            assert!(
                text.contains("no blending for R32G32B32A32_SFLOAT"),
                "{text}"
            );
            NO_BLENDING
        }
        Err(other) => panic!("{other}"),
    }
}

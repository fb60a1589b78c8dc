//! Mixtures that are the same matter as one volume throw the same shadows, and a layer of another volume takes away what its
//! extinction says.

use super::*;
use crate::occlusion::seen_from_above;
use glam::dvec3;
use stratavox::technique::{Settings, Shading, Shadows, preclassified::preclassified};

const SIDE: u32 = 24;
/// Per world length.
const EXTINCTION: f64 = 0.3;

fn cube(field: impl Fn(DVec3) -> f64) -> Volume {
    volume_of([SIDE; 3], DAffine3::IDENTITY, field)
}

/// Opaque, below 5.
fn is_floor(p: DVec3) -> bool {
    p.z < 5.0
}

/// Half transparent, 4 thick, over the left third of the floor.
fn is_layer(p: DVec3) -> bool {
    p.x < 8.0 && p.z > 12.0 && p.z < 16.0
}

fn white(opacities: &[(f64, f64)]) -> TransferFunction {
    let point = |&(value, opacity)| OpacityPoint { value, opacity };
    TransferFunction {
        opacity: opacities.iter().map(point).collect(),
        interpolation: Interpolation::Step,
        ..fog([1.0; 3], 0.0)
    }
}

/// Opacity over world length 1.
fn opacity_of(extinction: f64) -> f64 {
    -(-extinction).exp_m1()
}

/// Light from the left and above, all of it diffuse, the layer in its way to the right of the layer.
fn lit(settings: &mut Settings) {
    let light = dvec3(-1.0, 0.0, 1.0);
    settings.shading = Some(Shading {
        ambient: 0.0,
        specular: 0.0,
        diffuse: 1.0,
        lights: vec![stratavox::technique::Light::of_world(light, [1.0; 3])],
        shadows: Shadows::Volume {
            light_size_degrees: 0.0,
        },
        ..Shading::default()
    });
}

fn floor_at(picture: &Picture, x: usize) -> f32 {
    picture.pixels[12 * SIDE as usize + x][0]
}

fn both(p: DVec3) -> f64 {
    match (is_floor(p), is_layer(p)) {
        (true, _) => 2.0,
        (_, true) => 1.0,
        _ => 0.0,
    }
}

fn matter() -> TransferFunction {
    white(&[(-1.0, 0.0), (0.5, opacity_of(EXTINCTION)), (1.5, 1.0)])
}

#[test]
fn a_layer_of_another_volume_takes_as_much_light_as_one_of_the_same() {
    let one = cube(both);
    let floor = cube(|p| f64::from(is_floor(p)));
    let layer = cube(|p| f64::from(is_layer(p)));
    // Twice as fine, on a grid of its own that ends with that of the floor.
    let half = DAffine3::from_scale(DVec3::splat(0.5));
    let fine = volume_of([2 * SIDE; 3], half, |p| f64::from(is_layer(0.5 * p)));
    let opaque = white(&[(-1.0, 0.0), (0.5, 1.0)]);
    let of_layer = |extinction| white(&[(-1.0, 0.0), (0.5, opacity_of(extinction))]);
    let (whole, halved) = (of_layer(EXTINCTION), of_layer(0.5 * EXTINCTION));
    let numbers = |volume, function| channel(volume, function, Role::Numbers);
    let wanted = seen_from_above(&one, &matter(), Beside::Nothing, lit);
    for (channels, what) in [
        (&[numbers(&layer, &whole)][..], "another volume"),
        (&[numbers(&layer, &halved); 2], "two of half the extinction"),
        (&[numbers(&fine, &whole)], "a finer grid"),
        (&[channel(&layer, &whole, Role::Labels)], "labels"),
    ] {
        let found = seen_from_above(&floor, &opaque, Beside::Channels(channels), lit);
        // Where the light comes through the layer at 45 degrees, and where it passes beside.
        let [shadow, bright] = [12, 22].map(|x| f64::from(floor_at(&found, x)));
        let through = (-EXTINCTION * 4.0 * 2.0_f64.sqrt()).exp();
        let off = (shadow / bright - through).abs();
        assert!(off < 1e-5, "{what}: {shadow} of {bright}, wanted {through}");
        // Gradients at the layer are those of another volume: the floor beside it is the same.
        for x in 9..SIDE as usize {
            let [wanted, found] = [&wanted, &found].map(|picture| floor_at(picture, x));
            assert!(
                (wanted - found).abs() < 2e-6,
                "{what}, {x}: {found}, wanted {wanted}"
            );
        }
    }
}

/// Labels that are hidden cut out all that lies there: light goes through.
#[test]
fn hidden_labels_let_light_through() {
    let floor = cube(|p| f64::from(is_floor(p)));
    let layer = cube(|p| f64::from(is_layer(p)));
    let labels = cube(|_| 1.0);
    let mut hidden = labels.clone();
    let voxels =
        (0..SIDE).flat_map(|z| (0..SIDE).flat_map(move |y| (0..SIDE).map(move |x| [x, y, z])));
    let is_seen = |index: [u32; 3]| !is_layer(DVec3::from(index.map(f64::from)) + 0.5);
    hidden.validity = Some(voxels.map(|index| u8::from(is_seen(index))).collect());
    let opaque = white(&[(-1.0, 0.0), (0.5, 1.0)]);
    let (of_layer, nothing) = (
        white(&[(-1.0, 0.0), (0.5, opacity_of(EXTINCTION))]),
        fog([0.0; 3], 0.0),
    );
    let layer = channel(&layer, &of_layer, Role::Numbers);
    for (labels, through) in [
        (&labels, (-EXTINCTION * 4.0 * 2.0_f64.sqrt()).exp()),
        (&hidden, 1.0),
    ] {
        let channels = [layer, channel(labels, &nothing, Role::Labels)];
        let found = seen_from_above(&floor, &opaque, Beside::Channels(&channels), lit);
        let [shadow, bright] = [12, 22].map(|x| f64::from(floor_at(&found, x)));
        let off = (shadow / bright - through).abs();
        assert!(off < 1e-5, "{shadow} of {bright}, wanted {through}");
    }
}

/// Occlusion alone, where no gradient counts: pictures are the same all over.
fn occluded(settings: &mut Settings) {
    settings.shading = None;
    settings.ambient_occlusion = Some(stratavox::technique::AmbientOcclusion {
        strength: 0.9,
        radius_world: Some(8.0),
    });
}

#[track_caller]
fn assert_same(what: &str, wanted: &Picture, found: &Picture, allowed: f64) {
    Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, allowed).assert_holds();
}

#[test]
fn labels_with_the_functions_of_a_volume_are_that_volume() {
    let (one, nothing) = (cube(both), fog([0.0; 3], 0.0));
    let transfer = matter();
    let wanted = seen_from_above(&one, &transfer, Beside::Nothing, occluded);
    let dark = wanted
        .pixels
        .iter()
        .filter(|p| p[3] > 0.99 && p[0] < 0.7)
        .count();
    assert!(dark > 100, "{dark} pixels are dark");
    let empty = cube(|_| 1.0);
    let labels = [channel(&one, &transfer, Role::Labels)];
    let found = seen_from_above(&empty, &nothing, Beside::Channels(&labels), occluded);
    assert_same("labels", &wanted, &found, 4e-6);
}

#[test]
fn an_opacity_from_another_volume_throws_the_shadow_of_that_volume() {
    let (one, constant) = (cube(both), cube(|_| 1.0));
    let transfer = matter();
    let wanted = seen_from_above(&one, &transfer, Beside::Nothing, occluded);
    let opacity = [channel(&one, &transfer, Role::Opacity)];
    // Opaque by itself, if that counted.
    let colour = fog([1.0; 3], 9.0);
    let found = seen_from_above(&constant, &colour, Beside::Channels(&opacity), occluded);
    assert_same("opacity", &wanted, &found, 4e-6);
}

#[test]
fn grey_colours_throw_the_shadow_of_their_luma_and_classified_voxels_that_of_their_values() {
    let one = cube(|p| 0.5 * both(p));
    let points = [(-1.0, 0.0), (0.25, opacity_of(EXTINCTION)), (0.75, 1.0)];
    let mut transfer = white(&points);
    let grey = |value| ColorPoint {
        value,
        srgb: [value; 3],
    };
    transfer.color = vec![grey(0.0), grey(0.5), grey(1.0)];
    let wanted = seen_from_above(&one, &transfer, Beside::Nothing, occluded);
    let others = [&one, &one];
    let found = seen_from_above(&one, &transfer, Beside::Colors(&others), occluded);
    assert_same("colours", &wanted, &found, 4e-6);
    let classified = preclassified(&one, &transfer, 1.0, ColorSpace::Display).unwrap();
    let [red, green, blue, depth] = &classified;
    let others = [green, blue, depth];
    let found = seen_from_above(red, &transfer, Beside::Classified(&others), occluded);
    assert_same("classified", &wanted, &found, 4e-6);
}

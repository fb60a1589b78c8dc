//! The device computes what its CPU reference computes, on every kind of mixture, and bricks change nothing.

use super::*;
use stratavox::technique::Shadows;

fn without_light(shot: &PictureCase) -> PictureCase {
    shot.with(|settings| {
        settings.ambient_occlusion = None;
        if let Some(shading) = &mut settings.shading {
            shading.shadows = Shadows::Off;
        }
    })
}

/// Shots whose technique `has_it`, as their references, and darker than without: the third `turn` of the pipelines, all of them in
/// long sweeps. Drivers take seconds to compile each.
fn check(
    turn: usize,
    volumes: &[&Volume],
    transfer: &TransferFunction,
    beside: Beside,
    has_it: impl Fn(Technique) -> bool,
    what: &str,
) {
    let mut renderer = renderer(volumes);
    let shots = dim_shots(Mode::Composite).filter(|shot| has_it(shot.settings.technique));
    let is_drawn = |i: usize| sweep::is_long() || (i / 2 + i / 6) % 3 == turn;
    for (i, shot) in shots.enumerate().filter(|(i, _)| is_drawn(*i)) {
        let filter = [Filter::Linear, Filter::Nearest][i % 2];
        let shot = shot.with(|settings| settings.filter = filter);
        let dark = scene(&shot, volumes[0], transfer, beside);
        let all = pictures(&mut renderer, &dark);
        let what = format!("{what}, {filter:?}, {}", shot.what());
        let lists = all.each_ref().map(|p| p.pixels.as_flattened());
        compare(&what, 4 * all[0].width, lists, 1.0);
        let bright = without_light(&shot);
        let bright = reference::render::<f32>(&scene(&bright, volumes[0], transfer, beside));
        let pixels = || bright.as_ref().unwrap().pixels.iter().zip(&all[1].pixels);
        let darker = pixels().filter(|(a, b)| a[1] - b[1] > 0.01).count();
        assert!(darker > 60, "{what}: {darker} pixels are darker");
        assert!(pixels().all(|(a, b)| a[3] == b[3]), "{what}: opacity");
    }
}

fn any(_: Technique) -> bool {
    true
}

#[test]
fn channels_labels_and_opacities_are_dimmed_as_their_references() {
    let first = with_holes(volume_of(GRID().dims, sheared_affine(), waves), 211);
    let (second, mut labels) = (ripples(), with_holes(blocks(), 211));
    dim(&mut labels, |label| label == 2);
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let names = label_colors();
    let numbers = channel(&second, &functions[1], Role::Numbers);
    let map = channel(&labels, &names, Role::Labels);
    let opacity = channel(&second, &functions[1], Role::Opacity);
    for (turn, (channels, what)) in [
        (&[numbers][..], "channels"),
        (&[map], "labels"),
        (&[opacity, map], "opacity and labels"),
    ]
    .into_iter()
    .enumerate()
    {
        let others = channels.iter().map(|channel| channel.volume);
        let volumes: Vec<_> = [&first].into_iter().chain(others).collect();
        check(
            turn,
            &volumes,
            &functions[0],
            Beside::Channels(channels),
            any,
            what,
        );
    }
}

#[test]
fn volumes_on_grids_of_their_own_are_dimmed_as_their_references() {
    let first = volume_of(GRID().dims, sheared_affine(), waves);
    let turn = DAffine3::from_axis_angle(DVec3::new(0.3, 0.2, 0.9).normalize(), 0.4);
    let center = GRID().center();
    let affine = DAffine3::from_translation(center)
        * turn
        * DAffine3::from_scale(DVec3::splat(0.6))
        * DAffine3::from_translation(DVec3::splat(-10.0));
    let second = volume_of([20; 3], affine, |p| {
        0.5 + 0.4 * (0.7 * p.y + 0.3 * p.x).sin()
    });
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let channels = [channel(&second, &functions[1], Role::Numbers)];
    let has_places = |technique| technique != Technique::Slices2d;
    let beside = Beside::Channels(&channels);
    check(
        0,
        &[&first, &second],
        &functions[0],
        beside,
        has_places,
        "own grids",
    );
}

#[test]
fn colours_are_dimmed_as_their_references() {
    let red = volume_of(GRID().dims, sheared_affine(), waves);
    let green = with_holes(ripples(), 211);
    let blue = volume_of(GRID().dims, sheared_affine(), |p| 1.0 - waves(p));
    let alpha = volume_of(GRID().dims, sheared_affine(), |p| 0.3 + 0.7 * waves(p));
    let transfer = ramps();
    for (turn, others) in [(1, &[&green, &blue][..]), (2, &[&green, &blue, &alpha])] {
        let volumes: Vec<&Volume> = [&[&red], others].concat();
        let what = format!("{} colours", volumes.len());
        let beside = Beside::Colors(others);
        check(turn, &volumes, &transfer, beside, any, &what);
    }
}

#[test]
fn light_goes_through_bricks_of_mixtures_as_through_one_piece() {
    let first = volume_of(GRID().dims, sheared_affine(), waves);
    let second = ripples();
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let channels = [channel(&second, &functions[1], Role::Numbers)];
    let small = Caps {
        max_image_dimension_3d: 11,
        max_image_array_layers: 8,
        ..Caps::UNLIMITED
    };
    let volumes = vec![&first, &second];
    let mut whole = renderer(&volumes);
    let mut bricks = Renderer::several(device_with(small), volumes).unwrap();
    for shot in dim_shots(Mode::Composite).step_by(4) {
        let scene = scene(&shot, &first, &functions[0], Beside::Channels(&channels));
        let wanted = whole.render(&scene, &[]).unwrap().picture;
        let found = bricks.render(&scene, &[]).unwrap().picture;
        let what = format!("bricks, {}", shot.what());
        Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 2e-6).assert_holds();
    }
}

//! The volume among a host's meshes: rays, which read its depth buffer, and slices, which are tested against it, show
//! the same.
#![cfg(feature = "png")]

#[path = "../examples/meshes/main.rs"]
#[allow(dead_code, reason = "its `main` is not called")]
mod example;

use stratavox::picture::read_image;
use stratavox::technique::Technique;

fn pixels(technique: Technique) -> Vec<[f32; 4]> {
    let folder = tempfile::tempdir().unwrap();
    example::run(folder.path(), technique, 1).unwrap();
    read_image(&folder.path().join("000.png")).unwrap().pixels
}

#[test]
fn rays_and_slices_stand_alike_among_meshes() {
    let [rays, slices] = [Technique::Raycast, Technique::Slices3d].map(pixels);
    let pairs = rays.iter().zip(&slices);
    let off = pairs.map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max));
    let off: Vec<f32> = off.collect();
    // Samples lie elsewhere: bone, lit by differences of voxels, is rough. One that stands in front of the ring where
    // the other stands behind it would be off by half of white and more, all over where they cross.
    let wrong = off.iter().filter(|&&off| off > 0.35).count();
    assert!(
        wrong < off.len() / 1000,
        "{wrong} pixels are of another thing"
    );
    // Stripes of the ring, blue and orange, and the head between them.
    let count = |is: &dyn Fn(&[f32; 4]) -> bool| rays.iter().filter(|p| is(p)).count();
    let blue = count(&|p| p[2] > 2.0 * p[0] && p[2] > 0.2);
    let orange = count(&|p| p[0] > 4.0 * p[2] && p[0] > 0.2);
    let bone = count(&|p| p[0] > 0.3 && p[2] > 0.3 && p[0] >= p[2]);
    assert!(
        blue > 500 && orange > 500 && bone > 2000,
        "{blue} {orange} {bone}"
    );
}

//! The volume among a host's meshes: rays and slices on one lattice show the same, behind and before the meshes.

use crate::meshes_example as example;
use stratavox::color::encode_srgb;
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
    let codes = |pixel: &[f32; 4]| [0, 1, 2].map(|c| 255.0 * encode_srgb(f64::from(pixel[c])));
    let off = |(a, b): (&[f32; 4], &[f32; 4])| {
        let (a, b) = (codes(a), codes(b));
        (0..3usize)
            .map(|c| f64::abs(a[c] - b[c]))
            .fold(0.0, f64::max)
    };
    let off: Vec<f64> = rays.iter().zip(&slices).map(off).collect();
    let count = |most: f64| off.iter().filter(|&&off| off > most).count();
    println!("{:?}", [0.5, 1.5, 2.5, 5.0, 20.0].map(count));
    // Each takes the same samples. A target of 8-bit sRGB holds each picture within 1.1 codes (as it is read half a code,
    // as it is blended 0.6), and rays end where 2^-13 of the light is left, which is 0.4 of a code: 2.6 codes together.
    let most = 2.0 * 1.1 + 0.4;
    assert_eq!(
        count(most),
        0,
        "pixels that are off by more than {most} codes"
    );
    // Stripes of the ring, blue and orange, and the head between them.
    let count = |is: &dyn Fn(&[f32; 4]) -> bool| rays.iter().filter(|p| is(p)).count();
    let blue = count(&|p| p[2] > 2.0 * p[0] && p[2] > 0.2);
    let orange = count(&|p| p[0] > 4.0 * p[2] && p[0] > 0.2);
    let bone = count(&|p| p[0] > 0.3 && p[2] > 0.3 && p[0] >= p[2]);
    // Tubes before the head and behind it.
    let green = count(&|p| p[1] > 1.5 * p[0] && p[1] > 1.2 * p[2] && p[1] > 0.2);
    assert!(
        blue > 500 && orange > 500 && bone > 2000 && green > 500,
        "{blue} {orange} {bone} {green}"
    );
}

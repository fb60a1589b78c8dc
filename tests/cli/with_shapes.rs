//! Surfaces and points beside a volume. Drawn by the CPU reference on the CPU.

use crate::person::Folder;
use std::fs;

const SIDE: usize = 80;
/// A quarter of a voxel a pixel.
const VIEW: &str = "--projection orthographic --view-height 20 --size 80x80 --eye 30,20,25 --target 0,0,0 --up 0,0,1 --look plain \
                    --background none --device reference --force";
const RADIUS: f64 = 7.0;

/// Voxels of a unit side around zero with the distance to a sphere's surface, positive inside.
fn folder() -> Folder {
    let folder = Folder::new();
    let header = "NRRD0004\ntype: float\ndimension: 3\nsizes: 24 24 24\nencoding: raw\nendian: little\n\
                  space: right-anterior-superior\nspace origin: (-11.5,-11.5,-11.5)\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n\n";
    let mut bytes = header.as_bytes().to_vec();
    let at = |i: usize| i as f64 - 11.5;
    for i in 0..24_usize.pow(3) {
        let [x, y, z] = [at(i % 24), at(i / 24 % 24), at(i / 576)];
        let inside = RADIUS - (x * x + y * y + z * z).sqrt();
        bytes.extend((inside as f32).to_le_bytes());
    }
    folder.file("ball.nrrd", bytes);
    folder
}

fn floats(folder: &Folder, name: &str) -> Vec<f32> {
    let bytes = fs::read(folder.path(name)).expect("a file");
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (numbers, _) = bytes[start..].as_chunks::<4>();
    numbers.iter().map(|b| f32::from_le_bytes(*b)).collect()
}

/// Colours, and depths.
fn drawn(folder: &Folder, words: &str) -> (Vec<[f32; 4]>, Vec<f32>) {
    let ran = folder.run(&format!("render {words} {VIEW} -o p.npy --aov depth"));
    ran.assert_done();
    let colors = floats(folder, "p.npy").as_chunks::<4>().0.to_vec();
    (colors, floats(folder, "p.depth.npy"))
}

/// Voxels from the middle of the picture to that of a pixel.
fn out(pixel: usize) -> f64 {
    let [x, y] = [pixel % SIDE, pixel / SIDE].map(|n| (n as f64 + 0.5) / 4.0 - 10.0);
    x.hypot(y)
}

/// The triangles and the rays see the same trilinear numbers. Both surfaces are within h^2/8 * 2/R of the sphere, which is .036
/// voxels, and a ray between two samples half a voxel apart within .005 of its own.
const OFF: f64 = 0.08;
/// The normal of a triangle in a voxel is off by no more than half of its longest side, sqrt(3) voxels, over the radius: .124.
const LIGHT: f64 = 0.7 * 0.124;

#[test]
fn a_surface_that_was_written_lies_where_the_volume_has_that_value() {
    let folder = folder();
    let (rays, depths) = drawn(&folder, "ball.nrrd --mode iso --iso 0");
    for name in ["s.stl", "s.ply", "s.glb"] {
        let ran = folder.run(&format!("convert ball.nrrd -o {name} --iso 0"));
        ran.assert_done();
        let (found, found_depths) = drawn(
            &folder,
            &format!("ball.nrrd --hide-volume --with {name},color=1:0.5:0"),
        );
        let mut compared = 0;
        for pixel in 0..SIDE * SIDE {
            let out = out(pixel);
            let is_seen = [rays[pixel][3], found[pixel][3]].map(|alpha| alpha > 0.5);
            if (out - RADIUS).abs() > OFF {
                assert_eq!(is_seen, [out < RADIUS; 2], "{name} at {out}");
            }
            if out < 0.95 * RADIUS {
                compared += 1;
                let facing = (1.0 - (out / RADIUS).powi(2)).sqrt();
                let off = f64::from((depths[pixel] - found_depths[pixel]).abs()) * facing;
                assert!(off < OFF, "{name}: {off} at {out}");
                // As bright as a dull ball under a light at the eye, .3 + .7 cos; red is full, green half of sRGB.
                let [red, green, blue, _] = found[pixel].map(f64::from);
                assert!(
                    (red - (0.3 + 0.7 * facing)).abs() < LIGHT,
                    "{name}: {red} at {out}"
                );
                assert!(
                    (green / red - 0.2140).abs() < 1e-3 && blue == 0.0,
                    "{name}: {green}"
                );
            }
        }
        assert!(compared > 2000, "{compared}");
    }
    // Half of it is cut away, and it is moved.
    let (cut, _) = drawn(
        &folder,
        "ball.nrrd --hide-volume --with s.stl --clip 0,0,1,0",
    );
    let count = |colors: &[[f32; 4]]| colors.iter().filter(|c| c[3] > 0.5).count();
    assert!(
        count(&cut) > 500 && count(&cut) < count(&rays),
        "{}",
        count(&cut)
    );
    let (moved, _) = drawn(
        &folder,
        "ball.nrrd --hide-volume --with s.stl,shift=0:0:100",
    );
    assert_eq!(count(&moved), 0);
}

#[test]
fn a_surface_hides_what_lies_behind_it_and_fog_before_it_stays() {
    let folder = folder();
    folder
        .run("convert ball.nrrd -o s.ply --iso 0")
        .assert_done();
    let fog = "ball.nrrd --window=-20,7 --mode composite";
    let (alone, _) = drawn(&folder, fog);
    let (both, _) = drawn(&folder, &format!("{fog} --with s.ply,color=1:0:0"));
    let middle = SIDE / 2 * SIDE + SIDE / 2;
    // Red through the fog before it, whose own colour is left of it.
    let [red, green] = [0, 1].map(|c| [both[middle][c], alone[middle][c]]);
    assert!(red[0] > red[1] + 0.01 && red[0] < 0.95, "{red:?}");
    assert!(green[0] < green[1] - 0.01 && green[0] > 0.05, "{green:?}");
    // Beside the ball nothing is other than it was.
    for pixel in (0..SIDE * SIDE).filter(|&pixel| out(pixel) > RADIUS + OFF) {
        assert_eq!(both[pixel], alone[pixel], "{pixel}");
    }
}

#[test]
fn points_are_spheres_in_the_colours_of_their_values() {
    let folder = folder();
    folder.file("p.csv", "x,y,z,v\n0,0,0,1\n5,0,2,2\n");
    let words = "ball.nrrd --hide-volume --with p.csv,colormap=grey --sphere-size 12";
    let (colors, _) = drawn(&folder, words);
    let middle = SIDE / 2 * SIDE + SIDE / 2;
    assert_eq!(colors[middle][3], 1.0);
    let bright = |c: &&[f32; 4]| c[3] == 1.0 && c[0] > 0.5;
    assert!(colors.iter().filter(bright).count() > 40);
    let (one, _) = drawn(&folder, "ball.nrrd --hide-volume --with p.csv,color=0:1:0");
    let greener = one.iter().filter(|c| c[3] == 1.0 && c[1] > c[0]).count();
    assert!(greener > 20, "{greener}");
    // What is kept draws the same.
    let words = format!("render {words} {VIEW} -o a.npy --save-scene s.json");
    folder.run(&words).assert_done();
    folder
        .run("render --scene s.json --device reference -o b.npy --force")
        .assert_done();
    assert_eq!(floats(&folder, "a.npy"), floats(&folder, "b.npy"));
}

#[test]
fn what_a_surface_has_not_is_refused_by_name() {
    let folder = folder();
    folder
        .run("convert ball.nrrd -o s.stl --iso 0")
        .assert_done();
    let bytes = fs::read(folder.path("s.stl")).expect("a surface");
    folder.file("cut.stl", &bytes[..bytes.len() - 7]);
    folder.file("p.csv", "x,y,z,v\n0,0,0,1\n5,0,2,2\n");
    for (words, wanted) in [
        ("s.stl,preset=pet", "preset is of volumes"),
        (
            "s.stl,window=0:1",
            "window is of values, and a surface has none",
        ),
        ("cut.stl", "cut.stl: stl field `length`: wanted the"),
        ("none.glb", "none.glb"),
        ("p.csv --section axial", "its spheres are symbols"),
        ("s.stl --section axial", "a plane meets a surface in a line"),
        ("s.stl --technique pathtrace", "--with ends rays and slices"),
    ] {
        let ran = folder.run(&format!(
            "render ball.nrrd --with {words} -o p.png --device reference"
        ));
        assert_ne!(ran.code, 0, "{words}");
        assert!(ran.err.contains(wanted), "{words}: {}", ran.err);
    }
    let ran = folder
        .run("render ball.nrrd --with s.stl,shift=50:0:0 -o p.png --size 16x16 --device reference");
    assert!(
        ran.err.contains("it lies outside of the box of the volume"),
        "{}",
        ran.err
    );
}

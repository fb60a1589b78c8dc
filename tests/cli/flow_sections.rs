//! Lines of the wind and of the map where planes cut them: clip planes, sections and slabs.

use crate::flow_drawn::{SIDE, STORM, VIEW, fixture, picture, places};
use crate::person::Folder;
use std::fs;

const SEEDS: &str = "--flow stream --flow-seeds rake:-15,-15,2,15,15,9,6";
const LOOK: &str = "--look plain --variable vapor --mode composite --hide-volume --flow-style tube --flow-width 2 \
                    --flow-color 0:1:0";

/// Pixels in which something is drawn, and where their middles lie in the world, seen from above.
fn drawn(folder: &Folder, words: &str) -> Vec<[f64; 2]> {
    let pixels = picture(folder, &format!("{SEEDS} {LOOK} {words}"));
    let half = 0.5 * SIDE as f64;
    let place = |i: usize| {
        [
            (i % SIDE) as f64 + 0.5 - half,
            half - (i / SIDE) as f64 - 0.5,
        ]
    };
    let seen = (0..pixels.len()).filter(|&i| pixels[i][3] > 0.0);
    seen.map(place).collect()
}

/// That there is something where `is_left` says all of a line, and nothing far from where it says any.
fn assert_cut(folder: &Folder, words: &str, left_by: impl Fn([f64; 3]) -> f64) {
    let drawn = drawn(folder, words);
    let (mut inside, mut outside) = (0, 0);
    for [x, y, z] in places(folder, SEEDS) {
        let near = |&[a, b]: &[f64; 2]| (a - x).hypot(b - y) < 1.2;
        // A line is one wide to each side, and chords are 3 long.
        match left_by([x, y, z]) {
            depth if depth > 0.0 => {
                assert!(drawn.iter().any(near), "{words}: nothing at {x} {y} {z}");
                inside += 1;
            }
            depth if depth < -1.5 => outside += 1,
            _ => {}
        }
    }
    assert!(
        inside > 8 && outside > 8,
        "{words}: {inside}, {outside} vertices tell nothing"
    );
    let all = places(folder, SEEDS);
    let left: Vec<_> = all.iter().filter(|place| left_by(**place) > -2.6).collect();
    for [x, y] in drawn {
        let is_near = left
            .iter()
            .any(|place| (place[0] - x).hypot(place[1] - y) < 2.6);
        assert!(is_near, "{words}: a line at {x} {y}");
    }
}

#[test]
fn a_slab_shows_the_lines_in_it_and_a_clip_plane_cuts_them() {
    let folder = Folder::new();
    let view = "--view-height 60 --size 60x60 --background none";
    let slab = format!("--section axial --target 0,0,6 --thickness 3 {view}");
    assert_cut(&folder, &slab, |[_, _, z]| 1.5 - (z - 6.0).abs());
    let above = format!("{VIEW} --eye 0,0,100 --up 0,1,0");
    assert_cut(&folder, &format!("--clip 1,0,0,2 {above}"), |[x, ..]| {
        x - 2.0
    });
    let whole = drawn(&folder, &above);
    let beside = drawn(&folder, &format!("--clip 1,0,0,2 {above}"));
    let right: Vec<_> = whole.into_iter().filter(|[x, _]| *x > 2.0).collect();
    assert_eq!(beside, right, "lines stand upright on the picture");
}

#[test]
fn a_section_of_one_sample_shows_where_lines_go_through_it() {
    let folder = Folder::new();
    let view = "--view-height 60 --size 60x60 --background none";
    let points = drawn(
        &folder,
        &format!("--section sagittal --target 0,0,6 {view}"),
    );
    assert!(!points.is_empty(), "lines go through the plane");
    // From the left north is on the left: across is -y, and up z around 6.
    let all = places(&folder, SEEDS);
    for [across, up] in &points {
        let near = |[x, y, z]: &[f64; 3]| x.abs() < 3.0 && (y + across).hypot(z - 6.0 - up) < 4.5;
        assert!(all.iter().any(near), "a line at {across} {up}");
    }
    let planes = format!("--section axial --at 4,8 {view}");
    let words = format!("{SEEDS} {LOOK} {planes}");
    folder
        .run(&format!("render {STORM} {words} -o b.png"))
        .assert_done();
}

#[test]
fn a_map_lies_on_a_level_section_whatever_its_height() {
    let folder = Folder::new();
    let file = fixture("theta.nc");
    let look = "--view-height 400 --size 60x60 --background none --look plain --variable pot --map graticule=1";
    let render = |words: &str| {
        let ran = folder.run(&format!("render {file} {look} {words} -o a.npy --force"));
        ran.assert_done();
        let bytes = fs::read(folder.path("a.npy")).expect("a picture");
        bytes[bytes.len() - 16 * SIDE * SIDE..].to_vec()
    };
    let is_drawn = |bytes: &[u8]| -> Vec<bool> {
        let alpha = |b: &[u8]| f32::from_le_bytes(b[12..].try_into().expect("four bytes"));
        bytes.chunks(16).map(|pixel| alpha(pixel) > 0.0).collect()
    };
    let eye = "--eye 415.3234,5670.9491,9999 --target 415.3234,5670.9491,0 --up 0,1,0 --projection orthographic";
    let from_above = is_drawn(&render(&format!("{eye} --hide-volume")));
    assert!(from_above.iter().filter(|is| **is).count() > 200);
    let target = "--target 415.3234,5670.9491,0 --mode composite --hide-volume";
    for plane in ["--at 3", "--at 40", "--at 40 --thickness 30"] {
        let section = is_drawn(&render(&format!("--section axial {plane} {target}")));
        assert!(section == from_above, "{plane}: other pixels");
    }
    // Over the values of the plane.
    let beside = render("--section axial --at 40");
    let alone = fs::read(folder.path("a.npy")).expect("a picture");
    assert!(alone.ends_with(&beside));
    let without = folder.run(&format!(
        "render {file} --view-height 400 --size 60x60 --background none --look plain --variable pot --section axial --at 40 \
         -o b.npy"
    ));
    without.assert_done();
    let plain = fs::read(folder.path("b.npy")).expect("a picture");
    let plain = &plain[plain.len() - 16 * SIDE * SIDE..];
    let differs = beside
        .chunks(16)
        .zip(plain.chunks(16))
        .filter(|(a, b)| a != b);
    assert!(differs.count() > 100, "the map is seen over the values");
}

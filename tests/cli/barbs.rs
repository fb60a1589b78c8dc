//! Wind barbs in pictures: `ground.nc` has winds to the east of 25, 50 and 2 knots on three heights, on both sides of the
//! equator.

use crate::person::Folder;
use std::fs;

const SIDE: usize = 100;
/// From above; 10 degrees are 20 pixels, 15 degrees east and the equator lie in the middle.
const VIEW: &str = "--look plain --hide-volume --eye 1667.9264,0,9999 --target 1667.9264,0,0 --up 0,1,0 --projection orthographic \
                    --view-height 5559.755 --size 100x100 --background none";

fn ground() -> String {
    format!(
        "{}/tests/fixtures/netcdf/ground.nc",
        env!("CARGO_MANIFEST_DIR")
    )
}

/// Whether something is drawn at each pixel.
struct Drawn(Vec<bool>);

impl Drawn {
    fn of(folder: &Folder, words: &str) -> Self {
        let ran = folder.run(&format!(
            "render {} --variable ua {words} {VIEW} -o a.npy --force",
            ground()
        ));
        ran.assert_done();
        let bytes = fs::read(folder.path("a.npy")).expect("a picture");
        let numbers = &bytes[bytes.len() - 16 * SIDE * SIDE..];
        let alpha = |pixel: &[u8]| f32::from_le_bytes(pixel[12..].try_into().expect("four bytes"));
        Self(numbers.chunks(16).map(|pixel| alpha(pixel) > 0.0).collect())
    }

    fn at(&self, x: f64, y: f64) -> bool {
        self.0[y as usize * SIDE + x as usize]
    }

    /// At a pixel, or at one beside it.
    fn near(&self, x: f64, y: f64) -> bool {
        let beside = [-1.0, 0.0, 1.0];
        let all = beside
            .into_iter()
            .flat_map(|dy| beside.map(|dx| [x + dx, y + dy]));
        all.into_iter().any(|[x, y]| self.at(x, y))
    }

    fn count(&self) -> usize {
        self.0.iter().filter(|is| **is).count()
    }
}

/// Pixels of the places of barbs.
fn places() -> impl Iterator<Item = [f64; 2]> {
    let along = [20.0, 40.0, 60.0, 80.0];
    along.into_iter().flat_map(move |y| along.map(|x| [x, y]))
}

#[test]
fn a_west_wind_has_its_staff_in_the_west_and_feathers_to_the_pole() {
    let folder = Folder::new();
    let drawn = Drawn::of(&folder, "--barbs=0");
    for [x, y] in places() {
        let pole = if y < 50.0 { -1.0 } else { 1.0 };
        // A staff is 16 pixels long; two full feathers and a half one lean to the west by 60 degrees.
        assert!((1..16).all(|k| drawn.at(x - f64::from(k), y)), "{x} {y}");
        assert!(!drawn.at(x + 2.0, y) && !drawn.at(x - 8.0, y - 2.0 * pole));
        for (along, reach) in [(16.0, 6.4), (13.92, 6.4), (11.84, 3.2)] {
            for part in [0.35, 0.6, 0.85] {
                let place = [
                    x - along - part * reach * 0.5,
                    y + pole * part * reach * 0.866,
                ];
                assert!(drawn.near(place[0], place[1]), "{x} {y}: {along} {part}");
                assert!(
                    !drawn.at(place[0], y - pole * (part * reach * 0.866 + 1.0)),
                    "{x} {y}"
                );
            }
        }
    }
}

#[test]
fn fifty_knots_are_a_filled_flag_and_two_are_a_circle() {
    let folder = Folder::new();
    let drawn = Drawn::of(&folder, "--barbs=750m");
    for [x, y] in places() {
        let pole = if y < 50.0 { -1.0 } else { 1.0 };
        // Its foot from 12.8 to 16 pixels, its tip 6.4 away.
        for (along, side) in [(15.0, 1.5), (15.4, 3.0), (14.2, 1.0), (15.6, 4.5)] {
            assert!(
                drawn.at(x - along, y + pole * side),
                "{x} {y}: {along} {side}"
            );
        }
        assert!(!drawn.at(x - 9.0, y + pole * 2.5) && !drawn.at(x - 12.5, y + pole * 5.0));
    }
    let calm = Drawn::of(&folder, "--barbs=2");
    for [x, y] in places() {
        // 2.08 pixels.
        for (dx, dy) in [(2.0, 0.0), (-2.1, 0.0), (0.0, 2.0), (0.0, -2.1)] {
            assert!(calm.at(x + dx, y + dy), "{x} {y}: {dx} {dy}");
        }
        assert!(!calm.at(x - 6.0, y) && !calm.at(x, y - 5.0));
    }
}

#[test]
fn levels_heights_steps_and_other_winds_are_what_words_say() {
    let folder = Folder::new();
    let lowest = Drawn::of(&folder, "--barbs");
    assert!(
        lowest.0 == Drawn::of(&folder, "--barbs=250m").0
            && lowest.0 == Drawn::of(&folder, "--barbs=,1").0
    );
    // The means of neighbours are those of an even wind.
    assert_eq!(
        Drawn::of(&folder, "--barbs=500m").count(),
        Drawn::of(&folder, "--barbs=500m").count()
    );
    let few = Drawn::of(&folder, "--barbs=0,3");
    assert!(few.at(18.0, 20.0) && few.at(78.0, 80.0) && !few.at(38.0, 40.0));
    // A wind of other names: from the south.
    let turned = Drawn::of(&folder, "--barbs=0 --wind va,ua,none");
    assert!(turned.at(40.0, 52.0) && !turned.at(28.0, 40.0));
    let ran = folder.run(&format!(
        "render {} --variable ua --barbs=1,2 -o b.png --size 40x30",
        ground()
    ));
    ran.assert_done();
    let wanted = "barbs: half 5, full 10, flag 50 kt, at level 1, 750 m, every 2 columns: 4 barbs";
    assert!(ran.err.contains(wanted), "{ran:#?}");
}

#[test]
fn what_barbs_mean_is_written_in_the_picture() {
    let folder = Folder::new();
    let words =
        "--look plain --variable ua --hide-volume --barbs --size 240x160 --background black";
    let read = |name: &str| fs::read(folder.path(name)).expect(name);
    for (name, annotate) in [
        ("bar.png", "--annotate bar"),
        ("time.png", "--annotate source"),
        ("none.png", ""),
    ] {
        folder
            .run(&format!("render {} {words} {annotate} -o {name}", ground()))
            .assert_done();
    }
    assert!(read("bar.png") != read("none.png") && read("bar.png") != read("time.png"));
}

#[test]
fn barbs_that_cannot_be_are_refused_by_name() {
    let folder = Folder::new();
    for (words, wanted) in [
        ("--barbs=3", "--barbs 3: wanted a level from 0 to 2"),
        ("--barbs=850hPa", "heights of the input are no pressures"),
        ("--barbs=9km", "the wind has no data there"),
        ("--barbs=1,0", "columns over 0"),
        ("--barbs=high", "wanted a level such as 0, or a height"),
        ("--barb-color red", "--barbs"),
        ("--wind ua,va", "--wind names a wind that nothing draws"),
        ("--barbs --wind ua,nothing", "nothing"),
        ("--barbs --technique shear-warp", "not for shear-warp"),
        ("--barbs --section axial", "--barbs with --section"),
    ] {
        let ran = folder.run(&format!(
            "render {} --variable ua {words} -o a.png --size 20x20",
            ground()
        ));
        assert!([2, 3].contains(&ran.code), "{words}: {ran:#?}");
        assert!(ran.err.contains(wanted), "{words}: {ran:#?}");
    }
    let ran = folder.run("render phantom:head,n=8 --barbs -o a.png --size 20x20");
    assert!(ran.code == 2 && ran.err.contains("no wind"), "{ran:#?}");
}

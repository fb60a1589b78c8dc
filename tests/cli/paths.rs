//! Path tracing from the command line.

use crate::person::Folder;
use std::fs;
#[cfg(unix)]
use std::io::{BufRead, BufReader};
#[cfg(unix)]
use std::process::{Command, Stdio};

const SMALL: &str = "--size 24x20 --spp 2 --force";

#[test]
fn a_saved_scene_of_the_cinematic_look_draws_the_same_picture() {
    let folder = Folder::new();
    folder
        .run(&format!(
            "render phantom:head,n=24 --look cinematic -o a.png --save-scene s.json {SMALL}"
        ))
        .assert_done();
    folder.run("render --scene s.json -o b.png").assert_done();
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert!(read("a.png") == read("b.png"));
    let scene = String::from_utf8(read("s.json")).expect("text");
    for word in [
        "pathtrace",
        "surface-scattering",
        "environment",
        "camera:",
        "exposure",
    ] {
        let underscored = word.replace('-', "_");
        assert!(
            scene.contains(word) || scene.contains(&underscored),
            "{word}: {scene}"
        );
    }
}

#[test]
fn flags_win_over_the_look_and_change_the_picture() {
    let folder = Folder::new();
    let mut seen = Vec::new();
    for words in [
        "",
        "--seed 1",
        "--exposure 0",
        "--bounces 1",
        "--bounces 0",
        "--density-scale 3",
        "--albedo 0.3",
        "--phase hg:-0.7",
        "--environment 2,0,0",
        "--surface-scattering 0",
        "--light 0,0,1",
        "--light-size 0",
        "--point-light 40,12,30",
        "--point-light 40,12,30,1,0.5,0",
        "--point-light 40,12,30,1,1,1,9",
        "--disc-light 40,12,30,9",
        "--disc-light 40,12,30,9,0,1,0",
        "--f0 0.9",
        "--roughness 0.1",
        "--aperture-radius 4",
        "--aperture-radius 4 --focus-distance 20",
        "--tone none",
        "--tone filmic",
        "--exposure=-1",
        "--technique raycast",
        "--device reference",
    ] {
        let ran = folder.run(&format!(
            "render phantom:head,n=24 --look cinematic {words} -o a.png {SMALL}"
        ));
        ran.assert_done();
        let bytes = fs::read(folder.path("a.png")).expect("a picture");
        assert!(!seen.contains(&bytes), "{words} changes nothing");
        seen.push(bytes);
    }
}

#[test]
fn what_paths_do_not_go_with_is_refused_by_name() {
    let folder = Folder::new();
    for n in [8, 10] {
        folder
            .run(&format!(
                "convert phantom:sphere,n={n} -o l{n}.nrrd --type u8 --window 0,1"
            ))
            .assert_done();
    }
    for (words, said) in [
        ("--mode mip", "mode mip"),
        ("--filter cubic", "the filter cubic"),
        ("--shading phong", "shading"),
        ("--ambient-occlusion 0.5", "ambient occlusion"),
        ("--aa 4", "rays a pixel"),
        ("--jitter", "lattice jitter"),
        ("--preintegrated", "pre-integrated"),
        ("--adaptive-steps 0.01", "adaptive"),
        ("--color-space display", "linear light"),
        ("--labels l8.nrrd --iso 0.5", "a path-traced surface"),
        ("--with l10.nrrd", "labels on one grid"),
        (
            "--preset boundaries --gradient-filter sobel",
            "central differences",
        ),
        ("--crop 0,4,0,8,0,8 --cut-faces", "cut faces"),
        ("--flow stream --aa 1", "--flow"),
        ("--phase mie", "hg:G"),
        ("--phase hg:1", "-0.99 to 0.99"),
        ("--albedo 2", "light would grow"),
        ("--environment=-1,0,0", "sky"),
        ("--density-scale 0", "--density-scale"),
        ("--density-scale -1", "--density-scale"),
        ("--density-scale 1e6", "collisions in a macro cell"),
        (
            "--density-scale 1e6 --device reference",
            "collisions in a macro cell",
        ),
        ("--light-size 120", "90 degrees"),
        ("--point-light 1,2", "X,Y,Z"),
        ("--point-light 1,2,3,1,1,1,0", "noise never ends"),
        ("--point-light 9,9,9 --target 9,9,9", "turned to"),
        ("--disc-light 1,2,3,0", "radius over 0"),
        (
            "--light 1,0,0 --light 0,1,0 --point-light 9,9,9 --point-light 9,9,8 --disc-light 9,9,7,1",
            "5",
        ),
        ("--spp 0", "--spp"),
        ("--spp 3 --denoise-picture", "4 or more"),
        ("--surface-scattering=-1", "surfaces"),
        ("--f0 2", "reflectance"),
        ("--roughness 0", "0.05 to 1"),
        ("--aperture-radius 0", "--aperture-radius"),
        (
            "--aperture-radius 1 --projection orthographic",
            "perspective",
        ),
        ("--focus-distance 1", "--aperture-radius"),
        ("--noise 0", "--noise"),
        ("--seconds=-1", "--seconds"),
        ("--exposure 99", "-64 to 64"),
        ("--noise 0.1 --device reference", "--device reference"),
        ("--seconds 9 --device reference", "--device reference"),
    ] {
        let ran = folder.run(&format!(
            "render phantom:sphere,n=8 --technique pathtrace {words} -o q.png --size 20x20"
        ));
        ran.assert_refused(2, &[said]);
    }
    let layer = "render phantom:sphere,n=8 --technique pathtrace -o q.exr --size 20x20 --aov";
    for (words, said) in [
        ("position", "--aov position needs"),
        ("value", "--aov value needs"),
        ("noise --device reference", "--device reference"),
        (
            "transmittance --environment 1,1,1 --background environment",
            "--background",
        ),
    ] {
        let ran = folder.run(&format!("{layer} {words}"));
        ran.assert_refused(2, &[said]);
    }
    for layer in [
        "noise", "albedo", "direct", "indirect", "emission", "bounces",
    ] {
        let words = format!("render phantom:sphere,n=8 -o q.exr --size 20x20 --aov {layer}");
        let ran = folder.run(&words);
        ran.assert_refused(2, &["--technique pathtrace"]);
    }
    let ran = folder.run("render phantom:sphere,n=8 --spp 3 -o q.png --size 20x20");
    ran.assert_done();
    assert!(
        ran.err.contains("without --technique pathtrace"),
        "{}",
        ran.err
    );
}

/// A wall that begins half way between the voxels 3 and 4 along x, in air; seen along x from 20 before the first voxel.
fn wall(folder: &Folder) -> &'static str {
    let mut bytes = b"NRRD0005\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 8 8 8\n\
        space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n"
        .to_vec();
    bytes.extend((0..512).map(|i| if i % 8 < 4 { 0 } else { 200 }));
    fs::write(folder.path("wall.nrrd"), bytes).expect("a file");
    "render wall.nrrd --look plain --technique pathtrace --size 24x20 --spp 2 --force --iso 100 --density-scale 1e-6 --eye=-20,3.5,3.5 --target 3.5,3.5,3.5 --up 0,0,1 --aperture-radius 1"
}

#[test]
fn a_lens_is_focused_on_what_the_middle_shows() {
    let folder = Folder::new();
    let words = wall(&folder);
    let read = |name: &str| fs::read(folder.path(name)).expect("a file");
    let said = |ran: &crate::person::Ran| -> f64 {
        let (_, word) = ran.err.split_once("--focus-distance ").expect(&ran.err);
        let number = word.split_whitespace().next().expect("a number");
        number.parse().expect(word)
    };
    // The value is 100 half way from 0 to 200: 23.5 ahead.
    let auto = folder.run(&format!(
        "{words} --focus-distance auto -o a.npy --save-scene s.json"
    ));
    auto.assert_done();
    let ahead = said(&auto);
    assert!((ahead - 23.5).abs() < 1e-3, "{ahead}");
    for (more, name) in [
        (format!("--focus-distance {ahead}"), "b.npy"),
        ("--scene s.json".to_owned(), "b.npy"),
    ] {
        let words = match more.contains("scene") {
            true => format!("render {more} -o {name} --force"),
            false => format!("{words} {more} -o {name}"),
        };
        folder.run(&words).assert_done();
        assert!(read("a.npy") == read(name), "{more}");
    }
    folder
        .run(&format!("{words} --focus-distance target -o b.npy"))
        .assert_done();
    folder.run(&format!("{words} -o c.npy")).assert_done();
    assert!(read("b.npy") == read("c.npy"));
    let ran = folder.run(&format!(
        "{words} --focus-distance auto --device reference -o c.npy"
    ));
    ran.assert_done();
    assert!((said(&ran) - 23.5).abs() < 1e-3, "{}", ran.err);
    // Nothing is there: the target stays.
    let up = words.replace(
        "--target 3.5,3.5,3.5 --up 0,0,1",
        "--target=-20,3.5,30 --up 1,0,0",
    );
    let ran = folder.run(&format!("{up} --focus-distance auto -o c.npy"));
    ran.assert_done();
    assert!(ran.err.contains("the middle shows nothing"), "{}", ran.err);
    let film = words.replace("render", "animate");
    let ran = folder.run(&format!(
        "{film} --focus-distance auto --turntable 2 -o f.gif"
    ));
    ran.assert_refused(2, &["--focus-distance auto", "a film"]);
    let ran = folder
        .run("bench wall.nrrd --technique pathtrace --aperture-radius 1 --focus-distance auto");
    ran.assert_refused(2, &["--focus-distance auto", "a bench"]);
    let ran = folder.run(&format!("{words} --focus-distance near -o c.npy"));
    ran.assert_refused(2, &["target, or auto"]);
}

/// Films have the layers of each of their frames.
#[test]
fn films_have_layers_of_paths() {
    let folder = Folder::new();
    let of = "phantom:head,n=16 --look plain --technique pathtrace --surface-scattering 8 --size 24x20 --spp 4";
    let layers = "--aov albedo,normal,depth,direct,indirect,bounces,noise --denoise-picture";
    folder
        .run(&format!(
            "animate {of} {layers} --view left --turntable 4 -o f/%02d.npy"
        ))
        .assert_done();
    folder
        .run(&format!(
            "render {of} {layers} --azimuth 450 --elevation 0 --seed 3 -o a.npy"
        ))
        .assert_done();
    for layer in [
        "", ".albedo", ".normal", ".depth", ".direct", ".bounces", ".noise",
    ] {
        let read =
            |name: &str| fs::read(folder.path(&format!("{name}{layer}.npy"))).expect("a file");
        // The last frame of a turn by quarters that begins at 180 degrees.
        assert!(read("f/03") == read("a"), "{layer}");
        assert!(read("f/00") != read("f/03"), "{layer}");
    }
}

#[test]
fn the_samples_of_paths_are_their_number() {
    let folder = Folder::new();
    let words = "phantom:head,n=24 --technique pathtrace --size 24x20 --spp 3";
    folder
        .run(&format!("render {words} -o a.png --timings t.json"))
        .assert_done();
    let text = fs::read_to_string(folder.path("t.json")).expect("timings");
    assert!(text.contains("\"samples\": 1440"), "{text}");
    for key in ["samples_per_s", "collisions_per_sample"] {
        assert!(!text.contains(&format!("\"{key}\": null")), "{text}");
    }
    let ran = folder.run(&format!("bench {words} --repeat 1 --json b.json"));
    ran.assert_done();
    let ran = folder.run(&format!("animate {words} --turntable 2 -o f.gif"));
    ran.assert_done();
    let ran = folder.run(&format!("render {words} --stream -o b.png"));
    ran.assert_refused(2, &["pathtrace"]);
}

#[test]
fn pictures_that_end_by_themselves_say_how_many_paths_they_have() {
    let folder = Folder::new();
    let words = "render phantom:head,n=24 --technique pathtrace --size 24x20 --force -o a.png";
    let ran = folder.run(&format!("{words} --noise 0.5 --timings t.json"));
    ran.assert_done();
    assert!(ran.err.contains("16 paths a pixel, noise"), "{}", ran.err);
    let text = fs::read_to_string(folder.path("t.json")).expect("timings");
    assert!(text.contains("\"samples\": 7680"), "{text}");
    let ran = folder.run(&format!("{words} --seconds 0.000001"));
    ran.assert_done();
    assert!(ran.err.contains("paths a pixel"), "{}", ran.err);
    let ran = folder.run(&format!("{words} --spp 4"));
    ran.assert_done();
    assert!(!ran.err.contains("paths a pixel"), "{}", ran.err);
}

/// How many paths there are, how much noise and how long the rest takes.
#[test]
fn programs_are_told_how_far_paths_are() {
    let folder = Folder::new();
    let words = "render phantom:head,n=24 --technique pathtrace --size 24x20 -o a.png";
    let ran = folder.run(&format!("{words} --spp 12 --progress json"));
    ran.assert_done();
    let told: Vec<serde_json::Value> = ran
        .err
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .filter(|line: &serde_json::Value| line.get("samples").is_some())
        .collect();
    let samples: Vec<_> = told.iter().map(|line| line["samples"].as_u64()).collect();
    assert_eq!(samples, [2, 4, 6, 8, 12].map(Some), "{}", ran.err);
    assert!(told[0]["noise"].is_null() && told[1]["noise"].as_f64() > Some(0.0));
    assert!(told[0]["seconds_left"].as_f64() > Some(0.0));
    assert_eq!(told[4]["seconds_left"].as_f64(), Some(0.0));
}

/// Functions of gradients, labels and volumes beside: the picture is another one than without.
#[test]
fn paths_go_through_functions_of_gradients_and_several_volumes() {
    let folder = Folder::new();
    folder
        .run("convert phantom:sphere,n=24 -o other.nrrd --type u8 --window 0,1")
        .assert_done();
    let mut seen = Vec::new();
    for words in [
        "",
        "--preset boundaries",
        "--with other.nrrd,color=red,window=0:255",
        "--labels other.nrrd",
        "--opacity-from other.nrrd",
    ] {
        let ran = folder.run(&format!(
            "render phantom:sphere,n=24,type=f32 --look cinematic {words} -o a.png {SMALL}"
        ));
        ran.assert_done();
        let bytes = fs::read(folder.path("a.png")).expect("a picture");
        assert!(!seen.contains(&bytes), "{words} changes nothing");
        seen.push(bytes);
    }
}

/// Water and ice of clouds are white, scatter forward and have no surfaces; flags win.
#[test]
fn clouds_are_white_under_the_cinematic_look() {
    let folder = Folder::new();
    let scene = |words: &str| -> serde_json::Value {
        let ran = folder.run(&format!(
            "render phantom:storm,n=16 --time 4 --look cinematic {words} -o a.png --save-scene s.json {SMALL}"
        ));
        ran.assert_done();
        let text = fs::read_to_string(folder.path("s.json")).expect("a scene");
        serde_json::from_str(&text).expect("JSON")
    };
    let cloud = scene("").to_string();
    for word in ["hg:0.85", "0.999"] {
        assert!(cloud.contains(word), "{word}: {cloud}");
    }
    assert!(scene("--phase rayleigh").to_string().contains("rayleigh"));
    let wind = scene("--variable w").to_string();
    assert!(!wind.contains("hg:0.85"), "{wind}");
}

/// PNG goes through a tone curve; numbers of light do not.
#[test]
fn tone_is_for_screens_alone() {
    let folder = Folder::new();
    for (name, words) in [("a", ""), ("b", "--tone neutral --exposure 1")] {
        for ending in ["npy", "png"] {
            folder
                .run(&format!(
                    "render phantom:head,n=24 --size 24x20 -o {name}.{ending} {words}"
                ))
                .assert_done();
        }
    }
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert!(read("a.npy") == read("b.npy"));
    assert!(read("a.png") != read("b.png"));
    let words = "render phantom:head,n=24 --size 24x20 --force";
    let ran = folder.run(&format!("{words} -o b.npy --tone neutral"));
    ran.assert_done();
    assert!(ran.err.contains("holds light as it is"), "{}", ran.err);
    let ran = folder.run(&format!(
        "{words} -o b.png --tone neutral --color-space display"
    ));
    ran.assert_refused(2, &["--color-space display"]);
    folder
        .run("animate phantom:head,n=24 --size 24x20 --turntable 1 -o b.apng --tone neutral --exposure 1")
        .assert_done();
    folder
        .run("animate phantom:head,n=24 --size 24x20 --turntable 1 -o a.apng")
        .assert_done();
    assert!(read("a.apng") != read("b.apng"));
}

/// A picture of Radiance, without runs: red, green, blue and the exponent of each pixel.
fn hdr(width: u32, height: u32, pixel: impl Fn(u32) -> [u8; 4]) -> Vec<u8> {
    let mut bytes =
        format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    bytes.extend((0..width * height).flat_map(pixel));
    bytes
}

#[test]
fn a_picture_of_the_sky_lights_and_lies_behind() {
    let folder = Folder::new();
    // 128 / 256 * 2^1 = 1, and a sun of 64.
    let sky = hdr(16, 8, |i| {
        if i == 35 {
            [128, 128, 128, 135]
        } else {
            [128, 128, 128, 129]
        }
    });
    fs::create_dir(folder.path("skies")).expect("a folder");
    fs::write(folder.path("skies/sun.hdr"), sky).expect("a file");
    let words = "render phantom:head,n=24 --technique pathtrace --size 24x20 --spp 4 --force";
    let mut seen = Vec::new();
    for more in [
        "--environment skies/sun.hdr",
        "--environment skies/sun.hdr --environment-turn 90",
        "--environment skies/sun.hdr --environment-strength 0.5",
        "--environment skies/sun.hdr --background environment",
        "--environment 1,1,1",
        "--environment 1,1,1 --background environment",
        "--environment 1,1,1 --environment-strength 0.5",
    ] {
        folder
            .run(&format!("{words} {more} -o a.png"))
            .assert_done();
        let bytes = fs::read(folder.path("a.png")).expect("a picture");
        assert!(!seen.contains(&bytes), "{more}");
        seen.push(bytes);
    }
    folder
        .run(&format!(
            "{words} --environment skies/sun.hdr -o a.png --save-scene skies/s.json"
        ))
        .assert_done();
    folder
        .run("render --scene skies/s.json -o b.png")
        .assert_done();
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert!(read("a.png") == read("b.png"));
    let scene = String::from_utf8(read("skies/s.json")).expect("text");
    assert!(scene.contains("\"sun.hdr\""), "{scene}");
}

#[test]
fn what_is_no_sky_is_refused_by_name() {
    let folder = Folder::new();
    let black = hdr(16, 8, |_| [0; 4]);
    let square = hdr(8, 8, |_| [128, 128, 128, 129]);
    let cut = hdr(16, 8, |_| [128, 128, 128, 129])[..200].to_vec();
    let huge = hdr(40_000, 1, |_| [0; 4])[..60].to_vec();
    for (name, bytes) in [
        ("black.hdr", black),
        ("square.hdr", square),
        ("cut.hdr", cut),
        ("huge.hdr", huge),
        ("text.hdr", b"no picture".to_vec()),
    ] {
        fs::write(folder.path(name), bytes).expect("a file");
    }
    let words = "render phantom:head,n=8 --technique pathtrace --size 8x8 --spp 1 -o a.png";
    for (file, code, said) in [
        ("black.hdr", 3, "it is black"),
        ("square.hdr", 3, "8 x 8"),
        ("cut.hdr", 3, "cut.hdr"),
        ("huge.hdr", 3, "huge.hdr"),
        ("text.hdr", 3, "text.hdr"),
        ("none.exr", 3, "none.exr"),
        ("1,2", 2, "a picture .hdr or .exr"),
        ("sky.jpg", 2, "a picture .hdr or .exr"),
    ] {
        let ran = folder.run(&format!("{words} --environment {file}"));
        ran.assert_refused(code, &[said]);
    }
    let ran = folder.run(&format!("{words} --environment-turn 3"));
    ran.assert_refused(2, &["--environment"]);
    let ran = folder.run("render phantom:head,n=8 --size 8x8 -o a.png --background environment");
    ran.assert_refused(2, &["--background environment"]);
}

/// Once: the picture of what has been traced is written. Of the CPU reference there is none.
#[cfg(unix)]
#[test]
fn an_interrupt_writes_the_picture_of_the_paths_that_there_are() {
    let folder = Folder::new();
    for (device, is_written) in [("", true), ("--device reference", false)] {
        let words = format!(
            "render phantom:head,n=24 --technique pathtrace --spp 1000000 --size 24x20 --progress json -o a.png --force {device}"
        );
        let mut child = folder
            .command(&words)
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut stderr = BufReader::new(child.stderr.take().expect("a pipe")).lines();
        let is_drawing = |line: &String| match is_written {
            true => line.contains("\"part\""),
            false => line.contains("\"stage\":\"draw\""),
        };
        let begun = stderr.by_ref().map_while(Result::ok).find(is_drawing);
        assert!(begun.is_some(), "{words}: nothing is drawn");
        let kill = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(kill.expect("kill runs").success());
        let said: Vec<String> = stderr.map_while(Result::ok).collect();
        let status = child.wait().expect("an end");
        assert_eq!(status.code(), Some(130), "{said:?}");
        let found = fs::read(folder.path("a.png"));
        assert_eq!(found.is_ok(), is_written, "{said:?}");
        let says_paths = said.iter().any(|line| line.contains("paths a pixel"));
        assert_eq!(says_paths, is_written, "{said:?}");
        let _ = fs::remove_file(folder.path("a.png"));
    }
}

#[test]
fn solid_surfaces_change_the_picture_and_others_colours_are_refused() {
    let folder = Folder::new();
    let of_paths = "render phantom:head,n=24 --technique pathtrace --light 1,-1,1";
    let mut seen = Vec::new();
    for words in [
        "",
        "--iso 300",
        "--iso 300 --iso-opacity 0.5 --iso-color red --f0 0.5",
    ] {
        folder
            .run(&format!(
                "{of_paths} {words} -o a.png --save-scene s.json {SMALL}"
            ))
            .assert_done();
        folder
            .run("render --scene s.json -o b.png --force")
            .assert_done();
        let [one, again] =
            ["a.png", "b.png"].map(|name| fs::read(folder.path(name)).expect("a file"));
        assert!(one == again, "{words}");
        assert!(!seen.contains(&one), "{words}");
        seen.push(one);
    }
    for (words, wanted) in [
        ("--iso-color-by vapor", "--iso-color-by is for --mode iso"),
        ("--iso-opacity 0.5", "--iso names 0"),
        ("--iso 1,2,3,4,5,6,7,8,9", "at most 8"),
    ] {
        let refused = folder.run(&format!("{of_paths} {words} -o c.png {SMALL}"));
        refused.assert_refused(2, &[wanted]);
    }
}

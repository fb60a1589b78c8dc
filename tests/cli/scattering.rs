//! Light that is scattered once, from the command line.

use crate::person::Folder;
use std::fs;

const SMALL: &str = "render phantom:head,n=24 --size 24x20 --force";

#[test]
fn flags_of_the_medium_and_of_light_change_the_picture() {
    let folder = Folder::new();
    let mut seen = Vec::new();
    for words in [
        "",
        "--scattering none",
        "--shadows off",
        "--shadows march",
        "--light 0,0,1",
        "--light 0,0,1 --light-size 40",
        "--light 0,0,1 --shadows march",
        "--environment 1,1,1",
        "--environment 1,1,1 --light 0,0,1",
        "--environment 1,1,1 --shadows off",
        "--density-scale 3",
        "--albedo 0.3",
        "--phase hg:-0.7",
        "--phase rayleigh",
        "--clip 1,0,0,0",
        "--point-light 40,12,12 --shadows march",
        "--point-light 40,12,12,1,0,0 --shadows march",
        "--point-light 40,12,12 --shadows off",
    ] {
        // The last word of a flag counts, and there may be one.
        let scattering = match words {
            "--scattering none" => "",
            _ => "--scattering single",
        };
        let ran = folder.run(&format!("{SMALL} {scattering} {words} -o a.png"));
        ran.assert_done();
        let picture = fs::read(folder.path("a.png")).expect("a picture");
        assert!(!seen.contains(&picture), "{words:?} changes nothing");
        seen.push(picture);
    }
    let ran = folder.run(&format!("{SMALL} --scattering single --spp 4 -o a.png"));
    ran.assert_done();
    assert!(
        ran.err.contains("without --technique pathtrace"),
        "{}",
        ran.err
    );
}

#[test]
fn a_saved_scene_draws_the_same_picture() {
    let folder = Folder::new();
    let words = "--scattering single --light camera:-1,1,1 --environment 0.2,0.3,0.4";
    folder
        .run(&format!("{SMALL} {words} -o a.png --save-scene s.json"))
        .assert_done();
    folder.run("render --scene s.json -o b.png").assert_done();
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert!(read("a.png") == read("b.png"));
    for (word, of) in [("scattering", "single"), ("environment", "0.2,0.3,0.4")] {
        let scene = String::from_utf8(read("s.json")).expect("text");
        assert!(
            scene.contains(word) && scene.contains(of),
            "{word}: {scene}"
        );
    }
}

#[test]
fn what_does_not_go_with_it_is_refused_by_name() {
    let folder = Folder::new();
    folder.file("sky.exr", []);
    for (words, said) in [
        ("single --technique slices-3d", "ray casting"),
        ("single --technique pathtrace", "--bounces 1"),
        ("multiple", "--technique pathtrace"),
        ("double", "none or single"),
        ("single --mode mip", "composite"),
        ("single --filter cubic", "--filter linear"),
        ("single --shading phong", "--shading"),
        ("single --ambient-occlusion 1", "occlusion"),
        ("single --shadows half-angle", "slices-3d"),
        ("single --environment sky.exr", "even sky"),
        ("single --environment 1,1,1 --phase hg:0.5", "isotropic"),
        (
            "single --background environment",
            "--background environment",
        ),
        ("single --shadows march --light-size 3", "look wide"),
        ("single --point-light 9,9,9", "--shadows march"),
        ("single --disc-light 9,9,9,1", "--technique pathtrace"),
        ("single --color-space display", "linear light"),
        ("single --phase hg:0.995", "0.99"),
        ("single --albedo 1.5", "light would grow"),
        ("single --preintegrated", "pre-integrated"),
        ("single --adaptive-steps 0.1", "adaptive"),
        ("single --empty-space octree", "macro cells"),
        ("single --lattice bresenham", "lattice"),
        ("single --cut-faces --crop 1,9,1,9,1,9", "cut faces"),
        ("single --component all", "one volume of numbers"),
        ("single --preset boundaries", "one volume of numbers"),
        ("single --stream", "--scattering single"),
        ("none --shadows march", "--scattering single"),
        (
            "none --technique pathtrace --shadows march",
            "--scattering single",
        ),
    ] {
        let input = match words {
            "single --component all" => "phantom:cells,n=16",
            _ => "phantom:sphere,n=8",
        };
        let ran = folder.run(&format!(
            "render {input} --scattering {words} -o q.png --size 20x20"
        ));
        ran.assert_refused(2, &[said]);
    }
}

/// Keys of a function's file that say what matter does to light.
#[test]
fn keys_of_a_medium_are_drawn_by_what_scatters_and_named_elsewhere() {
    let folder = Folder::new();
    let tf = |extinction: &str| {
        format!(
            "{{\"stratavox_transfer_function\":1,\"color\":[[0,0.5,0.5,0.5]],\"extinction\":{extinction},\
             \"albedo\":[[0,0.9,0.5,0.2]],\"emission\":[[0,0,0,0],[1000,0.01,0,0]],\"phase\":{{\"g\":0.7}}}}"
        )
    };
    folder.file("grey.json", tf("[[0,0],[1000,0.2]]"));
    folder.file("three.json", tf("[[0,0,0,0],[1000,0.2,0.1,0.05]]"));
    let read = |name: &str| fs::read(folder.path(name)).expect("a picture");
    let run = |words: &str| folder.run(&format!("{SMALL} {words}"));
    let draw = |words: &str| {
        let ran = run(words);
        ran.assert_done();
        assert!(
            !ran.err.contains("transfer function are for"),
            "{}",
            ran.err
        );
        read("a.png")
    };
    let paths = "--technique pathtrace --spp 2 -o a.png";
    let grey = draw(&format!("--tf grey.json {paths}"));
    assert!(grey != draw(&format!("--tf three.json {paths}")));
    // A word wins over the file.
    assert!(grey == draw(&format!("--tf grey.json --phase hg:0.7 {paths}")));
    assert!(grey != draw(&format!("--tf grey.json --phase isotropic {paths}")));
    let once = draw("--tf grey.json --scattering single -o a.png");
    assert!(once == draw("--tf grey.json --scattering single -o a.png --save-scene s.json"));
    folder.run("render --scene s.json -o b.png").assert_done();
    assert!(once == read("b.png"));
    let refused = run("--tf three.json --scattering single -o a.png");
    assert!(
        !refused.err.is_empty() && refused.err.contains("--technique pathtrace"),
        "{refused:?}"
    );
    assert!(refused.err.contains("three colours"), "{refused:?}");
    let ran = run("--tf grey.json -o a.png");
    ran.assert_done();
    let note = "extinction, albedo, emission and phase of the transfer function are for --technique pathtrace and --scattering single";
    assert!(ran.err.contains(note), "{}", ran.err);
}

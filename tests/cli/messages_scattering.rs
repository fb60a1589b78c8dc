//! What is said of words for light that scatters: light that is missing, flags that change nothing, and hints that help.

use crate::person::Folder;
use std::fs;

const SMALL: &str = "--size 16x16 --force";
const PATHS: &str = "--technique pathtrace --spp 1";
const SINGLE: &str = "--scattering single";

/// Matter everywhere, with these keys.
fn function(keys: &str) -> String {
    format!("{{\"stratavox_transfer_function\":1,\"color\":[[0,0.5,0.5,0.5]],{keys}}}")
}

const EXTINCTION: &str = "\"extinction\":[[-2000,0.1],[2000,0.1]]";

/// Whether a colour of a picture of 16 x 16 pixels is over 0.
fn is_lit(npy: &[u8]) -> bool {
    let pixels = npy[npy.len() - 16 * 16 * 16..].chunks_exact(16);
    let mut colors = pixels.flat_map(|pixel| pixel[..12].chunks_exact(4));
    colors.any(|c| f32::from_le_bytes(c.try_into().expect("four bytes")) > 0.0)
}

#[test]
fn a_picture_without_light_says_so_once_and_what_gives_light() {
    let folder = Folder::new();
    let emission = |light: &str| function(&format!("{EXTINCTION},\"emission\":[[0,{light}]]"));
    folder.file("shines.json", emission("0,0.1,0"));
    folder.file("dark.json", emission("0,0,0"));
    let said = |ran: &crate::person::Ran| {
        ran.assert_done();
        let count = ran.err.matches("no light: the picture is black").count();
        assert_eq!(count, ran.err.matches("give light").count(), "{ran:#?}");
        count
    };
    for how in [PATHS, SINGLE] {
        for (words, is_dark) in [
            ("", false),
            ("--environment 0,0,0", true),
            ("--environment 0,0,0.1", false),
            ("--light 0,0,1,0,0,0", true),
            ("--light 0,0,1,0,0,0 --light 0,0,1", false),
            ("--light 0,0,1,0,0,0 --environment 0,0,0", true),
            ("--environment 0,0,0 --light 0,0,1,0,0,1", false),
            ("--environment 0,0,0 --tf shines.json", false),
            ("--environment 0,0,0 --tf dark.json", true),
            ("--point-light 40,12,12,0,0,0 --shadows off", true),
        ] {
            let ran = folder.run(&format!(
                "render phantom:head,n=8 {how} {words} -o a.npy {SMALL}"
            ));
            assert_eq!(said(&ran), usize::from(is_dark), "{how} {words}: {ran:#?}");
            let picture = fs::read(folder.path("a.npy")).expect("a picture");
            assert_eq!(is_lit(&picture), !is_dark, "{how} {words}");
        }
        let ran = folder.run(&format!(
            "animate phantom:head,n=8 {how} --environment 0,0,0 --turntable 3 -o f.gif {SMALL}"
        ));
        assert_eq!(said(&ran), 1, "{how}: {ran:#?}");
    }
    // Matter shines in its colours, and is not scattered.
    for how in ["--technique pathtrace --spp 1 --bounces 0", ""] {
        let ran = folder.run(&format!(
            "render phantom:head,n=8 {how} --environment 0,0,0 -o a.npy {SMALL}"
        ));
        assert_eq!(said(&ran), 0, "{how}: {ran:#?}");
    }
}

#[test]
fn a_sky_behind_needs_a_sky() {
    let folder = Folder::new();
    let words = format!("render phantom:head,n=8 --background environment -o a.png {SMALL}");
    let ran = folder.run(&format!("{words} {PATHS}"));
    ran.assert_refused(
        2,
        &["--background environment", "hint: --environment R,G,B"],
    );
    folder
        .run(&format!("{words} {PATHS} --environment 1,1,1"))
        .assert_done();
    // The look has one.
    folder
        .run(&format!("{words} --look cinematic --spp 1"))
        .assert_done();
}

/// The notes that something has no effect, one a line.
fn idle(ran: &crate::person::Ran) -> Vec<String> {
    ran.assert_done();
    let lines = ran.err.lines().filter(|line| line.contains("no effect"));
    lines.map(str::to_owned).collect()
}

#[test]
fn flags_that_change_nothing_are_named_and_no_others() {
    let folder = Folder::new();
    let material = "--material 0.1,0.7,0.2,10";
    let of_paths = "no effect with --technique pathtrace";
    for (how, words, said) in [
        (PATHS, "", vec![]),
        (PATHS, "--f0 0.1 --roughness 0.3", vec![]),
        (
            PATHS,
            "--shadows off",
            vec![format!("--shadows off has {of_paths}")],
        ),
        (
            PATHS,
            "--shadows volume",
            vec![format!("--shadows volume has {of_paths}")],
        ),
        (PATHS, material, vec![format!("--material has {of_paths}")]),
        (
            PATHS,
            "--half-gradient 3 --samples-per-voxel 2",
            vec![format!(
                "--half-gradient and --samples-per-voxel have {of_paths}"
            )],
        ),
        (
            PATHS,
            "--roughness 0.3",
            vec!["--roughness has no effect without --f0".to_owned()],
        ),
        (
            SINGLE,
            material,
            vec!["--material has no effect with --scattering single".to_owned()],
        ),
        (
            SINGLE,
            "--spp 4",
            vec!["--spp has no effect without --technique pathtrace".to_owned()],
        ),
        (
            "",
            "--spp 4",
            vec!["--spp has no effect without --technique pathtrace".to_owned()],
        ),
        (
            "",
            "--spp 4 --seed 2 --phase rayleigh",
            vec![
                "--spp and --seed have no effect without --technique pathtrace".to_owned(),
                "--phase has no effect without --technique pathtrace or --scattering single"
                    .to_owned(),
            ],
        ),
    ] {
        let ran = folder.run(&format!(
            "render phantom:head,n=8 {how} {words} -o a.png {SMALL}"
        ));
        let found = idle(&ran);
        assert_eq!(found.len(), said.len(), "{how} {words}: {ran:#?}");
        for (found, said) in found.iter().zip(&said) {
            assert!(found.ends_with(said.as_str()), "{how} {words}: {ran:#?}");
        }
    }
    // Nor are words that a look or a scene has by itself.
    for words in [
        "render phantom:head,n=8 --look cinematic --spp 1 --save-scene s.json -o a.png",
        "render --scene s.json -o a.png",
    ] {
        let ran = folder.run(&format!("{words} {SMALL}"));
        assert!(idle(&ran).is_empty(), "{words}: {ran:#?}");
    }
}

#[test]
fn a_number_out_of_range_has_a_hint_of_its_own() {
    let folder = Folder::new();
    let refused = |how: &str, words: &str, hint: &str| {
        let ran = folder.run(&format!("render phantom:head,n=8 {how} {words} -o a.png"));
        ran.assert_refused(2, &[&format!("hint: {hint}")]);
    };
    for (words, hint) in [
        ("--spp 3 --denoise-picture", "--spp 16"),
        ("--noise 1e10", "--noise"),
        ("--seconds 1e10", "--seconds"),
        ("--phase hg:2,0.1,0.1", "--phase hg:F"),
        ("--light-size 120", "--light-size"),
        (
            "--environment 1,1,1 --environment-turn 9999",
            "--environment-turn",
        ),
        ("--environment=-1,0,0", "--environment"),
        ("--f0 2", "--f0"),
        ("--roughness 0", "--roughness"),
        ("--surface-scattering=-1", "--surface-scattering"),
        ("--point-light 1,2,3,1,1,1,0", "--point-light"),
        ("--point-light 9,9,9 --target 9,9,9", "--point-light"),
    ] {
        refused("--technique pathtrace", words, hint);
    }
    for how in ["--technique pathtrace", SINGLE] {
        refused(how, "--albedo 2", "--albedo");
        refused(how, "--phase hg:1", "--phase hg:0.8");
    }
}

#[test]
fn what_does_not_go_together_has_a_hint_that_helps() {
    let folder = Folder::new();
    folder
        .run("convert phantom:sphere,n=8 -o l.nrrd --type u8 --window 0,1")
        .assert_done();
    let paths = "--technique pathtrace";
    let single = (SINGLE, "without --scattering single");
    let refused = [
        (
            "phantom:sphere,n=8 --aperture-radius 1 --projection orthographic",
            (
                paths,
                "--projection perspective, or leave out --aperture-radius",
            ),
        ),
        (
            "phantom:sphere,n=9 --with l.nrrd",
            (paths, "--technique raycast"),
        ),
        ("phantom:sphere,n=8 --with l.nrrd", single),
        ("phantom:sphere,n=8 --labels l.nrrd", single),
        ("phantom:cells,n=8 --component all", single),
    ];
    for (words, (how, hint)) in refused {
        let ran = folder.run(&format!("render {words} {how} -o a.png {SMALL}"));
        ran.assert_refused(2, &["hint: ", hint]);
        assert!(!ran.err.contains("docs/matrix.md"), "{ran:#?}");
    }
}

#[test]
fn keys_of_a_medium_are_named_as_the_file_has_them() {
    let folder = Folder::new();
    let opacity = "\"opacity\":[[-2000,0.1],[2000,0.1]]";
    let albedo = "\"albedo\":[[0,0.9,0.5,0.2]]";
    let is_for = "for --technique pathtrace and --scattering single:";
    for (keys, said) in [
        (
            EXTINCTION.to_owned(),
            format!(
                "extinction of the transfer function is {is_for} its colour is drawn, as dense as the mean of its extinction"
            ),
        ),
        (
            format!("{EXTINCTION},{albedo}"),
            format!("extinction and albedo of the transfer function are {is_for}"),
        ),
        (
            format!("{opacity},{albedo}"),
            format!("albedo of the transfer function is {is_for} its colour and opacity are drawn"),
        ),
    ] {
        folder.file("tf.json", function(&keys));
        let ran = folder.run(&format!(
            "render phantom:head,n=8 --tf tf.json -o a.png {SMALL}"
        ));
        ran.assert_done();
        assert!(ran.err.contains(&said), "{keys}: {ran:#?}");
        let speaks = ran.err.contains("opacity");
        assert_eq!(speaks, keys.contains("opacity"), "{ran:#?}");
    }
}

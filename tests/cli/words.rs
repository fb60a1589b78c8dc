//! Words that cannot be followed are refused by name, with exit code 2, before anything is read.

use crate::person::Folder;

#[test]
fn modes_that_walk_along_rays_are_drawn_and_what_they_lack_is_refused_by_name() {
    let folder = Folder::new();
    let of_head = "render phantom:head,n=16 --size 16x16 -o";
    for (nth, (words, note)) in [
        ("--mode iso", "surfaces of the value"),
        (
            "--mode iso --iso -300,250 --iso-color orange,white --aov value,position",
            "",
        ),
        (
            "--mode mida --aov transmittance",
            "maxima are compared between",
        ),
        ("--mode lmip --depth-cue 0.5", "local maxima count over"),
        ("--mode attenuated-mip", ""),
        ("--mode mip --exact-maximum", ""),
    ]
    .into_iter()
    .enumerate()
    {
        let ran = folder.run(&format!("{of_head} {nth}.exr {words}"));
        ran.assert_done();
        assert!(ran.err.contains(note), "{words}: {}", ran.err);
    }
    for (words, named) in [
        (
            "--mode iso --technique slices-3d",
            "--mode iso needs --technique raycast",
        ),
        ("--mode mida --lattice planes", "--lattice planes"),
        ("--mode xray --depth-cue 0.5", "--mode xray"),
        ("--mode average --exact-maximum", "--exact-maximum"),
        ("--mode iso --iso 1,2 --iso-color red", "--iso-color"),
        ("--mode mida --mida-gamma 1.5", "the gamma of MIDA is 1.5"),
    ] {
        let ran = folder.run(&format!("{of_head} a.png {words}"));
        ran.assert_refused(2, &[named, "hint"]);
    }
}

#[test]
fn a_word_that_cannot_be_is_a_usage_error() {
    let folder = Folder::new();
    for (words, name) in [
        ("paint", "paint"),
        ("render -o a.png", "INPUT"),
        ("render phantom:fog -o a.jpg", "a.jpg"),
        ("render phantom:fog -o a.png --size 0x3", "--size"),
        ("render phantom:fog -o a.png --aa 2", "--aa 2"),
        ("render phantom:fog -o a.png --zoom 0", "--zoom"),
        ("render phantom:fog -o a.png --zoom nan", "--zoom"),
        ("render phantom:fog -o a.png --eye 1,2", "--eye"),
        (
            "render phantom:fog -o a.png --eye 1,2,3 --view left",
            "--view",
        ),
        ("render phantom:fog -o a.png --window 3,3", "--window 3,3"),
        ("render phantom:fog -o a.png --preset ct-bones", "ct-bone,"),
        (
            "render phantom:fog -o a.png --background 2,0,0",
            "--background",
        ),
        ("render phantom:fog -o a.png --crop 1,0,0,1,0,1", "--crop"),
        ("render phantom:fog -o a.png --aov depth", "--aov"),
        (
            "render phantom:fog -o a.png --shading phong --mode mip",
            "--shading phong",
        ),
        (
            "render phantom:fog -o a.png --shading phong --material 1,1,1,0",
            "--material",
        ),
        ("render phantom:fog -o a.png --light 0,0,0", "a direction"),
        (
            "render phantom:cells,n=8 -o a.png --shadows half-angle --technique slices-3d --component all",
            "--shadows half-angle is for one number a voxel",
        ),
        ("render phantom:fog -o a.png --repeat 0", "--repeat"),
        ("render phantom:fog -o a.png --bit-depth 12", "--bit-depth"),
        ("render phantom:fog -o a.png --timings a.png", "twice"),
        ("render phantom:fog -o a.png --timings ./a.png", "twice"),
        ("info phantom:fog,n=8 --time 9", "--time 9"),
        ("histogram phantom:fog,n=8 -o h.jpg", "h.jpg"),
        ("histogram phantom:fog,n=8 -o h.png --bins 0", "--bins"),
        (
            "histogram phantom:fog,n=8 -o h.png --window 3,3",
            "--window 3,3",
        ),
        ("histogram phantom:storm,n=8 -o h.png", "several variables"),
        ("preset show ct-bones", "ct-bone,"),
        ("preset show mri --window 3,3", "--window 3,3"),
        ("preset import a.json --window 1,0", "--window 1,0"),
        ("completions tcsh", "tcsh"),
        ("man --force", "--output"),
        ("info phantom:fog,n=8 --component 1", "--component 1"),
        ("render phantom:fog -o a.png --raw 2x2x2,u8", "--raw"),
        (
            "render phantom:fog,n=8 -o a.png --component 1",
            "--component 1",
        ),
        ("render phantom:fog,n=8 -o a.png --time 9", "--time 9"),
    ] {
        let ran = folder.run(words);
        assert_eq!(ran.code, 2, "{words}: {ran:#?}");
        assert!(ran.err.contains(name), "{words}: {ran:#?}");
        assert!(!ran.err.contains("panicked"), "{words}: {ran:#?}");
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

/// What clap refuses too: its own last lines name no verb.
#[test]
fn an_unknown_flag_ends_in_a_hint_that_names_the_verb() {
    let folder = Folder::new();
    for (words, hint) in [
        ("render phantom:fog --nonsense", "`stratavox render --help`"),
        ("render phantom:fog --size", "`stratavox render --help`"),
        ("sheet -o a.png", "`stratavox sheet --help`"),
        ("compare a.png", "`stratavox compare --help`"),
        ("nonsense", "`stratavox --help`"),
        ("--nonsense", "`stratavox --help`"),
    ] {
        let ran = folder.run(words);
        assert_eq!(ran.code, 2, "{words}: {ran:#?}");
        let last = ran.err.trim_end().lines().last().unwrap_or_default();
        let wanted = format!("  hint: {hint} shows examples and lists every flag");
        assert_eq!(last, wanted, "{words}: {ran:#?}");
    }
}

#[test]
fn normals_are_refused_by_name_where_there_is_no_ray_and_no_one_volume() {
    let folder = Folder::new();
    folder.file("v.nrrd", crate::thumbnails::nrrd(4, 0));
    for (words, named) in [
        (
            "phantom:fog,n=8 --technique slices-3d",
            "--technique raycast",
        ),
        ("phantom:fog,n=8 --mode average", "a mode with a depth"),
        ("phantom:cells,n=8", "one number a voxel: --component 0"),
        ("v.nrrd --labels v.nrrd", "one number a voxel: no --labels"),
        ("phantom:fog,n=8 --stream", "no --stream"),
    ] {
        let ran = folder.run(&format!("render {words} --aov normal --size 8x8 -o a.npy"));
        ran.assert_refused(2, &["--aov normal needs", named]);
    }
    let words = "render phantom:sphere,n=16 --mode iso --aov normal --size 8x8 -o a.npy";
    folder.run(words).assert_done();
    let layer = std::fs::read(folder.path("a.normal.npy")).expect("a layer");
    let header = String::from_utf8_lossy(&layer[..128]).into_owned();
    assert!(header.contains("'shape': (8, 8, 3), }"), "{header}");
}

#[test]
fn help_and_version_are_answers_on_standard_output() {
    let folder = Folder::new();
    for words in [
        "--help",
        "render --help",
        "info --help",
        "devices --help",
        "compare --help",
        "bench --help",
        "histogram --help",
        "preset --help",
        "preset import --help",
        "completions --help",
        "man --help",
    ] {
        let ran = folder.run(words);
        ran.assert_done();
        assert!(
            ran.out.contains("stratavox ") && ran.err.is_empty(),
            "{words}: {ran:#?}"
        );
    }
    let ran = folder.run("--version");
    ran.assert_done();
    assert_eq!(
        ran.out,
        format!("stratavox {}\n", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn several_variables_are_an_error_that_lists_them() {
    let folder = Folder::new();
    let words = "render phantom:storm,n=8 --look plain -o a.png --size 8x8 --device reference";
    let refused = folder.run(words);
    refused.assert_refused(2, &["several variables", "--variable"]);
    let listed = refused
        .err
        .split("several variables: ")
        .nth(1)
        .expect("a list");
    let first = listed.split([',', '\n']).next().expect("a name");
    let ran = folder.run(&format!("{words} --variable {first}"));
    ran.assert_done();
    assert!(
        ran.err.contains("the first of"),
        "the choice of a time is not said: {ran:#?}"
    );
}

#[test]
fn a_flag_without_effect_is_mentioned_and_no_skip_is_always_taken() {
    let folder = Folder::new();
    let ran = folder.run(
        "render phantom:fog,n=8 -o a.png --size 8x8 --device reference --no-skip --order front-to-back",
    );
    ran.assert_done();
    assert!(ran.err.contains("--order has no effect"), "{ran:#?}");
    let ran = folder.run("info phantom:fog,n=8 --time 0");
    ran.assert_done();
    assert!(ran.err.contains("--time has no effect"), "{ran:#?}");
}

#[test]
fn a_step_beyond_the_limit_is_refused_with_a_hint_but_not_in_stacks_that_ignore_it() {
    let folder = Folder::new();
    let words = "render phantom:fog,n=8 --size 8x8 --device reference --samples-per-voxel 1e9";
    folder
        .run(&format!("{words} -o a.png"))
        .assert_refused(6, &["samples, the limit is", "--samples-per-voxel"]);
    let ran = folder.run(&format!("{words} -o b.png --technique slices-2d"));
    ran.assert_done();
    let plain = "render phantom:fog,n=8 --size 8x8 --device reference --technique slices-2d";
    folder.run(&format!("{plain} -o c.png")).assert_done();
    folder.run("compare b.png c.png --at-most 0").assert_done();
}

/// A way to sample that technique or mode lack: said before anything is read, and where it would be right.
#[test]
fn ways_to_sample_are_refused_where_there_are_none() {
    let folder = Folder::new();
    for (words, named) in [
        ("--mode mip --preintegrated", "pre-integrated"),
        ("--smooth", "between slices"),
        ("--technique slices-3d --jitter", "jitter"),
        ("--jitter --lattice planes", "--lattice planes"),
        ("--jitter --lattice bresenham", "--lattice bresenham"),
        (
            "--lattice bresenham --technique slices-2d",
            "the lattice bresenham is for ray casting, not for slices-2d",
        ),
        (
            "--lattice bresenham --mode lmip",
            "is for composite, mip, minip, average and xray, not for mode lmip",
        ),
        (
            "--lattice bresenham --preintegrated",
            "is for the lattices ray, planes and jitter, not for the lattice bresenham",
        ),
        (
            "--lattice bresenham --cut-faces --crop 1,9,1,9,1,9",
            "is for the lattices ray, planes and jitter, not for the lattice bresenham",
        ),
        (
            "--lattice bresenham --adaptive-steps 0.01",
            "is for the lattice of rays, not for bresenham",
        ),
        (
            "--lattice bresenham --section axial",
            "other lattices than that of rays",
        ),
        (
            "--technique shear-warp --mode lmip",
            "shear-warp is for composite, mip, minip, average and xray, not for mode lmip",
        ),
        (
            "--technique shear-warp --lattice planes",
            "a lattice of rays is for ray casting, not for shear-warp",
        ),
        ("--technique shear-warp --jitter", "not for shear-warp"),
        (
            "--technique shear-warp --section axial",
            "leave out --technique",
        ),
        (
            "--technique shear-warp --intermediate 0",
            "wanted voxels, pixels or a number over 0",
        ),
    ] {
        folder
            .run(&format!("render phantom:fog -o a.png {words}"))
            .assert_refused(2, &[named, "hint"]);
    }
}

#[test]
fn features_that_do_not_go_together_are_wrong_words_and_no_limit() {
    let folder = Folder::new();
    let head = "render phantom:head,n=12 --device reference --size 8x8 -o a.png";
    for (words, wanted) in [
        ("--preset boundaries --preintegrated", "its gradient"),
        (
            "--technique slices-2d --smooth --preset boundaries",
            "its gradient",
        ),
        (
            "--shading phong --light 1,0,0 --shadows volume --light-size nan",
            "a number",
        ),
    ] {
        folder
            .run(&format!("{head} {words}"))
            .assert_refused(2, &[wanted]);
    }
    let function = r#"{"stratavox_transfer_function":1,"widgets":[
        {"shape":"contour","value":300,"opacity":0.5,"color":[1,1,1]}]}"#;
    std::fs::write(folder.path("widgets.json"), function).expect("a file");
    folder
        .run(&format!("{head} --color-tf widgets.json"))
        .assert_refused(2, &["--color-tf", "`color`"]);
}

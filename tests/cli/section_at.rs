//! Cuts at positions in the world, one or several of them in one picture.

use crate::person::Folder;
use crate::section::{SIDE, picture, seen, value, values, volume};

#[test]
fn a_position_is_a_place_in_the_world_along_the_axis_that_the_plane_stands_across() {
    let folder = Folder::new();
    volume(&folder);
    for (section, words, named) in [
        ("axial", "--section axial", "axial"),
        ("coronal", "--section coronal", "coronal"),
        ("sagittal", "--section sagittal", "sagittal"),
        // Normals count along themselves, whatever their length.
        ("axial", "--section 0,0,-4 --at -3.5", "-z"),
        ("coronal", "--section 0,0.5,0", "+y"),
    ] {
        let at = if words.contains("--at") {
            ""
        } else {
            "--at 3.5"
        };
        // A target moves what is seen sideways alone.
        for more in ["", "--target 2.5,2.5,2.5"] {
            let words = format!("{words} {at} {more} --device reference");
            let found = values(&folder, &words);
            for (i, found) in found.into_iter().enumerate() {
                let wanted = value(seen(section, [i % SIDE, i / SIDE], 3));
                assert!(
                    (found - wanted).abs() < 1e-3,
                    "{named}, pixel {i}: {found}, not {wanted}"
                );
            }
        }
    }
}

/// The panels of a picture in a row, 16 pixels a side, each as it is drawn alone, to the bit.
fn assert_panels(folder: &Folder, together: &str, alone: &[String]) {
    let window = "--window 0,444 --background 0,0,1";
    let width = alone.len() * 20 - 4;
    let all = picture(folder, &format!("{together} {window}"), [width, 16]);
    let mut shown = Vec::new();
    for (nth, words) in alone.iter().enumerate() {
        let words = format!("{words} --view-height 5 {window}");
        let wanted = picture(folder, &words, [16, 16]);
        for (i, wanted) in wanted.iter().enumerate() {
            let at = i / 16 * width + 20 * nth + i % 16;
            assert_eq!(&all[at], wanted, "{together}: panel {nth}, pixel {i}");
        }
        assert!(!shown.contains(&wanted), "{words}: as another panel");
        shown.push(wanted);
    }
}

#[test]
fn slabs_at_several_positions_are_those_of_single_pictures_to_the_bit() {
    let folder = Folder::new();
    volume(&folder);
    for (section, more) in [
        ("axial", "--thickness 1.5"),
        ("axial", "--thickness 2 --mode mip"),
        ("coronal", ""),
        ("sagittal", "--thickness 0.7 --mode minip"),
    ] {
        // Slabs may overlap, and come in any order.
        let positions = ["3", "1.25", "2"];
        let together = format!("--section {section} --at {} {more}", positions.join(","));
        let alone = positions.map(|at| format!("--section {section} --at {at} {more}"));
        assert_panels(&folder, &together, &alone);
    }
    let alone = [1, 2, 3].map(|nth| format!("--section axial:{nth}/3 --thickness 1.5"));
    assert_panels(&folder, "--section axial:3 --thickness 1.5", &alone);
}

#[test]
fn positions_are_kept_in_a_scene_until_other_planes_are_named() {
    let folder = Folder::new();
    volume(&folder);
    let window = "--window 0,444";
    let size = [36, 16];
    let words = "--section coronal --at 1.5,3.5 --thickness 0.5";
    let first = picture(
        &folder,
        &format!("{words} {window} --save-scene s.json"),
        size,
    );
    assert_eq!(picture(&folder, "--scene s.json", size), first);
    let other = picture(&folder, "--scene s.json --section sagittal", size);
    let wanted = picture(
        &folder,
        &format!("--section sagittal --thickness 0.5 {window}"),
        size,
    );
    assert_eq!(other, wanted);
}

#[test]
fn positions_that_place_no_plane_are_refused() {
    let folder = Folder::new();
    volume(&folder);
    let many = (0..65).map(|_| "2").collect::<Vec<_>>().join(",");
    for (command, words, wanted) in [
        ("render", "--at 2", "--section"),
        (
            "render",
            "--section axial --at 10mm",
            "wanted a number, found \"10mm\"",
        ),
        (
            "render",
            "--section axial,coronal --at 2",
            "planes that face one way",
        ),
        (
            "render",
            "--section axial:3 --at 2",
            "planes that face one way",
        ),
        (
            "render",
            "--section axial --at 2,9",
            "--at 9: the volume lies from 0 to 5 there",
        ),
        ("animate", "--section axial --at 2,3", "several planes"),
    ] {
        let end = if command == "render" { "png" } else { "gif" };
        let words = format!("{command} v.nrrd -o a.{end} {words}");
        folder.run(&words).assert_refused(2, &[wanted]);
    }
    let words = format!("render v.nrrd -o a.png --section axial --at {many}");
    folder
        .run(&words)
        .assert_refused(2, &["at most 64 planes, found 65"]);
    // A slab reaches into the volume from outside.
    folder
        .run("render v.nrrd -o a.png --section axial --at 5.5 --thickness 2 --size 16x16")
        .assert_done();
}

//! Spheres and ribbons along lines, and widths in kilometres.

use crate::person::Folder;
use std::fs;

/// Two pixels a kilometre.
const VIEW: &str = "--variable vapor --hide-volume --projection orthographic --view-height 30 --view top --size 60x60 --look plain \
                    --background none --device reference --force";
const LINE: &str =
    "phantom:storm,n=16 --flow stream --flow-seeds rake:-8,-8,4,8,8,4,3 --flow-color 1:0:0";

fn alphas(folder: &Folder, words: &str) -> (Vec<f32>, String) {
    let ran = folder.run(&format!("render {words} {VIEW} -o a.npy"));
    ran.assert_done();
    let bytes = fs::read(folder.path("a.npy")).expect("a picture");
    let pixels = bytes[bytes.len() - 16 * 3600..].chunks(16);
    let alpha = |pixel: &[u8]| f32::from_le_bytes(pixel[12..].try_into().expect("four bytes"));
    (pixels.map(alpha).collect(), ran.err)
}

fn count(alphas: &[f32]) -> usize {
    alphas.iter().filter(|&&alpha| alpha > 0.0).count()
}

#[test]
fn a_width_in_kilometres_is_that_on_the_ground_and_never_under_a_pixel() {
    let folder = Folder::new();
    let width = |width: &str| {
        alphas(
            &folder,
            &format!("{LINE} --flow-style tube --flow-width {width}"),
        )
        .0
    };
    assert_eq!(width("3km"), width("6"));
    assert_eq!(width("0.001km"), width("1.2"));
    assert!(count(&width("3km")) > 2 * count(&width("2")));
}

#[test]
fn spheres_lie_on_the_line_and_ribbons_are_flat() {
    let folder = Folder::new();
    let style = |style: &str| {
        alphas(
            &folder,
            &format!("{LINE} --flow-style {style} --flow-width 4"),
        )
    };
    let (tube, _) = style("tube");
    let (points, said) = style("points");
    assert!(said.contains("a sphere every "), "{said}");
    assert!(
        count(&points) > 20 && count(&points) < count(&tube),
        "{}",
        count(&points)
    );
    // From above no sphere covers what the tube of the same width does not.
    let beside = tube
        .iter()
        .zip(&points)
        .filter(|(tube, point)| **tube == 0.0 && **point > 0.0);
    assert_eq!(beside.count(), 0);
    // A ribbon that is turned is narrower than a tube seen from above, and never wider.
    let (ribbons, _) = style("ribbons");
    assert!(count(&ribbons) > count(&tube) / 4, "{}", count(&ribbons));
    assert!(count(&ribbons) <= count(&tube) + 20, "{}", count(&ribbons));
}

#[test]
fn styles_and_widths_that_mean_nothing_are_refused_by_name() {
    let folder = Folder::new();
    for (words, wanted) in [
        (
            "phantom:storm,n=16 --flow streak --flow-style points",
            "no particle goes along smoke",
        ),
        (
            "phantom:storm,n=16 --flow streak --flow-style ribbons",
            "no particle goes along smoke",
        ),
        (
            "phantom:storm,n=16 --flow stream --flow-width 50km",
            "--flow-width 50km: wanted over 0 and at most",
        ),
        (
            "phantom:flow,kind=saddle,n=16 --flow stream --flow-width 1km",
            "--flow-width 1km is of the Earth",
        ),
        (
            "phantom:storm,n=16 --flow stream --flow-width 1mile",
            "or a length such as 20km",
        ),
    ] {
        let ran = folder.run(&format!(
            "render {words} -o p.png --size 40x40 --device reference"
        ));
        assert_ne!(ran.code, 0, "{words}");
        assert!(ran.err.contains(wanted), "{words}: {}", ran.err);
    }
}

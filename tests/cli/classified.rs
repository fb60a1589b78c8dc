//! Which of value and material is interpolated, as a person and a file say it.

use crate::person::Folder;
use std::fs;

const HEAD: &str = "phantom:head,n=16 --size 16x16 --device reference";
/// A thin shell that samples miss.
const SHELL: &str = r#"{"stratavox_transfer_function": 1, "color": [[0, 1, 0.5, 0]],
    "opacity": [[90, 0], [100, 0.9], [110, 0]]}"#;

#[test]
fn a_file_asks_for_slabs_and_flags_win() {
    let folder = Folder::new();
    folder.file("plain.json", SHELL);
    let asking = SHELL.replace("1, \"color\"", "1, \"preintegrated\": true, \"color\"");
    folder.file("asking.json", asking);
    let draw = |words: &str| {
        let ran = folder.run(&format!("render --look plain {words} -o a.npy --force"));
        ran.assert_done();
        fs::read(folder.path("a.npy")).expect("a picture")
    };
    let of = |tf: &str, words: &str| draw(&format!("{HEAD} --tf {tf}.json {words}"));
    let (values, slabs) = (of("plain", ""), of("plain", "--preintegrated"));
    let materials = of("plain", "--preclassified");
    assert!(values != slabs && slabs != materials && values != materials);
    let asked = of("asking", "--save-scene s.json");
    assert!(asked == slabs, "a file can ask for slabs");
    assert!(of("asking", "--postclassified") == values, "but flags win");
    assert!(
        of("asking", "--preclassified") == materials,
        "but flags win"
    );
    assert!(draw("--scene s.json") == slabs, "a scene carries the wish");
    assert!(draw("--scene s.json --postclassified") == values);
    let cubic = of("asking", "--filter cubic");
    assert!(
        cubic == of("plain", "--filter cubic"),
        "where there are no slabs the wish is left"
    );
    folder.file(
        "bad.json",
        SHELL.replace("1, \"color\"", "1, \"preintegrated\": 1, \"color\""),
    );
    let ran = folder.run(&format!(
        "render --look plain {HEAD} --tf bad.json -o x.npy"
    ));
    ran.assert_refused(
        3,
        &["bad.json", "`preintegrated`", "true or false", "found 1"],
    );
}

#[test]
fn what_cannot_be_classified_before_it_is_interpolated_says_so() {
    let folder = Folder::new();
    let contour = r#"{"stratavox_transfer_function": 1, "widgets": [
        {"shape": "contour", "value": 5, "opacity": 0.2, "color": [1, 1, 1]}]}"#;
    folder.file("widgets.json", contour);
    for (words, said) in [
        ("--mode mip", "--mode composite"),
        ("--with phantom:head,n=8", "--with"),
        ("--labels l.nrrd", "--labels"),
        ("--filter cubic", "--filter cubic"),
        ("--tf widgets.json", "widgets"),
        ("--preintegrated", "--preintegrated"),
        ("--technique slices-2d --smooth", "--smooth"),
    ] {
        let ran = folder.run(&format!(
            "render --look plain {HEAD} -o x.npy --preclassified {words}"
        ));
        ran.assert_refused(2, &[said]);
    }
    let cells = "phantom:cells,n=8 --size 16x16 --device reference";
    let ran = folder.run(&format!(
        "render --look plain {cells} -o x.npy --preclassified"
    ));
    ran.assert_refused(2, &["--component 0"]);
}

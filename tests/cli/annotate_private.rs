//! What a DICOM file says of a person is not in a picture with all marks: names, numbers, dates, places, words.

use crate::dicom::Dicom;
use crate::person::Folder;
use std::fs;

/// Four places at two times, in files whose elements and names say `private`.
fn scan(folder: &Folder, name: &str, private: &str, date: &str) {
    fs::create_dir(folder.path(name)).expect("a folder");
    for k in 0..8 {
        let mut slice = Dicom::slice(k / 2, [0.0, 0.0, 2.0 * (k / 2) as f64]);
        slice
            .text(0x0008_0018, b"UI", &format!("1.2.3.{k}"))
            .text(0x0020_0013, b"IS", &format!("{k}"))
            // The trigger: what tells the two times apart, and may be written.
            .text(0x0018_1060, b"DS", &format!("{}", 500 * (k % 2)));
        let words: [(u32, &[u8; 2]); 15] = [
            (0x0008_0050, b"SH"), // accession number
            (0x0008_0080, b"LO"), // institution
            (0x0008_0081, b"ST"), // its address
            (0x0008_0090, b"PN"), // referring physician
            (0x0008_1010, b"SH"), // station
            (0x0008_1030, b"LO"), // study
            (0x0008_103e, b"LO"), // series
            (0x0008_1050, b"PN"), // performing physician
            (0x0010_0010, b"PN"), // patient
            (0x0010_0020, b"LO"), // patient's number
            (0x0010_1040, b"LO"), // patient's address
            (0x0010_4000, b"LT"), // comments on the patient
            (0x0018_1030, b"LO"), // protocol
            (0x0020_0010, b"SH"), // study's number
            (0x0020_4000, b"LT"), // comments on the picture
        ];
        for (tag, kind) in words {
            slice.text(tag, kind, private);
        }
        for tag in [0x0008_0020, 0x0008_0021, 0x0010_0030] {
            slice.text(tag, b"DA", date);
        }
        slice.text(0x0010_0040, b"CS", &private[..1]);
        let file = format!("{name}/{private} {k}.dcm");
        fs::write(folder.path(&file), slice.bytes()).expect("a file");
    }
}

#[test]
fn no_private_word_of_a_dicom_file_reaches_a_picture() {
    let folder = Folder::new();
    scan(&folder, "DOE-JOHN", "Doe John", "19700101");
    scan(&folder, "ROE-JANE-1984", "Roe Jane Maria", "19841231");
    let marks = "--annotate bar,time,orientation,scale,source,box,ticks,axes";
    let draw = |scan: &str, words: &str, out: &str| {
        let shot = "--device reference --size 320x240";
        folder
            .run(&format!("render {scan} {words} {shot} -o {out}"))
            .assert_done();
        fs::read(folder.path(out)).expect("a picture")
    };
    let first = draw("DOE-JOHN", marks, "first.png");
    let second = draw("ROE-JANE-1984", marks, "second.png");
    assert!(first == second, "who was scanned changes the picture");
    let plain = draw("DOE-JOHN", "", "plain.png");
    assert!(first != plain, "marks are drawn");
    let later = draw("DOE-JOHN", &format!("{marks} --time 1"), "later.png");
    assert!(first != later, "the time is written");
    // What is asked for is written, and can be told apart in such a picture.
    let titled = |title: &str| {
        let words = format!("{marks},title={title}");
        draw("DOE-JOHN", &words, &format!("{title}.png"))
    };
    assert!(titled("Doe") != titled("Roe"), "words change a picture");
}

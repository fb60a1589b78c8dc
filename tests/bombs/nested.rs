//! Text: structures in structures, entities, lists without an end, in volumes and in the files beside them.

use crate::Bombs;
use std::fs::File;

pub fn add(bombs: &mut Bombs) {
    xml(bombs);
    beside(bombs);
}

fn xml(bombs: &mut Bombs) {
    let head = "<?xml version=\"1.0\"?>";
    let deep = "<ImageData>".repeat(80_000);
    bombs.volume(
        "deep.vti",
        format!("{head}<VTKFile type=\"ImageData\">{deep}</VTKFile>"),
        "",
    );
    let mut entities = String::from("<!DOCTYPE VTKFile [<!ENTITY a0 \"aaaaaaaaaa\">");
    for k in 1..20 {
        let ten = format!("&a{};", k - 1).repeat(10);
        entities += &format!("<!ENTITY a{k} \"{ten}\">");
    }
    let body = "]><VTKFile type=\"ImageData\">&a19;</VTKFile>";
    bombs.volume("entities.vti", format!("{head}{entities}{body}"), "");
    let attributes: String = (0..100_000).map(|k| format!(" a{k}=\"1\"")).collect();
    bombs.volume(
        "attributes.vti",
        format!("{head}<VTKFile type=\"ImageData\"{attributes}></VTKFile>"),
        "",
    );
}

/// Files of `render` and other commands that are no volumes.
fn beside(bombs: &mut Bombs) {
    let deep = format!("{}1{}", "[".repeat(200_000), "]".repeat(200_000));
    let object = |key: &str| format!("{{\"{key}\": 1, \"a\": {deep}}}");
    let picture = "-o a.png --device reference --size 16x16";
    let fog = "phantom:fog,n=8";
    for (name, key, words) in [
        (
            "tf.json",
            "stratavox_transfer_function",
            format!("render {fog} --tf FILE {picture}"),
        ),
        (
            "colors.json",
            "stratavox_transfer_function",
            format!("render {fog} --color-tf FILE {picture}"),
        ),
        (
            "labels.json",
            "stratavox_labels",
            format!("render phantom:cells,n=8 --label-tf FILE {picture}"),
        ),
        (
            "scene.json",
            "stratavox_scene",
            format!("render {fog} --scene FILE {picture}"),
        ),
        (
            "keys.json",
            "stratavox_keyframes",
            format!("animate {fog} --keyframes FILE --size 16x16 --device reference -o f%d.png"),
        ),
        (
            "views.json",
            "views",
            format!("bench {fog} --cameras FILE --device reference"),
        ),
        (
            "import.json",
            "a",
            "preset import FILE -o b.json".to_owned(),
        ),
    ] {
        let text = match key {
            "views" => deep.clone(),
            _ => object(key),
        };
        bombs.folder.write(name, text);
        bombs.run(name, &words.replace("FILE", name), "");
        // 16 GiB that take no room on the disk.
        let sparse = format!("sparse-{name}");
        let file = File::create(bombs.folder.path(&sparse)).expect("a file");
        file.set_len(16 << 30).expect("a length");
        bombs.run(&sparse, &words.replace("FILE", &sparse), "");
    }
    let points: Vec<String> = (0..200_000).map(|k| format!("[{k}, 0, 0, 0]")).collect();
    let points = points.join(",");
    let many = format!(
        "{{\"stratavox_transfer_function\": 1, \"color\": [{points}], \"opacity\": [[0, 1]]}}"
    );
    bombs.folder.write("points.json", many);
    bombs.run(
        "points.json",
        &format!("render {fog} --tf points.json {picture}"),
        "",
    );
    let reference = "{\"stratavox_transfer_function\": 1, \"color\": [[1e308, 1, 1, 1], [-1e308, 0, 0, 0]], \
                     \"opacity\": [[0, 1e308]], \"reference_length\": 1e-300}";
    bombs.folder.write("numbers.json", reference);
    bombs.run(
        "numbers.json",
        &format!("render {fog} --tf numbers.json {picture}"),
        "",
    );
}

//! Variables computed from others of a file of weather, by the program: wherever a variable is named; and the surfaces that
//! nobody names.

use crate::person::Folder;
use serde_json::Value;

const SMALL: &str = "--device reference --size 24x16 --force";

fn wrf() -> String {
    let folder = env!("CARGO_MANIFEST_DIR");
    format!("{folder}/tests/fixtures/netcdf/wrf_derived.nc")
}

/// The number behind `surface of the value `.
fn level(said: &str) -> f64 {
    let rest = said.split_once("surface of the value ");
    let word = rest.and_then(|(_, rest)| rest.split_whitespace().next());
    word.and_then(|word| word.parse().ok())
        .unwrap_or_else(|| panic!("{said}"))
}

#[test]
fn derived_variables_are_named_as_those_of_the_file() {
    let folder = Folder::new();
    let file = wrf();
    for words in [
        "--variable temperature",
        "--variable QVAPOR --mode iso --iso-color-by temperature",
        "--variable temperature --opacity-variable relative_humidity",
        "--variable wind_speed --mode mip",
    ] {
        let ran = folder.run(&format!("render {file} {words} {SMALL} -o a.png"));
        ran.assert_done();
        let noted = ran.err.contains(" is derived: ");
        assert!(noted, "{words}: {}", ran.err);
    }
    let ran = folder.run(&format!("render {file} --variable T {SMALL} -o a.png"));
    ran.assert_done();
    assert!(!ran.err.contains(" is derived: "), "{}", ran.err);
    assert!(
        ran.err.contains("perturbation potential temperature"),
        "{}",
        ran.err
    );
}

#[test]
fn a_part_that_is_missing_is_named() {
    let folder = Folder::new();
    let file = wrf().replace("wrf_derived", "wrf");
    let ran = folder.run(&format!(
        "render {file} --variable temperature {SMALL} -o a.png"
    ));
    ran.assert_refused(
        3,
        &[
            "variable temperature",
            "wanted air_pressure",
            "found `PHB, PH, T",
        ],
    );
}

#[test]
fn info_lists_what_can_be_derived_apart_and_the_map() {
    let folder = Folder::new();
    let ran = folder.run(&format!("info {} --variable T", wrf()));
    ran.assert_done();
    for line in [
        "\nderived      temperature        K, from T, P, PB\n",
        "\n             wind_speed         m s-1, from U, V, W\n",
        "\nvariable     T: all numbers here are its own; 10 more below\n             perturbation potential temperature\n",
        "\nmap          Lambert conformal, true at latitude 30 and 60, standard longitude -98\n",
        "\ncentre       latitude 45.5560, longitude -179.9500\n",
    ] {
        assert!(ran.out.contains(line), "no {line:?} in {}", ran.out);
    }
    let ran = folder.run(&format!("info {} --variable pressure --json", wrf()));
    ran.assert_done();
    let info: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(info["unit"], "Pa");
    assert_eq!(info["derived"][3]["name"], "relative_humidity");
    assert_eq!(
        info["derived"][3]["from"],
        serde_json::json!(["T", "P", "PB", "QVAPOR"])
    );
    assert_eq!(info["map"]["kind"], "Lambert");
    assert_eq!(
        info["map"]["true_latitudes"],
        serde_json::json!([30.0, 60.0])
    );
}

#[test]
fn a_surface_of_what_falls_with_height_is_its_mean_at_a_third_of_the_box_at_all_times() {
    let folder = Folder::new();
    let of = |words: &str| {
        let ran = folder.run(&format!("render {words} --mode iso {SMALL} -o a.png"));
        ran.assert_done();
        level(&ran.err)
    };
    // Half a voxel above the sixth layer: centres of 18 layers lie at 0.5, 1.5, ... km, a third of the box is 6 km.
    let storm = "phantom:storm,n=48,times=3 --variable vapor";
    let values = |time: u32| {
        let words = format!("convert {storm} --time {time} -o v{time}.npy --force");
        folder.run(&words).assert_done();
        let bytes = std::fs::read(folder.path(&format!("v{time}.npy"))).expect("an array");
        let start = bytes.iter().position(|&b| b == b'\n').expect("a header") + 1;
        let numbers = bytes[start..].chunks_exact(4);
        numbers
            .map(|four| f64::from(f32::from_le_bytes(four.try_into().expect("four"))))
            .collect::<Vec<_>>()
    };
    let layer = 48 * 48;
    let means = (0..3).map(|time| {
        let all = values(time);
        all[5 * layer..7 * layer].iter().sum::<f64>() / (2 * layer) as f64
    });
    let wanted = means.sum::<f64>() / 3.0;
    let found = of(storm);
    let rounded = format!("{wanted:.2e}").parse();
    assert_eq!(rounded, Ok(found), "{wanted} to three digits");
    assert_eq!(
        of(&format!("{storm} --time 2")),
        found,
        "one number for all times"
    );
    let film = format!(
        "animate {storm} --mode iso --times --size 24x16 --device reference --force -o a.gif"
    );
    let ran = folder.run(&film);
    ran.assert_done();
    assert_eq!(level(&ran.err), found);

    // Others as their values have it.
    let ran = folder.run(&format!(
        "render phantom:storm,n=16 --variable w --mode iso {SMALL} -o a.png"
    ));
    ran.assert_done();
    assert!(ran.err.contains("surfaces of the value "), "{}", ran.err);
    let ran = folder.run(&format!(
        "render {storm} --mode iso --iso 2 {SMALL} -o a.png"
    ));
    assert!(!ran.err.contains("of the value"), "{}", ran.err);
    let ran = folder.run(&format!(
        "render {storm} --look plain --mode iso {SMALL} -o a.png"
    ));
    assert!(ran.err.contains("surfaces of the value "), "{}", ran.err);
}

/// Between which values the surfaces of a picture, or of a film, have colours by its note.
fn colours(said: &str) -> [f64; 2] {
    let note = said
        .lines()
        .find(|line| line.contains("surfaces are coloured by "));
    let note = note.expect("a note");
    let (_, ends) = note.split_once(", from ").expect("from");
    let mut words = ends.split([' ', ';']);
    let low = words.next().and_then(|word| word.parse().ok());
    let high = words.nth(1).and_then(|word| word.parse().ok());
    [low, high].map(|end| end.expect("a number"))
}

#[test]
fn another_variable_colours_surfaces_over_its_values_there_and_in_a_film_over_those_of_all_times() {
    let folder = Folder::new();
    let storm = "phantom:storm,n=32,times=3";
    let surface = "--variable vapor --mode iso --iso 2 --iso-color-by temperature";
    let of_times = [0, 1, 2].map(|time| {
        let words = format!("render {storm} {surface} --time {time} {SMALL} -o a.png");
        let ran = folder.run(&words);
        ran.assert_done();
        colours(&ran.err)
    });
    let values = |variable: &str| {
        let words = format!("convert {storm} --variable {variable} --time 2 -o v.npy --force");
        folder.run(&words).assert_done();
        let bytes = std::fs::read(folder.path("v.npy")).expect("an array");
        let start = bytes.iter().position(|&b| b == b'\n').expect("a header") + 1;
        let numbers = bytes[start..].chunks_exact(4);
        numbers
            .map(|four| f64::from(f32::from_le_bytes(four.try_into().expect("four"))))
            .collect::<Vec<_>>()
    };
    let (vapor, temperature) = (values("vapor"), values("temperature"));
    // Layers are 32 x 32: the surface lies between a voxel and the one above it in most columns.
    let layer = 32 * 32;
    let cut = (layer..vapor.len()).filter(|&i| vapor[i] < 2.0 && vapor[i - layer] >= 2.0);
    let at_surface = cut.flat_map(|i| [temperature[i], temperature[i - layer]]);
    let mut at_surface: Vec<f64> = at_surface.collect();
    at_surface.sort_by(f64::total_cmp);
    let [low, high] = of_times[2];
    let most = at_surface.len() / 20;
    assert!(low < at_surface[most] && high > at_surface[at_surface.len() - most]);
    let width = at_surface[at_surface.len() - 1] - at_surface[0];
    assert!(
        high - low < 1.1 * width,
        "{low} to {high}, and {width} kelvin there"
    );

    let words = format!("animate {storm} {surface} --times --size 24x16 --force -o a.gif");
    let ran = folder.run(&words);
    ran.assert_done();
    let lows = of_times.map(|[low, _]| low);
    let highs = of_times.map(|[_, high]| high);
    let of_all = [
        lows.into_iter().fold(f64::INFINITY, f64::min),
        highs.into_iter().fold(f64::NEG_INFINITY, f64::max),
    ];
    assert_eq!(colours(&ran.err), of_all);
    assert_ne!(of_all, of_times[0], "colours of the first time alone");
    // A window that is said stays.
    let words = format!("render {storm} {surface} --window 220,300 {SMALL} -o a.png");
    assert_eq!(colours(&folder.run(&words).err), [220.0, 300.0]);
}

#[test]
fn a_variable_of_several_is_drawn_brick_by_brick_with_the_same_surface() {
    let folder = Folder::new();
    let draw = |words: &str| {
        let ran = folder.run(&format!("render {words} --size 24x16 --force -o a.png"));
        ran.assert_done();
        ran.err
    };
    let said = draw(&format!("{} --variable temperature --stream", wrf()));
    assert!(said.contains("temperature is derived: "), "{said}");
    let storm = "phantom:storm,n=24,times=2 --variable vapor --mode iso";
    let [whole, bricks] = ["", "--stream"].map(|word| level(&draw(&format!("{storm} {word}"))));
    assert_eq!(whole, bricks);
}

#[test]
fn quantities_have_their_colours() {
    let folder = Folder::new();
    for (variable, words) in [
        ("temperature", "in the colours of roma"),
        ("vapor", "in the colours of viridis"),
        ("cloud", "in the colours of viridis"),
        ("u", "blue below, red above"),
        ("w", "blue below, red above"),
    ] {
        let ran = folder.run(&format!("info phantom:storm,n=32 --variable {variable}"));
        ran.assert_done();
        assert!(ran.out.contains(words), "{variable}: {}", ran.out);
    }
}

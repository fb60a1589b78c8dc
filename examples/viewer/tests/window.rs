//! The viewer in a window of a display without a screen, with a script for a hand, and the validation layer listening.

mod display;

use display::{Display, skipped, texts};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use stratavox::annotate::{Annotation, Facts, GeometryLegend, Seen};
use stratavox::camera::{Camera, Lens, Orbit};
use stratavox::color::decode_srgb;
use stratavox::gpu::{DeviceChoice, Headless, Options};
use stratavox::offscreen::Renderer;
use stratavox::picture::{Picture, WriteOptions, read_image, write_picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{Light, LightSpace, Settings, Technique};
use stratavox::transfer::{Classified, TransferFunction, ValueSummary, automatic, automatic_in};
use stratavox::volume::{Limits, TimeComponent, Volume, phantom};
use tempfile::TempDir;

impl Display {
    /// A viewer that the validation layer listens to.
    fn heard(&self, folder: &Path) -> Command {
        let mut command = self.viewer(folder);
        command.args(["--validation", "sync"]);
        command
    }

    /// Does what the lines say with `words`; no message of the layer, no error.
    fn play(&self, folder: &Path, words: &[&str], lines: &str) -> Report {
        let script = folder.join("script.txt");
        std::fs::write(&script, lines).unwrap();
        let mut command = self.heard(folder);
        let output = command
            .args(words)
            .arg("--script")
            .arg(script)
            .output()
            .unwrap();
        let text = texts(&output);
        assert!(
            output.status.success(),
            "{:?}: {text}",
            output.status.code()
        );
        Report(text)
    }
}

/// What the viewer said.
struct Report(String);

impl Report {
    /// The numbers in the `n`-th line that begins so.
    fn numbers(&self, begin: &str, n: usize) -> Vec<f64> {
        let mut lines = self.0.lines().filter(|line| line.starts_with(begin));
        let line = lines
            .nth(n)
            .unwrap_or_else(|| panic!("no {begin} in {}", self.0));
        let words = line[begin.len()..].split([' ', ',']);
        words.filter_map(|word| word.parse().ok()).collect()
    }

    /// The camera of the first report.
    fn camera(&self, volume: &Volume, extent: [u32; 2]) -> Camera {
        let n = self.numbers("camera", 0);
        let grid = volume.grid();
        let bounds = stratavox::camera::BoundingSphere::of_grid(&grid.world_from_voxel, grid.dims);
        let orbit = Orbit {
            azimuth_degrees: n[0],
            elevation_degrees: n[1],
            roll_degrees: 0.0,
        };
        let lens = match self.0.contains("--projection orthographic") {
            true => Lens::Orthographic { view_height: None },
            false => Lens::Perspective { fov_degrees: 30.0 },
        };
        let target = glam::DVec3::new(n[3], n[4], n[5]);
        let camera = Camera::orbit(&bounds, target, orbit, None, lens, extent).unwrap();
        Camera {
            zoom: n[2],
            ..camera
        }
    }
}

fn pixels(path: &Path) -> ([u32; 2], Vec<[f32; 4]>) {
    let image = read_image(path).unwrap();
    ([image.width as u32, image.height as u32], image.pixels)
}

/// The largest difference of two pictures, in codes of 8 bits.
fn codes_apart(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    assert_eq!(a.len(), b.len());
    let encode = |x: f32| 255.0 * stratavox::color::encode_srgb(f64::from(x)) as f32;
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs
        .map(|(a, b)| (encode(*a) - encode(*b)).abs())
        .fold(0.0, f32::max)
}

fn read(spec: &str) -> Volume {
    let source = phantom::open(spec, &Limits::default()).unwrap();
    let whole = source.header().whole();
    Volume::read(
        source.as_ref(),
        TimeComponent::default(),
        whole,
        &Limits::default(),
    )
    .unwrap()
}

/// The picture that the library makes of the same volume by itself, without a background.
fn offscreen(
    volume: &Volume,
    function: &TransferFunction,
    camera: &Camera,
    extent_pixels: [u32; 2],
    settings: &Settings,
) -> Picture {
    let scene = Scene {
        volume,
        transfer: Some(function),
        beside: Beside::Nothing,
        camera,
        extent_pixels,
        settings,
    };
    let device = Headless::new(&DeviceChoice::default(), &Options::default()).unwrap();
    let mut renderer = Renderer::new(device, volume).unwrap();
    renderer.render(&scene, &[]).unwrap().picture
}

/// What suits the values.
fn usual_function(volume: &Volume) -> TransferFunction {
    let summary = ValueSummary::of(
        volume.voxels.len(),
        volume.value_range,
        volume.grid().diagonal(),
        volume.hounsfield,
        |i| {
            let rescale = volume.rescale;
            Some(f64::from(volume.voxels.stored(i)) * rescale.slope + rescale.intercept)
        },
    );
    automatic(&summary, Classified::Samples, None)
}

/// A picture as it comes out of a file, before what `drawing.rs` clears it to, blended by the device in the same numbers.
fn shown(folder: &Path, mut picture: Picture) -> Vec<[f32; 4]> {
    let behind = [0.008_f32, 0.011, 0.016, 1.0];
    for pixel in &mut picture.pixels {
        let left = 1.0 - pixel[3];
        for c in 0..4 {
            pixel[c] += left * behind[c];
        }
    }
    let path = folder.join("wanted.png");
    let options = WriteOptions {
        force: true,
        ..WriteOptions::default()
    };
    write_picture(&picture, &path, options).unwrap();
    pixels(&path).1
}

#[test]
fn the_window_shows_what_the_offscreen_renderer_draws() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let spec = "phantom:head,n=40";
    let volume = read(spec);
    let function = usual_function(&volume);
    let extent = [212, 160];
    for (technique, key) in [
        (Technique::Raycast, "key O\nkey ArrowLeft"),
        (Technique::Slices3d, "key 2\nwheel 2 50 40"),
        (
            Technique::Slices2d,
            "key 3\ndrag 60 60 100 90\ndrag 60 60 66 50 middle",
        ),
    ] {
        let lines = format!("{key}\nframes 20\nreport\npicture p.png\nwindow w.png\n");
        let report = display.play(
            folder.path(),
            &[spec, "--look", "plain", "--bare", "--size", "212x160"],
            &lines,
        );
        assert_eq!(report.numbers("picture", 0), [0.0, 0.0, 212.0, 160.0]);
        let settings = Settings {
            technique,
            termination: 1.0 / 8192.0,
            ..Settings::default()
        };
        let camera = report.camera(&volume, extent);
        let wanted = offscreen(&volume, &function, &camera, extent, &settings);
        let wanted = shown(folder.path(), wanted);
        let (_, picture) = pixels(&folder.path().join("p.png"));
        let (_, window) = pixels(&folder.path().join("w.png"));
        assert!(
            codes_apart(&wanted, &vec![wanted[0]; wanted.len()]) > 100.0,
            "nothing is seen"
        );
        assert!(
            wanted == picture,
            "{technique}: {} codes apart",
            codes_apart(&wanted, &picture)
        );
        // The window's shader encodes sRGB by a power that devices may be off in; a rounding then goes the other way.
        let apart = codes_apart(&wanted, &window);
        assert!(apart < 1.5, "{technique}: the window is {apart} codes off");
    }
}

#[test]
fn light_scatters_where_the_picture_rests() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let spec = "phantom:head,n=16";
    let volume = read(spec);
    let lines = "picture rays.png\nkey G\nreport\npicture p.png\nkey ArrowLeft\nkey R\nreport\npicture again.png\nkey G\npicture off.png\n";
    let words = [spec, "--look", "plain", "--bare", "--size", "80x64"];
    let report = display.play(folder.path(), &words, lines);
    assert_eq!(report.numbers("paths", 0), [64.0, 64.0]);
    assert_eq!(report.numbers("paths", 1), [64.0, 64.0]);
    let picture = |name: &str| pixels(&folder.path().join(name)).1;
    assert!(picture("p.png") == picture("again.png"));
    assert!(picture("rays.png") == picture("off.png"));
    let apart = codes_apart(&picture("p.png"), &picture("rays.png"));
    assert!(apart > 20.0, "{apart}");
    let key = Light {
        towards: glam::dvec3(-0.54, 0.64, 0.54),
        space: LightSpace::Camera,
        srgb: [1.0; 3],
    };
    let settings = Settings {
        technique: Technique::Pathtrace,
        path: PathTracing {
            samples: 64,
            density: 0.5,
            lights: vec![key],
            light_size_degrees: 40.0,
            sky: [0.35; 3],
            surface: 8.0,
            f0: 0.04,
            roughness: 0.45,
            ..PathTracing::default()
        },
        ..Settings::default()
    };
    let extent = [80, 64];
    let (function, camera) = (usual_function(&volume), report.camera(&volume, extent));
    let wanted = offscreen(&volume, &function, &camera, extent, &settings);
    // Sums of f32 in another order: a code where they are rounded the other way.
    let apart = codes_apart(&shown(folder.path(), wanted), &picture("p.png"));
    assert!(apart < 1.5, "{apart} codes");
}

#[test]
fn a_click_says_where_the_sphere_is() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let spec = "phantom:sphere,n=64";
    let words = [spec, "--bare", "--size", "200x150"];
    // Surfaces are the last mode, one back from the first.
    let lines =
        "key shift M\nkey Y\nreport\nclick 110 70\nframes 3\nreport\nclick 3 3\nframes 3\nreport\n";
    let report = display.play(folder.path(), &words, lines);
    let camera = report.camera(&read(spec), [200, 150]);
    let found = report.numbers("pick", 0);
    // The sphere of the phantom: around (4, -6, 5), radius 35, with an edge that is one voxel wide, of 100 / 64.
    let (origin, direction) = camera.rays([200, 150]).at(110.5, 70.5);
    let from_center = origin - glam::DVec3::new(4.0, -6.0, 5.0);
    let b = from_center.dot(direction);
    let t = -b - (b * b - from_center.length_squared() + 35.0 * 35.0).sqrt();
    let wanted = origin + t * direction;
    let position = glam::DVec3::new(found[0], found[1], found[2]);
    let off = (position - wanted).length();
    assert!(off < 100.0 / 64.0, "{position}, wanted {wanted}");
    assert!((0.0..=1.0).contains(&found[3]), "value {}", found[3]);
    assert!(report.0.contains("pick nothing"), "{}", report.0);

    let lines = "key 2\nclick 110 70\nframes 2\nreport\n";
    let report = display.play(folder.path(), &words, lines);
    assert!(report.0.contains("message slices-3d"), "{}", report.0);
    assert!(
        report.0.contains("has no depth to give back"),
        "{}",
        report.0
    );
}

#[test]
fn a_click_on_a_label_says_what_it_is_called() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    // A cube of one label in a larger one of another.
    let side = |i: usize| [i % 16, i / 16 % 16, i / 256];
    let inside =
        |i: usize, margin: usize| side(i).iter().all(|n| (margin..16 - margin).contains(n));
    let label = |i: usize| {
        if inside(i, 2) {
            3
        } else {
            7 * u8::from(inside(i, 1))
        }
    };
    let mut file =
        b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n\n".to_vec();
    file.extend((0..16 * 16 * 16).map(label));
    std::fs::write(folder.path().join("map.nrrd"), file).unwrap();
    std::fs::write(folder.path().join("names.txt"), "3 heart\n7 lung\n").unwrap();
    let lines = "click 100 75\nframes 3\nreport\n";
    let size = ["map.nrrd", "--bare", "--size", "200x150"];
    let named = [&size[..], &["--label-tf", "names.txt"]].concat();
    let report = display.play(folder.path(), &named, lines);
    let picked = report.numbers("pick", 0)[3];
    let name = match picked {
        3.0 => "called heart",
        7.0 => "called lung",
        _ => panic!("{}", report.0),
    };
    assert!(report.0.contains(name), "{}", report.0);
    let report = display.play(folder.path(), &size, lines);
    assert!(report.0.contains("called nothing"), "{}", report.0);
    let unknown = [&size[..], &["--label-tf", "none.txt"]].concat();
    let output = display.heard(folder.path()).args(unknown).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", texts(&output));
    assert!(
        texts(&output).contains("--label-tf none.txt"),
        "{}",
        texts(&output)
    );
}

#[test]
fn a_dragged_point_changes_the_picture_and_makes_no_pipeline() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let words = ["phantom:head,n=32", "--size", "640x760"];
    let report = display.play(folder.path(), &words, "report\n");
    let from = report.numbers("handle Opacity(5)", 0);
    let to = [from[0] - 7.0, from[1] - 40.0];
    let color = report.numbers("handle Color(7)", 0);
    let lines = format!(
        "report\npicture 1.png\ndrag {} {} {} {}\nreport\npicture 2.png\ndrag {} {} {} {}\nreport\npicture 3.png\n",
        from[0],
        from[1],
        to[0],
        to[1],
        color[0],
        color[1],
        color[0] + 14.0,
        color[1]
    );
    let report = display.play(folder.path(), &words, &lines);
    let moved = report.numbers("handle Opacity(5)", 1);
    let off = (moved[0] - to[0]).abs().max((moved[1] - to[1]).abs());
    // The point is where the hand is, which took hold of it within a point of its middle.
    assert!(off < 1.0, "{moved:?}, wanted {to:?}");
    let one = pixels(&folder.path().join("1.png")).1;
    let two = pixels(&folder.path().join("2.png")).1;
    let three = pixels(&folder.path().join("3.png")).1;
    assert!(codes_apart(&one, &two) > 5.0, "opacity changes nothing");
    assert!(codes_apart(&two, &three) > 5.0, "colour changes nothing");
    let made = [0, 1, 2].map(|n| report.numbers("pipelines", n)[0]);
    assert_eq!(made, [made[0]; 3], "pipelines were made");
}

#[test]
fn a_window_of_another_size_shows_a_picture_of_that_size() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let lines = "size 333 217\nframes 1\nsize 90 400\nsize 260 180\nreport\nkey R\npicture resized.png\nwindow w.png\n";
    let spec = "phantom:shells,n=32";
    let report = display.play(folder.path(), &[spec, "--bare", "--size", "300x200"], lines);
    assert_eq!(report.numbers("picture", 0), [0.0, 0.0, 260.0, 180.0]);
    display.play(
        folder.path(),
        &[spec, "--bare", "--size", "260x180"],
        "picture fresh.png\n",
    );
    let (size, resized) = pixels(&folder.path().join("resized.png"));
    let (_, fresh) = pixels(&folder.path().join("fresh.png"));
    assert_eq!(size, [260, 180]);
    assert!(
        resized == fresh,
        "{} codes apart",
        codes_apart(&resized, &fresh)
    );
    assert_eq!(pixels(&folder.path().join("w.png")).0, [260, 180]);
}

#[test]
fn the_slider_shows_another_time_without_another_pipeline() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let spec = "phantom:storm,n=24,variable=cloud";
    let words = [spec, "--bare", "--size", "160x120"];
    let lines = "report\npicture 0.png\ntime 5\nreport\npicture 5.png\nkey .\nreport\n";
    let report = display.play(folder.path(), &words, lines);
    let times = [0, 1, 2].map(|n| report.numbers("time", n)[0]);
    assert_eq!(times, [0.0, 5.0, 6.0]);
    let made = [0, 1].map(|n| report.numbers("pipelines", n)[0]);
    assert_eq!(made[0], made[1], "pipelines were made");
    let [first, later] = ["0.png", "5.png"].map(|name| pixels(&folder.path().join(name)).1);
    assert!(codes_apart(&first, &later) > 5.0, "time changes nothing");
}

#[test]
fn a_hand_on_a_real_pointer_and_keyboard_turns_the_volume() {
    let Some(display) = Display::new() else {
        return;
    };
    if Command::new("xdotool").arg("version").output().is_err() {
        skipped::<()>("there is no xdotool");
        return;
    }
    let folder = TempDir::new().unwrap();
    let mut viewer = display.heard(folder.path());
    viewer.args(["phantom:head,n=32", "--bare", "--size", "300x200"]);
    let viewer = viewer
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let tool = |words: &[&str]| {
        let mut command = Command::new("xdotool");
        command.args(words).env("DISPLAY", &display.name);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{words:?}: {}", texts(&output));
    };
    tool(&[
        "search",
        "--sync",
        "--onlyvisible",
        "--name",
        "stratavox",
        "windowfocus",
    ]);
    // The first picture takes a while; what is typed meanwhile waits for it.
    tool(&["mousemove", "100", "100", "key", "c"]);
    // A hand takes its time, and some of it within one slow frame.
    let rest = || std::thread::sleep(Duration::from_millis(200));
    tool(&["mousedown", "1"]);
    for x in ["101", "120", "150"] {
        tool(&["mousemove", "--sync", x, "100"]);
        rest();
    }
    tool(&["mouseup", "1"]);
    tool(&["key", "c", "key", "shift+s", "key", "q"]);
    let since = Instant::now();
    let output = viewer.wait_with_output().unwrap();
    let report = Report(texts(&output));
    assert!(output.status.success(), "{}", report.0);
    assert!(
        since.elapsed() < Duration::from_secs(60),
        "it took too long to end"
    );
    let [before, after] = [0, 1].map(|n| report.numbers("--projection", n)[0]);
    // 0.4 degrees a point, to the other side.
    assert!((before - after - 20.0).abs() < 0.5, "{before} {after}");
    let name = "head-n-32-window.png";
    assert_eq!(pixels(&folder.path().join(name)).0, [300, 200]);
}

#[test]
fn what_cannot_be_shown_is_said_in_a_sentence() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    for (words, code, part) in [
        (&["nowhere.nii"][..], 3, "cannot read nowhere.nii"),
        (
            &["phantom:head,n=16", "--component", "1"],
            2,
            "--component 1: a voxel has 1",
        ),
        (
            &["phantom:head,n=16", "--time", "1"],
            2,
            "--time 1: there are 1",
        ),
        (
            &["phantom:head,n=16", "--device", "abacus"],
            5,
            "none is called `abacus`",
        ),
    ] {
        let output = display.heard(folder.path()).args(words).output().unwrap();
        let text = texts(&output);
        assert_eq!(output.status.code(), Some(code), "{words:?}: {text}");
        assert!(text.contains(part), "{words:?}: {text}");
    }
    let script = folder.path().join("bad.txt");
    std::fs::write(&script, "key M\ndance 3\n").unwrap();
    let mut viewer = display.heard(folder.path());
    let output = viewer.arg("--script").arg(&script).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", texts(&output));
    assert!(
        texts(&output).contains("line 2: `dance 3`"),
        "{}",
        texts(&output)
    );
    let mut viewer = display.heard(folder.path());
    let output = viewer
        .arg("phantom:head,n=16")
        .env("DISPLAY", ":4711")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(5), "{}", texts(&output));
    assert!(texts(&output).contains("no display"), "{}", texts(&output));
}

#[test]
fn every_mode_and_filter_is_drawn_or_refused_by_name() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let words = ["phantom:head,n=24", "--size", "420x300"];
    let mut lines = "key H\nwindow help.png\nkey H\n".to_owned();
    for mode in 0..9 {
        lines += &format!("picture mode-{mode}.png\nkey M\n");
    }
    lines += "key L\npicture lit.png\nkey L\n";
    for filter in 0..5 {
        lines += &format!("picture filter-{filter}.png\nkey F\n");
    }
    // Slices: what needs rays is refused, and the picture stays.
    lines += "key 2\nkey M\nkey M\nkey M\nkey M\nreport\nkey M\nreport\nkey 3\nkey F\nkey F\nframes 1\nreport\n";
    let report = display.play(folder.path(), &words, &lines);
    let drawn = |name: String| pixels(&folder.path().join(name)).1;
    let modes: Vec<_> = (0..9).map(|k| drawn(format!("mode-{k}.png"))).collect();
    for (k, mode) in modes.iter().enumerate() {
        let same = modes[..k].iter().position(|other| other == mode);
        assert_eq!(same, None, "mode {k} looks as another");
    }
    assert!(drawn("lit.png".into()) != modes[0], "light changes nothing");
    let filters: Vec<_> = (0..5).map(|k| drawn(format!("filter-{k}.png"))).collect();
    assert!(filters[0] == modes[0], "nine modes on is the first again");
    for k in 1..5 {
        assert!(filters[k] != filters[k - 1], "filter {k} changes nothing");
    }
    assert!(
        report.0.contains("look slices-3d xray linear"),
        "{}",
        report.0
    );
    assert!(report.0.contains("message"), "{}", report.0);
}

/// The box of pixels that are not the background, in parts of the picture's sides: low and high.
fn seen_box([width, height]: [u32; 2], pixels: &[[f32; 4]]) -> [[f64; 2]; 2] {
    let behind = pixels[0];
    let mut seen = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for (at, pixel) in (0_u32..).zip(pixels) {
        if codes_apart(&[*pixel], &[behind]) > 3.0 {
            let side = [width, height].map(f64::from);
            let [x, y] = [at % width, at / width].map(f64::from);
            for (k, start) in [x, y].into_iter().enumerate() {
                seen[0][k] = seen[0][k].min(start / side[k]);
                seen[1][k] = seen[1][k].max((start + 1.0) / side[k]);
            }
        }
    }
    seen
}

#[test]
fn the_first_picture_is_fitted_to_what_is_visible_and_lit_as_the_command_line_does_it() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let spec = "phantom:head,n=48";
    let extent = [320, 240];
    let words = [spec, "--bare", "--size", "320x240"];
    let lines =
        "frames 2\nreport\npicture first.png\nkey Plus\nkey ArrowLeft\nkey R\npicture again.png\n";
    let report = display.play(folder.path(), &words, lines);
    let (size, first) = pixels(&folder.path().join("first.png"));
    assert_eq!(size, extent);
    // #18181c.
    let behind = [24.0, 24.0, 28.0].map(|code| code / 255.0);
    for (found, wanted) in first[0].iter().zip(behind) {
        assert!((f64::from(*found) - wanted).abs() < 1e-6, "{:?}", first[0]);
    }
    let [low, high] = seen_box(size, &first);
    let filled = (high[0] - low[0]).max(high[1] - low[1]);
    assert!((0.85..=0.95).contains(&filled), "{low:?} {high:?}");
    let off = [0, 1].map(|k| (0.5 * (low[k] + high[k]) - 0.5).abs());
    assert!(off[0].max(off[1]) <= 0.05, "{low:?} {high:?}");
    let (_, again) = pixels(&folder.path().join("again.png"));
    assert!(again == first, "the first view comes back");

    // The picture of the same camera, function and light, drawn apart from the window: the numbers are the same.
    let source = phantom::open(spec, &Limits::default()).unwrap();
    let volume = read(spec);
    let context = stratavox::look::context(source.header());
    let summary = stratavox::look::summary(&volume);
    let function = automatic_in(&context, &summary, Classified::Samples, None);
    let settings = Settings {
        termination: 1.0 / 8192.0,
        samples_per_voxel: 2.0,
        shading: Some(stratavox::look::light(&volume)),
        ..Settings::default()
    };
    let camera = report.camera(&volume, extent);
    let mut wanted = offscreen(&volume, &function, &camera, extent, &settings);
    for pixel in &mut wanted.pixels {
        let left = 1.0 - pixel[3];
        for c in 0..3 {
            pixel[c] += left * decode_srgb(behind[c]) as f32;
        }
        pixel[3] = 1.0;
    }
    let path = folder.path().join("wanted.png");
    write_picture(&wanted, &path, WriteOptions::default()).unwrap();
    let (_, wanted) = pixels(&path);
    let apart = codes_apart(&wanted, &first);
    // The device blends in the same numbers; a rounding to 8 bits may go the other way.
    assert!(apart < 1.5, "{apart} codes apart");

    // The plain look is the whole box without light.
    let plain = [&words[..], &["--look", "plain"]].concat();
    display.play(folder.path(), &plain, "picture plain.png\n");
    let (_, plain) = pixels(&folder.path().join("plain.png"));
    let [low, high] = seen_box(size, &plain);
    let filled = (high[0] - low[0]).max(high[1] - low[1]);
    assert!(filled < 0.85, "{low:?} {high:?}");
}

#[test]
fn marks_are_laid_over_the_picture_and_their_box_shows_through_the_volume() {
    let Some(display) = Display::new() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let spec = "phantom:head,n=40";
    let list = "bar,orientation,scale,box,source,title=Head";
    let extent = [320, 240];
    let words = [spec, "--look", "plain", "--bare", "--size", "320x240"];
    let marked = [&words[..], &["--annotate", list]].concat();
    let lines = "frames 2\nreport\npicture with.png\nwindow w.png\nkey A\npicture without.png\n\
                 key A\npicture again.png\n";
    let report = display.play(folder.path(), &marked, lines);
    let drawn = |name: &str| pixels(&folder.path().join(name)).1;
    assert!(
        drawn("with.png") == drawn("again.png"),
        "the key shows what it hid"
    );
    display.play(folder.path(), &words, "picture plain.png\n");
    assert!(
        drawn("without.png") == drawn("plain.png"),
        "hidden marks leave a trace"
    );

    // The same marks, laid by hand: edges behind the volume under it, all others over the picture.
    let source = phantom::open(spec, &Limits::default()).unwrap();
    let volume = read(spec);
    let summary = stratavox::look::summary(&volume);
    let function = automatic(&summary, Classified::Samples, None);
    let settings = Settings {
        termination: 1.0 / 8192.0,
        ..Settings::default()
    };
    let camera = report.camera(&volume, extent);
    let mut wanted = offscreen(&volume, &function, &camera, extent, &settings);
    let background = Picture {
        pixels: vec![[0.008, 0.011, 0.016, 1.0]; wanted.pixels.len()],
        ..wanted.clone()
    };
    let annotation = Annotation {
        marks: list.parse().unwrap(),
        size: None,
        color: None,
        is_log: false,
        facts: Facts::of(source.header(), spec),
    };
    let seen = Seen {
        camera: &camera,
        settings: &settings,
        function: Some(&function),
        beside: Beside::Nothing,
        grid: volume.grid(),
        height_factor: 1.0,
        time: 0.0,
        projected: None,
        geometry: GeometryLegend::default(),
    };
    let marks = annotation.draw(&background, &seen).unwrap();
    let over = |over: [f32; 4], under: [f32; 4]| {
        std::array::from_fn(|k| over[k] + (1.0 - over[3]) * under[k])
    };
    let layers = marks.behind.iter().zip(&marks.front);
    let grounds = background.pixels.iter().zip(layers);
    for (pixel, (ground, (behind, front))) in wanted.pixels.iter_mut().zip(grounds) {
        *pixel = over(*front, over(*pixel, over(*behind, *ground)));
    }
    let path = folder.path().join("wanted.png");
    write_picture(&wanted, &path, WriteOptions::default()).unwrap();
    let wanted = pixels(&path).1;
    let inked = marks.front.iter().filter(|pixel| pixel[3] > 0.9).count();
    assert!(inked > 500, "{inked} pixels of marks");
    let plain = drawn("plain.png");
    let hidden = wanted.iter().zip(&plain).zip(&marks.front);
    let hidden = hidden
        .filter(|((a, b), front)| front[3] == 0.0 && a != b)
        .count();
    assert!(hidden > 50, "{hidden} pixels of edges behind the volume");
    let apart = codes_apart(&wanted, &drawn("with.png"));
    assert!(apart < 1.5, "{apart} codes apart");
    // A sampler's weights have 8 bits: of a white neighbour 1/256 may be there, in black 12.92 x 255 / 256 codes.
    let apart = codes_apart(&wanted, &drawn("w.png"));
    assert!(apart < 12.87 + 1.5, "the window is {apart} codes off");

    let shot = [&marked[..], &["--screenshot", "shot.png"]].concat();
    let output = display.heard(folder.path()).args(shot).output().unwrap();
    assert!(output.status.success(), "{}", texts(&output));
    assert!(
        drawn("shot.png") == drawn("w.png"),
        "a screenshot has the marks"
    );

    let wrong = [spec, "--annotate", "title=Жук"];
    let output = display.heard(folder.path()).args(wrong).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", texts(&output));
    assert!(
        texts(&output).contains("no letter 'Ж'"),
        "{}",
        texts(&output)
    );
}

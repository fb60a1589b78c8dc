//! Films in one file, read back by readers of their own and compared with the frames of a sequence.

use crate::person::Folder;
use std::{fs, io::BufReader, path::Path};

const FRAMES: usize = 6;
const WIDTH: usize = 24;
const HEIGHT: usize = 18;
const SMALL: &str = "--size 24x18 --device reference --turntable 6";
/// What lies behind films without transparency.
const BLACK: &str = "--background 0,0,0";

/// Red, green, blue and alpha of a PNG.
fn png_codes(path: &Path) -> Vec<u8> {
    let file = fs::File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut reader = png::Decoder::new(BufReader::new(file))
        .read_info()
        .expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut bytes).expect("a picture");
    bytes
}

/// The frames of the same film as a sequence.
fn sequence(folder: &Folder, words: &str) -> Vec<Vec<u8>> {
    folder
        .run(&format!(
            "animate --look plain {words} -o seq/%d.png {SMALL}"
        ))
        .assert_done();
    let frames = (0..FRAMES).map(|k| png_codes(&folder.path(&format!("seq/{k}.png"))));
    frames.collect()
}

#[test]
fn an_apng_holds_the_frames_exactly_and_plays_for_ever() {
    for (bits, bytes_each) in [(8, 1), (16, 2)] {
        let folder = Folder::new();
        let words = format!("phantom:head,n=16 --bit-depth {bits}");
        let frames = sequence(&folder, &words);
        folder
            .run(&format!(
                "animate --look plain {words} --fps 12.5 -o film.apng {SMALL}"
            ))
            .assert_done();
        assert_eq!(folder.names(), ["film.apng", "seq"]);
        let file = fs::File::open(folder.path("film.apng")).expect("a film");
        let mut reader = png::Decoder::new(BufReader::new(file))
            .read_info()
            .expect("a PNG");
        let control = *reader.info().animation_control().expect("an animation");
        assert_eq!((control.num_frames, control.num_plays), (FRAMES as u32, 0));
        for (k, wanted) in frames.iter().enumerate() {
            let mut found = vec![0; reader.output_buffer_size().expect("a size")];
            assert_eq!(found.len(), WIDTH * HEIGHT * 4 * bytes_each);
            reader.next_frame(&mut found).expect("a frame");
            assert!(found == *wanted, "{bits} bits, frame {k}");
            let frame = reader.info().frame_control().expect("a frame's words");
            assert_eq!((frame.delay_num, frame.delay_den), (2, 25), "frame {k}");
            assert_eq!(frame.blend_op, png::BlendOp::Source);
        }
    }
}

/// Colours of each frame, and its hundredths of a second.
fn gif_frames(path: &Path) -> Vec<(Vec<u8>, u16)> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options
        .read_info(fs::File::open(path).expect("a film"))
        .expect("a GIF");
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
    let mut frames = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        assert_eq!(
            (usize::from(frame.width), usize::from(frame.height)),
            (WIDTH, HEIGHT)
        );
        frames.push((frame.buffer.to_vec(), frame.delay));
    }
    frames
}

#[test]
fn a_gif_of_few_colours_is_exact() {
    // A maximum is grey: at most 256 levels.
    let folder = Folder::new();
    let words = format!("phantom:head,n=16 --mode mip {BLACK}");
    let frames = sequence(&folder, &words);
    folder
        .run(&format!(
            "animate --look plain {words} --fps 30 -o film.gif {SMALL}"
        ))
        .assert_done();
    let found = gif_frames(&folder.path("film.gif"));
    assert_eq!(found.len(), FRAMES);
    for (k, (found, wanted)) in found.iter().zip(&frames).enumerate() {
        assert!(found.0 == *wanted, "frame {k}");
    }
    // Three frames at 30 a second are ten hundredths.
    let delays: Vec<_> = found.iter().map(|frame| frame.1).collect();
    assert_eq!(delays, [3, 4, 3, 3, 4, 3]);
}

#[test]
fn a_gif_of_many_colours_is_near_and_has_one_palette() {
    let folder = Folder::new();
    let words = format!("phantom:head,n=32 --zoom 2.5 {BLACK}");
    let frames = sequence(&folder, &words);
    folder
        .run(&format!("animate --look plain {words} -o film.gif {SMALL}"))
        .assert_done();
    let found = gif_frames(&folder.path("film.gif"));
    let distinct = |frames: &[&[u8]]| {
        let pixels = frames.iter().flat_map(|frame| frame.as_chunks::<4>().0);
        pixels.collect::<std::collections::HashSet<_>>().len()
    };
    let wanted: Vec<&[u8]> = frames.iter().map(Vec::as_slice).collect();
    let colors: Vec<&[u8]> = found.iter().map(|frame| frame.0.as_slice()).collect();
    assert!(
        distinct(&wanted) > 256,
        "{} colours are no test",
        distinct(&wanted)
    );
    assert!(distinct(&colors) <= 256, "{} colours", distinct(&colors));
    let off = wanted
        .concat()
        .iter()
        .zip(colors.concat())
        .map(|(a, b)| f64::from(a.abs_diff(b)).powi(2))
        .sum::<f64>();
    let rms = (off / (FRAMES * WIDTH * HEIGHT * 4) as f64).sqrt();
    println!(
        "{} colours as 256: off by {rms:.2} of 255 (rms)",
        distinct(&wanted)
    );
    // 256 colours even all over the cube would be 40 apart, and 12 off.
    assert!(rms < 6.0, "{rms}");
}

/// BT.709-6, 3.2 to 3.5, limited range, of sRGB codes.
fn ycbcr([r, g, b]: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = [r, g, b].map(|code| f64::from(code) / 255.0);
    let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let (cb, cr) = ((b - y) / 1.8556, (r - y) / 1.5748);
    [219.0 * y + 16.0, 224.0 * cb + 128.0, 224.0 * cr + 128.0].map(|code| code.round() as u8)
}

#[track_caller]
fn assert_y4m_is(bytes: &[u8], frames: &[Vec<u8>]) {
    let head = b"YUV4MPEG2 W24 H18 F25:1 Ip A1:1 C444 XCOLORRANGE=LIMITED XCOLORMATRIX=BT709\n";
    let rest = bytes.strip_prefix(head).expect("the head");
    let plane = WIDTH * HEIGHT;
    let chunks: Vec<&[u8]> = rest.chunks(6 + 3 * plane).collect();
    assert_eq!(chunks.len(), frames.len());
    for (k, (chunk, wanted)) in chunks.iter().zip(frames).enumerate() {
        let planes = chunk.strip_prefix(b"FRAME\n").expect("a frame");
        for (i, &[r, g, b, alpha]) in wanted.as_chunks::<4>().0.iter().enumerate() {
            let found = [planes[i], planes[plane + i], planes[2 * plane + i]];
            assert_eq!(found, ycbcr([r, g, b]), "frame {k}, pixel {i}");
            assert_eq!(alpha, 255);
        }
    }
}

#[test]
fn a_y4m_holds_every_pixel_in_a_file_and_through_a_pipe() {
    let folder = Folder::new();
    let frames = sequence(&folder, &format!("phantom:head,n=16 {BLACK}"));
    // Black is behind a Y4M without a word.
    folder
        .run(&format!(
            "animate --look plain phantom:head,n=16 -o film.y4m {SMALL}"
        ))
        .assert_done();
    let file = fs::read(folder.path("film.y4m")).expect("a film");
    assert_y4m_is(&file, &frames);
    let piped = folder
        .command(&format!(
            "animate --look plain phantom:head,n=16 -o - {SMALL}"
        ))
        .output()
        .expect("the program runs");
    assert!(piped.status.success(), "{piped:?}");
    assert!(piped.stdout == file, "the pipe carries something else");
}

#[test]
fn a_closed_pipe_is_exit_code_4() {
    let folder = Folder::new();
    let mut child = folder
        .command("animate --look plain phantom:fog,n=8 --turntable 400 --size 64x48 --device reference -o -")
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stdout.take());
    assert_eq!(child.wait().expect("an end").code(), Some(4));
}

#[test]
fn an_mp4_has_all_frames_where_ffmpeg_is_installed() {
    let folder = Folder::new();
    let probe = std::process::Command::new("ffprobe")
        .arg("-version")
        .output();
    if probe.is_err() {
        println!("skipped: no ffmpeg is installed");
        return;
    }
    folder
        .run(&format!(
            "animate --look plain phantom:head,n=16 -o film.mp4 {SMALL}"
        ))
        .assert_done();
    assert_eq!(folder.names(), ["film.mp4"]);
    let words = "-v error -count_frames -show_entries stream=nb_read_frames,width,height -of csv=p=0 film.mp4";
    let output = std::process::Command::new("ffprobe")
        .args(words.split_whitespace())
        .current_dir(folder.path("."))
        .output()
        .expect("ffprobe runs");
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "24,18,6");
}

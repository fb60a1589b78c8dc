//! MP4 with H.264, by the ffmpeg that is installed: frames go into its standard input, no shell is between.

use super::Reel;
use crate::cli::Error;
use std::{
    env,
    ffi::OsString,
    io::{self, Read, Write},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
};

#[cfg(windows)]
const NAME: &str = "ffmpeg.exe";
#[cfg(not(windows))]
const NAME: &str = "ffmpeg";

/// The ffmpeg of the search path, for the film at `path`.
pub fn find_ffmpeg(path: &Path) -> Result<PathBuf, Error> {
    let folders = env::var_os("PATH").unwrap_or_default();
    let found = env::split_paths(&folders)
        .map(|folder| folder.join(NAME))
        .find(|program| program.is_file());
    found.ok_or_else(|| Error::Output {
        path: path.to_owned(),
        problem: "no ffmpeg is found in the folders of PATH".to_owned(),
        hint: Some("install ffmpeg, or write a .apng, .gif or .y4m"),
    })
}

/// The whole film into `part`.
pub fn write(reel: &Reel, part: &Path) -> Result<(), Error> {
    let mut child = Command::new(find_ffmpeg(reel.path)?)
        .args(words(reel, part))
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|cause| reel.wrote(cause))?;
    // Read beside the writing: a full pipe would stop both.
    let mut stderr = child.stderr.take();
    let said = std::thread::spawn(move || {
        let mut text = Vec::new();
        if let Some(stderr) = &mut stderr {
            let _ = stderr.take(1 << 16).read_to_end(&mut text);
            let _ = io::copy(stderr, &mut io::sink());
        }
        String::from_utf8_lossy(&text).into_owned()
    });
    let fed = feed(reel, &mut child);
    let status = child.wait().map_err(|cause| reel.wrote(cause))?;
    let said = said.join().unwrap_or_default();
    match fed {
        // It says itself why it has stopped listening.
        Err(Error::Output { .. }) | Ok(()) if !status.success() => Err(Error::Output {
            path: reel.path.to_owned(),
            problem: format!(
                "ffmpeg: {}",
                said.lines().next_back().unwrap_or("no reason given")
            ),
            hint: Some("a .apng, .gif or .y4m needs no ffmpeg"),
        }),
        fed => fed,
    }
}

fn feed(reel: &Reel, child: &mut Child) -> Result<(), Error> {
    // Dropped at the end: a closed pipe is the end of the film.
    let Some(mut pipe) = child.stdin.take() else {
        return Ok(());
    };
    for number in 0..reel.count {
        reel.progress
            .stage("encode", number as usize, reel.count as usize);
        let codes = reel.codes(number)?;
        let rgb: Vec<u8> = codes
            .as_chunks::<4>()
            .0
            .iter()
            .flat_map(|&[r, g, b, _]| [r, g, b])
            .collect();
        pipe.write_all(&rgb).map_err(|cause| reel.wrote(cause))?;
    }
    Ok(())
}

/// H.264 at 4:2:0 plays everywhere and wants even sides; BT.709, limited range, sRGB's curve, all said in the file.
fn words(reel: &Reel, part: &Path) -> Vec<OsString> {
    let [width, height] = reel.extent_pixels;
    let mut words: Vec<OsString> = format!(
        "-hide_banner -nostdin -loglevel error -y -f rawvideo -pixel_format rgb24 -video_size {width}x{height} \
         -framerate {rate} -i pipe:0 -an -vf \
         pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p \
         -c:v libx264 -preset medium -crf 18 -colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1 \
         -color_range tv -movflags +faststart -f mp4",
        rate = reel.rate
    )
    .split_whitespace()
    .map(OsString::from)
    .collect();
    // With the protocol in front no name can be taken for an option or another protocol.
    let mut name = OsString::from("file:");
    name.push(part);
    words.push(name);
    words
}

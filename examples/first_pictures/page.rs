//! The page of what was measured.

use crate::measure::Measured;
use std::fmt::Write;

/// The larger side of the visible box takes at least this share of the frame.
const LEAST_BOX: f64 = 0.85;
/// The box's centre is at most this far from the frame's, in shares of each side.
const MOST_OFF_CENTRE: f64 = 0.05;
/// Mean luminance of visible pixels.
const LUMINANCE: [f64; 2] = [0.2, 0.8];
/// SSIM with more samples, without light and with.
const LEAST_SSIM: [f64; 2] = [0.99, 0.96];

/// `docs/first-pictures.md`.
pub fn page(rows: &[Measured], commit: &str) -> String {
    let mut page = format!(
        "# First pictures\n\n\
         What `stratavox render INPUT` draws without a flag at 1024x768, measured: `make first-pictures` writes this page. \
         `sheet.png` is what they look like, [first-pictures-grades.md](first-pictures-grades.md) grades them by eye, \
         [first-pictures-peers.md](first-pictures-peers.md) shows six of them in other programs. Drawn by commit {commit} on \
         {}, {}.\n\n",
        machine(),
        rows.first().map_or("", |row| &row.driver),
    );
    page.push_str(
        "* *box*: shares of the frame's width and height that the box of visible pixels takes, visible being an alpha \
         over 8/255 without light at one sample per voxel. Bar: the larger at least .85.\n\
         * *off centre*: distance of the box's centre from the frame's, in shares of width and height. Bar: .05.\n\
         * *covered*: share of visible pixels.\n\
         * *luminance*: mean of .2126 R + .7152 G + .0722 B of their sRGB numbers from 0 to 1. Bar: .2 to .8.\n\
         * *SSIM*: with the picture of so many samples per voxel, the same scene, both at 512x384. Bar: .99 without light, \
         .96 lit at 2 samples. The reference has 16 samples, or the most for which the driver does not end a loop.\n\
         * *frame*: milliseconds of the frame, *unlit* those without light at one sample per voxel from the same camera, \
         then their ratio, and *total* from the start of the program to the written file.\n\n\
         **Bold** does not reach its bar.\n\n\
         | volume | box | off centre | covered | luminance | drawn | SSIM | frame | unlit | ratio | total |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let [w, h] = row.box_share;
        let [x, y] = row.off_centre;
        let off = x.max(y);
        let least_ssim = LEAST_SSIM[usize::from(row.is_lit)];
        writeln!(
            page,
            "| {} | {} | {} | {:.2} | {} | {}, {} | {} of {} | {:.0} | {:.0} | {:.1} | {:.0} |",
            row.input,
            marked(w.max(h) >= LEAST_BOX, &format!("{w:.2} x {h:.2}")),
            marked(off <= MOST_OFF_CENTRE, &format!("{x:.3}, {y:.3}")),
            row.covered,
            marked(
                (LUMINANCE[0]..=LUMINANCE[1]).contains(&row.luminance),
                &format!("{:.2}", row.luminance)
            ),
            if row.is_lit { "lit" } else { "unlit" },
            row.samples,
            marked(row.ssim >= least_ssim, &format!("{:.4}", row.ssim)),
            row.reference_samples,
            row.frame_ms,
            row.plain_frame_ms,
            row.frame_ms / row.plain_frame_ms,
            row.total_ms,
        )
        .expect("a String takes all");
    }
    let count = |has: fn(&Measured) -> bool| rows.iter().filter(|row| has(row)).count();
    writeln!(
        page,
        "\nOf {} pictures {} reach the bar of the box, {} of the centre, {} of luminance, {} of SSIM.",
        rows.len(),
        count(|row| row.box_share[0].max(row.box_share[1]) >= LEAST_BOX),
        count(|row| row.off_centre[0].max(row.off_centre[1]) <= MOST_OFF_CENTRE),
        count(|row| (LUMINANCE[0]..=LUMINANCE[1]).contains(&row.luminance)),
        count(|row| row.ssim >= LEAST_SSIM[usize::from(row.is_lit)]),
    )
    .expect("a String takes all");
    page
}

fn marked(is_reached: bool, text: &str) -> String {
    if is_reached {
        text.to_owned()
    } else {
        format!("**{text}**")
    }
}

/// Processor and its cores, where the system says so.
fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let model = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    format!("{model} ({cores} threads)")
}

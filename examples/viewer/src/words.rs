//! The words of the command line.

use clap::{Parser, ValueEnum};
use std::path::PathBuf;
use stratavox::annotate::Marks;

/// A window on a volume: turn it, move it, change its colours, look what lies where
#[derive(Clone, Debug, Parser)]
#[command(name = "stratavox-viewer", version, max_term_width = 100)]
#[command(after_help = "H in the window shows the keys.\n\nExamples:\n  \
    stratavox-viewer scan.nii.gz\n  \
    stratavox-viewer wrfout.nc --variable QVAPOR\n  \
    stratavox-viewer phantom:storm --annotate --screenshot storm.png")]
pub struct Arguments {
    /// A volume file, a folder of slices, or phantom:NAME[,n=256]
    #[arg(value_name = "INPUT", default_value = "phantom:head")]
    pub input: String,
    /// One of several variables
    #[arg(long, value_name = "NAME")]
    pub variable: Option<String>,
    /// One of several times, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub time: u32,
    /// One of several numbers of a voxel, counted from 0
    #[arg(long, value_name = "N")]
    pub component: Option<u32>,
    /// One of several DICOM series of a folder
    #[arg(long, value_name = "UID")]
    pub series: Option<String>,
    /// One of several resolutions of a file, 0 the finest
    #[arg(long, value_name = "N")]
    pub level: Option<u32>,
    /// What labels are called: a file that `stratavox render --label-tf` takes
    #[arg(long, value_name = "FILE")]
    pub label_tf: Option<PathBuf>,
    /// What is seen at first: `auto` as `stratavox render` chooses it, `plain` the whole box without light, in colours by
    /// what the values look like
    #[arg(long, default_value = "auto")]
    pub look: LookWord,
    /// Draw tables and head holders of CT too, which --look auto leaves out
    #[arg(long)]
    pub keep_all: bool,
    /// Draw over the picture: bar, time, orientation, scale, title=TEXT, box, ticks, axes, source; without a list the
    /// first four. A in the window hides and shows them
    #[arg(long, value_name = "LIST", num_args = 0..=1, default_missing_value = Marks::USUAL)]
    pub annotate: Option<Marks>,
    /// A device by a part of its name
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Width and height of the window, in pixels
    #[arg(long, value_name = "WxH", default_value = "1360x860", value_parser = size)]
    pub size: [u32; 2],
    /// How frames reach the screen
    #[arg(long, default_value = "fifo")]
    pub present: Present,
    /// Frames that the device may be behind
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub frames_in_flight: u32,
    /// Begin without the panel
    #[arg(long)]
    pub bare: bool,
    /// Write the window into a PNG when it is drawn, and end
    #[arg(long, value_name = "FILE.png")]
    pub screenshot: Option<PathBuf>,
    /// Do what stands in a file, line by line, and end
    #[arg(long, value_name = "FILE", conflicts_with = "screenshot")]
    pub script: Option<PathBuf>,
    /// Let the validation layer listen: every message is printed, and there is an error in the end [default: what
    /// STRATAVOX_VALIDATION says]
    #[arg(long)]
    pub validation: Option<Layer>,
}

/// Which choices hold at first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LookWord {
    /// Fitted to what is visible, lit where light helps, classified by meaning
    Auto,
    /// The whole box, without light
    Plain,
}

/// How frames reach the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Present {
    /// Each at the next refresh: no tearing, no more frames than the screen shows
    Fifo,
    /// The newest at the next refresh
    Mailbox,
    /// At once, torn or not
    Immediate,
}

/// What the validation layer looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Layer {
    /// Arguments, layouts, lifetimes
    Core,
    /// Missing barriers too
    Sync,
}

fn size(word: &str) -> Result<[u32; 2], String> {
    let wrong = || "wanted two numbers such as 1280x800".to_owned();
    let (width, height) = word.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| match text.parse() {
        Ok(pixels @ 64..=16384) => Ok(pixels),
        _ => Err(wrong()),
    };
    Ok([side(width)?, side(height)?])
}

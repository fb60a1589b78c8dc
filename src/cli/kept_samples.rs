//! Samples of a picture of paths in a file, `--keep-samples`: whoever was stopped, or wants more of them, goes on with
//! `--resume`.
//!
//! ```text
//! "stratavox samples\n"    u32 version    u32 length of JSON    JSON    sums (`PathSums`)    u32 CRC-32 of all before
//! {"picture": "/a/b.png", "of": {"version": .., "device": .., "volume": .., "scene": {..}}}
//! ```
//!
//! Numbers are little-endian. `of` has all that the sums depend on, and is compared place by place; how many samples there
//! are to be, and what becomes of them, is no part of it. The length of the file is known from the picture's size before
//! anything is taken from it. Sums of layers are there that the run wanted, and guides of `--denoise-picture` always.

use super::{
    Error,
    flags::{PictureFlags, SceneFlags, Size},
    output::write_whole,
    resume_check::{difference, hash_of, hash_voxels},
    scene_file,
    signals::Gate,
};
use crate::{
    offscreen::PathSums,
    picture::LayerKind,
    technique::{Settings, pathtrace::SkyPicture},
    volume::Volume,
};
use flate2::Crc;
use serde_json::{Value, json};
use std::{
    fs::File,
    hash::Hash,
    io::{self, Read},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
};

const MAGIC: &[u8] = b"stratavox samples\n";
const VERSION: u32 = 3;
/// A scene has its functions in it, of at most as much.
const MAX_WORDS_BYTES: u32 = 8 << 20;

/// The file, and what a run before has left in it.
#[derive(Debug)]
pub struct KeptSamples {
    path: PathBuf,
    past: Option<Past>,
}

/// What is there of a run before.
#[derive(Debug)]
struct Past {
    picture: PathBuf,
    of: Value,
    /// `None`: of a picture of another size.
    sums: Option<PathSums>,
}

/// What the sums of a picture depend on.
#[derive(Debug)]
pub struct PictureOf<'a> {
    /// All words, as `--save-scene` writes them.
    pub scene: &'a SceneFlags,
    /// Pixels across and down.
    pub extent: [u32; 2],
    /// What is drawn.
    pub volume: &'a Volume,
    /// What is computed.
    pub settings: &'a Settings,
    /// Who draws.
    pub device: String,
    /// And by which driver.
    pub driver: String,
}

impl KeptSamples {
    /// The file at `path` for a picture of so many pixels. Only `force` replaces one that is not gone on with.
    pub fn open(path: &Path, extent: [u32; 2], resume: bool, force: bool) -> Result<Self, Error> {
        let is_there = path.symlink_metadata().is_ok();
        if is_there && !resume && !force {
            return Err(Error::Output {
                path: path.to_owned(),
                problem: "samples of a picture may be there".to_owned(),
                hint: Some("--resume goes on with them, --force begins anew"),
            });
        }
        let past = match is_there && resume {
            true => Some(Past::read(path, extent)?),
            false => None,
        };
        Ok(Self {
            path: path.to_owned(),
            past,
        })
    }

    /// Whether the picture at `output` is that of the run before: it is replaced by a better one.
    pub fn replaces(&self, output: &Path) -> bool {
        let is_its = |past: &Past| std::path::absolute(output).is_ok_and(|own| own == past.picture);
        self.past.as_ref().is_some_and(is_its)
    }

    /// What to go on with, and who keeps what comes.
    pub fn begin(
        self,
        output: &Path,
        of: &PictureOf,
        force: bool,
    ) -> Result<(PathSums, Keeper), Error> {
        let own = of.words();
        let sums = match self.past {
            None => PathSums::default(),
            Some(past) => {
                // What says most comes first: all else may follow from it.
                let size = |of: &Value| of["scene"]["picture"]["size"].clone();
                let why = difference("scene.picture.size", &size(&past.of), &size(&own))
                    .or_else(|| difference("volume", &past.of["volume"], &own["volume"]))
                    .or_else(|| difference("", &past.of, &own));
                let layers = of.scene.picture.layers().into_iter();
                let lacking = |sums: &PathSums| -> Vec<_> {
                    let lacking = layers.filter(|&layer| !sums.have(layer));
                    lacking.map(LayerKind::name).collect()
                };
                match (why, past.sums) {
                    (None, Some(sums)) => match lacking(&sums) {
                        names if names.is_empty() => sums,
                        _ if force => PathSums::default(),
                        names => {
                            return Err(Error::usage(
                                format!(
                                    "--resume: {} keeps no sums of --aov {}",
                                    self.path.display(),
                                    names.join(",")
                                ),
                                "layers of paths are of all of them: leave these out, or --force begins anew",
                            ));
                        }
                    },
                    _ if force => PathSums::default(),
                    (why, _) => {
                        let why = why.unwrap_or_default();
                        return Err(Error::usage(
                            format!("--resume: {}: {why}", self.path.display()),
                            "the words and the input of the first run go on with it; --force begins anew",
                        ));
                    }
                }
            }
        };
        let wanted = of.settings.path.samples;
        let found = sums.paths();
        if found > wanted {
            return Err(Error::usage(
                format!(
                    "--resume: {} has {found} samples a pixel, and --spp is {wanted}",
                    self.path.display()
                ),
                "a larger --spp goes on with them",
            ));
        }
        let picture = std::path::absolute(output).unwrap_or_else(|_| output.to_owned());
        let words = json!({ "picture": picture, "of": own }).to_string();
        let keeper = Keeper {
            path: self.path,
            words,
            failed: Arc::default(),
        };
        Ok((sums, keeper))
    }
}

/// Writes the file.
#[derive(Debug)]
pub struct Keeper {
    path: PathBuf,
    words: String,
    failed: Arc<Mutex<Option<Error>>>,
}

impl Keeper {
    /// Where the last failure to write will be.
    pub fn failed(&self) -> Arc<Mutex<Option<Error>>> {
        Arc::clone(&self.failed)
    }

    /// The sums so far, whole or not at all.
    pub fn keep(&self, sums: &PathSums, gate: &Gate) {
        let words = self.words.as_bytes();
        let mut bytes = MAGIC.to_vec();
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&(words.len() as u32).to_le_bytes());
        bytes.extend_from_slice(words);
        bytes.extend_from_slice(&sums.to_bytes());
        let mut crc = Crc::new();
        crc.update(&bytes);
        bytes.extend_from_slice(&crc.sum().to_le_bytes());
        let written = write_whole(&self.path, &bytes, true, gate);
        *self.failed.lock().unwrap_or_else(PoisonError::into_inner) = written.err();
    }
}

impl PictureOf<'_> {
    fn words(&self) -> Value {
        let Self {
            volume, settings, ..
        } = self;
        let grid = format!("{:?} {:?}", volume.grid(), volume.rescale);
        let volume = hash_of(|hasher| {
            hash_voxels(volume, hasher);
            grid.hash(hasher);
        });
        let sky = settings.path.sky_picture.as_ref();
        let sky = sky.map(|sky| hash_of(|hasher| SkyPicture::bytes(sky).hash(hasher)));
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "device": self.device,
            "driver": self.driver,
            "volume": volume,
            "sky": sky,
            "scene": self.scene_words(),
        })
    }

    /// Without what the sums do not depend on.
    fn scene_words(&self) -> Value {
        let scene = self.scene.clone();
        let mut path = scene.path;
        (path.spp, path.noise, path.seconds) = (None, None, None);
        path.denoise_picture = false;
        if path.file().is_some() {
            // Its pixels count, wherever they lie.
            path.environment = None;
        }
        let mut input = scene.input;
        input.path = None;
        let shows_sky = scene.picture.shows_sky();
        let picture = PictureFlags {
            size: Some(Size(self.extent)),
            ..Default::default()
        };
        let scene = SceneFlags {
            path,
            input,
            picture,
            map: Default::default(),
            annotate: Default::default(),
            device: Vec::new(),
            ..scene
        };
        let text = scene_file::text(&scene, Path::new(""));
        let mut words: Value = serde_json::from_str(&text).expect("what was just written as JSON");
        words["sky_is_seen"] = shows_sky.into();
        words
    }
}

impl Past {
    fn read(path: &Path, extent: [u32; 2]) -> Result<Self, Error> {
        let refused = |problem: String| Error::Input {
            path: path.to_owned(),
            problem,
        };
        let unread = |cause: io::Error| refused(cause.to_string());
        let mut file = File::open(path).map_err(unread)?;
        let length = file.metadata().map_err(unread)?.len();
        let cut_off = |wanted: u64| {
            refused(format!(
                "it is cut off: wanted {wanted} bytes or more, found {length}"
            ))
        };
        let mut head = [0; MAGIC.len() + 8];
        let magic = &mut head[..MAGIC.len()];
        if file.read_exact(magic).is_err() || magic != MAGIC {
            return Err(refused("it holds no samples of a picture".to_owned()));
        }
        let mut wanted = head.len() as u64;
        if length < wanted {
            return Err(cut_off(wanted));
        }
        file.read_exact(&mut head[MAGIC.len()..]).map_err(unread)?;
        let number = |at: usize| {
            let bytes = head[MAGIC.len() + at..][..4].try_into();
            u32::from_le_bytes(bytes.expect("four bytes"))
        };
        let (version, words_bytes) = (number(0), number(4));
        if version != VERSION {
            return Err(refused(format!(
                "samples of version {version}: this program knows {VERSION}"
            )));
        }
        if words_bytes > MAX_WORDS_BYTES {
            return Err(refused(format!(
                "wanted at most {MAX_WORDS_BYTES} bytes of words, found {words_bytes}"
            )));
        }
        wanted += u64::from(words_bytes) + PathSums::HEAD_BYTES as u64;
        if length < wanted {
            return Err(cut_off(wanted));
        }
        let mut words = vec![0; words_bytes as usize];
        file.read_exact(&mut words).map_err(unread)?;
        let value: Value = serde_json::from_slice(&words)
            .map_err(|cause| refused(format!("its words: {cause}")))?;
        let own = |sums| Self {
            picture: value["picture"].as_str().unwrap_or_default().into(),
            of: value["of"].clone(),
            sums,
        };
        let [width, height] = extent;
        if value["of"]["scene"]["picture"]["size"] != format!("{width}x{height}") {
            return Ok(own(None));
        }
        let pixels = u64::from(width) * u64::from(height);
        let mut counts = [0; PathSums::HEAD_BYTES];
        let damaged = || refused("it is damaged".to_owned());
        file.read_exact(&mut counts).map_err(unread)?;
        let bytes = PathSums::byte_count(counts, pixels).ok_or_else(damaged)?;
        let wanted = head.len() as u64 + u64::from(words_bytes) + bytes + 4;
        if length != wanted {
            return Err(refused(format!(
                "wanted {wanted} bytes for {width} x {height} pixels, found {length}"
            )));
        }
        let mut sums = Vec::with_capacity(bytes as usize + 4);
        sums.extend_from_slice(&counts);
        file.take(bytes + 4 - counts.len() as u64)
            .read_to_end(&mut sums)
            .map_err(unread)?;
        let (sums, crc) = sums.split_last_chunk().ok_or_else(damaged)?;
        let mut all = Crc::new();
        for part in [&head[..], &words, sums] {
            all.update(part);
        }
        if all.sum() != u32::from_le_bytes(*crc) {
            return Err(damaged());
        }
        let sums = PathSums::from_bytes(sums, pixels as usize).ok_or_else(damaged)?;
        Ok(own(Some(sums)))
    }
}

//! Volumes to pictures: one is read while another is drawn and those before are encoded and written.

use super::{
    Became, Row,
    parts::Part,
    room::{Room, Share},
};
use crate::{
    cli::{
        Error,
        flags::SceneFlags,
        line::{Line, encoders},
        load,
        memory::{DeviceMemory, DeviceRoom, Held, needed_bytes},
        progress::Progress,
        reasons::why_empty,
        renderer::{Device, Job, Renderer},
        shown::Shown,
        signals::Gate,
    },
    picture::{EncodedPicture, Picture, WriteOptions},
    technique::Settings,
};
use std::{
    panic::resume_unwind,
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        mpsc::{Receiver, Sender, channel, sync_channel},
    },
    thread,
    time::Instant,
};

/// One volume and its picture.
#[derive(Debug)]
pub struct Item {
    /// As `render` takes it.
    pub input: String,
    /// Which of the volumes that it holds.
    pub part: Part,
    /// A name in the folder of pictures.
    pub picture: PathBuf,
    /// The picture is there and stays.
    pub is_kept: bool,
}

/// All that is to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a> {
    /// The flags of every picture.
    pub scene: &'a SceneFlags,
    /// What they say is computed.
    pub settings: &'a Settings,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
    /// The volumes.
    pub items: &'a [Item],
    /// Where pictures go.
    pub folder: &'a Path,
    /// How they are written.
    pub options: WriteOptions,
    /// Who waits for a file to be whole.
    pub gate: &'a Gate,
    /// Who hears how far it is.
    pub progress: &'a Progress,
}

/// What a stage hands on of one volume: its part, and what a person should know.
struct Noted<T> {
    outcome: Result<T, Error>,
    notes: Vec<String>,
}

/// A volume in memory.
struct Read<'a> {
    shown: Shown,
    scene: SceneFlags,
    /// Behind the volume: given back when that has gone.
    _share: Share<'a>,
}

/// A picture and the voxels that it shows.
struct Drawn<P> {
    picture: P,
    dims: [u32; 3],
}

type Volumes<'a> = Mutex<Option<Receiver<(usize, Noted<Read<'a>>)>>>;

impl Batch<'_> {
    /// Draws all, and says what became of each and why the first of those that failed did.
    pub fn draw(self) -> Result<(Vec<Row>, Option<Error>), Error> {
        let places = (0..self.items.len()).filter(|&at| !self.items[at].is_kept);
        let places: Vec<usize> = places.collect();
        let mut rows: Vec<Row> = self.items.iter().map(Item::row).collect();
        let mut first_error = None;
        if places.is_empty() {
            self.progress.note("all pictures are there already");
            return Ok((rows, None));
        }
        self.progress.stage("prepare", 0, 1);
        let words = self.scene.devices();
        let devices = words.iter().map(|word| Device::find(*word));
        let devices = devices.collect::<Result<Vec<_>, _>>()?;
        for device in &devices {
            self.progress.device(&device.name()?);
        }
        let reading = Reading {
            batch: self,
            memory: devices[0].memory()?,
            // What all volumes may take together.
            room: &Room::new(self.scene.input.max_memory.unwrap_or(u64::MAX)),
        };
        let encoders = encoders(self.extent_pixels);
        let line = &Line::new(devices.len() + encoders + 1);
        let (to_drawers, volumes) = sync_channel(0);
        let volumes: &Volumes = &Mutex::new(Some(volumes));
        let (to_encoders, pictures) = channel();
        let start = Instant::now();
        self.progress.volumes(0, places.len(), None);
        thread::scope(|scope| {
            let (reading, places) = (&reading, &places);
            scope.spawn(move || {
                let _stops = line.stops_in_panic();
                for (at, &place) in places.iter().enumerate() {
                    if to_drawers
                        .send((at, reading.read(&self.items[place])))
                        .is_err()
                    {
                        return;
                    }
                }
            });
            let draw = |(device, word)| {
                let pictures = to_encoders.clone();
                scope.spawn(move || {
                    let _stops = line.stops_in_panic();
                    self.draw_on(device, word, volumes, line, &pictures);
                })
            };
            let drawers: Vec<_> = devices.into_iter().zip(words).map(draw).collect();
            drop(to_encoders);
            let encode = |at: usize, drawn| self.encoded(&self.items[places[at]], drawn);
            let written = line.run(pictures, encoders, encode, |at, encoded| {
                let place = places[at];
                let error = self.put(&mut rows[place], encoded);
                let left = (start.elapsed() / (at as u32 + 1))
                    .saturating_mul((places.len() - at - 1) as u32);
                self.progress.volumes(at + 1, places.len(), Some(left));
                if first_error.is_none() {
                    first_error = error;
                }
                Ok(())
            });
            let ended: Vec<_> = drawers.into_iter().map(|drawer| drawer.join()).collect();
            // Who reads ahead stops, if nobody draws any more.
            *volumes.lock().unwrap_or_else(PoisonError::into_inner) = None;
            for ended in ended {
                ended.unwrap_or_else(|fault| resume_unwind(fault));
            }
            written
        })?;
        Ok((rows, first_error))
    }

    fn draw_on<'r>(
        &self,
        device: Device,
        word: Option<&str>,
        volumes: &Volumes<'r>,
        line: &Line,
        pictures: &Sender<(usize, Noted<Drawn<Picture>>)>,
    ) {
        let mut here = Some(device);
        loop {
            let next = {
                let volumes = volumes.lock().unwrap_or_else(PoisonError::into_inner);
                volumes.as_ref().and_then(|volumes| volumes.recv().ok())
            };
            let Some((at, Noted { outcome, mut notes })) = next else {
                return;
            };
            if !line.enter(at) {
                return;
            }
            let outcome = outcome.and_then(|read| {
                // A device that a picture failed on is not used for the next.
                let device = here.take().map_or_else(|| Device::find(word), Ok)?;
                let (drawn, device) = self.draw_one(&read, device, &mut notes)?;
                here = Some(device);
                Ok(drawn)
            });
            if pictures.send((at, Noted { outcome, notes })).is_err() {
                return;
            }
        }
    }

    fn draw_one(
        &self,
        read: &Read,
        device: Device,
        notes: &mut Vec<String>,
    ) -> Result<(Drawn<Picture>, Device), Error> {
        let Read { shown, scene, .. } = read;
        let mut settings = self.settings.clone();
        let camera = shown.camera(scene, self.extent_pixels, &mut settings)?;
        let parts = shown.parts();
        let job = Job {
            volume: &shown.volume,
            stream: shown.stream(),
            classification: &shown.classification,
            beside: parts.beside(),
            settings: &settings,
            extent_pixels: self.extent_pixels,
            layers: &[],
        };
        let mut renderer = Renderer::new(job, &camera, device)?;
        let picture = renderer.draw(&camera)?.picture;
        let reasoned = parts.only(&shown.classification);
        if let Some(reason) = why_empty(&picture, &shown.volume, reasoned, &camera, &settings) {
            notes.push(format!("the picture is empty: {reason}"));
        }
        let dims = shown.volume.dims;
        Ok((Drawn { picture, dims }, renderer.into_device()))
    }

    fn encoded(&self, item: &Item, noted: Noted<Drawn<Picture>>) -> Noted<Drawn<EncodedPicture>> {
        let outcome = noted.outcome.and_then(|Drawn { mut picture, dims }| {
            if let Some(background) = self.scene.picture.background() {
                picture.over_background(background);
            }
            let path = self.folder.join(&item.picture);
            let picture = EncodedPicture::new(&picture, &path, self.options)?;
            Ok(Drawn { picture, dims })
        });
        Noted {
            outcome,
            notes: noted.notes,
        }
    }

    /// Writes a picture and says what there is to say of its volume; the error, where there is none.
    fn put(&self, row: &mut Row, noted: Noted<Drawn<EncodedPicture>>) -> Option<Error> {
        let written = noted.outcome.and_then(|Drawn { picture, dims }| {
            self.gate.whole(|| picture.write(self.options.force))?;
            Ok(dims)
        });
        row.notes = noted.notes;
        let error = match written {
            Ok(dims) => {
                row.dims = Some(dims);
                row.became = Became::Drawn;
                None
            }
            Err(error) => {
                row.error = Some(error.to_string());
                row.picture = None;
                Some(error)
            }
        };
        if let Some(error) = &row.error {
            self.progress.note(&format!("{}: {error}", row.input));
        }
        self.progress
            .volume(&row.input, row.picture.as_deref(), row.error.as_deref());
        error
    }
}

impl Item {
    fn row(&self) -> Row {
        Row {
            input: self.input.clone(),
            series: self.part.series.clone(),
            variable: self.part.variable.clone(),
            picture: Some(self.picture.display().to_string()),
            became: match self.is_kept {
                true => Became::Kept,
                false => Became::Failed,
            },
            ..Row::default()
        }
    }
}

/// Who reads volumes, one after the other.
struct Reading<'a> {
    batch: Batch<'a>,
    /// Of the first device.
    memory: Option<DeviceMemory>,
    room: &'a Room,
}

impl<'a> Reading<'a> {
    fn read(&self, item: &Item) -> Noted<Read<'a>> {
        let progress = Progress::of_part();
        let outcome = self.read_noting(item, &progress);
        Noted {
            outcome,
            notes: progress.into_notes(),
        }
    }

    fn read_noting(&self, item: &Item, progress: &Progress) -> Result<Read<'a>, Error> {
        let mut scene = self.batch.scene.clone();
        scene.input.path = Some(item.input.clone());
        if is_without_layout(&item.input) {
            scene.input.raw = None;
        }
        if item.part != Part::default() {
            scene.input.series = item.part.series.clone();
            scene.input.variable = item.part.variable.clone();
        }
        let source = load::open(&scene.input, &scene.input.limits())?;
        // The source is of the first of several, where nobody chose.
        let header = source.header();
        if let (None, [first, _, ..]) = (&scene.input.variable, &header.variables[..]) {
            let count = header.variables.len();
            progress.note(&format!("drawn is the first of {count} variables, {first}"));
            scene.input.variable = Some(first.clone());
        }
        let held = Held::of(&scene, source.header().components);
        let needed = needed_bytes(source.header(), &scene, self.memory, held);
        let share = self.room.share(needed);
        let shown = Shown::of(source, &scene, self.batch.settings, &self.memory, progress)?;
        Ok(Read {
            shown: shown.at_level(&scene),
            scene,
            _share: share,
        })
    }
}

/// True for a volume that says itself how it lies: `--raw` is for the others.
fn is_without_layout(input: &str) -> bool {
    !Path::new(input)
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("raw"))
}

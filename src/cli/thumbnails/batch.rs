//! Volumes to pictures: one is read while another is drawn and those before are encoded and written.

use super::{
    Became, Row,
    item::{Item, WantedPicture},
    parts::Part,
    room::{Room, Share},
};
use crate::{
    annotate::Annotation,
    cli::{
        Error,
        annotation::{annotation, finish},
        flags::{Depth, SceneFlags, ViewWord},
        line::{Line, encoders},
        load,
        look::{Framing, Use, View, Views, prepared},
        memory::{DeviceMemory, DeviceRoom, Held, needed_bytes},
        progress::Progress,
        reasons::{Shows, why_empty},
        renderer::Device,
        scene_inputs::{SceneInputs, with_level},
        signals::Gate,
    },
    picture::{EncodedPicture, Picture, PictureFormat, WriteOptions},
    technique::Settings,
};
use std::{
    cell::OnceCell,
    panic::resume_unwind,
    path::Path,
    sync::{
        Mutex, PoisonError,
        mpsc::{Receiver, Sender, channel, sync_channel},
    },
    thread,
    time::Instant,
};

/// All that is to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a> {
    /// The flags of every picture.
    pub scene: &'a SceneFlags,
    /// What they say is computed.
    pub settings: &'a Settings,
    /// How exactly pictures are kept.
    pub depth: Depth,
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
    shown: SceneInputs,
    scene: SceneFlags,
    /// Behind the volume: given back when that has gone.
    _share: Share<'a>,
}

/// Pictures and the voxels that they show.
struct Drawn<P> {
    shots: Vec<PlannedPicture<P>>,
    dims: [u32; 3],
}

/// One of the pictures of a volume.
struct PlannedPicture<P> {
    /// Which.
    at: usize,
    picture: P,
    notes: Vec<String>,
    /// What the camera was fitted to.
    framed: Vec<String>,
}

type Volumes<'a> = Mutex<Option<Receiver<(usize, Noted<Read<'a>>)>>>;

impl Batch<'_> {
    /// Draws all, and says what became of each and why the first of those that failed did.
    pub fn draw(self) -> Result<(Vec<Row>, Option<Error>), Error> {
        let places = (0..self.items.len()).filter(|&at| self.items[at].is_wanted());
        let places: Vec<usize> = places.collect();
        let mut rows: Vec<Vec<Row>> = self.items.iter().map(Item::rows).collect();
        let mut first_error = None;
        if places.is_empty() {
            self.progress.note("all pictures are there already");
            return Ok((rows.concat(), None));
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
        let [width, height] = self.extent_pixels;
        let most = self.items.iter().map(|item| item.pictures.len()).max();
        let encoders = encoders([width, height.saturating_mul(most.unwrap_or(1) as u32)]);
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
                    self.draw_on(device, word, volumes, places, line, &pictures);
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
        Ok((rows.concat(), first_error))
    }

    fn draw_on<'r>(
        &self,
        device: Device,
        word: Option<&str>,
        volumes: &Volumes<'r>,
        places: &[usize],
        line: &Line,
        pictures: &Sender<(usize, Noted<Drawn<Picture>>)>,
    ) {
        let mut here = Some(device);
        loop {
            let next = {
                let volumes = volumes.lock().unwrap_or_else(PoisonError::into_inner);
                volumes.as_ref().and_then(|volumes| volumes.recv().ok())
            };
            let Some((at, Noted { outcome, notes })) = next else {
                return;
            };
            if !line.enter(at) {
                return;
            }
            let outcome = outcome.and_then(|read| {
                // A device that a picture failed on is not used for the next.
                let device = here.take().map_or_else(|| Device::find(word), Ok)?;
                let (drawn, device) = self.draw_one(&self.items[places[at]], &read, device)?;
                here = Some(device);
                Ok(drawn)
            });
            if pictures.send((at, Noted { outcome, notes })).is_err() {
                return;
            }
        }
    }

    /// All views of a volume that has come to the device once.
    fn draw_one(
        &self,
        item: &Item,
        read: &Read,
        device: Device,
    ) -> Result<(Drawn<Picture>, Device), Error> {
        let Read { shown, scene, .. } = read;
        let made_for = Use {
            is_film: false,
            is_opaque: true,
            depth: self.depth,
        };
        let framing = |wanted: &WantedPicture| {
            let mut scene = scene.clone();
            if let Some(view) = wanted.view {
                scene.camera.view = Some(view);
            }
            let skip = self.settings.skip;
            Framing::new(&scene, shown, made_for, self.extent_pixels, skip)
        };
        let missing: Vec<_> = item.missing().collect();
        let views: Vec<_> = missing.iter().map(|_| OnceCell::new()).collect();
        let parts = shown.parts();
        let reasoned = parts.only(&shown.classification);
        let annotation = annotation(scene, &shown.header, self.settings.mode)?;
        let annotation_note = annotation.as_ref().and_then(Annotation::note);
        let first = Views::default();
        let (_, wanted) = missing.first().expect("who is read has a picture to come");
        let (mut renderer, fitted) = prepared(&framing(wanted), &parts, &[], device, &first)?;
        let mut fitted = Some(fitted.clone());
        let mut shots = Vec::new();
        for ((at, wanted), view) in missing.iter().zip(&views) {
            let fitted = match fitted.take() {
                Some(first) => first,
                None => framing(wanted).fit(&mut |camera, settings, extent_pixels| {
                    renderer.draw_other(camera, settings, extent_pixels)
                })?,
            };
            let drawn = view.get_or_init(|| fitted);
            let View {
                camera,
                settings,
                scene,
                notes: framed,
            } = drawn;
            renderer.change(&shown.classification, settings);
            let mut picture = renderer.draw(camera)?.picture;
            let reason = why_empty(
                &picture,
                Shows::Volume,
                &shown.volume,
                reasoned,
                camera,
                settings,
            );
            let view = wanted.view.map(|view| format!("--view {}: ", view.name()));
            let view = view.unwrap_or_default();
            let empty = reason.map(|reason| format!("{view}{reason}"));
            let idle = scene.idle().into_iter();
            let notes = idle.chain(empty).chain(annotation_note.clone());
            let framed = framed.iter().map(|note| format!("{view}{note}"));
            let (background, annotation) = (scene.picture.background(), annotation.as_ref());
            let format = PictureFormat::Png;
            finish(
                &mut picture,
                annotation,
                shown,
                drawn,
                &mut renderer,
                background,
                format,
            )?;
            shots.push(PlannedPicture {
                at: *at,
                picture,
                notes: notes.collect(),
                framed: framed.collect(),
            });
        }
        let dims = shown.volume.dims;
        Ok((Drawn { shots, dims }, renderer.into_device()))
    }

    fn encoded(&self, item: &Item, noted: Noted<Drawn<Picture>>) -> Noted<Drawn<EncodedPicture>> {
        let encoded = |shot: PlannedPicture<Picture>| {
            let path = self.folder.join(&item.pictures[shot.at].picture);
            Ok(PlannedPicture {
                at: shot.at,
                picture: EncodedPicture::new(&shot.picture, &path, self.options)?,
                notes: shot.notes,
                framed: shot.framed,
            })
        };
        let outcome = noted.outcome.and_then(|Drawn { shots, dims }| {
            let shots = shots.into_iter().map(encoded);
            let shots = shots.collect::<Result<_, Error>>()?;
            Ok(Drawn { shots, dims })
        });
        Noted {
            outcome,
            notes: noted.notes,
        }
    }

    /// Writes the pictures of a volume and says what there is to say of each; the first error, where there is one.
    fn put(&self, rows: &mut [Row], noted: Noted<Drawn<EncodedPicture>>) -> Option<Error> {
        let mut first_error = None;
        let missing = rows.iter_mut().enumerate();
        let missing = missing.filter(|(_, row)| row.became != Became::Kept);
        match noted.outcome {
            Ok(Drawn { shots, dims }) => {
                for ((_, row), shot) in missing.zip(shots) {
                    row.notes = [noted.notes.clone(), shot.notes].concat();
                    row.framed = shot.framed;
                    let written = self.gate.whole(|| shot.picture.write(self.options.force));
                    let written = written.map_err(Error::from);
                    self.became(row, written.as_ref().map(|()| dims));
                    first_error = first_error.or(written.err());
                }
            }
            Err(error) => {
                for (_, row) in missing {
                    row.notes = noted.notes.clone();
                    self.became(row, Err(&error));
                }
                first_error = Some(error);
            }
        }
        if let (Some(error), Some(row)) = (&first_error, rows.first()) {
            self.progress.note(&format!("{}: {error}", row.input));
        }
        first_error
    }

    /// Notes the voxels of a picture that is there, or why there is none.
    fn became(&self, row: &mut Row, outcome: Result<[u32; 3], &Error>) {
        match outcome {
            Ok(dims) => {
                row.dims = Some(dims);
                row.became = Became::Drawn;
            }
            Err(error) => {
                row.error = Some(error.to_string());
                row.picture = None;
            }
        }
        self.progress.volume(
            &row.input,
            row.view.map(ViewWord::name),
            row.picture.as_deref(),
            row.error.as_deref(),
        );
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
        scene.choose_for_points();
        if is_without_layout(&item.input) {
            scene.input.raw = None;
        }
        if item.part != Part::default() {
            scene.input.series = item.part.series.clone();
            scene.input.variable = item.part.variable.clone();
        }
        if let Some(note) = &item.part.note {
            progress.note(note);
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
        let settings = self.batch.settings;
        if let Some(with_level) = with_level(&scene, settings.mode, source.as_ref(), progress)? {
            scene = with_level;
        }
        let shown = SceneInputs::of(source, &scene, settings, &self.memory, progress)?;
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

//! A renderer for a volume, on a Vulkan device or on the CPU alone: the one place of the program that makes one.

use super::{
    Error,
    devices::driver_text,
    flags::Classification,
    flow::DrawnLines,
    intermediate,
    memory::{DeviceMemory, DeviceRoom},
    progress::Progress,
    signals::Gate,
    timings::{RunsHeld, Stages, in_ms, ms_since},
};
use crate::{
    camera::Camera,
    gpu::{DeviceChoice, Headless, Options},
    offscreen::{self, Ceilings, Kept, PathSums, Stream, Traced, reference},
    picture::{LayerKind, Picture},
    scene::{Beside, Scene},
    technique::{Filter, InPixel, Mode, Role, Settings, layers::Lack, pathtrace::PathTracing},
    volume::{Denoise, Volume, labels::labels_of},
};
use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

/// What stays the same from picture to picture.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// What is drawn.
    pub volume: &'a Volume,
    /// How its values are seen.
    pub classification: &'a Classification,
    /// Where its voxels come from, where it is an outline.
    pub stream: Option<&'a Stream>,
    /// What it is seen together with.
    pub beside: Beside<'a>,
    /// Lines that are drawn with it.
    pub lines: Option<&'a DrawnLines>,
    /// What is computed.
    pub settings: &'a Settings,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
    /// Layers that the picture must have.
    pub layers: &'a [LayerKind],
}

/// What draws, from when it is being made on.
#[derive(Debug)]
pub struct Device {
    making: Mutex<Option<Making>>,
    made: OnceLock<Made>,
}

type Making = JoinHandle<Result<Made, Error>>;

#[derive(Debug)]
struct Made {
    /// `None`: the CPU references.
    on: Option<Kept>,
    found_ms: f64,
}

/// A renderer that is ready to draw.
#[derive(Debug)]
pub struct Renderer<'a> {
    job: Job<'a>,
    /// `None`: the CPU references.
    on_device: Option<Box<offscreen::Renderer<'a>>>,
    /// What bringing the volume to the device took.
    pub upload_ms: f64,
    /// What making the device, pipelines, what rays need not look at, and the light took.
    pub prepare_ms: f64,
    /// Of that, the device.
    pub device_ms: f64,
    /// Of that, pipelines.
    pub pipelines_ms: f64,
    /// Of that, what rays need not look at.
    pub empty_space_ms: f64,
}

/// One picture and what it took.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Before the background.
    pub picture: Picture,
    /// By the device's own clock.
    pub gpu_ms: Option<f64>,
}

/// The middle of a picture is one pixel of a view that is so much narrower, with so many paths.
const MIDDLE_ZOOM: f64 = 1e3;
const MIDDLE_PATHS: u32 = 64;
/// Paths a pixel that are traced once more to count what they meet.
const COUNTED_PATHS: u32 = 2;

/// The word of `--device` for the CPU references.
pub const REFERENCE: &str = "reference";

impl Device {
    /// The one that the word of `--device` names.
    pub fn find(word: Option<&str>) -> Result<Self, Error> {
        Made::find(word).map(Self::from)
    }

    /// The same, made beside what the caller goes on with: bringing in all drivers of a machine takes some 50 ms. What
    /// fails is said by the first call that needs the device.
    pub fn begin(word: Option<&str>) -> Self {
        let word = word.map(str::to_owned);
        let making = std::thread::spawn(move || Made::find(word.as_deref()));
        Self {
            making: Mutex::new(Some(making)),
            made: OnceLock::new(),
        }
    }

    /// Until it is made. An error is told once: whoever was told goes no further.
    pub fn wait(&self) -> Result<(), Error> {
        let mut making = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(making) = making.take() {
            let made = making.join().unwrap_or_else(|fault| resume_unwind(fault))?;
            let _ = self.made.set(made);
        }
        Ok(())
    }

    fn made(&self) -> Result<&Made, Error> {
        self.wait()?;
        Ok(self.made.get().expect("who was told of an error stops"))
    }

    fn into_made(self) -> Result<Made, Error> {
        self.made()?;
        Ok(self.made.into_inner().expect("made above"))
    }

    /// What it does at most, with the texture of this volume; `None` of the CPU references. Ends the device.
    pub fn ceilings(self, volume: &Volume) -> Result<Option<Ceilings>, Error> {
        let mut made = self.into_made()?;
        let device = made.on.as_mut();
        let ceilings = device.map(|on| offscreen::ceilings(&mut on.device, volume));
        Ok(ceilings.transpose()?)
    }

    /// The volume without noise.
    pub fn denoised(self, volume: &Volume, filter: &Denoise) -> Result<(Volume, Self), Error> {
        let mut made = self.into_made()?;
        let volume = match &mut made.on {
            Some(on) => offscreen::denoised(&mut on.device, volume, filter)?,
            None => filter.denoised(volume),
        };
        Ok((volume, made.into()))
    }

    /// Its name.
    pub fn name(&self) -> Result<String, Error> {
        Ok(name_of(self.made()?.headless()))
    }

    /// Its driver and the driver's version.
    pub fn driver(&self) -> Result<String, Error> {
        Ok(driver_of(self.made()?.headless()))
    }
}

impl DeviceRoom for Device {
    fn memory(&self) -> Result<Option<DeviceMemory>, Error> {
        let memory = |on: &Kept| DeviceMemory {
            heap_bytes: on.device.gpu().limits().max_heap_bytes,
            is_of_host: on.device.gpu().is_cpu(),
        };
        Ok(self.made()?.on.as_ref().map(memory))
    }
}

impl Made {
    fn find(word: Option<&str>) -> Result<Self, Error> {
        let start = Instant::now();
        let on = match word {
            Some(REFERENCE) => None,
            _ => {
                let choice = word.map(DeviceChoice::from).unwrap_or_default();
                Some(Headless::new(&choice, &Options::default())?.into())
            }
        };
        Ok(Self {
            on,
            found_ms: ms_since(start),
        })
    }

    fn headless(&self) -> Option<&Headless> {
        self.on.as_ref().map(|on| &on.device)
    }
}

impl From<Made> for Device {
    fn from(made: Made) -> Self {
        Self {
            making: Mutex::default(),
            made: made.into(),
        }
    }
}

fn name_of(device: Option<&Headless>) -> String {
    match device {
        Some(device) => device.gpu().device_name().to_owned(),
        None => "reference (the CPU, without Vulkan)".to_owned(),
    }
}

fn driver_of(device: Option<&Headless>) -> String {
    match device {
        Some(device) => driver_text(device.gpu().identity()),
        None => format!("stratavox {}", env!("CARGO_PKG_VERSION")),
    }
}

impl<'a> Renderer<'a> {
    /// Brings to the device what `camera` sees first.
    pub fn new(job: Job<'a>, camera: &Camera, device: Device) -> Result<Self, Error> {
        check_layers(&job)?;
        let device = device.into_made()?;
        if device.on.is_none() && job.layers.contains(&LayerKind::Noise) {
            return Err(Error::usage(
                "--aov noise is of devices, and --device reference traces all paths at once",
                "leave out --device reference",
            ));
        }
        let Some(on) = device.on else {
            return Ok(Self {
                job,
                on_device: None,
                upload_ms: 0.0,
                prepare_ms: 0.0,
                device_ms: 0.0,
                pipelines_ms: 0.0,
                empty_space_ms: 0.0,
            });
        };
        let start = Instant::now();
        let beside = job.beside.volumes();
        let volumes = [job.volume].into_iter().chain(beside).collect();
        let mut renderer = match job.stream {
            Some(stream) => offscreen::Renderer::streamed(on.device, stream)?,
            None => offscreen::Renderer::with_kept(on, volumes)?,
        };
        let prepare_ms = device.found_ms + ms_since(start);
        let start = Instant::now();
        let scene = job.scene(camera);
        if let Some(lines) = job.lines {
            let geometry = lines.geometry(camera, job.extent_pixels);
            renderer.set_geometry(Some(Arc::new(geometry)));
        }
        let told = intermediate::told(&renderer, &scene);
        renderer.upload(&scene).map_err(told)?;
        let upload_ms = ms_since(start);
        let start = Instant::now();
        renderer.prepare_pipelines(&scene).map_err(told)?;
        let pipelines_ms = ms_since(start);
        let start_of_space = Instant::now();
        renderer.prepare_empty_space(&scene).map_err(told)?;
        let empty_space_ms = ms_since(start_of_space);
        if !scene.settings.mode.is_projection() {
            renderer.prepare_light(&scene).map_err(told)?;
        }
        Ok(Self {
            job,
            on_device: Some(Box::new(renderer)),
            upload_ms,
            prepare_ms: prepare_ms + ms_since(start),
            device_ms: device.found_ms,
            pipelines_ms,
            empty_space_ms,
        })
    }

    /// From here on `watch` is told how much of a picture is done, 0 to 1; the CPU references tell nothing.
    pub fn watch(&mut self, watch: impl FnMut(f64) + Send + 'a) {
        if let Some(renderer) = &mut self.on_device {
            renderer.watch(watch);
        }
    }

    /// From here on `watch` is told what has been traced of a picture of paths; of the CPU references nothing.
    pub fn watch_paths(&mut self, watch: impl FnMut(Traced) + Send + 'a) {
        if let Some(renderer) = &mut self.on_device {
            renderer.watch_paths(watch);
        }
    }

    /// Paths a second of the last picture; `None` of other techniques.
    pub fn paths_per_s(&self) -> Option<f64> {
        let [width, height] = self.job.extent_pixels.map(f64::from);
        let rate = |traced: Traced| {
            width * height * f64::from(traced.paths - traced.begun) / traced.seconds
        };
        self.traced().map(rate)
    }

    /// Tentative collisions of a path and of its shadow rays, the mean over the picture of this camera, of a few paths more that are
    /// traced for it; `None` of other techniques.
    pub fn collisions_per_sample(&mut self, camera: &Camera) -> Result<Option<f64>, Error> {
        let settings = self.job.settings;
        if !settings.technique.traces_paths() {
            return Ok(None);
        }
        let settings = &Settings {
            path: PathTracing {
                samples: COUNTED_PATHS,
                noise: None,
                seconds: None,
                denoise: false,
                ..settings.path.clone()
            },
            ..settings.clone()
        };
        let scene = Scene {
            settings,
            ..self.job.scene(camera)
        };
        let Some(renderer) = &mut self.on_device else {
            return Ok(None);
        };
        let picture = renderer.render(&scene, &[LayerKind::Samples])?.picture;
        let counts = picture.layers.iter().flat_map(|layer| &layer.values);
        let sum: f64 = counts.map(|&count| f64::from(count)).sum();
        Ok(Some(sum / picture.pixels.len() as f64))
    }

    /// From here on the first interrupt ends a picture of paths early; one of the CPU references it stops.
    pub fn end_paths_by(&mut self, gate: &Gate) {
        let traces = self.job.settings.technique.traces_paths();
        if let Some(renderer) = self.on_device.as_mut().filter(|_| traces) {
            renderer.end_paths_when(gate.ends_early());
        }
    }

    /// Who keeps the sums of paths, and what they begin with; nobody those of the CPU references.
    pub fn keep_paths(&mut self, begun: PathSums, keep: impl FnMut(&PathSums) + Send + 'a) {
        if let Some(renderer) = &mut self.on_device {
            renderer.keep_paths(begun, keep);
        }
    }

    /// What the last picture of paths took; `None` of the CPU references and of other techniques.
    pub fn traced(&self) -> Option<Traced> {
        let renderer = self.on_device.as_ref()?;
        let traces = self.job.settings.technique.traces_paths();
        traces.then(|| renderer.traced())
    }

    /// From here on values are seen so, and so is computed.
    pub fn change(&mut self, classification: &'a Classification, settings: &'a Settings) {
        self.job.classification = classification;
        self.job.settings = settings;
    }

    /// The range of what the mode projects in the picture of this camera; upside down where nothing is hit.
    pub fn projected_range(&mut self, camera: &Camera) -> Result<[f64; 2], Error> {
        let picture = self.draw_with(camera, &[LayerKind::Value])?.picture;
        let values = picture.layers.iter().flat_map(|layer| &layer.values);
        let values = values.filter(|value| !value.is_nan());
        Ok(
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
                [low.min(value.into()), high.max(value.into())]
            }),
        )
    }

    /// The picture that this camera sees, in memory when the call returns.
    pub fn draw(&mut self, camera: &Camera) -> Result<Frame, Error> {
        self.draw_with(camera, self.job.layers)
    }

    /// The samples that the picture of this camera takes, rays through the middles of pixels alone. Draws once
    /// more to count them; paths are those of the last picture.
    pub fn samples(&mut self, camera: &Camera) -> Result<u64, Error> {
        let settings = self.job.settings;
        if settings.technique.traces_paths() {
            let [width, height] = self.job.extent_pixels.map(u64::from);
            let paths = self
                .traced()
                .map_or(settings.path.samples, |traced| traced.paths);
            return Ok(width * height * u64::from(paths));
        }
        let picture = self.draw_with(camera, &[LayerKind::Samples])?.picture;
        let counts = picture.layers.iter().flat_map(|layer| &layer.values);
        Ok(counts.map(|&count| count as u64).sum())
    }

    /// A picture of other settings and of other pixels, without layers.
    pub fn draw_other(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        extent_pixels: [u32; 2],
    ) -> Result<Picture, Error> {
        let scene = Scene {
            settings,
            extent_pixels,
            ..self.job.scene(camera)
        };
        self.put_lines(camera, extent_pixels);
        match &mut self.on_device {
            Some(renderer) => {
                let told = intermediate::told(renderer, &scene);
                Ok(renderer.render(&scene, &[]).map_err(told)?.picture)
            }
            None => self.reference(&scene),
        }
    }

    /// How far ahead of the eye paths through the middle of the picture meet matter, the mean of those that do; `None`: none
    /// does.
    pub fn distance_ahead(
        &mut self,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<Option<f64>, Error> {
        let camera = &Camera {
            zoom: MIDDLE_ZOOM * camera.zoom,
            ..*camera
        };
        let settings = &Settings {
            path: PathTracing {
                samples: MIDDLE_PATHS,
                bounces: Some(0),
                noise: None,
                seconds: None,
                denoise: false,
                lens: None,
                ..settings.path.clone()
            },
            ..settings.clone()
        };
        let scene = Scene {
            settings,
            extent_pixels: [1, 1],
            ..self.job.scene(camera)
        };
        let picture = match &mut self.on_device {
            Some(renderer) => renderer.render(&scene, &[LayerKind::Depth])?.picture,
            None => self.reference(&scene)?,
        };
        let layers = picture.layers.iter();
        let mut depths = layers.filter(|layer| layer.kind == LayerKind::Depth);
        let depth = depths.next().map(|layer| f64::from(layer.values[0]));
        Ok(depth.filter(|depth| *depth > 0.0))
    }

    /// What the CPU references draw.
    fn reference(&self, scene: &Scene) -> Result<Picture, Error> {
        let lines = self.job.lines;
        let geometry = lines.map(|lines| lines.geometry(scene.camera, scene.extent_pixels));
        let picture = reference::render_with::<f32>(scene, geometry.as_ref());
        // Images of the CPU have no limit of their own.
        picture.map_err(|error| intermediate::explained(error.into(), scene, u64::MAX))
    }

    /// Lines are as wide as pixels of the camera say.
    fn put_lines(&mut self, camera: &Camera, extent_pixels: [u32; 2]) {
        if let (Some(lines), Some(renderer)) = (self.job.lines, &mut self.on_device) {
            renderer.set_geometry(Some(Arc::new(lines.geometry(camera, extent_pixels))));
        }
    }

    fn draw_with(&mut self, camera: &Camera, layers: &[LayerKind]) -> Result<Frame, Error> {
        let scene = self.job.scene(camera);
        self.put_lines(camera, self.job.extent_pixels);
        if let Some(renderer) = &mut self.on_device {
            let told = intermediate::told(renderer, &scene);
            let rendered = renderer.render(&scene, layers).map_err(told)?;
            return Ok(Frame {
                picture: rendered.picture,
                gpu_ms: rendered.gpu_ms,
            });
        }
        let mut picture = self.reference(&scene)?;
        let mut made = std::mem::take(&mut picture.layers);
        for kind in layers {
            let at = made.iter().position(|layer| layer.kind == *kind);
            let at = at.expect("`check_layers` knows what a reference makes");
            picture.layers.push(made.swap_remove(at));
        }
        Ok(Frame {
            picture,
            gpu_ms: None,
        })
    }

    /// What the work took until now, the last picture being that of `camera`.
    pub fn stages(
        &self,
        camera: &Camera,
        progress: &Progress,
        gate: &Gate,
        encode_ms: Option<f64>,
    ) -> Stages {
        let loaded = progress.all_loaded();
        let on_device = self.on_device.as_ref();
        let submitted = on_device.map(|renderer| renderer.device().submissions());
        let submitted = submitted.unwrap_or_default();
        let filtered = on_device.and_then(|renderer| renderer.filtered(self.job.settings));
        let grid = self.job.volume.grid();
        let stages = Stages {
            read_ms: in_ms(loaded.read),
            statistics_ms: in_ms(loaded.statistics),
            device_ms: self.device_ms,
            pipelines_ms: self.pipelines_ms,
            empty_space_ms: self.empty_space_ms,
            encode_ms,
            total_ms: ms_since(gate.begun()),
            submissions: submitted.count,
            longest_submission_ms: submitted.longest_ms,
            filtered_by: filtered.map(|filtered| filtered.by),
            filtered_because: filtered.map(|filtered| filtered.because),
            runs: on_device.and_then(|renderer| RunsHeld::of(renderer)),
            ..Stages::default()
        };
        stages.with_view(&self.job.scene(camera).view(&grid, InPixel::CENTER))
    }

    /// The device, free for another volume, with its pipelines and images.
    pub fn into_device(self) -> Device {
        Device::from(Made {
            on: self.on_device.map(|renderer| renderer.into_kept()),
            found_ms: 0.0,
        })
    }

    /// The device's name.
    pub fn device(&self) -> String {
        name_of(self.on_device.as_ref().map(|renderer| renderer.device()))
    }

    /// The driver and its version.
    pub fn driver(&self) -> String {
        driver_of(self.on_device.as_ref().map(|renderer| renderer.device()))
    }

    /// Device memory in use or kept for later.
    pub fn device_bytes(&self) -> u64 {
        match &self.on_device {
            Some(renderer) => renderer.device().gpu().memory().reserved_bytes,
            None => 0,
        }
    }
}

impl<'a> Job<'a> {
    fn scene<'s>(&self, camera: &'s Camera) -> Scene<'s>
    where
        'a: 's,
    {
        Scene {
            beside: self.beside,
            volume: self.volume,
            transfer: match self.classification {
                Classification::Function(function) => Some(function),
                Classification::RangeOfPicture => None,
            },
            camera,
            extent_pixels: self.extent_pixels,
            settings: self.settings,
        }
    }
}

/// True where a map lies over the volume, or the values are labels and nothing mixes them.
fn has_labels(job: &Job) -> bool {
    match job.beside {
        Beside::Nothing => {
            job.settings.filter == Filter::Nearest
                && job.stream.is_none()
                && labels_of(job.volume).is_some()
        }
        Beside::Channels(channels) => channels.iter().any(|one| one.role == Role::Labels),
        Beside::Colors(_) | Beside::Classified(_) | Beside::Preclassified | Beside::Points(_) => {
            false
        }
    }
}

/// What to leave, so that one number a voxel is seen alone.
fn one_number(beside: &Beside) -> &'static str {
    match beside {
        Beside::Channels(others) if others.iter().any(|one| one.role == Role::Labels) => {
            match others.len() {
                1 => "one number a voxel: no --labels",
                _ => "one number a voxel: --component 0 and no --labels",
            }
        }
        _ => "one number a voxel: --component 0",
    }
}

/// Layers that the picture does not have, with what would give them.
fn check_layers(job: &Job) -> Result<(), Error> {
    let is_of_one = matches!(job.beside, Beside::Nothing | Beside::Points(_));
    for &layer in job.layers {
        let missing = match job.settings.lack(layer, !is_of_one) {
            Some(Lack::OneNumber) => one_number(&job.beside),
            Some(Lack::OneValue) => "a mode with one value, such as --mode mip",
            Some(Lack::Transmittance) => "--mode composite",
            Some(Lack::Rays) => "--technique raycast",
            Some(Lack::Paths) => "--technique pathtrace",
            Some(Lack::Unlit) => "another --background than environment",
            Some(Lack::Depth) => "a mode with a depth, such as --mode mip",
            Some(Lack::Annotation) | None => match layer {
                LayerKind::Label if !has_labels(job) => {
                    "labels: --labels FILE, or a volume of labels with --filter nearest"
                }
                LayerKind::Line if job.lines.is_none() => "lines: --flow stream",
                LayerKind::Normal if job.stream.is_some() => "the voxels in memory: no --stream",
                LayerKind::Normal if !is_of_one && job.settings.mode != Mode::Iso => {
                    one_number(&job.beside)
                }
                _ => continue,
            },
        };
        return Err(Error::usage(
            format!("--aov {} needs {missing}", layer.name()),
            "without --aov the picture itself can be drawn",
        ));
    }
    Ok(())
}

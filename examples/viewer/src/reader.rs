//! Reads the times of a series on a thread of its own, and puts each into textures: making objects may run beside
//! recordings. Only the newest wish is read.

use crate::error::Error;
use crate::subject::Way;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use stratavox::embed;
use stratavox::gpu::Gpu;
use stratavox::technique::Settings;
use stratavox::volume::{Source, Volume};

pub struct Reader {
    wishes: Option<Sender<Wish>>,
    found: Receiver<Result<Read, Error>>,
    thread: Option<JoinHandle<()>>,
    /// The time that is on its way.
    pub pending: Option<u32>,
}

struct Wish {
    time: u32,
    settings: Settings,
}

/// One time of the series.
pub struct Read {
    pub time: u32,
    pub voxels: Volume,
    /// Its textures, for renderers of these settings; not uploaded yet.
    pub textures: embed::Volume,
    pub settings: Settings,
}

impl Reader {
    /// `wake` is called when there is something to take.
    pub fn new(
        gpu: &Arc<Gpu>,
        source: Arc<dyn Source>,
        way: Way,
        wake: impl Fn() + Send + 'static,
    ) -> Self {
        let (wishes, wished) = channel::<Wish>();
        let (give, found) = channel();
        let gpu = Arc::clone(gpu);
        let thread = std::thread::spawn(move || {
            while let Ok(mut wish) = wished.recv() {
                while let Ok(newer) = wished.try_recv() {
                    wish = newer;
                }
                if give.send(read(&gpu, source.as_ref(), way, wish)).is_err() {
                    return;
                }
                wake();
            }
        });
        Self {
            wishes: Some(wishes),
            found,
            thread: Some(thread),
            pending: None,
        }
    }

    /// Asks for a time, in the textures that such settings read.
    pub fn ask(&mut self, time: u32, settings: &Settings) {
        let wish = Wish {
            time,
            settings: settings.clone(),
        };
        if let Some(wishes) = &self.wishes
            && wishes.send(wish).is_ok()
        {
            self.pending = Some(time);
        }
    }

    /// What was read since, if anything.
    pub fn take(&mut self) -> Option<Result<Read, Error>> {
        let found = self.found.try_recv().ok()?;
        self.pending = None;
        Some(found)
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        // Without a sender the thread ends; it holds the device until then.
        self.wishes = None;
        if let Some(thread) = self.thread.take() {
            // A panic there was printed when it happened.
            let _ = thread.join();
        }
    }
}

fn read(gpu: &Arc<Gpu>, source: &dyn Source, way: Way, wish: Wish) -> Result<Read, Error> {
    let Wish { time, settings } = wish;
    let (voxels, _) = way.read(source, time)?;
    let textures = embed::Volume::new(gpu, &voxels, &settings)?;
    Ok(Read {
        time,
        voxels,
        textures,
        settings,
    })
}

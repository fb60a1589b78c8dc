//! Work in submissions that none takes long, and who is told how far it is.

use crate::gpu::{Error, Gpu, Headless, Timer};
use crate::gpu::{Pace, TARGET_MS};
use ash::vk;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Who is told how much of a picture is done.
pub type Watch<'v> = Box<dyn FnMut(f64) + Send + 'v>;

/// How a renderer cuts its work.
pub struct TimeSlices<'v> {
    /// How long a submission shall take.
    pub target_ms: f64,
    watch: Option<Watch<'v>>,
    /// What is being drawn, as a part of what was asked for: where it begins, and how much it is.
    span: [f64; 2],
}

impl TimeSlices<'_> {
    /// As a device wants it. No watchdog looks at one that computes on the processor, and there each submission costs
    /// milliseconds of its own: it gets twice the time.
    pub fn of(gpu: &Gpu) -> Self {
        Self {
            target_ms: if gpu.is_cpu() {
                2.0 * TARGET_MS
            } else {
                TARGET_MS
            },
            watch: None,
            span: [0.0, 1.0],
        }
    }
}

impl fmt::Debug for TimeSlices<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TimeSlices")
            .field("target_ms", &self.target_ms)
            .field("span", &self.span)
            .finish_non_exhaustive()
    }
}

/// Some work.
#[derive(Clone, Debug)]
pub struct Work {
    /// Parts of it that may lie in different submissions.
    pub units: Range<u64>,
    /// What all of them will take, rather too much than too little.
    pub expected_ms: f64,
    /// Whether it draws the picture: the watch is told how much of it is done.
    pub is_drawing: bool,
    /// Whether something is recorded behind it in the last submission, which the clock does not count.
    pub is_finished: bool,
}

impl Work {
    /// What is made before a picture is drawn.
    pub fn beside(units: Range<u64>, expected_ms: f64) -> Self {
        Self {
            units,
            expected_ms,
            is_drawing: false,
            is_finished: false,
        }
    }
}

/// What a device did in its submissions.
#[derive(Clone, Copy, Debug)]
pub struct Spent {
    /// By its own clock, if it has one.
    pub gpu_ms: Option<f64>,
    /// From submissions until they were done.
    pub wall_ms: f64,
}

impl<'v> TimeSlices<'v> {
    /// From here on `watch` is told.
    pub fn watch(&mut self, watch: Watch<'v>) {
        self.watch = Some(watch);
    }

    /// What comes is part number `number` of `of` equal ones of what was being drawn, which is given back and goes to
    /// [`TimeSlices::leave`].
    pub fn enter(&mut self, number: usize, of: usize) -> [f64; 2] {
        self.enter_some(number..number + 1, of)
    }

    /// The same for several of them.
    pub fn enter_some(&mut self, numbers: Range<usize>, of: usize) -> [f64; 2] {
        let [from, size] = self.span;
        let one = size / of.max(1) as f64;
        let part = [
            from + one * numbers.start as f64,
            one * numbers.len() as f64,
        ];
        std::mem::replace(&mut self.span, part)
    }

    /// Back to what was being drawn.
    pub fn leave(&mut self, span: [f64; 2]) {
        self.span = span;
    }

    fn tell(&mut self, part: f64) {
        let [from, size] = self.span;
        if let Some(watch) = &mut self.watch {
            watch(from + part * size);
        }
    }

    /// Runs some work. `record` is given the units of one submission; none for what is recorded behind all of them.
    pub fn run(
        &mut self,
        device: &mut Headless,
        timer: Option<&Timer>,
        work: Work,
        mut record: impl FnMut(vk::CommandBuffer, &Gpu, Range<u64>) -> Result<(), Error>,
    ) -> Result<Spent, Error> {
        let gpu = Arc::clone(device.gpu());
        let first = work.units.start;
        let count = work.units.end - first;
        let mut pace = Pace::new(count, work.expected_ms, self.target_ms);
        let mut gpu_ms = timer.map(|_| 0.0);
        while let Some(part) = pace.next() {
            device.run(|cmd| {
                // SAFETY: recorded outside rendering, in this order, into one command buffer that `run` waits for.
                let start = || unsafe { timer.inspect(|timer| timer.start(cmd)) };
                // SAFETY: as above.
                let stop = || unsafe { timer.inspect(|timer| timer.stop(cmd)) };
                start();
                record(cmd, &gpu, first + part.start..first + part.end)?;
                stop();
                match work.is_finished && part.end == count {
                    true => record(cmd, &gpu, work.units.end..work.units.end),
                    false => Ok(()),
                }
            })?;
            let more = timer.map_or(Ok(None), Timer::elapsed_ms)?;
            gpu_ms = gpu_ms.zip(more).map(|(sum, more)| sum + more);
            pace.took(part, device.submissions().last_ms);
            if work.is_drawing {
                self.tell(pace.part());
            }
        }
        Ok(Spent {
            gpu_ms,
            wall_ms: pace.spent_ms(),
        })
    }
}

//! Splats of a volume in parts: some drivers end the loops of an invocation after so many turns
//! ([`crate::gpu::Caps::max_loop_turns`]). A part takes some sheets of each ray, or some of its slices where sheets are these or
//! none, and goes on with what those before have left.
//!
//! ```text
//! turns of a slice = 2 + n (1 + clips)                          n voxels near the ray
//! slices of N image-aligned sheets = |d_k| (N s + 2 (reach + s)) + 3      s the length of a sheet along the ray
//! ```
//!
//! A slice that reaches into sheets of two parts is gone through by both: it adds to each sheet what it adds to that alone.

use super::kernel::Kernel;
use super::line::Line;
use super::{Sheets, sheets_of, stack_axis, uses_stack};
use crate::lattice::main_axis;
use crate::technique::{Error, View};

/// Turns of loops that are not gone round for every slice.
const SPARE_TURNS: f64 = 1024.0;
/// All sheets, and all slices, of a ray.
const ALL: u32 = i32::MAX as u32;

/// What the loops of a ray go round for.
struct Loops {
    /// Along the whole ray.
    slices: f64,
    /// Near the ray in each slice.
    voxels: f64,
    /// Turns of a slice.
    of_slice: f64,
    /// Slices in the length of an image-aligned sheet, and those that reach into a part of such sheets from outside.
    in_sheet: f64,
    beside: f64,
}

impl View<'_> {
    /// How many sheets of a ray one recording takes, or of its slices, so that its loops are no longer than the device allows.
    ///
    /// # Errors
    /// [`Error::SplatLoopsEnd`] where one is too many.
    pub(crate) fn splat_sheets_at_once(&self, max_loop_turns: u32) -> Result<u32, Error> {
        match self.splat_turns(max_loop_turns) {
            None => Ok(ALL),
            Some((at_once, _)) if at_once > 0 => Ok(at_once),
            Some((_, error)) => Err(error),
        }
    }

    /// Whether one recording takes all of each ray.
    ///
    /// # Errors
    /// [`Error::SplatLoopsEnd`].
    pub(crate) fn check_splats_in_one(&self, max_loop_turns: u32) -> Result<(), Error> {
        self.splat_turns(max_loop_turns)
            .map_or(Ok(()), |(_, error)| Err(error))
    }

    /// `None` where loops are short enough; else how many sheets or slices are, and what is said of all.
    fn splat_turns(&self, max_loop_turns: u32) -> Option<(u32, Error)> {
        let settings = self.settings;
        if !settings.technique.splats() || settings.splat.of_points || max_loop_turns == u32::MAX {
            return None;
        }
        let is_image = sheets_of(settings.mode, settings.splat.sheets) == Sheets::Image;
        // These are closed one by one.
        let closing = if is_image { 2.0 } else { 0.0 };
        let room = f64::from(max_loop_turns) - SPARE_TURNS;
        let (mut at_once, mut is_whole) = (f64::from(ALL), true);
        let (mut most, mut splats) = (0.0, 0.0);
        for loops in self.splat_loops() {
            let of_whole = loops.slices * loops.of_slice;
            is_whole &= of_whole + closing * self.longest_sample_count() <= room;
            let fits = match is_image {
                true => {
                    let of_sheet = loops.in_sheet * loops.of_slice + closing;
                    (room - loops.beside * loops.of_slice) / of_sheet
                }
                false => room / loops.of_slice,
            };
            at_once = at_once.min(fits);
            if of_whole > most {
                (most, splats) = (of_whole, loops.slices * loops.voxels);
            }
        }
        let error = Error::SplatLoopsEnd {
            wanted: splats,
            limit: (room.max(0.0) * splats / most).floor(),
        };
        (!is_whole).then_some((at_once.max(0.0) as u32, error))
    }

    /// How many recordings of so many sheets or slices each the longest ray takes.
    pub(crate) fn splat_parts(&self, at_once: u32) -> usize {
        let settings = self.settings;
        if at_once == ALL || !settings.technique.splats() || settings.splat.of_points {
            return 1;
        }
        let of_ray = match sheets_of(settings.mode, settings.splat.sheets) {
            // Those that splats beyond the box reach into are cut by either end.
            Sheets::Image => self.longest_sample_count() + self.open_sheets() + 2.0,
            Sheets::Axis | Sheets::None => self
                .grid
                .dims
                .into_iter()
                .map(f64::from)
                .fold(0.0, f64::max),
        };
        (of_ray / f64::from(at_once)).ceil() as usize
    }

    fn splat_loops(&self) -> impl Iterator<Item = Loops> {
        let kernel = Kernel::of(self);
        let clips = self.settings.clip_planes.len() as f64;
        let of_each = 1.0 + if clips > 0.0 { clips + 1.0 } else { 0.0 };
        let stack = uses_stack(self.settings).then(|| stack_axis(self));
        let step = self.step_world();
        self.some_rays().map(move |(origin, direction, cosine)| {
            let (o, d) = (origin.to_array(), direction.to_array());
            let axis = stack.unwrap_or_else(|| main_axis(d));
            let line = Line::of_kernel(&kernel, axis, o, d);
            let across = line.half_widths.iter().map(|w| (2.0 * w + 1.0).ceil());
            let voxels: f64 = across.product();
            let sheet = step / cosine;
            Loops {
                slices: f64::from(self.grid.dims[axis]),
                voxels,
                of_slice: 2.0 + voxels * of_each,
                in_sheet: d[axis].abs() * sheet,
                beside: d[axis].abs() * 2.0 * (line.reach + sheet) + 3.0,
            }
        })
    }
}

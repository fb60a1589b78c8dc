//! Splatting on the CPU: CPU reference of `shaders/splat.wgsl` and `shaders/splat_projection.wgsl`.
//!
//! ```text
//! for each slice, from front to back:        sheets that end before all of it are closed
//!     for each voxel near the ray:           adds its part to each open sheet
//! ```
//!
//! With w the part of a voxel's splat in a sheet (`line.rs`), a closed sheet is
//!
//! ```text
//! composite            v = sum of f w / sum of w, a sample of the sheet's length     extreme of v in mip and minip
//! the same, classified     alpha = 1 - exp(-sum of sigma w)    colour = sum of sigma c w / sum of sigma w
//! xray, average        none: sum of f F; sum of f F / sum of F
//! ```
//!
//! Where voxels without data have more than half of the weight there is none.

use super::line::Line;
use super::open_sheets::{OpenSheets, edge_of};
use super::{Sheets, points, sheets_of};
use crate::lattice::{Segment, Slab, main_axis};
use crate::ray::{
    Ray, domain_interval, pixel_ray, plane_length, plane_t, vector, visible_interval, voxel_ray,
};
use crate::real::{Real, dot};
use crate::shaders::Frame;
use crate::technique::Mode;
use crate::technique::composite::Composite;
use crate::technique::projected::Projected;
use crate::technique::reference::{Gathered, Samples};

/// Beyond all rays.
const ENDLESS: f32 = 1e15;

/// What the splats of a pixel gather.
pub(crate) fn pixel<R: Real>(of: &impl Samples<R>, pixel: [R; 2]) -> Gathered<R> {
    if let Some(points) = of.points() {
        return points::reference::pixel(of, points, pixel);
    }
    let (frame, settings) = (&of.frame_of(pixel), of.settings());
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let axis = match frame.slice_axis {
        axis @ 0..=2 => axis as usize,
        // The ray's own.
        _ => main_axis(voxel.direction),
    };
    let take = match settings.mode {
        Mode::Average | Mode::Xray => Take::Sum,
        mode if mode.is_projection() => Take::Value,
        _ if of.is_classified() => Take::Classified,
        _ => Take::Composite,
    };
    let Some(part) = Range::of(frame, take, &world, &voxel) else {
        return Walk::new(of, take).gathered();
    };
    let mut walk = Walk::new(of, take);
    let line = Line::new(frame, axis, &voxel);
    let sheets = sheets_of(settings.mode, settings.splat.sheets);
    walk.slices(&world, &line, &part, sheets);
    walk.gathered()
}

/// What is made of splats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Take {
    Composite,
    Classified,
    Value,
    Sum,
}

impl Take {
    /// Splats are added as they are: a voxel counts by its centre, and nothing behind the eye.
    fn is_added(self) -> bool {
        matches!(self, Self::Classified | Self::Sum)
    }
}

/// What of a ray counts.
pub(super) struct Range<R> {
    /// Where samples may lie.
    pub t: [R; 2],
    /// Where splats are cut.
    pub part: [R; 2],
    /// The voxels that are splatted, the last included.
    kept: [[i32; 3]; 2],
}

impl<R: Real> Range<R> {
    /// `None` where nothing does.
    fn of(frame: &Frame, take: Take, world: &Ray<R>, voxel: &Ray<R>) -> Option<Self> {
        let endless = R::from_f32(ENDLESS);
        if take.is_added() {
            let t = visible_interval(frame, [R::from_f64(0.0), endless], world);
            let kept = [frame.splat_first, frame.splat_last];
            return Some(Self { t, part: t, kept });
        }
        let t = visible_interval(frame, domain_interval(frame, world, voxel), world);
        (t[0] < t[1]).then(|| Self {
            t,
            part: [-endless, endless],
            kept: [[0; 3], frame.dims.map(|n| n as i32 - 1)],
        })
    }

    /// Slices that may have a part there, from front to back: the first, which way, how many.
    fn slices(&self, line: &Line<R>, margin: R) -> [i32; 3] {
        let k = line.axes[2];
        let (low, high) = (self.kept[0][k], self.kept[1][k]);
        let number = |i: i32| R::from_f64(f64::from(i));
        let half = R::from_f64(0.5);
        let at = |t: R| line.origin[2] + t * line.direction[2] - half;
        let ends = [at(self.t[0] - margin), at(self.t[1] + margin)];
        let first = ends[0].min(ends[1]).max(number(low)).floor().to_i32();
        let last = ends[0].max(ends[1]).min(number(high)).ceil().to_i32();
        match line.direction[2] > R::from_f64(0.0) {
            true => [first, 1, last - first + 1],
            false => [last, -1, last - first + 1],
        }
    }
}

/// Voxels of a slice that may lie within reach of the ray.
struct Rectangle<R> {
    /// The first column and row, and how many.
    first: [i32; 2],
    count: [i32; 2],
    /// From the crossing to the first of them.
    from: [R; 2],
}

impl<R: Real> Rectangle<R> {
    fn of(line: &Line<R>, range: &Range<R>, t: R) -> Self {
        let at = line.at(t);
        let half = R::from_f64(0.5);
        let mut found = Self {
            first: [0; 2],
            count: [0; 2],
            from: [half; 2],
        };
        for (a, &k) in line.axes.iter().take(2).enumerate() {
            let number = |i: i32| R::from_f64(f64::from(i));
            let low = (at[a] - line.half_widths[a] - half).max(number(range.kept[0][k]));
            let high = (at[a] + line.half_widths[a] - half).min(number(range.kept[1][k]));
            found.first[a] = low.ceil().to_i32();
            found.count[a] = (high.floor().to_i32() - found.first[a] + 1).max(0);
            found.from[a] = number(found.first[a]) + half - at[a];
        }
        found
    }
}

/// What a walk has gathered.
struct Walk<'a, R, S> {
    of: &'a S,
    take: Take,
    composite: Composite<R>,
    projected: Projected<R>,
    /// Splats that the ray has met.
    splats: u32,
}

impl<'a, R: Real, S: Samples<R>> Walk<'a, R, S> {
    fn new(of: &'a S, take: Take) -> Self {
        Self {
            of,
            take,
            composite: Composite::default(),
            projected: Projected::default(),
            splats: 0,
        }
    }

    fn gathered(self) -> Gathered<R> {
        let zero = R::from_f64(0.0);
        match self.take {
            Take::Composite | Take::Classified => {
                let found = Gathered::of_composite((self.composite, self.splats));
                Gathered {
                    depth: None,
                    ..found
                }
            }
            Take::Value | Take::Sum => {
                let Projected {
                    value,
                    weight,
                    depth,
                } = self.projected;
                let found = Gathered::of_blended([value, weight, zero, zero], self.splats as f32);
                Gathered { depth, ..found }
            }
        }
    }

    fn is_finished(&self) -> bool {
        self.composite.transmittance < R::from_f32(self.of.frame().termination)
    }

    fn slices(&mut self, world: &Ray<R>, line: &Line<R>, range: &Range<R>, sheets: Sheets) {
        let frame = self.of.frame();
        let length = plane_length(frame, world);
        let [first, step, count] = range.slices(line, line.reach + length);
        if count <= 0 {
            return;
        }
        let crossings = [first, first + step * (count - 1)].map(|m| line.crossing(m));
        let mut open = match sheets {
            Sheets::Image => Some(OpenSheets::new(frame, world, line, range, crossings)),
            Sheets::Axis | Sheets::None => None,
        };
        for m in (0..count).map(|i| first + i * step) {
            let t = line.crossing(m);
            if let Some(open) = &mut open {
                while open.is_done_before(t - line.reach) {
                    self.with_image_sheet(world, range, open.first, open.close());
                    if self.is_finished() {
                        return;
                    }
                }
                open.move_to(line, range, t);
            }
            let mut slice = [R::from_f64(0.0); 4];
            let rectangle = Rectangle::of(line, range, t);
            let [columns, rows] = rectangle.count;
            for n in 0..columns * rows {
                let mut at = [n % columns, n / columns];
                if sheets == Sheets::None {
                    // Front to back.
                    for (a, at) in at.iter_mut().enumerate() {
                        if line.direction[a] < R::from_f64(0.0) {
                            *at = rectangle.count[a] - 1 - *at;
                        }
                    }
                }
                let from: [R; 2] =
                    std::array::from_fn(|a| rectangle.from[a] + R::from_f64(f64::from(at[a])));
                let Some([weight, drift]) = line.splat(from) else {
                    continue;
                };
                let mut index = [0; 3];
                index[line.axes[0]] = rectangle.first[0] + at[0];
                index[line.axes[1]] = rectangle.first[1] + at[1];
                index[line.axes[2]] = m;
                if !self.is_kept(index) {
                    continue;
                }
                self.splats += 1;
                let numbers = self.numbers(index);
                if let Some(open) = &mut open {
                    open.add(line, drift, weight, numbers);
                    continue;
                }
                let before = |end: R| line.before(line.kappa * (end - t - drift));
                let weight = weight * (before(range.part[1]) - before(range.part[0]));
                if sheets == Sheets::Axis {
                    slice = std::array::from_fn(|c| slice[c] + weight * numbers[c]);
                } else {
                    self.with_splat(weight, numbers);
                    if self.is_finished() {
                        return;
                    }
                }
            }
            if sheets == Sheets::Axis {
                let is_inside = range.t[0] <= t && t < range.t[1];
                let length = R::from_f64(1.0) / line.direction[2].abs();
                self.with_sheet(slice, is_inside.then_some(Segment { t, length }));
                if self.is_finished() {
                    return;
                }
            }
        }
        while let Some(open) = open.as_mut().filter(|open| open.first <= open.last) {
            self.with_image_sheet(world, range, open.first, open.close());
            if self.is_finished() {
                return;
            }
        }
    }

    /// Whether clip planes leave the centre of a voxel, where that says what is splatted.
    fn is_kept(&self, index: [i32; 3]) -> bool {
        let frame = self.of.frame();
        if !self.take.is_added() || frame.clip_plane_count == 0 {
            return true;
        }
        let center = index.map(|i| R::from_f64(f64::from(i) + 0.5));
        let world = frame
            .world_from_voxel
            .map(|[x, y, z, w]| dot(vector([x, y, z]), center) + R::from_f32(w));
        let planes = &frame.clip_planes[..frame.clip_plane_count as usize];
        planes
            .iter()
            .all(|&[x, y, z, w]| dot(vector([x, y, z]), world) >= R::from_f32(w))
    }

    /// What a voxel adds to a sheet, for each part of its weight: sigma c d0 and sigma d0, or value and 1 where it has
    /// data, and 1.
    fn numbers(&self, index: [i32; 3]) -> [R; 4] {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        match self.take {
            Take::Classified => self.of.classified_voxel(index).unwrap_or([zero; 4]),
            _ => match self.of.voxel(index) {
                Some(value) => [value, one, one, zero],
                None => [zero, zero, one, zero],
            },
        }
    }

    /// Takes in sheet `k` of those that face the eye.
    fn with_image_sheet(&mut self, world: &Ray<R>, range: &Range<R>, k: i32, sums: [R; 4]) {
        let frame = self.of.frame();
        let zero = R::from_f64(0.0);
        let length = plane_length(frame, world);
        let segment = match self.take {
            Take::Value => {
                let t = plane_t(frame, world, k);
                (range.t[0] <= t && t < range.t[1]).then_some(Segment { t, length })
            }
            _ => {
                let edges = [k, k + 1].map(|k| edge_of(frame, world, k));
                let cut = Slab::cut(edges, range.t, length);
                (cut.length > zero).then(|| cut.segment())
            }
        };
        self.with_sheet(sums, segment);
    }

    /// Takes in a sheet of these sums; without a segment it is not in the domain.
    fn with_sheet(&mut self, sums: [R; 4], segment: Option<Segment<R>>) {
        let half = R::from_f64(0.5);
        if self.take == Take::Classified {
            self.with_matter(sums);
            return;
        }
        let [sum, weight, all, _] = sums;
        let (Some(segment), true) = (segment, weight > R::from_f64(0.0) && weight >= half * all)
        else {
            return;
        };
        let value = sum / weight;
        if self.take == Take::Composite {
            let material = self.of.classify(value);
            self.composite.add(material, segment.length, segment.t);
        } else {
            let (frame, mode) = (self.of.frame(), self.of.settings().mode);
            // Of extremes there is no last one.
            let _goes_on = self.projected.add(frame, mode, value, segment);
        }
    }

    /// Takes in one splat by itself.
    fn with_splat(&mut self, weight: R, numbers: [R; 4]) {
        if self.take == Take::Classified {
            self.with_matter(numbers.map(|n| weight * n));
            return;
        }
        let (frame, mode) = (self.of.frame(), self.of.settings().mode);
        if numbers[1] > R::from_f64(0.0) {
            let segment = Segment {
                t: R::from_f64(0.0),
                length: weight,
            };
            let _goes_on = self.projected.add(frame, mode, numbers[0], segment);
        }
    }

    /// Matter of so much light and depth, times the reference length.
    fn with_matter(&mut self, [red, green, blue, depth]: [R; 4]) {
        if depth > R::from_f64(0.0) {
            let color = [red, green, blue].map(|c| c / depth);
            let [r, g, b] = color;
            let extinction = depth / R::from_f32(self.of.frame().reference_length);
            let one = R::from_f64(1.0);
            self.composite
                .add([r, g, b, extinction], one, R::from_f64(0.0));
        }
    }
}

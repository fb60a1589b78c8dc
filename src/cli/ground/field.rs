//! The numbers that colour the ground: a variable of one number a column, or a level of one of several.

use super::flags::{GroundFlags, GroundWord};
use crate::annotate::{ColorLegend, caption, unit};
use crate::cli::Error;
use crate::cli::flags::{context, summary};
use crate::cli::flow::{Variables, numbers};
use crate::color::decode_srgb;
use crate::transfer::{Colormap, Interpolation, Kind, TransferFunction, Window};
use crate::volume::{Grid, Header, Volume, sample::linear};
use glam::DVec3;

/// Colours where a variable does not say.
const COLORMAP: &str = "viridis";

/// One number a column on a grid of its own; NaN where there is none.
pub struct Field {
    /// Its columns.
    pub grid: Grid,
    values: Vec<f32>,
    colors: Option<Colormap>,
    is_signed: bool,
    caption: String,
    unit: Option<String>,
}

/// Reads it at a time that may lie between two; `None` is the one of the words.
pub fn read(word: &GroundWord, variables: &Variables<'_>, at: Option<f64>) -> Result<Field, Error> {
    let source = variables.open(&word.variable)?;
    let header = source.header().clone();
    if header.components != 1 {
        return Err(Error::usage(
            format!(
                "--ground {word}: wanted one number a voxel, found {}",
                header.components
            ),
            "name a variable of single numbers",
        ));
    }
    let height = word
        .place
        .map(|place| place.world_height(&header, "--ground"));
    let height = height.transpose()?;
    let last = header.times.saturating_sub(1);
    let time = match at {
        Some(time) => time.min(f64::from(last)),
        None => f64::from(variables.input.time(&header)?.0),
    };
    let first = variables.read(source.as_ref(), time.floor() as u32, 0)?;
    let mut values = of_columns(&first, height);
    if time.fract() > 0.0 {
        let second = variables.read(source.as_ref(), time.ceil() as u32, 0)?;
        let part = time.fract() as f32;
        for (value, next) in values.iter_mut().zip(of_columns(&second, height)) {
            *value += part * (next - *value);
        }
    }
    if values.iter().all(|value| value.is_nan()) {
        return Err(Error::usage(
            format!("--ground {word}: there are no data"),
            "without a level the lowest numbers of all columns are taken",
        ));
    }
    let choice = context(&header).choice(&summary(&first));
    Ok(Field {
        grid: Grid {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
        },
        values,
        colors: choice.colormap,
        is_signed: choice.kind == Kind::Signed,
        caption: with_place(caption(&header), word),
        unit: unit(&header),
    })
}

fn with_place(caption: String, word: &GroundWord) -> String {
    match word.place {
        Some(place) => format!("{caption}, {}", place.words()),
        None => caption,
    }
}

/// The least and the greatest number of all times.
pub fn range_of_all_times(word: &GroundWord, variables: &Variables<'_>) -> Result<[f64; 2], Error> {
    let times = variables.open(&word.variable)?.header().times;
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for time in 0..times.max(1) {
        let [low, high] = read(word, variables, Some(f64::from(time)))?.range();
        range = [range[0].min(low), range[1].max(high)];
    }
    Ok(range)
}

/// At a height of the world, or the lowest of each column.
fn of_columns(volume: &Volume, height: Option<f64>) -> Vec<f32> {
    let [nx, ny, nz] = volume.dims;
    let Some(height) = height else {
        let all = numbers(volume, 1.0);
        let is_rising = volume.world_from_voxel.matrix3.z_axis.z > 0.0;
        let size = nx as usize * ny as usize;
        let column = |i: usize| {
            let levels = 0..nz as usize;
            let at = |level: usize| all[level * size + i];
            let found = match is_rising {
                true => levels.map(at).find(|value| value.is_finite()),
                false => levels.rev().map(at).find(|value| value.is_finite()),
            };
            found.unwrap_or(f32::NAN)
        };
        return (0..size).map(column).collect();
    };
    let voxel_from_world = volume.world_from_voxel.inverse();
    let origin = volume.world_from_voxel.translation;
    let z = voxel_from_world
        .transform_point3(DVec3::new(origin.x, origin.y, height))
        .z;
    let is_inside = (0.0..=f64::from(nz)).contains(&z);
    let all = (0..ny).flat_map(|y| (0..nx).map(move |x| [x, y]));
    let value = |[x, y]: [u32; 2]| {
        let found = linear::<f64>(volume, [f64::from(x) + 0.5, f64::from(y) + 0.5, z]);
        found
            .filter(|_| is_inside)
            .map_or(f32::NAN, |value| value as f32)
    };
    all.map(value).collect()
}

impl Field {
    /// The least and the greatest number.
    pub fn range(&self) -> [f64; 2] {
        let all = self.values.iter().filter(|value| value.is_finite());
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
            [low.min(value.into()), high.max(value.into())]
        })
    }

    /// What its colours mean over a range: about 0 where the numbers are.
    pub fn legend(&self, flags: &GroundFlags, range: [f64; 2]) -> ColorLegend {
        let [low, high] = match (self.is_signed, flags.ground_range) {
            (_, Some(range)) => range.0,
            (true, None) => {
                let most = range[0].abs().max(range[1].abs());
                [-most, most]
            }
            (false, None) => range,
        };
        let named = flags
            .ground_colormap
            .as_deref()
            .and_then(|name| name.parse().ok());
        let signed = || self.is_signed.then(|| Colormap::from_name("vik")).flatten();
        let map = named.or_else(signed).or(self.colors);
        let map = map
            .or_else(|| Colormap::from_name(COLORMAP))
            .expect("one of ours");
        let window = Window::of_range([low, if high > low { high } else { low + 1.0 }]);
        ColorLegend {
            function: TransferFunction {
                color: map.points(window),
                opacity: Vec::new(),
                reference_length: None,
                interpolation: Interpolation::Linear,
                gradient_transfer: None,
                medium: None,
            },
            caption: self.caption.clone(),
            unit: self.unit.clone(),
        }
    }

    /// The number at a place in voxels of the columns, bilinear; that of the nearest column where a neighbour has none.
    pub fn at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let tap = |at: f64, n: u32| {
            let at = (at - 0.5).clamp(0.0, f64::from(n - 1));
            (
                at.floor() as usize,
                (at.floor() as usize + 1).min(n as usize - 1),
                at.fract(),
            )
        };
        let [nx, ny, _] = self.grid.dims;
        let ((x0, x1, s), (y0, y1, t)) = (tap(x, nx), tap(y, ny));
        let value = |x: usize, y: usize| f64::from(self.values[y * nx as usize + x]);
        // A neighbour of no weight need not be there.
        let mix = |a: f64, b: f64, part: f64| if part == 0.0 { a } else { a + part * (b - a) };
        let row = |y: usize| mix(value(x0, y), value(x1, y), s);
        let mixed = mix(row(y0), row(y1), t);
        if mixed.is_finite() {
            return Some(mixed);
        }
        let [near_x, near_y] = [if s < 0.5 { x0 } else { x1 }, if t < 0.5 { y0 } else { y1 }];
        let nearest = value(near_x, near_y);
        nearest.is_finite().then_some(nearest)
    }
}

/// The linear colour of a value.
pub fn color_of(legend: &ColorLegend, value: f64) -> [f32; 3] {
    legend.function.srgb(value).map(|c| decode_srgb(c as f32))
}

/// Whether a header has a place for a ground: its third axis upright.
pub fn is_upright(header: &Header) -> bool {
    let m = header.world_from_voxel.matrix3;
    m.x_axis.z == 0.0 && m.y_axis.z == 0.0 && m.z_axis.x == 0.0 && m.z_axis.y == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    #[test]
    fn numbers_are_bilinear_between_columns_and_the_nearest_where_one_is_missing() {
        let mut field = Field {
            grid: Grid {
                dims: [3, 2, 1],
                world_from_voxel: DAffine3::IDENTITY,
            },
            values: vec![0.0, 1.0, 2.0, 10.0, 11.0, 12.0],
            colors: None,
            is_signed: false,
            caption: String::new(),
            unit: None,
        };
        assert_eq!(field.at([0.5, 0.5]), Some(0.0));
        assert_eq!(field.at([1.75, 1.0]), Some(1.25 + 5.0));
        // Held beyond the outermost middles.
        assert_eq!(field.at([0.0, 2.0]), Some(10.0));
        field.values[5] = f32::NAN;
        assert_eq!(field.at([1.75, 0.5]), Some(1.25));
        assert_eq!(field.at([1.75, 1.2]), Some(11.0));
        assert_eq!(field.at([2.4, 1.2]), None);
        assert_eq!(field.range(), [0.0, 11.0]);
    }
}

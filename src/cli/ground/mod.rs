//! The ground below a volume: `--map terrain` its heights, `--ground VAR` a variable that colours it.
//!
//! ```text
//! heights   of the ground over the columns of the volume, stretched as it is; without terrain the height of the map
//! colours   of the variable; of heights, where there is none; both shaded where there is terrain
//! ```

mod colors;
mod field;
mod flags;
mod surface;

pub use flags::GroundFlags;
pub use surface::Surface;

use super::{
    Error,
    flags::{InputFlags, Numbers, SceneFlags},
    flow::{Variables, ground_heights, sea_of},
    map::ground_height,
    progress::Progress,
    readable::in_unit,
};
use crate::annotate::ColorLegend;
use crate::figure::short;
use crate::geometry::Triangles;
use crate::volume::{Grid, Header};
use field::{color_of, is_upright};
use glam::DVec3;

/// How much relief darkens and brightens the colours of a variable, whose bar says what they mean.
const SHADE_OF_FIELD: f64 = 0.35;
/// Bytes of a column: its number and height, a corner, two triangles.
const BYTES_PER_COLUMN: u64 = 96;

/// What is drawn of the ground.
#[derive(Clone, Debug)]
pub struct Ground {
    /// In the drawn world, heights stretched.
    pub triangles: Triangles,
    /// Before they are stretched, where there is terrain.
    pub terrain: Option<Surface>,
    /// What its colours mean, where a variable colours it.
    pub legend: Option<ColorLegend>,
}

impl Ground {
    /// What the words ask for below the volume of this header, at a time of a film where it is one of its frames; `None`
    /// where they ask for nothing.
    pub fn read(
        scene: &SceneFlags,
        header: &Header,
        stretch: DVec3,
        at: Option<f64>,
        progress: &Progress,
    ) -> Result<Option<Self>, Error> {
        let has_terrain = scene.map.map.is_some_and(|map| map.has_terrain());
        let flags = &scene.ground;
        if !has_terrain && flags.ground.is_none() {
            return Ok(None);
        }
        let input = &input_of_any(scene);
        let variables = Variables {
            input,
            limits: input.limits(),
        };
        let word = if has_terrain {
            "--map terrain"
        } else {
            "--ground"
        };
        check(header, word, &variables)?;
        let grid = Grid {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
        };
        let terrain = match has_terrain {
            true => Some(terrain(&variables, header, &grid)?),
            false => None,
        };
        let field = flags.ground.as_ref();
        let field = field
            .map(|word| field::read(word, &variables, at))
            .transpose()?;
        let level = ground_height(&grid);
        let Some(field) = field else {
            let Some(surface) = terrain else {
                return Ok(None);
            };
            let sea = sea_of(&variables, header)?;
            let triangles = bare(&surface, sea.as_deref(), header, stretch, level);
            return Ok(Some(Self {
                triangles,
                terrain: Some(surface),
                legend: None,
            }));
        };
        let legend = field.legend(flags, field.range());
        let ends = legend
            .function
            .color
            .first()
            .zip(legend.function.color.last());
        if let (Some(word), Some((low, high))) = (&flags.ground, ends) {
            progress.note(&format!(
                "the ground is coloured by {word}, from {} to {}{}",
                short(low.value),
                short(high.value),
                in_unit(legend.unit.as_deref())
            ));
        }
        let columns = u64::from(field.grid.dims[0]) * u64::from(field.grid.dims[1]);
        let flat = Surface::new(&field.grid, vec![level; columns as usize]);
        let flat = flat.ok_or_else(|| no_ground("--ground", "no columns"))?;
        let colored = |place: DVec3| Some(color_of(&legend, field.at(flat.voxel(place))?));
        let triangles = match &terrain {
            None => flat.triangles(stretch, |place, _| colored(place)),
            Some(surface) => {
                let mut triangles = surface.triangles(stretch, |place, normal| {
                    let shade = 1.0 + SHADE_OF_FIELD * (colors::shade(normal) - 1.0);
                    Some(colored(place)?.map(|c| c * shade as f32))
                });
                add_walls(&mut triangles, surface, stretch, level);
                triangles
            }
        };
        Ok(Some(Self {
            triangles,
            terrain,
            legend: Some(legend),
        }))
    }

    /// The scene of a film, whose colours of the ground are those of all its times where nobody says their range.
    pub fn with_range_of_film(scene: &SceneFlags) -> Result<SceneFlags, Error> {
        let mut whole = scene.clone();
        let flags = &scene.ground;
        let Some(word) = flags
            .ground
            .as_ref()
            .filter(|_| flags.ground_range.is_none())
        else {
            return Ok(whole);
        };
        let input = &input_of_any(scene);
        let variables = Variables {
            input,
            limits: input.limits(),
        };
        let range = field::range_of_all_times(word, &variables)?;
        let field = field::read(word, &variables, Some(0.0))?;
        let points = field.legend(flags, range).function.color;
        let ends = points.first().zip(points.last());
        whole.ground.ground_range = ends.map(|(low, high)| Numbers([low.value, high.value]));
        Ok(whole)
    }
}

/// Of any variable of the file.
fn input_of_any(scene: &SceneFlags) -> InputFlags {
    InputFlags {
        variable: None,
        component: None,
        ..scene.input.clone()
    }
}

/// Metres: ground that rises by less is flat.
const RELIEF: f64 = 1.0;

/// True where the file has heights of the ground that can be drawn, and they are not all the same.
pub fn has_relief(header: &Header, variables: &Variables<'_>) -> bool {
    let is_drawn = check(header, "--map terrain", variables).is_ok();
    let heights = || ground_heights(variables, header).ok().flatten();
    let Some(heights) = is_drawn.then(heights).flatten() else {
        return false;
    };
    let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (high - low) * header.length_metres.unwrap_or(1.0) > RELIEF
}

fn check(header: &Header, word: &str, variables: &Variables<'_>) -> Result<(), Error> {
    if !is_upright(header) {
        return Err(no_ground(word, "a grid that is turned"));
    }
    let columns = u64::from(header.dims[0]) * u64::from(header.dims[1]);
    let wanted = columns.saturating_mul(BYTES_PER_COLUMN);
    match wanted > variables.limits.max_bytes {
        true => Err(Error::Memory(format!(
            "the ground of {columns} columns takes {wanted} bytes, and there are {}",
            variables.limits.max_bytes
        ))),
        false => Ok(()),
    }
}

fn no_ground(word: &str, found: &str) -> Error {
    Error::usage(
        format!(
            "{word}: the volume has no ground: wanted a grid whose third axis is upright, found {found}"
        ),
        format!("leave out {word}"),
    )
}

fn terrain(variables: &Variables<'_>, header: &Header, grid: &Grid) -> Result<Surface, Error> {
    let heights = ground_heights(variables, header)?;
    let surface = heights.and_then(|heights| Surface::new(grid, heights));
    surface.ok_or_else(|| {
        let found = match header.variables.as_slice() {
            [] => "none".to_owned(),
            names => names.join(", "),
        };
        Error::usage(
            format!(
                "--map terrain: no height of the ground in the input: wanted the standard name surface_altitude or \
                 orography, or HGT, orog, or PH and PHB, one number a column; found {found}"
            ),
            "leave out terrain",
        )
    })
}

/// Terrain in the colours of heights.
fn bare(
    surface: &Surface,
    sea: Option<&[f64]>,
    header: &Header,
    stretch: DVec3,
    level: f64,
) -> Triangles {
    let metres = header.length_metres.unwrap_or(1.0);
    let [nx, ny, _] = header.dims;
    let is_sea = |place: DVec3| {
        let [x, y] = surface.voxel(place);
        let column = |at: f64, n: u32| (at.max(0.0) as usize).min(n as usize - 1);
        Some(sea?.get(column(y, ny) * nx as usize + column(x, nx))? > &0.5)
    };
    let mut triangles = surface.triangles(stretch, |place, normal| {
        let color = colors::of_height(metres * place.z, is_sea(place));
        Some(color.map(|c| c * colors::shade(normal) as f32))
    });
    add_walls(&mut triangles, surface, stretch, level);
    triangles
}

fn add_walls(triangles: &mut Triangles, surface: &Surface, stretch: DVec3, level: f64) {
    let grey = crate::color::decode_srgb(colors::WALL as f32);
    let walls = surface.walls(stretch, level.min(surface.lowest()), [grey; 3]);
    triangles.append(&walls);
}

//! Built-in volumes: a formula behind a [`Source`], its voxels the field at their centers.
//!
//! ```text
//! phantom:NAME[,n=256][,type=u8|u16|f32]     all of them
//! phantom:sphere[,edge=LENGTH]               width of the soft edge; 0 for a hard one; default one voxel
//! phantom:fog[,profile=exponential|linear]
//! phantom:storm[,variable=NAME][,times=8]    hours 0 to 24, g/kg, K and m/s, on the Earth but nowhere on the globe
//! phantom:flow[,kind=helix|saddle|taylor-green|abc]      velocities whose lines are known, in m/s
//! phantom:cells                             three dyes of a microscope: nuclei, membranes, mitochondria
//! ```
//!
//! `n` is the number of voxels along x; voxels are cubes. World is RAS+ in millimetres (`marschner-lobb`:
//! the unit of its paper; `flow`: metres; `storm`: x east, y north, z up in kilometres).

mod cells;
mod flow;
mod head;
mod noise;
mod spec;
mod storm;

pub use spec::NAMES;

use super::field::{Ball, Field, Fog, Gaussian, MarschnerLobb, Shells};
use super::read::check_memory;
use super::{
    ComponentKind, Format, Header, Limits, Piece, Problem, ReadError, Rescale, Source,
    TimeComponent, VoxelBox, VoxelType, Voxels,
};
use glam::{DAffine3, DMat3, DVec3};
use spec::Spec;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The phantom that `spec` names, with or without `phantom:` in front.
///
/// # Errors
/// Where the name or a word is not known, and where one time of it would not fit `limits`.
pub fn open(spec: &str, limits: &Limits) -> Result<Box<dyn Source>, ReadError> {
    let failed = |problem| ReadError {
        path: spec.into(),
        problem,
    };
    let phantom = build(spec).map_err(failed)?;
    check_memory(&phantom.header, phantom.header.whole(), limits).map_err(failed)?;
    Ok(Box::new(phantom))
}

/// A field for each time, and where its voxels lie.
struct Phantom {
    spec: PathBuf,
    header: Header,
    field_at: FieldAt,
}

/// The field of one time and component.
type FieldAt = Box<dyn Fn(TimeComponent) -> Box<dyn Field> + Send + Sync>;

impl Source for Phantom {
    fn path(&self) -> &Path {
        &self.spec
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let field = (self.field_at)(pick);
        let Rescale { slope, intercept } = self.header.rescale;
        // A cast goes to the nearest end where a number does not fit.
        let code = |value: f64| ((value - intercept) / slope).round();
        let voxels = match self.header.stored {
            VoxelType::U8 => Voxels::U8(self.sample(&*field, region, |v| code(v) as u8)),
            VoxelType::U16 => Voxels::U16(self.sample(&*field, region, |v| code(v) as u16)),
            _ => Voxels::F32(self.sample(&*field, region, |v| v as f32)),
        };
        Ok(voxels.into())
    }
}

impl Phantom {
    /// Slices are shared out to threads one at a time; a voxel does not depend on who makes it.
    fn sample<T: Clone + Default + Send>(
        &self,
        field: &dyn Field,
        region: VoxelBox,
        stored: impl Fn(f64) -> T + Sync,
    ) -> Vec<T> {
        let [nx, ny, nz] = region.dims().map(|n| n as usize);
        let mut voxels = vec![T::default(); nx * ny * nz];
        let slices = Mutex::new((region.min[2]..).zip(voxels.chunks_exact_mut(nx * ny)));
        let next = || slices.lock().unwrap_or_else(PoisonError::into_inner).next();
        let work = || {
            while let Some((z, slice)) = next() {
                for (y, row) in (region.min[1]..).zip(slice.chunks_exact_mut(nx)) {
                    for (x, voxel) in (region.min[0]..).zip(row) {
                        let center = DVec3::new(x.into(), y.into(), z.into()) + 0.5;
                        let p = self.header.world_from_voxel.transform_point3(center);
                        *voxel = stored(field.value(p));
                    }
                }
            }
        };
        let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
        std::thread::scope(|scope| {
            for _ in 1..threads.min(nz) {
                scope.spawn(work);
            }
            work();
        });
        voxels
    }
}

/// What a phantom is before its voxels are counted.
struct Design {
    /// World.
    min: DVec3,
    max: DVec3,
    /// What integer codes span; f32 holds values as they are.
    value_range: [f64; 2],
    /// A code stands for a whole number of values.
    whole_slope: bool,
    default_type: VoxelType,
    hounsfield: bool,
    /// The world is that of a patient.
    is_patient: bool,
    /// Metres of a unit of the world.
    length_metres: Option<f64>,
}

impl Design {
    fn cube(half_side: f64) -> Self {
        Self {
            min: DVec3::splat(-half_side),
            max: DVec3::splat(half_side),
            value_range: [0.0, 1.0],
            whole_slope: false,
            default_type: VoxelType::F32,
            hounsfield: false,
            is_patient: false,
            length_metres: Some(1e-3),
        }
    }
}

fn build(text: &str) -> Result<Phantom, Problem> {
    let mut spec = Spec::parse(text)?;
    let n = spec.count("n", 1..=4096, 256)?;
    let mut known = vec!["n", "type"];
    let (mut times, mut variables) = (1, Vec::new());
    let mut storm = None;
    let mut design = Design::cube(50.0);
    let mut meaning = ComponentKind::Numbers;
    let field_at: FieldAt = match spec.name {
        "sphere" => {
            known.push("edge");
            let ball = Ball {
                center: DVec3::new(4.0, -6.0, 5.0),
                radius: 35.0,
                edge: spec.length("edge", 100.0 / f64::from(n))?,
            };
            Box::new(move |_| Box::new(ball))
        }
        "gauss" => {
            let blob = Gaussian {
                center: DVec3::new(6.0, -4.0, 3.0),
                deviation: 8.0,
            };
            Box::new(move |_| Box::new(blob))
        }
        "marschner-lobb" => {
            design = Design::cube(1.0);
            design.length_metres = None;
            Box::new(|_| Box::new(MarschnerLobb::default()))
        }
        "fog" => {
            known.push("profile");
            (design.min.z, design.max.z) = (0.0, 100.0);
            let fog = match spec.choice("profile", &["exponential", "linear"])? {
                0 => Fog::Exponential { height: 25.0 },
                _ => Fog::Linear { height: 100.0 },
            };
            Box::new(move |_| Box::new(fog))
        }
        "shells" => {
            let shells = Shells {
                center: DVec3::new(2.0, 3.0, -4.0),
                outermost_radius: 45.0,
                count: 5,
                thickness: 0.6,
            };
            Box::new(move |_| Box::new(shells))
        }
        "storm" => {
            known.extend(["variable", "times"]);
            times = spec.count("times", 1..=1000, 8)?;
            let variable = storm::VARIABLES
                [spec.choice("variable", &storm::VARIABLES.map(storm::Variable::name))?];
            variables.push(variable.name().to_string());
            let others = storm::VARIABLES
                .into_iter()
                .filter(|&other| other != variable);
            variables.extend(others.map(|other| other.name().to_string()));
            storm = Some(variable);
            (design.min, design.max) = (storm::MIN, storm::MAX);
            design.value_range = variable.value_range();
            design.length_metres = Some(1e3);
            Box::new(move |pick| Box::new(storm::Storm::new(variable, pick.time, times)))
        }
        "flow" => {
            known.push("kind");
            let kind = spec.choice("kind", &flow::KINDS)?;
            meaning = ComponentKind::Vector;
            design = Design {
                value_range: flow::RANGE,
                length_metres: Some(1.0),
                ..Design::cube(flow::HALF_SIDE)
            };
            Box::new(move |pick| Box::new(flow::Flow::new(kind, pick.component)))
        }
        "cells" => {
            meaning = ComponentKind::Channels(cells::channels());
            design.default_type = VoxelType::U8;
            Box::new(|pick| Box::new(cells::Cells::new(pick.component)))
        }
        _ => {
            design = Design {
                value_range: [-1024.0, 3056.0],
                whole_slope: true,
                default_type: VoxelType::U16,
                hounsfield: true,
                is_patient: true,
                ..Design::cube(head::HALF_SIDE)
            };
            Box::new(move |_| Box::new(head::Head::new(2.0 * head::HALF_SIDE / f64::from(n))))
        }
    };
    let stored = spec.voxel_type(design.default_type)?;
    spec.finish(&known)?;
    let spacing = (design.max.x - design.min.x) / f64::from(n);
    let size = design.max - design.min;
    let dims = size
        .to_array()
        .map(|side| ((side / spacing).round() as u32).max(1));
    let world_from_voxel = DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::splat(spacing)),
        translation: design.min,
    };
    let components = match &meaning {
        ComponentKind::Channels(channels) => channels.len() as u32,
        ComponentKind::Vector => 3,
        _ => 1,
    };
    let unit = match meaning {
        ComponentKind::Vector => Some(flow::UNIT.to_owned()),
        _ => storm.map(|variable| variable.unit().to_owned()),
    };
    let header = Header {
        components,
        meaning,
        times,
        rescale: rescale(&design, stored),
        hounsfield: design.hounsfield,
        is_patient: design.is_patient,
        length_metres: design.length_metres,
        is_earth: storm.is_some(),
        unit,
        standard_name: storm.and_then(|v| v.standard_name().map(str::to_owned)),
        long_name: storm.map(|variable| variable.long_name().to_owned()),
        time_names: storm.map_or(Vec::new(), |_| storm::time_names(times)),
        variables,
        ..Header::new(Format::Phantom, dims, stored, world_from_voxel)
    };
    Ok(Phantom {
        spec: text.into(),
        header,
        field_at,
    })
}

fn rescale(design: &Design, stored: VoxelType) -> Rescale {
    let largest = match stored {
        VoxelType::U8 => 255.0,
        VoxelType::U16 => 65535.0,
        _ => return Rescale::default(),
    };
    let [low, high] = design.value_range;
    let slope = (high - low) / largest;
    Rescale {
        slope: if design.whole_slope {
            slope.ceil()
        } else {
            slope
        },
        intercept: low,
    }
}

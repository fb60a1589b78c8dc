//! What to compute.

use super::paths::{paths, sv_path_tracing};
use super::status::{Failure, number};
use super::structure::{self, Versioned};
use super::words::{SCATTERINGS, TONES, word};
use crate::color::ColorSpace;
use crate::named::Named;
use crate::picture::Tone;
use crate::shaders::{MAX_CLIP_PLANES, MAX_LEVELS, MAX_LIGHTS};
use crate::technique::{
    ClipPlane, Filter, Intermediate, Jitter, Lattice, Level, Light, Mode, PerMode, Settings,
    Shading, Technique,
};
use glam::DVec3;
use std::ffi::c_void;

/// What is behind it is cut away: world points with `normal . x < offset`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_clip_plane {
    /// Of any length but 0.
    pub normal: [f64; 3],
    /// See above.
    pub offset: f64,
}

/// A surface of SV_MODE_ISO.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_isosurface {
    /// The value that the volume has there.
    pub value: f64,
    /// Its colour before light, in sRGB numbers from 0 to 1.
    pub srgb: [f64; 3],
    /// What it takes of the light from behind, 0 to 1.
    pub opacity: f64,
}

/// A light that is infinitely far away.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_light {
    /// The way to it in the world, of any length but 0.
    pub towards: [f64; 3],
    /// sRGB numbers from 0 to 1.
    pub srgb: [f64; 3],
}

/// What to compute. All zero: a composite by rays, one sample a voxel.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_settings {
    /// `sizeof(sv_settings)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// sv_technique.
    pub technique: u32,
    /// sv_mode.
    pub mode: u32,
    /// sv_filter.
    pub filter: u32,
    /// sv_lattice.
    pub lattice: u32,
    /// sv_color_space.
    pub color_space: u32,
    /// Not 0: composites count what lies between two samples too.
    pub is_preintegrated: u32,
    /// Not 0: samples that cannot matter are taken as well. The picture is the same, and slower.
    pub disable_space_skipping: u32,
    /// Not 0: MIP and MinIP of the trilinear field itself, not of samples.
    pub has_exact_maximum: u32,
    /// Samples a voxel along a ray. 0 is 1.
    pub samples_per_voxel: f64,
    /// Rays end where less than this part of the light behind comes through, 0 to 1. 0: never.
    pub termination: f64,
    /// The corner of the box to keep with the smallest voxel coordinates, which go from 0 to the number of voxels.
    pub crop_min: [f64; 3],
    /// The other corner. Both zero: all of the volume.
    pub crop_max: [f64; 3],
    /// Planes that cut.
    pub clip_planes: *const sv_clip_plane,
    /// How many there are.
    pub clip_plane_count: u64,
    /// Surfaces of SV_MODE_ISO.
    pub levels: *const sv_isosurface,
    /// How many there are.
    pub level_count: u64,
    /// Not 0: composites and surfaces are lit.
    pub is_lit: u32,
    /// Not 0: `lmip_threshold` counts. Else SV_MODE_LMIP is a MIP.
    pub has_lmip_threshold: u32,
    /// Part of the colour that needs no light. This and the next three all zero: 0.1, 0.7, 0.2 and 10.
    pub ambient: f64,
    /// Part of the colour of a surface across the light.
    pub diffuse: f64,
    /// White that a surface mirrors.
    pub specular: f64,
    /// How sharply it mirrors. 0 is 10.
    pub shininess: f64,
    /// Lights. None: a white one, carried by the eye.
    pub lights: *const sv_light,
    /// How many there are.
    pub light_count: u64,
    /// The values that count as 0 and as 1 in SV_MODE_MIDA and SV_MODE_ATTENUATED_MIP. Both zero: the volume's range.
    pub unit_values: [f64; 2],
    /// SV_MODE_LMIP: the first local maximum over it is shown.
    pub lmip_threshold: f64,
    /// SV_MODE_MIDA: from -1, a composite, to 1, a MIP.
    pub mida_gamma: f64,
    /// SV_MODE_ATTENUATED_MIP: how fast values fade. 0 is 16.
    pub attenuation: f64,
    /// Modes that show one place of a ray: how much darker they are at its far end, 0 to 1.
    pub depth_cue: f64,
    /// SV_LATTICE_JITTER: another pattern.
    pub jitter_seed: u32,
    /// SV_LATTICE_JITTER: the number of the picture in a film.
    pub jitter_frame: u32,
    /// SV_TECHNIQUE_SHEAR_WARP: rays a voxel along each side of the plane. 0 is 1; less than 0: as fine as the picture.
    pub rays_per_voxel: f64,
    /// SV_TECHNIQUE_PATHTRACE: what it traces, under `lights`; or NULL. Matter and lights of `scattering` too.
    pub paths: *const sv_path_tracing,
    /// sv_scattering, of composites by rays.
    pub scattering: u32,
    /// sv_tone: what the light of composites and surfaces goes through on its way into the target.
    pub tone: u32,
    /// It is multiplied by 2 to the power of this before, -126 to 126 stops.
    pub exposure: f64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_settings {
    const NAME: &'static str = "sv_settings";
}

/// More samples a voxel than this are of no use, and no driver's loops are so long.
const MOST_SAMPLES_PER_VOXEL: f64 = 1024.0;

/// Settings for a volume of this range; NULL is all zero.
///
/// # Safety
/// What `pointer` points to, and the arrays there, are as long as they say.
pub(super) unsafe fn settings(
    pointer: *const sv_settings,
    range: [f64; 2],
) -> Result<Settings, Failure> {
    // SAFETY: the caller's promise.
    let c = unsafe { structure::read_or_zero(pointer)? };
    // SAFETY: as above.
    let (planes, levels, lights) = unsafe {
        (
            structure::array(
                "sv_settings.clip_planes",
                c.clip_planes,
                c.clip_plane_count,
                MAX_CLIP_PLANES.into(),
            )?,
            structure::array(
                "sv_settings.levels",
                c.levels,
                c.level_count,
                MAX_LEVELS.into(),
            )?,
            structure::array(
                "sv_settings.lights",
                c.lights,
                c.light_count,
                MAX_LIGHTS.into(),
            )?,
        )
    };
    let lights = lights.iter().map(light).collect::<Result<Vec<_>, _>>()?;
    let or = |number: f64, default: f64| if number == 0.0 { default } else { number };
    let samples = or(c.samples_per_voxel, 1.0);
    let is_right = samples > 0.0 && samples <= MOST_SAMPLES_PER_VOXEL;
    let wanted = "over 0 and at most 1024";
    number("sv_settings.samples_per_voxel", wanted, samples, is_right)?;
    share("sv_settings.termination", c.termination)?;
    let made = Settings {
        technique: word("sv_settings.technique", Technique::ALL, c.technique)?,
        mode: word("sv_settings.mode", Mode::ALL, c.mode)?,
        filter: word("sv_settings.filter", Filter::ALL, c.filter)?,
        lattice: word("sv_settings.lattice", Lattice::ALL, c.lattice)?,
        color_space: word("sv_settings.color_space", ColorSpace::ALL, c.color_space)?,
        tone: Tone {
            exposure: c.exposure,
            curve: word("sv_settings.tone", &TONES, c.tone)?,
        },
        jitter: Jitter {
            seed: c.jitter_seed,
            frame: c.jitter_frame,
        },
        intermediate: match c.rays_per_voxel {
            as_pixels if as_pixels < 0.0 => Intermediate::Pixels,
            rays => Intermediate::PerVoxel(or(rays, 1.0)),
        },
        preintegrated: c.is_preintegrated != 0,
        skip: c.disable_space_skipping == 0,
        samples_per_voxel: samples,
        termination: c.termination as f32,
        crop: crop(&c)?,
        clip_planes: planes.iter().map(plane).collect::<Result<_, _>>()?,
        shading: match c.is_lit {
            0 => None,
            _ => Some(shading(&c, lights.clone())?),
        },
        single_scattering: word("sv_settings.scattering", &SCATTERINGS, c.scattering)?,
        // SAFETY: the caller's promise.
        path: unsafe { paths(c.paths, lights)? },
        per_mode: PerMode {
            unit_values: match c.unit_values == [0.0; 2] {
                true => range,
                false => c.unit_values,
            },
            lmip_threshold: match c.has_lmip_threshold {
                0 => f64::INFINITY,
                _ => c.lmip_threshold,
            },
            mida_gamma: c.mida_gamma,
            attenuation: or(c.attenuation, crate::technique::DEFAULT_ATTENUATION),
            depth_cue: c.depth_cue,
            exact_maximum: c.has_exact_maximum != 0,
            levels: levels.iter().map(level).collect::<Result<_, _>>()?,
        },
        ..Settings::default()
    };
    made.check()?;
    Ok(made)
}

pub(super) fn share(name: &str, found: f64) -> Result<(), Failure> {
    number(name, "0 to 1", found, (0.0..=1.0).contains(&found))
}

/// Three numbers, each of them finite.
pub(super) fn finite(name: &str, found: [f64; 3]) -> Result<DVec3, Failure> {
    let bad = found.iter().find(|number| !number.is_finite());
    match bad {
        None => Ok(DVec3::from_array(found)),
        Some(&bad) => Err(Failure::argument(format!(
            "{name}: wanted finite numbers, found {bad}"
        ))),
    }
}

fn direction(name: &str, found: [f64; 3]) -> Result<DVec3, Failure> {
    let found = finite(name, found)?;
    let length = found.length();
    // A longer one's square is infinite, a shorter one's 0.
    number(name, "a length over 0", length, length.is_normal())?;
    Ok(found)
}

fn plane(plane: &sv_clip_plane) -> Result<ClipPlane, Failure> {
    let name = "sv_clip_plane.offset";
    number(
        name,
        "a finite number",
        plane.offset,
        plane.offset.is_finite(),
    )?;
    Ok(ClipPlane {
        normal: direction("sv_clip_plane.normal", plane.normal)?,
        offset: plane.offset,
    })
}

fn level(level: &sv_isosurface) -> Result<Level, Failure> {
    level
        .srgb
        .iter()
        .try_for_each(|&channel| share("sv_isosurface.srgb", channel))?;
    Ok(Level {
        value: level.value,
        srgb: level.srgb,
        opacity: level.opacity,
    })
}

fn crop(c: &sv_settings) -> Result<Option<[DVec3; 2]>, Failure> {
    let min = finite("sv_settings.crop_min", c.crop_min)?;
    let max = finite("sv_settings.crop_max", c.crop_max)?;
    if (min, max) == (DVec3::ZERO, DVec3::ZERO) {
        return Ok(None);
    }
    for (low, high) in c.crop_min.into_iter().zip(c.crop_max) {
        let wanted = "more than crop_min on each axis";
        number("sv_settings.crop_max", wanted, high, low < high)?;
    }
    Ok(Some([min, max]))
}

fn light(light: &sv_light) -> Result<Light, Failure> {
    let mut channels = light.srgb.iter();
    channels.try_for_each(|&channel| share("sv_light.srgb", channel))?;
    let towards = direction("sv_light.towards", light.towards)?;
    Ok(Light::of_world(towards, light.srgb))
}

fn shading(c: &sv_settings, lights: Vec<Light>) -> Result<Shading, Failure> {
    let default = Shading::default();
    let parts = [c.ambient, c.diffuse, c.specular, c.shininess];
    let [ambient, diffuse, specular, shininess] = match parts == [0.0; 4] {
        true => [
            default.ambient,
            default.diffuse,
            default.specular,
            default.shininess,
        ],
        false => [c.ambient, c.diffuse, c.specular, c.shininess],
    };
    let shininess = match shininess == 0.0 {
        true => default.shininess,
        false => shininess,
    };
    let names = ["ambient", "diffuse", "specular", "shininess"];
    for (name, found) in names
        .into_iter()
        .zip([ambient, diffuse, specular, shininess])
    {
        let is_right = found >= 0.0 && found.is_finite();
        number(&format!("sv_settings.{name}"), "0 or more", found, is_right)?;
    }
    Ok(Shading {
        ambient,
        diffuse,
        specular,
        shininess,
        lights,
        ..default
    })
}

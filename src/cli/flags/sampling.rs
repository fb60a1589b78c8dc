//! Which samples are taken and what is done with them: flags to [`Settings`].

use super::{
    Error, Numbers,
    cuts::{ClipBox, CutFacesWord},
    empty_space::EmptySpaceWord,
    intermediate::IntermediateWord,
    positive,
    sampling_numbers::{clip_planes, crop_box, rays_per_side, samples_per_voxel},
    scattering::SINGLE,
    shadows::HALF_ANGLE,
};
use crate::{
    cli::technique_hints,
    picture::ColorSpace,
    points::FieldKernel,
    shaders::MAX_CLIP_PLANES,
    technique::{
        self, ClipPlane, DEFAULT_DIM, Filter, FilterBy, Jitter, Lattice, Mode, Order, Settings,
        Technique,
        splat::{Sheets, Splat},
    },
};
use clap::Args;
use serde::{Deserialize, Serialize};

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SamplingFlags {
    /// Rendering technique [default: raycast]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub technique: Option<Technique>,
    /// What is done with the samples of a ray [default: composite]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode: Option<Mode>,
    /// How a value between voxels is made [default: linear]; quadratic and cubic take more memory, and all but nearest
    /// and linear more time
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub filter: Option<Filter>,
    /// What interpolates between voxels: the device's sampler, or the shader, from voxels that it fetches and with weights
    /// in floats [default: auto]
    #[arg(long, value_name = "WAY")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub filter_by: Option<FilterBy>,
    /// Where samples are: ray, at equal steps; planes, on the planes of --technique slices-3d; bresenham, in the middle of
    /// each voxel of the axis that the ray runs along most [default: ray]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lattice: Option<Lattice>,
    /// Pre-integrated classification of what lies between two samples: no bands where the transfer function is steep
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub preintegrated: bool,
    /// Classify voxels and interpolate what they are made of, not their values; blurs, and loses what lies between
    #[arg(long, conflicts_with = "preintegrated")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub preclassified: bool,
    /// Classify interpolated values [default, unless the --tf file asks for --preintegrated]
    #[arg(long, conflicts_with_all = ["preintegrated", "preclassified"])]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub postclassified: bool,
    /// 2D stacks: slices interpolated between those of the volume, and a cross-fade from stack to stack
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub smooth: bool,
    /// Rays: steps begin elsewhere in each pixel, which turns bands into fine grain (blue noise); another number,
    /// another pattern
    #[arg(long, value_name = "SEED", num_args = 0..=1, default_missing_value = "0", require_equals = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jitter: Option<u32>,
    /// Base pixels of --technique shear-warp: voxels, one a voxel; pixels, as fine as the picture; or so many a voxel
    /// [default: voxels]
    #[arg(long, value_name = "voxels|pixels|F")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub intermediate: Option<IntermediateWord>,
    /// How slicers blend [default: back-to-front]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<Order>,
    /// Samples per smallest voxel spacing [default: 1; 2 in stills of composites under --look auto], or per radius of --field
    /// [default: 5]
    #[arg(long, value_name = "F", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples_per_voxel: Option<f64>,
    /// Rays in composite: one sample for all of a ray in a block of 8^3 voxels whose values look alike, so that no
    /// channel of the picture is farther than this from that of all samples, from 0 to 1: 0.01 is 2.6 of 255 codes in
    /// linear light
    #[arg(long, value_name = "ERROR", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adaptive_steps: Option<f64>,
    /// Rays in composite: what says where nothing is seen; the picture is the same [default: cells]
    #[arg(long, value_name = "WAY")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub empty_space: Option<EmptySpaceWord>,
    /// Rays per pixel, a square number [default: 1]
    #[arg(long, value_name = "N")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aa: Option<u32>,
    /// Send the rays of --aa through uneven places of the pixel, other ones in each pixel and each frame of a film:
    /// grain in place of regular patterns where detail is finer than pixels
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub aa_uneven: bool,
    /// Blend in linear light, or in sRGB numbers as VTK and Slicer do [default: linear]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color_space: Option<ColorSpace>,
    /// Keep this box of voxels; fractions are allowed
    #[arg(long, value_name = "X0,X1,Y0,Y1,Z0,Z1", allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crop: Option<Numbers<6>>,
    /// Keep the world points p with (NX,NY,NZ) . p >= D (repeatable, up to 512 planes)
    #[arg(long, value_name = "NX,NY,NZ,D", allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub clip: Vec<Numbers<4>>,
    /// Keep a box that may be turned: centre and size in world length, then degrees about the world's x, y and z, one
    /// after the other; it counts as six of --clip
    #[arg(
        long,
        value_name = "CX,CY,CZ,SX,SY,SZ[,RX,RY,RZ]",
        allow_hyphen_values = true
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip_box: Option<ClipBox>,
    /// Show what --crop, --clip and --clip-box lay bare as an opaque face in the picture's own colours, or in the greys
    /// of a window: what is over LO, as a scanner shows it
    #[arg(long, value_name = "LO,HI", num_args = 0..=1, default_missing_value = "own", require_equals = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut_faces: Option<CutFacesWord>,
    /// Splats: sheets that they are put together in [default: image]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheets: Option<Sheets>,
    /// Splats: standard deviation of the Gaussian that a voxel is, in voxels [default: 0.6], less shows the voxels, more
    /// blurs; of scattered points in world length [default: their column, or by the distances of neighbours]
    #[arg(long, value_name = "LENGTH", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub splat_std: Option<f64>,
    /// Splats: no splat is thinner than so many pixels, as they are at the centre of the box, or where a scattered point
    /// is; 0 never widens them [default: 0.6, of scattered points 0.75]
    #[arg(long, value_name = "PIXELS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub splat_low_pass: Option<f64>,
    /// The input is scattered points.
    #[arg(skip)]
    #[serde(skip)]
    pub of_points: bool,
    /// The input is scattered points, and rays are cast through this field of them.
    #[arg(skip)]
    #[serde(skip)]
    pub field: Option<FieldKernel>,
    /// As `stratavox conformance` draws: float targets, no early termination, filtering in the shader
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub conformance: bool,
}

/// How exactly the picture is kept: what early termination may leave out follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// An 8-bit PNG.
    Eight,
    /// 16-bit PNG, EXR, npy.
    More,
}

/// Early termination of an 8-bit picture in linear light: 0.4 of a code where sRGB is steepest.
const TERMINATION_LINEAR: f32 = 1.0 / 8192.0;
/// Early termination of an 8-bit picture in display space.
const TERMINATION_DISPLAY: f32 = 1.0 / 512.0;
/// Where splats of an 8-bit picture end: what is cut off of a constant is 0.12 %, and made up for.
const CUT_BITS_EIGHT: u32 = 8;
/// Which ways to sample go with which technique.
const WAYS: &str = "--preintegrated is for --mode composite, --smooth for that with --technique slices-2d, --jitter for \
                    --technique raycast, and --cut-faces, --adaptive-steps and --empty-space octree and runs for that with --mode \
                    composite";
/// What samples along main axes go with.
const MAIN_AXIS: &str = "--lattice bresenham is for --technique raycast and --mode composite, mip, minip, average and xray, \
                         without --preintegrated, --adaptive-steps and --cut-faces";
/// What shear-warp goes with.
const WARP: &str = "--technique shear-warp is for --mode composite, mip, minip, average and xray, without --lattice, --jitter, \
                    --aa-uneven, --adaptive-steps and --cut-faces";
/// What splats go with.
const SPLATS: &str = "--technique splat is for --mode composite, mip, minip, average and xray, with a kernel (--splat-std) and \
                      sheets (--sheets) of its own: leave out the other flag, or draw a volume by --technique raycast, points by \
                      --points-as field or grid";
/// What rays through points go with.
const FIELD: &str = "points are cast by rays, in --mode composite, mip, minip, average and xray; --points-as grid makes a volume of \
                     them";

/// What paths go with.
const PATHS: &str = "--technique pathtrace is for --mode composite of volumes of numbers, by --filter linear and nearest, with lights \
                     (--light, --environment) that need no --shading: leave out the other flag";

/// Whether settings have the ways to sample that are asked for.
pub fn check_ways(settings: &Settings) -> Result<(), Error> {
    let hint = match settings.lattice {
        _ if settings.field.is_some() => FIELD,
        _ if settings.is_half_angle() => HALF_ANGLE,
        _ if settings.technique.is_warped() => WARP,
        _ if settings.technique.splats() => SPLATS,
        _ if settings.technique.traces_paths() => PATHS,
        _ if settings.single_scattering.is_some() => SINGLE,
        Lattice::Bresenham => MAIN_AXIS,
        _ => WAYS,
    };
    settings.check_ways().map_err(|problem| {
        let hint = match problem {
            technique::Error::OutOfRange { .. } => technique_hints::hint(&problem),
            _ => hint,
        };
        Error::usage(problem.to_string(), hint)
    })
}

impl SamplingFlags {
    /// What to compute, for a picture kept so exactly.
    pub fn settings(&self, depth: Depth) -> Result<Settings, Error> {
        let color_space = self.color_space.unwrap_or_default();
        let termination = match (depth, color_space) {
            _ if self.conformance => 0.0,
            (Depth::More, _) => 0.0,
            (Depth::Eight, ColorSpace::Linear) => TERMINATION_LINEAR,
            (Depth::Eight, ColorSpace::Display) => TERMINATION_DISPLAY,
        };
        let settings = Settings {
            technique: self.technique.unwrap_or_default(),
            mode: self.mode.unwrap_or_default(),
            filter: self.filter.unwrap_or_default(),
            filter_by: self.filter_by.unwrap_or_default(),
            lattice: self.lattice()?,
            jitter: Jitter {
                seed: self.jitter.unwrap_or_default(),
                frame: 0,
            },
            intermediate: self.intermediate.unwrap_or_default().0,
            stack: None,
            smooth: self.smooth,
            preintegrated: self.preintegrated,
            order: self.order.unwrap_or_default(),
            samples_per_voxel: samples_per_voxel(self.samples_per_voxel.unwrap_or(1.0))?,
            adaptive_steps: self.adaptive_steps,
            rays_per_side: rays_per_side(self.aa.unwrap_or(1))?,
            uneven_rays: self.aa_uneven,
            termination,
            skip: self.empty_space.unwrap_or_default().skips(),
            empty_space: self.empty_space.unwrap_or_default().skip_by(),
            color_space,
            // Of a file's pixels: `PictureFlags::tone`.
            tone: Default::default(),
            crop: self.crop.map(crop_box).transpose()?,
            clip_planes: self.clip_planes()?,
            cut_faces: self.cut_faces.map(CutFacesWord::cut_faces),
            shading: None,
            gradient_filter: Default::default(),
            gradient_storage: Default::default(),
            dim: DEFAULT_DIM,
            splat: self.splat(depth),
            field: self.field,
            path: Default::default(),
            single_scattering: None,
            ambient_occlusion: None,
            conformance: self.conformance,
            // Of the values, which are not known yet.
            per_mode: Default::default(),
        };
        check_ways(&settings)?;
        let is_alone = settings.technique.splats() && settings.splat.sheets == Sheets::None;
        if is_alone && settings.mode == Mode::Composite && !self.preclassified {
            return Err(Error::usage(
                "--sheets none composites each voxel by itself, and values are classified sheet by sheet",
                "add --preclassified, or take --sheets image",
            ));
        }
        Ok(settings)
    }

    /// What splats are, in a picture kept so exactly.
    fn splat(&self, depth: Depth) -> Splat {
        let default = match self.of_points {
            true => Splat::of_points(),
            false => Splat::default(),
        };
        Splat {
            sheets: self.sheets.unwrap_or_default(),
            // Of points it is a world length, which the points themselves keep.
            std: self
                .splat_std
                .filter(|_| !self.of_points)
                .unwrap_or(default.std),
            low_pass: self.splat_low_pass.unwrap_or(default.low_pass),
            cut_bits: match depth {
                Depth::Eight if !self.conformance => CUT_BITS_EIGHT,
                _ => default.cut_bits,
            },
            of_points: self.of_points,
        }
    }

    /// Those of `--clip`, then those of `--clip-box`.
    pub fn clip_planes(&self) -> Result<Vec<ClipPlane>, Error> {
        let of_box = self.clip_box.as_ref().map(ClipBox::planes);
        let of_box = of_box.transpose()?.into_iter().flatten();
        let planes: Vec<_> = clip_planes(&self.clip)?.into_iter().chain(of_box).collect();
        if planes.len() > MAX_CLIP_PLANES as usize {
            return Err(Error::TooMany {
                message: format!(
                    "--clip-box takes six clip planes and --clip {}: at most {MAX_CLIP_PLANES} are possible",
                    self.clip.len()
                ),
                hint: "leave planes out; --crop cuts along the axes of the grid",
            });
        }
        Ok(planes)
    }

    /// True where samples lie at steps that --samples-per-voxel sets: not on the slices of plain 2D stacks.
    pub fn has_steps(&self) -> bool {
        let technique = self.technique.unwrap_or_default();
        self.smooth || !(technique.draws_stacks() || technique.traces_paths())
    }

    /// True where a word says what is classified.
    pub fn says_how(&self) -> bool {
        self.preintegrated || self.preclassified || self.postclassified
    }

    /// Takes out what `stronger` excludes.
    pub fn give_way_to(&mut self, stronger: &Self) {
        if stronger.says_how() {
            (self.preintegrated, self.preclassified) = (false, false);
            self.postclassified = false;
        }
    }

    fn lattice(&self) -> Result<Lattice, Error> {
        match (self.jitter, self.lattice) {
            (Some(_), Some(Lattice::Planes)) => Err(Error::usage(
                "--jitter --lattice planes: planes begin at the same place for all rays",
                "--jitter alone moves the steps of --lattice ray",
            )),
            (Some(_), Some(Lattice::Bresenham)) => Err(Error::usage(
                "--jitter --lattice bresenham: its samples lie at heights of the grid, whatever the pixel",
                "--jitter alone moves the steps of --lattice ray",
            )),
            (Some(_), _) => Ok(Lattice::Jitter),
            (None, word) => Ok(word.unwrap_or_default()),
        }
    }

    /// Flags that change nothing under the others, a sentence each.
    pub fn idle(&self) -> Vec<&'static str> {
        let mut notes = Vec::new();
        if self.aa_uneven && self.aa.unwrap_or(1) == 1 {
            notes.push("--aa-uneven has no effect on one ray a pixel: --aa 4");
        }
        let technique = self.technique.unwrap_or_default();
        if self.order.is_some() && technique.casts_rays() {
            notes.push("--order has no effect on rays, they go front to back");
        }
        if self.intermediate.is_some() && !technique.is_warped() {
            notes.push("--intermediate has no effect without --technique shear-warp");
        }
        let is_of_splats =
            self.sheets.is_some() || self.splat_std.is_some() || self.splat_low_pass.is_some();
        if is_of_splats && !technique.splats() {
            notes.push("--sheets, --splat-std and --splat-low-pass have no effect without --technique splat");
        }
        if self.sheets.is_some() && matches!(self.mode, Some(Mode::Average | Mode::Xray)) {
            notes.push("--sheets has no effect on --mode average and xray, which add all splats");
        }
        let is_cut = self.crop.is_some() || self.clip_box.is_some() || !self.clip.is_empty();
        if self.cut_faces.is_some() && !is_cut {
            notes.push("--cut-faces has no effect without --crop, --clip or --clip-box");
        }
        if self.lattice == Some(Lattice::Ray) && !technique.casts_rays() {
            notes.push("--lattice ray has no effect on slices, they have a lattice of their own");
        }
        if self.samples_per_voxel.is_some() && technique.draws_stacks() && !self.smooth {
            notes.push(
                "--samples-per-voxel has no effect on 2D stacks, they have one sample a slice",
            );
        }
        notes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn flags(change: impl FnOnce(&mut SamplingFlags)) -> SamplingFlags {
        let mut flags = SamplingFlags::default();
        change(&mut flags);
        flags
    }

    #[track_caller]
    fn refusal(flags: &SamplingFlags) -> String {
        flags
            .settings(Depth::Eight)
            .expect_err("refused")
            .to_string()
    }

    #[test]
    fn rays_end_early_only_as_far_as_the_picture_can_show() {
        let linear = flags(|_| {});
        let display = flags(|f| f.color_space = Some(ColorSpace::Display));
        let conformance = flags(|f| f.conformance = true);
        for (flags, depth, wanted) in [
            (&linear, Depth::Eight, 2_f32.powi(-13)),
            (&display, Depth::Eight, 2_f32.powi(-9)),
            (&conformance, Depth::Eight, 0.0),
            (&linear, Depth::More, 0.0),
            (&display, Depth::More, 0.0),
        ] {
            let found = flags.settings(depth).expect("settings").termination;
            assert_eq!(found, wanted, "{flags:?} {depth:?}");
        }
    }

    #[test]
    fn rays_per_pixel_are_a_square_number() {
        for (rays, wanted) in [(1, 1), (4, 2), (9, 3), (4096, 64)] {
            let found = flags(|f| f.aa = Some(rays)).settings(Depth::Eight);
            assert_eq!(found.expect("settings").rays_per_side, wanted);
        }
        for rays in [0, 2, 8, 4225] {
            let text = refusal(&flags(|f| f.aa = Some(rays)));
            assert!(text.contains("square number"), "{text}");
        }
    }

    #[test]
    fn a_crop_is_in_the_order_of_its_words() {
        let crop = "1,2,3,4.5,-5,6".parse().expect("six numbers");
        let found = flags(|f| f.crop = Some(crop)).settings(Depth::Eight);
        assert_eq!(
            found.expect("settings").crop,
            Some([DVec3::new(1.0, 3.0, -5.0), DVec3::new(2.0, 4.5, 6.0)])
        );
        let crop = "2,1,0,1,0,1".parse().expect("six numbers");
        let text = refusal(&flags(|f| f.crop = Some(crop)));
        assert!(text.contains("--crop 2,1,0,1,0,1"), "{text}");
    }

    #[test]
    fn a_clip_plane_needs_a_direction_and_there_are_only_so_many() {
        let text = refusal(&flags(|f| f.clip = vec![Numbers([0.0, 0.0, 0.0, 3.0])]));
        assert!(text.contains("--clip 0,0,0,3"), "{text}");
        let many = vec![Numbers([1.0, 0.0, 0.0, 3.0]); MAX_CLIP_PLANES as usize + 1];
        let error = flags(|f| f.clip = many).settings(Depth::Eight);
        let error = error.expect_err("refused");
        assert!(error.to_string().contains("at most 512"), "{error}");
        assert_eq!(error.exit_code(), 6, "a limit");
    }

    #[test]
    fn a_flag_without_effect_is_mentioned() {
        let idle = flags(|f| f.order = Some(Order::FrontToBack)).idle();
        assert_eq!(idle.len(), 1, "{idle:?}");
        assert!(flags(|_| {}).idle().is_empty());
    }
}

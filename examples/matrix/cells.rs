//! Every cell of the matrix: technique x mode x filter x feature, as a scene that says itself whether it can be.

use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::check_geometry;
use stratavox::picture::ColorSpace;
use stratavox::points::{FieldKernel, Points, Quantity};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::splat::Splat;
use stratavox::technique::{
    AmbientOcclusion, ClipPlane, CutFaces, Error, Filter, GradientFilter, GradientStorage, Lattice,
    Level, Light, Mode, Order, PerMode, Role, Settings, Shading, Shadows, SingleScattering,
    Technique,
};
use stratavox::transfer::{
    ColorPoint, GradientTransfer, Interpolation, OpacityPoint, Shape, TransferFunction, Widget,
};
use stratavox::volume::{Denoise, Rescale, Volume, Voxels, labels::dim};

/// Where samples lie.
pub const TECHNIQUES: [(Technique, &str); 5] = [
    (Technique::Raycast, "raycast"),
    (Technique::Slices3d, "slices-3d"),
    (Technique::Slices2d, "slices-2d"),
    (Technique::ShearWarp, "shear-warp"),
    (Technique::Splat, "splat"),
];

/// What is done with them.
pub const MODES: [(Mode, &str); 9] = [
    (Mode::Composite, "composite"),
    (Mode::Mip, "mip"),
    (Mode::Minip, "minip"),
    (Mode::Average, "average"),
    (Mode::Xray, "xray"),
    (Mode::Lmip, "lmip"),
    (Mode::AttenuatedMip, "attenuated-mip"),
    (Mode::Mida, "mida"),
    (Mode::Iso, "iso"),
];

/// How values between voxels are made.
pub const FILTERS: [(Filter, &str); 7] = [
    (Filter::Nearest, "nearest"),
    (Filter::Linear, "linear"),
    (Filter::Quadratic, "quadratic"),
    (Filter::Cubic, "cubic"),
    (Filter::QuadraticSmooth, "quadratic-smooth"),
    (Filter::CubicSmooth, "cubic-smooth"),
    (Filter::CatmullRom, "catmull-rom"),
];

/// What is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// One volume of numbers.
    Alone,
    /// One whose function is over value and gradient.
    GradientFunction,
    /// One with voxels that are no data.
    Holed,
    /// One that rises everywhere, so that its gradient has a direction everywhere.
    Bowl,
    /// One that is to lie in several textures.
    Bricked,
    /// One out of which a noise filter has taken what it could.
    Denoised,
    /// Two volumes, each with a function.
    Channels,
    /// Two, of which one lies on a grid of its own.
    OwnGrids,
    /// One under a label map.
    Labelled,
    /// Three volumes that are one colour.
    Colored,
    /// One that another makes opaque.
    Veiled,
    /// One whose voxels are classified already.
    Classified,
    /// Scattered points in place of a volume.
    Points,
    /// One volume and a tube through it.
    Tube,
}

/// Something that can be asked for beside technique, mode and filter.
pub struct Feature {
    /// What it is.
    pub name: &'static str,
    /// How the command line asks for it.
    pub words: &'static str,
    /// What is seen.
    pub seen: Seen,
    dress: fn(&mut Settings),
}

const fn feature(
    name: &'static str,
    words: &'static str,
    seen: Seen,
    dress: fn(&mut Settings),
) -> Feature {
    Feature {
        name,
        words,
        seen,
        dress,
    }
}

/// Features by name, the first of them nothing at all.
pub const FEATURES: &[Feature] = &[
    feature("one volume", "", Seen::Alone, |_| {}),
    feature(
        "crop and clip planes",
        "`--crop`, `--clip`",
        Seen::Alone,
        |s| {
            s.crop = Some([dvec3(1.3, 0.6, 1.0), dvec3(9.7, 11.0, 8.2)]);
            let normal = dvec3(0.6, -0.64, 0.48);
            let offset = normal.dot(center()) - 3.0;
            s.clip_planes = vec![ClipPlane { normal, offset }];
        },
    ),
    feature("cut faces", "`--cut-faces`", Seen::Alone, |s| {
        s.crop = Some([dvec3(0.0, 1.6, 0.0), dvec3(9.2, 12.0, 7.3)]);
        s.cut_faces = Some(CutFaces::Own);
    }),
    feature(
        "front to back",
        "`--order front-to-back`",
        Seen::Alone,
        |s| {
            s.order = Order::FrontToBack;
        },
    ),
    feature(
        "planes of a slicer",
        "`--lattice planes`",
        Seen::Alone,
        |s| {
            s.lattice = Lattice::Planes;
        },
    ),
    feature(
        "main axes of rays",
        "`--lattice bresenham`",
        Seen::Alone,
        |s| {
            s.lattice = Lattice::Bresenham;
        },
    ),
    feature("jitter", "`--jitter`", Seen::Alone, |s| {
        s.lattice = Lattice::Jitter;
    }),
    feature(
        "several rays a pixel",
        "`--aa 4`, `--aa-uneven`",
        Seen::Alone,
        |s| {
            s.rays_per_side = 2;
            s.uneven_rays = true;
        },
    ),
    feature("interpolated slices", "`--smooth`", Seen::Alone, |s| {
        s.smooth = true;
    }),
    feature("pre-integration", "`--preintegrated`", Seen::Alone, |s| {
        s.preintegrated = true;
    }),
    feature("depth cue", "`--depth-cue`", Seen::Alone, |s| {
        s.per_mode.depth_cue = 0.7;
    }),
    feature("exact extreme", "`--exact-maximum`", Seen::Alone, |s| {
        s.per_mode.exact_maximum = true;
    }),
    feature("light", "`--shading phong`", Seen::Alone, |s| {
        s.shading = Some(lights());
    }),
    feature(
        "light, pre-integration",
        "`--preintegrated --shading phong`",
        Seen::Alone,
        |s| {
            s.preintegrated = true;
            s.shading = Some(lights());
        },
    ),
    feature(
        "ambient occlusion",
        "`--ambient-occlusion`",
        Seen::Alone,
        |s| {
            s.ambient_occlusion = Some(AmbientOcclusion {
                strength: 0.9,
                radius_world: None,
            });
        },
    ),
    feature("shadows", "`--shadows volume`", Seen::Alone, |s| {
        let light_size_degrees = 6.0;
        s.shading = Some(Shading {
            shadows: Shadows::Volume { light_size_degrees },
            ..lights()
        });
    }),
    feature(
        "light and the shadows of half-angle slices",
        "`--shading phong --shadows half-angle`",
        Seen::Alone,
        |s| {
            let mut lit = lights();
            lit.lights.truncate(1);
            lit.shadows = Shadows::HalfAngle;
            s.shading = Some(lit);
        },
    ),
    feature(
        "light that is scattered once",
        "`--scattering single`",
        Seen::Alone,
        |s| {
            s.single_scattering = Some(SingleScattering::Volume);
            s.path.lights = lights().lights;
            s.path.light_size_degrees = 6.0;
        },
    ),
    feature(
        "value and gradient",
        "`widgets`, `gradient_opacity`, `--preset boundaries`",
        Seen::GradientFunction,
        |_| {},
    ),
    feature(
        "gradients by Sobel",
        "`--gradient-filter sobel`",
        Seen::Alone,
        |s| {
            s.shading = Some(lights());
            s.gradient_filter = GradientFilter::Sobel;
        },
    ),
    feature(
        "gradients of a spline",
        "`--gradient-filter cubic`",
        Seen::Alone,
        |s| {
            s.shading = Some(lights());
            s.gradient_filter = GradientFilter::Cubic;
        },
    ),
    feature(
        "gradients of the filter",
        "`--gradient-filter analytic`",
        Seen::Alone,
        |s| {
            s.shading = Some(lights());
            s.gradient_filter = GradientFilter::Analytic;
        },
    ),
    feature(
        "kept gradients",
        "`--gradients kept --gradient-filter sobel`",
        Seen::Bowl,
        |s| {
            s.shading = Some(Shading {
                specular: 0.0,
                ..lights()
            });
            s.gradient_filter = GradientFilter::Sobel;
            s.gradient_storage = GradientStorage::Precomputed;
        },
    ),
    feature("a volume in several bricks", "", Seen::Bricked, |s| {
        // Surfaces in bricks want short segments: half a voxel for wide filters.
        if s.mode == Mode::Iso {
            s.samples_per_voxel = 2.5;
        }
    }),
    feature(
        "lines, spheres and surfaces in it",
        "`--flow`, `--map`, `--barbs`, `--ground`, `--with surface.stl`",
        Seen::Tube,
        |_| {},
    ),
    feature("noise filters", "`--denoise`", Seen::Denoised, |_| {}),
    feature("voxels without data", "", Seen::Holed, |_| {}),
    feature(
        "light, voxels without data",
        "`--shading phong`",
        Seen::Holed,
        |s| {
            s.shading = Some(lights());
        },
    ),
    feature("several channels", "`--channel`", Seen::Channels, |_| {}),
    feature(
        "volumes on grids of their own",
        "`--with`",
        Seen::OwnGrids,
        |_| {},
    ),
    feature(
        "labels over it, one of them dimmed",
        "`--labels`, `--label-dim`",
        Seen::Labelled,
        |_| {},
    ),
    feature("colours", "a file of colours", Seen::Colored, |_| {}),
    feature(
        "scattered points",
        "`--points-as splats`",
        Seen::Points,
        |s| s.splat = Splat::of_points(),
    ),
    feature(
        "scattered points, clip planes",
        "`--points-as splats`, `--clip`",
        Seen::Points,
        |s| {
            s.splat = Splat::of_points();
            let normal = dvec3(0.6, -0.64, 0.48);
            let offset = normal.dot(center()) - 1.0;
            s.clip_planes = vec![ClipPlane { normal, offset }];
        },
    ),
    feature(
        "scattered points, cast by rays",
        "`--points-as field`",
        Seen::Points,
        |s| s.field = Some(field(Quantity::Mean)),
    ),
    feature(
        "density of scattered points, cast by rays, clip planes",
        "`--field kernel,density`, `--clip`",
        Seen::Points,
        |s| {
            s.field = Some(field(Quantity::Density));
            let normal = dvec3(0.6, -0.64, 0.48);
            let offset = normal.dot(center()) - 1.0;
            s.clip_planes = vec![ClipPlane { normal, offset }];
        },
    ),
    feature(
        "opacity by another",
        "`--opacity-variable`, `--opacity-from`",
        Seen::Veiled,
        |_| {},
    ),
    feature(
        "pre-classification",
        "`--preclassified`",
        Seen::Classified,
        |_| {},
    ),
    feature(
        "light, several channels",
        "`--channel`, `--shading phong`",
        Seen::Channels,
        |s| {
            s.shading = Some(lights());
        },
    ),
    feature(
        "light, volumes on grids of their own",
        "`--with`, `--shading phong`",
        Seen::OwnGrids,
        |s| {
            s.shading = Some(lights());
        },
    ),
    feature(
        "light, labels over it",
        "`--labels`, `--shading phong`",
        Seen::Labelled,
        |s| {
            s.shading = Some(lights());
        },
    ),
    feature(
        "light, colours",
        "a file of colours, `--shading phong`",
        Seen::Colored,
        |s| {
            s.shading = Some(lights());
        },
    ),
    feature(
        "light, opacity by another",
        "`--opacity-from`, `--shading phong`",
        Seen::Veiled,
        |s| {
            s.shading = Some(lights());
        },
    ),
    feature(
        "light, pre-classification",
        "`--preclassified`, `--shading phong`",
        Seen::Classified,
        |s| {
            s.shading = Some(lights());
        },
    ),
    feature(
        "occlusion and shadows, several channels",
        "`--channel`, `--ambient-occlusion`, `--shadows volume`",
        Seen::Channels,
        hindered,
    ),
    feature(
        "occlusion and shadows, volumes on grids of their own",
        "`--with`, `--ambient-occlusion`, `--shadows volume`",
        Seen::OwnGrids,
        hindered,
    ),
    feature(
        "occlusion and shadows, labels over it",
        "`--labels`, `--ambient-occlusion`, `--shadows volume`",
        Seen::Labelled,
        hindered,
    ),
    feature(
        "occlusion and shadows, colours",
        "a file of colours, `--ambient-occlusion`, `--shadows volume`",
        Seen::Colored,
        hindered,
    ),
    feature(
        "occlusion and shadows, opacity by another",
        "`--opacity-from`, `--ambient-occlusion`, `--shadows volume`",
        Seen::Veiled,
        hindered,
    ),
    feature(
        "occlusion and shadows, pre-classification",
        "`--preclassified`, `--ambient-occlusion`, `--shadows volume`",
        Seen::Classified,
        hindered,
    ),
];

/// Matter takes light away, from all around and of lamps.
fn hindered(s: &mut Settings) {
    s.ambient_occlusion = Some(AmbientOcclusion {
        strength: 0.9,
        radius_world: None,
    });
    s.shading = Some(Shading {
        shadows: Shadows::Volume {
            light_size_degrees: 6.0,
        },
        ..lights()
    });
}

fn lights() -> Shading {
    let light = |towards, srgb| Light::of_world(towards, srgb);
    Shading {
        ambient: 0.2,
        diffuse: 0.5,
        specular: 0.4,
        shininess: 9.0,
        lights: vec![
            light(dvec3(1.0, -2.0, 0.7), [1.0, 0.9, 0.8]),
            light(dvec3(-0.3, 0.2, 3.0), [0.2, 0.3, 0.6]),
        ],
        ..Shading::default()
    }
}

/// The settings of a cell.
pub fn settings(technique: Technique, mode: Mode, filter: Filter, feature: &Feature) -> Settings {
    let level = |value, srgb, opacity| Level {
        value,
        srgb,
        opacity,
    };
    let mut settings = Settings {
        technique,
        mode,
        filter,
        per_mode: PerMode {
            lmip_threshold: 0.6,
            levels: vec![
                level(0.4, [0.9, 0.3, 0.2], 0.5),
                level(0.65, [0.2, 0.5, 0.9], 1.0),
            ],
            ..PerMode::default()
        },
        ..Settings::default()
    };
    (feature.dress)(&mut settings);
    settings
}

const DIMS: [u32; 3] = [11, 12, 9];

/// A grid that is neither along the axes of the world nor rectangular.
fn world_from_voxel() -> DAffine3 {
    let m = DMat3::from_cols(
        dvec3(1.1, 0.2, -0.1),
        dvec3(-0.3, 0.9, 0.2),
        dvec3(0.1, 0.3, 1.6),
    );
    DAffine3::from_mat3_translation(m, dvec3(25.0, -8.0, 100.0))
}

fn center() -> DVec3 {
    world_from_voxel().transform_point3(0.5 * DVec3::from_array(DIMS.map(f64::from)))
}

/// The volumes and functions that cells show.
pub struct Matter {
    numbers: Volume,
    holed: Volume,
    bowl: Volume,
    denoised: Volume,
    others: [Volume; 2],
    elsewhere: Volume,
    classified: [Volume; 4],
    points: Points,
    /// Where they are, and which values they have.
    binned: Volume,
    labels: Volume,
    function: TransferFunction,
    gradient_transfer: TransferFunction,
    label_function: TransferFunction,
    cameras: [Camera; 2],
}

/// Picks one of the values around a voxel: CPU reference and device agree to the bit.
pub const DENOISE: Denoise = Denoise::Median;

impl Matter {
    /// Small volumes that change along every axis; `denoised` applies [`DENOISE`].
    pub fn new(denoised: impl FnOnce(&Volume) -> Volume) -> Self {
        let wave = |a: f64, b: f64| {
            move |p: DVec3| {
                0.5 + 0.25 * (a * p.x - 0.3 * p.z).sin() + 0.2 * (b * p.y + 0.4 * p.z).cos()
            }
        };
        let numbers = volume(wave(0.8, 0.7));
        let count = DIMS.iter().product::<u32>();
        let mut holed = volume(wave(0.8, 0.7));
        holed.validity = Some((0..count).map(|i| u8::from(i % 97 != 7)).collect());
        let labels = |p: DVec3| ((p.x / 4.0).floor() + (p.y / 5.0).floor()) % 4.0;
        let mut map = volume(labels);
        dim(&mut map, |label| label == 2);
        let length = numbers.grid().smallest_spacing();
        let classified = preclassified(&numbers, &function(), length, ColorSpace::default());
        let span = DVec3::from_array(DIMS.map(f64::from)).length();
        let points = points(wave(0.8, 0.7));
        let bowl = |p: DVec3| {
            let square = (p - dvec3(9.0, -16.0, 12.0)).length_squared();
            0.1 + 0.8 * (square - 280.0) / 700.0
        };
        let camera = Camera {
            eye: center() + span * dvec3(0.9, -1.3, 0.6),
            target: center(),
            up: dvec3(0.1, 0.0, 1.0),
            projection: Projection::Perspective { fov_degrees: 36.0 },
            zoom: 1.0,
        };
        let parallel = Camera {
            projection: Projection::Orthographic {
                view_height: 1.1 * span,
            },
            ..camera
        };
        Self {
            bowl: volume(bowl),
            denoised: denoised(&numbers),
            numbers,
            holed,
            classified: classified.expect("volumes of the right length"),
            elsewhere: volume_elsewhere(),
            binned: points.binned(),
            points,
            others: [volume(wave(0.5, 1.1)), volume(wave(1.2, 0.4))],
            labels: map,
            function: function(),
            gradient_transfer: TransferFunction {
                medium: None,
                gradient_transfer: Some(GradientTransfer {
                    steepest: Some(0.4),
                    share: Vec::new(),
                    widgets: vec![Widget {
                        srgb: None,
                        opacity: 0.5,
                        second: None,
                        shape: Shape::Contour {
                            value: 0.55,
                            half_width: 1.5,
                        },
                    }],
                }),
                ..function()
            },
            label_function: label_function(),
            cameras: [camera, parallel],
        }
    }

    /// Whether a scene can be drawn.
    ///
    /// # Errors
    /// Its own, and that of the geometry in it.
    pub fn check(scene: &Scene, seen: Seen) -> Result<(), Error> {
        scene.check()?;
        match seen {
            Seen::Tube => check_geometry(scene.settings),
            _ => Ok(()),
        }
    }

    /// The channels that stand beside the first volume where `seen` has such.
    pub fn channels(&self, seen: Seen) -> Vec<Channel<'_>> {
        let channel = |volume, transfer, role| Channel {
            volume,
            transfer: Some(transfer),
            role,
        };
        match seen {
            Seen::Channels => vec![channel(&self.others[0], &self.function, Role::Numbers)],
            Seen::OwnGrids => vec![channel(&self.elsewhere, &self.function, Role::Numbers)],
            Seen::Veiled => vec![channel(&self.others[0], &self.function, Role::Opacity)],
            Seen::Labelled => vec![channel(&self.labels, &self.label_function, Role::Labels)],
            _ => Vec::new(),
        }
    }

    /// The scene of the `nth` cell, in perspective or orthographic; `channels` and `parts` are those of
    /// [`Self::channels`] and [`Self::parts`].
    pub fn scene<'a>(
        &'a self,
        nth: usize,
        seen: Seen,
        settings: &'a Settings,
        channels: &'a [Channel<'a>],
        parts: &'a [&'a Volume],
    ) -> Scene<'a> {
        let beside = match seen {
            Seen::Channels | Seen::OwnGrids | Seen::Labelled | Seen::Veiled => {
                Beside::Channels(channels)
            }
            Seen::Colored => Beside::Colors(parts),
            Seen::Classified => Beside::Classified(parts),
            Seen::Alone
            | Seen::Bricked
            | Seen::GradientFunction
            | Seen::Holed
            | Seen::Bowl
            | Seen::Tube
            | Seen::Denoised => Beside::Nothing,
            Seen::Points => Beside::Points(&self.points),
        };
        Scene {
            volume: match seen {
                Seen::Holed => &self.holed,
                Seen::Bowl => &self.bowl,
                Seen::Denoised => &self.denoised,
                Seen::Classified => &self.classified[0],
                Seen::Points => &self.binned,
                _ => &self.numbers,
            },
            transfer: Some(match seen {
                Seen::GradientFunction => &self.gradient_transfer,
                _ => &self.function,
            }),
            beside,
            camera: &self.cameras[nth % 2],
            extent_pixels: [22, 19],
            settings,
        }
    }

    /// The volumes that are one colour with the first.
    pub fn parts(&self, seen: Seen) -> Vec<&Volume> {
        match seen {
            Seen::Colored => self.others.iter().collect(),
            Seen::Classified => self.classified[1..].iter().collect(),
            _ => Vec::new(),
        }
    }
}

/// Reaches the nearest neighbours.
fn field(quantity: Quantity) -> FieldKernel {
    FieldKernel {
        radius: 5.0,
        quantity,
    }
}

/// One in each third voxel along each axis, from a third of a pixel to two voxels wide.
fn points(field: impl Fn(DVec3) -> f64) -> Points {
    let [nx, ny, nz] = DIMS.map(|n| n.div_ceil(3));
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let at: Vec<_> = all
        .map(|p| 3.0 * DVec3::from_array(p.map(f64::from)) + 1.0)
        .collect();
    let places = at.iter().map(|&p| world_from_voxel().transform_point3(p));
    let values = at.iter().map(|&p| field(p) as f32);
    let stds = (0..at.len()).map(|i| 0.3 + 1.7 * ((i * 37 % 101) as f32 / 100.0));
    Points::new(
        places.collect(),
        values.collect(),
        Some(stds.collect()),
        None,
    )
    .expect("lists of one length")
}

fn volume(field: impl Fn(DVec3) -> f64) -> Volume {
    let [nx, ny, nz] = DIMS;
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let value = |p: [u32; 3]| field(DVec3::from_array(p.map(f64::from)) + 0.5) as f32;
    let voxels = Voxels::F32(all.map(value).collect());
    Volume::from_voxels(DIMS, world_from_voxel(), voxels, Rescale::default(), None)
        .expect("a volume of the right length")
}

/// Turned against the grid of the others, with finer voxels, in most of their box.
fn volume_elsewhere() -> Volume {
    let m = DMat3::from_rotation_z(0.3) * DMat3::from_diagonal(dvec3(0.8, 0.7, 1.2));
    let dims = [13, 14, 10];
    let half = m * (0.5 * DVec3::from_array(dims.map(f64::from)));
    let count = dims.iter().product::<u32>();
    let values = (0..count).map(|i| 0.2 + 0.6 * ((i * 37 % 101) as f32 / 100.0));
    let affine = DAffine3::from_mat3_translation(m, center() - half);
    let voxels = Voxels::F32(values.collect());
    Volume::from_voxels(dims, affine, voxels, Rescale::default(), None)
        .expect("a volume of the right length")
}

fn function() -> TransferFunction {
    let color = |value, srgb| ColorPoint { value, srgb };
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    TransferFunction {
        color: vec![color(0.1, [0.1, 0.2, 0.9]), color(0.9, [1.0, 0.5, 0.1])],
        opacity: vec![opacity(0.3, 0.02), opacity(0.8, 0.35)],
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// Label 0 hides nothing and shows nothing, label 1 is hidden by opacity 0.
fn label_function() -> TransferFunction {
    let value = |i: usize| i as f64 - 0.5;
    let colors = [[0.0; 3], [1.0, 0.1, 0.1], [0.1, 1.0, 0.2], [0.2, 0.3, 1.0]];
    let opacities = [0.0, 0.0, 0.1, 0.3];
    TransferFunction {
        color: (0..)
            .zip(colors)
            .map(|(i, srgb)| ColorPoint {
                value: value(i),
                srgb,
            })
            .collect(),
        opacity: (0..)
            .zip(opacities)
            .map(|(i, opacity)| OpacityPoint {
                value: value(i),
                opacity,
            })
            .collect(),
        reference_length: None,
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    }
}

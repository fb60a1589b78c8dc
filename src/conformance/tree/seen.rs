//! Pictures of voxels that no line goes through, each ray followed a second time in f64 by `oracle::seen`: A11, A14 and
//! A15, A17 to A19, the modes along rays, mixtures, cuts.

use super::drawn::{measure, measure_within};
use super::ground::{self, MODES, PLACEMENTS, PROJECTIONS, Placement, RAYS};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::oracle::{
    Chord, FILTERS, Numbers, Open, Part, PictureCase, Seen, seen, seen_through,
};
use crate::conformance::test_bed::TestBed;
use crate::named::Named;
use crate::picture::LayerKind;
use crate::scene::{Beside, Channel};
use crate::technique::{
    AmbientOcclusion, ClipPlane, Filter, Lattice, Light, LightSpace, Mode, Order, Role, Settings,
    Shading, Shadows,
};
use crate::transfer::{GradientTransfer, OpacityPoint, TransferFunction, Widget};
use crate::volume::VoxelType;
use glam::{DVec3, dvec3};

/// Half a unit in the last place of an f32 at 1.
const U: f64 = 1.0 / (1u32 << 24) as f64;

/// How steep `saddles` are along each axis.
const SADDLES: DVec3 = dvec3(0.9, 0.8, 0.7);

const EXTREME: &str = "u = 2^-24. A maximum is as continuous as what it is of: the field, off by its slopes (0.3 times 0.9, 0.8 and \
0.7 a voxel at most) times the blur of the place, and by 8 taps x 3 u of 1.25. Where the derivative along a cell is zero is found to 64 u \
of its terms. Over a cell these are at most, with s1 = 2.4, s2 = 1.91 and s3 = 0.504 the sums and the product of these steepnesses, \
0.3 (s1 + 2 s2 + 3 s3) where the ray enters, 0.3 (2 s2 + 6 s3) that is linear on the way and 0.3 x 3 s3 that is quadratic: less than 5 \
together, which costs 320 u of the value. Three times that for the pixel: opacity rises by 5/6 and colour by 1.2 a unit of value.";

/// What is in the voxels, and what is made of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    /// A field that varies along every axis.
    Waves,
    /// The signal of Marschner and Lobb (1994), over 40 voxels from -1 to 1 along each axis, as far as the grid goes.
    MarschnerLobb,
    /// Light from the eye.
    Lit,
    /// Three lights.
    Lamps,
    /// Three lights that move with the camera, on gradients of which small ones are no surface.
    SteadyLamps,
    /// An emitter over value and gradient.
    Widget(usize),
    /// Three lights, each as far as matter lets it through.
    Shadows,
    /// Three lights that have a size, and less from all around where matter is near.
    SoftShadows,
    /// Less light where matter is near.
    Occluded,
    /// Three clip planes.
    Clipped,
    /// Two things in one place.
    Channels,
    /// The same, one of them on a grid of its own.
    OwnGrid,
    /// Colour by one, opacity by the other.
    Opacity,
    /// Names of things beside numbers.
    Labels,
    /// The extreme of the trilinear field.
    Exact,
}

/// Where matter takes light away. It is one extinction all over: what comes through is known.
const DIMMED: [Look; 3] = [Look::Shadows, Look::SoftShadows, Look::Occluded];

/// By what it is known in names.
const WIDGETS: [&str; 5] = ["contour", "triangle", "rectangle", "gaussian", "region"];

impl Look {
    fn word(self) -> &'static str {
        match self {
            Self::Waves => "waves",
            Self::MarschnerLobb => "marschner_lobb",
            Self::Lit => "headlight",
            Self::Lamps => "lamps",
            Self::SteadyLamps => "steady_lamps",
            Self::Shadows => "shadows",
            Self::SoftShadows => "soft_shadows",
            Self::Occluded => "occluded",
            Self::Widget(i) => WIDGETS[i],
            Self::Clipped => "clipped",
            Self::Channels => "channels",
            Self::OwnGrid => "own_grid",
            Self::Opacity => "opacity_beside",
            Self::Labels => "labels",
            Self::Exact => "exact",
        }
    }
}

/// All of them.
pub fn cases() -> Vec<Case> {
    let mut all = Vec::new();
    let linear = FILTERS[1];
    for placement in PLACEMENTS {
        for mode in MODES {
            for filter in FILTERS {
                all.push((placement, mode, Look::Waves, filter));
            }
            all.push((placement, mode, Look::Clipped, linear));
        }
        let composite = MODES[0];
        // By kernels of more weights, light may be off by so much that bounds say nothing: `reference` has it.
        for look in [Look::Lit, Look::Lamps] {
            all.push((placement, composite, look, linear));
        }
        all.extend((0..WIDGETS.len()).map(|i| (placement, composite, Look::Widget(i), linear)));
        for look in
            DIMMED
                .into_iter()
                .chain([Look::Channels, Look::OwnGrid, Look::Opacity, Look::Labels])
        {
            all.push((placement, composite, look, linear));
        }
        for filter in [FILTERS[2], FILTERS[3], FILTERS[4], linear] {
            for mode in [MODES[1], MODES[4]] {
                all.push((placement, mode, Look::MarschnerLobb, filter));
            }
        }
    }
    for mode in [MODES[1], MODES[2]] {
        all.push((RAYS, mode, Look::Exact, linear));
    }
    all.push((RAYS, MODES[0], Look::SteadyLamps, linear));
    let by_rays = |mode: &&Mode| mode.needs_rays() && **mode != Mode::Iso;
    for &mode in Mode::ALL.iter().filter(by_rays) {
        all.extend(FILTERS.map(|filter| (RAYS, mode, Look::Waves, filter)));
        if mode == Mode::Mida {
            all.push((RAYS, mode, Look::Lamps, linear));
        }
    }
    let mut cases = Vec::new();
    for (placement, mode, look, (filter_word, filter)) in all {
        let mode_word = ground::word_of(mode);
        let Some(of) = placement.word_in(mode) else {
            continue;
        };
        if is_hidden(placement, mode, look, filter) {
            continue;
        }
        for (projection, is_perspective) in PROJECTIONS {
            let name = format!(
                "{of}.{mode_word}.{}.{filter_word}.f32.{projection}",
                look.word()
            );
            let mut case = Case::new(name, move |bed| {
                draw(bed, placement, mode, look, filter, is_perspective)
            });
            case.needs = ground::needs(placement, mode, VoxelType::F32, false);
            case.profile = profile(placement, mode, look, filter, is_perspective);
            cases.push(case);
        }
    }
    cases
}

/// Where a tenth of the pixels is not known: errors add up in what is left before a slice, the more the steeper a look.
fn is_hidden(placement: Placement, mode: Mode, look: Look, filter: Filter) -> bool {
    let is_under = placement.order == Order::FrontToBack;
    let is_steep = matches!(look.word(), "contour" | "gaussian");
    let is_coarse = filter == Filter::CatmullRom;
    // A stack has no places between its slices.
    let is_of_stack = placement.technique.draws_stacks() && look == Look::OwnGrid;
    is_of_stack
        || ground::hides_maxima(placement, mode, filter)
        || is_under && (is_steep || is_coarse)
}

/// Where rays through the whole grid may be off by so much that a pass would prove little: these looks are asked of a part
/// of it that rays are in for less long. What a single sample is off by shows as much there, and less is allowed.
fn is_thin(placement: Placement, look: Look) -> bool {
    let is_under = placement.order == Order::FrontToBack;
    let is_of_lamps = matches!(
        look,
        Look::Lamps | Look::SteadyLamps | Look::Shadows | Look::SoftShadows
    );
    is_of_lamps || look == Look::Lit && is_under
}

/// The baseline has each look in each technique, and the filters where something depends on them.
fn profile(
    placement: Placement,
    mode: Mode,
    look: Look,
    filter: Filter,
    is_perspective: bool,
) -> Profile {
    let is_first = placement.order == Order::BackToFront && placement.lattice == Lattice::Ray;
    let is_linear = filter == Filter::Linear;
    let is_in = match look {
        // One shader for all kernels, which takes SwiftShader ten seconds.
        Look::Waves if mode == Mode::Mida => {
            is_linear || (is_perspective && filter == Filter::CubicSmooth)
        }
        Look::Waves if mode.needs_rays() => is_linear || is_perspective,
        Look::Waves => is_perspective && (is_linear || (is_first && filter == Filter::CubicSmooth)),
        Look::MarschnerLobb => is_perspective && is_first && mode == Mode::Xray,
        Look::Clipped => is_perspective && matches!(mode, Mode::Composite | Mode::Xray),
        Look::Exact => true,
        Look::Lit | Look::Lamps => is_linear,
        _ => is_first && is_perspective != placement.technique.draws_stacks(),
    };
    [Profile::Full, Profile::Baseline][usize::from(is_in)]
}

fn draw(
    bed: &mut TestBed,
    placement: Placement,
    mode: Mode,
    look: Look,
    filter: Filter,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let shot = ground::shot(placement, mode, (filter, false), is_perspective);
    let shot = shot.with(|settings| {
        let whole = settings.crop;
        set(settings, look);
        if is_thin(placement, look) {
            settings.crop = settings.crop.or(whole).map(ground::thin);
        }
    });
    let parts = parts(&shot, look);
    let bordered = (look == Look::OwnGrid).then(|| parts[1].numbers.bordered());
    let beside: Vec<Channel> = parts[1..]
        .iter()
        .map(|part| Channel {
            volume: bordered.as_ref().unwrap_or(&part.numbers.volume),
            transfer: Some(&part.function),
            role: part.role,
        })
        .collect();
    let mut scene = shot.scene(&parts[0].numbers.volume, Some(&parts[0].function));
    if !beside.is_empty() {
        scene.beside = Beside::Channels(&beside);
    }
    let is_by_rays = placement.technique.casts_rays();
    let layers: &[LayerKind] = match (mode.is_projection(), is_by_rays && mode.has_depth()) {
        // Its colour shows it.
        (true, _) if mode == Mode::Average => &[],
        (true, true) => &[LayerKind::Value, LayerKind::Depth],
        (true, false) => &[LayerKind::Value],
        (false, true) => &[LayerKind::Depth],
        (false, false) => &[],
    };
    if look == Look::Exact {
        let of = |chord: &Chord| {
            // What the value rises by at most, times the blur, 8 taps, and both sides of a root.
            let off = 0.3 * SADDLES.dot(chord.blur_voxels) + (24.0 * 1.25 + 320.0) * U;
            Seen {
                slack: 3.0 * off,
                ..seen(&shot, chord, &parts)
            }
        };
        let bound = Bound::new("f32-extreme", EXTREME);
        return measure_within(bed, &shot, &scene, &[LayerKind::Value], bound, of);
    }
    let function = &parts[0].function;
    let open = DIMMED.contains(&look).then(|| {
        let per_length = function.reference_length.expect("one all over has one");
        Open::new(&shot, -(-function.opacity[0].opacity).ln_1p() / per_length)
    });
    measure(bed, &shot, &scene, layers, |chord| {
        seen_through(&shot, chord, &parts, open.as_ref())
    })
}

fn set(settings: &mut Settings, look: Look) {
    let [low, high] = settings.crop.expect("the ground has one");
    settings.crop = None;
    settings.per_mode.lmip_threshold = 0.6;
    settings.per_mode.unit_values = [0.1, 0.9];
    settings.per_mode.attenuation = 4.0;
    settings.per_mode.mida_gamma = -0.25;
    settings.per_mode.exact_maximum = look == Look::Exact;
    let light = |towards, srgb| Light {
        space: match look {
            Look::SteadyLamps => LightSpace::Camera,
            _ => LightSpace::World,
        },
        ..Light::of_world(towards, srgb)
    };
    let shadows = |light_size_degrees| Shadows::Volume { light_size_degrees };
    match look {
        Look::Lit => settings.shading = Some(Shading::default()),
        Look::Lamps | Look::SteadyLamps | Look::Shadows | Look::SoftShadows => {
            settings.shading = Some(Shading {
                ambient: 0.2,
                diffuse: 0.5,
                specular: 0.4,
                shininess: 23.0,
                half_gradient: if look == Look::SteadyLamps { 0.1 } else { 0.0 },
                lights: vec![
                    light(dvec3(1.0, -2.0, 0.7), [1.0, 0.9, 0.8]),
                    light(dvec3(-0.3, 0.2, 3.0), [0.2, 0.3, 0.6]),
                    light(DVec3::NEG_X, [0.3; 3]),
                ],
                shadows: match look {
                    Look::Shadows => shadows(0.0),
                    Look::SoftShadows => shadows(9.0),
                    _ => Shadows::Off,
                },
                ..Shading::default()
            });
        }
        Look::Clipped => {
            let middle = ground::grid().center();
            settings.clip_planes = [
                (dvec3(1.0, 0.4, -0.3), 4.1),
                (dvec3(-0.5, 1.0, 0.6), 5.7),
                (dvec3(-0.2, -0.8, 1.0), 6.3),
            ]
            .map(|(normal, back)| ClipPlane {
                normal: normal.normalize(),
                offset: normal.normalize().dot(middle) - back,
            })
            .into();
        }
        // No tap lies outside.
        Look::MarschnerLobb => settings.crop = Some([low, high]),
        _ => {}
    }
    if DIMMED.contains(&look) {
        // Along faces of cells: those inside are whole.
        settings.crop = Some([low.ceil(), high.floor()]);
    }
    if matches!(look, Look::Occluded | Look::SoftShadows) {
        settings.ambient_occlusion = Some(AmbientOcclusion {
            strength: 0.9,
            radius_world: Some(4.3),
        });
    }
}

fn parts(shot: &PictureCase, look: Look) -> Vec<Part> {
    // A sample is never clear: what is divided by extinction has digits.
    let mut function = ground::ramps();
    function.opacity[0].opacity = 0.03;
    let part = |function: TransferFunction, role, field: &dyn Fn(DVec3) -> f64| Part {
        numbers: Numbers::of(shot, field),
        function,
        role,
    };
    let mut tinted = ground::ramps();
    tinted.color.reverse();
    for (point, value) in tinted.color.iter_mut().zip([0.0, 0.4, 1.0]) {
        point.value = value;
    }
    tinted.opacity[0].opacity = 0.05;
    let other = |p: DVec3| ground::waves(dvec3(9.0 - p.y, p.z + 2.0, 0.7 * p.x));
    let beside = |role, field: &dyn Fn(DVec3) -> f64| {
        let first = part(function.clone(), Role::Numbers, &ground::waves);
        vec![first, part(tinted.clone(), role, field)]
    };
    match look {
        Look::Channels | Look::OwnGrid => beside(Role::Numbers, &other),
        Look::Opacity => beside(Role::Opacity, &other),
        Look::Exact => vec![part(function.clone(), Role::Numbers, &saddles)],
        Look::Labels => beside(Role::Labels, &|p| {
            (0.2 * p.dot(DVec3::ONE)).floor() % 3.0 / 2.0
        }),
        Look::MarschnerLobb => vec![part(
            function.clone(),
            Role::Numbers,
            &ground::marschner_lobb,
        )],
        _ if DIMMED.contains(&look) => {
            function.opacity = vec![OpacityPoint {
                value: 0.0,
                opacity: 0.2,
            }];
            function.reference_length = Some(1.0);
            vec![part(function, Role::Numbers, &ground::waves)]
        }
        Look::Widget(i) => {
            let widget = Widget {
                srgb: (i % 2 == 0).then_some([0.9, 0.6, 0.3]),
                opacity: 0.7,
                second: None,
                shape: ground::widget_shape(WIDGETS[i]),
            };
            let gradient_transfer = GradientTransfer {
                steepest: Some(0.3),
                share: Vec::new(),
                widgets: vec![widget],
            };
            let function = TransferFunction {
                medium: None,
                gradient_transfer: Some(gradient_transfer),
                ..function.clone()
            };
            vec![part(function, Role::Numbers, &ground::waves)]
        }
        _ => vec![part(function.clone(), Role::Numbers, &ground::waves)],
    }
}

/// A field that bends inside of cells, and not at their walls alone: between 0.2 and 0.8.
fn saddles(p: DVec3) -> f64 {
    let [x, y, z] = (SADDLES * p).to_array();
    0.5 + 0.3 * x.sin() * y.sin() * z.sin()
}

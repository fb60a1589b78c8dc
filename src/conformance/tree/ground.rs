//! What cases of pictures stand on: a grid that is neither axis-aligned nor orthogonal nor isotropic, an eye that looks
//! along no axis, and the words of placements, projections, filters, types and modes.

use crate::camera::{Camera, Projection};
use crate::conformance::oracle::PictureCase;
use crate::gpu::Item;
use crate::named::Named;
use crate::technique::{Filter, FilterBy, Lattice, Mode, Order, Settings, Technique};
use crate::transfer::{ColorPoint, Interpolation, OpacityPoint, Shape, TransferFunction};
use crate::volume::{Grid, VoxelType};
use ash::vk;
use glam::{DAffine3, DMat3, DVec3, dvec3};

/// Sheared, of unequal spacing, far from the origin.
pub fn grid() -> Grid {
    let m = DMat3::from_cols(
        dvec3(1.1, 0.2, -0.1),
        dvec3(-0.3, 0.9, 0.2),
        dvec3(0.1, 0.3, 1.6),
    );
    Grid {
        dims: [17, 21, 13],
        world_from_voxel: DAffine3::from_mat3_translation(m, dvec3(250.0, -80.0, 1000.0)),
    }
}

/// Where samples lie and in which order they are blended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the types say it")]
pub struct Placement {
    /// The word of names.
    pub word: &'static str,
    pub technique: Technique,
    pub lattice: Lattice,
    pub order: Order,
}

const fn placement(
    word: &'static str,
    technique: Technique,
    lattice: Lattice,
    order: Order,
) -> Placement {
    Placement {
        word,
        technique,
        lattice,
        order,
    }
}

/// All of them. Modes that project have no order.
pub const PLACEMENTS: [Placement; 7] = [
    placement(
        "raycast.ray",
        Technique::Raycast,
        Lattice::Ray,
        Order::BackToFront,
    ),
    placement(
        "raycast.planes",
        Technique::Raycast,
        Lattice::Planes,
        Order::BackToFront,
    ),
    placement(
        "raycast.bresenham",
        Technique::Raycast,
        Lattice::Bresenham,
        Order::BackToFront,
    ),
    placement(
        "slices_3d.over",
        Technique::Slices3d,
        Lattice::Ray,
        Order::BackToFront,
    ),
    placement(
        "slices_3d.under",
        Technique::Slices3d,
        Lattice::Ray,
        Order::FrontToBack,
    ),
    placement(
        "slices_2d.over",
        Technique::Slices2d,
        Lattice::Ray,
        Order::BackToFront,
    ),
    placement(
        "slices_2d.under",
        Technique::Slices2d,
        Lattice::Ray,
        Order::FrontToBack,
    ),
];

/// Rays through a base plane: pixels have no rays of their own, and no closed form of one.
pub const SHEAR_WARP: Placement = placement(
    "shear_warp",
    Technique::ShearWarp,
    Lattice::Ray,
    Order::BackToFront,
);

/// Collisions at random places, and no lattice.
pub const PATHS: Placement = placement(
    "pathtrace",
    Technique::Pathtrace,
    Lattice::Ray,
    Order::BackToFront,
);

/// All whose samples lie on a lattice.
pub fn all_placements() -> impl Iterator<Item = Placement> {
    PLACEMENTS.into_iter().chain([SHEAR_WARP])
}

/// One ray a pixel, at equal steps from where it enters the volume.
pub const RAYS: Placement = PLACEMENTS[0];

/// The modes that every placement has.
pub const MODES: [Mode; 5] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
];

/// Types that voxels are kept in.
pub const TYPES: [(&str, VoxelType); 6] = [
    ("u8", VoxelType::U8),
    ("i8", VoxelType::I8),
    ("u16", VoxelType::U16),
    ("i16", VoxelType::I16),
    ("f16", VoxelType::F16),
    ("f32", VoxelType::F32),
];

/// A filter, and whether the device's sampler does it.
pub const FILTERS: [(&str, Filter, bool); 7] = [
    ("nearest", Filter::Nearest, false),
    ("linear_fetch", Filter::Linear, false),
    ("linear", Filter::Linear, true),
    ("quadratic_smooth", Filter::QuadraticSmooth, false),
    ("cubic_smooth", Filter::CubicSmooth, false),
    ("catmull_rom", Filter::CatmullRom, false),
    ("cubic_smooth_sampler", Filter::CubicSmooth, true),
];

/// How rays spread.
pub const PROJECTIONS: [(&str, bool); 2] = [("orthographic", false), ("perspective", true)];

impl Placement {
    /// True where slabs end on samples of a pixel's own ray.
    pub fn has_slabs(&self) -> bool {
        self.lattice != Lattice::Bresenham && self.technique != Technique::ShearWarp
    }

    /// True where the rasterizer blends.
    pub fn is_slicer(&self) -> bool {
        !self.technique.casts_rays()
    }

    /// True where samples lie at heights of the grid.
    fn is_on_heights(&self) -> bool {
        self.lattice == Lattice::Bresenham || self.technique.is_warped()
    }

    /// True where what is seen of a part of the grid does not depend on how much there is of it: samples of rays begin
    /// where the domain does, and its middle is where a base plane lies.
    pub fn is_fixed(&self) -> bool {
        self.is_slicer() || self.lattice != Lattice::Ray
    }

    /// True where modes are drawn in which a sample depends on those before it.
    pub fn has_rays(&self) -> bool {
        self.technique.has_depth() && self.lattice == Lattice::Ray
    }

    /// The first part of names: modes that project have no order.
    pub fn word_in(&self, mode: Mode) -> Option<&'static str> {
        match (mode.is_projection(), self.word) {
            (false, word) => Some(word),
            (true, "slices_3d.over") => Some("slices_3d"),
            (true, "slices_2d.over") => Some("slices_2d"),
            (true, "slices_3d.under" | "slices_2d.under") => None,
            (true, word) => Some(word),
        }
    }
}

/// A mode in the names of cases.
pub fn word_of(mode: Mode) -> String {
    mode.name().replace('-', "_")
}

/// A camera that looks along no axis at the centre of a grid, close enough to fill the picture.
pub fn oblique_camera(grid: &Grid, projection: Projection) -> Camera {
    let center = grid.center();
    let size = (grid.world_from_voxel.matrix3 * grid.far_corner()).length();
    Camera {
        eye: center + size * dvec3(0.9, -1.3, 0.6),
        target: center,
        up: dvec3(0.1, 0.0, 1.0),
        projection,
        zoom: 1.0,
    }
}

/// One picture.
pub fn shot(
    placement: Placement,
    mode: Mode,
    (filter, by_sampler): (Filter, bool),
    is_perspective: bool,
) -> PictureCase {
    let grid = grid();
    let far = grid.far_corner();
    let size = (grid.world_from_voxel.matrix3 * far).length();
    let projection = match is_perspective {
        true => Projection::Perspective { fov_degrees: 26.0 },
        false => Projection::Orthographic {
            view_height: 0.7 * size,
        },
    };
    // One a voxel would lie where filters go from voxel to voxel, and rounding would say by which of them it is made.
    let samples_per_voxel = match placement.is_on_heights() {
        true => 2.0,
        false => 1.0,
    };
    // No tap of any filter lies outside the grid, and no plane of a stack at an end.
    let margin = 2.125;
    PictureCase {
        grid,
        camera: oblique_camera(&grid, projection),
        extent: [32, 28],
        settings: Settings {
            technique: placement.technique,
            lattice: placement.lattice,
            order: placement.order,
            mode,
            samples_per_voxel,
            filter,
            filter_by: match by_sampler {
                true => FilterBy::Sampler,
                false => FilterBy::Fetch,
            },
            conformance: !by_sampler,
            color_space: crate::conformance::oracle::Classes::SPACE,
            crop: Some([DVec3::splat(margin), far - margin]),
            ..Settings::default()
        },
    }
}

/// Whether what weights may be off by hides which of two samples of a ray is the larger: those of Catmull and Rom, and those
/// of all kernels where samples lie near each other.
pub fn hides_maxima(placement: Placement, mode: Mode, filter: Filter) -> bool {
    let is_by_samples = matches!(mode, Mode::Mip | Mode::Minip) && !placement.is_slicer();
    let is_near = placement.is_on_heights();
    is_by_samples && (filter == Filter::CatmullRom || is_near && filter.kernel().is_some())
}

/// Whether more pixels depend on rounding than a case may leave out: of a composite by kernels, each of the four rays that a
/// pixel of a warp depends on.
pub fn is_unsure(placement: Placement, mode: Mode, filter: Filter) -> bool {
    placement.technique.is_warped() && mode == Mode::Composite && filter.kernel().is_some()
}

/// What a picture asks of a device beyond what all need. Every device blends 16-bit floats, in which slices are
/// composited where it does not blend those of 32 bits.
pub fn needs(placement: Placement, mode: Mode, stored: VoxelType, by_sampler: bool) -> Vec<Item> {
    let mut needs = Vec::new();
    if placement.is_slicer() && mode != Mode::Composite {
        needs.push(blended_floats());
    }
    if by_sampler {
        let format = match stored {
            VoxelType::F16 => vk::Format::R16_SFLOAT,
            VoxelType::F32 => vk::Format::R32_SFLOAT,
            VoxelType::U8 | VoxelType::I8 => vk::Format::R8_UNORM,
            _ => vk::Format::R16_UNORM,
        };
        let linear = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
        needs.push(Item::Format(
            format,
            vk::FormatFeatureFlags::SAMPLED_IMAGE | linear,
        ));
    }
    needs
}

/// Slices blended in 32-bit floats.
pub fn blended_floats() -> Item {
    let blend =
        vk::FormatFeatureFlags::COLOR_ATTACHMENT | vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
    Item::Format(vk::Format::R32G32B32A32_SFLOAT, blend)
}

/// A field that varies along every axis, between about 0 and 1.
pub fn waves(p: DVec3) -> f64 {
    0.5 + 0.2 * (0.61 * p.x).sin()
        + 0.15 * (0.53 * p.y + 0.4).cos()
        + 0.15 * (0.37 * p.z - p.x * 0.2).sin()
}

/// The signal of Marschner and Lobb:
/// rho(x, y, z) = (1 - sin(pi z / 2) + a (1 + cos(2 pi f cos(pi r / 2)))) / (2 (1 + a)), f = 6, a = 1/4.
pub fn marschner_lobb(p: DVec3) -> f64 {
    use std::f64::consts::PI;
    let [x, y, z] = ((p - dvec3(8.5, 10.5, 6.5)) / 20.0).to_array();
    let wave = (12.0 * PI * (0.5 * PI * x.hypot(y)).cos()).cos();
    (1.0 - (0.5 * PI * z).sin() + 0.25 * (1.0 + wave)) / 2.5
}

/// Colours and opacities with ramps between 0 and 1.
pub fn ramps() -> TransferFunction {
    let color = |value, srgb| ColorPoint { value, srgb };
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    TransferFunction {
        color: vec![
            color(0.0, [0.1, 0.2, 0.9]),
            color(0.5, [0.2, 0.8, 0.3]),
            color(1.0, [1.0, 0.5, 0.1]),
        ],
        opacity: vec![opacity(0.2, 0.0), opacity(0.6, 0.15), opacity(0.9, 0.4)],
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// The shape of the widget of that name.
pub fn widget_shape(word: &str) -> Shape {
    let point = |value, opacity| OpacityPoint { value, opacity };
    match word {
        "contour" => Shape::Contour {
            value: 0.6,
            half_width: 1.5,
        },
        "triangle" => Shape::Triangle {
            value: 0.5,
            half_width: 0.3,
            threshold: 0.1,
            top: 1.2,
        },
        "rectangle" => Shape::Rectangle {
            values: [0.4, 0.7],
            gradients: [0.2, 0.6],
        },
        "gaussian" => Shape::Gaussian {
            value: 0.5,
            gradient: 0.4,
            sigma_value: 0.2,
            sigma_gradient: 0.3,
        },
        _ => Shape::Region {
            points: vec![point(0.1, 0.1), point(0.5, 0.8), point(0.95, 0.3)],
        },
    }
}

/// Four cells along y, the axis that the eye looks along most: whole ones.
pub fn thin([low, high]: [DVec3; 2]) -> [DVec3; 2] {
    let [from, to] = [8.0, 12.0];
    [dvec3(low.x, from, low.z), dvec3(high.x, to, high.z)]
}

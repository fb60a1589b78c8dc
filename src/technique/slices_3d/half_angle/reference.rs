//! Half-angle slicing on the CPU: CPU reference of `shaders/slices_3d_half.wgsl`, `shaders/lib/light_buffer.wgsl` and
//! `shadowed.wgsl`.

use crate::ray::{domain_interval, pixel_ray, plane_length, plane_t, voxel_ray};
use crate::real::{Real, add, dot, scale, sub};
use crate::shaders::Frame;
use crate::technique::blend::Fragment;

/// The picture that the light has of the slices before the next one.
#[derive(Clone, Debug)]
pub struct LightBuffer<R> {
    /// Texels across and down.
    pub extent: [u32; 2],
    /// What each texel's ray has lost, rows from the top.
    pub taken: Vec<R>,
}

impl<R: Real> LightBuffer<R> {
    /// Nothing stands in the light yet.
    pub fn new(extent: [u32; 2]) -> Self {
        let texels = extent.map(|n| n as usize).into_iter().product();
        let taken = vec![R::from_f64(0.0); texels];
        Self { extent, taken }
    }

    /// What is left of the light at a point of the centred world.
    pub fn light_at(&self, frame: &Frame, world: [R; 3]) -> R {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        let at = |k: usize| {
            let [x, y, z, w] = frame.light_rows[k].map(R::from_f32);
            // Texel centres lie at whole numbers.
            let texel = dot([x, y, z], world) + w - R::from_f64(0.5);
            let last = R::from_f64(f64::from(self.extent[k] - 1));
            let low = texel.floor().max(zero).min(last);
            let high = (low + one).min(last);
            (low, high, (texel - low).max(zero).min(one))
        };
        let ((left, right, across), (top, bottom, down)) = (at(0), at(1));
        let upper = self
            .taken_at(left, top)
            .lerp(self.taken_at(right, top), across);
        let lower = self
            .taken_at(left, bottom)
            .lerp(self.taken_at(right, bottom), across);
        one - upper.lerp(lower, down)
    }

    fn taken_at(&self, x: R, y: R) -> R {
        self.taken[y.to_i32() as usize * self.extent[0] as usize + x.to_i32() as usize]
    }
}

/// The sample of a pixel's ray on one plane, as the eye or the light sees it; `None` outside the domain, `Some(None)`
/// for no data. `value_at` takes the place in voxel space and in the centred world.
pub fn fragment<R: Real, V>(
    frame: &Frame,
    pixel: [R; 2],
    plane: i32,
    value_at: impl Fn([R; 3], [R; 3]) -> Option<V>,
) -> Option<Option<Fragment<R, V>>> {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let [t0, t1] = domain_interval(frame, &world, &voxel);
    let t = plane_t(frame, &world, plane);
    if !(t0 <= t && t < t1) {
        return None;
    }
    let length = plane_length(frame, &world).abs();
    Some(value_at(voxel.at(t), world.at(t)).map(|value| Fragment { value, length }))
}

/// The colour of matter of which the full light makes `lit`, where a part of it is left.
pub fn dimmed<R: Real>(frame: &Frame, color: [R; 3], lit: [R; 3], light: R) -> [R; 3] {
    let ambient: [R; 3] =
        std::array::from_fn(|c| (color[c] * R::from_f32(frame.ambient)).min(lit[c]));
    add(ambient, scale(sub(lit, ambient), light))
}

/// The colour of matter in the full light, without surfaces.
pub fn plainly_lit<R: Real>(frame: &Frame, color: [R; 3]) -> [R; 3] {
    let one = R::from_f64(1.0);
    let ambient = R::from_f32(frame.ambient).min(one);
    let of_light = |c: usize| ambient + (one - ambient) * R::from_f32(frame.light_colors[0][c]);
    [0, 1, 2].map(|c| color[c] * of_light(c))
}

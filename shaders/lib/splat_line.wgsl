// What a ray makes of splats. A ray v(t) = o + t d of voxel space meets slice m of axis k at t_m. With w from there to
// the centre of a voxel of the slice, across it, and M the precision of the kernel,
//
//     t* = t_m + g.w         g = (Md)_ij / (d.Md)                     where the splat is densest along the ray
//     b^2 = w.Qw             Q = M_ij - (Md)_i (Md)_j / (d.Md)        how far from it the ray passes, in deviations
//     F = peak e^(-b^2 / 2) / kappa        kappa = sqrt(d.Md)         its integral along the ray, 0 beyond R
//     F (Phi(kappa (t_b - t*)) - Phi(kappa (t_a - t*)))               the same between t_a and t_b
//     |w_i| <= R sqrt(Q^-1_ii)        |t* - t_m| <= R sqrt(g.Q^-1 g)
//
// From the crossing of the slice b^2 keeps its digits; from an eye far away it has none left. CPU reference:
// src/technique/splat/line.rs.

#import ray
#import main_axis
#import normal

// Beyond all rays.
const ENDLESS: f32 = 1e15;

// Vectors have the two axes across the slices first, the lower one before the other.
struct SplatLine {
    origin: vec3<f32>,
    axis: u32,
    direction: vec3<f32>,
    kappa: f32,
    // Q_ii, Q_ij, Q_jj.
    form: vec3<f32>,
    // F of a splat that the ray goes through the middle of.
    peak: f32,
    // g.
    drift: vec2<f32>,
    // How far from the crossing splats lie, in voxels.
    half_widths: vec2<f32>,
    // How far before and behind the crossing, in world length, they have any part.
    reach: f32,
}

// What of a ray counts.
struct SplatRange {
    // Where samples may lie.
    t: vec2<f32>,
    // Where splats are cut.
    part: vec2<f32>,
    // The voxels that are splatted, the last included.
    first: vec3<i32>,
    last: vec3<i32>,
}

// The slices of a ray, from front to back.
struct SplatSlices {
    first: i32,
    step: i32,
    count: i32,
}

// Voxels of a slice that may lie within reach of the ray.
struct SplatRectangle {
    first: vec2<i32>,
    count: vec2<i32>,
    // From the crossing to the first of them.
    offset: vec2<f32>,
}

// A vector by the axes across slices of axis k, and that.
fn across(k: u32, v: vec3<f32>) -> vec3<f32> {
    return select(select(v, v.xzy, k == 1u), v.yzx, k == 0u);
}

fn whole_across(k: u32, v: vec3<i32>) -> vec3<i32> {
    return select(select(v, v.xzy, k == 1u), v.yzx, k == 0u);
}

// The voxel of such a vector.
fn voxel_across(k: u32, v: vec3<i32>) -> vec3<i32> {
    return select(select(v, v.xzy, k == 1u), v.zxy, k == 0u);
}

// A position in voxel space of such a vector.
fn across_voxel(k: u32, v: vec3<f32>) -> vec3<f32> {
    return select(select(v, v.xzy, k == 1u), v.zxy, k == 0u);
}

fn splat_line(voxel: Ray) -> SplatLine {
    let d = voxel.direction;
    // The slices of a stack, or of the ray's own main axis.
    let k = select(frame.slice_axis, main_axis_of(d), frame.slice_axis > 2u);
    // Of the mixed numbers, each stands at the axis that it does not mix.
    let mixed = frame.splat_mixed;
    let turned = frame.splat_diagonal * d + (mixed.zzy * d.yxx + mixed.yxx * d.zzy);
    let along = d.x * turned.x + d.y * turned.y + d.z * turned.z;
    let diagonal = across(k, frame.splat_diagonal).xy;
    let md = across(k, turned).xy;
    let g = md / along;
    let form = vec3(diagonal.x - md.x * g.x, across(k, mixed).z - md.x * g.y, diagonal.y - md.y * g.y);
    let determinant = form.x * form.z - form.y * form.y;
    let spread = g.x * g.x * form.z - 2.0 * g.x * g.y * form.y + g.y * g.y * form.x;
    let kappa = sqrt(along);
    let cut = frame.splat_reach;
    return SplatLine(
        across(k, voxel.origin),
        k,
        across(k, d),
        kappa,
        form,
        frame.splat_peak / kappa,
        g,
        cut * sqrt(form.zx / determinant),
        cut / kappa + cut * sqrt(max(spread / determinant, 0.0)),
    );
}

// Where slice m is met.
fn crossing(line: SplatLine, m: i32) -> f32 {
    return (f32(m) + 0.5 - line.origin.z) / line.direction.z;
}

// Slices that may have a part within so much of what counts.
fn splat_slices(line: SplatLine, range: SplatRange, margin: f32) -> SplatSlices {
    let low = whole_across(line.axis, range.first).z;
    let high = whole_across(line.axis, range.last).z;
    let ends = line.origin.z + (range.t + vec2(-margin, margin)) * line.direction.z - 0.5;
    let first = i32(floor(max(min(ends.x, ends.y), f32(low))));
    let last = i32(ceil(min(max(ends.x, ends.y), f32(high))));
    let is_up = line.direction.z > 0.0;
    return SplatSlices(select(last, first, is_up), select(-1, 1, is_up), last - first + 1);
}

fn splat_rectangle(line: SplatLine, range: SplatRange, t: f32) -> SplatRectangle {
    let at = line.origin.xy + t * line.direction.xy;
    let least = vec2<f32>(whole_across(line.axis, range.first).xy);
    let most = vec2<f32>(whole_across(line.axis, range.last).xy);
    let first = vec2<i32>(ceil(max(at - line.half_widths - 0.5, least)));
    let last = vec2<i32>(floor(min(at + line.half_widths - 0.5, most)));
    return SplatRectangle(first, max(last - first + 1, vec2(0)), vec2<f32>(first) + 0.5 - at);
}

// Before the first place of a rectangle.
const FIRST_PLACE: vec2<i32> = vec2(-1, 0);

// The place after another, row by row: without a division, which llvmpipe does number by number.
fn next_place(at: vec2<i32>, columns: i32) -> vec2<i32> {
    let next = at.x + 1;
    return select(vec2(next, at.y), vec2(0, at.y + 1), next == columns);
}

// b^2 of the voxel that lies so far from the crossing.
fn splat_square(line: SplatLine, w: vec2<f32>) -> f32 {
    return line.form.x * w.x * w.x + 2.0 * line.form.y * w.x * w.y + line.form.z * w.y * w.y;
}

// F.
fn splat_weight(line: SplatLine, square: f32) -> f32 {
    return line.peak * exp(-0.5 * square);
}

// The part of a splat before so many of its deviations along the ray.
fn part_before(x: vec4<f32>) -> vec4<f32> {
    let cut = vec4(frame.splat_reach);
    return select(select(normal(x), vec4(0.0), x <= -cut), vec4(1.0), x >= cut);
}

// The part of a splat that counts, without sheets.
fn part_within(line: SplatLine, range: SplatRange, t_densest: f32) -> f32 {
    let ends = line.kappa * (range.part - t_densest);
    let parts = part_before(vec4(ends, ends));
    return parts.y - parts.x;
}

// How far from the crossing of a slice, in voxels, what its sheets are made of lies: a sheet that the slice reaches into
// has voxels as far again.
fn passed_reach(line: SplatLine, sheet: f32) -> f32 {
    let along = (2.0 * line.reach + sheet) * max(abs(line.direction.z), max(abs(line.direction.x), abs(line.direction.y)));
    let halo = frame.splat_halo;
    return along + max(halo.x, max(halo.y, halo.z));
}

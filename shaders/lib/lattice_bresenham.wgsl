// Samples where a ray meets the heights (j + 1/2) / D of its own main axis k, that of its largest slope in voxel space, D
// samples a voxel of that axis. With s = sign(d_k) they count from front to back:
//
//     t_i = ((i + 1/2) / D - s o_k) / |d_k|          a sample stands for 1 / (D |d_k|)
//
// For D = 1 they lie in the voxels of Bresenham's line. CPU reference: src/lattice.rs.

#import ray
#import lattice
#import main_axis

// A ray along its main axis: s o_k and |d_k|.
struct MainAxis {
    height: f32,
    slope: f32,
}

fn main_axis(world: Ray) -> MainAxis {
    let voxel = voxel_ray(world);
    let slopes = abs(voxel.direction);
    let enough = MAIN_AXIS_SHARE * max(slopes.x, max(slopes.y, slopes.z));
    var height = voxel.origin.z;
    var slope = voxel.direction.z;
    if slopes.x >= enough {
        height = voxel.origin.x;
        slope = voxel.direction.x;
    } else if slopes.y >= enough {
        height = voxel.origin.y;
        slope = voxel.direction.y;
    }
    return MainAxis(select(height, -height, slope < 0.0), abs(slope));
}

// One height more at each end: rounding may not lose one, and `segment_of` has the last word.
fn lattice_of(world: Ray, interval: vec2<f32>, pixel: vec2<f32>) -> Lattice {
    let line = main_axis(world);
    let first = i32(floor((line.height + interval.x * line.slope) * frame.samples_per_voxel - 0.5));
    let last = i32(ceil((line.height + interval.y * line.slope) * frame.samples_per_voxel - 0.5));
    return Lattice(first, last - first + 1, interval.x, interval.y, interval.x);
}

// A segment of no length is outside.
fn segment_of(lattice: Lattice, world: Ray, k: i32) -> Segment {
    let line = main_axis(world);
    let t = height_t(line, k);
    let inside = lattice.t0 <= t && t < lattice.t1;
    return Segment(t, select(0.0, height_length(line), inside));
}

// One between two that lie inside.
fn whole_segment(lattice: Lattice, world: Ray, k: i32) -> Segment {
    return Segment(height_t(main_axis(world), k), height_length(main_axis(world)));
}

// Samples lie at t = x + k y.
fn line_of(lattice: Lattice, world: Ray) -> vec2<f32> {
    let line = main_axis(world);
    return vec2(height_t(line, 0), height_length(line));
}

// From x (included) to y (excluded) none is cut short.
fn whole_samples(lattice: Lattice) -> vec2<i32> {
    return vec2(lattice.first, lattice.first + lattice.count);
}

// Which sample lies at t, as a fraction.
fn index_at(lattice: Lattice, world: Ray, t: f32) -> f32 {
    let line = main_axis(world);
    return (line.height + t * line.slope) * frame.samples_per_voxel - 0.5;
}

// Where height k meets the ray.
fn height_t(line: MainAxis, k: i32) -> f32 {
    return ((f32(k) + 0.5) / frame.samples_per_voxel - line.height) / line.slope;
}

// The length that each of its samples stands for.
fn height_length(line: MainAxis) -> f32 {
    return 1.0 / (frame.samples_per_voxel * line.slope);
}

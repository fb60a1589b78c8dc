// The parameters of one recording: rays, grid, domain, values, transfer function, slices.
//
// World here is the file's world moved so that the centre of the uncropped grid box is its origin:
// f32 then keeps the same precision wherever the patient lay. Matrices hold their rows one after
// another and are applied as `vec4(position, 1) * rows`.

// The parameters of a recording may take 16 KiB on every device: these are half of that.
const MAX_CLIP_PLANES: u32 = 512u;
// One lane of a vector each.
const MAX_CHANNELS: u32 = 4u;
const CHANNEL_ROWS: u32 = 12u;
const MAX_LIGHTS: u32 = 4u;
const MAX_LEVELS: u32 = 8u;
// Bins of values, and rows with the largest extinctions of 1, 2, 4, .. of them beside each other: seven fill 112 of the vectors.
const MAJORANT_BINS: u32 = 64u;
const MAJORANT_ROWS: u32 = 7u;
const MAJORANT_VECTORS: u32 = 128u;

struct Frame {
    // Beside vectors stand the numbers that fragments of slices ask for (`shaders/flat_varyings.rs`).
    //
    // A pixel's ray: origin + x * origin_dx + y * origin_dy, and the same for its direction, which is
    // then made a unit vector. Pixel centres lie at +0.5.
    origin: vec3<f32>,
    table_scale: f32,
    origin_dx: vec3<f32>,
    is_uneven: u32,
    origin_dy: vec3<f32>,
    table_first: f32,
    direction: vec3<f32>,
    code_offset: f32,
    direction_dx: vec3<f32>,
    slope: f32,
    direction_dy: vec3<f32>,
    intercept: f32,
    // The camera's forward direction, or half way between it and the light's: normal of the planes.
    forward: vec3<f32>,
    step_world: f32,
    // The same as a covector of voxel space: which way each grid axis runs away from the eye.
    forward_voxel: vec3<f32>,
    // +1 for a maximum, -1 for a minimum, 0 for a sum.
    extreme_sign: f32,
    // What is kept of the grid, in voxel space, and the cover that slicers draw.
    domain_min: vec3<f32>,
    clip_plane_count: u32,
    domain_max: vec3<f32>,
    table_count: u32,
    cover_min: vec3<f32>,
    slice_first: i32,
    cover_max: vec3<f32>,
    codes_are_integers: u32,
    dims: vec3<f32>,
    reference_length: f32,
    // The brick of this recording: the samples that are its own, and where its texture lies in voxel space.
    brick_min: vec3<f32>,
    is_only_brick: u32,
    brick_max: vec3<f32>,
    code_scale: f32,
    brick_origin: vec3<f32>,
    slice_axis: u32,
    brick_dims: vec3<f32>,
    slice_direction: i32,
    voxel_from_world: mat3x4<f32>,
    world_from_voxel: mat3x4<f32>,
    clip_from_world: mat4x4<f32>,
    // Keeps the world points with dot(xyz, point) >= w.
    clip_planes: array<vec4<f32>, MAX_CLIP_PLANES>,
    extent_pixels: vec2<u32>,
    color_point_count: u32,
    opacity_point_count: u32,
    // Where in the transfer function's numbers those begin that gradients ask for.
    first_widget_entry: u32,
    interpolation_is_step: u32,
    color_space_is_display: u32,
    // Slices: instance i shows slice (or plane) slice_first + i * slice_direction; in a 2D stack that
    // is seen from inside, the instances from slice_turn on start at the other end.
    slice_turn: u32,
    slice_first_after_turn: i32,
    // Nothing lies before this recording.
    is_first_brick: u32,
    // Several volumes in one place, one lane a channel; lane 0 of codes is that of the volume above.
    channel_count: u32,
    // From voxel space to that of each channel, three rows each, and voxels along its axes; not 0 in the last
    // lane of one on a grid of its own.
    channel_from_voxel: array<vec4<f32>, CHANNEL_ROWS>,
    channel_dims: array<vec4<f32>, MAX_CHANNELS>,
    // Makes gradients of channels comparable: the least gradient of the first that is a surface over that of each.
    channel_gradient_scale: vec4<f32>,
    channel_code_scale: vec4<f32>,
    channel_code_offset: vec4<f32>,
    channel_slope: vec4<f32>,
    channel_intercept: vec4<f32>,
    channel_codes_are_integers: vec4<u32>,
    channel_is_labels: vec4<u32>,
    channel_has_holes: vec4<u32>,
    // 1: says how opaque the channel before it is, and is not seen itself.
    channel_is_opacity: vec4<u32>,
    // Not 0: the four are light and optical depth per reference length of classified voxels, not a colour.
    colors_are_classified: u32,
    channel_table_first: vec4<f32>,
    channel_table_scale: vec4<f32>,
    channel_table_count: vec4<u32>,
    channel_table_row: vec4<u32>,
    channel_point_first: vec4<u32>,
    channel_color_point_count: vec4<u32>,
    channel_opacity_point_count: vec4<u32>,
    channel_interpolation_is_step: vec4<u32>,
    channel_reference_length: vec4<f32>,
    // The table of pre-integrated classification.
    slab_first: f32,
    slab_scale: f32,
    slab_count: u32,
    // Planes of a 2D stack for each of its slices, and where a cover lies between one plane and the next.
    planes_per_slice: f32,
    cover_offset: f32,
    // Covers that lie so near the eye are the whole picture: voxels along a stack, world length for planes.
    cover_eye_reach: f32,
    // Whether rays are jittered, by how much the pattern is turned, in parts of 2^32, and moved.
    is_jittered: u32,
    jitter: u32,
    jitter_shift: vec2<u32>,
    // Where is_uneven is 1 each pixel has a place of its own for its ray, in a square of this side around where the ray
    // would be.
    cell_seed: u32,
    cell_pixels: f32,
    // Rays end where no more of what lies behind comes through.
    termination: f32,
    // Values without a unit: (value - value_low) * value_scale, 0 to 1.
    value_low: f32,
    value_scale: f32,
    // A local maximum counts over this.
    lmip_threshold: f32,
    // How much of a new maximum's height is taken from what lies before it: 1 + gamma.
    mida_fade: f32,
    // The share of the maximum's picture: gamma over 0.
    mida_mip: f32,
    // Per world length of matter of value 1.
    attenuation: f32,
    // How dark it is at depth 1 of (depth - depth_near) * depth_scale.
    depth_cue: f32,
    depth_near: f32,
    depth_scale: f32,
    // Surfaces, ascending: the value in x; colour as it is blended, not premultiplied, and opacity.
    level_count: u32,
    level_values: array<vec4<f32>, MAX_LEVELS>,
    level_colors: array<vec4<f32>, MAX_LEVELS>,
    // Light: no lights, no shading. The way to each light is a unit vector of world space; w is not 0 for one
    // that shines along the pixel's ray, and where matter scatters light for one that has a place, which xyz then is.
    light_directions: array<vec4<f32>, MAX_LIGHTS>,
    light_colors: array<vec4<f32>, MAX_LIGHTS>,
    light_count: u32,
    // Value per world length under which there is no surface.
    flat_gradient: f32,
    ambient: f32,
    diffuse: f32,
    specular: f32,
    shininess: f32,
    // Value per world length at which half of the light is that on a surface.
    half_gradient: f32,
    // Which kernel, where the filter is one: see kernel.wgsl.
    kernel: u32,
    // World length of the shortest side of a voxel.
    smallest_spacing: f32,
    // Samples that rays take for each voxel of their main axis.
    samples_per_voxel: f32,
    // How gradients are made, and code (or slope) from the texels that they are made of: see gradient_taps.wgsl.
    gradient_operator: u32,
    gradient_scale: f32,
    gradient_codes_are_integers: u32,
    // What is left of extinction and colour where a label is shadowed.
    dim: f32,
    // Cut faces: 0 none, 1 in the picture's own colours, 2 in greys, by (value - cut_low) * cut_scale.
    cut_faces: u32,
    cut_low: f32,
    cut_scale: f32,
    // Nothing lies behind this recording.
    is_last_brick: u32,
    // The light volume: cells of its grid along each axis, and how many of them a voxel is long.
    light_cells: vec3<f32>,
    // How much darker ambient light is where nothing comes in, 0 to 1; 0 without occlusion.
    occlusion_strength: f32,
    light_cells_per_voxel: vec3<f32>,
    // World length by which a sample asks nearer to the light, or to the eye for what comes from all around.
    light_reach: f32,
    has_shadows: u32,
    // The bundle of the first light.
    shadow_bundle: u32,
    // Where a point of the world lies in the light's picture, in its texels: across and down.
    light_rows: array<vec4<f32>, 2>,
    // Macro cells of this recording's brick: how many along each axis (0: nothing is known of them), which one is its
    // first, and where that begins in voxel space.
    cells: vec3<u32>,
    cells_first: u32,
    cells_origin: vec3<f32>,
    // Slices of this recording, and the side in pixels of the squares in which empty parts of them are left out.
    slice_count: u32,
    patch_pixels: u32,
    // How far samples may lie from where a patch says: voxels, and planes where they are slabs.
    patch_reach_voxels: f32,
    patch_reach_planes: f32,
    // A host's depth of a point p of the world: dot(host_z, (p, 1)) / dot(host_w, (p, 1)). Its depth buffer ends rays
    // where has_host_depth is not 0; host_near is the depth of its near plane, which covers around the eye lie in.
    // In a copy of it (host_depth_copy.wgsl) the larger depth is always the nearer one: where flips_host_depth is not 0,
    // the copy has 1 - depth.
    has_host_depth: u32,
    host_near: f32,
    flips_host_depth: u32,
    // Planes with samples lie at forward . x = (k + 1/2) step_world + plane_offset.
    plane_offset: f32,
    host_z: vec4<f32>,
    host_w: vec4<f32>,
    // Where pixel (x, y) of a picture lies in its intermediate image: (x, y, 1, 0) to homogeneous coordinates.
    base_from_pixel: mat3x4<f32>,
    // Splats: the precision matrix of the kernel in voxel space, xx, yy, zz and yz, xz, xy; where it is cut, in
    // deviations; what makes its integral 1; the voxels whose centres are kept, the last included; and by how many
    // voxels tiles look around the box.
    splat_diagonal: vec3<f32>,
    splat_reach: f32,
    splat_mixed: vec3<f32>,
    splat_peak: f32,
    splat_first: vec3<i32>,
    splat_last: vec3<i32>,
    splat_halo: vec3<f32>,
    // What of each ray this recording takes: of splats which sheets, or which slices where sheets are these or none; of scattered
    // points which of the list of a tile, or where rays are cast through them which samples.
    part_first: u32,
    part_end: u32,
    // The field of points: from voxel space to cells, how many of these there are along each axis, a cell over the radius, 1 over
    // the integral of the kernel (0: means of values), and whether empty cells are left out.
    field_from_voxel: mat3x4<f32>,
    field_cells: vec3<u32>,
    field_scale: f32,
    field_density: f32,
    field_skips: u32,
    // Path tracing: how many paths of each pixel the picture is the mean of already, the first path in this recording, how
    // many, which random numbers they have, and how often they may be scattered.
    path_before: u32,
    path_first: u32,
    path_count: u32,
    path_seed: u32,
    path_bounces: u32,
    // Radiance from all around, or what that of a picture of so many texels is multiplied by, turned by a part of a turn;
    // and whether the eye sees it.
    path_sky: vec3<f32>,
    path_sky_turn: f32,
    path_sky_size: vec2<u32>,
    path_sky_shown: u32,
    // Tiles are drawn that see nothing of the volume: through a lens, or with a sky.
    draws_all_tiles: u32,
    // Per world length, times density: no extinction is larger.
    path_majorant: f32,
    // The phase function: see phase.wgsl.
    path_phase: vec4<f32>,
    // What extinctions and colours are multiplied by.
    path_density: f32,
    path_albedo: f32,
    // A collision at gradient g (value per world length) is one with a surface by the chance 1 - exp(-path_surface g).
    path_surface: f32,
    // Surfaces: reflectance at right angles, 0: Lambert; and the square of the roughness.
    path_f0: f32,
    path_alpha: f32,
    // 1 - cosine of half the angle that a light is wide.
    path_light_size: f32,
    // Lights with a place: which way a disc faces, 0 for a sphere, and the radius.
    lamps: array<vec4<f32>, MAX_LIGHTS>,
    // A thin lens: half of its width to the right and up, and how far away along `forward` is sharp; 0: none.
    path_lens_right: vec3<f32>,
    path_focus: f32,
    path_lens_up: vec3<f32>,
    // Paths of more rounds end by chance.
    path_rounds: u32,
    // Bin (value - first) * scale; row r holds at i the largest of the bins i to i + 2^r - 1, times density.
    path_bin_first: f32,
    path_bin_scale: f32,
    // Optical depth behind which light is not followed any more that samples follow to lights; 0: they follow none.
    scattering_depth: f32,
    // Segments of a ray are step_world long over its slope to `forward`, which counts as this at least: 1 where all are alike.
    least_slope: f32,
    // A medium: emission points behind those of opacity; whether these are (value, extinctions times reference_length of red,
    // green and blue); and whether the three differ.
    emission_point_count: u32,
    opacity_is_extinction: u32,
    extinction_is_colored: u32,
    // In a host's target: what is done with light (tone.wgsl), and what it is multiplied by before.
    tone: u32,
    tone_gain: f32,
    path_majorants: array<vec4<f32>, MAJORANT_VECTORS>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

/* stratavox: volumes drawn by a host's own Vulkan device. See docs/c-interface.md.
 *
 * Made by cbindgen of src/capi; do not edit.
 *
 * Rules of all of it:
 *  - No header of Vulkan is needed: dispatchable handles are pointers, others are uint64_t, enums are plain numbers.
 *  - Each structure begins with its own size and `next`, which is NULL. All else may be zero, which is the default.
 *  - Each function that can fail returns an sv_status, and writes what is wrong to `diagnostic`, which may be NULL.
 *  - A handle of something that is destroyed is an error and never more, and so is one of another kind.
 *  - What is destroyed first does not matter: what still needs it keeps it.
 *  - Nothing is submitted, waited for or destroyed that is the host's, but for what sv_submitter_* is asked to submit.
 */

#ifndef STRATAVOX_H
#define STRATAVOX_H

#include <stdint.h>

// How a call ended. What failed has changed nothing, unless its function says otherwise.
enum sv_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Done.
    SV_OK = 0,
    // An argument that can never do: a null pointer, a stale handle, a number out of its range.
    SV_E_ARGUMENT = -1,
    // Nothing wrong with it, but neither the library nor this device can do it.
    SV_E_UNSUPPORTED = -2,
    // More than a limit allows, of the device or of the library: see `wanted` and `allowed`.
    SV_E_LIMIT = -3,
    // No memory, of the host or of the device.
    SV_E_MEMORY = -4,
    // The device is lost. What is on it can only be destroyed, which stays safe.
    SV_E_DEVICE_LOST = -5,
    // Right, but not now: something else comes first, or another thread uses the object.
    SV_E_STATE = -6,
    // A structure of another version of this header: see `struct_size` and `next`.
    SV_E_VERSION = -7,
    // A mistake of the library's own. Please report it with the text.
    SV_E_INTERNAL = -8,
    // The driver refused, and gave no better reason than its number, which the text has.
    SV_E_DRIVER = -9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_status sv_status;
#else
typedef int32_t sv_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The version of this interface.
enum sv_version
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Of this header: compare it with sv_abi_version.
    SV_ABI_VERSION = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_version sv_version;
#else
typedef uint32_t sv_version;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Features of the device, by their names in the Vulkan specification.
enum sv_feature
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Required.
    SV_FEATURE_DYNAMIC_RENDERING = 1,
    // Required.
    SV_FEATURE_SYNCHRONIZATION2 = 2,
    // Required of `sv_submitter_create` alone.
    SV_FEATURE_TIMELINE_SEMAPHORE = 4,
    // Of use, no more.
    SV_FEATURE_ROBUST_BUFFER_ACCESS = 8,
    // Of use, no more.
    SV_FEATURE_ROBUST_IMAGE_ACCESS = 16,
    // `VK_KHR_portability_subset`, an extension: required where the device lists it.
    SV_FEATURE_PORTABILITY_SUBSET = 32,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_feature sv_feature;
#else
typedef uint32_t sv_feature;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The rendering technique.
enum sv_technique
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // One ray a pixel, in a compute pass.
    SV_TECHNIQUE_RAYCAST = 0,
    // Planes parallel to the picture, drawn and blended.
    SV_TECHNIQUE_SLICES_3D = 1,
    // The volume's own slices along the axis that faces the eye most.
    SV_TECHNIQUE_SLICES_2D = 2,
    // Rays through a plane between these slices, warped to the picture. No depth.
    SV_TECHNIQUE_SHEAR_WARP = 3,
    // Every voxel is a Gaussian, of which rays take the integral.
    SV_TECHNIQUE_SPLAT = 4,
    // Random paths of light that scatters: each frame has more of them.
    SV_TECHNIQUE_PATHTRACE = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_technique sv_technique;
#else
typedef uint32_t sv_technique;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What is done with the samples of a ray.
enum sv_mode
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Emission and absorption.
    SV_MODE_COMPOSITE = 0,
    // Maximum.
    SV_MODE_MIP = 1,
    // Minimum.
    SV_MODE_MINIP = 2,
    // Mean, weighted by length.
    SV_MODE_AVERAGE = 3,
    // Integral of the value over world length.
    SV_MODE_XRAY = 4,
    // First local maximum over a threshold, the maximum where there is none. Rays only.
    SV_MODE_LMIP = 5,
    // Maximum of values that what lies before them fades. Rays only.
    SV_MODE_ATTENUATED_MIP = 6,
    // Surfaces where the volume has the values of `levels`. Rays only.
    SV_MODE_ISO = 7,
    // Emission and absorption in which a new maximum takes from what lies before it. Rays only.
    SV_MODE_MIDA = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_mode sv_mode;
#else
typedef uint32_t sv_mode;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How light comes to matter that scatters it once on its way to the eye.
enum sv_scattering
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // It scatters none: matter shines in its colours.
    SV_SCATTERING_NONE = 0,
    // Lights are followed from each sample on.
    SV_SCATTERING_MARCH = 1,
    // Nothing is in the way of lights.
    SV_SCATTERING_OPEN = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_scattering sv_scattering;
#else
typedef uint32_t sv_scattering;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What is done with light near white and over it.
enum sv_tone
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Light over 1 is cut off by targets that do not hold it.
    SV_TONE_NONE = 0,
    // Colours stay, and bright ones fade to white (Khronos PBR neutral).
    SV_TONE_NEUTRAL = 1,
    // Soft in the dark and in the light (Hable 2010).
    SV_TONE_FILMIC = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_tone sv_tone;
#else
typedef uint32_t sv_tone;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How a value between voxel centres is made.
enum sv_filter
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Trilinear (bilinear in a 2D stack).
    SV_FILTER_LINEAR = 0,
    // The voxel that the sample lies in.
    SV_FILTER_NEAREST = 1,
    // The quadratic B-spline through the voxels.
    SV_FILTER_QUADRATIC = 2,
    // The cubic B-spline through the voxels.
    SV_FILTER_CUBIC = 3,
    // The quadratic B-spline with voxels as coefficients, which blurs.
    SV_FILTER_QUADRATIC_SMOOTH = 4,
    // The cubic B-spline with voxels as coefficients, which blurs more.
    SV_FILTER_CUBIC_SMOOTH = 5,
    // Catmull and Rom's cubic through the voxels.
    SV_FILTER_CATMULL_ROM = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_filter sv_filter;
#else
typedef uint32_t sv_filter;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which samples rays take.
enum sv_lattice
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Equal steps from where the ray enters the volume.
    SV_LATTICE_RAY = 0,
    // Where the ray meets the planes that SV_TECHNIQUE_SLICES_3D draws.
    SV_LATTICE_PLANES = 1,
    // Equal steps after a first one that depends on the pixel: grain in place of bands.
    SV_LATTICE_JITTER = 2,
    // Where the ray meets the heights (j + 1/2) / samples_per_voxel of its own main axis, in voxels.
    SV_LATTICE_BRESENHAM = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_lattice sv_lattice;
#else
typedef uint32_t sv_lattice;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// In which numbers colours are blended.
enum sv_color_space
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Linear light: for targets of floats and of `SRGB` formats.
    SV_COLOR_SPACE_LINEAR = 0,
    // sRGB numbers as they are: for `UNORM` targets that are shown as they are.
    SV_COLOR_SPACE_DISPLAY = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_color_space sv_color_space;
#else
typedef uint32_t sv_color_space;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The type of stored voxels.
enum sv_voxel_type
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // 8 bits, unsigned.
    SV_VOXEL_U8 = 0,
    // 8 bits, signed.
    SV_VOXEL_I8 = 1,
    // 16 bits, unsigned.
    SV_VOXEL_U16 = 2,
    // 16 bits, signed.
    SV_VOXEL_I16 = 3,
    // 32 bits, unsigned. Kept as F32.
    SV_VOXEL_U32 = 4,
    // 32 bits, signed. Kept as F32.
    SV_VOXEL_I32 = 5,
    // Half precision.
    SV_VOXEL_F16 = 6,
    // Single precision.
    SV_VOXEL_F32 = 7,
    // Double precision. Kept as F32.
    SV_VOXEL_F64 = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_voxel_type sv_voxel_type;
#else
typedef uint32_t sv_voxel_type;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a camera is made of.
enum sv_camera_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // All of the volume from the front, in perspective.
    SV_CAMERA_FITTED = 0,
    // `eye`, `target` and `up`.
    SV_CAMERA_LOOK_AT = 1,
    // `view_from_world` and `clip_from_view`.
    SV_CAMERA_MATRICES = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_camera_kind sv_camera_kind;
#else
typedef uint32_t sv_camera_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which way lines are followed from their seeds.
enum sv_direction
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Both: the seed lies inside of the line.
    SV_DIRECTION_BOTH = 0,
    // Along the velocity.
    SV_DIRECTION_FORWARD = 1,
    // Against it.
    SV_DIRECTION_BACKWARD = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_direction sv_direction;
#else
typedef uint32_t sv_direction;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a line is.
enum sv_line_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Along the velocities of one instant.
    SV_LINE_KIND_STREAM = 0,
    // The way of one particle.
    SV_LINE_KIND_PATH = 1,
    // Where the particles are at one moment that left the seed one after another.
    SV_LINE_KIND_STREAK = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_line_kind sv_line_kind;
#else
typedef uint32_t sv_line_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Why a line ends.
enum sv_cause
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // It was not followed that way.
    SV_CAUSE_NONE = 0,
    // The box of the grid ends there.
    SV_CAUSE_DOMAIN = 1,
    // The ground. Not of fields of the host's.
    SV_CAUSE_GROUND = 2,
    // A voxel that it lies between has no data.
    SV_CAUSE_NO_DATA = 3,
    // A pole of the Earth. Not of fields of the host's.
    SV_CAUSE_POLE = 4,
    // It is a million times slower than the fast places of the field, or stays where it is.
    SV_CAUSE_STAGNATION = 5,
    // It came back to its seed.
    SV_CAUSE_CLOSED = 6,
    // `length`.
    SV_CAUSE_LENGTH = 7,
    // `duration`.
    SV_CAUSE_TIME = 8,
    // `most_vertices`.
    SV_CAUSE_VERTICES = 9,
    // It came too near to another line that is evenly spaced.
    SV_CAUSE_CROWDED = 10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sv_cause sv_cause;
#else
typedef uint32_t sv_cause;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What any function of Vulkan is cast to.
typedef void (*sv_vk_function)(void);

// `vkGetInstanceProcAddr`, with `VkInstance` as a plain pointer: cast yours to it.
typedef sv_vk_function (*sv_get_instance_proc_addr)(void *instance, const char *name);

// Limits that are stricter than those of the device. 0 is no limit.
typedef struct sv_limits {
    // `sizeof(sv_limits)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // `maxImageDimension2D`.
    uint32_t max_image_dimension_2d;
    // `maxImageDimension3D`: larger volumes lie in bricks.
    uint32_t max_image_dimension_3d;
    // `maxImageArrayLayers`.
    uint32_t max_image_array_layers;
    // `maxStorageBufferRange`.
    uint32_t max_storage_buffer_range;
    // `maxMemoryAllocationSize`.
    uint64_t max_allocation_bytes;
    // `maxMemoryAllocationCount`.
    uint64_t max_allocations;
    // The size of the largest memory heap.
    uint64_t max_heap_bytes;
} sv_limits;

// A device of the host's, and what is enabled on it: Vulkan cannot be asked for that.
typedef struct sv_host_device {
    // `sizeof(sv_host_device)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // The `apiVersion` that the instance was made with, 1.3 or later. 0 is 1.3.
    uint32_t api_version;
    // The family of the queues that recordings are submitted to: with graphics and compute.
    uint32_t queue_family;
    // `VkInstance`.
    void *instance;
    // `VkPhysicalDevice`.
    void *physical_device;
    // `VkDevice`. It lives longer than the sv_device.
    void *device;
    // Every function of Vulkan is reached through it, and no loader is linked.
    sv_get_instance_proc_addr get_instance_proc_addr;
    // Bits of sv_feature that are enabled on the device.
    uint32_t features;
    // Not 0: the instance has `VK_EXT_debug_utils`, and objects get names.
    uint32_t has_debug_utils;
    // Stricter limits, or NULL.
    const struct sv_limits *limits;
    // What sv_device_pipeline_cache gave in an earlier run, or NULL. What another driver made is ignored.
    const void *pipeline_cache;
    // Bytes of it.
    uint64_t pipeline_cache_bytes;
    // Called once, from the call that notices that the device is lost; or NULL. It may destroy nothing.
    void (*device_lost)(void *user, const char *text);
    // What `device_lost` is called with.
    void *user;
    // As sv_device_set_memory_budget. 0: no budget.
    uint64_t memory_budget;
} sv_host_device;

// A device of the host's, and all that is made on it. 0 is none.
typedef uint64_t sv_device;

// What went wrong: memory of the caller's, written by calls that fail.
typedef struct sv_diagnostic {
    // `sizeof(sv_diagnostic)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // What the call returned.
    sv_status status;
    // What was wanted, where a limit was in the way; else 0.
    uint64_t wanted;
    // What the limit allows.
    uint64_t allowed;
    // What was being done, wanted and found: UTF-8 that ends with a zero, cut where it is longer.
    char text[256];
} sv_diagnostic;

// Memory of a device that is the library's.
typedef struct sv_memory {
    // `sizeof(sv_memory)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // Bytes in use.
    uint64_t used_bytes;
    // Bytes taken from the driver, in use or kept for later.
    uint64_t reserved_bytes;
    // The most bytes that were taken at once.
    uint64_t peak_bytes;
    // Vulkan objects that exist, those that wait for sv_device_retire among them.
    uint64_t vulkan_objects;
    // Handles that are not destroyed yet.
    uint64_t handles;
    // The most bytes that may be reserved, or 0 where there is no budget.
    uint64_t budget_bytes;
    // In how many pieces they were taken, which `maxMemoryAllocationCount` counts.
    uint64_t allocations;
    // What the driver says that this process may use of the device's own memory; 0 without `VK_EXT_memory_budget`.
    uint64_t device_budget_bytes;
    // What the driver says that it uses, the host's own with it; 0 without that.
    uint64_t device_used_bytes;
} sv_memory;

// Colour at a value.
typedef struct sv_color_point {
    // After rescale.
    double value;
    // sRGB numbers from 0 to 1.
    double srgb[3];
} sv_color_point;

// Opacity at a value.
typedef struct sv_opacity_point {
    // After rescale.
    double value;
    // Per reference length, 0 to 1.
    double opacity;
} sv_opacity_point;

// What matter does to light at a value, for SV_TECHNIQUE_PATHTRACE.
typedef struct sv_medium_point {
    // After rescale.
    double value;
    // Linear numbers of red, green and blue, none under 0.
    double linear[3];
} sv_medium_point;

// A transfer function by control points in order of their values, constant beyond the ends.
typedef struct sv_transfer_function_desc {
    // `sizeof(sv_transfer_function_desc)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // None: black.
    const struct sv_color_point *colors;
    // How many there are, at most 4096.
    uint64_t color_count;
    // None: transparent.
    const struct sv_opacity_point *opacities;
    // How many there are, at most 4096.
    uint64_t opacity_count;
    // The world length that opacities are for. 0: the smallest voxel spacing.
    double reference_length;
    // Not 0: from one point to the next the value of the first holds. Else it goes straight.
    uint32_t is_stepped;
    // 0.
    uint32_t reserved;
    // Extinction per world length in place of opacities, which are none then: what scatters no light takes the opacity that
    // it has over `reference_length`, 0 there being the length behind which half of the light is left in the densest matter.
    // None: that of `opacities`.
    const struct sv_medium_point *extinctions;
    // How many there are, at most 4096.
    uint64_t extinction_count;
    // The part of light that is scattered and not absorbed, 0 to 1. None: the colours in linear light.
    const struct sv_medium_point *albedos;
    // How many there are, at most 4096.
    uint64_t albedo_count;
    // Light that matter sends out, radiance per world length. None: it sends out none.
    const struct sv_medium_point *emissions;
    // How many there are, at most 4096.
    uint64_t emission_count;
} sv_transfer_function_desc;

// A transfer function. 0 is a ramp of greys over the volume's range.
typedef uint64_t sv_transfer_function;

// What is drawn into, as far as pipelines have to know.
typedef struct sv_target_class {
    // `sizeof(sv_target_class)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // `VkFormat` of the one color target.
    uint32_t color_format;
    // Samples of each target, as `VkSampleCountFlagBits`. 0 is 1.
    uint32_t samples;
    // `VkFormat` of the depth attachment, or 0 where there is none.
    uint32_t depth_format;
    // Not 0: the same image is the stencil attachment too.
    uint32_t has_stencil;
    // Not 0: the larger of two depths is nearer.
    uint32_t is_depth_reversed;
    // Of `render_pass`, with the color target as its first color attachment.
    uint32_t subpass;
    // `VkRenderPass`, or 0 for dynamic rendering.
    uint64_t render_pass;
} sv_target_class;

// The hull of two spheres: a piece of a tube, an arrow's head, a sphere where both ends are the same.
typedef struct sv_round_cone {
    // Middle of the first sphere, world.
    double first[3];
    // Of the second.
    double second[3];
    // World length, over 0.
    double first_radius;
    // Of the second.
    double second_radius;
    // Linear red, green and blue; it is lit from the eye.
    float first_color[3];
    // Of the second: colours go straight from one to the other.
    float second_color[3];
} sv_round_cone;

// A triangle that is seen from both sides, in colours as they are.
typedef struct sv_triangle {
    // Corners, world.
    double corners[3][3];
    // Linear red, green and blue of each.
    float colors[3][3];
    // 0.
    uint32_t reserved;
} sv_triangle;

// What geometry is made of and for.
typedef struct sv_geometry_desc {
    // `sizeof(sv_geometry_desc)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // What is drawn into, with a depth attachment.
    const struct sv_target_class *target;
    // sv_color_space.
    uint32_t color_space;
    // Frames of the host that may be unfinished at once, at most 64. 0 is 1.
    uint32_t frames_in_flight;
    // They are copied before the call returns.
    const struct sv_round_cone *cones;
    // How many there are.
    uint64_t cone_count;
    // They are copied before the call returns.
    const struct sv_triangle *triangles;
    // How many there are.
    uint64_t triangle_count;
} sv_geometry_desc;

// Round cones and triangles on a device. 0 is none.
typedef uint64_t sv_geometry;

// Where the eye is and what it sees, in the world. All zero: all of the volume from the front.
typedef struct sv_camera {
    // `sizeof(sv_camera)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // sv_camera_kind.
    uint32_t kind;
    // SV_CAMERA_MATRICES, not 0: the larger of two depths is nearer ("reverse Z").
    uint32_t is_reversed;
    // SV_CAMERA_LOOK_AT: where rays start.
    double eye[3];
    // SV_CAMERA_LOOK_AT: a point in the middle of the picture.
    double target[3];
    // SV_CAMERA_LOOK_AT: what points up in the picture. All zero: z.
    double up[3];
    // SV_CAMERA_LOOK_AT in perspective: the full vertical angle. 0 is 30.
    double fov_degrees;
    // SV_CAMERA_LOOK_AT: the world height of the picture of parallel rays. 0: perspective.
    double view_height;
    // SV_CAMERA_LOOK_AT: divides the picture plane. 0 is 1.
    double zoom;
    // SV_CAMERA_MATRICES: a turn and a shift, as columns.
    double view_from_world[16];
    // SV_CAMERA_MATRICES: perspective or orthographic, as columns, to Vulkan's clip space: y down, depth 0 to 1.
    double clip_from_view[16];
} sv_camera;

// One frame of the host's.
typedef struct sv_frame_info {
    // `sizeof(sv_frame_info)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // The eye; NULL: all of the volume from the front.
    const struct sv_camera *camera;
    // Which of the frames in flight, from 0: nothing unfinished was recorded with this number.
    uint32_t frame;
    // 0.
    uint32_t reserved;
} sv_frame_info;

// A field of velocities, and where its lines begin.
typedef struct sv_trace_desc {
    // `sizeof(sv_trace_desc)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // How many voxels there are along x, y and z: 1 or more of each.
    uint32_t dims[3];
    // sv_direction.
    uint32_t direction;
    // Three numbers a voxel, x fastest, then y, then z: along the axes of the world, world length per second; a voxel where one
    // of them is not finite has no data. With several times those of all voxels at the first of them, then at the second, and so
    // on; between two times velocities are linear. They are read before the call returns.
    const float *velocities;
    // How many numbers there are.
    uint64_t velocity_count;
    // As in sv_volume_desc. All zero: voxel space is the world.
    double world_from_voxel[16];
    // Three numbers each, world; or NULL: stream lines that are evenly spaced.
    const double *seeds;
    // How many seeds there are.
    uint64_t seed_count;
    // Of lines that are evenly spaced: their distance, world length. 0: a 24th of the diagonal of the box.
    double spacing;
    // No more lines that are evenly spaced than these. 0 is 2000.
    uint32_t most_lines;
    // How many vertices a line has at most, each way. 0 is 4000.
    uint32_t most_vertices;
    // How long a line is at most, each way, world length. 0: as long as it goes.
    double length;
    // For how long a line is followed, each way, in seconds. 0: as long as it goes.
    double duration;
    // What a step may be off by, in cells of the grid. 0 is 0.001.
    double tolerance;
    // sv_line_kind.
    uint32_t kind;
    // At how many times the velocities are given. 0 is 1; paths and streaks want 2 or more.
    uint32_t time_count;
    // These times, seconds that grow; NULL where there is one.
    const double *times;
    // Of stream lines the instant; of paths when particles are at the seeds; of streaks since when they leave them.
    double start;
    // Of streaks the moment that shows where they are.
    double end;
} sv_trace_desc;

// Lines that follow a field: in memory of the host's alone. 0 is none.
typedef uint64_t sv_lines;

// What is behind it is cut away: world points with `normal . x < offset`.
typedef struct sv_clip_plane {
    // Of any length but 0.
    double normal[3];
    // See above.
    double offset;
} sv_clip_plane;

// A surface of SV_MODE_ISO.
typedef struct sv_isosurface {
    // The value that the volume has there.
    double value;
    // Its colour before light, in sRGB numbers from 0 to 1.
    double srgb[3];
    // What it takes of the light from behind, 0 to 1.
    double opacity;
} sv_isosurface;

// A light that is infinitely far away.
typedef struct sv_light {
    // The way to it in the world, of any length but 0.
    double towards[3];
    // sRGB numbers from 0 to 1.
    double srgb[3];
} sv_light;

// What SV_TECHNIQUE_PATHTRACE traces. All zero: one path a pixel and frame up to 64, light that is scattered as often as it is,
// to all sides alike.
typedef struct sv_path_tracing {
    // `sizeof(sv_path_tracing)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // Paths a pixel, at most: frames after it show the same. 0 is 64.
    uint32_t samples;
    // So many more in each frame, at most 8, of a driver that counts the turns of loops 4 (through functions of gradients 2). 0 is 1.
    uint32_t samples_per_frame;
    // Other numbers, other noise.
    uint32_t seed;
    // How often light is scattered at most. 0: as often as it is.
    uint32_t bounces;
    // Not 0: it is not scattered, and matter shines in its colours.
    uint32_t is_unscattered;
    // Not 0: matter scatters light as particles far smaller than the wavelength do (Rayleigh).
    uint32_t is_rayleigh;
    // What extinctions are multiplied by. 0 is 1.
    double density;
    // What albedos are multiplied by, 0 to 1. 0 is 1.
    double albedo;
    // The mean cosine of the phase function (Henyey and Greenstein), -0.99 to 0.99: positive forward.
    double mean_cosine;
    // That of a second one.
    double second_mean_cosine;
    // The part of light that is scattered by the second one, 0 to 1.
    double second_part;
    // How wide lights look, in degrees, 0 to 90.
    double light_size_degrees;
    // Radiance from all around, linear red, green and blue. Without it and without `sv_settings.lights` a white light is
    // carried by the eye.
    double sky[3];
    // How much of matter is surface: a collision is one with a surface by the chance 1 - exp(-surface g), g the gradient
    // in ranges of values a smallest spacing.
    double surface;
    // Reflectance of surfaces at right angles, 0 to 1. 0: they reflect as Lambert says.
    double f0;
    // How rough the coat of surfaces is, 0.05 to 1. 0 is 0.4.
    double roughness;
} sv_path_tracing;

// What to compute. All zero: a composite by rays, one sample a voxel.
typedef struct sv_settings {
    // `sizeof(sv_settings)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // sv_technique.
    uint32_t technique;
    // sv_mode.
    uint32_t mode;
    // sv_filter.
    uint32_t filter;
    // sv_lattice.
    uint32_t lattice;
    // sv_color_space.
    uint32_t color_space;
    // Not 0: composites count what lies between two samples too.
    uint32_t is_preintegrated;
    // Not 0: samples that cannot matter are taken as well. The picture is the same, and slower.
    uint32_t disable_space_skipping;
    // Not 0: MIP and MinIP of the trilinear field itself, not of samples.
    uint32_t has_exact_maximum;
    // Samples a voxel along a ray. 0 is 1.
    double samples_per_voxel;
    // Rays end where less than this part of the light behind comes through, 0 to 1. 0: never.
    double termination;
    // The corner of the box to keep with the smallest voxel coordinates, which go from 0 to the number of voxels.
    double crop_min[3];
    // The other corner. Both zero: all of the volume.
    double crop_max[3];
    // Planes that cut.
    const struct sv_clip_plane *clip_planes;
    // How many there are.
    uint64_t clip_plane_count;
    // Surfaces of SV_MODE_ISO.
    const struct sv_isosurface *levels;
    // How many there are.
    uint64_t level_count;
    // Not 0: composites and surfaces are lit.
    uint32_t is_lit;
    // Not 0: `lmip_threshold` counts. Else SV_MODE_LMIP is a MIP.
    uint32_t has_lmip_threshold;
    // Part of the colour that needs no light. This and the next three all zero: 0.1, 0.7, 0.2 and 10.
    double ambient;
    // Part of the colour of a surface across the light.
    double diffuse;
    // White that a surface mirrors.
    double specular;
    // How sharply it mirrors. 0 is 10.
    double shininess;
    // Lights. None: a white one, carried by the eye.
    const struct sv_light *lights;
    // How many there are.
    uint64_t light_count;
    // The values that count as 0 and as 1 in SV_MODE_MIDA and SV_MODE_ATTENUATED_MIP. Both zero: the volume's range.
    double unit_values[2];
    // SV_MODE_LMIP: the first local maximum over it is shown.
    double lmip_threshold;
    // SV_MODE_MIDA: from -1, a composite, to 1, a MIP.
    double mida_gamma;
    // SV_MODE_ATTENUATED_MIP: how fast values fade. 0 is 16.
    double attenuation;
    // Modes that show one place of a ray: how much darker they are at its far end, 0 to 1.
    double depth_cue;
    // SV_LATTICE_JITTER: another pattern.
    uint32_t jitter_seed;
    // SV_LATTICE_JITTER: the number of the picture in a film.
    uint32_t jitter_frame;
    // SV_TECHNIQUE_SHEAR_WARP: rays a voxel along each side of the plane. 0 is 1; less than 0: as fine as the picture.
    double rays_per_voxel;
    // SV_TECHNIQUE_PATHTRACE: what it traces, under `lights`; or NULL. Matter and lights of `scattering` too.
    const struct sv_path_tracing *paths;
    // sv_scattering, of composites by rays.
    uint32_t scattering;
    // sv_tone: what the light of composites and surfaces goes through on its way into the target.
    uint32_t tone;
    // It is multiplied by 2 to the power of this before, -126 to 126 stops.
    double exposure;
} sv_settings;

// What is drawn over a picture, and what is known of the volume in it.
typedef struct sv_overlay_desc {
    // `sizeof(sv_overlay_desc)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // Pixels across: 1 to 16384.
    uint32_t width;
    // Pixels down.
    uint32_t height;
    // Who looks, as in sv_frame_info.
    const struct sv_camera *camera;
    // Which marks, as `--annotate` of the program has them: "bar,scale,title=Storm". NULL: "bar,time,orientation,scale".
    const char *marks;
    // How many voxels there are along x, y and z: 1 or more of each.
    uint32_t dims[3];
    // Not 0: x of the world points right, y to the front and z to the head of a patient.
    uint32_t is_patient;
    // As in sv_volume_desc. All zero: voxel space is the world.
    double world_from_voxel[16];
    // Whose colours the bar has. 0: there is no bar.
    sv_transfer_function function;
    // What was computed, or NULL, as in sv_renderer_desc: a bar is as opaque as its mode makes values.
    const struct sv_settings *settings;
    // What the values are, or NULL. These four are UTF-8; letters that cannot be drawn are boxes.
    const char *caption;
    // Their unit, or NULL.
    const char *unit;
    // The moment, or NULL: "2005-08-28T12:00:00" is written as a date.
    const char *time;
    // Where the volume is from, or NULL.
    const char *source;
    // Not 0: x of the world points east, y north and z up.
    uint32_t is_earth;
    // Not 0: the values along the bar are spread by their logarithms.
    uint32_t is_logarithmic;
    // Metres of a unit of the world. 0: not known, and there is no unit at the scale.
    double length_metres;
    // How much higher than it is the volume is drawn. 0 is 1.
    double height_factor;
    // Pixels of an em. 0: a fortieth of the height, 11 at least.
    double text_pixels;
    // What lies under the marks, which are light or dark by it: four numbers a pixel, linear light times opacity, rows from
    // the top. NULL: black. It is read before the call returns.
    const float *under;
    // How many numbers there are.
    uint64_t under_count;
    // Not 0: the marks have this colour.
    uint32_t has_color;
    // 0.
    uint32_t reserved;
    // sRGB, 0 to 1.
    double color[3];
} sv_overlay_desc;

// Pictures of one volume in a host's frames. 0 is none.
typedef uint64_t sv_renderer;

// The state of an image at one moment. All zero of `before`: what it holds is given up.
// All zero of `after`: as rendering leaves it, in `VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL`.
typedef struct sv_image_state {
    // `VkImageLayout`.
    uint32_t layout;
    // Not 0: `queue_family` owns the image before or after, and ownership goes from one to the other.
    uint32_t has_queue_family;
    // Bits of `VkPipelineStageFlags2`.
    uint64_t stage;
    // Bits of `VkAccessFlags2`.
    uint64_t access;
    // Of the queues that own the image.
    uint32_t queue_family;
    // 0.
    uint32_t reserved;
} sv_image_state;

// An image of the host's that is drawn into: one level, one layer, one sample.
typedef struct sv_target {
    // `sizeof(sv_target)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // `VkImage`.
    uint64_t image;
    // `VkImageView` of it, 2D.
    uint64_t view;
    // `VkFormat` of the view.
    uint32_t format;
    // Pixels across.
    uint32_t width;
    // Pixels down.
    uint32_t height;
    // Not 0: `clear_color` goes over all of it first.
    uint32_t is_cleared;
    // Red, green, blue and alpha, premultiplied.
    float clear_color[4];
    // How it arrives.
    struct sv_image_state before;
    // How it leaves.
    struct sv_image_state after;
} sv_target;

// Command buffers for frames that the library submits. 0 is none.
typedef uint64_t sv_submitter;

// A timeline semaphore of the host's, and one of its values.
typedef struct sv_timeline_point {
    // `VkSemaphore`, of type timeline.
    uint64_t semaphore;
    // Its value.
    uint64_t value;
} sv_timeline_point;

// When a submission begins and what it reaches.
typedef struct sv_submission {
    // `sizeof(sv_submission)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // `VkQueue`, of the device's family.
    void *queue;
    // Called before the queue is used, or NULL where nobody else uses it. It calls no function of this header.
    void (*lock)(void *user);
    // Called after that; NULL where `lock` is.
    void (*unlock)(void *user);
    // What both are called with.
    void *user;
    // It begins when all of them are reached.
    const struct sv_timeline_point *waits;
    // How many there are.
    uint64_t wait_count;
    // All of them are reached when it is done.
    const struct sv_timeline_point *signals;
    // How many there are.
    uint64_t signal_count;
} sv_submission;

// How long the submissions of a frame, an upload or an update last, and who hears of them.
typedef struct sv_pacing {
    // `sizeof(sv_pacing)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // Milliseconds that a submission shall take. 0 is 100.
    double target_ms;
    // Called after each submission but the last with how much is done, 0 to 1; not 0 ends it. Or NULL.
    // It calls no function of this header.
    uint32_t (*tell)(void *user, double done);
    // What `tell` is called with.
    void *user;
} sv_pacing;

// A volume on a device. 0 is none.
typedef uint64_t sv_volume;

// New voxels on their way into a volume. 0 is none.
typedef uint64_t sv_update;

// What lies under a pixel: where a composite has become half opaque, the first surface, the place of a maximum.
typedef struct sv_pick {
    // `sizeof(sv_pick)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // 0: nothing is there, and all that follows is 0.
    uint32_t is_hit;
    // 0: MIDA and slabs have no value.
    uint32_t has_value;
    // 0: projecting modes have no colour yet, and slices none beside their depth.
    uint32_t has_color;
    // 0.
    uint32_t reserved;
    // World length from where the ray starts.
    double distance;
    // The place in the world.
    double position[3];
    // The projected value, that of the surface, or of the sample that made a composite half opaque; of a map of labels
    // the label.
    double value;
    // Premultiplied colour and alpha.
    float color[4];
} sv_pick;

// Voxels, x fastest, then y, then z. `value = slope stored + intercept`.
typedef struct sv_volume_desc {
    // `sizeof(sv_volume_desc)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // How many there are along x, y and z: 1 or more of each.
    uint32_t dims[3];
    // sv_voxel_type, in the order of bytes of this machine.
    uint32_t voxel_type;
    // The voxels, without gaps. They are copied before the call returns. Floats that are not finite hold no data.
    const void *voxels;
    // Bytes of them.
    uint64_t voxel_bytes;
    // Voxel space, in which voxel (i, j, k) covers [i, i + 1) and so on, to the world: columns of a matrix, the last
    // row of which is (0, 0, 0, 1). All zero: the two are the same.
    double world_from_voxel[16];
    // 0 is 1.
    double slope;
    // Value of a stored 0.
    double intercept;
    // Not 0: stored numbers like `fill` hold no data.
    uint32_t has_fill;
    // What stands where there is no data.
    double fill;
    // The settings of the renderers that will draw it, of which technique, filter, light and empty space count; or
    // NULL.
    const struct sv_settings *settings;
    // Not 0: `value_range` holds all values that the volume has and will get by updates. 0: it is that of the voxels.
    uint32_t has_value_range;
    // 0.
    uint32_t reserved;
    // Smallest and largest value.
    double value_range[2];
} sv_volume_desc;

// What a volume will take.
typedef struct sv_plan {
    // `sizeof(sv_plan)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // Bytes of its textures and of what is known of its empty space, without what the driver pads them by.
    uint64_t device_bytes;
    // Bytes of the buffer that it is staged in until its upload has run.
    uint64_t staging_bytes;
    // Into how many bricks the limits of the device cut it.
    uint64_t bricks;
} sv_plan;

// A depth buffer that rays read: 2D, one level, one layer, one sample, with `VK_IMAGE_USAGE_SAMPLED_BIT`.
typedef struct sv_depth_image {
    // `VkImageView` of its depth aspect.
    uint64_t view;
    // `VkImageLayout` that it is in when a recording runs, visible to sampled reads of compute shaders.
    uint32_t layout;
    // Pixels across.
    uint32_t width;
    // Pixels down.
    uint32_t height;
    // 0.
    uint32_t reserved;
} sv_depth_image;

// What a renderer is made for.
typedef struct sv_renderer_desc {
    // `sizeof(sv_renderer_desc)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // Uploaded, with settings of the same kind.
    sv_volume volume;
    // 0: a ramp of greys over the volume's range.
    sv_transfer_function function;
    // What to compute, or NULL.
    const struct sv_settings *settings;
    // What is drawn into.
    const struct sv_target_class *target;
    // Pixels across.
    uint32_t width;
    // Pixels down.
    uint32_t height;
    // Frames of the host that may be unfinished at once, at most 64. 0 is 1.
    uint32_t frames_in_flight;
    // Not 0: what the host has drawn hides the volume behind it. Cameras are SV_CAMERA_MATRICES then.
    uint32_t has_host_depth;
    // Not 0: sv_renderer_draw_depth will be called, where `target` has a depth attachment (cameras are
    // SV_CAMERA_MATRICES then). sv_renderer_record_pick may be called too.
    uint32_t gives_depth;
    // 0: slices are blended with each other in an image of floats, and the result once into the target. Not 0: one by one
    // in the target, each rounded to its format, which is wrong in targets of few bits; composites from back to front
    // alone, and not in parts.
    uint32_t blends_slices_in_target;
    // With `has_host_depth`: the host's depth, one image for all frames in flight or one for each. Slices that are
    // blended in the target without `gives_depth` are tested against its attachment instead, and have none.
    const struct sv_depth_image *depth_images;
    // How many there are.
    uint64_t depth_image_count;
    // Not 0: sv_renderer_record_pick will be called. Rays that composite keep 16 bytes more for it, a pixel and frame in
    // flight; of slices, rays look for the depth.
    uint32_t picks;
} sv_renderer_desc;

// One thing that a device has or lacks. Texts are UTF-8 that end with a zero.
typedef struct sv_requirement {
    // Its name in the Vulkan specification.
    char name[64];
    // What is wanted of it.
    char wanted[128];
    // What was found; empty where no device was asked.
    char found[128];
    // What it is for.
    char unlocks[256];
    // Not 0: a device that lacks it is refused. 0: it draws less, or slower.
    uint32_t is_required;
    // Not 0: it was found to be enough.
    uint32_t is_met;
} sv_requirement;

// New voxels of a box.
typedef struct sv_update_desc {
    // `sizeof(sv_update_desc)`.
    uint32_t struct_size;
    // NULL.
    const void *next;
    // The first voxel of the box, along x, y and z.
    uint32_t origin[3];
    // How many there are: 1 or more of each.
    uint32_t extent[3];
    // All voxels of the changed volume, of the same type, without gaps. Those of the box are read, and some around it:
    // beside the box nothing has changed.
    const void *voxels;
    // Bytes of them: as many as the volume was made of.
    uint64_t voxel_bytes;
} sv_update_desc;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library's interface: SV_ABI_VERSION of the header that it was built with. Threads: any.
uint32_t sv_abi_version(void);

// Takes a host's device into use. It stays the host's, and only what is made here is destroyed by us.
//
// The handles belong together; by sv_device_destroy, the device has finished everything that was recorded with them.
// Threads: any.
sv_status sv_device_from_host(const struct sv_host_device *host, sv_device *device, struct sv_diagnostic *diagnostic);

// Destroys everything that was made on the device, in the right order, and what waits for sv_device_retire. Handles of
// all of it are stale from now on. The `VkDevice` stays, and has finished all that was recorded here, or is lost.
// Threads: no other call on the device or on what is made on it.
sv_status sv_device_destroy(sv_device device, struct sv_diagnostic *diagnostic);

// Says that what is recorded from now on is done when the host's count of submissions (or its timeline) reaches
// `value`. What is destroyed later waits for it. Values only rise. Threads: any.
sv_status sv_device_announce(sv_device device, uint64_t value, struct sv_diagnostic *diagnostic);

// Frees what was destroyed and waited for `completed` or less. The device has finished all that was recorded under
// announced values up to it. Threads: any.
sv_status sv_device_retire(sv_device device, uint64_t completed, struct sv_diagnostic *diagnostic);

// How much memory the library uses on the device. Threads: any.
sv_status sv_device_memory(sv_device device, struct sv_memory *memory, struct sv_diagnostic *diagnostic);

// Takes no more memory from the driver than so many bytes from now on: what would is SV_E_LIMIT, before the driver is
// asked. 0: no budget. Threads: any.
sv_status sv_device_set_memory_budget(sv_device device, uint64_t bytes, struct sv_diagnostic *diagnostic);

// The host has heard that its device is lost, as it submits and waits itself: from now on every call for work is
// SV_E_DEVICE_LOST, and nothing calls the device but what destroys. `device_lost` is not called for it. Threads: any.
sv_status sv_device_declare_lost(sv_device device, struct sv_diagnostic *diagnostic);

// How many pipelines were made so far: after the last sv_renderer_create it stays. Threads: any.
sv_status sv_device_pipelines_made(sv_device device, uint32_t *count, struct sv_diagnostic *diagnostic);

// What the driver has compiled so far, for sv_host_device of a later run. With `data` NULL, `bytes` is set to what
// there is; else as many bytes are written, where `bytes` says that there is room for them. Threads: any.
sv_status sv_device_pipeline_cache(sv_device device, uint64_t *bytes, void *data, struct sv_diagnostic *diagnostic);

// Takes control points in. Nothing of it lies on the device. Threads: any.
sv_status sv_transfer_function_create(sv_device device,
                                      const struct sv_transfer_function_desc *desc,
                                      sv_transfer_function *function,
                                      struct sv_diagnostic *diagnostic);

// Destroys it. Renderers that were made with it have a copy. Threads: any.
sv_status sv_transfer_function_destroy(sv_transfer_function function, struct sv_diagnostic *diagnostic);

// Makes buffers, pipelines and all else that draws will need. Threads: any.
sv_status sv_geometry_create(sv_device device,
                             const struct sv_geometry_desc *desc,
                             sv_geometry *geometry,
                             struct sv_diagnostic *diagnostic);

// Records the upload, once. What it is staged in is freed by sv_device_retire, if sv_device_announce came before.
//
// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, and is submitted before what draws the geometry.
// Threads: one at a time for one geometry.
sv_status sv_geometry_record_upload(sv_geometry geometry,
                                    void *command_buffer,
                                    struct sv_diagnostic *diagnostic);

// Draws all of it where it is not behind what the host has drawn so far, and writes its depth: volumes whose renderers read
// that depth (`has_host_depth`) end there. Its camera is of SV_CAMERA_MATRICES. Bound pipeline, descriptor set 0, viewport and
// scissor are ours afterwards.
//
// `command_buffer` is inside rendering to a target of the geometry's class, of so many pixels, after
// sv_geometry_record_upload; depth may be written. Nothing unfinished was drawn with the same `frame` of `shot`.
// Threads: one at a time for one geometry.
sv_status sv_geometry_draw(sv_geometry geometry,
                           void *command_buffer,
                           const struct sv_frame_info *shot,
                           uint32_t width,
                           uint32_t height,
                           struct sv_diagnostic *diagnostic);

// Destroys the handle; what frames in flight use is freed by sv_device_retire. Threads: any.
sv_status sv_geometry_destroy(sv_geometry geometry, struct sv_diagnostic *diagnostic);

// Follows lines of a field: by steps no longer than a cell, in 64-bit floats, one line a seed in their order, by all
// cores of the machine. Nothing is done on the device, which keeps the lines among its handles. Threads: any.
sv_status sv_trace(sv_device device,
                   const struct sv_trace_desc *desc,
                   sv_lines *lines,
                   struct sv_diagnostic *diagnostic);

// How many lines there are, one a seed; one that begins where there is no velocity has no vertices. Threads: any.
sv_status sv_lines_count(sv_lines lines, uint64_t *count, struct sv_diagnostic *diagnostic);

// The places of the vertices of one line along the velocity, three doubles each. `count` is for how many there is room at
// `positions`, and becomes how many there are; with NULL that alone is told. Threads: any.
sv_status sv_lines_positions(sv_lines lines,
                             uint64_t line,
                             double *positions,
                             uint64_t *count,
                             struct sv_diagnostic *diagnostic);

// The time and the speed at the vertices of one line: two doubles each. Of a stream line the time since the seed, negative
// before it; of a path that of the particle; of a streak when the particle left. As sv_lines_positions.
sv_status sv_lines_values(sv_lines lines,
                          uint64_t line,
                          double *values,
                          uint64_t *count,
                          struct sv_diagnostic *diagnostic);

// The numbers of those vertices of one line, counted from 0, that no piece of the line leads to: of a streak between whose
// particles others are gone. As sv_lines_positions, one number each.
sv_status sv_lines_breaks(sv_lines lines,
                          uint64_t line,
                          uint64_t *breaks,
                          uint64_t *count,
                          struct sv_diagnostic *diagnostic);

// Why a line begins where it does, and why it ends: two numbers of sv_cause. Threads: any.
sv_status sv_lines_cause(sv_lines lines, uint64_t line, uint32_t *causes, struct sv_diagnostic *diagnostic);

// Forgets the lines. Threads: any.
sv_status sv_lines_destroy(sv_lines lines, struct sv_diagnostic *diagnostic);

// Draws words and marks as pixels of their own: linear light times opacity, four numbers each, rows from the top, to be laid over
// the picture (`over + (1 - opacity) under`). `count` numbers have room at `pixels`: 4 times width times height.
// Edges of a box that lie behind the volume are left out. Nothing is done on the device. Threads: any.
sv_status sv_overlay_rgba(sv_device device,
                          const struct sv_overlay_desc *desc,
                          float *pixels,
                          uint64_t count,
                          struct sv_diagnostic *diagnostic);

// Begins a frame that is recorded in parts, and tells how many pieces it has: blocks of 64 x 64 pixels, smaller where
// those are thought to take long, slices of half-angle slicing, and what a new function has to be found empty. What
// else is recorded for the frame, another function, volume or size, and an update of the volume, ends it. Threads: one
// at a time for one renderer.
sv_status sv_renderer_begin_parts(sv_renderer renderer,
                                  const struct sv_frame_info *shot,
                                  uint64_t *pieces,
                                  struct sv_diagnostic *diagnostic);

// Level B in parts: records the next `count` pieces, one at least, and tells how many are left. The same `target` each
// time.
//
// Rays, and slices in other modes than composite, touch the target with the last part alone. Composites by slices draw
// each part into it, and leave it in its state `after`. As sv_renderer_record_into; parts are submitted in their order
// to one queue.
sv_status sv_renderer_record_part_into(sv_renderer renderer,
                                       void *command_buffer,
                                       uint32_t frame,
                                       uint64_t count,
                                       const struct sv_target *target,
                                       uint64_t *left,
                                       struct sv_diagnostic *diagnostic);

// Level C in parts: as sv_submitter_submit, in as many submissions as it takes for each to last no longer than
// `pacing` says (NULL: 100 ms). Between them it waits for the device, for the host's `waits` too. `is_done` is set to
// 0 where the host ended the frame: none of the signals will be reached then, and the target is as
// sv_renderer_record_part_into says. Threads: one at a time for one submitter and for one renderer.
sv_status sv_submitter_submit_in_parts(sv_submitter submitter,
                                       sv_renderer renderer,
                                       const struct sv_frame_info *shot,
                                       const struct sv_target *target,
                                       const struct sv_submission *submission,
                                       const struct sv_pacing *pacing,
                                       uint32_t *is_done,
                                       struct sv_diagnostic *diagnostic);

// sv_submitter_upload in as many submissions as it takes for each to last no longer than `pacing` says (NULL: 100 ms).
// Between them it waits for the device, for the host's `waits` too. `is_done` is set to 0 where the host ended it:
// none of the signals will be reached then, and the rest of the upload is still to be recorded. As
// sv_submitter_submit_in_parts.
sv_status sv_submitter_upload_in_parts(sv_submitter submitter,
                                       sv_volume volume,
                                       uint32_t frame,
                                       const struct sv_submission *submission,
                                       const struct sv_pacing *pacing,
                                       uint32_t *is_done,
                                       struct sv_diagnostic *diagnostic);

// sv_volume_record_update in submissions of the library's own, in parts. `is_done` is set to 0 where the host ended
// it: none of the signals will be reached then, and the rest of the update is still to be recorded. As
// sv_submitter_upload_in_parts.
sv_status sv_submitter_update_in_parts(sv_submitter submitter,
                                       sv_volume volume,
                                       sv_update update,
                                       uint32_t frame,
                                       const struct sv_submission *submission,
                                       const struct sv_pacing *pacing,
                                       uint32_t *is_done,
                                       struct sv_diagnostic *diagnostic);

// Of how many paths a pixel the picture of the last recorded frame is the mean (SV_TECHNIQUE_PATHTRACE). Another camera,
// function, volume, size or settings, and an update of the volume begin anew.
// Threads: one at a time for one renderer.
sv_status sv_renderer_paths_traced(sv_renderer renderer,
                                   uint32_t *paths,
                                   struct sv_diagnostic *diagnostic);

// How noisy that picture was `frames_in_flight` frames before: the root of the sum of the variances of its pixels' luminances
// over that of their squares. It halves with four times as many paths, and nothing waits for it. SV_E_STATE while nothing is
// known: of the first frames, and of a picture that has begun anew. Threads: one at a time for one renderer.
sv_status sv_renderer_noise(sv_renderer renderer,
                            double *noise,
                            struct sv_diagnostic *diagnostic);

// The next frame begins with the first path: where what the host has drawn has moved before the volume, and where a frame
// that was recorded will not be submitted. Threads: one at a time for one renderer.
sv_status sv_renderer_restart_paths(sv_renderer renderer,
                                    struct sv_diagnostic *diagnostic);

// Records the copy of what lies under a pixel, for sv_renderer_pick when the frame is done.
// As sv_renderer_record, after it.
sv_status sv_renderer_record_pick(sv_renderer renderer,
                                  void *command_buffer,
                                  uint32_t frame,
                                  uint32_t x,
                                  uint32_t y,
                                  struct sv_diagnostic *diagnostic);

// What lay under a pixel of a frame that is done, for which sv_renderer_record_pick was recorded with the same pixel.
// Threads: one at a time for one renderer.
sv_status sv_renderer_pick(sv_renderer renderer,
                           uint32_t frame,
                           uint32_t x,
                           uint32_t y,
                           struct sv_pick *pick,
                           struct sv_diagnostic *diagnostic);

// What a volume will take: of `desc`, `dims`, `voxel_type`, `has_fill` (there will be holes) and `settings` count, and
// `voxels` may be NULL. Threads: any.
sv_status sv_volume_plan(sv_device device,
                         const struct sv_volume_desc *desc,
                         struct sv_plan *plan,
                         struct sv_diagnostic *diagnostic);

// Level A, first half: records all of a frame that lies outside of the host's rendering. It submits nothing, waits for
// nothing and makes no Vulkan object.
//
// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, for a queue of the device's family, and is
// submitted in the order in which it was recorded. Depth images are in the layout that was said.
// Threads: one at a time for one renderer; others beside it.
sv_status sv_renderer_record(sv_renderer renderer,
                             void *command_buffer,
                             const struct sv_frame_info *shot,
                             struct sv_diagnostic *diagnostic);

// Level A, second half: draws what was recorded for `frame` over what the host has drawn. Bound pipeline, descriptor
// set 0, viewport and scissor are ours afterwards.
//
// `command_buffer` is inside rendering to a target of the renderer's class and size, after sv_renderer_record.
// Threads: one at a time for one renderer.
sv_status sv_renderer_draw(sv_renderer renderer,
                           void *command_buffer,
                           uint32_t frame,
                           struct sv_diagnostic *diagnostic);

// Writes the depth of a picture into the depth attachment, where it is nearer than what is there. Of composites it is
// where they become half opaque. As sv_renderer_draw, and depth may be written; wants `gives_depth`.
sv_status sv_renderer_draw_depth(sv_renderer renderer,
                                 void *command_buffer,
                                 uint32_t frame,
                                 struct sv_diagnostic *diagnostic);

// Level B: sv_renderer_record and sv_renderer_draw into an image that arrives and leaves as `target` says.
// As sv_renderer_record; the image lives until `command_buffer` has run.
sv_status sv_renderer_record_into(sv_renderer renderer,
                                  void *command_buffer,
                                  const struct sv_frame_info *shot,
                                  const struct sv_target *target,
                                  struct sv_diagnostic *diagnostic);

// Makes all that frames of that size will need: nothing is compiled later.
// Threads: any; several at once make several renderers.
sv_status sv_renderer_create(sv_device device,
                             const struct sv_renderer_desc *desc,
                             sv_renderer *renderer,
                             struct sv_diagnostic *diagnostic);

// Frames of another size, or with other depth images, from now on. Nothing waits; what frames in flight use is freed
// by sv_device_retire. Threads: one at a time for one renderer.
sv_status sv_renderer_resize(sv_renderer renderer,
                             uint32_t width,
                             uint32_t height,
                             const struct sv_depth_image *depth_images,
                             uint64_t depth_image_count,
                             struct sv_diagnostic *diagnostic);

// Another transfer function from the next recording on; 0 is the ramp of greys. It may be called each frame: nothing
// is compiled, nothing waits. Threads: one at a time for one renderer.
sv_status sv_renderer_set_transfer_function(sv_renderer renderer,
                                            sv_transfer_function function,
                                            struct sv_diagnostic *diagnostic);

// Other numbers in the settings from the next recording on: steps, crops, planes, levels, lights. What needs other
// pipelines is refused. Threads: one at a time for one renderer.
sv_status sv_renderer_set_settings(sv_renderer renderer,
                                   const struct sv_settings *settings,
                                   struct sv_diagnostic *diagnostic);

// Another volume of the same size and kind from the next recording on: the next time of a series. It is uploaded, or
// its upload is recorded. Threads: one at a time for one renderer.
sv_status sv_renderer_set_volume(sv_renderer renderer,
                                 sv_volume volume,
                                 sv_transfer_function function,
                                 struct sv_diagnostic *diagnostic);

// Destroys the handle; what frames in flight use is freed by sv_device_retire. Threads: any.
sv_status sv_renderer_destroy(sv_renderer renderer, struct sv_diagnostic *diagnostic);

// All that is required and recommended, before there is a device. With `requirements` NULL, `count` is set to how many
// there are; else as many are written, where `count` says that there is room for them. Threads: any.
sv_status sv_requirements(struct sv_requirement *requirements, uint64_t *count, struct sv_diagnostic *diagnostic);

// The same, and what a physical device has of it: `instance`, `physical_device` and `get_instance_proc_addr` of `host`
// are asked, and `device`, which may be NULL, is not. Where it is not NULL, `features` are those enabled; else those
// that the device supports count. A version that is too old is all that is told of a device. Threads: any.
sv_status sv_check_device(const struct sv_host_device *host,
                          struct sv_requirement *requirements,
                          uint64_t *count,
                          struct sv_diagnostic *diagnostic);

// Command buffers for so many frames in flight, at most 64. Wants SV_FEATURE_TIMELINE_SEMAPHORE. Threads: any.
sv_status sv_submitter_create(sv_device device,
                              uint32_t frames_in_flight,
                              sv_submitter *submitter,
                              struct sv_diagnostic *diagnostic);

// Level C: sv_renderer_record_into in a submission of the library's own. Nothing waits on the CPU but for `lock`.
//
// The submission before with the shot's number of a frame is done. Semaphores live until this one is done.
// Threads: one at a time for one submitter and for one renderer.
sv_status sv_submitter_submit(sv_submitter submitter,
                              sv_renderer renderer,
                              const struct sv_frame_info *shot,
                              const struct sv_target *target,
                              const struct sv_submission *submission,
                              struct sv_diagnostic *diagnostic);

// sv_volume_record_upload in a submission of the library's own, as number `frame` of the frames in flight.
// As sv_submitter_submit.
sv_status sv_submitter_upload(sv_submitter submitter,
                              sv_volume volume,
                              uint32_t frame,
                              const struct sv_submission *submission,
                              struct sv_diagnostic *diagnostic);

// Destroys the handle; what it has submitted is done, or is waited for by sv_device_retire. Threads: any.
sv_status sv_submitter_destroy(sv_submitter submitter, struct sv_diagnostic *diagnostic);

// Stages new voxels of a box of a volume that was uploaded: a copy of them, where the recording finds it. Their values
// lie in the volume's `value_range`; where it was made without holes they have none; filters that read coefficients of
// a spline are SV_E_UNSUPPORTED. Threads: any.
sv_status sv_volume_stage_update(sv_volume volume,
                                 const struct sv_update_desc *desc,
                                 sv_update *update,
                                 struct sv_diagnostic *diagnostic);

// Records an update between the frames that were recorded before, which show the old voxels, and those recorded later,
// which show the new ones. Updates of one volume are recorded as they were staged: SV_E_STATE where another comes
// first, or was destroyed, and this was staged after it. The handle of one that is recorded is used up; what it is
// staged in is freed by sv_device_retire, if sv_device_announce came before.
//
// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, and is submitted to the queue that draws the
// volume, in the order of recording. Threads: any, one at a time for one volume.
sv_status sv_volume_record_update(sv_volume volume,
                                  void *command_buffer,
                                  sv_update update,
                                  struct sv_diagnostic *diagnostic);

// Records the next `count` pieces of an update, one at least and none of them long, and tells how many are left. Where
// there are none, the handle is used up. Until then the volume is not drawn (SV_E_STATE); where the update is
// destroyed before, that lasts until another one is recorded that changes all of its voxels. As
// sv_volume_record_update, of all parts, which are submitted in their order.
sv_status sv_volume_record_update_part(sv_volume volume,
                                       void *command_buffer,
                                       sv_update update,
                                       uint64_t count,
                                       uint64_t *left,
                                       struct sv_diagnostic *diagnostic);

// Destroys the handle of an update that is not recorded: those that were staged after it will not be recorded any
// more, for they were staged from voxels that hold these. Threads: any.
sv_status sv_update_destroy(sv_update update, struct sv_diagnostic *diagnostic);

// Makes textures for voxels, which are copied to where the upload finds them. Threads: any.
sv_status sv_volume_create(sv_device device,
                           const struct sv_volume_desc *desc,
                           sv_volume *volume,
                           struct sv_diagnostic *diagnostic);

// Records the upload, once, before anything is made that draws the volume. What it is staged in is freed by
// sv_device_retire, if sv_device_announce came before.
//
// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, and is submitted before what draws the volume.
// Threads: any, one at a time for one volume.
sv_status sv_volume_record_upload(sv_volume volume, void *command_buffer, struct sv_diagnostic *diagnostic);

// Records the next `count` pieces of the upload, one at least and none of them long, and tells how many are left.
// Where there are none, the volume is uploaded. As sv_volume_record_upload, of all parts, which are submitted in their
// order.
sv_status sv_volume_record_upload_part(sv_volume volume,
                                       void *command_buffer,
                                       uint64_t count,
                                       uint64_t *left,
                                       struct sv_diagnostic *diagnostic);

// The smallest and the largest value that is no hole: two doubles. Threads: any.
sv_status sv_volume_value_range(sv_volume volume, double *range, struct sv_diagnostic *diagnostic);

// Destroys the handle. Renderers that draw the volume keep it; else it waits for sv_device_retire. Threads: any.
sv_status sv_volume_destroy(sv_volume volume, struct sv_diagnostic *diagnostic);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* STRATAVOX_H */

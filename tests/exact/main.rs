//! Pictures against exact answers: closed forms, and the CPU reference that says what each shader computes.
#![cfg(feature = "conformance")]

#[path = "../driver_faults/mod.rs"]
mod driver_faults;
#[path = "../embed_shared/mod.rs"]
mod embed_shared;
#[path = "../shared/mod.rs"]
mod shared;
#[path = "../skipping_shared/mod.rs"]
mod skipping_shared;

mod adaptive_steps;
mod codes;
mod corners;
mod cover;
mod cuts;
mod denoise;
mod emission;
mod extremes;
mod fast_path;
mod field;
mod filters;
mod formats;
mod geometry;
mod gradient;
mod half_angle;
mod light;
mod lit_slabs;
mod long_rays;
mod macro_cells;
mod main_axis;
mod maximum;
mod mixtures;
mod modes_along_rays;
mod mutants;
mod normals;
mod occlusion;
mod pathtrace;
mod quality;
mod references;
mod scattering;
mod shapes;
mod shear_warp;
mod slabs;
mod slabs_references;
mod smooth_stacks;
mod splat;
mod surfaces;
mod widgets;

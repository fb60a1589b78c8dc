//! What needs no device: readers and writers of files, and arithmetic.

#[cfg(feature = "files")]
#[path = "../shared/dicom.rs"]
mod dicom;
#[cfg(feature = "files")]
#[path = "../shared/encode.rs"]
mod encode;
#[cfg(feature = "files")]
#[path = "../shared/files.rs"]
mod files;
#[cfg(feature = "files")]
#[path = "../shared/fixtures.rs"]
mod fixtures;
#[cfg(feature = "files")]
#[path = "../shared/memory.rs"]
mod memory;
#[cfg(feature = "files")]
#[path = "../shared/mutate.rs"]
mod mutate;
#[cfg(all(feature = "files", feature = "netcdf"))]
#[path = "../shared/netcdf.rs"]
mod netcdf;
#[cfg(feature = "files")]
#[path = "../shared/nifti.rs"]
mod nifti;
#[cfg(all(feature = "png", feature = "exr"))]
#[path = "../picture_shared/mod.rs"]
mod picture_shared;
#[cfg(all(feature = "files", feature = "json"))]
#[path = "../shared/shapefile.rs"]
mod shapefile;
#[cfg(feature = "files")]
#[path = "../shared/survive.rs"]
mod survive;
#[cfg(feature = "files")]
#[path = "../shared/sweep.rs"]
mod sweep;
#[cfg(feature = "files")]
#[path = "../shared/tiff.rs"]
mod tiff;
#[path = "../transfer_shared/mod.rs"]
mod transfer_shared;
#[cfg(feature = "files")]
#[path = "../shared/truth.rs"]
mod truth;
#[cfg(feature = "files")]
#[path = "../shared/vtk.rs"]
mod vtk;
#[cfg(feature = "files")]
#[path = "../shared/zarr.rs"]
mod zarr;

mod cf_derived;
mod cf_wrf;
#[cfg(unix)]
mod ci_group;
mod colour_blind;
#[cfg(feature = "conformance")]
mod conformance_package;
mod dependencies;
mod floors;
mod format_bricks;
mod format_bricks_resumed;
#[cfg(all(feature = "files", feature = "netcdf", feature = "grib"))]
mod format_cuts;
mod format_dicom;
mod format_dicom_fixtures;
mod format_dicom_places;
#[cfg(feature = "dicom")]
mod format_dicom_refused;
mod format_dicom_values;
mod format_escapes;
#[cfg(all(
    feature = "files",
    feature = "json",
    feature = "netcdf",
    feature = "grib"
))]
mod format_fields;
#[cfg(all(feature = "files", feature = "json"))]
mod format_geographic;
#[cfg(feature = "files")]
mod format_grib;
mod format_hdf5;
mod format_hostile;
mod format_meaning;
#[cfg(feature = "files")]
mod format_mesh;
mod format_metaimage;
mod format_metaimage_refused;
mod format_netcdf;
mod format_nifti;
mod format_nifti_place;
mod format_nifti_refused;
mod format_npy;
mod format_nrrd;
mod format_nrrd_meaning;
mod format_nrrd_refused;
mod format_points;
mod format_raw;
mod format_sampled;
mod format_tiff;
#[cfg(feature = "tiff")]
mod format_tiff_refused;
mod format_vti;
mod format_vti_refused;
mod format_vtk;
mod format_weather;
mod format_zarr;
#[cfg(feature = "zarr")]
mod format_zarr_mutations;
mod format_zarr_ngff;
#[cfg(feature = "zarr")]
mod format_zarr_refused;
mod full_voxels;
mod isosurface;
#[cfg(feature = "files")]
mod mutations;
#[cfg(feature = "dicom")]
mod mutations_dicom;
mod no_contraction;
#[cfg(feature = "phantoms")]
mod phantoms;
mod picture_compare;
mod picture_files;
mod picture_hostile;
mod picture_output;
mod points_field;
mod points_interpolate;
mod public_api;
mod shader_constants;
mod shader_modules;
mod short_circuit;
mod spirv_words;
mod transfer_choice;
mod transfer_file;
mod transfer_import;
mod transfer_law;
mod transfer_materials;
mod transfer_widgets;
mod vocabulary;
mod volume_along;
mod volume_filters;
mod volume_joint;
mod volume_mixtures;
mod volume_octree;
#[cfg(feature = "phantoms")]
mod volume_read;
mod volume_reduce;
mod volume_runs;
mod volume_sample;
mod volume_statistics;
mod voxel_sets;
mod weather;

#[cfg(feature = "files")]
#[global_allocator]
static MEMORY: memory::Counting = memory::Counting;

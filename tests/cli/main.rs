//! The program as a person meets it: words, exit codes, files.
#![cfg(feature = "cli")]

#[path = "../shared/dicom.rs"]
mod dicom;
#[path = "../shared/files.rs"]
mod files;
#[path = "../shared/netcdf.rs"]
mod netcdf;
#[path = "../shared/shapefile.rs"]
mod shapefile;

mod animate;
#[cfg(target_os = "linux")]
mod animate_faults;
mod animate_films;
mod animate_look;
mod animate_mixed;
#[cfg(unix)]
mod animate_stops;
mod annotate;
mod annotate_private;
mod barbs;
mod bench;
mod classified;
mod coast;
mod comets;
mod conformance;
mod conformance_clamped;
mod conformance_runs;
mod convert;
mod convert_lengths;
mod convert_refused;
mod convert_stops;
mod device;
mod errors;
mod examples;
mod figures;
mod flow;
mod flow_drawn;
mod flow_sections;
mod flow_styles;
mod ground;
mod info;
mod info_structure;
#[cfg(unix)]
mod interrupt;
mod kept_samples;
mod large;
mod left_out;
mod levels_of_wind;
mod look;
mod look_frame;
mod manuals;
mod memory;
mod messages;
mod messages_inputs;
mod messages_scattering;
mod mixed;
mod moved_pole;
mod opacity;
mod pairs;
mod paths;
mod person;
mod pictures;
mod point_field;
mod point_grid;
mod points;
mod presets;
mod real;
mod sampled;
mod scattering;
mod scenes;
mod section;
mod section_at;
mod sheet;
mod spheres;
mod thumbnail_views;
mod thumbnails;
mod thumbnails_at_once;
mod untrusted;
mod view;
mod weather;
mod weather_derived;
mod widgets;
mod with;
mod with_shapes;
mod words;

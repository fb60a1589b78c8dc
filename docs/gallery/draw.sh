#!/bin/sh
# Draws docs/gallery/*.png: stratavox and the folder of the volumes are its words. `make gallery` calls it.
set -eu
program=$1
volumes=$2
here=$(dirname "$0")
draw() {
    name=$1
    input=$2
    shift 2
    "$program" render "$volumes/$input" --size 400x400 --force --progress none -o "$here/$name.png" "$@"
}
draw skull ct-cranium/cranium.nrrd --preset boundaries --shading phong --filter cubic --samples-per-voxel 2 \
    --azimuth -60 --zoom 1.5
draw torso ct-torso/torso-2x.mha --tf "$here/torso.json" --shading phong --crop 45,211,20,180,0,137 \
    --azimuth -75 --elevation 10 --zoom 1.3
draw brain mri-brainsmall/brainsmall.nhdr --tf "$here/brain.json" --shading phong --material 0.6,0.4,0.1,10 \
    --ambient-occlusion 1 --samples-per-voxel 2 --azimuth 240 --elevation 20 --zoom 2
draw walnut ct-walnut/walnut.mhd --shading phong --material 0.3,0.6,0.1,10 --light 1,-0.5,0.7 --shadows volume \
    --azimuth 200 --elevation 40 --zoom 1.2
draw nuclei tiff-nuclei/img3d.tif --mode mida --samples-per-voxel 2 --zoom 1.1
wrf="$volumes/met-wrf/wrf_ci.nc"
"$program" render "$wrf" --show both --size 900x600 --force --progress none -o "$here/weather.png"
"$program" render "$wrf" --show vapor --size 600x450 --force --progress none -o "$here/weather-vapor.png"
"$program" render "$wrf" --show wind --size 600x450 --force --progress none -o "$here/weather-wind.png"
"$program" animate "$wrf" --show vapor --between 7 --fps 8 --size 400x300 --force --progress none -o "$here/weather-day.gif"
draw pet dicom-pet --mode mip --denoise nlm --view anterior --zoom 1.3
# Two people: the heart of the second is moved into the chest of the first.
draw ct-pet ct-torso/torso-2x.mha --with "$volumes/dicom-pet,preset=pet,shift=10:-344:80" --view anterior

# Shells of a few voxels at 45 degrees, where stacks switch: classic and cured, by each technique.
at_45() {
    name=$1
    shift
    "$program" render phantom:shells,n=64 --look plain --preset grey --azimuth 45 --elevation 12 --zoom 1.7 --size 240x240 --force \
        --progress none -o "$here/45-$name.png" "$@"
}
at_45 slices --technique slices-2d
at_45 slices-cured --technique slices-2d --smooth --preintegrated
at_45 shear-warp --technique shear-warp
at_45 shear-warp-cured --technique shear-warp --preintegrated --intermediate 2
at_45 splats --technique splat --sheets axis
at_45 splats-cured --technique splat
at_45 bresenham --lattice bresenham
at_45 bresenham-cured --lattice bresenham --samples-per-voxel 4

# By path tracing, with the flags of a look.
cinematic() {
    name=$1
    input=$2
    shift 2
    "$program" render "$volumes/$input" --look cinematic --spp 32 --size 360x360 --force --progress none \
        -o "$here/cinematic-$name.png" "$@"
}
cinematic skull ct-cranium/cranium.nrrd
cinematic torso ct-torso/torso-2x.mha --preset ct-bone --azimuth 20
cinematic brain mri-mni152/mni152-t1.nii.gz
cinematic walnut ct-walnut/walnut.mhd --tf "$here/walnut-cinematic.json" --crop 0,128,23,96,0,114
cinematic nuclei tiff-nuclei/img3d.tif
cinematic seismic seismic-f3/f3.nrrd

# One cloud, by ever more of what light does in it.
ladder() {
    name=$1
    shift
    "$program" render phantom:storm,n=64 --variable cloud --time 4 --tf "$here/storm.json" --tone neutral --exposure 0.5 \
        --background 0.1,0.14,0.22 --size 300x180 --force --progress none -o "$here/ladder-$name.png" "$@"
}
sun="--light camera:-0.7,0.7,0.1 --environment 0.06,0.09,0.15"
traced="--technique pathtrace --spp 64 --denoise-picture"
ladder emission --shading none
ladder single --scattering single $sun
ladder 2 $traced $sun --bounces 2
ladder 4 $traced $sun --bounces 4
ladder 16 $traced $sun --bounces 16
ladder all $traced $sun

"""Are the cinematic pictures of draw.sh well exposed?

    python3 brightness.py PROGRAM VOLUMES

Draws each once more, 128 x 128 pixels with 8 paths, as linear light (npy, premultiplied), takes the stop of light of the look,
and writes a table. Of pixels that let less than half of what lies behind through: Y is .2126 R + .7152 G + .0722 B.

    mean       sum of Y / sum of alpha, over all pixels of alpha over .02
    over 1     part of the pixels with a channel over 1, before the curve of tones
    spike      the largest Y over the 99.9th percentile
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
EXPOSURE = 1.0
PICTURES = {
    "skull": ["ct-cranium/cranium.nrrd"],
    "torso": ["ct-torso/torso-2x.mha", "--preset", "ct-bone", "--azimuth", "20"],
    "brain": ["mri-mni152/mni152-t1.nii.gz"],
    "walnut": ["ct-walnut/walnut.mhd", "--tf", str(HERE / "walnut-cinematic.json"), "--crop", "0,128,23,96,0,114"],
    "nuclei": ["tiff-nuclei/img3d.tif"],
    "seismic": ["seismic-f3/f3.nrrd"],
}


def drawn(program, volumes, words):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.npy"
        of_look = ["--look", "cinematic", "--spp", "8", "--size", "128x128", "--progress", "none"]
        command = [program, "render", str(Path(volumes) / words[0]), *of_look, *words[1:], "-o", str(path)]
        subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
        return np.load(path).astype(float)


def main():
    program, volumes = sys.argv[1:]
    print("| picture | mean | over 1, % | spike |\n|---|---|---|---|")
    for name, words in PICTURES.items():
        pixels = drawn(program, volumes, words)
        light = 2**EXPOSURE * pixels[..., :3]
        luminance = light @ np.array([0.2126, 0.7152, 0.0722])
        alpha = pixels[..., 3]
        seen, dense = alpha > 0.02, alpha > 0.5
        mean = luminance[seen].sum() / alpha[seen].sum()
        over = 100 * (light.max(axis=-1)[dense] > 1).mean()
        spike = luminance[dense].max() / np.percentile(luminance[dense], 99.9)
        print(f"| {name} | {mean:.2f} | {over:.2f} | {spike:.2f} |")


if __name__ == "__main__":
    main()

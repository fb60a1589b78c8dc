"""How far pictures of so many paths are from one of many, with their noise and without.

    python docs/pathtrace/convergence.py target/release/stratavox FOLDER_OF_VOLUMES FOLDER_FOR_PICTURES

Of each scene pictures of 96 x 96 pixels with other random numbers than the reference, which has 1024 paths a pixel. Prints
rows of a table, of luminance y:

    error       sqrt(sum (y - y_r)^2 - sum v_r) / sqrt(sum y_r^2), v_r the variance of the reference's pixels by its layer `noise`
    slope       log2(error / error before) / log2(paths / paths before): -1/2 of independent paths
    told        what --aov noise says that the error is
    taken out   the error with --denoise-picture
    worth       as many paths would have this error, by the slope -1/2

Needs numpy; takes some minutes.
"""

import subprocess
import sys
from math import log, sqrt
from pathlib import Path

import numpy as np

PROGRAM, VOLUMES, OUT = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
SIZE, PATHS, DENOISED, REFERENCE = "96x96", [4, 16, 64, 256], [4, 16, 64], 1024
LOOK = (
    "--technique pathtrace --surface-scattering 8 --environment 0.35,0.35,0.35 --density-scale 0.5 --f0 0.04"
    " --light camera:-0.54,0.64,0.54 --light-size 40 --keep-all"
).split()
SCENES = {
    "a head of ellipsoids (`phantom:head,n=64`)": ["phantom:head,n=64", *LOOK],
    "a skull (CT, `ct-cranium`)": [VOLUMES / "ct-cranium" / "cranium.nrrd", "--preset", "ct-bone", *LOOK],
    "fog (`phantom:fog,n=32`)": "phantom:fog,n=32 --technique pathtrace --phase hg:0.6 --light 1,-1,2 --environment 0.3,0.4,0.6".split(),
}


def drawn(words, paths, seed, *more):
    """Luminance, and its standard error."""
    name = OUT / "picture.npy"
    words = [PROGRAM, "render", *words, "--spp", str(paths), "--seed", str(seed), "--size", SIZE, "--aov", "noise", *more]
    subprocess.run([*map(str, words), "-o", str(name), "--force"], check=True, capture_output=True)
    picture = np.load(name).astype(float)
    return picture[..., :3] @ [0.2126, 0.7152, 0.0722], np.load(OUT / "picture.noise.npy").astype(float).reshape(picture.shape[:2])


def number(x):
    return f"{x:.3f}".lstrip("0")


for name, words in SCENES.items():
    truth, of_truth = drawn(words, REFERENCE, 1)

    def error(y):
        return sqrt(max(((y - truth) ** 2).sum() - (of_truth**2).sum(), 0) / (truth**2).sum())

    print(f"{name}\n\n| paths | error | slope | told | taken out | worth paths |\n|---|---|---|---|---|---|", flush=True)
    before = None
    for paths in PATHS:
        y, noise = drawn(words, paths, 2)
        own, told = error(y), sqrt((noise**2).sum() / (truth**2).sum())
        slope = number(log(own / before[0]) / log(paths / before[1])).replace("-0", "-") if before else ""
        without = error(drawn(words, paths, 2, "--denoise-picture")[0]) if paths in DENOISED else None
        worth = f"{paths * (own / without) ** 2:.0f}" if without else ""
        print(f"| {paths} | {number(own)} | {slope} | {number(told)} | {number(without) if without else ''} | {worth} |", flush=True)
        before = own, paths
    print()

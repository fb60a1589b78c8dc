"""Draws five scenes with stratavox and with Mitsuba 3 (3.9.1, `pip install mitsuba`), and says whether they are the same.

    python docs/pathtrace/beside_mitsuba.py target/release/stratavox FOLDER_OF_VOLUMES FOLDER_FOR_PICTURES [VARIANT [PICTURES]]

Both have the same matter (extinctions at the centres of voxels, linear between them, the outer ones to the faces), the same
phase function, lights and parallel rays. Of each scene 16 pictures of other random numbers, so that each pixel has a mean
and the variance of that mean. Prints rows of a table:

    means         of all pixels and colours, ours and Mitsuba's
    apart         their difference, in standard errors of it
    chi^2         mean over pixels of (a - b)^2 / (var a + var b), which is 30 / 28 = 1.07 of 16 pictures each where both agree
    mirrored      the same beside our picture turned left to right: it has to be far off
    paths/s       of both, by the clock, in thousands; ours with all that a run of the program takes

VARIANT is Mitsuba's, scalar_rgb by default; PICTURES are 16. The means are drawn into FOLDER_FOR_PICTURES/beside_mitsuba.png: a
row a scene, ours, Mitsuba's, and their difference from -4 (black) to 4 (white) standard errors.
"""

import json
import subprocess
import sys
import time
from math import pi
from pathlib import Path

import mitsuba as mi
import numpy as np

PROGRAM, VOLUMES, OUT = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
VARIANT = sys.argv[4] if len(sys.argv) > 4 else "scalar_rgb"
mi.set_variant(VARIANT)
mi.set_log_level(mi.LogLevel.Error)
SIZE, PATHS = 32, 256
PICTURES = int(sys.argv[5]) if len(sys.argv) > 5 else 16
# Pixels of the sheet for each of a picture.
SCALE = 4
AIM = dict(origin=[0.3, -4, 0.5], target=[0, 0, 0], up=[0, 0, 1])


def fog():
    c = (np.arange(32) + 0.5) / 16 - 1
    x, y, z = np.meshgrid(c, c, c, indexing="ij")
    ball = np.exp(-((x - 0.2) ** 2 + y * y + (z + 0.15) ** 2) / (2 * 0.35**2))
    return (6 * ball * (1 + 0.8 * np.sin(7 * x) * np.cos(5 * z))).astype(np.float32), [1.0, 1.0, 1.0]


def skull():
    """A head by computed tomography, every fourth voxel across: extinction 0 up to 150, 40 from 1150 on."""
    subprocess.run([PROGRAM, "convert", VOLUMES / "ct-cranium" / "cranium.nrrd", "-o", OUT / "ct.npy", "--force"], check=True, capture_output=True)
    values = np.load(OUT / "ct.npy").transpose(2, 1, 0)[::4, ::4, ::2].astype(np.float32)
    sigma = (40 * np.clip((values - 150) / 1000, 0, 1)).astype(np.float32)
    half = np.array(sigma.shape) * [4 * 0.957, 4 * 0.957, 2 * 1.5]
    return sigma, list(half / half.max())


def sky(rows):
    """A gradient with a sun and a brighter side, so that no turn or mirror is the same, at these parts of the way down."""
    down, across = np.meshgrid(rows, (np.arange(512) + 0.5) / 512, indexing="ij")
    up = (1 - down)[..., None]
    light = (np.array([0.2, 0.3, 0.4]) + np.array([0.3, 0.4, 0.6]) * up) * (1 + 0.5 * np.sin(2 * pi * across)[..., None])
    sun = np.exp(-(((down - 0.28) / 0.02) ** 2) - (((across - 0.64) / 0.02) ** 2))
    return (light + sun[..., None] * np.array([60, 50, 40])).astype(np.float32)


def write_nrrd(name, sigma, half):
    """Voxels whose box is [-half, half]."""
    steps = [2 * h / n for h, n in zip(half, sigma.shape)]
    directions = " ".join(f"({','.join(str(s if k == a else 0) for k in range(3))})" for a, s in enumerate(steps))
    origin = ",".join(str(s / 2 - h) for s, h in zip(steps, half))
    sizes = " ".join(map(str, sigma.shape))
    head = (
        f"NRRD0005\ntype: float\ndimension: 3\nspace dimension: 3\nsizes: {sizes}\nspace directions: {directions}\n"
        f"space origin: ({origin})\nencoding: raw\nendian: little\n\n"
    )
    (OUT / name).write_bytes(head.encode() + sigma.transpose(2, 1, 0).tobytes())


def scenes():
    sun = [0.3, 0.9, -0.3]
    hg = {"g": 0.5}
    one = dict(volume=fog, albedo=[0.8] * 3, phase=hg, sun=sun)
    yield "fog, one bounce", dict(one, bounces=1)
    yield "fog", one
    yield "two lobes", dict(one, albedo=[0.95] * 3, phase={"f": 0.7, "g1": 0.7, "g2": -0.4})
    yield "picture of a sky", dict(volume=fog, albedo=[0.95, 0.9, 0.8], phase={"g": 0.6}, sky=sky)
    yield "skull, sun and even sky", dict(volume=skull, albedo=[0.9, 0.85, 0.75], phase={"g": 0.0}, sun=[-0.5, 0.6, -0.6], even=[0.3, 0.4, 0.5], paths=64)


def ours(scene, seed, size, paths):
    sigma, half = scene["volume"]()
    write_nrrd("matter.nrrd", sigma, half)
    most = float(sigma.max())
    function = {"stratavox_transfer_function": 1, "extinction": [[0, 0], [most, most]], "albedo": [[0, *scene["albedo"]]]}
    function["phase"] = scene["phase"]
    (OUT / "matter.json").write_text(json.dumps(function))
    # By the points of the function: its table of 4096 entries has 1/8192 of the largest extinction where there is none.
    words = ["--conformance", "--technique", "pathtrace", "--tf", OUT / "matter.json", "--spp", paths, "--seed", seed]
    words += ["--size", f"{size}x{size}", "--projection", "orthographic", "--view-height", 2]
    for word in ("eye", "target", "up"):
        words += [f"--{word}=" + ",".join(map(str, AIM[word.replace("eye", "origin")]))]
    if "bounces" in scene:
        words += ["--bounces", scene["bounces"]]
    if "sun" in scene:
        words += ["--light=" + ",".join(str(-c) for c in scene["sun"])]
    if "even" in scene:
        words += ["--environment", ",".join(map(str, scene["even"])), "--background", "environment"]
    if "sky" in scene:
        # Rows of texels lie half a row below their upper edges; Mitsuba's first and last ones at the poles.
        mi.Bitmap(scene["sky"]((np.arange(256) + 0.5) / 256)).write(str(OUT / "sky.exr"))
        words += ["--environment", OUT / "sky.exr", "--background", "environment"]
    words += ["-o", OUT / "ours.exr", "--force"]
    begun = time.time()
    subprocess.run([PROGRAM, "render", OUT / "matter.nrrd", *map(str, words)], check=True, capture_output=True)
    took = time.time() - begun
    picture = np.array(mi.Bitmap(str(OUT / "ours.exr")).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
    return picture, size * size * paths / took


def phase_of(phase):
    if "f" in phase:
        lobes = {"lobe_1": dict(type="hg", g=phase["g1"]), "lobe_2": dict(type="hg", g=phase["g2"])}
        return dict(type="blendphase", weight=1 - phase["f"], **lobes)
    return dict(type="hg", g=phase["g"])


def mitsubas(scene, size):
    sigma, half = scene["volume"]()
    box = mi.ScalarTransform4f().scale(half)
    grid = dict(type="gridvolume", grid=mi.VolumeGrid(sigma.transpose(2, 1, 0)[..., None].copy()), raw=True)
    grid.update(to_world=mi.ScalarTransform4f().translate([-h for h in half]).scale([2 * h for h in half]), filter_type="trilinear", wrap_mode="clamp")
    medium = dict(type="heterogeneous", scale=1.0, sigma_t=grid, phase=phase_of(scene["phase"]))
    medium["albedo"] = dict(type="rgb", value=scene["albedo"])
    made = dict(type="scene", integrator=dict(type="volpath", max_depth=scene.get("bounces", -2) + 1, rr_depth=1000))
    film = dict(type="hdrfilm", width=size, height=size, pixel_format="rgb", rfilter=dict(type="box"))
    made["sensor"] = dict(type="orthographic", to_world=mi.ScalarTransform4f().look_at(**AIM), film=film, sampler=dict(type="independent"))
    made["box"] = dict(type="cube", to_world=box, bsdf=dict(type="null"), interior=medium)
    if "sun" in scene:
        made["sun"] = dict(type="directional", direction=scene["sun"], irradiance=dict(type="rgb", value=[pi] * 3))
    if "even" in scene:
        made["sky"] = dict(type="constant", radiance=dict(type="rgb", value=scene["even"]))
    if "sky" in scene:
        # Its y is up: the world's z.
        turn = mi.ScalarTransform4f(np.array([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]], float))
        made["sky"] = dict(type="envmap", bitmap=mi.Bitmap(scene["sky"](np.arange(256) / 255)), to_world=turn)
    return mi.load_dict(made)


def theirs(scene, seed, size, paths):
    begun = time.time()
    picture = np.array(mi.render(scene, spp=paths, seed=seed))
    return picture, size * size * paths / (time.time() - begun)


def row_of(pictures, variance):
    """Three pictures side by side, in sRGB codes."""
    a, b = pictures
    grey = np.clip(0.5 + (a - b) / np.sqrt(np.maximum(variance, 1e-12)) / 8, 0, 1)
    # Brightest where one pixel in a hundred is brighter: suns are.
    white = max(np.percentile(b, 99), 1e-6)
    codes = [np.clip(picture / white, 0, 1) ** (1 / 2.2) for picture in pictures] + [grey]
    return np.concatenate([np.pad(c, ((1, 1), (1, 1), (0, 0)), constant_values=1) for c in codes], axis=1)


def main():
    rows = []
    print("| scene | means | apart | chi^2 | mirrored | paths/s |")
    print("|---|---|---|---|---|---|")
    for name, scene in scenes():
        other, paths = mitsubas(scene, SIZE), scene.get("paths", PATHS)
        a = np.stack([ours(scene, seed, SIZE, paths)[0] for seed in range(PICTURES)])
        b = np.stack([theirs(other, seed, SIZE, paths)[0] for seed in range(PICTURES)])
        mean_a, mean_b = a.mean(0), b.mean(0)
        means = [picture.mean((1, 2, 3)) for picture in (a, b)]
        error = sum(m.var(ddof=1) / PICTURES for m in means) ** 0.5
        variance = (a.var(0, ddof=1) + b.var(0, ddof=1)) / PICTURES
        lit = variance > 1e-3 * variance.max()
        chi = lambda x: float((((x - mean_b) ** 2)[lit] / variance[lit]).mean())
        rate_a = ours(scene, 99, 128, 64)[1]
        rate_b = theirs(mitsubas(scene, 64), 99, 64, 16)[1]
        apart = (means[0].mean() - means[1].mean()) / error
        row = f"{means[0].mean():.5f}, {means[1].mean():.5f} | {apart:+.2f} | {chi(mean_a):.2f} | {chi(mean_a[:, ::-1]):.0f}"
        print(f"| {name} | {row} | {rate_a / 1e3:.0f}, {rate_b / 1e3:.1f} |", flush=True)
        rows.append(row_of((mean_a, mean_b), variance))
    sheet = np.concatenate(rows).repeat(SCALE, 0).repeat(SCALE, 1)
    mi.Bitmap((255 * sheet + 0.5).astype(np.uint8)).write(str(OUT / "beside_mitsuba.png"))


main()

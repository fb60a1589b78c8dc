"""Draws what docs/gallery shows with stratavox and with VTK (9.7 with numpy and Pillow), and says how far apart they are.

    python docs/gallery/beside_vtk.py target/release/stratavox FOLDER_OF_VOLUMES FOLDER_FOR_PICTURES

Both have the same camera, the same functions and the same lamp, and blend numbers as a screen shows them
(`--color-space display`): VTK has no linear light. VTK's volumes end at the centres of the outer voxels, ours half a
voxel beyond. Prints rows of a table: intersection over union of what is brighter than 12 of 255, the mean of those
pixels in ours and in VTK's, the root mean square of the difference in codes, correlation, and mean SSIM (7 x 7) there.
"""

import json
import subprocess
import sys
from math import atan, cos, degrees, radians, sin, tan
from pathlib import Path

import numpy as np
import vtk
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401
from numpy.lib.stride_tricks import sliding_window_view
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk

PROGRAM, VOLUMES, OUT = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
HERE = Path(__file__).parent
SIZE, FOV = 400, 30.0


def run(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


def numbers(volume):
    run("convert", VOLUMES / volume, "-o", OUT / "volume.npy", "--force")
    return np.load(OUT / "volume.npy")


def preset(name, volume):
    return json.loads(run("preset", "show", name, VOLUMES / volume, "--json"))


def image(array, spacing, origin=(0, 0, 0)):
    made = vtk.vtkImageData()
    made.SetDimensions(*array.shape[::-1])
    made.SetSpacing(*spacing)
    made.SetOrigin(*origin)
    made.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(array).reshape(-1), deep=1))
    return made


def around(shape, spacing, azimuth, elevation, zoom, turned=False):
    """Eye, target and field of view of ours; `turned`: x runs to the left and y backwards."""
    size = np.array(shape[::-1]) * spacing
    target = size / 2 - np.array(spacing) / 2
    a, e = radians(azimuth), radians(elevation)
    towards = np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)]) * ([-1, -1, 1] if turned else 1)
    eye = target + np.linalg.norm(size) / 2 / sin(radians(FOV / 2)) * towards
    return eye, target, 2 * degrees(atan(tan(radians(FOV / 2)) / zoom))


def by_gradient(function, low, high, spacing, step):
    """Our function of value and gradient as VTK's image, whose rows end at a quarter of the range a mean spacing, and
    whose opacities are for one step."""
    steepest = 0.25 * (high - low) / np.mean(spacing)
    value, gradient = np.meshgrid(np.linspace(low, high, 2048), np.linspace(0, steepest, 512))
    depth, light = np.zeros(value.shape), np.zeros((*value.shape, 3))
    points = [(p[0], p[1:]) if not isinstance(p[1], list) else tuple(p) for p in function.get("color", [])]
    for w in function["widgets"]:
        if w["shape"] == "gaussian":
            v, g = (value - w["value"]) / w["sigma_value"], (gradient - w["gradient"]) / w["sigma_gradient"]
            share = np.exp(-0.5 * (v * v + g * g))
        elif w["shape"] == "rectangle":
            (a, b), (c, d) = w["values"], w["gradients"]
            share = ((value >= a) & (value <= b) & (gradient >= c) & (gradient <= d)).astype(float)
        else:
            reach = w["half_width"] * min(spacing) * np.maximum(gradient, 1e-9)
            share = np.maximum(0, 1 - abs(value - w["value"]) / reach)
        own = -np.log1p(-np.minimum(w["opacity"] * share, 0.9999))
        at, colors = [p[0] for p in points], np.array([p[1] for p in points])
        color = w.get("color") or np.stack([np.interp(value, at, colors[:, k]) for k in range(3)], 2)
        depth += own
        light += own[..., None] * np.array(color)
    alpha = 1 - np.exp(-depth * step / function.get("reference_length", min(spacing)))
    table = np.concatenate([light / np.maximum(depth, 1e-12)[..., None], alpha[..., None]], 2)
    made = vtk.vtkImageData()
    made.SetDimensions(2048, 512, 1)
    made.GetPointData().SetScalars(numpy_to_vtk(table.reshape(-1, 4).astype(np.float32), deep=1))
    return made


def looks(data, function):
    look, color, opacity = vtk.vtkVolumeProperty(), vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    low, high = data.GetScalarRange()
    function = function or {"color": [[low, 0, 0, 0], [high, 1, 1, 1]], "opacity": [[low, 1], [high, 1]]}
    for point in function["color"]:
        color.AddRGBPoint(*point)
    for point in function["opacity"]:
        opacity.AddPoint(*point)
    look.SetColor(color)
    look.SetScalarOpacity(opacity)
    look.SetInterpolationTypeToLinear()
    look.SetScalarOpacityUnitDistance(function.get("reference_length", min(data.GetSpacing())))
    return look


def by_vtk(name, data, view, step, function=None, table=None, mip=False, material=None, lamp=None, ambient_lamp=None,
           fixed_point=False, shadow=0.0):
    look = looks(data, function)
    if material:
        look.ShadeOn()
        look.SetAmbient(material[0])
        look.SetDiffuse(material[1])
        look.SetSpecular(material[2])
        look.SetSpecularPower(material[3])
    kind = vtk.vtkFixedPointVolumeRayCastMapper if fixed_point else vtk.vtkOpenGLGPUVolumeRayCastMapper
    mapper = kind()
    mapper.SetInputData(data)
    mapper.SetAutoAdjustSampleDistances(0)
    mapper.SetSampleDistance(step)
    if not fixed_point:
        mapper.UseJitteringOff()
    if table is not None:
        look.SetTransferFunctionMode(1)
        look.SetTransferFunction2D(table)
    if shadow:
        mapper.SetVolumetricScatteringBlending(shadow)
        mapper.SetGlobalIlluminationReach(1.0)
    if mip:
        mapper.SetBlendModeToMaximumIntensity()
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(look)
    shown(name, volume, view, lamp, ambient_lamp)


def several_by_vtk(name, pairs, view, step):
    """Volumes with a function each in one picture: `vtkMultiVolume`, which is how 3D Slicer draws several."""
    mapper, all_of_them = vtk.vtkOpenGLGPUVolumeRayCastMapper(), vtk.vtkMultiVolume()
    mapper.SetAutoAdjustSampleDistances(0)
    mapper.SetSampleDistance(step)
    mapper.UseJitteringOff()
    all_of_them.SetMapper(mapper)
    for port, (data, function) in enumerate(pairs):
        mapper.SetInputDataObject(port, data)
        volume = vtk.vtkVolume()
        volume.SetProperty(looks(data, function))
        all_of_them.SetVolume(volume, port)
    shown(name, all_of_them, view)


def shown(name, volume, view, lamp=None, ambient_lamp=None):
    scene, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    scene.AddVolume(volume)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(scene)
    eye, target, fov = view
    camera = scene.GetActiveCamera()
    camera.SetPosition(*eye)
    camera.SetFocalPoint(*target)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(fov)
    scene.ResetCameraClippingRange()
    if lamp is not None or ambient_lamp is not None:
        light = vtk.vtkLight()
        light.SetPositional(0)
        if lamp is None:
            light.SetLightTypeToHeadlight()
        else:
            light.SetLightTypeToSceneLight()
            light.SetPosition(*(target + 1e4 * np.array(lamp) / np.linalg.norm(lamp)))
            light.SetFocalPoint(*target)
        if ambient_lamp is not None:
            light.SetAmbientColor(*[ambient_lamp] * 3)
        scene.AddLight(light)
    window.Render()
    grab, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    writer.SetFileName(str(OUT / f"vtk_{name}.png"))
    writer.SetInputData(grab.GetOutput())
    writer.Write()


def by_us(name, volume, *words):
    run("render", VOLUMES / volume, "--size", f"{SIZE}x{SIZE}", "--background", "0,0,0", "--color-space", "display",
        "--samples-per-voxel", 2, "--force", "--progress", "none", "-o", OUT / f"ours_{name}.png", *words)


def judge(name, beside=None):
    grey = [np.asarray(Image.open(OUT / f"{who}_{n}.png").convert("RGB")).astype(float).mean(2)
            for who, n in (("ours", name), ("vtk", beside or name))]
    ours, theirs = grey
    covers = [g > 12 for g in grey]
    either, both = covers[0] | covers[1], covers[0] & covers[1]
    mean = lambda g: sliding_window_view(g, (7, 7)).mean((2, 3))
    a, b = mean(ours), mean(theirs)
    va, vb, ab = mean(ours * ours) - a * a, mean(theirs * theirs) - b * b, mean(ours * theirs) - a * b
    c, d = 2.55**2, 7.65**2
    alike = ((2 * a * b + c) * (2 * ab + d) / ((a * a + b * b + c) * (va + vb + d)))[
        sliding_window_view(either, (7, 7)).any((2, 3))].mean()
    rms = np.sqrt(((ours - theirs) ** 2)[either].mean())
    print(f"| {beside or name} | {both.sum() / either.sum():.3f} | {ours[covers[0]].mean():.1f} "
          f"| {theirs[covers[1]].mean():.1f} | {rms:.1f} | {np.corrcoef(ours[both], theirs[both])[0, 1]:.3f} "
          f"| {alike:.3f} |", flush=True)


PLAIN = (0.1, 0.7, 0.2, 10)
print("| picture | IoU | mean, ours | mean, VTK | RMS | correlation | SSIM |\n|---|---|---|---|---|---|---|")

# A brain. The lamp's own ambient colour is black in VTK, and its fixed-point mapper multiplies the material's with it.
FILE = "mri-brainsmall/brainsmall.nhdr"
material = (0.6, 0.4, 0.1, 10)
array = numbers(FILE)
data, view = image(array, (1, 1, 1)), around(array.shape, (1, 1, 1), 240, 20, 2)
function = json.loads((HERE / "brain.json").read_text())
words = ["--tf", HERE / "brain.json", "--azimuth", 240, "--elevation", 20, "--zoom", 2]
lit = [*words, "--shading", "phong", "--material"]
by_us("brain", FILE, *words)
by_us("brain_lit", FILE, *lit, "0.6,0.4,0.1,10")
by_us("brain_dark", FILE, *lit, "0,0.4,0.1,10")
by_vtk("brain", data, view, 0.5, function)
by_vtk("brain_lit", data, view, 0.5, function, material=material)
by_vtk("brain_fixed", data, view, 0.5, function, material=material, fixed_point=True)
by_vtk("brain_fixed_white", data, view, 0.5, function, material=material, fixed_point=True, ambient_lamp=1)
judge("brain")
judge("brain_lit")
judge("brain_lit", "brain_fixed")
judge("brain_dark", "brain_fixed")
judge("brain_lit", "brain_fixed_white")

# A skull by two contours.
FILE, spacing = "ct-cranium/cranium.nrrd", (0.957031, 0.957031, 1.5)
array = numbers(FILE)
data, view = image(array, spacing), around(array.shape, spacing, -60, 0, 1.5, turned=True)
function = preset("boundaries", FILE)
table = by_gradient(function, float(array.min()), float(array.max()), spacing, 0.47)
words = ["--preset", "boundaries", "--azimuth", -60, "--zoom", 1.5]
by_us("skull", FILE, *words)
by_us("skull_lit", FILE, *words, "--shading", "phong")
by_vtk("skull", data, view, 0.47, table=table)
by_vtk("skull_lit", data, view, 0.47, table=table, material=PLAIN)
judge("skull")
judge("skull_lit")

# A torso by Gaussians over value and gradient, cropped.
FILE, spacing, first = "ct-torso/torso-2x.mha", (1.5625, 1.5625, 2.0), np.array([45, 20, 0])
whole = numbers(FILE)
array = whole[0:137, 20:180, 45:211]
eye, target, fov = around(whole.shape, spacing, -75, 10, 1.3, turned=True)
data, view = image(array, spacing), (eye - first * spacing, target - first * spacing, fov)
function = json.loads((HERE / "torso.json").read_text())
table = by_gradient(function, float(array.min()), float(array.max()), spacing, 0.78)
words = ["--tf", HERE / "torso.json", "--crop", "45,211,20,180,0,137", "--azimuth", -75, "--elevation", 10, "--zoom", 1.3]
by_us("torso", FILE, *words)
by_us("torso_lit", FILE, *words, "--shading", "phong")
by_vtk("torso", data, view, 0.78, table=table)
by_vtk("torso_lit", data, view, 0.78, table=table, material=PLAIN)
judge("torso")
judge("torso_lit")

# A walnut, in units of a voxel. A lamp that is no headlight brings no ambient light in VTK.
FILE, side = "ct-walnut/walnut.mhd", 0.015625
array = numbers(FILE)
data, view = image(array, (1, 1, 1)), around(array.shape, (1, 1, 1), 200, 40, 1.2, turned=True)
function = preset("mri", FILE)
function["reference_length"] /= side
material, lamp = (0, 0.6, 0.1, 10), (-1, 0.5, 0.7)
words = ["--azimuth", 200, "--elevation", 40, "--zoom", 1.2]
lit = [*words, "--shading", "phong", "--material", "0,0.6,0.1,10", "--light", "1,-0.5,0.7"]
by_us("walnut", FILE, *words)
by_us("walnut_lit", FILE, *lit)
by_us("walnut_shadow", FILE, *lit, "--shadows", "volume")
by_vtk("walnut", data, view, 0.5, function)
by_vtk("walnut_lit", data, view, 0.5, function, material=material, lamp=lamp)
by_vtk("walnut_shadow", data, view, 0.5, function, material=material, lamp=lamp, shadow=2.0)
judge("walnut")
judge("walnut_lit")
judge("walnut_shadow")

# Nuclei: VTK has no MIDA, so the maximum, and compositing.
FILE = "tiff-nuclei/img3d.tif"
array = numbers(FILE)
data, view = image(array, (1, 1, 1)), around(array.shape, (1, 1, 1), 60, 15, 1.1)
window = f"{array.min()},{array.max()}"
by_us("nuclei_mip", FILE, "--mode", "mip", "--zoom", 1.1, "--preset", "grey", "--window", window)
by_us("nuclei", FILE, "--zoom", 1.1, "--preset", "microscopy")
by_vtk("nuclei_mip", data, view, 0.5, mip=True)
by_vtk("nuclei", data, view, 0.5, preset("microscopy", FILE))
judge("nuclei_mip")
judge("nuclei")

# A PET: the maximum, as it is and after a Gaussian of one voxel, which both have.
FILE, spacing = "dicom-pet", (3.53782, 3.53782, 3.375)
array = numbers(FILE)
data, view = image(array, spacing), around(array.shape, spacing, 90, 0, 1.3, turned=True)
smooth = vtk.vtkImageGaussianSmooth()
smooth.SetInputData(data)
smooth.SetStandardDeviations(1, 1, 1)
smooth.SetRadiusFactors(4, 4, 4)
smooth.Update()
function = {"color": [[0, 0, 0, 0], [20000, 1, 1, 1]], "opacity": [[0, 1], [1e5, 1]]}
words = ["--mode", "mip", "--view", "anterior", "--zoom", 1.3, "--preset", "grey", "--window", "0,20000"]
by_us("pet", FILE, *words)
by_us("pet_smooth", FILE, *words, "--denoise", "gaussian:1")
by_vtk("pet", data, view, 1.7, function, mip=True)
by_vtk("pet_smooth", smooth.GetOutput(), view, 1.7, function, mip=True)
judge("pet")
judge("pet_smooth")

# A chest by CT with a heart by PET, of two people: the second is moved so that its heart lies in the first's chest, and cut
# at the ends of the first, beyond which ours draws nothing.
FILE, spacing = "ct-torso/torso-2x.mha", (1.5625, 1.5625, 2.0)
whole = numbers(FILE)
inner_spacing, inner_origin = (3.53782, 3.53782, 3.375), (-35.523, -23.275, 70.216)
inner = numbers("dicom-pet")[:60, 7:119, 11:122]
inner_origin = [o + n * s for o, n, s in zip(inner_origin, (11, 7, 0), inner_spacing)]
words = ["--preset", "ct-bone", "--shading", "none", "--keep-all", "--azimuth", 70, "--elevation", 10, "--zoom", 1.3]
both = f"{VOLUMES / 'dicom-pet'},preset=pet,shift=10:-344:80"
by_us("ct_alone", FILE, *words)
by_us("ct_and_pet", FILE, *words, "--with", both)
view = around(whole.shape, spacing, 70, 10, 1.3, turned=True)
ct, pet = (image(whole, spacing), preset("ct-bone", FILE)), (image(inner, inner_spacing, inner_origin), preset("pet", "dicom-pet"))
by_vtk("ct_alone", ct[0], view, 0.78, ct[1])
several_by_vtk("ct_and_pet", [ct, pet], view, 0.78)
judge("ct_alone")
judge("ct_and_pet")

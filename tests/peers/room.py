"""Compares a path-traced room with Mitsuba 3 (`scalar_rgb`, one thread) by processor time × noise².

pip install --target /tmp/mitsuba mitsuba numpy
cargo build --release && PYTHONPATH=/tmp/mitsuba python3 tests/peers/room.py [ROUNDS]

The noise is the root mean square of the difference of two pictures with different seeds, divided by √2, with colours clipped to 0..1.
The time is that of 15 of the 16 samples: a frame of one sample is subtracted, with all loading and building.
"""
import os, resource, statistics, subprocess, sys, tempfile
import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MESHES, PROGRAM = ROOT + "/scenes/meshes/", os.environ.get("CARGO_TARGET_DIR", ROOT + "/target") + "/release/raykata"
COLORS = {"white": [0.73, 0.72, 0.68], "red": [0.62, 0.06, 0.05], "green": [0.13, 0.45, 0.09]}
T, SAMPLES = mi.ScalarTransform4f(), 16
rgb = lambda *color: {"type": "rgb", "value": list(color)}
diffuse = lambda *color: {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(*color)}}

def wall(folder, material):
    """The faces of one material of cornell.obj."""
    points, *groups = open(MESHES + "cornell.obj").read().split("usemtl ")
    faces = "".join(group.split("\n", 1)[1] for group in groups if group.split()[0] == material)
    open(f"{folder}/{material}.obj", "w").write(points.replace("mtllib", "#") + faces)
    return {"type": "obj", "filename": f"{folder}/{material}.obj", "face_normals": True, "bsdf": diffuse(*COLORS[material])}

def knot(folder):
    """The knot with each quad as two triangles."""
    header, data = open(MESHES + "knot.ply", "rb").read().split(b"end_header\n", 1)
    n_points, n_quads = [int(line.split()[2]) for line in header.splitlines() if line.startswith(b"element")]
    quads = np.frombuffer(data[24 * n_points:], [("n", "u1"), ("corners", "<i4", 4)])["corners"]
    faces = np.zeros(2 * n_quads, [("n", "u1"), ("corners", "<i4", 3)])
    faces["n"], faces["corners"] = 3, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    header = header.replace(b"face %d" % n_quads, b"face %d" % (2 * n_quads)) + b"end_header\n"
    open(folder + "/knot.ply", "wb").write(header + data[:24 * n_points] + faces.tobytes())
    to_world = T.translate([-0.1, 1.1, -0.3]).scale(0.45)
    return {"type": "ply", "filename": folder + "/knot.ply", "bsdf": diffuse(0.7, 0.7, 0.7), "to_world": to_world}

def room(folder):
    film = {"type": "hdrfilm", "width": 400, "height": 400, "rfilter": {"type": "box"}}
    view = T.look_at([0, 1, 4.1], [0, 1, 0], [0, 1, 0])
    light = {"type": "rectangle", "to_world": T.translate([0, 2, -0.03]).rotate([1, 0, 0], 90).scale([0.24, 0.19, 1]),
             "bsdf": diffuse(0, 0, 0), "emitter": {"type": "area", "radiance": rgb(17, 11.5, 6)}}
    mirror = {"type": "conductor", "material": "none", "specular_reflectance": rgb(0.9, 0.9, 0.9)}
    glass = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
    return mi.load_dict({"type": "scene", "camera": {"type": "perspective", "fov": 35.7, "to_world": view, "film": film},
        "integrator": {"type": "path", "max_depth": 13}, "light": light, "knot": knot(folder),
        "mirror": {"type": "sphere", "center": [-0.5, 0.35, 0.1], "radius": 0.35, "bsdf": mirror},
        "glass": {"type": "sphere", "center": [0.5, 0.3, 0.4], "radius": 0.3, "bsdf": glass},
        **{material: wall(folder, material) for material in COLORS}})

def picture(scene, folder, seed, samples):
    """The time and the picture of a frame: by Mitsuba, or by raykata without a scene."""
    who, out = resource.RUSAGE_SELF if scene else resource.RUSAGE_CHILDREN, folder + "/frame.hdr"
    before = resource.getrusage(who).ru_utime
    options = ["--kit", "solutions", "--threads", "1", "--seed", str(seed), "--spp", str(samples), "--out", out]
    if scene:
        film = mi.Bitmap(mi.render(scene, seed=seed, spp=samples))
    else:
        subprocess.run([PROGRAM, "render", ROOT + "/tests/peers/room.toml", *options], check=True, stdout=subprocess.DEVNULL)
    seconds = resource.getrusage(who).ru_utime - before
    film = np.array((film if scene else mi.Bitmap(out)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
    return seconds, film.clip(0, 1)

with tempfile.TemporaryDirectory() as folder:
    dr.set_thread_count(1)
    contestants, rows = {"raykata": None, "mitsuba": room(folder)}, {"raykata": [], "mitsuba": []}
    for seed in range(int(sys.argv[1]) if len(sys.argv) > 1 else 5):
        for name, scene in contestants.items():
            (one, _), (first, a), (second, b) = [picture(scene, folder, 3 * seed + i, n) for i, n in enumerate([1, SAMPLES, SAMPLES])]
            rows[name].append(((first + second) / 2 - one, np.sqrt(np.mean((a - b) ** 2) / 2), (a.mean() + b.mean()) / 2))
    medians = {name: [statistics.median(column) for column in zip(*row)] for name, row in rows.items()}
    for name, (seconds, noise, mean) in medians.items():
        print(f"{name}: {seconds:.2f} s, noise {noise:.4f}, mean {mean:.4f}")
    cost = {name: seconds * noise**2 for name, (seconds, noise, _) in medians.items()}
    print(f"time × noise² relative to Mitsuba: {cost['raykata'] / cost['mitsuba']:.2f}")

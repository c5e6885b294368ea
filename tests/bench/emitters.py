"""Selecting emitters by the light tree against selecting them by power: the squared error at equal CPU time, the cost of
one choice, and the cost where there are few emitters.

Rooms with small lamps are made here: a grid of rooms, each open to its neighbours by doors, so that of ten thousand
lamps a few light any point. References are rendered with the tree and another seed, for longer; their own noise is
taken off."""

import json
import pathlib
import random
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "jobs/scenes"))

import glb  # noqa: E402
import shapes  # noqa: E402

ROOM, HEIGHT, DOOR = 4.0, 3.0, 1.2  # metres
LONGER = 6  # a reference takes so many times the time of a picture


def walls(rooms):
    """Walls between rooms, with a door in the middle of each; closed at the border."""
    size = rooms * ROOM
    half = (ROOM - DOOR) / 2
    parts = []
    for i in range(rooms + 1):
        at = i * ROOM
        for k in range(rooms):
            spans = [(0, ROOM)] if i in (0, rooms) else [(0, half), (half + DOOR, ROOM)]
            for low, high in spans:
                begin, length = k * ROOM + low, high - low
                parts.append(shapes.quad((at, 0, begin), (0, 0, length), (0, HEIGHT, 0)))
                parts.append(shapes.quad((begin, 0, at), (length, 0, 0), (0, HEIGHT, 0)))
    parts.append(shapes.quad((0, 0, 0), (0, 0, size), (size, 0, 0)))
    parts.append(shapes.quad((0, HEIGHT, 0), (size, 0, 0), (0, 0, size)))
    return parts


def lamp(rng, size):
    """A small quad below the ceiling that faces down or sideways."""
    x, z = rng.uniform(0.1, size - 0.1), rng.uniform(0.1, size - 0.1)
    y = HEIGHT - rng.uniform(0.05, 0.15)  # none lies in another's plane
    side = 0.04
    if rng.random() < 0.7:
        return shapes.quad((x, y, z), (side, 0, 0), (0, 0, side))
    turned = [((side, 0, 0), (0, side, 0)), ((0, 0, side), (0, side, 0)), ((0, side, 0), (side, 0, 0)),
              ((0, side, 0), (0, 0, side))]
    return shapes.quad((x, y, z), *turned[rng.randrange(4)])


def lamps_behind_corners(lamps):
    """A scene of at least 16 rooms, with about 40 lamps in each, of a hundredfold range of radiance."""
    rng = random.Random(1)
    rooms = max(4, round((lamps / 40) ** 0.5))
    scene = glb.Glb("lamps", "", "", "closed")
    white = scene.material(glb.diffuse("white", (0.7, 0.7, 0.7)))
    for part in walls(rooms):
        scene.add("wall", part, white)
    shares = 5
    for k in range(shares):
        radiance = 10.0 ** (1 + k / 2)
        bright = scene.material(glb.emitter(f"lamp {k}", (radiance,) * 3))
        for first in range(0, lamps // shares, 4000):  # indices have 16 bits
            count = min(4000, lamps // shares - first)
            quads = shapes.joined(*(lamp(rng, rooms * ROOM) for _ in range(count)))
            scene.add(f"lamps {k} {first}", quads, bright)
    middle = (rooms // 2) * ROOM
    # Lower than all lamps and looking down: none is seen, whose borders no choice makes smoother.
    scene.camera("room", (middle + 0.3, 2.8, middle + 0.3), (middle + 2.6, 0.8, middle + 2.6), 50)
    return scene.bytes()


def integrators(method):
    """By tree and by power."""
    for emitters in ("tree", "power"):
        if method == "path":
            yield emitters, {"type": "path", "max_depth": 4, "emitters": emitters}
        else:
            yield emitters, {"type": "bdpt", "max_depth": 4, "connections": {"type": "paired", "emitters": emitters}}


def squared_errors(bench, name, job, integrators, seconds):
    """The MSE of each of the named integrators at equal CPU time."""
    reference, report = bench.render(f"{name}-reference", {
        **job, "seed": 77, "integrator": {"type": "path", "max_depth": 4, "emitters": "tree"},
        "budget": {"cpu_seconds": LONGER * seconds}})
    noise = report["errors"]["est_rmse"] ** 2
    mse = {}
    for which, integrator in integrators.items():
        out = bench.render(f"{name}-{which}", {**job, "integrator": integrator, "budget": {"cpu_seconds": seconds}})[0]
        mse[which] = bench.compare(out / "image.exr", reference / "image.exr", 16)["mse"] - noise
    print(f"  {name}: MSE " + ", ".join(f"{which} {value:.4g}" for which, value in mse.items()) +
          f"; of the reference {noise:.2g}", flush=True)
    return mse


def gain(bench, name, job, method, seconds):
    """MSE by power over MSE by the tree, at equal CPU time."""
    mse = squared_errors(bench, f"{name}-{method}", job, dict(integrators(method)), seconds)
    return mse["power"] / mse["tree"]


# Ten thousand lamps and their light of up to two bounces as virtual lights, of which a pixel gathers a few.
MANY = {"type": "many_lights", "max_depth": 4, "light_paths": 65536, "direct": "lights"}
FEW = {"gather": {"type": "random", "lights": 64}}
BESIDE = {"path-tree": {"type": "path", "max_depth": 4, "emitters": "tree"},
          "bdpt-tree": {"type": "bdpt", "max_depth": 4, "connections": {"type": "paired", "emitters": "tree"}},
          "random-lights": {**MANY, **FEW},
          "random-lights-without-compensation": {**MANY, **FEW, "compensation": False},
          "random-lights-view-maps": {**MANY, **FEW, "visibility": {"type": "view_maps"}},
          "all-lights-view-maps": {**MANY, "light_paths": 8192, "visibility": {"type": "view_maps"}}}


def beside_virtual_lights(bench, seconds):
    """Many emitters by the tree, and as virtual lights."""
    for name, job in (("lamps10000", {"scene": "lamps10000.glb", "resolution": [128, 128]}),
                      ("many_lights", {"scene": "many_lights.glb", "camera": "corner", "resolution": [128, 96]})):
        mse = squared_errors(bench, f"{name}-virtual", job, BESIDE, seconds)
        best = min(value for which, value in mse.items() if which not in ("path-tree", "bdpt-tree"))
        ratio = best / min(mse["path-tree"], mse["bdpt-tree"])
        print(f"  {name}: MSE of the best by virtual lights / of the best by the tree: {ratio:.3g}", flush=True)


def gains(bench, folder, seconds):
    for lamps in (10, 100, 1000, 10000, 100000):
        (folder / f"lamps{lamps}.glb").write_bytes(lamps_behind_corners(lamps))
        job = {"scene": f"lamps{lamps}.glb", "resolution": [128, 128]}
        for method in ("path", "bdpt"):
            ratio = gain(bench, f"lamps{lamps}", job, method, seconds)
            bound = 5 if lamps == 10000 and method == "path" else 0
            bench.figure(f"{lamps} lamps behind corners, {method}: MSE by power / by the tree", f"{ratio:.2f}",
                         f"at least {bound}", ratio >= bound)
    job = {"scene": "many_lights.glb", "camera": "corner", "resolution": [128, 96]}
    for method in ("path", "bdpt"):
        ratio = gain(bench, "many_lights", job, method, seconds)
        bench.figure(f"many_lights, {method}: MSE by power / by the tree", f"{ratio:.2f}", "at least 1", ratio >= 1)
    beside_virtual_lights(bench, seconds)
    for count in (1000, 100000):
        job = {"scene": "sponza/scene.glb", "camera": "atrium", "resolution": [128, 64],
               "particles": {"count": count, "power": 3e5, "alone": True}}
        ratio = gain(bench, f"particles{count}", job, "path", seconds)
        bench.figure(f"sponza, {count} particles, path: MSE by power / by the tree", f"{ratio:.2f}", "at least 1",
                     ratio >= 1)


def costs(bench, binary):
    """Nanoseconds of a choice, of three runs the least."""
    for n, bound in ((10, None), (1000, None), (10000, None), (100000, None), (1000000, 150)):
        lines = [subprocess.run([binary / "bench_emitters", str(n)], check=True, capture_output=True,
                                text=True).stdout.strip() for _ in range(3)]
        ns = min(float(re.search(r"tree ([0-9.]+) in batches", line)[1]) for line in lines)
        bench.figure(f"{n} emitters: CPU ns of a choice by the tree", f"{ns:.0f}", f"below {bound}" if bound else "-",
                     bound is None or ns < bound)
        print("  " + lines[0])


def overheads(bench):
    """CPU seconds of equal samples with the default and by power, where there are few emitters."""
    for scene in ("cornell-box/scene.glb", "ajar.glb"):
        job = {"scene": scene, "resolution": [256, 128], "budget": {"iterations": 16}}
        seconds = {"auto": [], "power": []}
        for _ in range(5):
            for emitters, found in seconds.items():
                spec = {**job, "integrator": {"type": "path", "emitters": emitters}}
                found.append(bench.render("few", spec)[1]["seconds"]["render_cpu"])
        ratio = min(seconds["auto"]) / min(seconds["power"])
        bench.figure(f"{scene}: CPU time with auto / by power", f"{ratio:.3f}", "at most 1.02", ratio <= 1.02)


def run(bench, binary, options):
    costs(bench, binary)
    overheads(bench)
    gains(bench, bench.folder, options.seconds / 12)


if __name__ == "__main__":
    pathlib.Path(sys.argv[1]).write_bytes(lamps_behind_corners(int(sys.argv[2])))

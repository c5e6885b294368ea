"""Lacuna beside Blender's Cycles, on the same glTF files at equal CPU time: a sweep, with Cycles as a foreign cell.

First, scenes of known answers: does Cycles read materials, lights and lengths as Lacuna does? Then, for each scene, the
means of 16 x 16 pixels of both agree with those of references to their noise; only then are errors compared.
Materials that only one of the two has (rough gloss) are made diffuse for both.

CPU seconds are those of a process's threads while it renders. Cycles reports none: it renders 1 sample and n
samples a pixel with the scene prepared, and the difference is the time of n - 1. Errors at equal time are those of the
sweep's report, its efficiency 1 / (relMSE x seconds). Writes the figure and the report of each scene to build/peers."""

import csv
import json
import math
import os
import pathlib
import shutil
import statistics
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "jobs/scenes"))

import glb  # noqa: E402
import rooms  # noqa: E402
import shapes  # noqa: E402

THREADS, BLOCK, DEPTH = 2, 16, 6
SEEDS = (1, 2)
LONGER = 12  # a reference takes so many times the time of a picture
PLAIN = {"path": {"type": "path"}, "path, reuse": {"type": "path", "reuse": 16}}
OURS = {**PLAIN, "bdpt": {"type": "bdpt"}, "auto": {"type": "auto"}}
CYCLES = {"Cycles": False, "Cycles, roulette": True}
SCENES = {
    "cornell-box": {"scene": "cornell-box/scene.glb", "resolution": [192, 192]},
    "door": {"scene": "door/scene.glb", "camera": "corner"},
    "sponza, arcade": {"scene": "sponza/scene.glb", "camera": "directional-light-from-power"},
    "sponza, nave": {"scene": "sponza/scene.glb", "camera": "atrium"},
    "atrium": {"scene": "atrium.glb", "camera": "arcade"},
    "room by day": {"scene": "day.glb", "camera": "room"},
    "room by day, a bulb": {"scene": "bulb.glb", "camera": "room"},
}
# Scenes of known answers, and the edges of their paths.
KNOWN = (("furnace.glb", 2), ("furnace.glb", 6), ("directional.glb", 2), ("point.glb", 2), ("area.glb", 2))


def furnished(with_bulb):
    """A room with a table, books, a cabinet, a stool, a picture and a window, and perhaps a bulb of 224 triangles with a
    fourth of the light of the window and 1 % of its area."""
    s = glb.Glb("furnished", "", "", "closed")
    white = s.material(glb.diffuse("white", (0.78, 0.77, 0.74)))
    boards = s.material(glb.diffuse("boards", (0.42, 0.30, 0.20)))
    x, y, z = (-2.5, 2.5), (0.0, 2.7), (0.0, 5.0)
    s.add("floor", shapes.wall("+y", y[0], x, z), boards)
    sides = [shapes.wall("-y", y[1], x, z), shapes.wall("+z", z[0], x, y), shapes.wall("-z", z[1], x, y),
             shapes.wall("+x", x[0], z, y)]
    s.add("walls", shapes.joined(*sides), white)
    hole = (1.2, 1.0), (3.0, 2.2)  # z, y of the window's corners
    cuts = (z[0], hole[0][0], hole[1][0], z[1]), (y[0], hole[0][1], hole[1][1], y[1])
    s.add("window's wall", shapes.wall("-x", x[1], *cuts, [(1, 1)]), white)
    day = s.material(glb.emitter("day", (6.0, 7.0, 8.0)))
    s.add("window", shapes.wall("-x", x[1] + 0.01, cuts[0][1:3], cuts[1][1:3]), day)
    if with_bulb:
        bulb = s.material(glb.emitter("bulb", (160.0, 120.0, 70.0)))
        s.add("bulb", shapes.sphere(0.05, 16, 8), bulb, at=(-1.6, 1.7, 1.0))
    rooms.ajar_furniture(s)
    s.camera("room", (-1.2, 1.6, 4.6), (0.45, 0.75, 1.2), 52, 16 / 9)
    return s.bytes()


def diffuse_where_rough(data):
    """A GLB file whose materials both renderers have, and the names of those that were changed."""
    size, = struct.unpack_from("<I", data, 12)
    document, rest = json.loads(data[20:20 + size]), data[20 + size:]
    changed = []
    for m in document.get("materials", []):
        pbr, extensions = m.setdefault("pbrMetallicRoughness", {}), m.setdefault("extensions", {})
        diffuse = extensions.get("KHR_materials_specular", {}).get("specularFactor", 1) == 0 and pbr.get("metallicFactor", 1) == 0
        if diffuse or pbr.get("roughnessFactor", 1) == 0:
            continue
        changed.append(m["name"])
        pbr.update(metallicFactor=0, roughnessFactor=1)
        extensions.pop("KHR_materials_ior", None)
        extensions["KHR_materials_specular"] = {"specularFactor": 0}
        document.setdefault("extensionsUsed", [])
        document["extensionsUsed"] = sorted({*document["extensionsUsed"], "KHR_materials_specular"})
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    whole = 12 + 8 + len(text) + len(rest)
    return struct.pack("<4sIIII", b"glTF", 2, whole, len(text), 0x4E4F534A) + text + rest, changed


def found(name):
    """A scene's file below the scenes roots."""
    for root in os.environ["LACUNA_SCENES"].split(":"):
        file = pathlib.Path(root) / name
        if root and file.is_file():
            return file
    raise SystemExit(f"bench: there is no scene {name}")


def cycles(folder, spec):
    """Runs tests/bench/cycles.py; gives what it prints."""
    file = folder / "cycles.json"
    file.write_text(json.dumps(spec))
    # Blender takes its modules from the Python that comes first: the system's.
    done = subprocess.run(["/usr/bin/blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                           pathlib.Path(__file__).with_name("cycles.py"), "--", file],
                          capture_output=True, text=True, env={**os.environ, "PATH": "/usr/bin:/bin"})
    for line in done.stdout.splitlines():
        if line.startswith("cycles: "):
            return json.loads(line[len("cycles: "):])
    raise SystemExit(f"bench: Blender failed\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


def known_answers(bench):
    """Scenes whose picture is known to both."""
    for name, depth in KNOWN:
        job = {"scene": name, "resolution": [64, 64]}
        files = [str(bench.folder / f"known-{k}.exr") for k in range(2)]
        cycles(bench.folder, {"scene": str(found(name)), "camera": "", "resolution": job["resolution"], "max_depth": depth,
                              "threads": THREADS, "runs": [{"seed": 1, "roulette": bool(k), "cpu_seconds": 1, "file": f}
                                                           for k, f in enumerate(files)]})
        out, _ = bench.render("known", {**job, "integrator": {"type": "path", "max_depth": depth}, "threads": THREADS,
                                        "budget": {"cpu_seconds": 1}})
        worst = max((bench.compare(f, out / "image.exr", BLOCK)["mean_relative"] for f in files), key=abs)
        bench.figure(f"{name}, {depth} edges: mean of Cycles / of Lacuna", f"{100 * worst:+.3f} %", "within 0.2 %",
                     abs(worst) <= 0.002)


def agreement(bench, pictures, references):
    """How far the means of blocks are from those of the reference, over what noise explains: 1 if both agree. And by how
    much of the mean they differ beyond noise. Seeds of Cycles share a part of their error (on cornell-box .1 % of the mean
    at 50 samples a pixel, .03 % at 350), which looks like a difference."""
    def squared(a, b):
        return bench.compare(a, b, BLOCK)["block_rms"] ** 2

    distance = statistics.mean(squared(p, r) for p in pictures for r in references)
    noise = squared(*pictures) / 2 + squared(*references) / 2
    c = bench.compare(pictures[0], references[0], BLOCK)
    return math.sqrt(distance / noise), math.sqrt(max(0, distance - noise)) / c["mean_b"]


def lacuna(bench, *arguments):
    """What the command prints."""
    return subprocess.run([ROOT / "build/release/bin/lacuna", *arguments], check=True, capture_output=True, text=True,
                          env={**os.environ, "LACUNA_DATA": str(bench.folder / "data")}).stdout


def foreign_cell(name, depth, runs, told):
    """The pictures of some runs of cycles(), as an integrator of a sweep; `told`: what it says of each."""
    return {"type": "foreign", "name": name, "max_depth": depth, "pictures": [
        {"file": pathlib.Path(r["file"]).name, "seed": r["seed"], "seconds": t["cpu_seconds"] / THREADS,
         "cpu_seconds": t["cpu_seconds"] / THREADS} for r, t in zip(runs, told)]}


def theirs(bench, job, scene, seconds):
    """Cycles as integrators of a sweep, its million samples a CPU second, and what it says of itself."""
    runs = [{"seed": seed, "roulette": roulette, "cpu_seconds": seconds, "file": str(bench.folder / f"{method}-{seed}.exr")}
            for method, roulette in CYCLES.items() for seed in SEEDS]
    told = cycles(bench.folder, {"scene": str(scene), "camera": job.get("camera", ""), "resolution": job["resolution"],
                                 "max_depth": DEPTH, "threads": THREADS, "runs": runs})
    cells, rates = [], {}
    for i, method in enumerate(CYCLES):
        of_method = slice(i * len(SEEDS), (i + 1) * len(SEEDS))
        of_runs = told["runs"][of_method]
        cells.append(foreign_cell(method, DEPTH, runs[of_method], of_runs))
        times = sum(t["cpu_seconds"] for t in of_runs)
        rates[method] = sum(t["samples"] for t in of_runs) * math.prod(job["resolution"]) / times / 1e6
    return cells, rates, told


def swept(bench, job, cells, seconds):
    """The folder of the sweep of all methods, and its report."""
    file, folder = bench.folder / "peers.json", bench.folder / "peers.sweep"
    shutil.rmtree(folder, ignore_errors=True)
    integrators = [{**method, "max_depth": DEPTH} for method in OURS.values()] + cells
    file.write_text(json.dumps({
        "seeds": len(SEEDS), "axes": {"/integrator": integrators}, "compare_at": {"clock": "cpu_seconds", "metric": "relmse"},
        "job": {**job, "reference": "reference-1/image.exr", "budget": {"cpu_seconds": seconds / THREADS}}}))
    lacuna(bench, "sweep", file, "--out", folder, "--quiet")
    return folder, json.loads(lacuna(bench, "report", folder, "--json"))


def rate(folders):
    """Million samples a CPU second of one thread."""
    reports = [json.loads((f / "report.json").read_text()) for f in folders]
    return sum(r["counts"]["samples"] for r in reports) / sum(r["seconds"]["render_cpu"] for r in reports) / THREADS / 1e6


def at_floor(folder):
    """Whether most of a run's last error is the reference's own noise."""
    with open(folder / "curve.csv", newline="") as file:
        return list(csv.DictReader(file))[-1]["at_floor"] == "1"


def judge(bench, name, efficiency, rates):
    """Speed without roulette, and errors at equal time against the better of Cycles."""
    best = max(efficiency[m] for m in CYCLES)
    quick = rates["path"] / rates["Cycles"]
    bench.figure(f"{name}: samples a CPU second, path / Cycles, both without roulette", f"{quick:.2f}", "at least 1.5",
                 quick >= 1.5)
    for method in PLAIN:
        plain = best / efficiency[method]
        bench.figure(f"{name}: relMSE at equal time, {method} / the better of Cycles", f"{plain:.3f}", "at most 0.5",
                     plain <= 0.5)
    good = best / max(efficiency[m] for m in OURS)
    bench.figure(f"{name}: relMSE at equal time, our best / the better of Cycles", f"{good:.3f}", "at most 0.33",
                 good <= 1 / 3)


def save(bench, folder, name):
    """The figure of a scene and its report in build/peers; prints the figure's table."""
    out = ROOT / "build/peers" / name.replace(", ", "-").replace(" ", "-")
    out.parent.mkdir(parents=True, exist_ok=True)
    spec = json.loads(lacuna(bench, "figure", "--suggest", folder))
    spec["scenes"][0]["name"] = name
    for method, label in zip(spec["methods"], (*OURS, *CYCLES)):
        method["name"] = label
    file = bench.folder / "figure.json"
    file.write_text(json.dumps({**spec, "sweep": folder.name}))
    lacuna(bench, "figure", file, "-o", out.with_suffix(".pdf"), "-o", out.with_suffix(".md"))
    lacuna(bench, "report", folder, "-o", out.with_suffix(".html"))
    print(out.with_suffix(".md").read_text())


def run(bench, options):
    seconds = options.peers_seconds
    for name, with_bulb in (("day", False), ("bulb", True)):
        (bench.folder / f"{name}.glb").write_bytes(furnished(with_bulb))
    known_answers(bench)
    for name in options.peers_scenes or SCENES:
        scene = bench.folder / "scene.glb"
        data, changed = diffuse_where_rough(found(SCENES[name]["scene"]).read_bytes())
        scene.write_bytes(data)
        job = {"resolution": [256, 144], **SCENES[name], "scene": scene.name, "threads": THREADS}
        cells, rates, told = theirs(bench, job, scene, seconds)
        references = [bench.render(f"reference-{seed}", {
            **job, "integrator": {**OURS["auto"], "max_depth": DEPTH}, "seed": 1000 + seed,
            "budget": {"cpu_seconds": LONGER * seconds / THREADS}})[0] for seed in SEEDS]
        folder, report = swept(bench, job, cells, seconds)
        print(f"  {name}: Cycles {told['version']}; diffuse in both: {', '.join(changed) or 'nothing new'}; CPU seconds of "
              f"Cycles to load {told['loading']:.2f}, to prepare {told['preparing']:.2f}")
        efficiency = {}
        for method, cell in zip((*OURS, *CYCLES), report["cells"]):
            runs = [folder / "runs" / r["name"] for r in cell["runs"]]
            ratio, beyond = agreement(bench, runs, references)
            bench.figure(f"{name}: blocks of {method} against the reference / noise", f"{ratio:.2f}",
                         f"at most 1.5, or 1 % of the mean beyond noise ({100 * beyond:.2f} %)", ratio <= 1.5 or beyond <= 0.01)
            efficiency[method] = cell["efficiency"]["value"]
            if method in ("path", "bdpt"):
                rates[method] = rate(runs)
        noisy = sum(at_floor(f) for f in (folder / "runs").iterdir())
        bench.figure(f"{name}: pictures whose MSE is mostly noise of the reference", str(noisy), "none", noisy == 0)
        judge(bench, name, efficiency, rates)
        print("  million samples a CPU second:", ", ".join(f"{m} {r:.3g}" for m, r in rates.items()))
        save(bench, folder, name)

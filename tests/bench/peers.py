"""Lacuna beside Blender's Cycles, on the same glTF files at equal CPU time.

First, scenes of known answers: does Cycles read materials, lights and lengths as Lacuna does? Then, for each scene, the
means of 16 x 16 pixels of both agree with those of one reference to their noise; only then are errors compared.
Materials that only one of the two has (rough gloss) are made diffuse for both.

CPU seconds are those of a process's threads while it renders. Cycles reports none: it renders 1 sample and n
samples a pixel with the scene prepared, and the difference is the time of n - 1. Writes a page with the pictures to
build/peers."""

import html
import json
import math
import os
import pathlib
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
LONGER = 6  # a reference takes so many times the time of a picture
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
    if "pictures" in spec and done.returncode == 0:
        return None
    raise SystemExit(f"bench: Blender failed\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


class Picture:
    """A picture of one method and seed: its file, samples a CPU second, and the CPU seconds of all threads."""

    def __init__(self, file, samples, seconds):
        self.file, self.rate, self.seconds = file, samples / seconds, seconds


def ours(bench, job, method, seconds, seed):
    out, report = bench.render(f"ours-{method.replace(', ', '-')}-{seed}", {
        **job, "integrator": {**OURS[method], "max_depth": DEPTH}, "seed": seed, "threads": THREADS,
        "budget": {"cpu_seconds": seconds / THREADS}})
    return Picture(out / "image.exr", report["counts"]["samples"], report["seconds"]["render_cpu"] * THREADS)


def theirs(bench, job, scene, seconds, seed):
    """{method: a picture}, and what Cycles says of itself."""
    runs = [{"seed": seed, "roulette": roulette, "cpu_seconds": seconds, "file": str(bench.folder / f"{method}-{seed}.exr")}
            for method, roulette in CYCLES.items()]
    told = cycles(bench.folder, {"scene": str(scene), "camera": job.get("camera", ""), "resolution": job["resolution"],
                                 "max_depth": DEPTH, "threads": THREADS, "runs": runs})
    pixels = math.prod(job["resolution"])
    pictures = [Picture(r["file"], t["samples"] * pixels, t["cpu_seconds"]) for r, t in zip(runs, told["runs"])]
    return dict(zip(CYCLES, pictures)), told


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
        return bench.compare(a.file, b.file, BLOCK)["block_rms"] ** 2

    distance = statistics.mean(squared(p, r) for p in pictures for r in references)
    noise = squared(*pictures) / 2 + squared(*references) / 2
    c = bench.compare(pictures[0].file, references[0].file, BLOCK)
    return math.sqrt(distance / noise), math.sqrt(max(0, distance - noise)) / c["mean_b"]


def measure(bench, job, scene, seconds):
    """{method: a picture of each seed}, references, what Cycles says of itself. Seed by seed: other work on the machine
    slows all of them."""
    pictures = {method: [] for method in (*OURS, *CYCLES)}
    for seed in SEEDS:
        found_by_cycles, told = theirs(bench, job, scene, seconds, seed)
        for method, picture in found_by_cycles.items():
            pictures[method].append(picture)
        for method in OURS:
            pictures[method].append(ours(bench, job, method, seconds, seed))
    references = [ours(bench, job, "auto", LONGER * seconds, 1000 + seed) for seed in SEEDS]
    return pictures, references, told


def noise_of(bench, references):
    """relMSE of a reference, from two."""
    return bench.compare(references[0].file, references[1].file, BLOCK)["relmse"] / 2


def errors(bench, pictures, references, noise):
    """relMSE of a method, without the references' own, `noise`."""
    return statistics.mean(bench.compare(p.file, r.file, BLOCK)["relmse"] for p in pictures for r in references) - noise


def rate(pictures):
    """Million samples a CPU second of one thread."""
    return statistics.mean(p.rate for p in pictures) / 1e6


def judge(bench, name, relmse, rates):
    """Speed without roulette, and errors against the better of Cycles."""
    best = min(relmse[m] for m in CYCLES)
    quick = rates["path"] / rates["Cycles"]
    bench.figure(f"{name}: samples a CPU second, path / Cycles, both without roulette", f"{quick:.2f}", "at least 1.5",
                 quick >= 1.5)
    for method in PLAIN:
        plain = relmse[method] / best
        bench.figure(f"{name}: relMSE at equal time, {method} / the better of Cycles", f"{plain:.3f}", "at most 0.5",
                     plain <= 0.5)
    good = min(relmse[m] for m in OURS) / best
    bench.figure(f"{name}: relMSE at equal time, our best / the better of Cycles", f"{good:.3f}", "at most 0.33",
                 good <= 1 / 3)


def row(name, relmse, rates):
    quick = " / ".join(f"{rates[m]:.3g}" for m in ("path", "bdpt", *CYCLES))
    best = min(relmse, key=relmse.get)
    cells = [f"{'**' if m == best else ''}{relmse[m]:.2g}{'**' if m == best else ''}" for m in (*OURS, *CYCLES)]
    return [name, quick, *cells]


def save_page(bench, folder, rows, pictures, told, seconds):
    """The table, and the pictures of each scene side by side."""
    cycles(bench.folder, {"pictures": pictures, "folder": str(folder)})
    head = ["scene", "samples", *OURS, *CYCLES]
    cells = "".join(f"<tr>{''.join(f'<td>{html.escape(c)}' for c in r)}" for r in [head, *rows])
    figures = "".join(f'<figure><img src="{png}"><figcaption>{html.escape(png[:-4])}</figcaption></figure>'
                      for _, png, _ in pictures)
    (folder / "index.html").write_text(
        "<!doctype html><meta charset=utf-8><title>Lacuna beside Cycles</title><style>body{font:14px sans-serif}"
        "td{padding:2px 10px}figure{display:inline-block;margin:4px}</style>"
        f"<h1>Lacuna beside Cycles {told['version']}</h1><p>{seconds:g} CPU seconds a picture, {THREADS} threads, paths of "
        f"{DEPTH} edges. samples: million a CPU second of path / bdpt / {' / '.join(CYCLES)}; the others: relMSE.</p>"
        f"<table>{cells}</table>{figures}")


def run(bench, options):
    seconds = options.peers_seconds
    folder = ROOT / "build/peers"
    folder.mkdir(parents=True, exist_ok=True)
    for name, with_bulb in (("day", False), ("bulb", True)):
        (bench.folder / f"{name}.glb").write_bytes(furnished(with_bulb))
    known_answers(bench)
    rows, gallery, told = [], [], {}
    for name in options.peers_scenes or SCENES:
        scene = bench.folder / "scene.glb"
        data, changed = diffuse_where_rough(found(SCENES[name]["scene"]).read_bytes())
        scene.write_bytes(data)
        job = {"resolution": [256, 144], **SCENES[name], "scene": scene.name}
        pictures, references, told = measure(bench, job, scene, seconds)
        print(f"  {name}: diffuse in both: {', '.join(changed) or 'nothing new'}; CPU seconds of Cycles to load "
              f"{told['loading']:.2f}, to prepare {told['preparing']:.2f}")
        for method, of_method in pictures.items():
            ratio, beyond = agreement(bench, of_method, references)
            bench.figure(f"{name}: blocks of {method} against the reference / noise", f"{ratio:.2f}",
                         f"at most 1.5, or 1 % of the mean beyond noise ({100 * beyond:.2f} %)", ratio <= 1.5 or beyond <= 0.01)
        noise = noise_of(bench, references)
        relmse = {m: errors(bench, p, references, noise) for m, p in pictures.items()}
        share = noise / min(relmse.values())
        bench.figure(f"{name}: relMSE of the reference / of the best", f"{share:.2f}", "at most 0.25", 0 <= share <= 0.25)
        rates = {m: rate(p) for m, p in pictures.items()}
        judge(bench, name, relmse, rates)
        rows.append(row(name, relmse, rates))
        exposure = bench.compare(references[0].file, references[1].file, BLOCK)["exposure"]
        slug = name.replace(", ", "-").replace(" ", "-")
        for method, shown in (*pictures.items(), ("reference", references)):
            kept = folder / f"{slug}-{method.replace(', ', '-')}.exr"
            kept.write_bytes(pathlib.Path(shown[0].file).read_bytes())
            gallery.append([str(kept), f"{kept.stem}.png", exposure])
    print(f"\nrelMSE at {seconds:g} CPU seconds, paths of {DEPTH} edges, Cycles {told['version']}; million samples a CPU "
          f"second of path / bdpt / {' / '.join(CYCLES)}\n")
    print("| scene | samples |", " | ".join((*OURS, *CYCLES)), "|")
    print("| --- | --- |" + " --- |" * (len(OURS) + len(CYCLES)))
    for r in rows:
        print("|", " | ".join(r), "|")
    save_page(bench, folder, rows, gallery, told, seconds)
    print(f"\npictures: {folder / 'index.html'}")

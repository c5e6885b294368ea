"""Renders the first figure of README.md, docs/pictures/ajar.jpg: a room lit through a door ajar, by methods of Lacuna and
by Blender's Cycles, after equal CPU time. `lacuna figure` draws it from a sweep with Cycles as a foreign cell.

Materials that only one of the two renderers has (rough gloss) are diffuse in both."""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import types

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/bench"))

import peers  # noqa: E402

THREADS, DEPTH, SEEDS = peers.THREADS, 8, (1, 2, 3)
GUIDED = {"type": "path", "reuse": 64, "guide": {"type": "learned_skeleton"}}
METHODS = {"path": {"type": "path"}, "path, guided": GUIDED,
           "bdpt, skeleton": {"type": "bdpt", "connections": {"type": "skeleton"}},
           "metropolis": {"type": "metropolis"}, "auto": {"type": "auto"}}
JOB = {"scene": "scene.glb", "camera": "room", "resolution": [384, 216], "threads": THREADS}


def cycles_cell(folder, seconds):
    """Cycles' pictures of all seeds, as an integrator of the sweep."""
    runs = [{"seed": s, "roulette": False, "cpu_seconds": seconds * THREADS, "file": str(folder / f"cycles-{s}.exr")}
            for s in SEEDS]
    told = peers.cycles(folder, {"scene": str(folder / "scene.glb"), "camera": JOB["camera"], "resolution": JOB["resolution"],
                                 "max_depth": DEPTH, "threads": THREADS, "runs": runs})
    return peers.foreign_cell("Cycles", DEPTH, runs, told["runs"])


def main():
    parser = argparse.ArgumentParser(prog="./dev pictures first", description=__doc__)
    parser.add_argument("--seconds", type=float, default=10, help="CPU seconds of each picture on each of two threads")
    parser.add_argument("--reference", type=float, default=360, help="the same of the reference")
    parser.add_argument("-o", "--out", default=ROOT / "docs/pictures/ajar.jpg", type=pathlib.Path)
    options = parser.parse_args()
    folder = ROOT / "build/first-page"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    bench = types.SimpleNamespace(folder=folder)
    os.environ["LACUNA_SCENES"] = str(folder)
    scene, _ = peers.diffuse_where_rough((ROOT / "jobs/scenes/ajar.glb").read_bytes())
    (folder / "scene.glb").write_bytes(scene)
    reference = folder / "reference.json"
    reference.write_text(json.dumps({**JOB, "seed": 1000, "integrator": {**GUIDED, "max_depth": DEPTH},
                                     "budget": {"cpu_seconds": options.reference}}))
    peers.lacuna(bench, "render", reference, "-o", folder / "reference.job", "--quiet")
    integrators = [cycles_cell(folder, options.seconds)] + [{**m, "max_depth": DEPTH} for m in METHODS.values()]
    sweep = folder / "first.json"
    sweep.write_text(json.dumps({
        "seeds": len(SEEDS), "axes": {"/integrator": integrators}, "compare_at": {"clock": "cpu_seconds", "metric": "relmse"},
        "job": {**JOB, "reference": "reference.job/image.exr", "budget": {"cpu_seconds": options.seconds}}}))
    peers.lacuna(bench, "sweep", sweep, "--out", folder / "first.sweep", "--quiet")
    spec = json.loads(peers.lacuna(bench, "figure", "--suggest", folder / "first.sweep"))
    spec["scenes"][0]["name"] = "Door ajar"
    for method, name in zip(spec["methods"], ("Cycles", *METHODS)):
        method["name"] = name
    figure, png = folder / "figure.json", folder / "figure.png"
    # Times to equal FLIP: one firefly can dominate relMSE.
    figure.write_text(json.dumps({**spec, "sweep": "first.sweep", "show": ["pictures", "table"],
                                  "metrics": ["flip", "relmse"], "dpi": 143}))
    peers.lacuna(bench, "figure", figure, "-o", png, "-o", folder / "figure.md")
    subprocess.run(["oiiotool", png, "--compression", "jpeg:92", "-o", options.out], check=True)
    print((folder / "figure.md").read_text())


main()

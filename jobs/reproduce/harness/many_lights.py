"""What the entries of Nabata et al. have in common: many lights on crops of 512 x 512 pixels. A crop keeps what the ratios
depend on, the number of lights and the pixels of a cache point, and takes a part of the time."""

import json

from harness import child
from harness.measured import Measured, exact

FULL = [512, 512]
# The lights that a light path gives, measured, decide how many paths the paper's number of lights takes.
SCENES = {
    "Hairball": {"scene": "hairball.glb", "camera": "front", "lights": 100_000, "paths": 34_800, "cache": 500,
                 "crop": [350, 170]},
    "Sponza": {"scene": "sponza/scene.glb", "camera": "atrium", "lights": 300_000, "paths": 285_000, "cache": 1414,
               "crop": [200, 260]},
    "Door": {"scene": "door/scene.glb", "camera": "corner", "lights": 100_000, "paths": 34_500, "cache": 1414,
             "crop": [200, 200]},
}


def visibility(name, cache_points=None, **more):
    value = {"type": name, **more}
    if cache_points is not None:
        value["cache_points"] = cache_points
    return value


def job(scene, how, full, share=1.0, side=64, **more):
    """One iteration of `share` of the paper's lights; `side`: pixels along a side of the crop, where not `full`."""
    s = SCENES[scene]
    value = {"scene": s["scene"], "camera": s["camera"], "budget": {"iterations": 1}, "checkpoint_seconds": 86400,
             "integrator": {"type": "many_lights", "max_depth": 6, "light_paths": round(s["paths"] * share),
                            "compensation": False, "visibility": how},
             "resolution": FULL if full else [side, side], **more}
    if full:
        value.pop("crop", None)
    else:
        value.setdefault("crop", {"of": FULL, "from": s["crop"]})
    return value


def cached(scene, full, side=64):
    """Cache points of the paper, as many as fall to the crop."""
    points = SCENES[scene]["cache"]
    return points if full else max(3, round(points * side * side / (FULL[0] * FULL[1])))


def render(run, name, value):
    """Renders a job into a folder of its own, once; gives its report."""
    folder = run.folder / run.version / name
    folder.parent.mkdir(parents=True, exist_ok=True)
    report = folder / "report.json"
    if not report.exists():
        file = folder.with_suffix(".json")
        file.write_text(json.dumps(value, indent=2) + "\n")
        child.lacuna("render", file, "--out", folder, "--quiet")
    return json.loads(report.read_text())


def seconds(report):
    return report["seconds"]["render_cpu"]


def errors(run, name, exact_name, *options):
    """Every error of one picture against another of the same lights, as `lacuna compare` prints them."""
    at = run.folder / run.version
    lines = child.lacuna("compare", at / name / "image.exr", at / exact_name / "image.exr", *options)[0].splitlines()
    return {words[0]: float(words[1]) for words in map(str.split, lines) if len(words) == 2}


def speed_up(run, scene, how, full):
    """Seconds of exact visibility over those of `how`, and the share of its tests that they save."""
    reports = {key: render(run, f"{scene}-{key}", job(scene, value, full))
               for key, value in {"exact": visibility("exact"), **how}.items()}
    times = {key: Measured(seconds(r)) for key, r in reports.items()}
    tests = {key: r["counts"]["shadow_rays"] for key, r in reports.items()}
    return {key: {"speed_up": times["exact"].ratio(times[key]), "seconds": times[key],
                  "saved": exact(1 - tests[key] / tests["exact"]),
                  "lights": reports[key]["integrator"]["virtual_lights"]} for key in reports}

"""Guides at equal CPU time, over the configurations of Fig. 77 of the thesis and ordinary scenes: the squared error of BSDF
sampling over that of each guide, by the errors that pictures estimate of themselves (est_rmse), geometric means over seeds."""

import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "jobs/reproduce"))

import noel_guides  # noqa: E402

GUIDES = {
    "bsdf": {"type": "bsdf"},
    "skeleton": {"type": "skeleton", "strength": "auto", "probability": "auto"},
    "sd_tree": {"type": "sd_tree"},
    "learned_skeleton": {"type": "learned_skeleton"},
}
OWN = "learned_skeleton"
WIDTH, HEIGHT = 192, 108
ORDINARY = {
    "door": {"scene": "door/scene.glb", "camera": "corner"},
    "cornell-box": {"scene": "cornell-box/scene.glb"},
    "cornell": {"scene": "cornell.glb"},
    "atrium": {"scene": "atrium.glb"},
    "area": {"scene": "area.glb"},
    "ajar": {"scene": "ajar.glb"},
    "nave": {"scene": "nave.glb"},
}


def scenes():
    """Jobs without integrator and budget, by name."""
    for name, given in noel_guides.SCENES.items():
        yield name, {p.lstrip("/"): v for p, v in given.items() if p not in ("/reference", "/resolution")}
    yield from ORDINARY.items()


def squared_error(bench, scene, guide, seconds, seeds):
    """Geometric mean over seeds, and the iterations of the first."""
    logs, iterations = [], 0
    for seed in range(1, seeds + 1):
        job = {**scene, "resolution": [WIDTH, HEIGHT], "analysis": {"resolution": 128}, "seed": seed, "threads": 1,
               "integrator": {"type": "path", "max_depth": 6, "guide": guide}, "budget": {"cpu_seconds": seconds}}
        report = bench.render("guide", job)[1]
        logs.append(2 * math.log(report["errors"]["est_rmse"]))
        iterations = iterations or report["counts"]["iterations"]
    return math.exp(sum(logs) / seeds), iterations


def geometric_mean(values):
    return math.exp(sum(math.log(v) for v in values) / len(values))


def run(bench, seconds, seeds):
    over_bsdf, over_best = [], []
    for name, scene in scenes():
        errors, iterations = {}, {}
        for guide, settings in GUIDES.items():
            errors[guide], iterations[guide] = squared_error(bench, scene, settings, seconds, seeds)
        gains = {guide: errors["bsdf"] / error for guide, error in errors.items()}
        print("  " + name + ": MSE of bsdf / of the guide (iterations): "
              + ", ".join(f"{guide} {gain:.2f} ({iterations[guide]})" for guide, gain in gains.items()), flush=True)
        over_bsdf.append(gains[OWN])
        over_best.append(gains[OWN] / max(gains["skeleton"], gains["sd_tree"]))
        bench.figure(f"{name}: MSE of bsdf / of {OWN}", f"{over_bsdf[-1]:.2f}", "at least 0.95", over_bsdf[-1] >= 0.95)
        bench.figure(f"{name}: MSE of the better of skeleton and sd_tree / of {OWN}", f"{over_best[-1]:.2f}",
                     "at least 0.95", over_best[-1] >= 0.95)
    mean = geometric_mean(over_best)
    bench.figure(f"all: MSE of the better of skeleton and sd_tree / of {OWN}", f"{mean:.2f}", "at least 1.3", mean >= 1.3)
    print(f"  all: MSE of bsdf / of {OWN}: {geometric_mean(over_bsdf):.2f}")

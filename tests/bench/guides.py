"""Guides at equal CPU time, over the configurations of Fig. 77 of the thesis and ordinary scenes: errors of BSDF sampling over
those of each guide. The error of a picture is told by pairs of them, of different seeds: they have no error in common."""

import itertools
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
THREADS = 2  # each has half of the CPU seconds
METRICS = ("mse", "relmse", "mae")
LEAST, LEAST_OVER_BEST = 0.95, 1.3
ORDINARY = {
    "door": {"scene": "door/scene.glb", "camera": "corner"},
    "cornell-box": {"scene": "cornell-box/scene.glb"},
    "cornell": {"scene": "cornell.glb"},
    "atrium": {"scene": "atrium.glb"},
    "area": {"scene": "area.glb"},
    "ajar": {"scene": "ajar.glb"},
    "nave": {"scene": "nave.glb"},
}
# Jobs without integrator and budget.
SCENES = {name: {p.lstrip("/"): v for p, v in given.items() if p not in ("/reference", "/resolution")}
          for name, given in noel_guides.SCENES.items()} | ORDINARY


def pairs(bench, scene, seconds, seeds):
    """Of each guide the errors of each pair of pictures, by their seeds; and the iterations of the first. The guides take turns:
    the speed of a machine drifts."""
    pictures, iterations = {guide: {} for guide in GUIDES}, {}
    for seed, (name, guide) in itertools.product(range(1, seeds + 1), GUIDES.items()):
        job = {**scene, "resolution": [WIDTH, HEIGHT], "analysis": {"resolution": 128}, "seed": seed, "threads": THREADS,
               "integrator": {"type": "path", "max_depth": 6, "guide": guide}, "budget": {"cpu_seconds": seconds / THREADS}}
        pictures[name][seed], report = bench.render(f"guide-{name}-{seed}", job)
        iterations.setdefault(name, report["counts"]["iterations"])
    return {name: ({(a, b): bench.compare(own[a] / "image.exr", own[b] / "image.exr", HEIGHT)
                    for a, b in itertools.combinations(own, 2)}, iterations[name]) for name, own in pictures.items()}


def mean(errors, metric, without=None):
    """Over all pairs that do not have the seed `without`."""
    values = [e[metric] for pair, e in errors.items() if without not in pair]
    return sum(values) / len(values)


def gain(plain, guided, metric, seeds):
    """Error of `plain` over that of `guided`, and the standard error of its logarithm (jackknife over seeds)."""
    ratio = mean(plain, metric) / mean(guided, metric)
    if seeds < 3:
        return ratio, math.nan
    logs = [math.log(mean(plain, metric, k) / mean(guided, metric, k)) for k in range(1, seeds + 1)]
    middle = sum(logs) / seeds
    return ratio, math.sqrt((seeds - 1) / seeds * sum((v - middle) ** 2 for v in logs))


def geometric_mean(values):
    return math.exp(sum(math.log(v) for v in values) / len(values))


def run(bench, seconds, seeds, names):
    over_bsdf, over_best = {m: [] for m in METRICS}, {m: [] for m in METRICS}
    for name in names or SCENES:
        told = pairs(bench, SCENES[name], seconds, seeds)
        gains = {guide: {m: gain(told["bsdf"][0], errors, m, seeds) for m in METRICS} for guide, (errors, _) in told.items()}
        for guide, (_, iterations) in told.items():
            print(f"  {name}: {guide}, {iterations} iterations: MSE, relMSE, MAE of bsdf / of the guide: "
                  + ", ".join(f"{value:.2f} ({deviation:.2f})" for value, deviation in gains[guide].values()), flush=True)
        for m in METRICS:
            over_bsdf[m].append(gains[OWN][m][0])
            over_best[m].append(gains[OWN][m][0] / max(gains["skeleton"][m][0], gains["sd_tree"][m][0]))
            for what, value in (("bsdf", over_bsdf[m][-1]), ("the better of skeleton and sd_tree", over_best[m][-1])):
                bench.figure(f"{name}: {m} of {what} / of {OWN}", f"{value:.2f}", f"at least {LEAST}", value >= LEAST)
    for m in METRICS:
        value = geometric_mean(over_best[m])
        bench.figure(f"all: {m} of the better of skeleton and sd_tree / of {OWN}", f"{value:.2f}",
                     f"at least {LEAST_OVER_BEST}", value >= LEAST_OVER_BEST)
        print(f"  all: {m} of bsdf / of {OWN}: {geometric_mean(over_bsdf[m]):.2f}")

"""Guesses of probabilistic visibility (docs/methods/visibility-guesses.md): variance times rays, and times CPU seconds.

A picture's light paths and eye paths depend on its seed alone. So what a picture differs from that of exact visibility with
the same seed is due to the tests that were not made; and what two pictures of exact visibility differ is due to the lights."""

import itertools
import math

SCENES = {
    "sponza": {"scene": "sponza/scene.glb", "camera": "atrium"},
    "hairball": {"scene": "hairball.glb"},
    "door": {"scene": "door/scene.glb", "camera": "corner"},
    "atrium": {"scene": "atrium.glb"},
}
FEW = {"cache_points": 200, "variance_points": 200, "epsilon_probability": .02}
GUESSES = {
    "cache_points": {},
    "200 cache_points": FEW,
    "200 cache_points, learned": {"reliability": "clusters", **FEW},
    "cells": {"guess": "cells", **FEW},
    "view_maps": {"guess": "view_maps", **FEW},
    "node_maps": {"guess": "node_maps", **FEW},
    "gates": {"guess": "gates", **FEW},
    "node_maps + gates": {"guess": {"type": "mixture", "of": ["node_maps", "gates"]}, **FEW},
    "gates, one cell": {"guess": "gates", "reliability": "picture", **FEW},
    "gates, assumed": {"guess": "gates", "reliability": "assumed", **FEW},
}
BEST, WORST = 1.5, .95


def pictures(bench, scene, options):
    """{(name, seed): (folder, report)} of exact visibility and of each guess."""
    found = {}
    for seed, (name, more) in itertools.product(range(1, options.visibility_seeds + 1),
                                                [("exact", None), *GUESSES.items()]):
        visibility = {"type": "exact"} if more is None else {"type": "probabilistic", **more}
        job = {**SCENES[scene], "resolution": [options.visibility_width, options.visibility_width // 2], "seed": seed,
               "integrator": {"type": "many_lights", "max_depth": 4, "light_paths": options.visibility_paths,
                              "compensation": False, "visibility": visibility},
               "budget": {"iterations": options.visibility_iterations}}
        found[name, seed] = bench.render(f"visibility-{scene}-{name}-{seed}".replace(" ", ""), job)
    return found


def mean_and_error(values):
    middle = sum(values) / len(values)
    if len(values) < 2:
        return middle, math.nan
    return middle, math.sqrt(sum((v - middle) ** 2 for v in values) / (len(values) - 1) / len(values))


def measure(bench, scene, options):
    """Prints a line for each guess; gives MSE times CPU seconds of each, relative to exact visibility."""
    found = pictures(bench, scene, options)
    seeds = range(1, options.visibility_seeds + 1)

    def mse(a, b):
        return bench.compare(found[a][0] / "image.exr", found[b][0] / "image.exr", 8)["mse"]

    # Two pictures have twice the variance of one.
    lights = sum(mse(("exact", a), ("exact", b)) / 2 for a, b in itertools.combinations(seeds, 2))
    lights /= math.comb(len(seeds), 2)
    costs = {}
    for name in ("exact", *GUESSES):
        ratios = {"variance": [], "rays": [], "cpu": []}
        for seed in seeds:
            own, exact = found[name, seed][1], found["exact", seed][1]
            ratios["variance"].append(1 + mse((name, seed), ("exact", seed)) / lights)
            ratios["rays"].append(rays_of(own) / rays_of(exact))
            ratios["cpu"].append(own["seconds"]["render_cpu"] / exact["seconds"]["render_cpu"])
        by_rays, rays_error = mean_and_error([v * r for v, r in zip(ratios["variance"], ratios["rays"])])
        by_cpu, cpu_error = mean_and_error([v * c for v, c in zip(ratios["variance"], ratios["cpu"])])
        costs[name] = by_cpu
        wrong = [f"{k.split('_wrong_if_')[1]} {v:.3f}" for k, v in found[name, 1][1]["integrator"].items()
                 if "_wrong_if_" in k]
        print(f"  {scene}: {name}: variance {mean_and_error(ratios['variance'])[0]:.3f}, rays "
              f"{mean_and_error(ratios['rays'])[0]:.3f}, CPU {mean_and_error(ratios['cpu'])[0]:.3f}; variance x rays "
              f"{by_rays:.3f} ({rays_error:.3f}), x CPU {by_cpu:.3f} ({cpu_error:.3f})"
              + (f"; wrong if {', '.join(wrong)}" if wrong else ""), flush=True)
    return costs


def rays_of(report):
    return report["counts"]["rays"] + report["counts"]["shadow_rays"]


def run(bench, options):
    gains = []
    for scene in options.visibility_scenes or SCENES:
        costs = measure(bench, scene, options)
        others = {name: costs["cache_points"] / cost for name, cost in costs.items() if name in GUESSES}
        best = max(others, key=others.get)
        gains.append(others[best])
        bench.figure(f"{scene}: variance x CPU of cache_points / of the best, {best}", f"{others[best]:.2f}",
                     f"at least {WORST}", others[best] >= WORST)
    middle = math.exp(sum(map(math.log, gains)) / len(gains))
    bench.figure("geometric mean of these", f"{middle:.2f}", f"at least {BEST}", middle >= BEST)

"""The table of README.md: each method's error over that of the best fixed one, and what `auto` chose."""

import bench
import regret

SECONDS, SEEDS = 10, 2
INTEGRATORS = {method["type"] for method in regret.METHODS.values()}
NAMES = {"path, reuse 16": "`path`, `reuse` 16",
         "path, learned_skeleton, reuse 64": "`path`, `reuse` 64, guide `learned_skeleton`", "metropolis": "`metropolis`",
         "bdpt, skeleton": "`bdpt`, `skeleton`", "many_lights": "`many_lights`", "auto": "`auto`"}


def lines(folder):
    runs = regret.Runs(bench.BIN / "lacuna", folder)
    found = {}
    for scene in regret.SCENES:
        found[scene] = regret.measure(runs, scene, [SECONDS], SEEDS)
        print(scene, flush=True)
    return list(regret.lines(found, SECONDS, "relmse", f"256 x 144 pixels, 6 edges, {SEEDS} seeds", NAMES))

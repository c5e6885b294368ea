"""The table of README.md: each method's error over that of the best fixed one, and what `auto` chose."""

import bench
import regret

SECONDS, SEEDS = 10, 2
NAMES = {"path, reuse 16": "`path`, `reuse` 16",
         "path, learned_skeleton, reuse 64": "`path`, `reuse` 64, guide `learned_skeleton`", "metropolis": "`metropolis`",
         "bdpt, skeleton": "`bdpt`, `skeleton`", "many_lights": "`many_lights`", "auto": "`auto`"}


def lines(folder):
    runs = regret.Runs(bench.BIN / "lacuna", folder)
    found = {}
    for scene in regret.SCENES:
        found[scene] = regret.measure(runs, scene, [SECONDS], SEEDS)
        print(scene, flush=True)
    rows = regret.rows(found, SECONDS, "relmse")
    return [f"| scene | {' | '.join(NAMES.values())} | `auto` chose |", "| --- |" + " --- |" * (len(NAMES) + 1), *rows]

"""The table of docs/methods/samplers.md: MSE with independent numbers over that with low-discrepancy sequences."""

import bench
import sampler

INTEGRATORS = {integrator["type"] for _, integrator, _ in sampler.METHODS}
NAMES = {"path, direct light": "`path`, direct light", "path": "`path`, 6 edges", "bdpt": "`bdpt` `paired`, 6 edges",
         "bdpt, skeleton": "`bdpt` `skeleton`, 6 edges", "light": "`light`, 6 edges"}


def shown(ratio):
    return f"{ratio:.0f}" if ratio >= 10 else f"{ratio:.2g}"


def lines(_):
    gains = {}
    with bench.Bench() as renderer:
        for method, scene, ratio, _ in sampler.gains(renderer):
            gains.setdefault(method, {})[scene] = ratio
            print(f"{method}, {scene}: {ratio:.2f}", flush=True)
    scenes = list(next(iter(gains.values())))
    return [f"| | {' | '.join(scenes)} |", "| --- |" + " --- |" * len(scenes),
            *(f"| {NAMES[method]} | {' | '.join(f'{shown(of[scene])}' for scene in scenes)} |" for method, of in gains.items())]

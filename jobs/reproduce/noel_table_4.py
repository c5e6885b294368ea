"""Noel 2015, Table 4: the time of the lights' sum with node maps over that without shadows."""

from harness import shadows
from harness.measured import median_of
from harness.run import Table

SEEDS = 6


def measure(run):
    rows = []
    for view, quantity in (("Sponza", "Sponza1"), ("Door", "Door")):
        for paths in (500, 1000, 2000):
            times = {how: [shadows.sum_seconds(run, view, how, paths, seed) for seed in range(SEEDS)]
                     for how in ("none", "node_maps")}
            ratio = median_of([a / b for (a, _), (b, _) in zip(times["node_maps"], times["none"])])
            exact = shadows.sum_seconds(run, view, "exact", paths, 0)[0]
            nodes = shadows.report(run, view, "node_maps", paths, 3)["integrator"]["nodes_used"]
            rows.append((view, round(times["none"][0][1]), round(nodes),
                         *(str(median_of([t for t, _ in times[how]])) for how in ("node_maps", "none")), f"{exact:.3g}",
                         str(ratio)))
        run.found(quantity, ratio)  # of the most lights
    run.tables.append(Table(("view", "lights", "nodes", "node maps, CPU seconds", "none", "exact", "node maps / none"), rows))
    run.note("1024 x 512 pixels; ours are sponza, atrium, and door, corner; apartment is not ours to have")

"""Nabata et al., Fig. 3: time and error of probabilistic visibility on the hairball against the number of cache points.
The error is that against exact visibility with the same lights; the paper's, against path tracing, also has the lights'."""

from harness import many_lights
from harness.many_lights import visibility
from harness.measured import exact
from harness.run import Table

POINTS = [125, 250, 500, 1000, 2000, 4000, 8000]  # of the whole picture
LEVEL = 1.1  # the error has levelled off where twice the points make it less than this times smaller


def measure(run):
    side = 64
    many_lights.render(run, "exact", many_lights.job("Hairball", visibility("exact"), run.full, 0.25, side))
    rows = []
    for points in POINTS:
        here = points if run.full else max(1, round(points * side * side / (512 * 512)))
        report = many_lights.render(
            run, f"{points}", many_lights.job("Hairball", visibility("probabilistic", here), run.full, 0.25, side))
        rows.append((points, many_lights.seconds(report), report["integrator"]["visibility_cpu_seconds"],
                     many_lights.errors(run, f"{points}", "exact")["rmse"]))
    level = [a[0] for a, b in zip(rows, rows[1:]) if a[3] < LEVEL * b[3]]
    run.found("cache points from which on the error levels off", exact(level[0]) if level else None)
    run.tables.append(Table(("cache points", "CPU seconds", "of these for cache points", "RMSE"),
                            [(n, f"{s:.3g}", f"{c:.3g}", f"{e:.3g}") for n, s, c, e in rows]))
    run.note("a quarter of the lights of Table 1" + ("" if run.full else "; a crop, with its share of the cache points"))

"""Noel 2015, Table 2: the time of a frame with gates against the number of lights."""

from harness import shadows
from harness.measured import median_of
from harness.run import Table

SEEDS = 6


def measure(run):
    rows = []
    for lights in (512, 1024, 2048):
        found = [shadows.report(run, "Sponza", "gates", lights, 3, seed) for seed in range(SEEDS)]
        time = median_of([1000 * r["seconds"]["render_cpu"] for r in found])
        run.found(f"{lights} lights", time)
        rows.append((lights, round(found[0]["integrator"]["virtual_lights"]), str(time)))
    run.tables.append(Table(("light paths", "lights", "CPU milliseconds"), rows))
    run.note("ours: CPU time of 1024 x 512 pixels, the light paths and direct light by rays included; sponza, atrium")

"""Nabata et al., Fig. 5: how many lights probabilistic visibility affords on the hairball in the time that exact visibility
takes for 2000."""

from harness import many_lights
from harness.many_lights import visibility
from harness.measured import exact
from harness.run import Table

LIGHTS = 100_000  # of many_lights.job() with a share of 1
EXACT = 2000
TRIED = [2000, 4000, 8000, 16000, 32000]


def measure(run):
    side = 128
    points = many_lights.cached("Hairball", run.full, side)

    def timed(how, lights):
        name = f"{how['type']}-{lights}"
        job = many_lights.job("Hairball", how, run.full, lights / LIGHTS, side)
        report = many_lights.render(run, name, job)
        return report["integrator"]["virtual_lights"], many_lights.seconds(report)

    lights, limit = timed(visibility("exact"), EXACT)
    rows = [timed(visibility("probabilistic", points), n) for n in TRIED]
    affords = None
    for (n0, t0), (n1, t1) in zip(rows, rows[1:]):
        if t0 <= limit < t1:
            affords = n0 + (n1 - n0) * (limit - t0) / (t1 - t0)
    run.found("lights, exact", exact(lights))
    if affords is not None:
        run.found("lights, probabilistic", exact(affords))
        run.found("lights, probabilistic / exact", exact(affords / lights))
    run.tables.append(Table(("visibility", "lights", "CPU seconds"),
                            [("exact", round(lights), f"{limit:.3g}")] +
                            [("probabilistic", round(n), f"{t:.3g}") for n, t in rows]))

"""Nabata et al., Fig. 4: the share of the lights that each pixel of the hairball tests."""

from harness import layers, many_lights
from harness.many_lights import visibility
from harness.run import Table

AT = (0.1, 0.25, 0.5, 0.75, 0.9)


def measure(run):
    side = 128
    rows = []
    for key, how in (("probabilistic", visibility("probabilistic", many_lights.cached("Hairball", run.full, side))),
                     ("as published", visibility("probabilistic", many_lights.cached("Hairball", run.full, side),
                                                 term_cost=0, variance="point")),
                     ("Veach", visibility("roulette", many_lights.cached("Hairball", run.full, side)))):
        many_lights.render(run, key, many_lights.job("Hairball", how, run.full, 0.25, side, layers=["visibility_tests"]))
        shares = sorted(layers.channels(run.folder / run.version / key, "visibility_tests")[0])
        rows.append((key, *(f"{shares[int(q * (len(shares) - 1))]:.1%}" for q in AT)))
    run.tables.append(Table(("visibility", *(f"{q:.0%} of the pixels below" for q in AT)), rows))
    run.note(f"of all lights, those that turn away included; pictures: {run.folder / run.version}")

"""Noel 2015, Fig. 91: rays through portals against BSDF sampling on door, after as many iterations of each."""

from harness import guided


def measure(run):
    guided.measure_iterations(run, {"portals": {"type": "portals", "probability": 0.5}, "portals, learned": {"type": "portals"}},
                              "error of BSDF sampling / of portals, at equal iterations")

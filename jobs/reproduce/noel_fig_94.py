"""Noel 2015, Fig. 94: rays towards bright faces against BSDF sampling on door, after as many iterations of each. The
thesis' pictures are too bright; ours have the densities that it got wrong (10.4.2)."""

from harness import guided


def measure(run):
    guided.measure_iterations(run, {"face irradiance": {"type": "face_irradiance", "probability": 0.5},
                                    "face irradiance, learned": {"type": "face_irradiance"}},
                              "error of BSDF sampling / of face irradiance, at equal iterations")

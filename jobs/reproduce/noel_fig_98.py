"""Noel 2015, Fig. 98: BPT, SkelBPT and ICBPT on door at equal time."""

from harness import resampling


def measure(run):
    resampling.measure_errors(run, "door")

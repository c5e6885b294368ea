"""Noel 2015, Fig. 99: BPT, SkelBPT and ICBPT on sponza at equal time."""

from harness import resampling


def measure(run):
    resampling.measure_errors(run, "sponza")

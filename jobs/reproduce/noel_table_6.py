"""Noel 2015, Table 6: time to equal L1 error of bidirectional path tracing with paired connections (BPT), importance
caching (ICBPT) and the skeleton (SkelBPT). The corridor, and the thesis' own settings, stand beside."""

from harness import resampling
from harness.measured import speed_up_to, time_to

METHODS = {"BPT": resampling.PAIRED, "ICBPT": resampling.CACHE, "SkelBPT": resampling.SKELETON}
FIRST = {"Door": "Door to 0.01, BPT", "Sponza": "Sponza to 0.15, BPT"}


def sweep(full):
    return resampling.sweep(full, resampling.SCENES, resampling.METHODS)


def measure(run):
    answers = run.answers(sweep(run.full))
    for name, first in FIRST.items():
        for method, connections in METHODS.items():
            to = resampling.cell(answers, name.lower(), connections)["to"][-1]
            run.found(first if method == "BPT" else f"{name}, {method}", time_to(to))
            if method != "BPT":
                run.found(f"{name}, {method}: speed-up", speed_up_to(to))
    run.tables += resampling.tables(answers, resampling.SCENES, resampling.METHODS)
    run.note("seconds: CPU seconds of a core; equal error: the lowest MAE that every run of a scene reached")
    run.note(f"{answers['seeds']} runs each, {sweep(run.full)['job']['budget']['cpu_seconds']} s; the thesis' runs took "
             "hours, where single bright pixels count less")

"""Noel 2015, Table 6: time to equal L1 error of bidirectional path tracing with paired connections (BPT), importance
caching (ICBPT) and the skeleton (SkelBPT), all at this project's settings. The corridor, and all three at the settings of
the thesis, stand beside."""

from harness import resampling
from harness.measured import speed_up_to, time_to

FIRST = {"Door": "Door to 0.01, BPT", "Sponza": "Sponza to 0.15, BPT"}


def measure(run):
    published = run.answers(resampling.sweep(run.full, resampling.THESIS, ("door", "sponza")), shared="noel-published")
    answers = resampling.ours(run)
    for name, first in FIRST.items():
        for method in ("BPT", "ICBPT", "SkelBPT"):
            to = resampling.cell(answers, name.lower(), resampling.OURS[method])["to"][-1]
            run.found(first if method == "BPT" else f"{name}, {method}", time_to(to))
            if method != "BPT":
                run.found(f"{name}, {method}: speed-up", speed_up_to(to))
    run.tables += [resampling.table(answers, scene, resampling.OURS) for scene in resampling.SCENES]
    run.tables += [resampling.table(published, scene, resampling.THESIS, ", as published") for scene in ("door", "sponza")]
    run.note("CPU seconds of a core; equal error: the lowest MAE that every run of a scene reached; "
             f"{answers['seeds']} runs each")

"""Path tracing in the thesis' corridor, without and with next event estimation, against its author's own render."""

import json
import math

from harness import child
from harness.measured import error_at, gain_at, of_answer, speed_up_to, time_to
from harness.run import cell_with

JOB = child.ROOT / "jobs/examples/corridor.json"
SWITCH = "/integrator/next_event_estimation"


def sweep(full):
    """CPU seconds are the clock: they hold on a busy machine, too."""
    job = json.loads(JOB.read_text())
    del job["label"]
    return {
        "label": "next event estimation in the corridor",
        "job": {**job, "budget": {"cpu_seconds": 240 if full else 8}},
        "axes": {SWITCH: [False, True]},
        "seeds": 10 if full else 3,
        "baseline": {SWITCH: False},
        "compare_at": {"clock": "cpu_seconds", "metric": "relmse"},
    }


def mean_radiance(run, cell):
    """Of the reference that the runs were compared with."""
    report = json.loads((run.runs / cell["runs"][0]["name"] / "report.json").read_text())
    reference = report["errors"]["reference"]["file"]
    lines = dict(line.split(maxsplit=1) for line in child.lacuna("compare", reference, reference)[0].splitlines())
    return float(lines["mean_b"])


def measure(run):
    answers = run.answers(sweep(run.full))
    cells = {"without": cell_with(answers, next_event_estimation=False),
             "with": cell_with(answers, next_event_estimation=True)}
    mean = mean_radiance(run, cells["with"])
    for name, cell in cells.items():
        run.found(f"relMSE at equal time, {name}", error_at(cell["at"][-1]))
        run.found(f"CPU seconds to equal relMSE, {name}", time_to(cell["to"][-1]))
        bias = of_answer(cell["bias_between_runs"])
        run.found(f"squared bias / squared mean radiance, {name}", bias and bias.scaled(1 / mean**2))
        if bias and bias.low is not None and bias.low <= 0:
            within = math.sqrt(max(bias.high, 0)) / mean
            run.note(f"{name}: unbiased within {within:.0%} of the mean radiance {mean:.4g}")
    at, to = cells["with"]["at"][-1], cells["with"]["to"][-1]
    run.found("error without / with, at equal time", gain_at(at))
    run.found("time without / with, to equal relMSE", speed_up_to(to))
    run.note(f"equal time: {at['seconds']:.3g} CPU seconds; equal error: relMSE {to['error']:.3g}; "
             f"{answers['seeds']} runs each; the reference's own noise is not known and counts as bias")

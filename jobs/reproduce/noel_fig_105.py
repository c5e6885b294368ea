"""Noel 2015, Fig. 105: errors and times after as many iterations of each method."""

from harness import resampling
from harness.measured import median_of

METHODS = {name: resampling.OURS[name] for name in ("BPT", "ICBPT", "SkelBPT")}


def sweep(full):
    value = resampling.sweep(full, METHODS, ("door",), seeds=6)
    value["job"]["budget"] = {"iterations": 64 if full else 8}
    return value


def measure(run):
    answers = run.answers(sweep(run.full))
    cells = {name: resampling.cell(answers, "door", value) for name, value in METHODS.items()}
    reports = {name: [run.report(c, seed) for seed in range(answers["seeds"])] for name, c in cells.items()}

    def ratio(of, to, value):
        return median_of([value(a) / value(b) for a, b in zip(reports[of], reports[to])])

    def error(report):
        return report["errors"]["mae"]

    run.found("error of BPT / of ICBPT, at equal iterations", ratio("BPT", "ICBPT", error))
    run.found("error of SkelBPT / of ICBPT, at equal iterations", ratio("SkelBPT", "ICBPT", error))
    run.found("time of ICBPT / of BPT", ratio("ICBPT", "BPT", lambda report: report["seconds"]["render_cpu"]))
    run.note(f"MAE after {sweep(run.full)['job']['budget']['iterations']} iterations; medians of {answers['seeds']} runs")

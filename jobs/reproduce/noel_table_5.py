"""Noel 2015, Table 5: nodes of the filtered skeleton, and how many of them have distributions in an iteration."""

from harness import resampling
from harness.measured import exact

SKELETON = resampling.OURS["SkelBPT"]


def sweep(full):
    value = resampling.sweep(full, {"SkelBPT": SKELETON}, ("door", "sponza"), seeds=1)
    del value["compare_at"], value["baseline"]
    for scene in value["zip"]:
        del scene["/reference"]
    value["job"]["budget"] = {"iterations": 16 if full else 4}
    return value


def measure(run):
    answers = run.answers(sweep(run.full))
    for name in ("Door", "Sponza"):
        told = run.report(resampling.cell(answers, name.lower(), SKELETON))["integrator"]
        run.found(f"{name}, nodes", exact(told["nodes"]))
        run.found(f"{name}, per iteration", exact(told["nodes_used"]))
        passes = {key: told[f"{key}_cpu_seconds"] for key in ("light_pass", "distributions", "eye_pass")}
        run.note(f"{name}: the distributions take {passes['distributions'] / sum(passes.values()):.1%} of an iteration")

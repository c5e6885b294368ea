"""Noel 2015, Table 5: nodes of the filtered skeleton, and how many of them have distributions in an iteration."""

import json

from harness import resampling
from harness.measured import exact


def sweep(full):
    value = resampling.sweep(full, ("door", "sponza"), {"skeleton": resampling.SKELETON})
    del value["compare_at"], value["baseline"]
    for scene in value["zip"]:
        del scene["/reference"]
    return {**value, "seeds": 1, "job": {**value["job"], "budget": {"iterations": 16 if full else 4}}}


def measure(run):
    answers = run.answers(sweep(run.full))
    for name in ("Door", "Sponza"):
        done = resampling.cell(answers, name.lower(), resampling.SKELETON)["runs"][0]["name"]
        told = json.loads((run.sweep_folder / "runs" / done / "report.json").read_text())["integrator"]
        run.found(f"{name}, nodes", exact(told["nodes"]))
        run.found(f"{name}, per iteration", exact(told["nodes_used"]))
        passes = {key: told[f"{key}_cpu_seconds"] for key in ("light_pass", "distributions", "eye_pass")}
        run.note(f"{name}: the distributions take {passes['distributions'] / sum(passes.values()):.1%} of an iteration")

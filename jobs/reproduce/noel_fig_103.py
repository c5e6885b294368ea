"""Noel 2015, Fig. 103: L1 error against time."""

from harness import resampling
from harness.measured import error_at, gain_at
from harness.run import Table


def measure(run):
    answers = resampling.ours(run)
    for name in ("Door", "Sponza"):
        cells = {method: resampling.cell(answers, name.lower(), value) for method, value in resampling.OURS.items()}
        run.found(f"{name}: error of BPT / of SkelBPT", gain_at(cells["SkelBPT"]["at"][-1]))
        run.tables.append(Table((f"{name}, CPU seconds", *cells), [
            (f"{at['seconds']:.3g}", *(str(error_at(c["at"][i])) for c in cells.values()))
            for i, at in enumerate(cells["BPT"]["at"])]))
    run.note(f"MAE, {answers['seeds']} runs each; the curves: lacuna report {run.runs}")

"""What scripts measure with, on a sweep of a few pixels."""

import pathlib
import tempfile
import unittest

from harness import child
from harness.entry import Entry
from harness.measured import Measured, of_answer
from harness.output import run_json, run_text
from harness.run import Run, Table, cell_with
from harness.verdict import at_least, beside

SWEEP = {
    "label": "small", "seeds": 2, "baseline": {"/integrator/max_depth": 2},
    "job": {"scene": "cornell.glb", "resolution": [12, 8], "budget": {"iterations": 8}},
    "axes": {"/integrator/max_depth": [2, 3]},
}
ENTRY = Entry("noel-table-9", "a paper, Table 9", "what it claims", "path",
              (at_least("gain", 1.5), beside("seconds", 20, "s"), at_least("elsewhere", 1)))


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.run_ = Run(ENTRY, False, pathlib.Path(folder.name))

    def test_a_sweep_is_rendered_once_and_answered(self):
        answers = self.run_.answers(SWEEP)
        cell = cell_with(answers, max_depth=3)
        self.assertEqual((cell["done"], cell["baseline"]), (2, 1))
        self.assertGreater(of_answer(cell["efficiency"]).low, 0)
        self.assertTrue(self.run_.complete)
        rendered = {p: p.stat().st_mtime_ns for p in self.run_.runs.glob("*/image.exr")}
        self.assertEqual(len(rendered), 4)
        self.assertEqual(self.run_.answers(SWEEP)["cells"], answers["cells"])
        self.assertEqual({p: p.stat().st_mtime_ns for p in rendered}, rendered)
        with self.assertRaises(KeyError):
            cell_with(answers, max_depth=4)
        with self.assertRaises(KeyError):
            cell_with(answers)

    def test_another_sweep_in_the_same_folder_is_refused(self):
        self.run_.answers(SWEEP)
        with self.assertRaises(child.Failed) as refused:
            self.run_.answers({**SWEEP, "seeds": 3})
        self.assertEqual(refused.exception.code, 2)

    def test_a_scene_that_is_not_there_is_told(self):
        with self.assertRaisesRegex(child.Failed, "no run is done of: max_depth 2"):
            self.run_.answers({**SWEEP, "job": {**SWEEP["job"], "scene": "nowhere.glb"}})

    def test_what_is_not_claimed_cannot_be_found(self):
        with self.assertRaises(KeyError):
            self.run_.found("gian", Measured(2))

    def test_text_and_json_say_the_same(self):
        self.run_.found("gain", Measured(3.0, 2.0, 4.5, 3))
        self.run_.found("seconds", Measured(10.0, 9.0, 11.0, 3, supported=False))
        self.run_.tables.append(Table(("grid", "nodes"), [("a", 12345)]))
        self.run_.note("of two scenes")
        text, value = run_text(self.run_), run_json(self.run_)
        self.assertRegex(text, r"gain +>= 1\.5 +3 \[2, 4\.5\] +2 \[1\.33, 3\] +reached\n")
        self.assertRegex(text, r"seconds +20 s +\(10 \[9, 11\]\) +\(0\.5 \[0\.45, 0\.55\]\)\n")
        self.assertRegex(text, r"elsewhere +>= 1 +not measured\n")
        self.assertRegex(text, r"grid +nodes\na +12345\n")
        self.assertRegex(text, r"note: of two scenes\nnote: 1 of 3 not measured\nnote: \(in parentheses")
        self.assertEqual([row["verdict"] for row in value["rows"]], ["reached", None, "not measured"])
        self.assertEqual(value["rows"][0]["ratio"]["value"], 2.0)
        self.assertEqual(value["rows"][0]["claim"],
                         {"quantity": "gain", "figure": 1.5, "unit": "", "low": 1.5, "high": None})
        self.assertIsNone(value["rows"][2]["ours"])

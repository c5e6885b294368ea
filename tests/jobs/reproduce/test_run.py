"""What scripts measure with, on a sweep of a few pixels."""

import pathlib
import tempfile
import unittest
from unittest import mock

from harness import child, identity
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

    def test_another_sweep_has_a_folder_of_its_own(self):
        self.run_.answers(SWEEP)
        first = self.run_.runs
        answers = self.run_.answers({**SWEEP, "seeds": 1})
        self.assertEqual(answers["seeds"], 1)
        self.assertNotEqual(self.run_.runs, first)
        self.assertEqual(len(list(first.glob("*/image.exr"))), 4)

    def test_a_report_is_used_again_only_for_the_same_job_program_and_scene(self):
        job = {**SWEEP["job"], "integrator": {"type": "path", "max_depth": 2}, "budget": {"iterations": 2}}
        report = self.run_.render("picture", job)
        first = self.run_.place("picture")
        rendered = (first / "image.exr").stat().st_mtime_ns
        self.assertEqual(self.run_.render("picture", job), report)
        self.assertEqual((first / "image.exr").stat().st_mtime_ns, rendered)
        self.run_.render("picture", {**job, "seed": 7})
        self.assertNotEqual(self.run_.place("picture"), first)
        places = {first, self.run_.place("picture")}
        with mock.patch.object(identity, "programs", return_value={"lacuna": "another build"}):
            self.run_.render("picture", job)
            places.add(self.run_.place("picture"))
        with mock.patch.object(identity, "files_named", return_value={"cornell.glb": "another scene"}):
            self.run_.render("picture", job)
            places.add(self.run_.place("picture"))
        self.assertEqual(len(places), 4)
        (first / "outcome.json").write_text('{"state": "running"}')  # one that was stopped is not a result
        with mock.patch.object(child, "lacuna") as rendering:
            self.run_.render("picture", job)
        rendering.assert_called_once()

    def test_a_scene_that_a_job_names_is_recorded(self):
        self.assertEqual(set(self.run_.uses({"scene": "cornell.glb", "label": "no file", "list": ["mirror.glb", 3]})),
                         {"cornell.glb", "mirror.glb"})
        self.assertEqual(set(self.run_.inputs), {"cornell.glb", "mirror.glb"})

    def test_repeated_runs_differ_by_their_seed_alone(self):
        job = {**SWEEP["job"], "integrator": {"type": "path", "max_depth": 2}, "budget": {"iterations": 2}}
        with mock.patch.object(self.run_, "render", side_effect=lambda name, value: (name, value)):
            self.assertEqual(self.run_.repeated("a", job, 2), [("a-0", {**job, "seed": 0}), ("a-1", {**job, "seed": 1})])

    def test_a_scene_that_is_not_there_is_told(self):
        with self.assertRaisesRegex(child.Failed, "no run is done of: max_depth 2"):
            self.run_.answers({**SWEEP, "job": {**SWEEP["job"], "scene": "nowhere.glb"}})

    def test_what_is_not_claimed_cannot_be_found(self):
        with self.assertRaises(KeyError):
            self.run_.found("gian", Measured(2))

    def test_text_and_json_say_the_same(self):
        self.run_.found("gain", Measured(3.0, 2.0, 4.5, 3))
        self.run_.found("gain", published=Measured(1.2))
        self.run_.found("seconds", Measured(10.0, 9.0, 11.0, 3, supported=False))
        self.run_.tables.append(Table(("grid", "nodes"), [("a", 12345)]))
        self.run_.note("of two scenes")
        text, value = run_text(self.run_), run_json(self.run_)
        self.assertRegex(text, r"gain +>= 1\.5 +1\.2 +one run +3 \[2, 4\.5\] +reached\n")
        self.assertRegex(text, r"seconds +20 s +\(10 \[9, 11\]\)\n")
        self.assertRegex(text, r"elsewhere +>= 1 +not measured +not measured\n")
        self.assertRegex(text, r"grid +nodes\na +12345\n")
        self.assertRegex(text, r"note: of two scenes\nnote: 1 of 3 not measured\nnote: \(in parentheses")
        self.assertEqual([row["ours"]["verdict"] for row in value["rows"]], ["reached", None, "not measured"])
        self.assertEqual([row["published"]["verdict"] for row in value["rows"]], ["one run", None, "not measured"])
        self.assertEqual(value["rows"][0]["ours"]["ratio"]["value"], 2.0)
        self.assertEqual(value["rows"][0]["claim"],
                         {"quantity": "gain", "figure": 1.5, "unit": "", "low": 1.5, "high": None, "why": ""})
        self.assertIsNone(value["rows"][2]["ours"]["value"])

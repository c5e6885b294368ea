"""All entries in one go: each is measured once, a stop loses nothing, and the page has every claim."""

import contextlib
import io
import pathlib
import tempfile
import unittest
from unittest import mock

from harness import child, everything, identity, kept, page
from harness.entry import Entries
from harness.measured import Measured
from harness.run import Table
from harness.verdict import at_least, beside

NAMES = ("noel-a", "noel-b", "kol-c")


class Everything(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)
        self.measured, self.failing = [], {}
        self.entries = Entries()
        for name in NAMES:
            self.entries.measured(name, "a paper", f"what {name} claims", "path",
                                  (at_least("gain", 2, why="too *few*"), beside("seconds", 20, "s")))(
                lambda run, name=name: self.measure(run, name))
        self.entries.planned("kol-d", "a paper", "later", "path", (at_least("gain", 2),))

    def measure(self, run, name):
        self.measured.append(name)
        if name in self.failing:
            raise child.Failed("lacuna render ended", self.failing[name])
        run.uses("cornell.glb")
        run.found("gain", ours=Measured(3.0, 2.5, 3.5, 3), published=Measured(1.0, 0.9, 1.1, 3))
        run.tables.append(Table(("scene", "value"), [["a", 1]]))
        run.note(f"pictures: {child.ROOT}/build")
        run.note(f"the file {child.ROOT}/build/a_b")

    def all(self, **options):
        with contextlib.redirect_stderr(io.StringIO()):
            return list(everything.measure_all(self.entries, False, self.out, **options))

    def test_each_is_measured_once(self):
        first = self.all()
        self.assertEqual([o.reason for o in first], ["", "", "", "not built yet"])
        again = self.all()
        self.assertEqual(self.measured, list(NAMES))
        self.assertEqual(everything.text(again), everything.text(first))
        self.assertEqual(everything.value(again), everything.value(first))
        self.assertEqual(everything.verdicts(again), {"missed": 3, "reached": 3})
        self.assertEqual(again[0].run.notes, first[0].run.notes)

    def test_a_stop_loses_nothing(self):
        self.failing["noel-b"] = 75
        with self.assertRaises(child.Failed):
            self.all()
        self.failing.clear()
        self.all()
        self.assertEqual(self.measured, ["noel-a", "noel-b", "noel-b", "kol-c"])

    def test_what_fails_is_told_and_the_others_go_on(self):
        self.failing["noel-b"] = 1
        outcomes = self.all()
        self.assertEqual(outcomes[1].reason, "failed: lacuna render ended")
        self.assertEqual(self.measured, list(NAMES))
        self.assertRegex(everything.text(outcomes), r"(?m)^noel-b +gain +>= 2 +failed: lacuna render ended$")
        self.all()
        self.assertEqual(self.measured[3:], ["noel-b"], "a failure is not kept")

    def test_another_program_scene_or_measurement_is_measured_anew(self):
        self.all()
        for what, value in (("programs", {"lacuna": "other"}), ("file_hash", "other")):
            with mock.patch.object(identity, what, return_value=value):
                self.assertEqual([o.reason for o in self.all(only_kept=True)], ["not run"] * 3 + ["not built yet"], what)
        with mock.patch.object(kept, "_sources", return_value={"a.py": "other"}):
            self.assertEqual(self.all(only_kept=True)[0].reason, "not run")
        self.assertEqual(self.all(only_kept=True)[0].reason, "")
        self.assertEqual(self.measured, list(NAMES))

    def test_the_page_has_every_claim_and_the_reasons_of_those_missed(self):
        text = page.text(self.all(), False)
        self.assertIn("| noel-a | gain | >= 2 | 1 \\[0.9, 1.1\\] | missed | 3 \\[2.5, 3.5\\] | reached |", text)
        self.assertIn("| kol-d | gain | >= 2 |  | not built yet |  |  |", text)
        self.assertIn("- `noel-b`, gain (published): too *few*", text)
        self.assertIn("Verdicts: 3 missed, 3 reached.", text)
        self.assertIn("- the file build/a\\_b", text)
        self.assertNotIn("pictures: ", text)
        self.assertNotIn(str(child.ROOT), text)
        headings = [line for line in text.splitlines() if line.startswith("#")]
        self.assertEqual(len(set(headings)), len(headings))

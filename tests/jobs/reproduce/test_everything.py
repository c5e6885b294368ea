"""All entries in one go: each is measured once, a stop loses nothing, and the page has every claim."""

import contextlib
import io
import pathlib
import tempfile
import unittest
from unittest import mock

from catalogue import ENTRIES
from harness import child, code, everything, identity, page, stored
from harness.entry import Entries
from harness.measured import Measured
from harness.run import KINDS, Table
from harness.verdict import MISSED, NOT_TOLD_APART, at_least, beside

NAMES = ("noel-a", "noel-b", "kol-c")


class Everything(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)
        self.measured, self.failing, self.captions = [], {}, ()
        tree = mock.patch.multiple(stored, FOLDER=self.out / "tree")
        summary = self.out / "summary.md"
        summary.write_text("- a gains {noel-a | gain | ours}, d {kol-d | gain | ours}\n")
        written = mock.patch.multiple(page, PAGE=self.out / "tree.md", SUMMARY=summary)
        for patch in (tree, written):
            patch.start()
            self.addCleanup(patch.stop)
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
        run.note(f"the file {child.ROOT}/build/a_b")
        for caption in self.captions:
            run.show(caption, child.ROOT / "docs" / caption)

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
        with mock.patch.object(code, "python", return_value="other"):
            self.assertEqual(self.all(only_kept=True)[0].reason, "not run")
        self.assertEqual(self.all(only_kept=True)[0].reason, "")
        self.assertEqual(self.measured, list(NAMES))

    def test_the_page_has_every_claim_and_the_reasons_of_those_missed(self):
        page.write(self.entries, [o.run for o in self.all() if o.run])
        text = page.PAGE.read_text()
        self.assertIn("| noel-a | gain | >= 2 | 1 \\[0.9, 1.1\\] | missed | 3 \\[2.5, 3.5\\] | reached |", text)
        self.assertIn("| kol-d | gain | >= 2 |  | not built yet |  |  |", text)
        self.assertIn("- `noel-b`, gain (published): too *few*", text)
        self.assertIn("Verdicts: 3 missed, 3 reached; 0% not told apart.", text)
        self.assertIn("# Reproduction\n\n- a gains 3, d (not measured)\n", text)
        self.assertIn("- the file build/a\\_b", text)
        self.assertNotIn(str(child.ROOT), text)
        headings = [line for line in text.splitlines() if line.startswith("#")]
        self.assertEqual(len(set(headings)), len(headings))

    def test_the_page_keeps_what_was_measured_before_and_elsewhere(self):
        page.write(self.entries, [self.all()[0].run])
        first = page.PAGE.read_text()
        self.assertIn("| noel-b | gain | >= 2 |  | not run |  |  |", first)
        self.measured.clear()
        with mock.patch.object(identity, "programs", return_value={"lacuna": "other"}):
            page.write(self.entries, [self.all()[1].run])
        text = page.PAGE.read_text()
        for name in ("noel-a", "noel-b"):
            self.assertIn(f"| {name} | gain | >= 2 | 1 \\[0.9, 1.1\\] | missed | 3 \\[2.5, 3.5\\] | reached |", text)
        page.write(self.entries, [])
        self.assertEqual(page.PAGE.read_text(), text)

    def test_what_was_measured_with_other_code_is_marked(self):
        page.write(self.entries, [o.run for o in self.all() if o.run])
        self.assertIn(f"{page.STALE}none.", page.PAGE.read_text())
        with mock.patch.object(code, "renderer", return_value="other"):
            page.write(self.entries, [])
            self.assertEqual([code.changed(run) for run in page.stale(stored.outcomes(self.entries))], [["renderer"]] * 3)
        self.assertIn(f"{page.STALE}`noel-a`, `noel-b`, `kol-c`.", page.PAGE.read_text())

    def test_a_claim_that_is_new_or_gone(self):
        self.all()
        page.write(self.entries, [self.all()[0].run])
        others = Entries()
        others.measured("noel-a", "a paper", "what it claims", "path", (at_least("gain", 4), at_least("new", 1)))(print)
        others.planned("kol-d", "a paper", "later", "path", (at_least("gain", 2),))
        page.write(others, [])
        text = page.PAGE.read_text()
        self.assertIn("| noel-a | gain | >= 4 | 1 \\[0.9, 1.1\\] | missed | 3 \\[2.5, 3.5\\] | missed |", text)
        self.assertIn("| noel-a | new | >= 1 |  | not measured |  | not measured |", text)
        self.assertNotIn("| noel-a | seconds |", text)

    def test_pictures_stand_in_a_row(self):
        self.captions = ("one", "two_2")
        run = self.all()[0].run
        with mock.patch("harness.stored.subprocess.run") as oiiotool:
            oiiotool.return_value.returncode = 0
            page.write(self.entries, [run])
            arguments = oiiotool.call_args.args[0]
        self.assertEqual(arguments[1:6:3], [f"{child.ROOT}/docs/{name}/image.png" for name in self.captions])
        self.assertIn("2x1", arguments)
        text = page.PAGE.read_text()
        self.assertIn("![noel-a](tree/noel-a.jpg)\n\nFrom the left, row by row: one; two\\_2.", text)
        self.assertNotIn(str(child.ROOT), text)

    def test_a_layer_is_shown_by_its_channels(self):
        run = self.all()[0].run
        run.show("tests", self.out, "visibility_tests")
        with mock.patch("harness.stored.subprocess.run") as oiiotool:
            oiiotool.return_value.returncode = 0
            page.write(self.entries, [run])
            arguments = oiiotool.call_args.args[0]
        self.assertEqual(arguments[1:4], [str(self.out / "image.exr"), "--ch",
                                          "R=visibility_tests.R,G=visibility_tests.G,B=visibility_tests.B"])

    def test_a_row_that_cannot_be_drawn_is_an_error(self):
        self.captions = ("one",)
        with mock.patch("harness.stored.subprocess.run") as oiiotool:
            oiiotool.return_value = mock.Mock(returncode=1, stdout="", stderr="no such file")
            with self.assertRaisesRegex(child.Failed, "oiiotool ended with 1: no such file"):
                page.write(self.entries, [self.all()[0].run])


class Tree(unittest.TestCase):
    def test_the_page_is_that_of_the_results_in_the_tree(self):
        def but_stale(text):  # which every change of the code changes
            return [line for line in text.splitlines() if not line.startswith(page.STALE)]
        self.assertEqual(but_stale(page.PAGE.read_text()), but_stale(page.text(list(stored.outcomes(ENTRIES)))),
                         "./dev reproduce --stale --write writes it anew")

    def test_what_is_missed_in_the_tree_has_a_reason(self):
        self.assertEqual([(o.entry.name, row.claim.quantity) for o in stored.outcomes(ENTRIES) if o.run for row in o.run.rows
                          if MISSED in map(row.verdict, KINDS) and not row.claim.why], [])

    def test_not_more_than_three_in_ten_are_not_told_apart(self):
        self.assertLessEqual(everything.share(everything.verdicts(list(stored.outcomes(ENTRIES))), NOT_TOLD_APART), 0.3)

    def test_the_summary_is_ten_lines(self):
        self.assertLessEqual(len(page.SUMMARY.read_text().splitlines()), 10)

    def test_every_result_in_the_tree_is_of_an_entry_and_tells_its_commit(self):
        names = {entry.name for entry in ENTRIES}
        for file in stored.FOLDER.iterdir():
            self.assertIn(file.stem, names)
        for outcome in stored.outcomes(ENTRIES):
            if outcome.run:
                self.assertRegex(outcome.run.commit, "^[0-9a-f]{7}( with changes)?$")

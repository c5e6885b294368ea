"""The faults of tests/planted can be planted: the old text of each stands once in its file."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/planted"))

from fault import Fault  # noqa: E402
from faults import FAULTS  # noqa: E402
from planted import problems  # noqa: E402


class Faults(unittest.TestCase):
    def test_each_can_be_planted(self):
        self.assertEqual(list(problems(FAULTS)), [])

    def test_each_has_its_name_and_changes_something(self):
        self.assertEqual(len({fault.name for fault in FAULTS}), len(FAULTS))
        self.assertEqual([fault.name for fault in FAULTS if fault.old == fault.new], [])

    def test_its_tests_are_there(self):
        programs = set(re.findall(r"^lacuna_tests\((\w+)", (ROOT / "tests/CMakeLists.txt").read_text(), re.MULTILINE))
        named = {test for fault in FAULTS for stage in fault.tests for test in stage.split()}
        self.assertEqual([test for test in sorted(named) if test not in programs and not (ROOT / test).is_file()], [])

    def test_what_cannot_be_planted_is_told(self):
        for old in ("this stands nowhere", "import"):  # not there, and more than once
            fault = Fault("a fault", "tests/planted/planted.py", old, "")
            self.assertEqual(len(list(problems([fault]))), 1, old)


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)

"""`./dev reproduce` as one types it."""

import json
import re
import subprocess
import sys
import tempfile
import unittest

from catalogue import ENTRIES
from harness import child


def reproduce(*arguments):
    return subprocess.run([sys.executable, child.ROOT / "jobs/reproduce", *arguments], capture_output=True, text=True,
                          check=False)


class Command(unittest.TestCase):
    def test_without_a_name_it_lists_all(self):
        done = reproduce()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"(?m)^noel-table-1 +built +Noel 2015, Table 1, p\. 86")
        for entry in ENTRIES:
            self.assertRegex(done.stdout, rf"(?m)^{entry.name} +{'built' if entry.built else 'not built yet'} ")

    def test_the_list_as_json(self):
        listed = json.loads(reproduce("--json").stdout)
        self.assertEqual([(e["name"], e["built"]) for e in listed], [(e.name, e.built) for e in ENTRIES])

    def test_an_unknown_name_tells_those_there_are(self):
        done = reproduce("noel-table-7", "--full")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn('there is no "noel-table-7"; there are ', done.stderr)
        for entry in ENTRIES:
            self.assertIn(entry.name, done.stderr)

    def test_what_is_not_built_says_what_it_needs(self):
        entry = next((e for e in ENTRIES if not e.built), None)
        if entry is None:
            self.skipTest("all is built")
        for name in (entry.name, entry.name.replace("-", "_")):
            done = reproduce(name)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertEqual(done.stderr, f"reproduce: {entry.name} is not built yet; it needs {entry.needs}\n")

    def test_an_unknown_option_is_refused(self):
        self.assertEqual(reproduce("noel-table-1", "--fast").returncode, 2)

    def test_options_of_all_need_it(self):
        for options, said in ((("--all", "noel-table-1"), "--all and noel-table-1: one of the two"),
                              (("--kept",), "--kept: with --all only"),
                              (("--stale", "--full"), "--stale: without NAME, --all and --full"),
                              (("--run",), "--run: with --stale only"),
                              (("--write",), "--write: with --all, --stale or NAME")):
            done = reproduce(*options)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(said, done.stderr)

    def test_stale_results_are_listed_with_what_has_changed(self):
        done = reproduce("--stale")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[0].split(), "ENTRY VERSION MEASURED AT CHANGED SINCE".split())
        for line in done.stdout.splitlines()[1:]:
            self.assertRegex(line, r"^[a-z0-9-]+ +(quick|full) +[0-9a-f]{7}.* (renderer|python|renderer and python)$")

    def test_all_that_is_kept_is_one_table_of_every_claim(self):
        with tempfile.TemporaryDirectory() as folder:
            done = reproduce("--all", "--kept", "--out", folder)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertEqual(len(done.stdout.splitlines()), 1 + sum(len(entry.claims) for entry in ENTRIES))
            for entry in ENTRIES:
                for claim in entry.claims:
                    reason = "not run" if entry.built else "not built yet"
                    self.assertRegex(done.stdout, rf"(?m)^{entry.name} +{re.escape(claim.quantity)} .* {reason}$")

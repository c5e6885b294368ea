"""The harness of jobs/reproduce: `python3 tests/jobs/reproduce`, once `lacuna` is built."""

import os
import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.insert(0, str(ROOT / "jobs/reproduce"))
os.environ.setdefault("LACUNA_SCENES", str(ROOT / "jobs/scenes"))

if __name__ == "__main__":
    done = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.discover(str(HERE)))
    failed = len(done.failures) + len(done.errors)
    print(f"{done.testsRun - failed - len(done.skipped)} passed, {failed} failed")
    sys.exit(1 if failed or not done.testsRun else 0)

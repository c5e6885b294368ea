"""python/lacuna.py against the real service: the manual's page, what goes wrong, and pictures without numpy."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import lacuna  # noqa: E402

BIN = ROOT / "build/release/bin"
ROOM = {"scene": "cornell.glb", "resolution": [6, 4], "integrator": {"type": "path", "max_depth": 3},
        "budget": {"iterations": 4}}


class Client(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.server = subprocess.Popen(
            [BIN / "lacuna-server", "--port", "0", "--data", cls.folder.name, "--uploads", "--nice", "0"],
            stdout=subprocess.PIPE, text=True, env={**os.environ, "LACUNA_SCENES": str(ROOT / "jobs/scenes")})
        cls.url = re.search(r"http://\S+", cls.server.stdout.readline())[0].rstrip("/")
        cls.service = lacuna.Service(cls.url)

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        cls.server.stdout.close()
        cls.folder.cleanup()

    def test_the_manual_runs_as_it_stands(self):
        blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.DOTALL)
        self.assertGreater(len(blocks), 3)
        said, names = [], {"print": lambda *texts: said.append(" ".join(map(str, texts)))}
        os.environ["LACUNA_URL"] = self.url
        try:
            exec("".join(blocks), names)
        finally:
            del os.environ["LACUNA_URL"]
        self.assertRegex(said[0], r"^relMSE \S+ after \S+ CPU s and [1-9]\d* rays$")
        self.assertRegex(said[1], r"^64 x 48 pixels, at most \S+$")
        self.assertEqual(said[2], "400 /integrator/max_depth")
        self.assertEqual(len(names["final"]), 4)
        self.assertTrue(all(mse > 0 for mse in names["final"].values()))

    def test_errors_of_pictures_are_those_of_the_curve(self):
        job = self.service.submit({**ROOM, "reference": "auto", "reference_iterations": 32})
        self.service.wait(job)
        ours, reference = self.service.image(job), self.service.image(job, "reference")
        squares = [(a - b) ** 2 for row, other in zip(ours, reference) for p, q in zip(row, other)
                   for a, b in zip(p, q)]
        mse = self.service.curve(job)[-1]["mse"]
        self.assertAlmostEqual(sum(squares) / len(squares) / mse, 1, delta=0.01)

    def test_pictures_are_the_same_without_numpy(self):
        job = self.service.submit(ROOM)
        self.service.wait(job)
        ours = [[list(map(float, pixel)) for pixel in row] for row in self.service.image(job)]
        known = sys.modules.get("numpy")
        sys.modules["numpy"] = None  # importing it fails
        try:
            plain = self.service.image(job)
        finally:
            if known is None:
                del sys.modules["numpy"]
            else:
                sys.modules["numpy"] = known
        self.assertEqual((len(plain), len(plain[0]), len(plain[0][0])), (4, 6, 3))
        self.assertEqual(plain, ours)
        with self.assertRaisesRegex(KeyError, "no layer"):
            self.service.image(job, "normal")

    def test_the_same_key_is_one_job(self):
        self.assertEqual(self.service.submit(ROOM, key="one"), self.service.submit(ROOM, key="one"))
        self.assertNotEqual(self.service.submit(ROOM), self.service.submit(ROOM))
        with self.assertRaises(lacuna.Refused) as caught:
            self.service.submit({**ROOM, "seed": 2}, key="one")
        self.assertEqual(caught.exception.status, 422)

    def test_what_does_not_end_as_done_is_an_exception(self):
        job = self.service.submit({**ROOM, "budget": {"seconds": 1000}})
        with self.assertRaisesRegex(TimeoutError, job):
            self.service.wait(job, timeout=0)
        self.service.cancel(job)
        with self.assertRaises(lacuna.Failed) as caught:
            self.service.wait(job)
        self.assertEqual(caught.exception.ended[job]["state"]["state"], "cancelled")
        self.service.delete(job)
        with self.assertRaises(lacuna.Refused) as caught:
            self.service.job(job)
        self.assertEqual(caught.exception.status, 404)

    def test_extending_a_job_goes_on_from_its_picture(self):
        job = self.service.submit(ROOM)
        self.service.wait(job)
        self.service.extend(job, {"iterations": 6})
        self.service.wait(job)
        self.assertEqual(self.service.curve(job)[-1]["iteration"], 6)

    def test_uploads_a_scene(self):
        self.service.upload(ROOT / "jobs/scenes/cornell.glb", "mine.glb")
        self.service.wait(self.service.submit({**ROOM, "scene": "mine.glb"}))
        self.assertIn("mine.glb", self.service.scenes())

    def test_no_service_is_an_os_error(self):
        with self.assertRaises(OSError):
            lacuna.Service("http://127.0.0.1:9").scenes()


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)

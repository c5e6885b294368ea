"""What is installed runs by itself: a tree in any folder, and the Debian package in a clean root, from which it goes
without a trace."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.stdout}{done.stderr}")
    return done.stdout


def files(root):
    return sorted(str(path.relative_to(root)) for path in root.rglob("*"))


class Installed(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacuna-install-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.work = self.folder / "work"
        self.work.mkdir()
        self.environment = {"PATH": "/usr/bin:/bin", "HOME": str(self.work)}

    def try_all_of(self, prefix):
        """Renders a job with a scene that lies nowhere else, serves the page, and shows the manual."""
        scenes = prefix / "share/lacuna/scenes"
        shutil.copy(scenes / "cornell.glb", scenes / "only_here.glb")
        job = self.work / "job.json"
        job.write_text('{"scene": "only_here.glb", "resolution": [32, 32], "budget": {"iterations": 2}}')
        run(prefix / "bin/lacuna", "render", job, "-q", cwd=self.work, env=self.environment)
        self.assertTrue((self.work / "job.job/image.exr").stat().st_size > 0)
        (scenes / "only_here.glb").unlink()
        for example in ("cornell.json", "ajar.json"):
            run(prefix / "bin/lacuna", "check", prefix / "share/lacuna/examples" / example, cwd=self.work, env=self.environment)
        service = subprocess.Popen([prefix / "bin/lacuna-server", "--port", "0"], cwd=self.work, text=True,
                                   env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            url = re.search(r"http://\S+", service.stdout.readline()).group()
            with urllib.request.urlopen(url) as answer:
                self.assertEqual(answer.read(), (ROOT / "web/index.html").read_bytes())
            with urllib.request.urlopen(url + "api/scenes") as answer:
                self.assertIn(b"cornell.glb", answer.read())
        finally:
            service.terminate()
            service.communicate()
        manual = run("man", "-l", prefix / "share/man/man1/lacuna-render.1",
                     env={**self.environment, "MANWIDTH": "100"}) if shutil.which("man") else "--threads NAME"
        self.assertIn("--threads", manual)
        self.assertIn("NAME", manual)
        script = prefix / "share/bash-completion/completions/lacuna"
        words = run("bash", "-c", f'source "{script}"; COMP_WORDS=(lacuna render --th); COMP_CWORD=2; _lacuna; '
                    'echo "${COMPREPLY[@]}"')
        self.assertEqual(words.strip(), "--threads")
        self.assertIn('"$schema"', (prefix / "share/lacuna/schema/job.schema.json").read_text())
        self.assertTrue((prefix / "lib/systemd/system/lacuna-server.service").exists())

    def test_a_tree_can_be_moved(self):
        run("cmake", "--install", BUILD, "--prefix", self.folder / "one")
        (self.folder / "one").rename(self.folder / "two")
        self.try_all_of(self.folder / "two")

    def test_the_package_comes_and_goes(self):
        packages = self.folder / "packages"
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", packages, cwd=self.folder)
        [package] = packages.glob("*.deb")
        needs = run("dpkg-deb", "-f", package, "Depends")
        for library in ("libembree3-3", "libopenimageio2.4", "libtbb12"):
            self.assertIn(library, needs)
        for name in re.findall(r"(?:^|, )([a-z0-9.+-]+)", needs):
            self.assertIn("installed", run("dpkg-query", "-W", "-f", "${Status}", name))
        root = self.folder / "root"
        for name in ("updates", "info", "triggers"):
            (root / "var/lib/dpkg" / name).mkdir(parents=True)
        (root / "var/lib/dpkg/status").touch()
        for name in ("usr/bin", "usr/lib", "usr/share"):
            (root / name).mkdir(parents=True)
        dpkg = ["dpkg", f"--root={root}", "--force-depends", "--force-not-root", "--log=/dev/null"]
        before = [name for name in files(root) if not name.startswith("var/")]
        run(*dpkg, "--install", package, env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"})
        self.try_all_of(root / "usr")
        run(*dpkg, "--purge", "lacuna")
        # dpkg takes away the folders that nobody else is in.
        left = [name for name in files(root) if not name.startswith("var/")]
        self.assertEqual(set(left) - set(before), set())
        self.assertNotIn("lacuna\n", (root / "var/lib/dpkg/status").read_text())


if __name__ == "__main__":
    program = unittest.main(exit=False, argv=sys.argv[:1])
    bad = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)

"""`./dev` installs missing Debian packages only as root, after a yes at the terminal, or by a sudo without a password."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Stand-ins: each writes its call to $CALLS; no package is installed, and sudo asks for a password if $PASSWORD is set.
FAKES = {
    "id": 'echo "$USER_ID"',
    "dpkg-query": "exit 1",
    "apt-get": 'echo "apt-get $*" >>"$CALLS"',
    "sudo": '[ "$1" = -n ] || { echo "sudo $*" >>"$CALLS"; exec "$@"; }\n[ -z "${PASSWORD:-}" ]',
}
QUESTION = "Install them with sudo? [Y/n] "


class Setup(unittest.TestCase):
    def setUp(self):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="lacuna-setup-"))
        self.addCleanup(shutil.rmtree, folder)
        self.calls = folder / "calls"
        self.calls.touch()
        for name, body in FAKES.items():
            (folder / name).write_text(f"#!/bin/sh\n{body}\n")
            (folder / name).chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "CALLS": str(self.calls)}

    def dev(self, answer=None, user=1000, **more):
        """Runs a quick command; `answer` is typed at a terminal, None: standard input is none."""
        keyboard, terminal = os.openpty() if answer is not None else (None, subprocess.DEVNULL)
        if answer is not None:
            os.write(keyboard, answer.encode())
        try:
            return subprocess.run(["./dev", "reproduce"], cwd=ROOT, stdin=terminal, capture_output=True, text=True,
                                  env={**self.environment, "USER_ID": str(user), **more}, timeout=120, check=False)
        finally:
            for fd in (keyboard, terminal) if answer is not None else ():
                os.close(fd)

    def installed(self):
        return [line for line in self.calls.read_text().splitlines() if line.startswith("apt-get install")]

    def expect_refused(self, done):
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(self.calls.read_text(), "")
        self.assertRegex(done.stderr, r"\n  apt-get update && apt-get install -y --no-install-recommends .*libembree-dev")

    def test_root_is_not_asked(self):
        done = self.dev(answer="n\n", user=0)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn(QUESTION, done.stdout)
        self.assertNotIn("sudo", self.calls.read_text())
        self.assertIn(" libembree-dev ", self.installed()[0])

    def test_the_list_and_its_reasons_come_before_the_question(self):
        done = self.dev(answer="n\n")
        self.assertLess(done.stdout.index("\n  libembree-dev: ray casting\n"), done.stdout.index(QUESTION))
        self.expect_refused(done)

    def test_a_yes_installs(self):
        for answer in ("\n", "y\n", "Yes\n"):
            self.calls.write_text("")
            done = self.dev(answer=answer, PASSWORD="needed")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.count(QUESTION), 1)
            self.assertTrue(self.calls.read_text().startswith("sudo apt-get update"))
            self.assertEqual(len(self.installed()), 1)

    def test_no_other_answer_installs(self):
        for answer in ("no\n", "N\n", "later\n", "\x04"):  # the last: end of file
            self.expect_refused(self.dev(answer=answer))

    def test_without_a_terminal_sudo_needs_no_password(self):
        done = self.dev()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn(QUESTION, done.stdout)
        self.assertEqual(len(self.installed()), 1)

    def test_without_a_terminal_a_password_is_not_waited_for(self):
        self.expect_refused(self.dev(PASSWORD="needed"))


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)

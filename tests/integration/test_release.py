"""scripts/release on a small tree of its own: what it changes, and what it refuses before it changes anything."""

import datetime
import os
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "scripts/release"
CMAKE = 'project(ligature VERSION 0.1.0 DESCRIPTION "x" LANGUAGES CXX)\n'
CHANGES = "# Changelog\n\n## Unreleased\n### Added\n- a knot\n\n## 0.1.0 - 2026-01-01\n- a thread\n"


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name)
        (self.tree / "CMakeLists.txt").write_text(CMAKE)
        (self.tree / "CHANGELOG.md").write_text(CHANGES)
        self.git("init", "-q")
        self.commit()

    def git(self, *arguments):
        who = ["-c", "user.name=test", "-c", "user.email=test@localhost"]
        return subprocess.run(["git", *who, *arguments], cwd=self.tree, check=True, capture_output=True, text=True).stdout

    def commit(self):
        self.git("add", ".")
        self.git("commit", "-q", "-m", "start")

    def release(self, *arguments):
        environment = os.environ | {"LIGATURE_RELEASE_TREE": str(self.tree)} | {
            f"GIT_{who}_{what}": "test@localhost" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        return subprocess.run([SCRIPT, *arguments], env=environment, capture_output=True, text=True)

    def refused(self, word, *arguments):
        before = self.git("rev-parse", "HEAD"), self.git("status", "--porcelain")
        done = self.release(*arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(word, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertEqual(before, (self.git("rev-parse", "HEAD"), self.git("status", "--porcelain")))

    def test_makes_one_commit_with_version_and_date(self):
        done = self.release("0.2.0")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("git tag -a v0.2.0", done.stdout)
        self.assertEqual(self.git("log", "--format=%s").split("\n")[0], "Release 0.2.0")
        self.assertEqual(self.git("status", "--porcelain"), "")
        self.assertIn("VERSION 0.2.0 DESCRIPTION", (self.tree / "CMakeLists.txt").read_text())
        today = datetime.datetime.now(datetime.timezone.utc).date()
        self.assertEqual((self.tree / "CHANGELOG.md").read_text(),
                         CHANGES.replace("## Unreleased\n", f"## Unreleased\n\n## 0.2.0 - {today}\n"))

    def test_check_changes_nothing(self):
        done = self.release("--check", "0.2.0")
        self.assertEqual((done.returncode, done.stdout), (0, "release: 0.2.0 can follow 0.1.0\n"))
        self.assertEqual(self.git("log", "--format=%s").split(), ["start"])

    def test_refuses_what_is_no_next_version(self):
        for wrong in ("", "0.2", "v0.2.0", "0.02.0", "0.1.0", "0.0.9"):
            with self.subTest(wrong):
                self.refused(wrong, wrong)

    def test_refuses_a_tree_with_changes(self):
        (self.tree / "new").write_text("x")
        self.refused("not committed", "0.2.0")

    def test_refuses_a_tag_that_exists(self):
        self.git("tag", "v0.2.0")
        self.refused("tag v0.2.0", "0.2.0")

    def test_refuses_an_empty_changelog(self):
        (self.tree / "CHANGELOG.md").write_text(CHANGES.replace("- a knot\n", ""))
        self.commit()
        self.refused("nothing is listed", "0.2.0")


if __name__ == "__main__":
    unittest.main()

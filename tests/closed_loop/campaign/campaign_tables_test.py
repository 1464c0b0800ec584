#!/usr/bin/env python3
"""scripts/bench/campaign_tables.py counts right, says what is wrong, and docs/results/campaign.md holds the tables of docs/results/campaign.csv."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]


def tables(*arguments):
    return subprocess.run([sys.executable, "-B", str(ROOT / "scripts" / "bench" / "campaign_tables.py"), *map(str, arguments)],
                          capture_output=True, text=True)


def row(seed, outcome, **other):
    landed = outcome in ("safe", "unsafe")
    row = {"seed": seed, "look": "urban", "fault": "none", "fault_s": 0.0, "fault_lasts_s": None, "outcome": outcome,
           "reason": "a reason (with figures): and more", "duration_s": 20.0 + seed, "attempts": 1, "least_bad": False,
           "p_end": [3.0, 4.0, 0.1], "footprint": {"clearance_m": 2.0 + seed} if landed else None, "safe_radius_m": 5.0}
    return {**row, **other}


class CampaignTables(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, part, *rows):
        (self.folder / part).mkdir()
        (self.folder / part / "rows.jsonl").write_text("".join(json.dumps(one) + "\n" for one in rows))

    def test_counts(self):
        self.write("failing", row(1, "safe", fault="LiDAR lost", fault_lasts_s=3.0, attempts=2), row(2, "gave up", fault="LiDAR lost"),
                   row(3, "collided", fault="position lost"), row(4, "gave up", fault="position lost", safe_radius_m=2.0))
        page = tables(self.folder)
        self.assertEqual(page.returncode, 0, page.stderr)
        self.assertIn("| failing | 1 to 4 | 4 | 3 | 33.3 % (6.1 to 79.2) | 1 (4.56 to 69.94 %) | 2 | 21, 21 | 1 | 3.0 m |", page.stdout)
        self.assertIn("| ... lasting | 2 to 4 | 3 | 2 | 0.0 % (0.0 to 65.8) | 1 (6.15 to 79.23 %) | 2 | - | 0 | - |", page.stdout)
        self.assertIn("| LiDAR lost | 1 of 1 | 0 of 1 | 0 | 1 a reason |", page.stdout)
        self.assertIn("| position lost | 0 of 0 | 0 of 2 | 1 | 1 a reason |", page.stdout)

    def test_landings_without_failures_by_look(self):
        self.write("calm", row(1, "safe"), row(2, "safe", attempts=2, look="forest"), row(3, "gave up", look="forest"))
        page = tables(self.folder).stdout
        self.assertIn("| forest | 2 | 50.0 % (9.5 to 90.5) | 0 | 22, 22 | 1 | 4.0 m |\n", page)
        self.assertIn("| urban | 1 | 100.0 % (20.7 to 100.0) | 0 | 21, 21 | 0 | 3.0 m |\n", page)

    def test_the_same_worlds_with_and_without_camera(self):
        self.write("coarse", row(1, "safe"), row(2, "safe"), row(3, "safe"))
        self.write("full", row(1, "safe", p_end=[0.0, 0.0, 0.0], duration_s=60.0), row(2, "unsafe"))
        self.assertIn("Of 2 worlds flown with and without camera 1 have the same verdict. Touchdowns are 5.0 m apart in the median. "
                      "With camera 1 took more than half as long again, without it 0.", tables(self.folder).stdout)

    def test_a_line_for_every_landing_gives_the_same_tables(self):
        self.write("calm", row(2, "safe"), row(1, "gave up"))
        written = tables(self.folder, "--csv", self.folder / "landings.csv")
        self.assertEqual(written.stdout, tables(self.folder / "landings.csv").stdout)
        self.assertEqual(len((self.folder / "landings.csv").read_text().splitlines()), 3)

    def test_says_what_is_wrong(self):
        for wrong in (self.folder, self.folder / "missing.csv", pathlib.Path(__file__)):
            page = tables(wrong)
            self.assertEqual(page.returncode, 1, wrong)
            self.assertIn(str(wrong), page.stderr)
            self.assertIn("scripts/bench/campaign.sh", page.stderr)

    def test_the_page_holds_the_tables(self):
        printed = tables(ROOT / "docs" / "results" / "campaign.csv").stdout
        page = (ROOT / "docs" / "results" / "campaign.md").read_text()
        for block in printed.strip().split("\n\n"):
            self.assertTrue(block in page, "docs/results/campaign.md is out of date; it lacks:\n" + block)


unittest.main(verbosity=1)

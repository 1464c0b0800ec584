"""Every test that ctest lists has labels, known ones: labels_test.py CTEST BUILD_FOLDER."""
import json
import subprocess
import sys

KNOWN = {"unit", "sim", "network", "slow"}


def labels_of(test):
    return next((p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"), [])


def main():
    ctest, build = sys.argv[1:]
    listing = subprocess.run([ctest, "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True)
    tests = [test for test in json.loads(listing.stdout)["tests"] if not test["name"].endswith("_NOT_BUILT")]
    wrong = [f"{test['name']}: {labels_of(test)}" for test in tests if not labels_of(test) or set(labels_of(test)) - KNOWN]
    if wrong or len(tests) < 2:
        sys.exit(f"of {len(tests)} tests these have no label, or another than {sorted(KNOWN)}:\n" + "\n".join(wrong))
    print(f"{len(tests)} tests have labels")


main()

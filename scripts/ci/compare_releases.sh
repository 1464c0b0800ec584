#!/usr/bin/env bash
# Do Debian 12 and Debian 13 come to the same results? Builds on bare systems of both, and compares two replays of ten images
# of the same logs (verdicts; depth within 1e-4, relative), and the table of a data set that each evaluates.
#   scripts/ci/compare_releases.sh [--ccache DIR]       needs root and debootstrap; results stay in out/releases/<suite>
# The network computes in float32 on one thread in both. Exit code 1 if they disagree.
set -euo pipefail
cd "$(dirname "$0")/../.."
ccache=(--ccache ~/.cache/ccache)
[ "${1:-}" != --ccache ] || ccache=(--ccache "$2")
/usr/bin/python3 -c 'import cv2, numpy' 2>/dev/null ||
  { echo "compare_releases: needs apt-get install python3-numpy python3-opencv" >&2; exit 1; }
out=$PWD/out/releases
rm -rf "$out"
mkdir -p "$out"

# Both replay Debian 12's logs, and fly the same ones themselves.
cat >"$out/run.sh" <<'RUN'
set -euo pipefail
scripts/setup.sh
scripts/build.sh release alight-sim alight-infer alight-dataset alight-evaluate
bin=$PWD/build/release/bin
cd /output
[ -d logs ] || "$bin"/alight-sim -q --config configs/sim/ten_images.yaml --output logs
mkdir "$1"
"$bin"/alight-sim -q --config configs/sim/ten_images.yaml --output "$1"/own_logs
exact=(--set network.precision=float32 --set network.threads=1)
for flight in field town; do
  "$bin"/alight-infer -q --log logs/$flight.bag --output "$1"/$flight --set depth_every=1 --set overlay_every=0 "${exact[@]}"
  "$bin"/alight-infer -q --log logs/$flight.bag --output "$1"/$flight.lidar_only --lidar-only --set depth_every=1 \
    --set overlay_every=0
done
"$bin"/alight-dataset build -q --config configs/dataset/default.yaml --log logs/field.bag --log logs/town.bag --output "$1"/data
cd "$1"
"$bin"/alight-evaluate -q --checkpoint models/weights/default.pt --data data --output table.md
RUN
for suite in bookworm trixie; do
  scripts/bare_machine.sh --suite $suite "${ccache[@]}" --output "$out" "bash /output/run.sh $suite"
done

status=0
for flight in field town; do
  cmp "$out"/bookworm/own_logs/$flight.bag "$out"/trixie/own_logs/$flight.bag || status=1
done
for flight in field town field.lidar_only town.lidar_only; do
  scripts/bench/compare_results.py "$out"/bookworm/$flight "$out"/trixie/$flight --tolerance 1e-4 || status=1
done
diff -rq "$out"/bookworm/data "$out"/trixie/data --exclude build.yaml --exclude dataset.yaml ||
  { echo "compare_releases: the data sets differ"; status=1; }
diff "$out"/bookworm/table.md "$out"/trixie/table.md && echo "compare_releases: the tables are the same" || status=1
exit $status

#!/usr/bin/env bash
# Fuzzes what reads logs: a libFuzzer target a message type, one for whole bags, and building data sets of damaged bags.
#   scripts/ci/fuzz.sh                         every target for a minute, then 3,000 damaged bags
#   scripts/ci/fuzz.sh --seconds 600 --jobs 2  ten minutes a target, two targets at a time
#   scripts/ci/fuzz.sh --target bag            one target (a type with _ for /, or bag); may be repeated
#   scripts/ci/fuzz.sh --bags 0                without the damaged bags
# What is found lies in out/fuzz/<target>/crash-*; what was learnt in out/fuzz/<target>/corpus, from which the next run goes
# on. Exit code 1 if anything was found.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=60 jobs=1 bags=3000 targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    --bags) bags=$2; shift 2 ;;
    --target) targets+=("$2"); shift 2 ;;
    --help | -h) sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "fuzz: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(tr / _ <tests/fuzz/types.txt; echo bag)
scripts/build.sh fuzz fuzz_seeds "${targets[@]/#/fuzz_}"
bin=$PWD/build/fuzz/bin out=$PWD/out/fuzz
seeds=$(mktemp -d)
trap 'rm -rf "$seeds"' EXIT
# Real recordings, where they are beside the repository.
mapfile -t recordings < <(find ../shared/data -name '*.bag' -size +0 2>/dev/null | sort)
"$bin"/fuzz_seeds "$seeds" "${recordings[@]}"

fuzz() {  # target; a line of the table
  local target=$1 log=$out/$1/log.txt status=0
  mkdir -p "$out/$target/corpus" "$seeds/$target"
  (cd "$out/$target" && "$bin/fuzz_$target" -max_total_time="$seconds" -rss_limit_mb=4096 -timeout=20 -max_len=120000 \
    -print_final_stats=1 corpus "$seeds/$target") >"$log" 2>&1 || status=1
  printf '%-36s %12s %12s %9s\n' "$target" "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
    "$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")" "$(grep -o 'ft: [0-9]*' "$log" | tail -1 | cut -c5-)"
  [ $status = 0 ] || echo "fuzz: $target: see $log" >&2
  return $status
}

found=0 running=0
printf '%-36s %12s %12s %9s\n' target executions executions/s features
for target in "${targets[@]}"; do
  if [ $running -ge "$jobs" ]; then
    wait -n || found=1
    running=$((running - 1))
  fi
  fuzz "$target" &
  running=$((running + 1))
done
while [ $running -gt 0 ]; do
  wait -n || found=1
  running=$((running - 1))
done

if [ "$bags" -gt 0 ]; then
  scripts/build.sh release dataset_tests >&2
  ALIGHT_DAMAGED_BAGS=$bags build/release/bin/dataset_tests --gtest_filter='DamagedBags.*' || found=1
fi
exit $found

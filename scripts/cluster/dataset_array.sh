#!/usr/bin/env bash
# Builds a data set of many logs on a cluster, one shard a task, then puts the parts together.
# With Slurm:
#   job=$(sbatch --parsable --array=1-16 scripts/cluster/dataset_array.sh build CONFIG.yaml data/all logs/*.bag)
#   sbatch --dependency=afterok:$job scripts/cluster/dataset_array.sh merge data/all
# On one machine with GNU parallel or xargs:
#   seq 16 | xargs -P 4 -I{} env TASK={} TASKS=16 scripts/cluster/dataset_array.sh build CONFIG.yaml data/all logs/*.bag
#   scripts/cluster/dataset_array.sh merge data/all
# The parts lie in data/all.parts/; a task that failed or was killed is started again alone and goes on where it was.
# ALIGHT_DATASET names the program (default: alight-dataset of build/release, else of the PATH).
#SBATCH --cpus-per-task=4
#SBATCH --mem-per-cpu=2G
set -euo pipefail
usage() { sed -n '2,11s/^# \{0,1\}//p' "$0"; }
here=$(cd "$(dirname "$0")/../.." && pwd)
program=${ALIGHT_DATASET:-$here/build/release/bin/alight-dataset}
[ -x "$program" ] || program=alight-dataset

case ${1:-} in
  build)
    [ $# -ge 4 ] || { usage >&2; exit 2; }
    config=$2 output=$3
    shift 3
    task=${SLURM_ARRAY_TASK_ID:-${TASK:?set TASK and TASKS, or start this as a Slurm array}}
    tasks=${SLURM_ARRAY_TASK_COUNT:-${TASKS:?set TASKS, the number of tasks}}
    [ "$task" -le $# ] || { echo "dataset_array: task $task has no log: there are $#"; exit 0; }
    mkdir -p "$output.parts"
    exec "$program" build --config "$config" "${@/#/--log=}" --shard "$task/$tasks" --output "$output.parts/$task"
    ;;
  merge)
    [ $# -eq 2 ] || { usage >&2; exit 2; }
    mapfile -t parts < <(find "$2.parts" -mindepth 1 -maxdepth 1 -type d ! -name '*.partial' | sort -V)
    exec "$program" merge "${parts[@]}" --output "$2"
    ;;
  --help | -h) usage ;;
  *) usage >&2; exit 2 ;;
esac

#!/usr/bin/env bash
# Trains with N processes of this machine, each on its share of every batch.
#   scripts/cluster/launch.sh N [arguments of alight-train]
#   scripts/cluster/launch.sh 4 --config configs/train/demo.yaml --output runs/demo
# Process 0 speaks as alight-train alone would; what the others say on stderr is prefixed. When one fails, the others
# get a few seconds to say so too and are ended; the exit code is that of the first. ALIGHT_TRAIN names another binary.
#
# Several machines: torchrun and srun work as well. With Slurm, in a folder that all machines see:
#   export MASTER_ADDR=$(scontrol show hostnames "$SLURM_JOB_NODELIST" | head -1) MASTER_PORT=29500
#   srun --ntasks-per-node=4 alight-train --config configs/train/demo.yaml --output runs/demo
set -uo pipefail

binary=${ALIGHT_TRAIN:-$(dirname "$0")/../../build/release/bin/alight-train}
grace_s=10
case "${1:-}" in
  [1-9] | [1-9][0-9] | [1-9][0-9][0-9]) ;;
  *) echo "usage: scripts/cluster/launch.sh N [arguments of alight-train], N from 1 to 999" >&2; exit 2 ;;
esac
[ -x "$binary" ] || { echo "launch: $binary: no such program; build it with scripts/build.sh" >&2; exit 1; }
size=$1
shift

free_port() {
  # The kernel's choice. Without Python one at which nobody answers: whoever answers holds the port.
  python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])' 2>/dev/null && return
  local port
  while port=$((20000 + RANDOM)); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
}

export MASTER_ADDR=127.0.0.1 WORLD_SIZE=$size LOCAL_WORLD_SIZE=$size MASTER_PORT
MASTER_PORT=$(free_port)
pids=()
prefixers=()
trap 'kill -TERM "${pids[@]}" 2>/dev/null' INT TERM
for ((rank = 0; rank < size; ++rank)); do
  if [ "$rank" -eq 0 ]; then
    RANK=0 LOCAL_RANK=0 "$binary" "$@" &
  else
    exec {prefixed}> >(sed -u "s/^/[process $rank] /" >&2)
    prefixers+=($!)
    RANK=$rank LOCAL_RANK=$rank "$binary" "$@" >/dev/null 2>&"$prefixed" &
  fi
  pids+=($!)
  [ "$rank" -eq 0 ] || exec {prefixed}>&-
done

status=0
killer=
left=("${pids[@]}")
while [ ${#left[@]} -gt 0 ]; do
  wait -n -p ended "${left[@]}"
  code=$?
  [ -n "${ended:-}" ] || continue  # a signal was handled; its processes are about to end
  for i in "${!left[@]}"; do [ "${left[$i]}" = "$ended" ] && unset "left[$i]"; done
  if [ "$code" -ne 0 ] && [ "$status" -eq 0 ]; then
    status=$code
    if [ ${#left[@]} -gt 0 ]; then
      echo "launch: a process ended with code $code; the others have ${grace_s} s to end" >&2
      (sleep "$grace_s"; kill -KILL "${left[@]}" 2>/dev/null) >/dev/null 2>&1 &
      killer=$!
    fi
  fi
done
[ -z "$killer" ] || kill "$killer" 2>/dev/null
for pid in "${prefixers[@]}"; do wait "$pid"; done
exit "$status"

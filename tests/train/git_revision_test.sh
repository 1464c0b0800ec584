#!/usr/bin/env bash
# cmake/GitRevision.cmake in a repository of its own: git_revision_test.sh <cmake> <build folder>
set -euo pipefail
cmake=$1
script=$(cd "$(dirname "$0")/../.." && pwd)/cmake/GitRevision.cmake
# The build folder mostly lies inside a repository, which must not be taken for the one asked.
work=$(mktemp -d "$(realpath "$2")/git_revision.XXXXXX")
trap 'rm -rf "$work"' EXIT
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE # set where git itself runs the tests, as a hook
mkdir "$work/source"
in_source() { git -C "$work/source" -c user.name=test -c user.email=test@localhost "$@"; }

expect() { # what is looked at, the revision that has to come out
  "$cmake" -D GIT="${git-git}" -D SOURCE="$work/source" -D OUTPUT="$work/git_revision.cpp" -P "$script"
  grep -qF "\"$2\"" "$work/git_revision.cpp" && return
  echo "git_revision: $1: expected $2, got: $(tail -n 1 "$work/git_revision.cpp")" >&2
  exit 1
}

expect "a folder without a repository" unknown
in_source init -q
expect "a repository without a commit" unknown
echo one >"$work/source/file"
in_source add file
in_source commit -qm first
commit=$(in_source rev-parse HEAD)
in_source tag -a -m release v1
expect "a commit, tagged" "$commit"
touch -d '2001-01-01' "$work/git_revision.cpp"
expect "the same commit again" "$commit"
[ "$(date -r "$work/git_revision.cpp" +%Y)" = 2001 ] || { echo "git_revision: written though unchanged" >&2; exit 1; }
echo build >"$work/source/untracked"
expect "a file that git does not know" "$commit"
echo two >"$work/source/file"
expect "a changed file" "$commit-dirty"
git="" expect "a machine without git" unknown

#!/usr/bin/env bash
# Damages files of every format and reads them: scripts/mutate.sh [COUNT [FIRST]], 10000 of each if not given, after
# ./test.sh or with a build of the tests. Inputs with a fault are kept in build/mutations, and the status is 1.
set -euo pipefail
cd "$(dirname "$0")/.."

mkdir -p build/mutations
status=0
for format in $(build/bin/curvewright-mutate --list); do
    build/bin/curvewright-mutate "$format" "${1:-10000}" "${2:-1}" build/mutations || status=1
done
exit $status

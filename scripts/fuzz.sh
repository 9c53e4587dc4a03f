#!/usr/bin/env bash
# Feeds our own parsers with what libFuzzer thinks of: scripts/fuzz.sh [SECONDS [TARGET...]], so many seconds in total
# (60 if not given), shared by all targets or those named. What is found lies in build-fuzz/found, and the status is 1.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/common.sh

seconds=${1:-60}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(msh deformation_json deformation_csv expression session trace journal vtk_check vtk_answer)

install_packages fuzz
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
[ -e build-fuzz/build.ninja ] || quietly "Configuring" configure-fuzz cmake --preset fuzz "${launcher[@]}"
quietly "Building the fuzzer" build-fuzz cmake --build --preset fuzz

mkdir -p build-fuzz/found
status=0
for target in "${targets[@]}"; do
    # What earlier runs have found worth trying is tried first; the seeds stay as they are.
    mkdir -p "build-fuzz/corpus/$target"
    seeds=$target
    [ "$target" != vtk_check ] || seeds=vtk
    log=$log_dir/fuzz-$target.log
    if CURVEWRIGHT_FUZZ_TARGET=$target build-fuzz/bin/curvewright-fuzz -max_total_time=$((seconds / ${#targets[@]} + 1)) \
        -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 -artifact_prefix="build-fuzz/found/$target-" \
        "build-fuzz/corpus/$target" "tests/fuzz/corpus/$seeds" >"$log" 2>&1; then
        echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs, no fault"
    else
        echo "$target: a fault; the end of $log:" >&2
        tail -n 40 "$log" >&2
        status=1
    fi
done
exit $status

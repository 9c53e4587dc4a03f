#!/usr/bin/env bash
# Installs what is missing, builds and runs all tests; those of the window run on a virtual display.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/common.sh

install_packages test
build test

# -nolisten tcp: the display is for this run only. Software rendering: the pictures are compared.
exec xvfb-run -a -s "-screen 0 1440x900x24 -nolisten tcp" \
    env LIBGL_ALWAYS_SOFTWARE=1 ctest --preset release -j "$(nproc)" "$@"

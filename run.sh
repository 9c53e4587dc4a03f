#!/usr/bin/env bash
# Installs what is missing, builds, and does the main job: opens the window on a sample, or, where there is no display,
# runs the same pipeline headless and leaves pictures, VTU files and a report in out/.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/common.sh

install_packages run
build run

if [ -n "${DISPLAY:-}" ]; then
    [ $# -gt 0 ] || set -- sample_meshes/moving_circle/moving_circle.msh \
        --deformation sample_meshes/moving_circle/deformation.json
    exec build/bin/curvewright "$@"
fi
exec scripts/demo.sh out

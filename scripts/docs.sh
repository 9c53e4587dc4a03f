#!/usr/bin/env bash
# Makes the documentation in build/docs/html: the pages of docs/ and of the library's headers. Fails on warnings.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/common.sh

install_packages docs
if [ -e build/build.ninja ]; then
    quietly "Configuring" configure cmake build
else
    quietly "Configuring" configure cmake --preset release -DCURVEWRIGHT_BUILD_TESTS=OFF
fi
quietly "Making the documentation" docs ninja -C build docs
echo "build/docs/html/index.html"

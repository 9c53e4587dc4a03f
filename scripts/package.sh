#!/usr/bin/env bash
# Makes the Debian package of the programs and the tarball of the command line: build/packages/.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/common.sh

install_packages package
build run
rm -rf build/packages
for kind in DEB TGZ; do
    (cd build && quietly "Packing" "pack-$kind" cpack -G "$kind" -B packages)
done
rm -rf build/packages/_CPack_Packages
ls build/packages/*

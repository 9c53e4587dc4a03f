#!/usr/bin/env bash
# Draws the thumbnails of the samples: the deformed state of the untangling ones, the warped one of the others.
set -euo pipefail
cd "$(dirname "$0")"
cli=../build/bin/curvewright-cli
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for name in annulus moving_circle moving_sphere_small moving_sphere; do
    mesh=$name/$name.msh
    [ -e "$mesh" ] || mesh=$mesh.gz
    clip=()
    case $name in
        annulus) $cli deform "$mesh" --deformation $name/deformation.json -o "$work/state.msh" --quiet ;;
        *) $cli warp "$mesh" --deformation $name/deformation.json -o "$work/state.msh" --quiet ;;
    esac
    case $name in *sphere*) clip=(--clip z) ;; esac
    $cli render "$work/state.msh" -o $name/thumbnail.png --size 480x320 --no-legend "${clip[@]}"
done

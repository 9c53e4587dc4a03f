#!/usr/bin/env bash
# Draws the thumbnails of the samples: the deformed state of the untangling ones, the warped one of the others.
#     make_thumbnails.sh [NAME ...]        all samples of the MANIFEST, or those named
set -euo pipefail
cd "$(dirname "$0")"
cli=../build/bin/curvewright-cli
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 - "$@" <<'END' | while read -r name mesh dimension task; do
import json, sys
for card in json.load(open("MANIFEST"))["samples"]:
    if len(sys.argv) < 2 or card["name"] in sys.argv[1:]:
        print(card["name"], card["mesh"], card["dimension"], card["task"])
END
    command=warp
    [ "$task" = untangle ] && command=deform
    $cli $command "$mesh" --deformation "$name/deformation.json" -o "$work/state.msh" --quiet
    clip=()
    case $name in *sphere* | shell*) clip=(--clip z) ;; esac
    $cli render "$work/state.msh" -o "$name/thumbnail.png" --size 480x320 --no-legend "${clip[@]}"
done

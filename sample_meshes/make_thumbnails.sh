#!/usr/bin/env bash
# Draws the thumbnails of the samples: the deformed state of the untangling ones, the warped one of the others.
#     make_thumbnails.sh [NAME ...]        all samples of the MANIFEST, or those named
set -euo pipefail
cd "$(dirname "$0")"
cli=../build/bin/curvewright-cli
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 - "$@" <<'END' | while read -r name mesh deformation thumbnail task; do
import json, sys
for card in json.load(open("MANIFEST"))["samples"]:
    if len(sys.argv) < 2 or card["name"] in sys.argv[1:]:
        print(card["name"], card["mesh"], card["deformation"], card["thumbnail"], card["task"])
END
    command=warp
    [ "$task" = untangle ] && command=deform
    [ -e "$mesh" ] || { echo "$mesh is not there: generate.py $name makes it." >&2; continue; }
    $cli $command "$mesh" --deformation "$deformation" -o "$work/state.msh" --quiet
    clip=()
    case $name in *sphere* | shell*) clip=(--clip z) ;; esac
    $cli render "$work/state.msh" -o "$thumbnail" --size 480x320 --no-legend "${clip[@]}"
done

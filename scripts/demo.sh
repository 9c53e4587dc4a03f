#!/usr/bin/env bash
# The main job without a window: deform, warp and untangle the samples, with pictures, VTU files and a report.
#     scripts/demo.sh FOLDER [CLI]
set -euo pipefail
export LC_ALL=C
cli=$(realpath "${2:-$(dirname "$0")/../build/bin/curvewright-cli}")
out=${1:-out}
case $out in /*) ;; *) out=$PWD/$out ;; esac
cd "$(dirname "$0")/.."
mkdir -p "$out"
report=$out/report.md
json=$(mktemp)
trap 'rm -f "$json"' EXIT

# value OBJECT KEY: a number out of the JSON of the last command. The result's object comes before that of "before".
value() { sed -n "/\"$1\": {/,/}/s/^ *\"$2\": \([-0-9.e+]*\),*$/\1/p" "$json" | head -n 1; }

# row SAMPLE STEP: one line of the report from the JSON of the last command.
row() {
    printf '| %s | %s | %.3f | %.3f | %s | %s |\n' "$1" "$2" "$(value scaled_jacobian min)" \
        "$(value scaled_jacobian mean)" "$(value scaled_jacobian valid)" "$(value scaled_jacobian invalid)" >>"$report"
}

# Elements that stay invalid are a finding (status 3), not a failure of the demonstration.
run() { "$cli" "$@" --json --quiet >"$json" || [ $? = 3 ]; }

cat >"$report" <<'END'
# Curvewright: samples deformed, warped, untangled

Certified scaled Jacobian (min J / max J) of each state; pictures and VTU files lie beside this report.

| sample | state | min | mean | valid | invalid |
| --- | --- | --- | --- | --- | --- |
END

samples=sample_meshes
run deform $samples/annulus/annulus.msh --deformation $samples/annulus/deformation.json -o "$out/annulus_tangled.vtu"
run quality "$out/annulus_tangled.vtu"
row annulus "boundary moved"
run untangle "$out/annulus_tangled.vtu" --method signed-angle --beta 0.7 -o "$out/annulus_untangled.vtu"
row annulus "untangled, signed angles, beta 0.7"
for name in moving_circle moving_sphere_small; do
    mesh=$samples/$name/$name.msh
    [ -e "$mesh" ] || mesh=$mesh.gz
    run deform "$mesh" --deformation $samples/$name/deformation.json -o "$out/${name}_tangled.vtu"
    run quality "$out/${name}_tangled.vtu"
    row $name "boundary moved"
    run warp "$mesh" --deformation $samples/$name/deformation.json -o "$out/${name}_warped.vtu"
    row $name "warped, convex weights"
done
for file in "$out"/*.vtu; do
    clip=()
    case $file in *sphere*) clip=(--clip z) ;; esac
    run render "$file" -o "${file%.vtu}.png" --size 1200x900 "${clip[@]}"
    printf '\n![%s](%s)\n' "$(basename "${file%.vtu}")" "$(basename "${file%.vtu}").png" >>"$report"
done
echo "Pictures, VTU files and a report are in $out (start with report.md)."

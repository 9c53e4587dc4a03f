#!/usr/bin/env bash
# Makes the meshes of the scaling families with Gmsh (package gmsh): circle_0.msh ... circle_9.msh, sphere_0.msh ...
# sphere_7.msh, hole_0.msh, hole_1.msh, straight-sided, order 1. What is there already stays. They are for benchmarks and
# too large to be kept.
#     sample_meshes/families/generate.sh [FOLDER]      (default: build/families)
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-$here/../../build/families}
command -v gmsh >/dev/null || { echo "gmsh is missing; install the package gmsh." >&2; exit 1; }
mkdir -p "$out"

# make FAMILY DIMENSION LEVEL...
make() {
    local family=$1 dimension=$2 level
    shift 2
    for level; do
        local file="$out/${family}_$level.msh"
        [ ! -e "$file" ] || continue
        echo "$file"
        gmsh "-$dimension" "$here/$family.geo" -setnumber level "$level" -nt 1 -v 2 -o "$file.part.msh" >&2
        mv "$file.part.msh" "$file"
    done
}

make circle 2 0 1 2 3 4 5 6 7 8 9
make sphere 3 0 1 2 3 4 5 6 7
make hole 2 0 1

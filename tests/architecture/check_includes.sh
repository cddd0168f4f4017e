#!/usr/bin/env bash
# check_includes.sh ROOT: the #include lines of the rooms follow the arrows of docs/architecture.md, and each library is
# included by one file or folder only. Prints each offending line; exit code 1 if there is one.
set -euo pipefail
cd "$1"

optics_rooms="optics optics/detector optics/light optics/material optics/geometry"
# Room: rooms that it may include besides itself.
declare -A arrows=(
    [core]=""
    [spectral]="core"
    [optics/geometry]="spectral core"
    [optics/material]="optics/geometry spectral core"
    [optics/light]="optics/material optics/geometry spectral core"
    [optics/detector]="optics/material optics/geometry spectral core"
    [optics]="optics/detector optics/light optics/material optics/geometry spectral core"
    [optics/transport]="$optics_rooms spectral core"
    [io]="optics/transport $optics_rooms spectral core"
    [validation/truth]="spectral core"
    [validation/cases]="validation validation/truth $optics_rooms optics/transport spectral core"
    [validation]="validation/truth io optics/transport $optics_rooms spectral core"
    [cli]="validation io optics/transport $optics_rooms spectral core"
)

# Beginning of an #include <...> : what may include it, as a pattern of paths.
libraries=(
    "embree optics/geometry/ray_caster*"
    "CGAL/ optics/geometry/*"
    "Eigen/ *"
    "fmt/ *"
    "Random123/ core/*"
    "tbb/ @(core|optics/geometry)/*"
    "Imf io/exr.cpp"
    "Imath io/exr.cpp"
    "OpenColorIO/ io/display_encoding.cpp"
    "png.h io/raster.cpp"
    "nlohmann/ @(io/report|io/benchmark_json|validation/report_json).cpp"
    "cereal/ io/state_file.cpp"
    "pugixml io/bsdf_xml.cpp"
    "yaml-cpp/ io/yaml_tree.*"
    "CLI/ cli/main.cpp"
)
system_headers=" fcntl.h malloc.h unistd.h sys/resource.h sys/stat.h immintrin.h "

shopt -s extglob
problems=0
complain() { # FILE LINE TEXT
    echo "$1:$2: $3"
    problems=$((problems + 1))
}

check_room() { # FILE LINE INCLUDED
    local room=${1%/*} target=${3%/*}
    [[ -e $3 ]] || { complain "$1" "$2" "\"$3\" is no file from the root of the project"; return; }
    [[ $room == "$target" || " ${arrows[$room]} " == *" $target "* ]] ||
        complain "$1" "$2" "$room must not include \"$3\""
}

check_library() { # FILE LINE INCLUDED
    [[ $3 != */* && $3 != *.* ]] && return # the standard library
    [[ $system_headers == *" $3 "* ]] && return
    local entry
    for entry in "${libraries[@]}"; do
        [[ $3 == "${entry%% *}"* ]] || continue
        # shellcheck disable=SC2053  # the right side is a pattern
        [[ $1 == ${entry#* } ]] || complain "$1" "$2" "<$3> is for ${entry#* } only"
        return
    done
    complain "$1" "$2" "<$3> is of a library that tests/architecture/check_includes.sh does not know"
}

files=0
while IFS=: read -r file line text; do
    [[ -n ${arrows[${file%/*}]+known} ]] || { complain "$file" "$line" "lies in no room of the project"; continue; }
    if [[ $text =~ ^[[:space:]]*\#[[:space:]]*include[[:space:]]*\"([^\"]+)\" ]]; then
        check_room "$file" "$line" "${BASH_REMATCH[1]}"
    elif [[ $text =~ ^[[:space:]]*\#[[:space:]]*include[[:space:]]*\<([^\>]+)\> ]]; then
        check_library "$file" "$line" "${BASH_REMATCH[1]}"
    fi
    files=$((files + 1))
done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include' --include='*.h' --include='*.cpp' --include='*.in' \
    core spectral optics io validation cli)

((files > 0)) || { echo "found no #include at all"; exit 1; }
((problems == 0)) || exit 1

#!/usr/bin/env bash
# check_includes_catches.sh ROOT: the twin of check_includes.sh. Each wrong include, planted in a copy, must be caught.
set -euo pipefail
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT

must_catch() { # FILE INCLUDE-LINE
    rm -rf "${copy:?}"/*
    (cd "$root" && cp -r core spectral optics io validation cli "$copy")
    echo "$2" >>"$copy/$1"
    local output
    if output=$("$here/check_includes.sh" "$copy") || [[ $output != *"$1:"* ]]; then
        echo "not caught: $2 in $1"
        exit 1
    fi
}

root=$1
must_catch core/vector.h '#include "spectral/spectrum.h"'              # upwards
must_catch spectral/spectrum.h '  #  include "io/report.h"'            # upwards, oddly written
must_catch optics/light/light.h '#include "optics/detector/detector.h"' # between rooms side by side
must_catch optics/scene.h '#include "optics/transport/settings.h"'     # upwards within optics
must_catch io/report.cpp '#include <yaml-cpp/yaml.h>'                  # a library in the wrong file
must_catch core/random.cpp '#include <boost/any.hpp>'                  # a library that is not ours
must_catch io/report.cpp '#include "report.h"'                         # not from the root

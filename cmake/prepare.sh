# Sourced by ./run and ./test, from the root of the project: packages and build.

missing_packages() {
    local package
    while read -r package; do
        [[ -z $package || $package == \#* ]] && continue
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
    done <cmake/debian-packages.txt
}

# Installs the packages of cmake/debian-packages.txt that are missing; says nothing if there are none.
install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        echo "This is not a Debian system, so nothing is installed; docs/building.md lists what the build needs." >&2
        return 0
    fi
    local missing
    mapfile -t missing < <(missing_packages)
    ((${#missing[@]})) || return 0
    echo "Installing ${missing[*]}"
    local as_root=()
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            echo "Neither root nor sudo: please install these packages and call this again." >&2
            return 1
        fi
        as_root=(sudo)
    fi
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0)
    local log
    log=$(mktemp)
    if ! { "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
        cat "$log" >&2
        rm -f "$log"
        return 1
    fi
    rm -f "$log"
}

# Configures and builds a preset with all cores; says nothing if there is nothing to do.
#   build_preset PRESET [TARGET]
build_preset() {
    local preset=$1 target=${2:-all} log
    if [[ ! -e build/$preset/build.ninja ]]; then # later on, the build itself sees when to configure again
        log=$(mktemp)
        if ! cmake --preset "$preset" >"$log" 2>&1; then
            cat "$log" >&2
            rm -f "$log"
            return 1
        fi
        rm -f "$log"
    fi
    [[ $(ninja -C "build/$preset" -n "$target" 2>/dev/null) == *"no work to do"* ]] && return 0
    echo "Building in build/$preset with $(nproc) cores"
    cmake --build --preset "$preset" --target "$target" -j "$(nproc)"
}

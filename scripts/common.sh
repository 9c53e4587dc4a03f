# Functions shared by run.sh and test.sh. Sourced from the top of the repository.
. scripts/packages.sh

log_dir=build/logs

# Runs a step with its output in a log, which is shown only if the step fails.
quietly() {
    local what=$1 log="$log_dir/$2.log"
    shift 2
    mkdir -p "$log_dir"
    if ! "$@" >"$log" 2>&1; then
        echo "$what failed; the end of $log:" >&2
        tail -n 40 "$log" >&2
        exit 1
    fi
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# install_packages run|test|package|docs|fuzz: what is not there yet, through apt.
install_packages() {
    local wanted=("${run_packages[@]}") missing=() package
    [ "$1" = test ] && wanted+=("${test_packages[@]}")
    [ "$1" = package ] && wanted+=("${package_packages[@]}")
    [ "$1" = docs ] && wanted+=("${docs_packages[@]}")
    [ "$1" = fuzz ] && wanted+=("${fuzz_packages[@]}")
    command -v dpkg-query >/dev/null || return 0
    for package in "${wanted[@]}"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
        echo "These packages are missing, and there is no sudo to install them: ${missing[*]}" >&2
        exit 1
    fi
    echo "Installing ${missing[*]}"
    quietly "Updating the package lists" apt-update as_root apt-get update
    quietly "Installing packages" apt-install as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends "${missing[@]}"
}

# build run|test: configures once (release preset) and builds what is out of date. The tests are configured only when
# they are asked for, so that run.sh needs no test framework.
build() {
    local tests=OFF
    if [ "$1" = test ] || grep -q '^CURVEWRIGHT_BUILD_TESTS:BOOL=ON' build/CMakeCache.txt 2>/dev/null; then tests=ON; fi
    if [ ! -e build/build.ninja ] || ! grep -q "^CURVEWRIGHT_BUILD_TESTS:BOOL=$tests" build/CMakeCache.txt; then
        local launcher=()
        command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
        quietly "Configuring" configure cmake --preset release -DCURVEWRIGHT_BUILD_TESTS=$tests "${launcher[@]}"
    fi
    local targets=(curvewright curvewright-cli)
    [ "$1" = test ] && targets=(all)
    if [ "$(ninja -C build -n "${targets[@]}" 2>/dev/null | tail -n 1)" != "ninja: no work to do." ]; then
        echo "Building (the first time takes a few minutes)"
        quietly "Building" build ninja -C build "${targets[@]}"
    fi
}

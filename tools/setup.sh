#!/bin/sh
# Makes sure that Aquifer can be built and run here: Rust, a C compiler, a Vulkan adapter. Installs Mesa's software adapter where apt can.
# Run it by itself; the other scripts source it, since it also sets XDG_RUNTIME_DIR where that is unset. Quiet when nothing is missing.

aquifer_setup_fail() {
    echo "setup: $*" >&2
    exit 1
}

aquifer_has() {
    command -v "$1" >/dev/null 2>&1
}

# rustup's usual place, for shells that were started before Rust was installed.
if ! aquifer_has cargo && [ -x "${CARGO_HOME:-${HOME:-}/.cargo}/bin/cargo" ]; then
    PATH="${CARGO_HOME:-${HOME:-}/.cargo}/bin:$PATH"
    export PATH
fi
aquifer_has cargo || aquifer_setup_fail "Rust is missing: install it from https://rustup.rs"
aquifer_has cc || aquifer_has gcc || aquifer_has clang || [ "$(uname -s)" = Darwin ] ||
    aquifer_setup_fail "a C compiler is missing: install gcc or clang (Debian, Ubuntu: apt-get install gcc)"

# A loader, and the description of at least one driver.
aquifer_has_vulkan() {
    case $(/sbin/ldconfig -p 2>/dev/null || ldconfig -p 2>/dev/null) in
    *libvulkan.so.1*) ;;
    *) return 1 ;;
    esac
    [ -n "${VK_ICD_FILENAMES:-}${VK_DRIVER_FILES:-}" ] && return 0
    for folder in /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d /etc/vulkan/icd.d "${XDG_DATA_HOME:-${HOME:-}/.local/share}/vulkan/icd.d"; do
        for driver in "$folder"/*.json; do
            [ -e "$driver" ] && return 0
        done
    done
    return 1
}

# Installs Debian packages, as root or through sudo; says what goes wrong.
aquifer_apt_install() {
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        aquifer_has sudo || {
            echo "setup: run as root: apt-get install $*" >&2
            return 1
        }
        as_root=sudo
    fi
    log=$(mktemp)
    # shellcheck disable=SC2086 # as_root is empty or one word
    if ! { $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq update &&
        $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "$@"; } >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        rm -f "$log"
        echo "setup: apt could not install $*" >&2
        return 1
    fi
    rm -f "$log"
}

case $(uname -s) in
Linux)
    if ! aquifer_has_vulkan; then
        if aquifer_has apt-get; then
            echo "setup: no Vulkan adapter found; installing Mesa's software adapter (mesa-vulkan-drivers, libvulkan1)" >&2
            aquifer_apt_install mesa-vulkan-drivers libvulkan1 || exit 1
        else
            aquifer_setup_fail "no Vulkan adapter found: install a Vulkan loader and driver (Fedora: vulkan-loader mesa-vulkan-drivers; Arch: vulkan-icd-loader vulkan-swrast; Alpine: vulkan-loader mesa-vulkan-swrast)"
        fi
    fi
    # The Vulkan loader complains on every start when this is unset.
    if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
        XDG_RUNTIME_DIR="${TMPDIR:-/tmp}/aquifer-runtime-$(id -u)"
        mkdir -p -m 700 "$XDG_RUNTIME_DIR"
        export XDG_RUNTIME_DIR
    fi
    ;;
*) ;; # Metal and Direct3D 12 come with the system.
esac

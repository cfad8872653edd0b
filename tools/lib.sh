# Sourced by tools/run, tools/test and tools/bench: installs packages, configures and builds. Progress goes to stderr.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=$(nproc)
# Read by CMake when it configures a fresh build folder.
if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi

say() { printf '%s\n' "$*" >&2; }

as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi; }

apt_get() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -y -o DPkg::Lock::Timeout=300 "$@" >&2; }

apt_install() {
    # A fresh image has no package lists at all; old lists show themselves by a failing install.
    if compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null &&
        apt_get install --no-install-recommends "$@"; then return; fi
    if [ -z "${apt_updated:-}" ]; then
        apt_updated=yes
        apt_get update || return
    fi
    apt_get install --no-install-recommends "$@"
}

# listed GROUP [soft]: the packages of a group, only the hard or only the soft ones.
listed() { awk -v g="$1" -v s="${2:-}" '$1 == g && $3 == s { print $2 }' "$root/tools/packages.txt"; }

# missing PACKAGE...: those not installed.
missing() {
    [ $# = 0 ] || comm -13 \
        <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p' | sort -u) \
        <(printf '%s\n' "$@" | sort -u)
}

# need GROUP...: installs what the groups lack. The stamp makes the next call cost one hash.
need() {
    local group stamp hash hard soft package
    hash=$(sha256sum <"$root/tools/packages.txt")
    mkdir -p "$root/build"
    for group; do
        stamp=$root/build/packages-$group.stamp
        if [ -e "$stamp" ] && [ "$(<"$stamp")" = "$hash" ]; then continue; fi
        if command -v apt-get >/dev/null; then
            mapfile -t hard < <(missing $(listed "$group"))
            mapfile -t soft < <(missing $(listed "$group" soft))
            if [ ${#hard[@]} -gt 0 ]; then
                say "installing ${hard[*]}"
                apt_install "${hard[@]}" || { say "could not install: ${hard[*]}"; return 1; }
            fi
            for package in "${soft[@]}"; do
                say "installing $package (optional)"
                apt_install "$package" || say "not installed: $package; what needs it is skipped"
            done
            # CMake looks again for what it did not find.
            if [ $((${#hard[@]} + ${#soft[@]})) -gt 0 ]; then rm -f "$root"/build/*/configured.stamp; fi
        else
            say "not Debian: please install what matches" $(listed "$group") $(listed "$group" soft)
        fi
        printf '%s' "$hash" >"$stamp"
    done
}

# configure PRESET: again only when the presets changed; everything else CMake notices by itself.
configure() {
    local stamp=$root/build/$1/configured.stamp
    if [ ! -e "$stamp" ] || [ "$root/CMakePresets.json" -nt "$stamp" ]; then
        say "configuring build/$1"
        (cd "$root" && cmake --preset "$1" >&2) && touch "$stamp"
    fi
}

# build PRESET [TARGET...]: silent when there is nothing to do.
build() {
    local preset=$1
    shift
    configure "$preset"
    ninja -C "$root/build/$preset" -j "$jobs" "${@:-all}" |
        sed -u '/Entering directory/d; /Re-checking globbed/d; /no work to do/d' >&2
}

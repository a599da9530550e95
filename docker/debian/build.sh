#!/usr/bin/env bash
# Makes the Debian packages in a fresh Debian of each RELEASE, has lintian check them, and puts them into FOLDER.
#   docker/debian/build.sh [--ccache FOLDER | --own-ccache] FOLDER [RELEASE...]   default: bookworm trixie
# Needs what ../bare.sh needs; --ccache, --own-ccache: the compiler's cache, as there. Exit code: that of bare.sh; lintian's errors and warnings are
# failures.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cache=()
if [ "${1:-}" = --ccache ] && [ $# -ge 2 ]; then
    cache=(--ccache "$2")
    shift 2
elif [ "${1:-}" = --own-ccache ]; then
    cache=(--own-ccache)
    shift
fi
if [ $# -eq 0 ] || [ "${1:0:1}" = - ]; then
    sed -n '2,5s/^# \?//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift
[ $# -gt 0 ] || set -- bookworm trixie

work=$(mktemp -d --tmpdir rabit_packages.XXXXXX)
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
for release in "$@"; do
    mkdir "$work/$release"
    "$here/../bare.sh" "${cache[@]}" --keep "$work/$release" "$release" '
        docker/install-packages.sh docker/packages-build.txt docker/packages-pack.txt &&
        docker/build-preset.sh release rabit_package ground rabit_python &&
        cpack --config build/release/CPackConfig.cmake -B packages >&2 &&
        lintian --allow-root --fail-on error,warning packages/*.deb'
    cp "$work/$release/root/rabit/packages/"*.deb "$folder"
    rm -rf --one-file-system "${work:?}/$release"
done
ls "$folder"

#!/usr/bin/env bash
# Installs those Debian packages of packages-build.txt that are missing. Usage: install-packages.sh [LIST...]
# Quiet and without network when nothing is missing. A line `a | b` means either package: apt installs the first that
# this release of Debian has.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
lists=("$@")
[ ${#lists[@]} -gt 0 ] || lists=("$here/packages-build.txt")

# is_installed PACKAGE...: true if one of them is
is_installed() {
    local status
    status=$(dpkg-query -W -f='${db:Status-Status}\n' "$@" 2>/dev/null || true) # fails if one is unknown
    grep -qx installed <<<"$status"
}

mapfile -t wanted < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "${lists[@]}")
missing=()
for packages in "${wanted[@]}"; do
    # shellcheck disable=SC2086 # one word for each
    is_installed ${packages//|/ } || missing+=("$packages")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "install-packages.sh: not root and no sudo; install by hand: ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
echo "Installing ${#missing[@]} Debian packages: ${missing[*]}" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${as_root[@]}" apt-get update &&
       "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
           apt-get satisfy -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "install-packages.sh: apt-get failed (its last lines are above)" >&2
    exit 1
fi

#!/usr/bin/env bash
# Runs the two commands of the README in a fresh Debian, in which only git is installed, and removes it again.
#   docker/bare.sh [--ccache FOLDER | --own-ccache] [--keep FOLDER] RELEASE [COMMAND]
# RELEASE: bookworm (Debian 12) or trixie (Debian 13). COMMAND is run in a copy of this tree, in place of the two. --ccache:
# the compiler's cache, for repeated runs; --own-ccache: that of this machine's compiler; without them all is compiled.
# --keep: the Debian is made in FOLDER/root, with the copy in /rabit, and stays. Needs root, mmdebstrap and a mirror of
# Debian. The traffic stays on the loopback of this machine.
# Exit code: that of the first command that fails; 77 if this machine cannot make a root.
set -euo pipefail
tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

cache=
folder=
usage() {
    sed -n '2,8s/^# \?//p' "${BASH_SOURCE[0]}" >&2
    exit 2
}
while [ "${1:-}" = --ccache ] || [ "${1:-}" = --keep ] || [ "${1:-}" = --own-ccache ]; do
    if [ "$1" = --own-ccache ]; then
        cache=$(ccache --get-config=cache_dir) && mkdir -p "$cache"
        shift
        continue
    fi
    [ $# -ge 2 ] || usage
    given=$(cd "$2" && pwd)
    if [ "$1" = --ccache ]; then cache=$given; else folder=$given; fi
    shift 2
done
[ $# -eq 1 ] || [ $# -eq 2 ] || usage
release=$1
command=${2:-./examples/demo.sh --seconds 80 && ./tests/run.sh}
if [ "$(id -u)" -ne 0 ] || ! command -v mmdebstrap >/dev/null; then
    echo "bare.sh: skipped: needs root and mmdebstrap; docker/packages-docker.txt lists it" >&2
    exit 77
fi

if [ -z "$folder" ]; then
    folder=$(mktemp -d --tmpdir "rabit_bare_$release.XXXXXX")
    # The mounts are in a namespace of their own and end with it.
    trap 'rm -rf --one-file-system "$folder"' EXIT
fi
trap 'exit 130' INT
trap 'exit 143' TERM
root=$folder/root
echo "bare.sh: making a root of $release" >&2
mmdebstrap --quiet --mode=root --variant=minbase --include=git,ca-certificates "$release" "$root"
mkdir "$root/rabit" "$root/ccache"
git -C "$tree" ls-files -z | tar -C "$tree" --null -T - -c | tar -C "$root/rabit" -x
cp /etc/resolv.conf "$root/etc/resolv.conf"
echo "127.0.0.1 localhost" >"$root/etc/hosts" # Debian's installer writes it, mmdebstrap does not

echo "bare.sh: $command" >&2
# shellcheck disable=SC2016 # expanded inside
unshare --mount --pid --fork --kill-child sh -ec '
    mount --bind "$0" "$0" # in a root that is no mount, `unshare --mount` and `ip netns exec` fail
    mount --rbind /dev "$0/dev"
    mount -t proc proc "$0/proc"
    mount --rbind /sys "$0/sys"
    [ -z "$1" ] || mount --bind "$1" "$0/ccache"
    exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root CCACHE_DIR=/ccache \
        sh -c "cd /rabit && $2"' "$root" "$cache" "$command" </dev/null

# For tests that need packages of npm; to be sourced.
. "${BASH_SOURCE[0]%/*}/skip.sh"
#
# put_into WORK FILE...: copies the files that are missing or differ. Tests that run beside this one see each file whole.
put_into() {
    local work=$1 file name
    shift
    for file in "$@"; do
        name=${file##*/}
        cmp -s "$file" "$work/$name" || { cp "$file" "$work/.$name.$$" && mv "$work/.$name.$$" "$work/$name"; }
    done
}

# fetch_npm_packages HERE PACKAGE WORK: installs the packages of HERE/package.json in WORK, PACKAGE among them. Ends the
# test as skipped (77) if there is no node, or no registry. Of tests that run beside each other one fetches. A test fetches
# before it enters a network of its own.
fetch_npm_packages() {
    local here=$1 package=$2 work=$3
    if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
        skip "neither node nor npm is installed" "nodejs npm"
    fi
    mkdir -p "$work"
    exec 9>"$work/.fetching"
    flock 9
    put_into "$work" "$here/package.json" "$here/package-lock.json"
    if [ ! -d "$work/node_modules/$package" ]; then
        { [ "${RABIT_TEST_IN_NAMESPACE:-}" != yes ] &&
            (cd "$work" && timeout 200 npm ci --silent --no-audit --no-fund --ignore-scripts); } ||
            skip "npm could not fetch $package"
    fi
    exec 9>&-
}

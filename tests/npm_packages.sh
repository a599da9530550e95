# For tests that need packages of npm; to be sourced.
#
# put_into WORK FILE...: copies what is not there yet, so that a test that runs beside this one finds each file whole.
put_into() {
    local work=$1 file name
    shift
    for file in "$@"; do
        name=${file##*/}
        cmp -s "$file" "$work/$name" || { cp "$file" "$work/.$name.$$" && mv "$work/.$name.$$" "$work/$name"; }
    done
}

# fetch_npm_packages HERE PACKAGE WORK: has what HERE/package.json names in WORK, PACKAGE among it. Ends the test as skipped
# (77) where there is no node, or no registry. Of tests that run beside each other one fetches. None does in a network of
# its own: it fetches before it enters that.
fetch_npm_packages() {
    local here=$1 package=$2 work=$3
    if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
        echo "skipped: neither node nor npm is installed"
        exit 77
    fi
    mkdir -p "$work"
    exec 9>"$work/.fetching"
    flock 9
    put_into "$work" "$here/package.json" "$here/package-lock.json"
    if [ ! -d "$work/node_modules/$package" ]; then
        { [ "${RABIT_TEST_IN_NAMESPACE:-}" != yes ] &&
            (cd "$work" && timeout 200 npm ci --silent --no-audit --no-fund --ignore-scripts); } ||
            { echo "skipped: npm could not fetch $package"; exit 77; }
    fi
    exec 9>&-
}

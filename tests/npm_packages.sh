# For tests that need packages of npm; to be sourced.
#
# fetch_npm_packages HERE PACKAGE WORK: has what HERE/package.json names in WORK, PACKAGE among it. Ends the test as skipped
# (77) where there is no node, or no registry.
fetch_npm_packages() {
    local here=$1 package=$2 work=$3
    if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
        echo "skipped: neither node nor npm is installed"
        exit 77
    fi
    mkdir -p "$work"
    cp "$here/package.json" "$here/package-lock.json" "$work/"
    if [ ! -d "$work/node_modules/$package" ]; then
        (cd "$work" && timeout 200 npm ci --silent --no-audit --no-fund --ignore-scripts) ||
            { echo "skipped: npm could not fetch $package"; exit 77; }
    fi
}

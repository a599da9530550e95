#!/usr/bin/env bash
# Invalid options of ground: the reason is printed, the exit code is 2, and nothing is started.
#   ground_options_test.sh GROUND
set -uo pipefail
ground=$1
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $1"
    cat "$work/out" "$work/err"
    exit 1
}

# ground ARGUMENTS...: sets `status`.
ground() {
    timeout 60 "$ground" --config "$root/examples/ground_station/ground.yaml" "$@" >"$work/out" 2>"$work/err"
    status=$?
}

# refused LINE ARGUMENTS...: also with --check.
refused() {
    local line=$1 extra
    shift
    for extra in --check --seconds=1; do
        ground "$@" "$extra"
        [ "$status" -eq 2 ] || fail "$* $extra: exit code $status"
        [ "$(cat "$work/err")" = "$line" ] || fail "$* $extra: not the line '$line'"
        [ ! -s "$work/out" ] || fail "$* $extra: something was started"
    done
}

# refused_area FIELD VALUE RANGE NUMBERS...
refused_area() {
    refused "--search-area: $1 must be from $3, not $2" --search-area "${@:4}"
}

refused_area latitude_deg 999 '-90 to 90' 999 8.5456 400 600 510
refused_area latitude_deg -90.5 '-90 to 90' -90.5 8.5456 400 600 510
refused_area latitude_deg nan '-90 to 90' nan 8.5456 400 600 510
refused_area longitude_deg 180.5 '-180 to 180' 47.3977 180.5 400 600 510
refused_area north_m 0 '10 to 20000' 47.3977 8.5456 0 600 510
refused_area north_m -400 '10 to 20000' 47.3977 8.5456 -400 600 510
refused_area north_m inf '10 to 20000' 47.3977 8.5456 inf 600 510
refused_area east_m 1e+300 '10 to 20000' 47.3977 8.5456 400 1e300 510
refused_area altitude_m 10001 '-500 to 10000' 47.3977 8.5456 400 600 10001

refused $'--command-period: it must be from 0.1 to 86400, not nan\nRun with --help for more information.' \
    --command-period nan

# refused_parameters LINE PARAMETERS
refused_parameters() {
    printf 'node: ground\nparameters: %s\n' "$2" >"$work/fence.yaml"
    timeout 60 "$ground" --config "$work/fence.yaml" --check >"$work/out" 2>"$work/err"
    status=$?
    [ "$status" -eq 2 ] || fail "$2: exit code $status"
    [ "$(cat "$work/err")" = "$work/fence.yaml:2: $1" ] || fail "$2: not the line '$1'"
}
refused_parameters 'unknown parameter `geofence_radius`; did you mean `geofence_radius_m`?' '{geofence_radius: 3000}'
refused_parameters '`geofence_radius_m` is `5`; expected a number from 10 to 1e+06' '{geofence_radius_m: 5}'
for part in 'latitude_deg: 47' 'longitude_deg: 8' 'radius_m: 3000' 'latitude_deg: 47, geofence_longitude_deg: 8' \
    'latitude_deg: 47, geofence_radius_m: 3000' 'longitude_deg: 8, geofence_radius_m: 3000'; do
    refused_parameters 'a geofence needs all three of geofence_latitude_deg, geofence_longitude_deg and geofence_radius_m' \
        "{geofence_$part}"
done

# refused_setting LINE SETTING: a network setting that cannot work, on either backend.
refused_setting() {
    local transport
    printf 'node: ground\n%s\n' "$2" >"$work/net.yaml"
    for transport in fastdds cyclonedds; do
        timeout 60 "$ground" --config "$work/net.yaml" --check --transport "$transport" >"$work/out" 2>"$work/err"
        status=$?
        [ "$status" -eq 2 ] || fail "$2 on $transport: exit code $status"
        grep -qE "^$work/net.yaml:2: $1" "$work/err" || fail "$2 on $transport: no line '$1'"
    done
}
refused_setting '.*10\.0\.0\.1:port' 'peers: ["10.0.0.1:port"]'
refused_setting '.*/nowhere/vendor\.xml' 'backend_config: /nowhere/vendor.xml'
refused_setting '.*wlan 0' 'interfaces: ["wlan 0"]'

# An absent interface may come later: it is reported, but is no error.
printf 'node: ground\ninterfaces: [notyet0]\n' >"$work/net.yaml"
timeout 60 "$ground" --config "$work/net.yaml" --check >"$work/out" 2>"$work/err" || fail "an absent interface is refused"
grep -q "^$work/net.yaml:2: .*notyet0.*(it is waited for)$" "$work/err" || fail "nothing is said of an absent interface"

for area in '-90 -180 10 10 -500' '90 180 20000 20000 10000'; do
    # shellcheck disable=SC2086 # five words
    ground --check --search-area $area
    [ "$status" -eq 0 ] || fail "--search-area $area: refused"
done
echo passed

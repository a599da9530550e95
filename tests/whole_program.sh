#!/usr/bin/env bash
# Runs all cases of a GoogleTest program. Of its output, shows only the parts of failed cases, or of the case that ended the
# program, and the number of cases.
#   whole_program.sh PROGRAM    or what runs it, as `qemu-aarch64 PROGRAM`
set -uo pipefail
"$@" 2>&1 | awk '
    /^\[ RUN      \]/ { said = ""; inside = 1 }
    inside { said = said $0 "\n" }
    inside && /\[       OK \]|\[  SKIPPED \]/ { said = ""; inside = 0; next }
    inside && /\[  FAILED  \]/ { printf "%s", said; said = ""; inside = 0; next }
    !inside && !/^$|^\[----------\]/
    END { printf "%s", said }'
exit "${PIPESTATUS[0]}"

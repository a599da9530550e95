# For tests of the shell that need what a machine may not have; to be sourced.
#
# skip REASON [PACKAGE]: ends the test as skipped (77). Its last line says why, and names the Debian package that would help, as
# skip() of tests/skipped.py does.
skip() {
    echo "skipped: $1${2:+; install $2}"
    exit 77
}

#pragma once

// The version of Rabit. The build takes it from here. While the major version is 0, a new minor version may
// change API and ABI; a new patch version does not. So the shared libraries are then named
// librabit_*.so.0.MINOR, and find_package accepts only the same minor version.
#define RABIT_VERSION_MAJOR 0
#define RABIT_VERSION_MINOR 2
#define RABIT_VERSION_PATCH 0

#define RABIT_VERSION_TEXT_OF(number) #number
#define RABIT_VERSION_TEXT(major, minor, patch) \
    RABIT_VERSION_TEXT_OF(major) "." RABIT_VERSION_TEXT_OF(minor) "." RABIT_VERSION_TEXT_OF(patch)

// For comparisons in the preprocessor: #if RABIT_VERSION >= RABIT_VERSION_NUMBER(0, 3, 0)
#define RABIT_VERSION_NUMBER(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
#define RABIT_VERSION RABIT_VERSION_NUMBER(RABIT_VERSION_MAJOR, RABIT_VERSION_MINOR, RABIT_VERSION_PATCH)

// "0.2.0"
#define RABIT_VERSION_STRING RABIT_VERSION_TEXT(RABIT_VERSION_MAJOR, RABIT_VERSION_MINOR, RABIT_VERSION_PATCH)

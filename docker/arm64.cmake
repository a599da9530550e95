# Compiles on x86-64 for arm64 with Debian's cross compiler (the preset arm64). Programs of arm64 that the build runs, like
# idlc and its plugin, are started under qemu-user; so are the unit tests by ctest.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64)

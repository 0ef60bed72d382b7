# Toolchain file: arm64 by Debian's cross compiler, against the packages that arm64_sysroot.sh has unpacked in the build
# folder. Programs of the build run under qemu's user emulation, generators (lcm-gen) on the host.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ROVER_SYSROOT)
set(ROVER_SYSROOT "${CMAKE_BINARY_DIR}/sysroot" CACHE PATH "arm64 packages")
set(CMAKE_SYSROOT ${ROVER_SYSROOT})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${ROVER_SYSROOT})

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(libraries ${ROVER_SYSROOT}/usr/lib/aarch64-linux-gnu)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${ROVER_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${libraries}/pkgconfig:${ROVER_SYSROOT}/usr/share/pkgconfig)
# GCC finds mold for the host only; GNU ld needs to know where libraries of libraries are.
set(MOLD_PROGRAM "" CACHE FILEPATH "linker, unless empty")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${libraries}")

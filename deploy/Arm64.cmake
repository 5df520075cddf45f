# Toolchain for 64-bit ARM: Debian's cross compiler, and the libraries' packages of that architecture, unpacked in
# NAIAD_ARM64_ROOT (deploy/static-client --arm64). It is included again by project(), for what a platform sets itself.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES NAIAD_ARM64_ROOT)

set(CMAKE_FIND_ROOT_PATH ${NAIAD_ARM64_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)  # protoc is this machine's
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Archives: the shared libraries are in packages that are not unpacked.
set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
# Behind the compiler's own folders, which have the C library.
set(CMAKE_CXX_FLAGS_INIT "-idirafter ${NAIAD_ARM64_ROOT}/usr/include -idirafter ${NAIAD_ARM64_ROOT}/usr/include/aarch64-linux-gnu")
# What shared libraries would bring along, for dfclient itself, whose objects are the static one's.
set(CMAKE_CXX_STANDARD_LIBRARIES "${NAIAD_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/libtinfo.a ${NAIAD_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/libz.a")

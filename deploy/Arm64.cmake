# Toolchain for 64-bit ARM: Debian's cross compiler, and the library packages of that architecture, which deploy/static-client
# --arm64 unpacks in NAIAD_ARM64_ROOT. project() includes this file again, to override the platform's settings.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES NAIAD_ARM64_ROOT)

set(CMAKE_FIND_ROOT_PATH ${NAIAD_ARM64_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)  # protoc runs on the build machine
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Finds only archives, because the packages with the shared libraries are not unpacked.
set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
# The compiler searches these folders after its own ones, which have the C library.
set(CMAKE_CXX_FLAGS_INIT "-idirafter ${NAIAD_ARM64_ROOT}/usr/include -idirafter ${NAIAD_ARM64_ROOT}/usr/include/aarch64-linux-gnu")
# Archives on which other archives depend. Shared libraries name the libraries that they need; archives do not. The build of the
# static dfclient includes the plain one, whose objects it uses and which needs them, too.
set(CMAKE_CXX_STANDARD_LIBRARIES "${NAIAD_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/libtinfo.a ${NAIAD_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/libz.a")

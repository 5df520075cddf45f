# Functions and variables that the scripts in this folder share, for example to install packages and to build.
# The scripts source this file in bash after `set -euo pipefail`.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '%s\n' "-- $*" >&2; }
fail() {
  printf '%s\n' "$(basename "$0"): $1" >&2
  exit "${2:-1}"
}

# wrong_option TYPED KNOWN...: reports an unknown option, suggests the KNOWN one with the longest common beginning, and exits
# with 2.
wrong_option() {
  local typed=$1 known near="" length=2 same
  shift
  for known in "$@"; do
    for ((same = 0; same < ${#typed}; ++same)); do [ "${typed:same:1}" = "${known:same:1}" ] || break; done
    if [ $same -gt $length ]; then near=$known length=$same; fi
  done
  fail "unknown option $typed${near:+; did you mean $near?}
Run deploy/$(basename "$0") --help for more information." 2
}

# Packages that deploy/package needs to build packages, and to test them.
package_packages="dpkg-dev file"
package_check_packages="lintian mmdebstrap systemd man-db groff zsh fish"

# Packages for building and running, and for the tests. The names are those of Debian 12 and 13.
build_packages="g++ cmake ninja-build ccache libasio-dev libprotobuf-dev protobuf-compiler libncurses-dev libcli11-dev libssl-dev libargon2-dev libicu-dev libqrencode-dev libboost-dev zlib1g-dev libsqlite3-dev libnats-dev nlohmann-json3-dev"
# Also needed by the static dfclient, because Debian 13's libcrypto.a calls functions of libzstd.
static_packages="libzstd-dev"
# Packages that make and test the page for browsers.
page_packages="emscripten python3-fonttools python3-brotli python3-protobuf fonts-dejavu-core"
check_packages="$build_packages $page_packages $static_packages nats-server doxygen pkg-config chromium chromium-driver libgtest-dev tmux python3 python3-websockets clang clang-format clang-tidy libclang-rt-dev ncurses-term openssh-client openssh-server openssl iproute2 fail2ban python3-yaml dpkg-dev systemd man-db groff zsh fish"

# Packages that make the API's pages.
docs_packages="doxygen"

# Packages to compile a dfclient for 64-bit ARM, and to run it in a test.
arm64_packages="g++-aarch64-linux-gnu qemu-user-static"

# Packages of the benchmarks, including the libraries that they compare with.
bench_packages="$build_packages openssl libbox2d-dev libchipmunk-dev valgrind python3 libvterm-dev openssh-client openssh-server mosh"

# Packages of the laboratory: other engines to compare with, and a solver for references. GCC has quad precision.
lab_packages="$build_packages libbox2d-dev libchipmunk-dev libsundials-dev libgtest-dev valgrind python3"

# Packages that report how much of a decoder the fuzzing reached.
fuzz_packages="llvm"

# missing_packages "a b c": prints those of these packages that are not installed, each after a blank.
missing_packages() {
  local package
  for package in $1; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || printf ' %s' "$package"
  done
}
has_packages() { [ -z "$(missing_packages "$1")" ]; }

# need_packages "a b c": installs those of these packages that are missing. Calls apt only if any is missing.
need_packages() {
  local missing
  missing=$(missing_packages "$1")
  [ -z "$missing" ] && return 0
  local apt="apt-get install -y --no-install-recommends$missing" sudo=""
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || ! { sudo -n true 2>/dev/null || { [ -t 0 ] && sudo true; }; }; then
      echo "Required packages are missing, and this user cannot install them. As root, run:" >&2
      echo "  $apt" >&2
      exit 2
    fi
    sudo=sudo
  fi
  say "installing$missing"
  local log
  log=$(mktemp)
  export DEBIAN_FRONTEND=noninteractive
  # Package lists may be missing or old: refresh them, but let the install decide whether that matters.
  $sudo apt-get update -qq >"$log" 2>&1 || true
  if ! $sudo env DEBIAN_FRONTEND=noninteractive $apt >>"$log" 2>&1; then
    tail -n 20 "$log" >&2
    rm -f "$log"
    fail "cannot install packages; this command failed: $apt" 2
  fi
  rm -f "$log"
}

# build PRESET TARGET...: configures and builds the targets (none: all). Prints the output only if that fails.
build() {
  local preset=$1 log options=()
  shift
  # GCC writes addresses of its own memory into precompiled headers. Without address randomisation the bytes of a header
  # never change, so ccache still finds objects compiled with an earlier build of it.
  command -v ccache >/dev/null && options=("-DCMAKE_CXX_COMPILER_LAUNCHER=$(setarch -R true 2>/dev/null && echo 'setarch;-R;')ccache")
  # All scripts use the same build folder for the preset `release`. Only deploy/check turns its tests on; other scripts turn
  # them off in a new folder, and else leave the setting as it is.
  if [ "$preset" = release ] && [ "$(basename "$0")" = check ]; then
    options+=(-DNAIAD_TESTS=ON)
  elif [ "$preset" = release ] && [ ! -e "$root/build/release/CMakeCache.txt" ]; then
    options+=(-DNAIAD_TESTS=OFF)
  fi
  export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1  # other checkouts can use these objects
  # ccache needs this to store objects compiled with a precompiled header.
  export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
  log=$(mktemp)
  say "building ($preset)"
  if ! { (cd "$root" && cmake --preset "$preset" "${options[@]}" ${CMAKE_EXTRA:-}) >"$log" 2>&1 &&
         build_targets "$preset" "$@" >>"$log" 2>&1; }; then
    grep -vE '^\[[0-9]+/[0-9]+\] (Building|Linking|Generating|Running)' "$log" | tail -n 60 >&2
    rm -f "$log"
    fail "the build failed ($preset)"
  fi
  rm -f "$log"
}

# build_targets PRESET TARGET...: builds the targets. On a terminal, shows the numbers of done and of all steps.
build_targets() {
  local preset=$1
  shift
  local targets=()
  [ $# -gt 0 ] && targets=(--target "$@")
  if [ -t 2 ]; then
    cmake --build "$root/build/$preset" "${targets[@]}" 2>&1 | tee >(grep --line-buffered -oE '^\[[0-9]+/[0-9]+\]' | while read -r step; do printf '\r-- %s ' "$step" >&2; done)
    local status=${PIPESTATUS[0]}
    printf '\r            \r' >&2
    return "$status"
  fi
  cmake --build "$root/build/$preset" "${targets[@]}"
}

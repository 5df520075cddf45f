// naiad_soak: a server and bots over bad links in virtual time. Compares every client's screen with the
// server's.
//
// Exit codes: 0 success, 1 a failure (the last lines describe it), 2 invalid command line.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "Soak.h"

namespace {

int usage() {
  std::fprintf(stderr,
               "naiad_soak [--bots N] [--minutes M] [--seed S] [--stride K] [--haste H] [--quick]\n"
               "  --stride  look at each player's picture in every K-th tick (default 5)\n"
               "  --haste   let things happen H times as often (default 1)\n"
               "  --quick   12 bots, 1.5 minutes, every tick, 8 times as often\n");
  return 2;
}

bool parse(int argc, char** argv, naiad::soak::SoakOptions& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--quick") {
      options.bots = 12;
      options.minutes = 1.5;
      options.haste = 8;
      options.stride = 1;
      continue;
    }
    if (i + 1 == argc) return false;
    char* end = nullptr;
    const double value = std::strtod(argv[++i], &end);
    if (*end != '\0' || value < 0) return false;
    if (name == "--bots" && value >= 1 && value <= 1000) {
      options.bots = static_cast<int>(value);
    } else if (name == "--minutes") {
      options.minutes = value;
    } else if (name == "--seed") {
      options.seed = static_cast<std::uint64_t>(value);
    } else if (name == "--stride" && value >= 1) {
      options.stride = static_cast<std::uint32_t>(value);
    } else if (name == "--haste") {
      options.haste = value;
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  naiad::soak::SoakOptions options;
  if (!parse(argc, argv, options)) return usage();
  naiad::soak::Soak soak(options);
  return soak.run() ? 0 : 1;
}

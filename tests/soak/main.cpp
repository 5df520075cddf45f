// naiad_soak: a server and bots over bad links in virtual time. Compares every client's screen with the
// server's.
//
// Exit codes: 0 success, 1 a failure (the last lines describe it), 2 invalid command line.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "Soak.h"

namespace {

bool parse(int argc, char** argv, naiad::soak::SoakOptions& options) {
  if (argc == 2 && std::strcmp(argv[1], "--quick") == 0) {
    options = {.bots = 12, .minutes = 1.5, .haste = 8, .stride = 1};
    return true;
  }
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    char* end = nullptr;
    const double value = i + 1 < argc ? std::strtod(argv[i + 1], &end) : -1;
    if (value < 0 || *end != '\0' || (name != "--bots" && name != "--minutes")) return false;
    if (name == "--minutes") options.minutes = value;
    if (name == "--bots") options.bots = std::clamp(static_cast<int>(value), 1, 1000);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  naiad::soak::SoakOptions options;
  if (!parse(argc, argv, options)) {
    std::fprintf(stderr,
                 "usage: naiad_soak [--bots N] [--minutes M]\n"
                 "       naiad_soak --quick    12 bots, 1.5 minutes, every tick, 8 times as many events\n");
    return 2;
  }
  naiad::soak::Soak soak(options);
  return soak.run() ? 0 : 1;
}

#include "host/world/FixedAddresses.h"

#include <sys/personality.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace naiad {

namespace {

/// Environment and arguments are padded to multiples of these numbers; usual ones fit in one multiple.
constexpr std::size_t kEntries = 64;
constexpr std::size_t kBytes = std::size_t{16} << 10;
constexpr rlim_t kStack = rlim_t{8} << 20;

const std::string kFiller = "DF_FILLER=";

std::size_t roundUp(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

}  // namespace

void padEnvironment(const std::string& program, const std::vector<std::string>& arguments,
                    std::vector<std::string>& environment) {
  const std::size_t words = roundUp(arguments.size() + environment.size() + 1, kEntries);
  environment.resize(words - arguments.size(), kFiller);
  std::size_t bytes = program.size() + 1;
  for (const auto* p_words : {&arguments, &std::as_const(environment)}) {
    for (const std::string& word : *p_words) bytes += word.size() + 1;
  }
  environment.back().append(roundUp(bytes, kBytes) - bytes, '.');
}

bool canDisableAslr() {
  const pid_t trial = fork();
  if (trial == 0) _exit(disableAslr() ? 0 : 1);
  int status = 0;
  while (trial > 0 && waitpid(trial, &status, 0) < 0 && errno == EINTR) continue;
  return trial > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool hasFixedAddresses() {
  const int now = personality(0xffffffff);
  return now >= 0 && (now & ADDR_NO_RANDOMIZE) != 0;
}

bool disableAslr() {
  rlimit stack{};
  if (getrlimit(RLIMIT_STACK, &stack) == 0) {
    stack.rlim_cur = std::min(kStack, stack.rlim_max);
    setrlimit(RLIMIT_STACK, &stack);
  }
  const int now = personality(0xffffffff);
  return now >= 0 && personality(static_cast<unsigned long>(now) | ADDR_NO_RANDOMIZE) >= 0;
}

}  // namespace naiad

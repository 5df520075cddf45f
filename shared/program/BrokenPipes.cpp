#include "shared/program/BrokenPipes.h"

#include <csignal>

namespace naiad {

void surviveBrokenPipes() {
  struct sigaction before {};
  if (sigaction(SIGPIPE, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) return;
  // A handler, since exec() takes that back; a signal that is ignored stays so in what it starts.
  struct sigaction action {};
  action.sa_handler = [](int /*signal*/) {};
  action.sa_flags = SA_RESTART;
  sigaction(SIGPIPE, &action, nullptr);
}

}  // namespace naiad

#include "shared/program/BrokenPipes.h"

#include <pthread.h>

#include <csignal>
#include <utility>

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

std::thread startWithoutSignals(std::function<void()> job) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(job));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace naiad

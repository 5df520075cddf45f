#include "shared/program/ProcessSetup.h"

#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <utility>

namespace naiad {

std::size_t raiseOpenFileLimit(std::size_t wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  if (limit.rlim_cur >= wanted) return limit.rlim_cur;
  rlimit more = limit;
  more.rlim_cur = std::min<rlim_t>(wanted, limit.rlim_max);
  return setrlimit(RLIMIT_NOFILE, &more) == 0 ? more.rlim_cur : limit.rlim_cur;
}

void ignoreBrokenPipes() {
  struct sigaction before {};
  if (sigaction(SIGPIPE, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) return;
  // A handler instead of SIG_IGN: exec() resets handlers, but started programs inherit an ignored signal.
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
  // Restores the signal mask also if std::thread throws.
  const std::shared_ptr<void> restored(nullptr,
                                       [&](void*) { pthread_sigmask(SIG_SETMASK, &before, nullptr); });
  return std::thread(std::move(job));
}

}  // namespace naiad

#include "shared/program/ProcessSetup.h"

#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

namespace naiad {

namespace {

std::string limitText(decltype(RLIMIT_AS) limit, rlim_t unit) {
  rlimit now{};
  if (getrlimit(limit, &now) != 0 || now.rlim_cur == RLIM_INFINITY) return "unlimited";
  return std::to_string(now.rlim_cur / unit);
}

/// Returns a sentence with the limits that may have caused this errno; empty for another one.
std::string limitsText(int error) {
  if (error != EAGAIN && error != ENOMEM) return {};
  constexpr rlim_t kKiB = 1024;
  return ". Limits of this process: address space in KiB (ulimit -v): " + limitText(RLIMIT_AS, kKiB) +
         "; processes and threads (ulimit -u): " + limitText(RLIMIT_NPROC, 1) +
         "; a container may have lower ones";
}

}  // namespace

std::string errorText(int error) {
  return std::generic_category().message(error) + limitsText(error);
}

std::string errorText(const std::exception& error) {
  const auto* p_system = dynamic_cast<const std::system_error*>(&error);
  if (p_system != nullptr) return error.what() + limitsText(p_system->code().value());
  const bool is_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  return is_memory ? errorText(ENOMEM) : error.what();
}

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

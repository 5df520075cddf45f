// Settings of a process: the limit of open files, SIGPIPE, and threads that block all signals.
#pragma once

#include <cstddef>
#include <functional>
#include <thread>

namespace naiad {

/// Raises the limit of open files and sockets to `wanted`, or as far as the system allows. Returns the limit
/// now, which may be lower than that. Never lowers it.
std::size_t allowOpenFiles(std::size_t wanted);

/// Unless the process handles SIGPIPE already, a write to a pipe without a reader fails with EPIPE from now
/// on. Programs that this process starts have the default again.
void surviveBrokenPipes();

/// Runs `job` on a new thread that blocks all signals, so that only other threads handle them. Throws
/// std::system_error if no thread can be started.
std::thread startWithoutSignals(std::function<void()> job);

}  // namespace naiad

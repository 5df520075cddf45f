// What a process asks of its system: many open files, no signals of broken pipes, threads without signals.
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

/// Runs `job` on a thread that takes no signals: they are for the threads that were there before. Throws
/// std::system_error if there can be no thread.
std::thread startWithoutSignals(std::function<void()> job);

}  // namespace naiad

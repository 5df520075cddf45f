// Process settings: limits, SIGPIPE, and threads that block all signals.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <thread>

namespace naiad {

/// Raises the limit of open files and sockets to `wanted`, or as far as the system allows; never lowers it.
/// Returns the new limit, which may be lower or higher than requested; 0 if it cannot be read.
std::size_t raiseOpenFileLimit(std::size_t wanted);

// Errors, for people. If the system refused memory, a thread or a process, the texts name this process's
// limits.

/// Returns the text of an errno.
std::string errorText(int error);
/// Returns error.what().
std::string errorText(const std::exception& error);

/// Makes writes to a pipe without a reader fail with EPIPE. Does nothing if the process handles or ignores
/// SIGPIPE. Programs started by this process get SIGPIPE's default action.
void ignoreBrokenPipes();

/// Runs `job` on a new thread that blocks all signals, so that only other threads handle them. Throws
/// std::system_error if no thread can be started.
std::thread startWithoutSignals(std::function<void()> job);

}  // namespace naiad

// Signals that are not for whoever happens to run: broken pipes, and those that come while threads work.
#pragma once

#include <functional>
#include <thread>

namespace naiad {

/// Unless the process handles SIGPIPE already, a write to a pipe without a reader fails with EPIPE from now
/// on. Programs that this process starts have the default again.
void surviveBrokenPipes();

/// Runs `job` on a thread that takes no signals: they are for the threads that were there before.
std::thread startWithoutSignals(std::function<void()> job);

}  // namespace naiad

// The directory of a fleet: listens on the bus to servers that say they are there, and writes a list of them
// for the web (ServerList.h).
#pragma once

#include <memory>

#include "server/directory/DirectorySettings.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// All of it happens in run(), on the thread that calls it.
class Directory {
 public:
  /// Throws std::runtime_error if the list cannot be written. The bus has no complaint (busComplaint()).
  Directory(DirectorySettings settings, LogLine log);
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  /// SIGINT and SIGTERM stop it; SIGHUP opens the log again. A second one of the first two has its usual
  /// effect.
  void heedSignals();
  /// Serve until a signal comes, or stop().
  void run();
  void stop();

 private:
  struct Loop;
  std::unique_ptr<Loop> m_loop;
};

}  // namespace naiad

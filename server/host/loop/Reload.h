// Reads a running server's options again.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "host/auth/PasswordHash.h"
#include "host/auth/ServerIdentity.h"
#include "host/settings/HostOptions.h"

namespace naiad {

/// What was read, and what takes time to make of it.
struct Reloaded {
  std::string problem;  ///< why nothing can be made of it; empty: it is good
  HostOptions options;
  std::optional<PasswordHash> password;    ///< of a password that has changed
  std::optional<ServerIdentity> identity;  ///< of --certificate and --key: the files may be new
};

/// Files may be slow, and a password takes 0.1 s to hash: both happen on a thread of its own.
class Reload {
 public:
  /// Throws what says why it cannot.
  using ReadOptions = std::function<HostOptions()>;

  explicit Reload(ReadOptions read) : m_read(std::move(read)) {}
  /// Waits for what has begun.
  ~Reload();
  Reload(const Reload&) = delete;
  Reload& operator=(const Reload&) = delete;

  /// Read them, and call `done` once, on the other thread. `now`: the options in force. False: what was begun
  /// earlier is not done.
  bool begin(const HostOptions& now, std::function<void(Reloaded)> done);

 private:
  ReadOptions m_read;
  std::thread m_thread;
  std::atomic<bool> m_reading = false;
};

}  // namespace naiad

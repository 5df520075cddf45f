// The interface of what a host may have beside its game: scores, commands, metrics, the list of servers, a
// fleet. Such parts are in a library of their own (OperatorLibrary.h).
#pragma once

#include <chrono>

namespace naiad {

struct HostContext;
class HostClients;
class HostControls;
class HostEndpoint;

/// What parts work with. All of it outlives them.
struct HostAccess {
  HostContext& context;
  HostEndpoint& endpoint;
  HostClients& clients;
  HostControls& controls;
};

/// All calls are for the host's thread, in this order. None but finish() waits. A part that cannot begin its
/// work throws in its constructor, before players may come: ListenError, or std::runtime_error.
class HostPart {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~HostPart() = default;
  /// Ticks begin, and players may come.
  virtual void begin() {}
  /// The end of each tick, which began at `now`. A world in a process of its own ends its tick later.
  virtual void tick(Clock::time_point now) = 0;
  /// The last tick has ended; the players' goodbyes come next.
  virtual void drain() {}
  /// After these: no player is left, and what was promised is to be on disk when this returns.
  virtual void finish() {}
};

}  // namespace naiad

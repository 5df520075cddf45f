// The interface of the parts that a host may have in addition to its game: scores, commands, metrics, the
// server list, a fleet. They are in another library (OperatorLibrary.h).
#pragma once

#include <chrono>

namespace naiad {

struct HostContext;
class HostClients;
class HostControls;
class HostEndpoint;

/// The objects that parts work with. All of them outlive the parts.
struct HostAccess {
  HostContext& context;
  HostEndpoint& endpoint;
  HostClients& clients;
  HostControls& controls;
};

/// All functions are called on the host's thread, in this order. Only finish() may block. A part that cannot
/// start throws ListenError or std::runtime_error in its constructor, before players can join.
class HostPart {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~HostPart() = default;
  /// Called before the first tick; players may now join.
  virtual void begin() {}
  /// Called at the end of each tick, which began at `now`. World processes may finish their tick later.
  virtual void tick(Clock::time_point now) = 0;
  /// Called after the last tick, before the players' goodbyes.
  virtual void drain() {}
  /// Called when all connections have ended. Must have written all promised data to disk when it returns.
  virtual void finish() {}
};

}  // namespace naiad

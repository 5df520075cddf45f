// The copies of a world's process, and their places in the round. The front is the server's process.
//
// To request a copy, the front makes a pair of sockets and sends one end to the world (kWorldCheckpoints),
// before the turn after which the copy is to be made (appendTurnMessage()). So a world never has to make a
// socket. The copy writes its process id, and waits (CheckpointForker). Two copies are kept, because the
// newer one may already have the state that leads to a crash.
//
// A world may be a stranger's program, so what it sends is not trusted: the supervisor resumes only a copy
// that is its own child. A world that makes no copies is soon not asked any more.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/world/ViewCodec.h"

namespace naiad {

/// A copy's place in the round, with the last view and the numbered data that later answers refer to.
struct CheckpointState {
  std::uint32_t next_tick = 1;  ///< next tick of the copy, in the host's numbers
  ViewReader views;
  df::WorldView view;
};

struct WorldCheckpoint {
  int socket = -1;     ///< our end of the copy's socket, to be closed by the owner
  pid_t process = -1;  ///< process id that the copy sent; below 0: not yet
  CheckpointState state;
};

class WorldCheckpoints {
 public:
  static constexpr std::size_t kMaxCheckpoints = 2;
  /// After this many requests in a row without a copy, no more copies are requested.
  static constexpr int kMaxFailures = 3;

  /// `orders`: our end of the socket for requests, closed by this; below 0: there are no copies.
  explicit WorldCheckpoints(int orders) : m_request_socket(orders) {}
  /// Ends all copies that popNewest() has not returned.
  ~WorldCheckpoints();
  WorldCheckpoints(const WorldCheckpoints&) = delete;
  WorldCheckpoints& operator=(const WorldCheckpoints&) = delete;

  /// True if copies can be requested.
  bool isOn() const { return m_request_socket >= 0; }
  /// Returns the reason if copies have become impossible, only once.
  std::optional<std::string> popProblem() { return std::exchange(m_problem, std::nullopt); }

  /// Requests a copy of the process `world` after the turn sent next. Returns false if there will be none.
  bool request(pid_t world);
  /// Adds the copy of the last request(). Call when the world has answered that turn; `state`: the copy's
  /// place in the round.
  void add(CheckpointState state);
  /// Reads the messages of copies, and drops ended and surplus copies. Call once in each tick.
  void update();
  /// Removes and returns the newest ready copy, to be resumed by the caller; nullopt if no copy is ready.
  std::optional<WorldCheckpoint> popNewest();
  /// True if a copy is ready to take over.
  bool hasCheckpoint() const { return !processes().empty(); }
  /// Ends all copies; more can be requested.
  void clear();
  /// Returns the processes of the copies that are ready.
  std::vector<pid_t> processes() const;

 private:
  bool send(int descriptor) const;
  void stop();
  void drop(std::size_t at);
  void dropRequested();
  bool receive(WorldCheckpoint& copy);

  int m_request_socket;
  int m_requested = -1;  ///< our end of the socket for the copy of the current turn
  int m_failures = 0;
  std::vector<WorldCheckpoint> m_checkpoints;  ///< newest last
  std::optional<std::string> m_problem;
};

}  // namespace naiad

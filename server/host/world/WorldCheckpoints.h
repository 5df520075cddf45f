// The copies of a world's process, and their places in the round. The front is the server's process.
//
// To request a copy, the front makes a pair of sockets and sends one end to the world (kWorldCheckpoints),
// before the turn after which the copy is to be made (appendTurnMessage()). So a world never has to make a
// socket. The copy writes its process id, and waits (CheckpointForker). Two copies are kept, because the
// newer one may already have the state that leads to a crash.
//
// A world may be a stranger's program, so its statements are not trusted: the supervisor resumes only a copy
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

/// Place of a copy in the round, and the views before it, because answers are differences to them.
struct CheckpointState {
  std::uint32_t next_tick = 1;  ///< in the host's numbers
  ViewReader views;
  df::WorldView view;
};

struct WorldCheckpoint {
  int socket = -1;     ///< our end of its socket, to be closed by the owner
  pid_t process = -1;  ///< process id that the copy sent; below 0: not yet
  CheckpointState state;
};

class WorldCheckpoints {
 public:
  static constexpr std::size_t kMaxCheckpoints = 2;
  /// After this many orders in a row without a copy, none are ordered any more.
  static constexpr int kMaxFailures = 3;

  /// `orders`: our end of the socket for orders, closed by this; below 0: no copies.
  explicit WorldCheckpoints(int orders) : m_request_socket(orders) {}
  /// Ends all copies that have not been taken.
  ~WorldCheckpoints();
  WorldCheckpoints(const WorldCheckpoints&) = delete;
  WorldCheckpoints& operator=(const WorldCheckpoints&) = delete;

  /// True if copies can be ordered.
  bool isOn() const { return m_request_socket >= 0; }
  /// Returns why no copies can be ordered any more, once, in words.
  std::optional<std::string> popProblem() { return std::exchange(m_problem, std::nullopt); }

  /// Orders a copy of the process `world` for the turn that is sent next. Returns false if there will be
  /// none.
  bool request(pid_t world);
  /// Call when the world has answered that turn; `state` is its state then.
  void add(CheckpointState state);
  /// Reads the messages of copies. Call once in each tick.
  void update();
  /// Removes and returns the newest copy, to be resumed by the caller; nullopt without copies.
  std::optional<WorldCheckpoint> popNewest();
  /// True if a copy is ready to take over.
  bool hasCheckpoint() const { return !processes().empty(); }
  /// Ends all copies; more can be ordered.
  void clear();
  /// Returns the processes of the copies.
  std::vector<pid_t> processes() const;

 private:
  bool send(int descriptor) const;
  void stop();
  void drop(std::size_t at);
  void dropRequested();
  bool receive(WorldCheckpoint& copy);

  int m_request_socket;
  int m_requested = -1;  ///< our end for the copy of the current turn
  int m_failures = 0;
  std::vector<WorldCheckpoint> m_checkpoints;  ///< newest last
  std::optional<std::string> m_problem;
};

}  // namespace naiad

// The world's side of a WorldProcess: implements GM.run() in a process that a host has started for a world.
#pragma once

#include <optional>
#include <string>

#include "engine/world/Runner.h"
#include "host/snapshot/LagCompensator.h"
#include "host/snapshot/Publisher.h"
#include "host/world/TurnRecord.h"

namespace naiad {

/// Makes copies of a world's process when the front requests them (WorldCheckpoints.h).
///
/// A copy waits on a socket of its own until the front lets it replace the world, and ends when that socket
/// closes. It is a child of the world's supervisor, not of the world. So the game's own wait() never sees it,
/// and it ends with the supervisor as the world does.
class CheckpointForker {
 public:
  /// Takes over the descriptor kWorldCheckpoints. If this process does not have it, no copies are made.
  CheckpointForker();
  ~CheckpointForker();
  CheckpointForker(const CheckpointForker&) = delete;
  CheckpointForker& operator=(const CheckpointForker&) = delete;

  /// Makes the copy that was requested last. Call between two turns, in a process without threads. In the
  /// world, returns nullopt at once, whether or not there is a copy. In the copy, returns the copy's end of
  /// its socket when the front has sent the next turn, and closes `world_socket`.
  std::optional<int> makeCopy(int world_socket) const;

 private:
  int receiveRequest() const;

  int m_request_socket = -1;
};

class WorldServer : public df::Runner {
 public:
  /// `socket`: from takeWorldSocket(), closed by this; below 0: run() ends at once. `leaves`: if a key of a
  /// player ends the game, only this player leaves instead (InputQueue::setGameOverLeaves).
  WorldServer(int socket, bool leaves) : m_socket(socket), m_leaves(leaves) {}
  ~WorldServer() override;
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  /// Ticks as the host orders, until the game is over, the host is gone, or a frame is invalid or too long.
  void run(df::World& world) override;

 private:
  bool receive(std::string& fields) const;
  bool send(const std::string& frame) const;
  void updateLagCompensation(const WorldTurn& turn, df::World& world);
  bool sendAnswer(const WorldTurn& turn, df::World& world);
  void makeCopy();
  void close();

  int m_socket;
  bool m_leaves;
  TurnRecordReader m_turns;
  CheckpointForker m_checkpoints;
  ViewWriter m_views;
  std::string m_frame;
  // Lag compensation is needed in the middle of a tick, so the published models are computed here, too.
  std::optional<Publisher> m_publisher;
  LagCompensator m_lag_compensator;
};

}  // namespace naiad

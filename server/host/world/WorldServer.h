// The other end of a WorldProcess: what GM.run() is in a process that a host has started for a world.
#pragma once

#include <optional>
#include <string>

#include "engine/world/Runner.h"
#include "host/snapshot/LagCompensator.h"
#include "host/snapshot/Publisher.h"
#include "host/world/TurnRecord.h"

namespace naiad {

/// In a world's process: makes copies of it, as the front orders (WorldCopies.h).
///
/// A copy waits on a socket of its own until the front lets it go on in place of the world, and ends when
/// that socket closes. It is a child of the world's keeper, not of the world: the game's own wait() never
/// sees it, and it ends with the keeper as the world does.
class CopyMaker {
 public:
  /// Takes over kWorldCopies, if this process has it; without it no copies are made.
  CopyMaker();
  ~CopyMaker();
  CopyMaker(const CopyMaker&) = delete;
  CopyMaker& operator=(const CopyMaker&) = delete;

  /// Make the copy that was ordered last. For a process without threads, between two turns. Return in the
  /// world: nothing, at once, whether or not there is a copy. Return in the copy: its end of the socket, on
  /// which the front has sent the next turn; `world_socket` is closed there.
  std::optional<int> makeCopy(int world_socket) const;

 private:
  int takeOrder() const;

  int m_orders = -1;
};

class WorldServer : public df::Runner {
 public:
  /// `socket`: from takeWorldSocket(), closed by this; below 0: run() ends at once. `leaves`: a player whose
  /// key ends the game leaves it (InputQueue::setGameOverLeaves).
  WorldServer(int socket, bool leaves) : m_socket(socket), m_leaves(leaves) {}
  ~WorldServer() override;
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  /// Tick as the host says, until the game is over or the host is gone.
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
  CopyMaker m_copies;
  ViewWriter m_views;
  std::string m_frame;
  // A game that uses lag compensation asks in the middle of a tick, so the published models are computed
  // here, too.
  std::optional<Publisher> m_publisher;
  LagCompensator m_lag_compensator;
};

}  // namespace naiad

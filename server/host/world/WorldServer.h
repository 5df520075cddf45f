// The other end of a WorldProcess: what GM.run() is in a process that a host has started for a world.
#pragma once

#include <optional>
#include <string>

#include "engine/world/Runner.h"
#include "host/snapshot/LagCompensator.h"
#include "host/snapshot/Publisher.h"
#include "host/world/CopyMaker.h"
#include "host/world/TurnRecord.h"

namespace naiad {

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

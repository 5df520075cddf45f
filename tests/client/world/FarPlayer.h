// A real world with a player on a distant client that predicts. Snapshots and inputs pass through simple
// queues with delay and loss, one step per tick.
//
// In step n the server makes tick n, then the client draws a frame with its own object as predicted for the
// end of tick n + lead. The server applies keys pressed in this frame in the tick after that.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "client/world/DrawnPlacement.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {

/// Delays in ticks and probability of loss, in each direction. `margin` is how many copies of an input in a
/// row may be lost before it is late.
struct LinkDelays {
  std::uint32_t down = 3;
  std::uint32_t up = 3;
  double loss = 0;
  std::uint32_t margin = 2;
};

class FarPlayer {
 public:
  FarPlayer(const LinkDelays& delays, std::uint64_t seed);
  ~FarPlayer() { world.shutDown(); }

  df::Player& player() { return *world.views().player(m_player); }
  /// Runs one tick and draws one frame.
  void step();
  /// Steps until the client knows every object of interest to it.
  void stepUntilAllKnown();
  /// Presses a key in the frame just drawn.
  void press(df::Keyboard::Key key, df::EventKeyboardAction action = df::KEY_PRESSED);

  std::uint32_t tick() const { return static_cast<std::uint32_t>(world.getStepCount()); }
  std::uint32_t lead() const { return m_delays.up + m_delays.margin; }
  std::uint32_t shownTick() const { return tick() + lead(); }

  df::World world;
  df::World::Scope scope{world};
  SplitMix64 rng;
  Replica replica;
  Prediction prediction;

  // Results.
  std::uint32_t compared_from = 0;  ///< frames before this step do not count
  int compared = 0;                 ///< frames whose tick has happened
  int wrong = 0;                    ///< compared frames that showed the object in a wrong place
  int wrong_views = 0;              ///< compared frames with a wrong view
  int inputs = 0;
  int late_inputs = 0;  ///< inputs applied after their requested tick
  int states = 0;       ///< states of the player that arrived
  int ticks = 0;

 private:
  struct Down {
    std::uint32_t arrives;
    SnapshotSender::Packet packet;
  };
  struct Up {
    std::uint32_t arrives;
    std::vector<Input> inputs;
    AckWindow acks;
  };
  struct Frame {
    df::FixedVector position;
    CellPosition corner;
  };

  bool isLost() { return rng.unit() < m_delays.loss; }
  void serve();
  void takeInputs();
  void checkFrame();
  void receive(const SnapshotSender::Packet& packet);
  void draw();

  LinkDelays m_delays;
  std::uint32_t m_player;
  Publisher m_publisher;
  SnapshotSender m_sender{Resend::kAhead};
  std::deque<Down> m_down;
  std::deque<Up> m_up;
  std::map<std::uint32_t, Input> m_waiting;  // inputs on the server by id
  std::uint32_t m_applied = 0;

  std::uint32_t m_table_known = 0;  // as in ReceivedWorld
  std::uint32_t m_control_known = 0;
  AckWindow m_acks;
  std::uint32_t m_next_id = 1;
  std::uint32_t m_acknowledged = 0;
  std::deque<Input> m_pending;
  std::map<std::uint32_t, Frame> m_frames;  // shown frames by tick
};

}  // namespace naiad::test

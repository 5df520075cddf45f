// A real world with a player on a distant client that predicts: snapshots and inputs pass through plain
// queues with delay and loss, one step per tick.
//
// In step n the server makes tick n, then the client draws a frame: its own object as it will be at the end
// of tick n + lead, the tick before the one in which the server takes in what is pressed in this frame.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "client/world/DrawnPlacement.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Player.h"
#include "engine/world/World.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {

/// Delays in ticks, each way; probability of loss, each way; how many repeats of an input may be lost before
/// it comes too late.
struct Way {
  std::uint32_t down = 3;
  std::uint32_t up = 3;
  double loss = 0;
  std::uint32_t margin = 2;
};

class FarPlayer {
 public:
  FarPlayer(const Way& way, std::uint64_t seed);
  ~FarPlayer() { world.shutDown(); }

  df::Player& player() { return *world.getPlayer(m_player); }
  /// One tick and one frame.
  void step();
  /// Step until the client has heard of all that is of interest to it.
  void meetAll();
  /// In the frame that has just been drawn.
  void press(df::Keyboard::Key key, df::EventKeyboardAction action = df::KEY_PRESSED);

  std::uint32_t tick() const { return static_cast<std::uint32_t>(world.getStepCount()); }
  std::uint32_t lead() const { return m_way.up + m_way.margin; }
  std::uint32_t shownTick() const { return tick() + lead(); }

  df::World world;
  df::World::Scope scope{world};
  SplitMix64 rng;
  Replica replica;
  Prediction prediction;

  // What came of it.
  std::uint32_t compared_from = 0;  ///< frames before this step do not count
  int compared = 0;                 ///< frames whose tick has come true
  int wrong = 0;                    ///< of these, in how many the object was shown elsewhere than it then was
  int wrong_views = 0;              ///< … or the view
  int inputs = 0;
  int late_inputs = 0;  ///< taken in after the tick they were meant for
  int states = 0;       ///< states of the player that arrived
  int ticks = 0;

 private:
  struct Down {
    std::uint32_t arrives;
    SnapshotSender::Packet packet;
  };
  struct Input {
    std::uint32_t id;
    df::Keyboard::Key key;
    df::EventKeyboardAction action;
    std::uint32_t tick;
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

  bool isLost() { return rng.unit() < m_way.loss; }
  void serve();
  void takeInputs();
  void checkFrame();
  void receive(const SnapshotSender::Packet& packet);
  void draw();

  Way m_way;
  std::uint32_t m_player;
  Publisher m_publisher;
  SnapshotSender m_sender{Resend::kAhead};
  std::deque<Down> m_down;
  std::deque<Up> m_up;
  std::map<std::uint32_t, Input> m_waiting;  // on the server, by id
  std::uint32_t m_applied = 0;

  std::uint32_t m_table_known = 0;  // as in ClientSession
  std::uint32_t m_control_known = 0;
  AckWindow m_acks;
  std::uint32_t m_next_id = 1;
  std::uint32_t m_answered = 0;
  std::deque<Input> m_unanswered;
  std::map<std::uint32_t, Frame> m_frames;  // shown, by tick
};

}  // namespace naiad::test

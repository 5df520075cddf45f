// A real world with a player on a distant client that predicts. Snapshots and inputs pass through simple
// queues with delay and loss, one step per tick.
//
// In step n the server makes tick n, then the client draws a frame with its own object as predicted for the
// end of tick n + lead. The server applies keys pressed in this frame in the tick after that.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "client/world/DrawnPlacement.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
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
  FarPlayer(const LinkDelays& delays, std::uint64_t seed) : rng(seed), m_delays(delays) {
    world.log().setSink([](const std::string&) {});
    world.setSeed(seed);
    world.store().setWatched(true);
    m_sender.setLookAhead(lead() + m_delays.down);
    m_player = world.input().join("far", df::RED);
    world.tick();
    m_publisher.update(world.picture().view());
    m_sender.applyTick(m_publisher, world.picture().view().players[0]);
  }
  ~FarPlayer() { world.shutDown(); }

  df::Player& player() { return *world.views().player(m_player); }
  /// Runs one tick and draws one frame.
  void step() {
    takeInputs();
    world.tick();
    ++ticks;
    checkFrame();
    serve();
    draw();
  }
  /// Steps until the client knows every object of interest to it.
  void stepUntilAllKnown() {
    const auto knowsAll = [this] {
      return m_sender.knownCount() > 1 && replica.aliveCount() == m_sender.knownCount();
    };
    for (std::uint32_t i = 0; i < m_delays.down + m_delays.up; ++i) step();
    for (int i = 0; i < 1000 && !knowsAll(); ++i) step();
    ASSERT_TRUE(knowsAll());
    for (std::uint32_t i = 0; i <= lead(); ++i) step();  // until all earlier frames can be checked
  }
  /// Presses a key in the frame just drawn.
  void press(df::Keyboard::Key key, df::EventKeyboardAction action = df::KEY_PRESSED) {
    const Input input{.id = m_next_id++,
                      .tick = shownTick() + 1,
                      .action = static_cast<std::uint8_t>(action),
                      .key = static_cast<std::uint8_t>(key)};
    ++inputs;
    prediction.addInput(input);
    m_pending.push_back(input);
    if (!isLost()) m_up.push_back({tick() + m_delays.up, {input}, m_acks});
  }

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
  void serve() {
    m_publisher.update(world.picture().view());
    m_sender.applyTick(m_publisher, world.picture().view().players[0]);
    for (SnapshotSender::Packet& packet : m_sender.build(m_publisher)) {
      if (!isLost()) m_down.push_back({tick() + m_delays.down, std::move(packet)});
    }
  }
  void takeInputs() {
    const std::uint32_t now = tick() + 1;
    for (; !m_up.empty() && m_up.front().arrives <= now; m_up.pop_front()) {
      for (const Input& input : m_up.front().inputs) {
        if (input.id > m_applied) m_waiting.emplace(input.id, input);
      }
      m_sender.acknowledge(m_up.front().acks);
    }
    for (auto next = m_waiting.find(m_applied + 1); next != m_waiting.end() && next->second.tick <= now;
         next = m_waiting.find(m_applied + 1)) {
      world.input().key(m_player, static_cast<df::Keyboard::Key>(next->second.key),
                        static_cast<df::EventKeyboardAction>(next->second.action));
      late_inputs += next->second.tick < now ? 1 : 0;
      m_sender.setNewestInput(++m_applied, now);
      m_waiting.erase(next);
    }
  }
  void checkFrame() {
    const auto frame = m_frames.find(tick());
    if (frame != m_frames.end()) {
      const df::FixedVector corner = world.picture().view().players[0].view_corner;
      ++compared;
      wrong += frame->second.position != world.picture().view().players[0].steering.position ? 1 : 0;
      wrong_views += frame->second.corner != CellPosition{df::cellOf(corner.x), df::cellOf(corner.y)} ? 1 : 0;
    }
    m_frames.erase(m_frames.begin(), m_frames.upper_bound(tick()));
  }
  void receive(const SnapshotSender::Packet& packet) {
    Snapshot snapshot;
    ASSERT_EQ(replica.read(packet.bytes, snapshot), ReadResult::kOk);
    replica.apply(snapshot);
    m_acks.addReceived(packet.number);
    if (snapshot.header.has_input) m_acknowledged = std::max(m_acknowledged, snapshot.header.input);
    if (replica.controlTableNumber() != m_table_known) {
      m_table_known = replica.controlTableNumber();
      prediction.setTable(replica.controlTable());
    }
    if (replica.controlNumber() != m_control_known) {
      m_control_known = replica.controlNumber();
      prediction.applyControl(replica.control());
      ++states;
    }
  }
  void draw() {
    for (; !m_down.empty() && m_down.front().arrives <= tick(); m_down.pop_front())
      receive(m_down.front().packet);
    while (!m_pending.empty() && m_pending.front().id <= m_acknowledged) m_pending.pop_front();
    const bool lost = isLost();
    if (!lost) m_up.push_back({tick() + m_delays.up, {m_pending.begin(), m_pending.end()}, m_acks});
    prediction.run(replica, shownTick());
    if (!prediction.isActive() || tick() < compared_from) return;
    const ExtrapolationClamp clamp(replica, tick(), tick());
    const DrawnPlacement placement(replica, prediction, clamp);
    m_frames[shownTick()] = {prediction.position(), replica.viewCorner(tick() - m_delays.down, &placement)};
  }

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

#include "FarPlayer.h"

#include <gtest/gtest.h>

#include <utility>

#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace naiad::test {

FarPlayer::FarPlayer(const LinkDelays& delays, std::uint64_t seed) : rng(seed), m_delays(delays) {
  world.log().setSink([](const std::string&) {});
  world.setSeed(seed);
  world.store().setWatched(true);
  m_sender.setLookAhead(lead() + m_delays.down);
  m_player = world.input().join("far", df::RED);
  world.tick();
  m_publisher.update(world.picture().view());
  m_sender.applyTick(m_publisher, world.picture().view().players[0]);
}

void FarPlayer::step() {
  takeInputs();
  world.tick();
  ++ticks;
  checkFrame();
  serve();
  draw();
}

void FarPlayer::stepUntilAllKnown() {
  const auto knowsAll = [this] {
    return m_sender.knownCount() > 1 && replica.aliveCount() == m_sender.knownCount();
  };
  for (std::uint32_t i = 0; i < m_delays.down + m_delays.up; ++i) step();
  for (int i = 0; i < 1000 && !knowsAll(); ++i) step();
  ASSERT_TRUE(knowsAll());
  for (std::uint32_t i = 0; i <= lead(); ++i) step();  // until all earlier frames can be checked
}

void FarPlayer::takeInputs() {
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

void FarPlayer::checkFrame() {
  const auto frame = m_frames.find(tick());
  if (frame != m_frames.end()) {
    const df::FixedVector corner = world.picture().view().players[0].view_corner;
    ++compared;
    wrong += frame->second.position != world.picture().view().players[0].steering.position ? 1 : 0;
    wrong_views += frame->second.corner != CellPosition{df::cellOf(corner.x), df::cellOf(corner.y)} ? 1 : 0;
  }
  m_frames.erase(m_frames.begin(), m_frames.upper_bound(tick()));
}

void FarPlayer::serve() {
  m_publisher.update(world.picture().view());
  m_sender.applyTick(m_publisher, world.picture().view().players[0]);
  for (SnapshotSender::Packet& packet : m_sender.build(m_publisher)) {
    if (!isLost()) m_down.push_back({tick() + m_delays.down, std::move(packet)});
  }
}

void FarPlayer::receive(const SnapshotSender::Packet& packet) {
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

void FarPlayer::draw() {
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

void FarPlayer::press(df::Keyboard::Key key, df::EventKeyboardAction action) {
  const Input input{.id = m_next_id++,
                    .tick = shownTick() + 1,
                    .action = static_cast<std::uint8_t>(action),
                    .key = static_cast<std::uint8_t>(key)};
  ++inputs;
  prediction.addInput(input);
  m_pending.push_back(input);
  if (!isLost()) m_up.push_back({tick() + m_delays.up, {input}, m_acks});
}

}  // namespace naiad::test

#include "FarPlayer.h"

#include <gtest/gtest.h>

#include <utility>

#include "SteeredCopy.h"

namespace naiad::test {

FarPlayer::FarPlayer(const Way& way, std::uint64_t seed) : rng(seed), m_way(way) {
  world.setLogSink([](const std::string&) {});
  world.setSeed(seed);
  world.setWatched(true);
  m_player = world.join("far", df::RED);
  world.tick();
  m_publisher.update(world.view());
  m_sender.note(m_publisher);
}

void FarPlayer::step() {
  takeInputs();
  world.tick();
  ++ticks;
  checkFrame();
  serve();
  draw();
}

void FarPlayer::meetAll() {
  const auto all = static_cast<std::size_t>(world.getObjectCount());
  for (int i = 0; i < 1000 && replica.aliveCount() < all; ++i) step();
  ASSERT_EQ(replica.aliveCount(), all);
  step();
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
    world.key(m_player, next->second.key, next->second.action);
    late_inputs += next->second.tick < now ? 1 : 0;
    ++m_applied;
    m_waiting.erase(next);
  }
}

void FarPlayer::checkFrame() {
  const auto frame = m_frames.find(tick());
  if (frame != m_frames.end()) {
    const df::FixedVector corner = world.view().players[0].view_corner;
    ++compared;
    wrong += frame->second.position != world.view().players[0].steering.position ? 1 : 0;
    wrong_views += frame->second.corner != CellPosition{df::cellOf(corner.x), df::cellOf(corner.y)} ? 1 : 0;
  }
  m_frames.erase(m_frames.begin(), m_frames.upper_bound(tick()));
}

void FarPlayer::serve() {
  m_publisher.update(world.view());
  m_sender.note(m_publisher);
  m_sender.setPlayer(world.view().players[0]);
  m_table = *world.view().players[0].steering.p_table;
  Down packet{tick() + m_way.down, m_sender.build(m_publisher), state(world.view().players[0]), tick()};
  if (!isLost()) m_down.push_back(std::move(packet));
}

std::string FarPlayer::state(const df::PlayerFacts& facts) {
  const df::SteeringFacts& f = facts.steering;
  const ControlRecord now{tick(),     f.object.slot, f.object.generation, m_applied,
                          f.position, f.velocity,    f.acceleration,      f.state};
  if (m_sparse && m_told && coast(*m_told, *f.p_table, tick()) == now) return {};
  m_told = now;
  ++states;
  std::string bytes;
  writeControlRecord(bytes, now);
  return bytes;
}

void FarPlayer::draw() {
  prediction.setTable(m_table);
  for (; !m_down.empty() && m_down.front().arrives <= tick(); m_down.pop_front()) {
    const Down& packet = m_down.front();
    for (const SnapshotSender::Snapshot& snapshot : packet.snapshots) {
      const auto records = readRecords(snapshot.records, snapshot.tick);
      ASSERT_TRUE(records);
      replica.apply(snapshot.number, snapshot.tick, *records);
      m_acks.note(snapshot.number);
    }
    if (packet.state.empty()) continue;
    const auto record = readControlRecord(packet.state, packet.tick);
    ASSERT_TRUE(record);
    prediction.take(*record);
    m_answered = std::max(m_answered, record->newest_input);
  }
  while (!m_unanswered.empty() && m_unanswered.front().id <= m_answered) m_unanswered.pop_front();
  const bool lost = isLost();
  if (!lost) {
    m_up.push_back({tick() + m_way.up, {m_unanswered.begin(), m_unanswered.end()}, m_acks});
  }
  prediction.run(replica, shownTick());
  if (!prediction.isActive() || tick() < compared_from) return;
  const ExtrapolationClamp clamp(replica, tick(), tick());
  const DrawnPlacement placement(replica, prediction, clamp);
  m_frames[shownTick()] = {prediction.position(), replica.viewCorner(tick() - m_way.down, &placement)};
}

void FarPlayer::press(df::Keyboard::Key key, df::EventKeyboardAction action) {
  const Input input{m_next_id++, key, action, shownTick() + 1};
  ++inputs;
  prediction.press(input.id, key, action, input.tick);
  m_unanswered.push_back(input);
  if (!isLost()) m_up.push_back({tick() + m_way.up, {input}, m_acks});
}

}  // namespace naiad::test

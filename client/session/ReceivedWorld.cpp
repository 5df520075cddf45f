#include "client/session/ReceivedWorld.h"

namespace naiad {

void ReceivedWorld::start(const WelcomeMessage& welcome, const ResumeState& from) {
  m_tick = welcome.tick;
  m_clock = DisplayClock(m_tick);
  m_worlds = EpochReplicas({from.snapshot, welcome.tick_now, from.input}, from.world_epoch);
}

ReceivedWorld::Result ReceivedWorld::applySnapshot(std::string_view bytes, Time now, InputOutbox& inputs,
                                                   const std::function<void(std::uint32_t)>& before) {
  const Result result = m_worlds.applySnapshot(bytes, now, m_header, before);
  if (result != Result::kApplied && result != Result::kShown) return result;
  if (result == Result::kShown) m_table_known = m_control_known = 0;
  m_acks.addReceived(m_header.number);
  const bool of_this_world = !m_changes_world;  // otherwise the ticks may be those of another world
  updateClock(result, now);
  if (m_header.has_input) {
    const auto input = inputs.removeUpTo(m_header.input);
    if (input && of_this_world) m_input_ticks.onInputApplied(input->tick, m_header.input_tick);
  }
  applyControls();
  return result;
}

void ReceivedWorld::enter(std::uint8_t epoch, std::uint32_t tick_now, Time now) {
  m_worlds.expectWorld(epoch, tick_now, now);
  m_changes_world = m_worlds.isChanging();
}

// Ticks of another world do not concern the picture until that world is shown.
void ReceivedWorld::updateClock(Result result, Time now) {
  if (m_changes_world && m_worlds.isChanging()) return;
  if (m_changes_world && result == Result::kShown) {
    m_clock = DisplayClock(m_tick);
    m_clock.setDelay(oneWayDelay());
    m_prediction.reset();
  }
  m_changes_world = false;
  m_clock.onSnapshot(m_header.tick, now);
}

DisplayClock::Duration ReceivedWorld::oneWayDelay() const {
  return std::chrono::duration_cast<DisplayClock::Duration>(m_input_ticks.shortestRoundTrip() / 2);
}

void ReceivedWorld::applyControls() {
  if (replica().controlTableNumber() != m_table_known) {
    m_table_known = replica().controlTableNumber();
    m_prediction.setTable(replica().controlTable());
  }
  if (replica().controlNumber() != m_control_known) {
    m_control_known = replica().controlNumber();
    m_prediction.applyControl(replica().control());
  }
}

std::optional<std::uint64_t> ReceivedWorld::pollChecksum(Time now) {
  if (now < m_next_checksum || m_acks.newest == 0 || m_worlds.isChanging()) return std::nullopt;
  m_next_checksum = now + kChecksumInterval;
  return replica().checksum();
}

void ReceivedWorld::addRttSample(InputTickEstimator::Millis sample) {
  m_input_ticks.addRttSample(sample);
  m_clock.setDelay(oneWayDelay());
}

const Prediction& ReceivedWorld::predict(Time now) {
  m_prediction.run(replica(), predictedTick(now));
  return m_prediction;
}

std::uint32_t ReceivedWorld::predictedTick(Time now) const {
  return m_input_ticks.tickFor(m_clock, m_tick, now);
}

}  // namespace naiad

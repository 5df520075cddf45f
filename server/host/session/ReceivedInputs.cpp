#include "host/session/ReceivedInputs.h"

#include <algorithm>

#include "shared/replica/Acks.h"

namespace naiad {

ReceivedInputs::Verdict ReceivedInputs::add(const Input& input) {
  if (!isNewer(input.id, m_newest)) return Verdict::kRepeated;
  if (m_queue.size() >= kMaxQueued) return Verdict::kTooMany;
  m_newest = input.id;
  m_queue.push_back(input);
  m_pressed.noteInput(input);
  return Verdict::kQueued;
}

void ReceivedInputs::releaseKeys(std::uint32_t tick) {
  m_pressed.releaseAll([this, tick](Input input) {
    input.id = m_newest;  // acknowledged together with that one
    input.tick = tick;
    m_queue.push_back(input);
  });
}

std::optional<std::uint32_t> ReceivedInputs::clear() {
  std::optional<std::uint32_t> last;
  if (!m_queue.empty()) last = m_queue.back().id;
  m_queue.clear();
  m_pressed = {};
  m_controls.reset();
  return last;
}

bool ReceivedInputs::isTooEarly(const Input& input, std::uint32_t tick) const {
  const auto early = static_cast<std::int32_t>(input.tick - tick);
  if (m_controls == nullptr || input.is_mouse || early <= 0 || early > kMaxEarly) return false;
  return std::any_of(m_controls->rows.begin(), m_controls->rows.end(),
                     [&input](const df::ControlRow& row) { return row.key == input.key; });
}

}  // namespace naiad

#include "client/session/InputOutbox.h"

#include "shared/replica/Acks.h"

namespace naiad {

void InputOutbox::start(std::uint32_t id, std::chrono::microseconds tick) {
  m_next = id + 1;
  m_rate.per_second = kPerTick / std::chrono::duration<double>(tick).count();
}

bool InputOutbox::admitInput(bool urgent, TokenBucket::Time now) {
  if (isFull(urgent)) return false;
  if (!urgent) return m_bucket.tryConsume(m_rate, now);
  m_bucket.forceConsume(m_rate, now);
  return true;
}

const Input& InputOutbox::add(Input input) {
  input.id = m_next++;
  m_inputs.push_back(input);
  return m_inputs.back();
}

std::optional<Input> InputOutbox::removeUpTo(std::uint32_t id) {
  std::optional<Input> found;
  for (; !m_inputs.empty() && !isNewer(m_inputs.front().id, id); m_inputs.pop_front()) {
    if (m_inputs.front().id == id) found = m_inputs.front();
    if (m_on_stream > 0) --m_on_stream;
  }
  return found;
}

std::vector<Input> InputOutbox::popForStream() {
  std::vector<Input> unsent(m_inputs.begin() + static_cast<std::ptrdiff_t>(m_on_stream), m_inputs.end());
  m_on_stream = m_inputs.size();
  return unsent;
}

}  // namespace naiad

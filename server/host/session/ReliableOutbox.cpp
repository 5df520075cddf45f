#include "host/session/ReliableOutbox.h"

#include <algorithm>
#include <utility>

#include "host/session/Counters.h"
#include "naiad.pb.h"
#include "shared/net/stream/Framing.h"
#include "shared/replica/Acks.h"

namespace naiad {

namespace {

wire::ServerMessage noticeOf(std::uint64_t lines) {
  wire::ServerMessage message;  // without a player, the line is from the server
  message.mutable_chat()->set_text(lines == 1 ? "1 line of chat was dropped."
                                              : std::to_string(lines) + " lines of chat were dropped.");
  return message;
}

}  // namespace

std::size_t ReliableOutbox::ReliableFrame::size() const {
  return frame.size() + kFrameHeaderSize;
}

void ReliableOutbox::add(const wire::ServerMessage& message) {
  if (message.has_sounds()) return addSounds(message);
  append(message, message.has_players() ? Kind::kPlayers : Kind::kChat, {});
}

// Each sound gets its own frame, so that a newer state of the sound can replace it.
void ReliableOutbox::addSounds(const wire::ServerMessage& message) {
  for (const wire::Sound& sound : message.sounds().sounds()) {
    wire::ServerMessage single;
    *single.mutable_sounds()->add_sounds() = sound;
    append(std::move(single), Kind::kSound, (sound.music() ? "music " : "sound ") + sound.label());
  }
}

void ReliableOutbox::append(wire::ServerMessage message, Kind kind, std::string label) {
  if (replaceUnsent(message, kind, label)) return limit();
  message.set_number(m_next);
  m_kept.push_back({m_next, kind, false, std::move(label), message.SerializeAsString(), 0});
  if (++m_next == 0) m_next = 1;
  count(m_kept.back());
  limit();
}

// Replaces an unsent frame in its place in the queue. At the end, a frame that is often updated would never
// be sent over an always busy connection. A sent frame is removed, and the new one is added at the end.
bool ReliableOutbox::replaceUnsent(wire::ServerMessage& message, Kind kind, const std::string& label) {
  if (kind == Kind::kChat) return false;
  const auto before = std::find_if(m_kept.begin(), m_kept.end(), [&](const ReliableFrame& kept) {
    return kept.kind == kind && kept.label == label;
  });
  if (before == m_kept.end()) return false;
  if (before->sent) {
    erase(static_cast<std::size_t>(before - m_kept.begin()));
    return false;
  }
  message.set_number(before->number);
  discount(*before);
  before->frame = message.SerializeAsString();
  count(*before);
  return true;
}

void ReliableOutbox::limit() {
  while (m_sound_bytes > kMaxSounds && dropOldestSound()) {
  }
  while (m_bytes > kMax && dropOldestChat()) {
  }
}

void ReliableOutbox::count(const ReliableFrame& kept) {
  m_bytes += kept.size();
  if (kept.kind == Kind::kSound && !kept.sent) m_sound_bytes += kept.size();
}

void ReliableOutbox::discount(const ReliableFrame& kept) {
  m_bytes -= kept.size();
  if (kept.kind == Kind::kSound && !kept.sent) m_sound_bytes -= kept.size();
}

void ReliableOutbox::erase(std::size_t index) {
  const auto at = m_kept.begin() + static_cast<std::ptrdiff_t>(index);
  discount(*at);
  if (index < m_on_stream) {
    --m_on_stream;
    m_bytes_on_stream -= at->size();
  }
  m_kept.erase(at);
}

// Returns the index of the first unsent frame of this kind; m_kept.size() if there is none.
std::size_t ReliableOutbox::findUnsent(Kind kind) const {
  const auto found = std::find_if(m_kept.begin(), m_kept.end(), [kind](const ReliableFrame& kept) {
    return !kept.sent && kept.kind == kind;
  });
  return static_cast<std::size_t>(found - m_kept.begin());
}

// Replaces the oldest unsent line by a notice, which adds the count of an earlier unsent notice to its own.
bool ReliableOutbox::dropOldestChat() {
  std::uint64_t lines = 1;
  if (findUnsent(Kind::kChat) == m_kept.size()) return false;
  if (const std::size_t before = findUnsent(Kind::kNotice); before < m_kept.size()) {
    lines += m_kept[before].lines;
    erase(before);
  }
  ReliableFrame& line = m_kept[findUnsent(Kind::kChat)];
  discount(line);
  wire::ServerMessage notice = noticeOf(lines);
  notice.set_number(line.number);
  line = {line.number, Kind::kNotice, false, {}, notice.SerializeAsString(), lines};
  count(line);
  ++m_counters.outbox_chat_dropped;
  return true;
}

bool ReliableOutbox::dropOldestSound() {
  const std::size_t oldest = findUnsent(Kind::kSound);
  if (oldest == m_kept.size()) return false;
  erase(oldest);
  ++m_counters.outbox_sounds_dropped;
  return true;
}

void ReliableOutbox::acknowledge(std::uint32_t number) {
  if (number == 0 || m_newest_sent == 0 || isNewer(number, m_newest_sent)) return;
  while (!m_kept.empty() && !isNewer(m_kept.front().number, number)) erase(0);
}

void ReliableOutbox::restartStream() {
  m_on_stream = 0;
  m_bytes_on_stream = 0;
}

void ReliableOutbox::clear() {
  m_kept.clear();
  m_bytes = m_sound_bytes = 0;
  restartStream();
}

const std::string* ReliableOutbox::next() const {
  if (m_on_stream == m_kept.size() || m_bytes_on_stream >= kWindow) return nullptr;
  return &m_kept[m_on_stream].frame;
}

void ReliableOutbox::markSent() {
  ReliableFrame& kept = m_kept[m_on_stream++];
  m_bytes_on_stream += kept.size();
  if (m_newest_sent == 0 || isNewer(kept.number, m_newest_sent)) m_newest_sent = kept.number;
  if (!std::exchange(kept.sent, true) && kept.kind == Kind::kSound) m_sound_bytes -= kept.size();
}

}  // namespace naiad

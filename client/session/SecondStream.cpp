#include "client/session/SecondStream.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "client/session/ServerMessages.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"

namespace naiad {

bool SecondStream::takeAttempt(Time now) {
  if (m_channel != nullptr || now < m_next_attempt) return false;
  m_next_attempt = now + m_pause;
  m_pause = std::min(m_pause * 2, kLastPause);
  return true;
}

void SecondStream::start(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
                         std::function<void(std::string_view bytes)> on_snapshot) {
  close();
  m_channel = std::move(channel);
  m_on_snapshot = std::move(on_snapshot);
  m_started = m_last_heard = options.now();
  m_channel->setReceiveLimit(kMaxServerFrame);
  m_channel->start({[this, now = options.now](std::string_view frame) { receive(frame, now()); },
                    [this](CloseReason) { close(); }});
  m_channel->send(helloOf(options).SerializeAsString());
}

void SecondStream::update(Time now) {
  if (now - m_last_heard >= kMaxSilence) close();
}

void SecondStream::receive(std::string_view frame, Time now) {
  m_last_heard = now;
  if (now - m_started > m_pause) m_pause = kFirstPause;
  auto message = readServerMessage(frame);
  const auto* welcome = message ? std::get_if<WelcomeMessage>(&*message) : nullptr;
  if (!m_open && welcome != nullptr && welcome->second_stream) {
    m_open = true;
    return;
  }
  const auto* snapshot = message ? std::get_if<SnapshotMessage>(&*message) : nullptr;
  if (!m_open || snapshot == nullptr) return close();
  m_on_snapshot(snapshot->bytes);
}

bool SecondStream::isRepeat(std::string_view snapshot) {
  const std::size_t hash = std::hash<std::string_view>()(snapshot);
  const std::size_t kept = std::min(m_heard, m_hashes.size());
  const auto end = m_hashes.begin() + static_cast<std::ptrdiff_t>(kept);
  if (std::find(m_hashes.begin(), end, hash) != end) return true;
  m_hashes[m_heard++ % m_hashes.size()] = hash;
  return false;
}

void SecondStream::send(std::string_view frame) {
  if (m_open && m_channel->unsentBytes() == 0) m_channel->send(frame);
}

void SecondStream::close() {
  m_open = false;
  if (m_channel == nullptr) return;
  m_channel->close();
  m_channel.reset();
}

}  // namespace naiad
